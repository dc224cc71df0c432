"""What a recording says of lanes, which formulas ask for: a vehicle in a lane, beside it, or in a zone."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

from roadproof.library.scenarios import LANE, PAIR, TRIPLE, beside_lane, in_lane, in_zone
from roadproof.library.specification import Specification
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import without_names
from roadproof.recordings.formats.recording import ZONES

OTHER_LANE = "L1"
"""What the lane of a pair's second vehicle is called."""


@dataclass(frozen=True)
class LaneAtom:
    """A state formula that the data layer decides: a vehicle in a lane, beside it, or in a zone."""

    kind: Literal["at", "beside", "zone"]
    vehicle: str
    of: str


def lane_atoms(spec: Specification) -> Iterator[tuple[Formula, LaneAtom]]:
    """The lane predicates of a specification, for the vehicles of pairs and triples and the lanes L, L1."""
    for vehicle in dict.fromkeys((*PAIR, *TRIPLE)):
        for lane in (LANE, OTHER_LANE):
            yield without_names(in_lane(spec, vehicle, lane).formula), LaneAtom("at", vehicle, lane)
            yield without_names(beside_lane(spec, vehicle, lane).formula), LaneAtom("beside", vehicle, lane)
        for zone in ZONES:
            yield without_names(in_zone(spec, vehicle, zone).formula), LaneAtom("zone", vehicle, zone)
