"""The lanes of NGSIM's freeways, which no file measures: they are where vehicles with each Lane_ID drive.

Lanes through the section are numbered from the left. The edge of two is in the middle between the medians of
their vehicles' Local_X, and the outer edges are as far from their medians. On US-101, lane 6 joins the
on-ramp 7 to the off-ramp 8: it is a merge lane up to its middle and a departure lane from there. On I-80, 7
is an on-ramp. Such lanes are rectangles beside the last lane, from their first sample to their last, and put
the other lanes into their zone.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise

import numpy as np

from roadproof.errors import InputError
from roadproof.extensions.traffic.formats.table import ColumnTable
from roadproof.world.lanelet_rules import shared_boundaries
from roadproof.world.road import Attribute, Lanelet, Road, Zone

FOOT = 0.3048
"""m, exactly."""
_USUAL = 12.0
"""ft: the width of a lane where one lane alone has vehicles."""
_NARROWEST, _WIDEST = 6.0, 24.0
"""ft between the medians of neighbouring lanes."""
_MILLI = 1000
_ZONES: Mapping[Attribute, Zone] = {"main": "main", "merge": "merge", "departure": "depart"}


@dataclass(frozen=True)
class Freeway:
    """``through``: how many lanes go through; Lane_IDs of the other lanes, 0 for none.

    ``auxiliary`` joins ``on_ramp`` to ``off_ramp``. ``near``: Global_X and Global_Y (ft) of a place there.
    """

    through: int
    on_ramp: int
    auxiliary: int
    off_ramp: int
    near: tuple[float, float]

    @property
    def ramps(self) -> tuple[int, ...]:
        """The Lane_IDs beside the lanes through the section."""
        return tuple(x for x in (self.on_ramp, self.auxiliary, self.off_ramp) if x)


FREEWAYS: Mapping[str, Freeway] = {
    "us-101": Freeway(5, 7, 6, 8, (6_451_000.0, 1_873_000.0)),
    "i-80": Freeway(6, 7, 0, 0, (6_042_800.0, 2_133_500.0)),
}
"""By their names in the column Location; Lane_IDs as in the data dictionaries of FHWA."""

_Step = tuple[Fraction | None, Fraction | None, Attribute]
"""A stretch along s (m), and the kind of ramp beside the lanes there; main where there is none."""


def measured_road(name: str, freeway: Freeway, rows: ColumnTable) -> Road:
    """The road of a freeway by the samples on it, which are in order of vehicle and frame.

    Raises ``InputError`` where Lane_ID does not grow to the right.
    """
    lane, x = rows["Lane_ID"], rows["Local_X"]
    middles = _middles(rows, range(1, freeway.through + 1))
    if not middles:
        raise InputError(f"{rows.path}, column Lane_ID: no sample is in lanes 1 to {freeway.through}")
    values = np.array([*middles.values()])
    half = float(np.diff(values).mean()) / 2 if len(values) > 1 else _USUAL / 2
    cuts = [float(values[0]) - half, *((values[1:] + values[:-1]) / 2).tolist(), float(values[-1]) + half]
    on_ramps = np.isin(lane, freeway.ramps)
    steps: list[_Step] = [*_steps(freeway, rows.at(np.flatnonzero(on_ramps)))] if on_ramps.any() else []
    bands = [(str(k), _band(*ends)) for k, ends in zip(middles, pairwise(cuts), strict=True)]
    lanelets = [x for name, d in bands for x in _lanelets(name, "main", steps or [(None, None, "main")], d)]
    if steps:
        d = _band(cuts[-1], max(float(np.median(x[on_ramps])), cuts[-1]) + half)
        ramps: tuple[Attribute, ...] = ("merge", "departure")
        for ramp in ramps:
            lanelets += _lanelets(ramp, ramp, [x for x in steps if x[2] == ramp], d)
    return Road(name, tuple(lanelets), shared_boundaries(tuple(lanelets)))


def _band(left: float, right: float) -> tuple[Fraction, Fraction]:
    """Return d of the edges (m), the right one first, from their Local_X (ft)."""
    return _metres(-right), _metres(-left)


def _metres(feet: float) -> Fraction:
    return Fraction(round(feet * FOOT * _MILLI), _MILLI)


def _lanelets(
    lane: str, attribute: Attribute, steps: Sequence[_Step], d: tuple[Fraction, Fraction]
) -> Iterator[Lanelet]:
    for k, (begin, end, ramp) in enumerate(steps, 1):
        name = lane if len(steps) == 1 else f"{lane}.{k}"
        yield Lanelet(name, lane, _ZONES[ramp], attribute, (begin, end), d)


def _middles(rows: ColumnTable, numbers: Sequence[int]) -> dict[int, float]:
    """The median Local_X (ft) of each lane; of one without vehicles, between those of its neighbours."""
    lane, x = rows["Lane_ID"], rows["Local_X"]
    known = {k: float(np.median(x[lane == k])) for k in numbers if (lane == k).any()}
    for (one, left), (other, right) in pairwise(known.items()):
        if not _NARROWEST <= (right - left) / (other - one) <= _WIDEST:
            raise InputError(
                f"{rows.path}, column Local_X: vehicles of Lane_ID {other} drive {right - left:.1f} ft right "
                f"of those of Lane_ID {one}; lanes are {_NARROWEST:g} to {_WIDEST:g} ft wide, and both "
                "columns grow to the right"
            )
    there = range(min(known), max(known) + 1) if known else ()
    return {k: float(np.interp(k, [*known], [*known.values()])) for k in there}


def _steps(freeway: Freeway, rows: ColumnTable) -> Iterator[_Step]:
    """The road along s before, beside and after the ramps that ``rows`` are on."""
    lane, s = rows["Lane_ID"], rows["Local_Y"]
    begin, end = float(s.min()), float(s.max())
    places: list[tuple[float, Attribute]] = [(begin, "merge"), (end, "main")]
    if freeway.auxiliary:
        before, after = s[lane == freeway.on_ramp], s[lane == freeway.off_ramp]
        low = float(before.max()) if len(before) else begin
        high = float(after.min()) if len(after) else end
        places.insert(1, ((low + high) / 2, "departure"))
    cuts = [(_metres(feet), ramp) for feet, ramp in places]
    yield None, cuts[0][0], "main"
    for (low_s, ramp), (high_s, _) in pairwise(cuts):
        yield low_s, high_s, ramp
    yield cuts[-1][0], None, "main"
