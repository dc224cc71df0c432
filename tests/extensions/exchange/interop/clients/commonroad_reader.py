"""commonroad-io on CommonRoad files: its XSD, and what its reader makes of them, against what is expected."""

import json
import math
import sys
import warnings
from pathlib import Path

import commonroad
from commonroad.common.file_reader import CommonRoadFileReader
from lxml import etree

TURNED = 1e-5
"""rad between the direction of a box and that of the road."""
XSD = Path(commonroad.__file__).parent / "common" / "xml_definition_files" / "XML_commonRoad_XSD.xsd"


def check(path: str, expected: dict, schema) -> list[str]:
    try:
        found = [] if schema.validate(etree.parse(path)) else [str(x.message) for x in schema.error_log]
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            scenario, problems = CommonRoadFileReader(path).open()
        found += [f"warning: {x.message}" for x in told if not issubclass(x.category, DeprecationWarning)]
        return found + list(differences(scenario, problems, expected))
    except Exception as error:
        return [f"{type(error).__name__}: {error}"]


def differences(scenario, problems, expected: dict):
    if len(problems.planning_problem_dict) != 1:
        yield f"{len(problems.planning_problem_dict)} planning problems"
    lanelets = len(scenario.lanelet_network.lanelets)
    if lanelets != expected["lanelets"]:
        yield f"{lanelets} lanelets, where the road has {expected['lanelets']}"
    far, fast = expected["within"]
    vehicles = expected["vehicles"].values()
    if {x.obstacle_id for x in scenario.dynamic_obstacles} != {x["id"] for x in vehicles}:
        yield f"vehicles {[x.obstacle_id for x in scenario.dynamic_obstacles]}"
        return
    for told in vehicles:
        obstacle = scenario.obstacle_by_id(told["id"])
        size = obstacle.obstacle_shape.length, obstacle.obstacle_shape.width
        if size != (told["length"], told["width"]):
            yield f"vehicle {told['id']}: a box of {size}"
        states = [obstacle.initial_state, *obstacle.prediction.trajectory.state_list]
        if len(states) != len(told["samples"]):
            yield f"vehicle {told['id']}: {len(states)} states"
            continue
        for k, (state, place) in enumerate(zip(states, told["samples"], strict=True)):
            if state.time_step != k or math.dist(state.position, place[:2]) > far:
                yield f"vehicle {told['id']}, state {k}: at {state.position}, the drive is at {place[:2]}"
                break
            turned = abs(math.remainder(state.orientation - place[3], math.tau))
            if (place[2] is not None and abs(state.velocity - place[2]) > fast) or turned > TURNED:
                yield f"vehicle {told['id']}, state {k}: {state.velocity} m/s, turned {state.orientation}"
                break


if __name__ == "__main__":
    asked, answer = map(Path, sys.argv[1:])
    files = json.loads(asked.read_text("utf-8"))
    schema = etree.XMLSchema(etree.parse(str(XSD)))
    answer.write_text(json.dumps({x: check(x, told, schema) for x, told in files.items()}), "utf-8")
