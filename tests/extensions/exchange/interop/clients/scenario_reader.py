"""scenariogeneration's reader on OpenSCENARIO files: where boxes are, against what is expected."""

import contextlib
import io
import json
import math
import sys
from pathlib import Path

from scenariogeneration import xosc

WITHIN = 0.01
"""Metres, which the heading of a file promises."""


def check(path: str, expected: dict) -> list[str]:
    try:
        with contextlib.redirect_stdout(io.StringIO()):
            scenario = xosc.ParseOpenScenario(path)
        return list(differences(scenario, expected))
    except Exception as error:
        return [f"{type(error).__name__}: {error}"]


def differences(scenario, expected: dict):
    boxes = {x.name: x.entityobject.boundingbox for x in scenario.entities.scenario_objects}
    courses = {}
    for story in scenario.storyboard.stories:
        for act in story.acts:
            for group in act.maneuvergroup:
                (actor,) = group.actors.actors
                (event,) = [e for m in group.maneuvers for e in m.events]
                courses[actor.entity] = event.action[0].action
    if not boxes.keys() == courses.keys() == expected["vehicles"].keys():
        yield f"vehicles {[*boxes]}, courses {[*courses]}"
        return
    for name, told in expected["vehicles"].items():
        box = boxes[name]
        size = box.boundingbox.length, box.boundingbox.width
        if max(abs(size[0] - told["length"]), abs(size[1] - told["width"])) > 1e-9:
            yield f"{name}: a box of {size}"
        follows = courses[name]
        reference = follows.timeref.reference_domain.get_name()
        if (reference, follows.timeref.offset, follows.timeref.scale) != ("absolute", 0, 1):
            yield f"{name}: times are {reference}"
        line = follows.trajectory.shapes
        vertices = [(t, p.x, p.y, p.h) for t, p in zip(line.time, line.positions, strict=True)]
        worst = max(
            math.dist(centre(vertices, time, box.center.x), place)
            for time, place in zip(told["times"], told["centres"], strict=True)
        )
        if worst > WITHIN:
            yield f"{name}: {worst:.4f} m from the drive"


def centre(vertices, time: float, ahead: float) -> tuple[float, float]:
    k = max(k for k, x in enumerate(vertices[:-1]) if x[0] <= time or k == 0)
    (begin, *a), (end, *b) = vertices[k], vertices[k + 1]
    x, y, turned = (p + (time - begin) / (end - begin) * (q - p) for p, q in zip(a, b, strict=True))
    return x + ahead * math.cos(turned), y + ahead * math.sin(turned)


if __name__ == "__main__":
    asked, answer = map(Path, sys.argv[1:])
    files = json.loads(asked.read_text("utf-8"))
    answer.write_text(json.dumps({x: check(x, told) for x, told in files.items()}), "utf-8")
