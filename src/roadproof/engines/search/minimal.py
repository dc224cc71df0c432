"""Simplifies a drive as long as it still satisfies its query."""

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction

from roadproof.evidence.drive_file import DriveFile
from roadproof.library.bind import bind, values_with
from roadproof.library.specification import Library, Query
from roadproof.semantics.exact.judging import judge
from roadproof.semantics.exact.replay import first_breach, first_overlap
from roadproof.world.drive import Motion, Piece
from roadproof.world.models import load_vehicle
from roadproof.world.motion import piece_starts
from roadproof.world.road import Road

ZERO = Fraction(0)


def simplest(file: DriveFile, query: Query, library: Library) -> DriveFile:
    """The drive with fewer accelerations and rounder numbers, on which ``query`` still holds.

    Tried for each vehicle, and kept where the judge agrees, the vehicle stays on the road and within
    the limits of a car, and its speed across is 0 in the end: no acceleration along or across at all,
    none along in one piece, two neighbouring pieces with their mean, round numbers.
    """
    limits = load_vehicle("car")
    current = dict(file.drive.vehicles)
    formula = bind(query.formula, file.road, file.lanes, values_with(library, file.values))

    def good(name: str, motion: Motion) -> bool:
        """Return whether a drive still satisfies the query."""
        drive = replace(file.drive, vehicles={**current, name: motion})
        if not _stays(motion, file.road) or first_breach(
            drive, dict.fromkeys(current, limits), None, file.road.line
        ):
            return False
        apart = file.overlaps_allowed or first_overlap(drive, file.horizon) is None
        return apart and judge(formula, drive).holds

    for name in current:
        for change in (_steady_across, _steady_along, *_ROUNDER):
            current[name] = _changed_if_good(current[name], change(current[name]), name, good)
        for shorter in (_without_acceleration, _with_mean):
            place = 0
            while place < len(current[name].pieces) - 1:
                before = current[name]
                current[name] = _changed_if_good(before, shorter(before, place), name, good)
                place += len(current[name].pieces) == len(before.pieces)
    simple = {name: _merged(motion) for name, motion in current.items()}
    return replace(file, drive=replace(file.drive, vehicles=simple))


def _changed_if_good(
    motion: Motion, change: Motion, name: str, good: Callable[[str, Motion], bool]
) -> Motion:
    return change if change != motion and good(name, change) else motion


def _steady_across(motion: Motion) -> Motion:
    return replace(motion, v_lat=ZERO, pieces=tuple(replace(p, a_lat=ZERO) for p in motion.pieces))


def _steady_along(motion: Motion) -> Motion:
    return replace(motion, pieces=tuple(replace(p, a_lon=ZERO, j_lon=ZERO) for p in motion.pieces))


_ROUNDER: tuple[Callable[[Motion], Motion], ...] = (
    lambda motion: replace(motion, v_lon=Fraction(round(motion.v_lon))),
    lambda motion: replace(motion, s=Fraction(round(motion.s))),
    lambda motion: replace(motion, d=Fraction(round(20 * motion.d), 20)),
)


def _without_acceleration(motion: Motion, place: int) -> Motion:
    pieces = list(motion.pieces)
    pieces[place] = replace(pieces[place], a_lon=ZERO, j_lon=ZERO)
    return replace(motion, pieces=tuple(pieces))


def _with_mean(motion: Motion, place: int) -> Motion:
    """Two neighbouring pieces as one, which changes the speeds as much as both do."""
    first, second = motion.pieces[place : place + 2]
    if first.duration is None or second.duration is None:
        return motion
    whole = first.duration + second.duration
    lon = (
        sum(x.duration * (x.a_lon + x.j_lon * x.duration / 2) for x in (first, second) if x.duration) / whole
    )
    lat = (first.duration * first.a_lat + second.duration * second.a_lat) / whole
    one = Piece(whole, lon, lat)
    return replace(motion, pieces=(*motion.pieces[:place], one, *motion.pieces[place + 2 :]))


def _stays(motion: Motion, road: Road) -> bool:
    """Return whether the box stays between the edges of the road at every knot, and goes straight in the
    end.
    """
    right = min(lanelet.d[0] for lanelet in road.lanelets)
    left = max(lanelet.d[1] for lanelet in road.lanelets)
    knots = piece_starts(motion)
    return knots[-1].v_lat == 0 and all(right <= x.d - motion.width and x.d <= left for x in knots)


def _merged(motion: Motion) -> Motion:
    """Neighbouring pieces with the same accelerations as one, where they have no jerk."""
    pieces: list[Piece] = []
    for piece in motion.pieces:
        before = pieces[-1] if pieces else None
        if before is not None and _constant(before) == _constant(piece) is not None:
            ends = piece.duration is None or before.duration is None
            duration = None if ends else before.duration + piece.duration  # type: ignore[operator]
            pieces[-1] = replace(before, duration=duration)
        else:
            pieces.append(piece)
    return replace(motion, pieces=tuple(pieces))


def _constant(piece: Piece) -> tuple[Fraction, Fraction] | None:
    """The accelerations of a piece; None where one of them is not constant."""
    return None if piece.j_lon else (piece.a_lon, piece.a_lat)
