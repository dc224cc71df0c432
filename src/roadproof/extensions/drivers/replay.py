"""A driver model put into a drive: SV moves as in the test until the model responds, then as it prescribes.

The result is an exact drive, which the judge decides. POV and the road are those of the test. From the start
of the scenario on SV's own braking is left out: it is the answer of another driver.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import cached_property
from itertools import pairwise
from math import ceil, isqrt

from roadproof.extensions.drivers.driver_settings import DriverSettings
from roadproof.extensions.drivers.fuzzy import HERTZ
from roadproof.extensions.drivers.fuzzy_looks import LONGEST, Sight, controlled, known_from
from roadproof.extensions.drivers.lanes import Across, VehicleBox, across
from roadproof.extensions.drivers.manoeuvres import ManoeuvreName
from roadproof.extensions.drivers.models import driver_model, passed
from roadproof.extensions.drivers.outcome import Outcome, Result
from roadproof.extensions.drivers.response import Phase
from roadproof.library.elaborate import read_claim
from roadproof.library.specification import Specification
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula
from roadproof.reasons import ReasonKind
from roadproof.runtime.records import dataclass
from roadproof.semantics.exact.algebraic import as_float
from roadproof.semantics.exact.judging import judge
from roadproof.semantics.exact.truth import Cut, TruthSet
from roadproof.world.drive import Drive, Motion, Piece
from roadproof.world.motion import each_state, piece_starts, state_at, states_at
from roadproof.world.road import Road

_FINE = 10**6  # parts of a second: instants that are no fraction are taken so much later at most
_METRES, _SPEED, _ACCELERATION = (1, 0), (1, -1), (1, -2)
_NONE = Fraction(0)
_MOMENT = Fraction(1, 1000)  # s before it stands: there a vehicle loses its speed across


@dataclass(frozen=True)
class Replayed:
    """The drive of SV under a model, None where it cannot be made, and what becomes of it."""

    outcome: Outcome
    drive: Drive | None = None


def replay(
    drive: Drive,
    road: Road,
    vehicles: tuple[str, ...],
    manoeuvre: ManoeuvreName,
    model: str,
    since: Fraction,
    home: Specification,
    settings: DriverSettings,
) -> Replayed:
    """Replace the motion of SV from ``since`` (s) on, when the scenario holds, by the response of a model.

    ``vehicles``: SV first, the vehicle that it may hit last. ``home`` has the definitions of driver models.
    """
    me = vehicles[0]
    drive = replace(drive, vehicles={**drive.vehicles, me: unbraked(drive.vehicles[me], since)})
    scene = DriveScene(drive, road, vehicles, since)
    law = driver_model(model).law
    if law is None:
        onset, phases = _looked(scene, manoeuvre)
    else:
        response = law.respond(manoeuvre, scene, settings)
        onset, phases = (None, []) if response is None else (response.onset, [*response.phases])
    driven = drive
    if onset is not None:
        mine = driven_from(drive.vehicles[me], onset, phases)
        driven = replace(drive, vehicles={**drive.vehicles, me: mine})
    latest = since + LONGEST if law is None else None
    outcome = _judged(driven, vehicles, since, latest, home)
    return Replayed(replace(outcome, onset=None if onset is None else float(onset)), driven)


@dataclass(frozen=True)
class DriveScene:
    """A drive as a ``Scene``: the judge says when a condition holds first, exactly."""

    drive: Drive
    road: Road
    vehicles: tuple[str, ...]
    start: Fraction

    @cached_property
    def across(self) -> Across:
        """Return where SV and the first POV begin across the road."""
        me, other = (self._box(name) for name in self.vehicles[:2])
        return across(self.road, me, other, len(self.vehicles) == 2)

    def _box(self, name: str) -> VehicleBox:
        motion, now = self.drive.vehicles[name], state_at(self.drive.vehicles[name], self.start)
        return VehicleBox(now.s, now.d, motion.length, motion.width)

    def offset(self, metres: Fraction) -> Fraction | None:
        here, other = self.across, self.vehicles[1]
        middle = self.drive.vehicles[other].width / 2
        right, left = here.centre - metres + middle, here.centre + metres + middle
        to_the_right = _compare(t.Signal("d", other), "<=", right)
        to_the_left = _compare(t.Signal("d", other), ">=", left)
        if len(self.vehicles) > 2:  # it leaves the lane, to either side
            return self.first(f.disjunction(to_the_right, to_the_left))
        return self.first(to_the_right if here.side > 0 else to_the_left)

    def beside(self) -> Fraction | None:
        return self.first(self.in_way)

    def past_marking(self, metres: Fraction) -> Fraction | None:
        here, other = self.across, self.vehicles[1]
        if here.side > 0:
            reach = here.marking - metres + self.drive.vehicles[other].width
            return self.first(_compare(t.Signal("d", other), "<=", reach))
        return self.first(_compare(t.Signal("d", other), ">=", here.marking + metres))

    def wrapped(self) -> Fraction | None:
        me, other = self.vehicles[:2]
        wide = [self.drive.vehicles[x].width for x in (me, other)]
        inner, outer = (other, me) if wide[1] <= wide[0] else (me, other)
        room = abs(wide[0] - wide[1])
        apart = t.subtract(t.Signal("d", outer), t.Signal("d", inner))
        return self.first(f.conjunction(_compare(apart, ">=", _NONE), _compare(apart, "<=", room)))

    def closing(self, seconds: Fraction, since: Fraction) -> Fraction | None:
        me, other = self.vehicles[:2]
        faster = t.subtract(t.Signal("v_lon", me), t.Signal("v_lon", other))
        reach = t.Product((t.number(seconds, (0, 1)), faster))
        near = f.Compare(t.subtract(self._gap, reach), "<=", t.number(0, _METRES))
        return self.first(f.conjunction(near, _compare(faster, ">", _NONE, _SPEED)), since)

    def braking(self, least: Fraction) -> Fraction | None:
        other = self.vehicles[1]
        slows = _compare(t.Signal("a_lon", other), "<=" if least else "<", -least, _ACCELERATION)
        ahead = f.Compare(self._gap, ">=", t.number(0, _METRES))
        return self.first(f.conjunction(slows, ahead, self.in_way))

    @property
    def _gap(self) -> t.Term:
        me, other = self.vehicles[:2]
        rear = t.subtract(t.Signal("s", other), t.Size("length", other))
        return t.subtract(rear, t.Signal("s", me))

    @property
    def in_way(self) -> Formula:
        me, other = self.vehicles[0], self.vehicles[1]
        pairs = ((me, other), (other, me))
        return f.conjunction(
            *(
                f.Compare(t.Signal("d", a), ">=", t.subtract(t.Signal("d", b), t.Size("width", b)))
                for a, b in pairs
            )
        )

    def first(self, condition: Formula, since: Fraction | None = None) -> Fraction | None:
        """Return the first instant from ``since`` on at which a condition about states holds."""
        begin = self.start if since is None else since
        cut = first_cut(judge(condition, self.drive).truth(condition), begin)
        return None if cut is None else _at_or_after(cut)


def first_cut(truth: TruthSet, begin: Fraction) -> Cut | None:
    """Return the first cut from ``begin`` on at which something is true."""
    if truth.at(begin):
        return Cut(begin, False)
    return next((x.begin for x in truth.spans() if x.begin.point >= begin), None)


def _at_or_after(cut: Cut) -> Fraction:
    """Return a cut's instant; one that is no fraction is taken at most a microsecond later."""
    if isinstance(cut.point, Fraction):
        return cut.point
    return Fraction(ceil(as_float(cut.point) * _FINE) + 1, _FINE)


def _compare(left: t.Term, op: f.Comparison, right: Fraction, dimension: t.Dimension = _METRES) -> Formula:
    return f.Compare(left, op, t.number(right, dimension))


# --- motions --------------------------------------------------------------------------------------


def unbraked(motion: Motion, since: Fraction) -> Motion:
    """Return a motion without the pieces that brake from ``since`` on: there the speed stays what it is."""
    starts = piece_starts(motion)
    times = sorted({x.time for x in starts} | {since})
    pieces: list[Piece] = []
    for begin, end in pairwise([*times, None]):
        assert begin is not None
        now = state_at(motion, begin)
        duration = None if end is None else end - begin
        last = now.a_lon + (now.j_lon * duration if duration is not None else 0)
        brakes = begin >= since and min(now.a_lon, last) < 0
        a_lon, j_lon = (_NONE, _NONE) if brakes else (now.a_lon, now.j_lon)
        pieces.append(Piece(duration, a_lon, now.a_lat, j_lon))
    return replace(motion, pieces=tuple(pieces))


def driven_from(motion: Motion, onset: Fraction, phases: Sequence[Phase]) -> Motion:
    """Return a motion that is as before until ``onset``, and then has these phases along until it stands.

    Across the road it is as before until it stands, and then it moves no more.
    """
    starts, speed, time = piece_starts(motion), state_at(motion, onset).v_lon, onset
    along = {x.time: (x.a_lon, x.j_lon) for x in starts if x.time < onset}
    for lasts, acceleration, jerk in until_it_stands(speed, phases):
        along[time] = acceleration, jerk
        time += lasts
        speed += acceleration * lasts + jerk * lasts**2 / 2
    along[time] = _NONE, _NONE
    stands = speed == 0
    knots = {*along, *(x.time for x in starts if x.time >= onset and not (stands and x.time > time))}
    drift = state_at(motion, time).v_lat
    if stands and drift and time > onset:
        knots.add(max(onset, time - _MOMENT))
    pieces: list[Piece] = []
    begin, (acceleration, jerk) = onset, along[min(along)]
    times = sorted(knots)
    for now, end in zip(states_at(motion, times), [*times[1:], None], strict=True):
        if now.time in along:
            begin, (acceleration, jerk) = now.time, along[now.time]
        a_lat = _NONE if end is None and stands else now.a_lat
        duration = None if end is None else end - now.time
        pieces.append(Piece(duration, acceleration + jerk * (now.time - begin), a_lat, jerk))
    made = replace(motion, pieces=tuple(pieces))
    return _at_rest_across(made) if stands else made


def _at_rest_across(motion: Motion) -> Motion:
    """Return the motion with no speed across left at its end: it is lost in the last moment before."""
    last = piece_starts(motion)[-1]
    if last.v_lat == 0 or len(motion.pieces) < 2:
        return motion
    *before, piece, rest = motion.pieces
    assert piece.duration is not None
    change = replace(piece, a_lat=piece.a_lat - last.v_lat / piece.duration)
    return replace(motion, pieces=(*before, change, rest))


def until_it_stands(
    speed: Fraction, phases: Sequence[Phase]
) -> Iterator[tuple[Fraction, Fraction, Fraction]]:
    """Yield the phases up to the instant at which a vehicle stands, which is exact where braking is constant.

    Where it stands while braking grows, the last nanometres per second are lost at constant braking.
    """
    for duration, acceleration, jerk in phases:
        stop = _stop(speed, acceleration, jerk)
        if speed <= 0:
            return
        if stop is not None and (duration is None or stop <= duration):
            if stop > 0:
                yield stop, acceleration, jerk
            left = speed + acceleration * stop + jerk * stop**2 / 2
            braking = -(acceleration + jerk * stop)
            if left > 0:
                yield left / braking, -braking, _NONE
            return
        if duration is None:
            return
        yield duration, acceleration, jerk
        speed += acceleration * duration + jerk * duration**2 / 2


def _stop(speed: Fraction, acceleration: Fraction, jerk: Fraction) -> Fraction | None:
    """Return when the speed is lost, or at most so much earlier that it is positive; None for never."""
    if jerk == 0:
        return -speed / acceleration if acceleration < 0 else None
    square = acceleration**2 - 2 * jerk * speed
    if square < 0 or jerk > 0:
        return None  # braking that is released does not stop a vehicle here
    scale = 10**18
    root = Fraction(isqrt(int(square * scale**2)), scale)  # rounded down: it stands a little later
    return max(_NONE, (root + acceleration) / -jerk)


# --- the judge ------------------------------------------------------------------------------------


def _judged(
    drive: Drive, vehicles: tuple[str, ...], since: Fraction, latest: Fraction | None, home: Specification
) -> Outcome:
    """Return what the judge says of a drive: whether SV touches the last vehicle before it has passed it.

    Nothing is claimed of what comes after ``latest``, where that is not None.
    """
    me, last = vehicles[0], vehicles[-1]
    touching = read_claim(home, f"touches({me}, {last})").formula
    passing = read_claim(home, passed(vehicles)).formula
    judgement = judge(f.conjunction(touching, passing), drive)
    touch, past = (first_cut(judgement.truth(x), since) for x in (touching, passing))
    if touch is not None and (past is None or touch <= past):
        if latest is not None and touch.point > latest:
            return Outcome(Result.UNDECIDED, reason=ReasonKind.TOO_LONG(LONGEST), is_late=True)
        at = _at_or_after(touch)
        mine, its = (state_at(drive.vehicles[x], at) for x in (me, last))
        speed = round(float(mine.v_lon - its.v_lon), 2)
        return Outcome(Result.COLLIDES, instant=round(float(at), 3), speed=speed)
    if past is not None:
        return Outcome(Result.UNDECIDED, reason=ReasonKind.PASSED_BY(round(as_float(past.point), 2)))
    return Outcome(Result.PREVENTED, gap=least_gap(drive, (me, last), since))


def least_gap(drive: Drive, pair: tuple[str, str], since: Fraction) -> float | None:
    """Return the least distance along the road while the boxes overlap across it; None if they never do (m).

    It is looked for at knots, where the speeds are equal, and where the overlap begins or ends.
    """
    me, other = pair
    way, speeds = (
        DriveScene(drive, Road("", (), frozenset()), pair, since).in_way,
        _compare(t.subtract(t.Signal("v_lon", me), t.Signal("v_lon", other)), ">", _NONE, _SPEED),
    )
    judgement = judge(f.conjunction(way, speeds), drive)
    beside = judgement.truth(way)
    knots = {x.time for name in pair for x in piece_starts(drive.vehicles[name])}
    ends = (cut for truth in (beside, judgement.truth(speeds)) for cut in truth.cuts)
    times = {since, *knots, *(_at_or_after(x) for x in ends)}
    looked = sorted(x for x in times if x >= since and beside.at(x))
    mine, its = (states_at(drive.vehicles[x], looked) for x in pair)
    gaps = [b.s - drive.vehicles[other].length - a.s for a, b in zip(mine, its, strict=True)]
    return round(float(min(gaps)), 2) if gaps else None


# --- controllers ----------------------------------------------------------------------------------


def _looked(scene: DriveScene, manoeuvre: ManoeuvreName) -> tuple[Fraction | None, list[Phase]]:
    """Return when the fuzzy safety model first brakes, and its braking from look to look."""
    me, other = (scene.drive.vehicles[x] for x in (scene.vehicles[0], scene.vehicles[-1]))
    times = [scene.start + Fraction(k, HERTZ) for k in range(LONGEST * HERTZ)]
    ends = [piece_starts(motion)[-1] for motion in (me, other)]
    even = max(x.time for x in ends)
    is_straight = all(x.a_lon == x.a_lat == x.v_lat == 0 for x in ends)
    seen = (
        Sight(
            time,
            VehicleBox(mine.s, mine.d, me.length, me.width),
            VehicleBox(its.s, its.d, other.length, other.width),
            mine.v_lon,
            its.v_lon,
            mine.v_lat,
            its.v_lat,
            is_straight and time >= even,
        )
        for time, mine, its in zip(times, each_state(me, times), each_state(other, times), strict=True)
    )
    return controlled(seen, known_from(scene, manoeuvre))
