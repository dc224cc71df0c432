"""The places of names of vehicles in pictures: beside their boxes, on no other name, and within the picture.

Pictures that move have a box for each instant. Between instants boxes move on straight lines, and no two
names meet there either. A name stays on its side of its box as long as that is free, then it jumps.
"""

from collections.abc import Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import NamedTuple, TypeAlias

from roadproof.extensions.pages.drive_data import Box
from roadproof.runtime.records import dataclass

Track: TypeAlias = Sequence[Box]
"""A box (left, right, low, high; px) at each instant, or one."""
Size: TypeAlias = tuple[float, float]
"""Width and height in px."""
_ON_NAME, _ON_VEHICLE, _JUMP = 1e6, 1e3, 8.0
"""Costs: of a step on another name, of a step on a vehicle, and of a jump."""
_FIXED, _PER_PIXEL = 12.0, 0.02
"""Costs of a step at a place that does not follow the vehicle, and of each px between the two."""
_GAP, _COLUMNS = 2.0, 16
NO_JUMPS: Mapping[int, Box] = MappingProxyType({})


class _Way(NamedTuple):
    """A box at the begin and at the end of a straight way, and the box around all of it."""

    begin: Box
    end: Box
    hull: Box


Ways: TypeAlias = Sequence[_Way]


@dataclass(frozen=True)
class PlacedLabel:
    """The place of a name at each instant, or the only one.

    ``is_inside``: whether it is within the box of its vehicle. ``before``: the place up to an instant at
    which the name jumps, by the number of the instant.
    """

    boxes: Track
    is_inside: bool
    before: Mapping[int, Box]


def place_labels(
    vehicles: Mapping[str, Track], sizes: Mapping[str, Size], within: Box, inside: bool = False
) -> dict[str, PlacedLabel]:
    """Return the place of the name of each vehicle: on no other name, and on no vehicle if there is room.

    ``sizes``: of names; ``within``: the part of the picture for names; ``inside``: whether a name may be in
    the box of its own vehicle. Names of vehicles that are further ahead at first have the first choice.
    """
    placed: dict[str, PlacedLabel] = {}
    for name in sorted(vehicles, key=lambda x: -vehicles[x][0][1]):
        names = [_ways(x.boxes, x.before) for x in placed.values()]
        others = [_ways(x) for other, x in vehicles.items() if other != name]
        own, size = vehicles[name], sizes[name]
        middle = [_box((x[0] + x[1] - size[0]) / 2, (x[2] + x[3] - size[1]) / 2, size) for x in own]
        if inside and all(map(_is_within, middle, own)) and not any(_costs(middle, names, others)):
            placed[name] = PlacedLabel(middle, True, {})
        else:
            placed[name] = _placed_beside(own, size, within, names, [_ways(own), *others])
    return placed


def _placed_beside(
    own: Track, size: Size, within: Box, names: Sequence[Ways], vehicles: Sequence[Ways]
) -> PlacedLabel:
    """Return the place of a name outside of the box of its vehicle at the least cost."""
    tracks = [*_beside(own, size, within)]
    costs = [[rank + x for x in _costs(track, names, vehicles)] for rank, track in enumerate(tracks)]
    if any(min(here) >= _ON_VEHICLE for here in zip(*costs, strict=True)):
        for track in _fixed(own, size, within):
            far = [_FIXED + _PER_PIXEL * _distance(track[0], box) for box in own]
            costs.append([a + b for a, b in zip(_costs(track, names, vehicles), far, strict=False)])
            tracks.append(track)
    chosen = _cheapest(costs)
    chosen += chosen[-1:] * (len(own) - len(chosen))
    boxes = [tracks[which][k] for k, which in enumerate(chosen)]
    jumps = [k for k in range(1, len(chosen)) if chosen[k] != chosen[k - 1]]
    return PlacedLabel(boxes, False, {k: tracks[chosen[k - 1]][k] for k in jumps})


def _beside(own: Track, size: Size, within: Box) -> Iterator[Track]:
    """Yield the places of a name that follows its vehicle, the best first, moved into the picture."""
    wide, high = size
    gap = _GAP + 0.1 * wide
    spots: list[list[tuple[float, float]]] = [
        [(right + gap, (low + top - high) / 2) for _, right, low, top in own],
        [(left - gap - wide, (low + top - high) / 2) for left, _, low, top in own],
    ]
    for row in range(3):
        away = row * high + 1
        spots.append([((left + right - wide) / 2, low - away - high) for left, right, low, _ in own])
        spots.append([((left + right - wide) / 2, top + away) for left, right, _, top in own])
    for places in spots:
        yield [
            _box(
                min(max(x, within[0]), within[1] - wide),
                min(max(y, within[2]), within[3] - high),
                size,
            )
            for x, y in places
        ]


def _fixed(own: Track, size: Size, within: Box) -> Iterator[Track]:
    """Yield places that are the same at all instants, in rows and columns over the picture."""
    wide, high = size
    rows = max(1, int((within[3] - within[2]) / high))
    for row in range(rows):
        y = within[2] + (within[3] - within[2] - high) * row / max(1, rows - 1)
        for column in range(_COLUMNS):
            x = within[0] + (within[1] - within[0] - wide) * column / (_COLUMNS - 1)
            yield [_box(x, y, size)] * len(own)


def _cheapest(costs: Sequence[Sequence[float]]) -> list[int]:
    """Return the track of each step at the least cost, jumps included; ``costs``: by track and step."""
    total, came = [row[0] for row in costs], list[list[int]]()
    for step in range(1, len(costs[0])):
        best = min(range(len(total)), key=total.__getitem__)
        stay = [x <= total[best] + _JUMP for x in total]
        came.append([k if stays else best for k, stays in enumerate(stay)])
        total = [min(x, total[best] + _JUMP) + costs[k][step] for k, x in enumerate(total)]
    chosen = [min(range(len(total)), key=total.__getitem__)]
    for before in reversed(came):
        chosen.append(before[chosen[-1]])
    return chosen[::-1]


def _costs(track: Track, names: Sequence[Ways], vehicles: Sequence[Ways]) -> Iterator[float]:
    """Yield the cost of each step of a name: from an instant to the next, or at the only one."""
    for step, way in enumerate(_ways(track)):
        on_names = sum(_meet(way, x[step]) for x in names)
        yield _ON_NAME * on_names + _ON_VEHICLE * sum(_meet(way, x[step]) for x in vehicles)


def _ways(track: Track, before: Mapping[int, Box] = NO_JUMPS) -> Ways:
    """Return the ways of a box from each instant to the next; ``before``: the ends of some."""
    if len(track) == 1:
        return [_Way(track[0], track[0], track[0])]
    ends = (before.get(k, track[k]) for k in range(1, len(track)))
    return [_Way(a, b, _hull(a, b)) for a, b in zip(track[:-1], ends, strict=True)]


def _hull(one: Box, other: Box) -> Box:
    left, right = min(one[0], other[0]), max(one[1], other[1])
    return left, right, min(one[2], other[2]), max(one[3], other[3])


def _meet(one: _Way, other: _Way) -> bool:
    """Return whether two boxes overlap at any time on their ways."""
    if not boxes_meet(one.hull, other.hull):
        return False
    a, b, c, d = one.begin, other.begin, one.end, other.end
    since, until = 0.0, 1.0
    for begin, end in (
        (b[1] - a[0], d[1] - c[0]),
        (a[1] - b[0], c[1] - d[0]),
        (b[3] - a[2], d[3] - c[2]),
        (a[3] - b[2], c[3] - d[2]),
    ):
        if begin <= 0 and end <= 0:
            return False
        if begin <= 0:
            since = max(since, begin / (begin - end))
        elif end <= 0:
            until = min(until, begin / (begin - end))
    return since < until


def boxes_meet(one: Box, other: Box) -> bool:
    """Return whether two boxes overlap."""
    return one[0] < other[1] and other[0] < one[1] and one[2] < other[3] and other[2] < one[3]


def _is_within(one: Box, other: Box) -> bool:
    return other[0] <= one[0] and one[1] <= other[1] and other[2] <= one[2] and one[3] <= other[3]


def _distance(one: Box, other: Box) -> float:
    x = (one[0] + one[1] - other[0] - other[1]) / 2
    y = (one[2] + one[3] - other[2] - other[3]) / 2
    return abs(x) + abs(y)


def _box(x: float, y: float, size: Size) -> Box:
    return x, x + size[0], y, y + size[1]
