"""The same questions through both doors: Python, and the command line."""

import contextlib
import io
import json
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import roadproof as rp
from roadproof.frontends.api.answer import BaseAnswer
from roadproof.frontends.cli.main import main

SYMMETRIC = "danger(SV,POV) -> danger(POV,SV)"
FALSE = "fasterThan(SV,POV) -> danger(SV,POV)"
SLOW = "v_lon(SV) < 500 km/h"
IMPOSSIBLE = "s(SV) > s(POV) + 5 m and s(POV) > s(SV)"
MINE = """\
def roadSector_90(SV, POV: vehicle) := true
def disturb_90(SV, POV: vehicle, L: lane) := v_lon(SV) > 30 m/s
def scenario_90(SV, POV: vehicle, L: lane) "fast"
  := initSafe(SV, POV) and roadSector_90(SV, POV) and disturb_90(SV, POV, L)
"""


@dataclass(frozen=True)
class InterfaceCase:
    """A question in Python and as a command line, and whether there is a picture of its answer.

    Where the line says ``--out kept``, the command line takes up what was found in Python, and kept there.
    """

    ask: Callable[[Path], BaseAnswer]
    line: str
    drawn: bool = False


ASKED = {
    "prove": InterfaceCase(
        lambda _: rp.prove(SYMMETRIC, FALSE, jobs=1), f"prove '{SYMMETRIC}' '{FALSE}'", True
    ),
    "prove-property": InterfaceCase(lambda _: rp.prove("P4", jobs=1), "prove P4"),
    "prove-scenario": InterfaceCase(
        lambda _: rp.prove(4, using=rp.load("ext"), drive=False, jobs=1), "prove 4 --set ext --no-drive"
    ),
    "prove-bounded": InterfaceCase(
        lambda _: rp.prove(SLOW, engine="milp", horizon=3, dt="3/5", jobs=1),
        f"prove '{SLOW}' --engine milp --horizon 3 --dt 3/5",
    ),
    "witness": InterfaceCase(lambda _: rp.witness(4, IMPOSSIBLE, jobs=1), f"witness 4 '{IMPOSSIBLE}'", True),
    "witness-none": InterfaceCase(lambda _: rp.witness(f"not ({SLOW})", jobs=1), f"witness 'not ({SLOW})'"),
    "compare": InterfaceCase(
        lambda _: rp.compare(3, "scenario_4(POV,SV,L)"), "compare 3 'scenario_4(POV,SV,L)'"
    ),
    "compare-sets": InterfaceCase(
        lambda _: rp.compare(4, 4, rp.load("base", "ext")), "compare 4 4 --set base,ext", True
    ),
    "overlap": InterfaceCase(
        lambda kept: rp.overlap("3,4", out=kept, jobs=1), "overlap --among 3,4 --out kept --no-pictures", True
    ),
    "order": InterfaceCase(
        lambda _: rp.order([3, 4], rp.load("base"), jobs=1), "order --among 3,4 --set base", True
    ),
    "redundancy": InterfaceCase(
        lambda kept: rp.redundancy(90, rp.load(specs=[MINE]), effort=1, out=kept, jobs=1),
        "redundancy --among 90 --spec mine-1.spec --effort 1 --out kept",
    ),
    "coverage": InterfaceCase(
        lambda kept: rp.coverage(rp.load("complete"), out=kept, jobs=1),
        "coverage --set complete --out kept --no-pictures",
    ),
    "classify": InterfaceCase(
        lambda kept: rp.classify("3-4", shares=False, out=kept, jobs=1),
        "classify --among 3-4 --no-shares --out kept --no-pictures",
        True,
    ),
    "explore-values": InterfaceCase(
        lambda _: rp.explore(4, vary={"minDanger": (0, "3 s")}, steps=2, precision=3, jobs=1),
        "explore 4 --vary minDanger=0:3 --steps 2 --precision 3",
        True,
    ),
    "explore-measure": InterfaceCase(
        lambda kept: rp.explore(4, least=rp.SV.v_lon - rp.POV.v_lon, precision=5, out=kept, jobs=1),
        "explore 4 --least 'v_lon(SV) - v_lon(POV)' --precision 5 --out kept --no-pictures",
    ),
}
WITHOUT_JOBS = ("compare", "monitor")


def tell(arguments: Sequence[str]) -> tuple[int, str, str]:
    """The exit code of a command line, what it prints, and its complaints."""
    printed, complaints = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(complaints):
        code = main([*arguments, *(() if arguments[0] in WITHOUT_JOBS else ("--jobs", "1"))])
    return code, printed.getvalue(), complaints.getvalue()


def without_clock(text: str) -> str:
    """A text without what depends on how fast the machine is."""
    return re.sub(r" +\d+(\.\d+)? s$| +\d+\.\d+ s\b", " … s", text.strip(), flags=re.M)


COST = ("seconds", "stages", "sizes")
"""What answers say of the run that asked: how long each took, and how large the problems were."""


def without_seconds(data: Any) -> Any:
    """Plain data without what a run cost, as JSON brings it back."""

    def strip(part: Any) -> Any:
        match part:
            case dict():
                return {name: strip(x) for name, x in part.items() if name not in COST}
            case list():
                return [*map(strip, part)]
            case _:
                return part

    return strip(json.loads(json.dumps(data)))
