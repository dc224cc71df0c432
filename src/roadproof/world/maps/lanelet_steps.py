"""Lanelets of a road as rectangles in s and d, from the bounds of measured ones along a reference line.

Edges are constant in steps, and lanelets side by side have one edge in common, in the middle of both of
theirs. The greatest distance between an edge and the bound that it stands for is told. Ends of lanelets that
are within a metre of each other are one place.
"""

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise

import numpy as np

from roadproof.errors import InputError
from roadproof.world.maps.carriageway import Carriageway
from roadproof.world.maps.lines import thinned
from roadproof.world.maps.topology import Floats
from roadproof.world.reference_line import ReferenceLine
from roadproof.world.road import Attribute, Lanelet, Zone

_SPACING = 1.0
"""Metres between the points of a bound that are looked at."""
_ONE_PLACE, _ONE_EDGE, _NARROWEST = 1.0, 0.5, 0.1
"""Metres: of places and of edges that are one, and of the narrowest lanelet that is one."""
_SHORTEST = 0.25
"""Metres: a step that is shorter is not divided."""
_BACK = 1.0
"""Metres that a bound may go back along the reference line."""
_MILLI = 1000


@dataclass(frozen=True)
class MapLanelet:
    """``right``, ``left``: bounds as rows of s and d, s growing. ``lane``: a name that its lanelets have."""

    id: str
    lane: str
    attribute: Attribute
    zone: Zone
    right: Floats
    left: Floats

    @property
    def ends(self) -> tuple[float, float]:
        """s of its beginning and its end, in the middle of those of its bounds."""
        first, last = (float(self.right[k, 0] + self.left[k, 0]) / 2 for k in (0, -1))
        return first, last


@dataclass(frozen=True)
class _Strip:
    """A lanelet on a step from ``s[0]`` to ``s[1]``; ``error``: how far an edge is from its bound (m)."""

    lanelet: MapLanelet
    s: tuple[Fraction, Fraction]
    d: tuple[Fraction, Fraction]
    error: float


def edges_along(line: ReferenceLine, bound: Floats, where: str) -> Floats:
    """A bound as rows of s and d. Raises ``InputError`` where it goes back along the line."""
    rows: list[tuple[float, float]] = []
    samples = np.array(line.samples)
    for x, y in thinned(bound, _SPACING).tolist():
        near = int(np.argmin(np.hypot(samples[:, 1] - x, samples[:, 2] - y)))
        s, d = line.locate(x, y, float(samples[near, 0]))
        if rows and s < rows[-1][0] - _BACK:
            told = f"at s = {s:.1f} m it goes back along the middle of the way: the bend is too sharp"
            raise InputError(f"{where}: {told} for lanes side by side; name another way or cut the file")
        if not rows or s > rows[-1][0]:
            rows.append((s, d))
    return np.array(rows)


def lanelets_of(
    lanelets: Sequence[MapLanelet], way: Sequence[str], step: Fraction, where: str
) -> Carriageway:
    """Rectangles, their lanes called main-1, main-2, …, merge-1, … from the right. Raises ``InputError``.

    ``way``: ids of the lanelets on whose middle s is measured. ``step``: how much an edge changes at most on
    one of them (m). An id of several rectangles is ID.1, ID.2, ….
    """
    places = _places(lanelets, set(way))
    strips: list[_Strip] = []
    for begin, end in pairwise(sorted(set(places.values()))):
        there = [x for x in lanelets if places[x.ends[0]] <= begin and end <= places[x.ends[1]]]
        there.sort(key=lambda x: _between(x.right, begin, end) + _between(x.left, begin, end))
        for part in _divided(there, (begin, end), float(step)):
            strips += _strips(there, part, where)
    counts, parts = Counter(x.lanelet.id for x in strips), Counter[str]()
    names, numbers = dict[str, str](), Counter[Attribute]()
    found = []
    for x in strips:
        if x.lanelet.lane not in names:
            numbers[x.lanelet.attribute] += 1
            names[x.lanelet.lane] = f"{x.lanelet.attribute}-{numbers[x.lanelet.attribute]}"
        parts[x.lanelet.id] += 1
        name = x.lanelet.id if counts[x.lanelet.id] == 1 else f"{x.lanelet.id}.{parts[x.lanelet.id]}"
        lane = names[x.lanelet.lane]
        found.append(Lanelet(name, lane, x.lanelet.zone, x.lanelet.attribute, x.s, x.d))
    error = max((x.error for x in strips), default=0.0)
    return Carriageway(tuple(found), Fraction(-int(-error * _MILLI // 1), _MILLI))


def _places(lanelets: Sequence[MapLanelet], way: set[str]) -> dict[float, float]:
    """The place of each end: that of the way which is near, or the middle of those near each other."""
    ours = {s for x in lanelets if x.id in way for s in x.ends}
    places: dict[float, float] = {}
    near: list[float] = []
    for s in sorted({s for x in lanelets for s in x.ends}):
        if near and s - near[0] > _ONE_PLACE:
            places |= dict.fromkeys(near, _place(near, ours))
            near = []
        near.append(s)
    return places | dict.fromkeys(near, _place(near, ours))


def _place(near: list[float], ours: set[float]) -> float:
    chosen = [s for s in near if s in ours] or near
    return round(sum(chosen) / len(chosen) * _MILLI) / _MILLI


def _between(edge: Floats, begin: float, end: float) -> float:
    """d of an edge in the middle of a step."""
    return float(np.interp((begin + end) / 2, edge[:, 0], edge[:, 1]))


def _values(edge: Floats, part: tuple[float, float]) -> Floats:
    """d of an edge at the ends of a part and at its points between."""
    inside = edge[(edge[:, 0] > part[0]) & (edge[:, 0] < part[1]), 1]
    return np.concatenate((inside, np.interp(part, edge[:, 0], edge[:, 1])))


def _divided(
    there: Sequence[MapLanelet], part: tuple[float, float], step: float
) -> Iterator[tuple[float, float]]:
    """Parts on which no edge changes by more than ``step``."""
    changes = (np.ptp(_values(edge, part)) for x in there for edge in (x.right, x.left))
    low, high = part
    if high - low <= _SHORTEST or all(change <= step for change in changes):
        yield part
        return
    middle = round((low + high) / 2 * _MILLI) / _MILLI
    yield from _divided(there, (low, middle), step)
    yield from _divided(there, (middle, high), step)


def _strips(there: Sequence[MapLanelet], part: tuple[float, float], where: str) -> Iterator[_Strip]:
    """Lanelets side by side on a step, from right to left."""
    rights = [_values(x.right, part) for x in there]
    lefts = [_values(x.left, part) for x in there]
    right, left = ([_middle(x) for x in edges] for edges in (rights, lefts))
    for k in range(1, len(there)):
        gap = right[k] - left[k - 1]
        if abs(gap) <= _ONE_EDGE:
            right[k] = left[k - 1] = _middle(np.concatenate((lefts[k - 1], rights[k])))
        elif gap < 0:
            raise InputError(
                f"{where}: lanelets {there[k - 1].id} and {there[k].id} overlap by {float(-gap):.1f} m at "
                f"s = {part[0]:.0f} m; lanes side by side are needed"
            )
    s = _milli(part[0]), _milli(part[1])
    for k, x in enumerate(there):
        if right[k] + _NARROWEST <= left[k]:
            far = (np.abs(rights[k] - float(right[k])).max(), np.abs(lefts[k] - float(left[k])).max())
            yield _Strip(x, s, (right[k], left[k]), float(max(far)))


def _middle(values: Floats) -> Fraction:
    return _milli((float(values.min()) + float(values.max())) / 2)


def _milli(metres: float) -> Fraction:
    return Fraction(round(metres * _MILLI), _MILLI)
