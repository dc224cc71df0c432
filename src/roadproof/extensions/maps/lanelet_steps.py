"""Lanelets of a road as rectangles in s and d, from the bounds of measured ones along a reference line.

Edges are constant in steps, and lanelets side by side have one edge in common, in the middle of both of
theirs. The greatest distance between an edge and the bound that it stands for is told. Ends of lanelets that
are within a metre of each other are one place. Where two lanelets part or join, they may overlap: then the
place belongs to the one whose lane is longer, and the other one begins or ends beside it.
"""

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise

import numpy as np

from roadproof.errors import InputError
from roadproof.extensions.maps.carriageway import Carriageway
from roadproof.extensions.maps.lines import thinned, to_millimetre
from roadproof.extensions.maps.topology import Floats
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
_AROUND = 15.0
"""Metres before and after a place where the next point of a bound is looked for."""
_TURNED_BACK = 120.0
"""Degrees: a bound that turns by more at a point has a wrong point."""
_MILLI = 1000


@dataclass(frozen=True)
class MapLanelet:
    """``right``, ``left``: bounds as rows of s and d, s growing. ``lane``: a name that its lanelets have.

    ``lane_length`` in m. ``branches``: lanelets that it parts from at its beginning or joins at its end.
    """

    id: str
    lane: str
    attribute: Attribute
    zone: Zone
    right: Floats
    left: Floats
    lane_length: float = 0.0
    branches: frozenset[str] = frozenset()

    @property
    def ends(self) -> tuple[float, float]:
        """Return s of both ends, each midway between the ends of the bounds."""
        first, last = (float(self.right[k, 0] + self.left[k, 0]) / 2 for k in (0, -1))
        return first, last


@dataclass(frozen=True)
class _LaneletStrip:
    """A lanelet on a step from ``s[0]`` to ``s[1]``; ``error``: how far an edge is from its bound (m)."""

    lanelet: MapLanelet
    s: tuple[Fraction, Fraction]
    d: tuple[Fraction, Fraction]
    error: float


def edges_along(line: ReferenceLine, bound: Floats, begin: float, where: str) -> Floats:
    """A bound as rows of s and d. Raises ``InputError`` where it goes back along the line.

    ``begin``: where on the line the bound begins, roughly: points are looked for from there on, as the line
    may come near itself.
    """
    rows: list[tuple[float, float]] = []
    samples = np.array(line.samples)
    last, points = begin, thinned(bound, _SPACING)
    steps = np.hypot(*np.diff(points, axis=0, prepend=points[:1]).T)
    for (x, y), step in zip(points.tolist(), steps.tolist(), strict=True):
        last = min(max(last, float(line.begin)), float(line.end))
        ahead = samples[np.abs(samples[:, 0] - last) < 2 * step + _AROUND]
        near = int(np.argmin(np.hypot(ahead[:, 1] - x, ahead[:, 2] - y)))
        s, d = line.locate(x, y, float(ahead[near, 0]))
        last = s
        if rows and s < rows[-1][0] - _BACK:
            problem = f"at s = {s:.1f} m it goes back along the middle of the way by {rows[-1][0] - s:.1f} m"
            raise InputError(
                f"{where}: {problem}, {_cause(line, bound, s)}; lanes side by side are needed: "
                "name another way "
                "or cut the file"
            )
        if not rows or s > rows[-1][0]:
            rows.append((s, d))
    return np.array(rows)


def _cause(line: ReferenceLine, bound: Floats, s: float) -> str:
    """Return why a bound goes back along the line at ``s``."""
    step = np.diff(bound, axis=0)
    turns = np.abs(np.remainder(np.diff(np.arctan2(step[:, 1], step[:, 0])) + np.pi, 2 * np.pi) - np.pi)
    sharpest = float(np.degrees(turns.max(initial=0.0)))
    if sharpest > _TURNED_BACK:
        return f"as it turns by {sharpest:.0f} degrees at one of its points"
    near = (x.greatest for x in line.bends() if x.end > s - _AROUND and x.begin < s + _AROUND)
    return f"where the way has a radius of {1 / max(float(max(near, default=0)), 1e-3):.1f} m"


def lanelets_of(
    lanelets: Sequence[MapLanelet], way: Sequence[str], step: Fraction, where: str
) -> Carriageway:
    """Rectangles, their lanes called main-1, main-2, …, merge-1, … from the right. Raises ``InputError``.

    ``way``: ids of the lanelets on whose middle s is measured. ``step``: how much an edge changes at most on
    one of them (m). An id of several rectangles is ID.1, ID.2, ….
    """
    places = _places(lanelets, set(way))
    strips: list[_LaneletStrip] = []
    for begin, end in pairwise(sorted(set(places.values()))):
        there = [x for x in lanelets if places[x.ends[0]] <= begin and end <= places[x.ends[1]]]
        there.sort(key=lambda x: _between(x.right, begin, end) + _between(x.left, begin, end))
        divided = _divide(there, (begin, end), float(step))
        strips += _merge_steps([[*_strips(there, part, where)] for part in divided], step)
    counts, parts = Counter(x.lanelet.id for x in strips), Counter[str]()
    names, numbers = dict[str, str](), Counter[Attribute]()
    rectangles = []
    for x in strips:
        if x.lanelet.lane not in names:
            numbers[x.lanelet.attribute] += 1
            names[x.lanelet.lane] = f"{x.lanelet.attribute}-{numbers[x.lanelet.attribute]}"
        parts[x.lanelet.id] += 1
        name = x.lanelet.id if counts[x.lanelet.id] == 1 else f"{x.lanelet.id}.{parts[x.lanelet.id]}"
        lane = names[x.lanelet.lane]
        rectangles.append(Lanelet(name, lane, x.lanelet.zone, x.lanelet.attribute, x.s, x.d))
    error = max((x.error for x in strips), default=0.0)
    return Carriageway(tuple(rectangles), Fraction(-int(-error * _MILLI // 1), _MILLI))


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
    """Return d of an edge in the middle of a step."""
    return float(np.interp((begin + end) / 2, edge[:, 0], edge[:, 1]))


def _values(edge: Floats, part: tuple[float, float]) -> Floats:
    """Return d of an edge at the ends of a part and at its points between."""
    inside = edge[(edge[:, 0] > part[0]) & (edge[:, 0] < part[1]), 1]
    return np.concatenate((inside, np.interp(part, edge[:, 0], edge[:, 1])))


def _divide(
    there: Sequence[MapLanelet], part: tuple[float, float], step: float
) -> Iterator[tuple[float, float]]:
    """Parts on which no edge changes by more than ``step``."""
    changes = (np.ptp(_values(edge, part)) for x in there for edge in (x.right, x.left))
    low, high = part
    if high - low <= _SHORTEST or all(change <= step for change in changes):
        yield part
        return
    middle = round((low + high) / 2 * _MILLI) / _MILLI
    yield from _divide(there, (low, middle), step)
    yield from _divide(there, (middle, high), step)


def _strips(there: Sequence[MapLanelet], part: tuple[float, float], where: str) -> Iterator[_LaneletStrip]:
    """Lanelets side by side on a step, from right to left."""
    s = to_millimetre(part[0]), to_millimetre(part[1])
    beside: list[_Edges] = []
    for x in there:
        own_edges = _Edges(x, _values(x.right, part), _values(x.left, part))
        while beside and own_edges.gives_way_or_takes(beside[-1], where, part[0]):
            beside.pop()
        if own_edges.right < own_edges.left:
            beside.append(own_edges)
    for edges in beside:
        if edges.right + _NARROWEST <= edges.left:
            yield _LaneletStrip(edges.lanelet, s, (edges.right, edges.left), edges.error)


class _Edges:
    """The edges of a lanelet on a step, which those beside it move.

    ``rights``, ``lefts``: d of its bounds there. An edge that gave way to another lanelet has no error.
    """

    def __init__(self, lanelet: MapLanelet, rights: Floats, lefts: Floats) -> None:
        self.lanelet, self.rights, self.lefts = lanelet, rights, lefts
        self.right, self.left = _middle(rights), _middle(lefts)
        self.moved_right, self.moved_left = False, False

    @property
    def error(self) -> float:
        """Return how far (m) an edge is from its bound."""
        right = 0.0 if self.moved_right else float(np.abs(self.rights - float(self.right)).max())
        left = 0.0 if self.moved_left else float(np.abs(self.lefts - float(self.left)).max())
        return max(right, left)

    def gives_way_or_takes(self, other: "_Edges", where: str, s: float) -> bool:
        """Make edges meet with those of ``other`` to the right; whether nothing of the other one is left.

        Raises ``InputError`` where the two overlap though they neither part nor join.
        """
        gap = self.right - other.left
        if abs(gap) <= _ONE_EDGE:
            self.right = other.left = _middle(np.concatenate((other.lefts, self.rights)))
        elif gap < 0:
            one, two = other.lanelet, self.lanelet
            if two.id not in one.branches:
                raise InputError(
                    f"{where}: lanelets {one.id} and {two.id} overlap by {float(-gap):.1f} m at "
                    f"s = {s:.0f} m; lanes side by side are needed"
                )
            if one.lane_length < two.lane_length:
                other.left, other.moved_left = self.right, True
                return other.left <= other.right
            self.right, self.moved_right = other.left, True
        return False


def _merge_steps(parts: list[list[_LaneletStrip]], step: Fraction) -> list[_LaneletStrip]:
    """The strips of a step with those of a lanelet as one along which neither of its edges changes much.

    Every edge is constant for as long as it changes by no more than ``step``, so that lanelets side by side
    still have it in common. Where lanelets begin or end beside others, all remain as they are.
    """
    plain = [x for part in parts for x in part]
    if any([x.lanelet for x in part] != [x.lanelet for x in parts[0]] for part in parts):
        return plain
    rights, lefts = (
        [_level_runs([part[k].d[side] for part in parts], step) for k in range(len(parts[0]))]
        for side in (0, 1)
    )
    for n, part in enumerate(parts):
        for k in range(1, len(part)):
            apart, now = part[k].d[0] - part[k - 1].d[1], rights[k][n] - lefts[k - 1][n]
            if now < 0 or (now == 0) != (apart == 0):
                return plain
    strips: list[_LaneletStrip] = []
    for k, first in enumerate(parts[0]):
        edges = [*zip(rights[k], lefts[k], strict=True)]
        for n, d in enumerate(edges):
            x = parts[n][k]
            moved = max(abs(float(a - b)) for a, b in zip(x.d, d, strict=True))
            if n and edges[n - 1] == d:
                before = strips.pop()
                x = _LaneletStrip(first.lanelet, (before.s[0], x.s[1]), d, max(before.error, x.error + moved))
            else:
                x = _LaneletStrip(first.lanelet, x.s, d, x.error + moved)
            strips.append(x)
    return strips


def _level_runs(values: list[Fraction], step: Fraction) -> list[Fraction]:
    """Values with the middle of each run of them in which they differ by no more than ``step``."""
    evened: list[Fraction] = []
    run: list[Fraction] = []
    for value in values:
        if run and max(*run, value) - min(*run, value) > step:
            evened += [to_millimetre(float(min(run) + max(run)) / 2)] * len(run)
            run = []
        run.append(value)
    return evened + [to_millimetre(float(min(run) + max(run)) / 2)] * len(run) if run else evened


def _middle(values: Floats) -> Fraction:
    return to_millimetre((float(values.min()) + float(values.max())) / 2)
