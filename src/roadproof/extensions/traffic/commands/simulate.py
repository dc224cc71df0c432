"""``roadproof simulate``: recordings in the highD format, made of simulated traffic."""

import argparse
import re
import sys
from collections.abc import Iterator
from dataclasses import replace
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING

from roadproof.errors import InputError, UsageError
from roadproof.extensions.traffic.settings import Simulate
from roadproof.frontends.cli.progress import note
from roadproof.frontends.settings.flags import read_keywords
from roadproof.verdict import ExitCode

_NUMBERS = re.compile(r"\d{1,2}(-\d{1,2})?(,\d{1,2}(-\d{1,2})?)*")

if TYPE_CHECKING:
    from roadproof.evidence.drive_file import DriveFile

SUMMARY = "simulate traffic and write recordings in the highD format"

EXAMPLES = """\
Car following is IDM (Treiber et al. 2000), lane changes are MOBIL (Kesting et al. 2007). The same seed
gives the same files. With --plant, planted.csv tells which pair does what, when; its columns are those
of matches.csv.

examples:
  roadproof simulate --out traffic --recordings 2 --seconds 60 --seed 1
  roadproof simulate --out traffic --recordings 60 --jobs 2
  roadproof simulate --out traffic --seconds 120 --ramp merge
  roadproof simulate --out traffic --seconds 120 --plant 1-8
  roadproof witness 1 2 --set ext --out drives; roadproof simulate --out traffic --plant drives
"""
OPTIONS = Simulate


def run(args: argparse.Namespace) -> int:
    from roadproof.extensions.traffic.simulating import simulate

    if args.plant and args.ramp != "none":
        raise UsageError(
            f"--plant with --ramp {args.ramp}: drives are planted on main roads only; omit one of them"
        )
    each = (
        _search_drives(x, args.plant_set) if _NUMBERS.fullmatch(x) else _read(Path(x))
        for x in args.plant or ()
    )
    drives = tuple(chain.from_iterable(each))
    if args.plant and not drives:
        raise InputError(f"--plant {' '.join(args.plant)}: no drive that can be planted")
    simulation = simulate(args.out, **read_keywords(args, Simulate) | {"plant": drives, "tell": note})
    for line in simulation.left_out:
        _warn(f"not planted: {line}")
    if drives and not simulation.planted:
        raise InputError("--plant: no drive could be planted; simulate more seconds, or find other drives")
    planted = f", {len(simulation.planted)} drives planted" if drives else ""
    print(f"{args.recordings} recordings of {args.seconds:g} s in {args.out}{planted}")
    return ExitCode.AS_EXPECTED


def _read(path: Path) -> "Iterator[DriveFile]":
    """The drives of a file or a folder that can be planted; of the others it is said why not."""
    from roadproof.evidence.drive_file import load_drive
    from roadproof.evidence.judged import judge_file
    from roadproof.extensions.traffic.simulate.planting import plantable, with_roles
    from roadproof.library.loading import bundled_library

    files = [x for x in sorted(path.glob("*.json")) if _may_be_drive(x)] if path.is_dir() else [path]
    if not files:
        raise InputError(f"--plant {path}: the folder holds no drive files (*.json)")
    for name in files:
        file = load_drive(name)
        reason = plantable(file) or judge_file(file, bundled_library()).reason
        if reason:
            _warn(f"not planted: {name}: {reason}")
        else:
            yield with_roles(file, bundled_library())


def _may_be_drive(path: Path) -> bool:
    """Return whether a file of a folder is no other evidence, as ``roadproof witness`` writes beside
    drives.
    """
    from roadproof.core_record import DRIVES
    from roadproof.evidence.answer_codec import is_answer
    from roadproof.evidence.strict import read_json
    from roadproof.questions.data import SCHEMA as QUESTION

    content = read_json(path)
    kind = content.get("schema") if isinstance(content, dict) else None
    return kind in DRIVES or not (kind == QUESTION or is_answer(str(kind)))


def _search_drives(text: str, set_name: str) -> "Iterator[DriveFile]":
    """A drive for each scenario of ``text`` (such as 1-3,7), whose danger lasts up to its horizon.

    A recorded trace ends with its last danger, so whatever else the scenario needs has happened then;
    L is the lane of one vehicle's centre at the start, so that vehicle begins in L alone (semantics §7).
    """
    from roadproof.engines.search.drive_search import search_drive
    from roadproof.engines.setting import Search, Setting
    from roadproof.extensions.traffic import scenario_parts
    from roadproof.library import scenarios
    from roadproof.library.bind import default_values
    from roadproof.library.compose import both
    from roadproof.library.loading import bundled_library
    from roadproof.world.models import load_road

    specification = bundled_library().select(set_name)
    for item in text.split(","):
        low, _, high = item.partition("-")
        for number in range(int(low), int(high or low) + 1):
            if not 1 <= number <= 8:
                raise UsageError(
                    f"--plant {text}: recordings have a main road only; write scenarios from 1 to 8"
                )
            scenario, setting = scenarios.Scenario(number, set_name), Setting(load_road("main-2"))
            claim, vehicles = (
                scenarios.apply_scenario(specification, scenario),
                scenarios.vehicles_of(specification, scenario),
            )
            latest = setting.horizon - default_values(bundled_library())[scenarios.MIN_DANGER]
            alone = scenario_parts.alone_in_lane(
                specification, scenario_parts.lane_owner(specification, scenario)
            )
            lasting = scenario_parts.danger_at(specification, *scenario_parts.danger_pair(vehicles), latest)
            outcome = search_drive(Search(specification, both(claim, alone, lasting), setting))
            if outcome.drives:
                yield replace(outcome.drives[0].file, scenario=number, formula=claim.text)
            else:
                _warn(f"not planted: scenario {number}, {set_name}: {outcome.verdict}: {outcome.reason}")


def _warn(text: str) -> None:
    print(text, file=sys.stderr, flush=True)
