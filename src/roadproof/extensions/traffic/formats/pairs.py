"""The pairs and triples of vehicles to evaluate: those of one driving direction.

The pre-filter keeps every pair that may violate the RSS distance; what it drops provably does not.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Self

import numpy as np

from roadproof.extensions.traffic.formats.clock import samples_in
from roadproof.extensions.traffic.formats.recording import Bools, Floats, Integers, Masks, Recording, offsets
from roadproof.library.scenario_names import PAIR, TRIPLE


class _Columns:
    """Columns of equal length, the fields of a dataclass."""

    def __len__(self) -> int:
        return len(next(iter(vars(self).values())))

    def choose(self, selected: Bools | Integers | slice) -> Self:
        """The rows at ``selected``: a mask, indices or a slice."""
        if isinstance(selected, np.ndarray) and selected.dtype == np.bool_:
            selected = np.flatnonzero(selected)  # several times as fast as the mask
        if isinstance(selected, slice):
            return type(self)(*(column[selected] for column in vars(self).values()))
        return type(self)(*(column.take(selected) for column in vars(self).values()))


@dataclass(frozen=True)
class Pairs(_Columns):
    """Unordered pairs of vehicle indices, ``first`` < ``second``, and their common frames low … high."""

    first: Integers
    second: Integers
    low: Integers
    high: Integers

    @property
    def samples(self) -> Integers:
        """Return how many common frames each pair has."""
        return self.high - self.low + 1

    @property
    def vehicles(self) -> dict[str, Integers]:
        """The vehicles of each pair by the names that they have in formulas."""
        return dict(zip(PAIR, (self.first, self.second), strict=True))


@dataclass(frozen=True)
class RssParameters:
    """The parameters of RSS distances (SI units; paper eqs. lon_RSS and lat_RSS)."""

    rho: float
    a_max: float
    b_min: float
    b_max: float
    a_max_lat: float
    b_min_lat: float


@dataclass(frozen=True)
class DetectionRange:
    """The range of the detectors of earlier works: time to collision and headway (s), distance (m)."""

    ttc: float
    thw: float
    farthest: float


def common_pairs(recording: Recording, eligible: Bools) -> Pairs:
    """All unordered pairs of eligible vehicles of one direction that share a frame.

    ``eligible`` has one entry a vehicle. Pairs come in order of (first, second).
    """
    chosen = np.flatnonzero(eligible)
    ways = np.unique(recording.direction) if recording.vehicles else np.zeros(1, np.int64)
    made = [_meeting(recording, chosen[recording.direction[chosen] == way]) for way in ways]
    one, other = (np.concatenate([m[k] for m in made]) for k in (0, 1))
    first, second = np.minimum(one, other), np.maximum(one, other)
    order = np.lexsort((second, first))
    first, second = first[order], second[order]
    last_frame = recording.last_frame
    low = np.maximum(recording.first_frame[first], recording.first_frame[second])
    return Pairs(first, second, low, np.minimum(last_frame[first], last_frame[second]))


def _meeting(recording: Recording, vehicles: Integers) -> tuple[Integers, Integers]:
    """Return the pairs of vehicles on the road at one time, in order of entry."""
    vehicles = vehicles[np.argsort(recording.first_frame[vehicles], kind="stable")]
    entry = recording.first_frame[vehicles]
    place = np.arange(len(vehicles))
    count = np.searchsorted(entry, recording.last_frame[vehicles], side="right") - place - 1
    one = np.repeat(place, count)
    other = one + 1 + np.arange(len(one)) - np.repeat(offsets(count)[:-1], count)
    return vehicles[one], vehicles[other]


@dataclass(frozen=True)
class Moments(_Columns):
    """Moments of pairs: of the pair at index ``pair`` at ``frame``, the samples ``first`` and ``second``."""

    pair: Integers
    frame: Integers
    first: Integers
    second: Integers


def all_moments(recording: Recording, pairs: Pairs, samples: int = 300_000) -> Iterator[Moments]:
    """All common frames of all pairs, in order of pairs and frames, in parts of about so many."""
    for part in _parts(pairs, samples):
        chosen = pairs.choose(part)
        yield _moments(recording, pairs, part.start + np.arange(len(chosen)), chosen.low, chosen.high)


def near_moments(
    recording: Recording, pairs: Pairs, reach: RssParameters, samples: int = 1_000_000
) -> Iterator[Moments]:
    """The moments at which a pair is near enough, along and across, for an RSS violation.

    In order of pairs and frames, in parts that come from about so many ``samples``. Proof that no violation
    is lost. One needs, in one frame, a longitudinal and a lateral violation. Time is cut into pieces that are
    the same for all vehicles, and extremes below are those of a vehicle in the piece of the frame.
    Longitudinal, for the one in front f and the one behind r: 0 <= s_f - s_r <= length_f +
    dRSS_lon(v_r, v_f). Let V be the greatest |v_lon| of r in the piece and m the least |v_lon| of f.
    With rho, a_max >= 0 and b_min, b_max > 0: v_r·rho <= V·rho, (v_r + a_max·rho)² <=
    (V + a_max·rho)² and v_f² >= m², so dRSS_lon(v_r, v_f) is at most the same expression in V and m,
    whatever the signs of the speeds.
    Lateral, for the left one a and the right one b: 0 <= d_a - d_b <= width_a + dRSS_lat(v_1, v_2),
    where |v_1| and |v_2| are the lateral speeds. With U the greatest |v_lat| of either in the piece,
    (v_1 - v_2)·rho <= 2·U·rho and both squares are at most (U + rho·a_max_lat)², in either reading
    of the signs and with or without the squares of ``lateral_rss = signed``.
    These bounds are compared with the least distances in the piece, and in the pieces that are left with
    the distances in each frame. They are widened by a millimetre, far more than the rounding of doubles in
    these sums, which stays below a micrometre for roads up to a thousand kilometres.
    """
    if not (
        min(reach.rho, reach.a_max, reach.a_max_lat) >= 0
        and min(reach.b_min, reach.b_max, reach.b_min_lat) > 0
    ):
        raise ValueError("the bound holds for rho, a_max >= 0 and b_min, b_max > 0, lateral ones alike")
    if len(pairs):
        pieces = _pieces_of(recording, samples_in(recording.rate), reach)
        for part in _parts(pairs, samples):
            yield _near(recording, pieces, pairs, part)


@dataclass(frozen=True)
class _Pieces:
    """Extremes of each vehicle in pieces of ``frames`` frames, one after the other, vehicle by vehicle.

    Frame f of vehicle v is in the piece at ``shift[v] + f // frames``. Bounds on RSS distances are the sum of
    ``stopping`` of the one behind and ``braking`` of the one in front, and the greater ``aside`` of both.
    """

    frames: int
    shift: Integers
    s: tuple[Floats, Floats]
    d: tuple[Floats, Floats]
    stopping: Floats
    braking: Floats
    aside: Floats
    length: Floats
    width: Floats


def _pieces_of(recording: Recording, frames: int, reach: RssParameters) -> _Pieces:
    begin, end = recording.first_frame // frames, recording.last_frame // frames
    counts = end - begin + 1
    shift = offsets(counts)[:-1] - begin
    vehicle = np.repeat(np.arange(recording.vehicles), counts)
    earliest = (np.arange(len(vehicle)) - shift[vehicle]) * frames
    first_frame = recording.first_frame[vehicle]
    rows = recording.start[:-1][vehicle] + np.maximum(earliest, first_frame) - first_frame

    def extremes(values: Floats) -> tuple[Floats, Floats]:
        return np.minimum.reduceat(values, rows), np.maximum.reduceat(values, rows)

    (least, most), (right, left) = extremes(recording.v_lon), extremes(recording.v_lat)
    return _Pieces(
        frames,
        shift,
        extremes(recording.s),
        extremes(recording.d),
        stopping=_stopping(reach, np.maximum(-least, most)),
        braking=-(np.maximum(0, np.maximum(least, -most)) ** 2 / (2 * reach.b_max)),
        aside=_aside(reach, np.maximum(-right, left)),
        length=recording.length[vehicle],
        width=recording.width[vehicle],
    )


def _near(recording: Recording, pieces: _Pieces, pairs: Pairs, part: slice) -> Moments:
    """The near moments of the pairs of a slice: first piece by piece, then frame by frame."""
    chosen = pairs.choose(part)
    begin, end = chosen.low // pieces.frames, chosen.high // pieces.frames
    pair, piece = _spread(begin, end)
    first, second = (pieces.shift.take(x).take(pair) + piece for x in (chosen.first, chosen.second))
    for (least, most), bounds in ((pieces.s, _along), (pieces.d, _across)):
        below, above = bounds(pieces, first, second)
        ahead, behind = least.take(second) - most.take(first), least.take(first) - most.take(second)
        near = np.flatnonzero((ahead <= above) & (behind <= below))
        pair, piece, first, second = (x.take(near) for x in (pair, piece, first, second))
    low = np.maximum(chosen.low.take(pair), piece * pieces.frames)
    high = np.minimum(chosen.high.take(pair), piece * pieces.frames + (pieces.frames - 1))
    moments = _moments(recording, pairs, part.start + pair, low, high)
    counts = high - low + 1
    inside = np.ones(len(moments), bool)
    for position, bounds in ((recording.s, _along), (recording.d, _across)):
        below, above = bounds(pieces, first, second)
        apart = position.take(moments.second) - position.take(moments.first)
        inside &= apart <= np.repeat(above, counts)
        inside &= apart >= np.repeat(-below, counts)
    return moments.choose(inside)


def _spread(low: Integers, high: Integers) -> tuple[Integers, Integers]:
    """Return each whole number from ``low`` to ``high`` of each entry, with the index of the entry."""
    counts = high - low + 1
    place = np.repeat(np.arange(len(low)), counts)
    return place, np.arange(len(place)) + np.repeat(low - offsets(counts)[:-1], counts)


def _moments(recording: Recording, pairs: Pairs, pair: Integers, low: Integers, high: Integers) -> Moments:
    """The moments ``low`` … ``high`` of the pairs at ``pair``."""
    place, frame = _spread(low, high)
    shift = recording.start[:-1] - recording.first_frame
    first, second = (frame + shift.take(x.take(pair)).take(place) for x in (pairs.first, pairs.second))
    return Moments(pair.take(place), frame, first, second)


def pairs_in_sight(recording: Recording, pairs: Pairs, sight: DetectionRange) -> tuple[Pairs, Masks]:
    """The pairs that a bundled detector may match, and for each the lanes in which it may (bits).

    Every one of them needs a frame in which both are in L and the gap from the front of one to the
    rear of the other is at most ``farthest``, ``thw``·v_lon of the rear one, or ``ttc`` times the
    difference of the speeds; with the greatest speed of the rear and the least of the front, all are
    bounds that depend on the pair only. They are widened by a millimetre, as in near_moments.
    """
    greatest = np.maximum.reduceat(recording.v_lon, recording.start[:-1])
    least = np.minimum.reduceat(recording.v_lon, recording.start[:-1])

    def bound(rear: Integers, front: Integers) -> Floats:
        closing = sight.ttc * (greatest[rear] - least[front])
        gap = np.maximum.reduce([closing, sight.thw * greatest[rear], np.full(len(rear), sight.farthest)])
        total: Floats = gap + recording.length[front] + 0.001
        return total

    tests = [DistanceBounds(recording.s, bound(pairs.second, pairs.first), bound(pairs.first, pairs.second))]
    shared = np.zeros(len(pairs), np.uint32)
    in_sight = ever_within(recording, pairs, tests, shared)
    return pairs.choose(in_sight), shared[in_sight]


@dataclass(frozen=True)
class DistanceBounds:
    """-below <= position of second - position of first <= above; bounds have one entry a pair."""

    position: Floats
    below: Floats
    above: Floats


def _along(pieces: _Pieces, first: Integers, second: Integers) -> tuple[Floats, Floats]:
    """Return how far ``second`` may be behind ``first`` for a longitudinal violation, and how far ahead of
    it.
    """
    return _bound_along(pieces, second, first), _bound_along(pieces, first, second)


def _across(pieces: _Pieces, first: Integers, second: Integers) -> tuple[Floats, Floats]:
    """Return how far ``second`` may be right and left of ``first`` for a lateral violation."""
    bound = _bound_across(pieces, first, second)
    return bound + pieces.width.take(first), bound + pieces.width.take(second)


def _bound_along(pieces: _Pieces, rear: Integers, front: Integers) -> Floats:
    distance = np.maximum(0, pieces.stopping.take(rear) + pieces.braking.take(front))
    total: Floats = distance + 0.001 + pieces.length.take(front)
    return total


def _bound_across(pieces: _Pieces, first: Integers, second: Integers) -> Floats:
    bound: Floats = np.maximum(pieces.aside.take(first), pieces.aside.take(second))
    return bound


def _stopping(reach: RssParameters, greatest: Floats) -> Floats:
    braking = (greatest + reach.a_max * reach.rho) ** 2 / (2 * reach.b_min)
    way: Floats = greatest * reach.rho + reach.a_max * reach.rho**2 / 2
    return way + braking


def _aside(reach: RssParameters, greatest: Floats) -> Floats:
    braking = 2 * (greatest + reach.rho * reach.a_max_lat) ** 2 / (2 * reach.b_min_lat)
    return 2 * greatest * reach.rho + reach.a_max_lat * reach.rho**2 + braking + 0.001


def ever_within(
    recording: Recording, pairs: Pairs, tests: list[DistanceBounds], shared: Masks | None = None
) -> Bools:
    """Return for each pair whether all ``tests`` hold in one common frame.

    With ``shared`` (one entry a pair), both boxes must be in a common lane in that frame, and the
    lanes where that ever is so are written to it.
    """
    within = np.zeros(len(pairs), bool)
    for part in _parts(pairs, 500_000):
        chosen = pairs.choose(part)
        counts = chosen.samples
        begin = offsets(counts)[:-1]
        rows = np.arange(int(counts.sum()))
        first = rows + np.repeat(row_of(recording, chosen.first, chosen.low) - begin, counts)
        second = rows + np.repeat(row_of(recording, chosen.second, chosen.low) - begin, counts)
        inside = np.ones(len(rows), bool)
        for test in tests:
            apart = test.position.take(second) - test.position.take(first)
            inside &= apart <= np.repeat(test.above[part], counts)
            inside &= apart >= np.repeat(-test.below[part], counts)
        if shared is not None:
            lanes = np.where(inside, recording.occupancy[first] & recording.occupancy[second], 0)
            shared[part] = np.bitwise_or.reduceat(lanes, begin)
            inside &= lanes != 0
        within[part] = np.logical_or.reduceat(inside, begin)
    return within


def row_of(recording: Recording, vehicle: Integers, frame: Integers) -> Integers:
    """The sample of each vehicle at each frame."""
    return recording.start[vehicle] + frame - recording.first_frame[vehicle]


def _parts(pairs: Pairs, samples: int) -> Iterator[slice]:
    """Slices of the pairs, each of about so many samples."""
    ends = np.cumsum(pairs.samples)
    begin = 0
    while begin < len(pairs):
        done = ends[begin - 1] if begin else 0
        end = max(begin + 1, int(np.searchsorted(ends, done + samples, side="right")))
        yield slice(begin, end)
        begin = end


@dataclass(frozen=True)
class Triples(_Columns):
    """Ordered triples for scenario 2: SV, the first POV and the second, common frames low … high."""

    sv: Integers
    pov1: Integers
    pov2: Integers
    low: Integers
    high: Integers

    @property
    def vehicles(self) -> dict[str, Integers]:
        """The vehicles of each triple by the names that they have in formulas."""
        return dict(zip(TRIPLE, (self.sv, self.pov1, self.pov2), strict=True))


def triples_of(recording: Recording, endangered: Pairs, meeting: Pairs) -> Triples:
    """Every way to extend an endangered pair, in both orders, by a third vehicle.

    SV and POV2 are the endangered pair; POV1 is any vehicle that ``meeting`` says shares frames with
    SV, and all three have a frame in common. Vehicles of ``meeting`` are those of common_pairs.
    """
    sv = np.concatenate((endangered.first, endangered.second))
    pov2 = np.concatenate((endangered.second, endangered.first))
    low, high = np.tile(endangered.low, 2), np.tile(endangered.high, 2)
    one = np.concatenate((meeting.first, meeting.second))
    other = np.concatenate((meeting.second, meeting.first))[np.argsort(one, kind="stable")]
    begin = offsets(np.bincount(one, minlength=recording.vehicles))
    count = np.diff(begin)[sv]
    pair = np.repeat(np.arange(len(sv)), count)
    within = np.arange(len(pair)) - np.repeat(offsets(count)[:-1], count)
    pov1 = other[begin[sv[pair]] + within]
    last_frame = recording.last_frame
    triples = Triples(
        sv[pair],
        pov1,
        pov2[pair],
        np.maximum(low[pair], recording.first_frame[pov1]),
        np.minimum(high[pair], last_frame[pov1]),
    )
    return triples.choose((triples.low <= triples.high) & (triples.pov1 != triples.pov2))
