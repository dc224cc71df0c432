"""The set without gaps: each of its definitions said again in other words."""

import pytest

from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.logic.rewrite import without_names

LIBRARY = bundled_library()
SAID = {
    "cutIn(POV, SV, L)": "not (atLane(POV,L) and atLane(SV,L)) and F danger(SV,POV)",
    "cutOut(POV, SV, L)": "(atLane(POV,L) and atLane(SV,L)) and F danger(POV,SV) and F not atLane(POV,L)",
    "decel(POV, SV, L)": "laneKeep(POV,L)",
    "aheadOf(POV, SV)": "s(POV) <= s(SV)",
    "initialCondition_8(SV, POV, L)": "atLane(SV,L) and atLane(POV,L)",
}


@pytest.mark.parametrize("name", SAID)
def test_a_definition_is_what_is_said(name: str) -> None:
    complete, ext = LIBRARY.select("complete"), LIBRARY.select("ext")
    found = without_names(read_claim(complete, name).formula)
    assert found == without_names(read_claim(ext, SAID[name]).formula)
    assert found != without_names(read_claim(ext, name).formula)


def test_nothing_else_differs() -> None:
    complete, ext = (LIBRARY.select(x).definitions for x in ("complete", "ext"))
    assert {f"{n}(" for n in complete if complete[n] is not ext[n]} == {x[: x.index("(") + 1] for x in SAID}
