"""commonroad-crime's metrics on CommonRoad files against those of the drive.

Its rounding to two decimals is taken out, since equal within 1e-6 is asked. Its time to collision takes
the speed of a vehicle in whatever direction, differences of accelerations up to 0.1 m/s² for none, and the
acceleration of the one ahead without its sign; it is compared where that one does not brake.
"""

import contextlib
import io
import json
import logging
import sys
import warnings
from pathlib import Path

import commonroad_crime.utility.general as general
from commonroad.common.file_reader import CommonRoadFileReader
from commonroad_crime.data_structure.configuration import CriMeConfiguration
from commonroad_crime.measure import HW, THW, TTC

logging.disable(logging.CRITICAL)
warnings.simplefilter("ignore")
general.int_round = lambda value, *_: value
WITHIN = 1e-6


def check(path: str, expected: dict) -> list[str]:
    try:
        with contextlib.redirect_stdout(io.StringIO()):
            scenario, _ = CommonRoadFileReader(path).open(lanelet_assignment=True)
            egos = sorted({x["ego"] for x in expected["metrics"]})
            return list(differences({x: measures_of(scenario, x) for x in egos}, expected["metrics"]))
    except Exception as error:
        return [f"{type(error).__name__}: {error}"]


def measures_of(scenario, ego: int) -> dict:
    config = CriMeConfiguration()
    config.update(ego_id=ego, sce=scenario)
    return {"headway": HW(config), "time headway": THW(config), "time to collision": TTC(config)}


def differences(measures: dict, metrics: list):
    for told in metrics:
        for name, measure in measures[told["ego"]].items():
            if name in told:
                measure.other_vehicle = None  # it keeps the one that it was asked about first
                value = measure.compute(told["other"], told["step"], False)
                if not abs(value - told[name]) <= WITHIN:
                    yield f"{name} of {told['other']} at step {told['step']}: {value}, ours {told[name]}"


if __name__ == "__main__":
    asked, answer = map(Path, sys.argv[1:])
    files = json.loads(asked.read_text("utf-8"))
    answer.write_text(json.dumps({x: check(x, told) for x, told in files.items()}), "utf-8")
