"""Simple drives of two vehicles, and a measure of how hard a drive is to read.

They are tried before a solver, because they are easy to read. No verdict rests on them, because every drive
is judged.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import product

from roadproof.evidence.drive_file import DriveFile
from roadproof.library.scenarios import PAIR
from roadproof.world.drive import Drive, Motion, Piece
from roadproof.world.road import Road
from roadproof.world.vehicle import Vehicle

HORIZON = Fraction(14)
MOVE = Fraction(4)  # seconds for one move across
CLOSE = Fraction(1, 20)  # metres from a marking
CRUISE = Fraction(25)
ZERO = Fraction(0)


@dataclass(frozen=True)
class LateralMoves:
    """Moves across the road, each in metres to the left, one after the other from ``start`` (s) on.

    ``place``: the start in the lane: -1 at the right marking, 0 in the middle, 1 at the left marking, 2
    across it.
    """

    place: int
    moves: tuple[Fraction, ...] = ()
    start: Fraction = Fraction(1)


@dataclass(frozen=True)
class Approach:
    """The longitudinal approach of SV to POV, which starts ``gap`` m ahead of it, front to front.

    ``faster``: the speed of SV minus that of POV at the start (m/s); ``speeds_up``, ``slows_down``: the time
    (s) at which SV gains, or POV loses, speed for 2 s.
    """

    gap: Fraction
    faster: Fraction = ZERO
    speeds_up: Fraction | None = None
    slows_down: Fraction | None = None


def simple_drives(road: Road, vehicle: Vehicle) -> Iterator[Drive]:
    """Yield all simple drives on a road of parallel lanes.

    One of the vehicles makes no lateral moves, or both move alike. With more than two lanes, both move, with
    a lane between them at the start.
    """
    lanes = sorted({lanelet.d for lanelet in road.lanelets})
    across = list(_across(lanes, vehicle))
    between = lanes[1][1] - lanes[1][0] if len(lanes) > 2 else None
    for mine, theirs, along in product(across, across, _alongs()):
        moves = mine[1].moves, theirs[1].moves
        alike = len(moves[0]) == len(moves[1]) and mine[1].start == theirs[1].start
        if all(moves) and not alike:
            continue
        if between is not None and not (all(moves) and abs(mine[0] - theirs[0]) > between + vehicle.width):
            continue
        subject = _motion(vehicle, mine, ZERO, CRUISE + along.faster, along.speeds_up, Fraction(2))
        other = _motion(vehicle, theirs, along.gap, CRUISE, along.slows_down, Fraction(-3))
        yield Drive(dict(zip(PAIR, (subject, other), strict=True)))


def _alongs() -> Iterator[Approach]:
    yield Approach(Fraction(0))
    yield Approach(Fraction(3), Fraction(1))
    yield Approach(Fraction(85), Fraction(5))  # danger soon
    yield Approach(Fraction(125), Fraction(5))  # danger after 9 s
    yield Approach(Fraction(-50), Fraction(5))  # SV ahead, and faster
    yield Approach(Fraction(58), speeds_up=Fraction(2))
    yield Approach(Fraction(58), slows_down=Fraction(0))
    yield Approach(Fraction(58), speeds_up=Fraction(9))
    yield Approach(Fraction(0), Fraction(-5))
    yield Approach(Fraction(24), Fraction(-5), speeds_up=Fraction(2))  # danger, though POV stays faster


def _across(
    lanes: Sequence[tuple[Fraction, Fraction]], vehicle: Vehicle
) -> Iterator[tuple[Fraction, LateralMoves]]:
    """Yield lateral moves that stay on the road, each with the initial position of the left edge (m)."""
    width = lanes[0][1] - lanes[0][0]
    lane_change, drift = width, (width - vehicle.width) / 2 - CLOSE
    ways = [LateralMoves(place) for place in (-1, 0, 1, 2)]
    for side in (1, -1):
        ways.append(LateralMoves(0, (side * drift,)))
        ways.append(LateralMoves(-side, (side * drift * 7 / 10,)))
        ways.append(LateralMoves(0, (side * lane_change,)))
        ways.append(LateralMoves(0, (side * lane_change,), Fraction(8)))
        ways.append(LateralMoves(0, (side * lane_change, -side * lane_change)))
        ways.append(LateralMoves(0, (side * drift, -side * drift, side * lane_change)))
    for (right, left), way in product(lanes, ways):
        free = (left - right - vehicle.width) / 2 - CLOSE
        start = left + CLOSE if way.place == 2 else (right + left + vehicle.width) / 2 + way.place * free
        edges = [start, *(start + sum(way.moves[: k + 1]) for k in range(len(way.moves)))]
        if all(lanes[0][0] <= d - vehicle.width and d <= lanes[-1][1] for d in edges):
            yield start, way


def _motion(
    vehicle: Vehicle,
    across: tuple[Fraction, LateralMoves],
    s: Fraction,
    speed: Fraction,
    changes: Fraction | None,
    by: Fraction,
) -> Motion:
    """Return a motion that accelerates by ``by`` m/s^2 for 2 s from the time ``changes`` (s) on."""
    d, way = across
    half = MOVE / 2
    lateral: list[tuple[Fraction, Fraction, Fraction]] = []
    for k, distance in enumerate(way.moves):
        begin = way.start + k * MOVE
        a = distance / half**2
        lateral += [(begin, begin + half, a), (begin + half, begin + MOVE, -a)]
    longitudinal = [] if changes is None else [(changes, changes + 2, by)]
    knots = sorted({ZERO, *(t for x in (*lateral, *longitudinal) for t in x[:2])})
    pieces = []
    for begin, end in zip(knots, [*knots[1:], None], strict=True):
        a_lon = sum((a for low, high, a in longitudinal if low <= begin < high), ZERO)
        a_lat = sum((a for low, high, a in lateral if low <= begin < high), ZERO)
        pieces.append(Piece(None if end is None else end - begin, a_lon, a_lat))
    return Motion(vehicle.length, vehicle.width, s, d, speed, ZERO, tuple(pieces), vehicle.kind)


def effort_of(file: DriveFile) -> tuple[int, int, int, Fraction]:
    """Return how hard a drive is to read; smaller is simpler.

    It counts vehicles that move across the road, accelerations, and vehicles that start off the middle of a
    lane; the last number is its duration (s).
    """
    motions = file.drive.vehicles.values()
    movers = sum(m.v_lat != 0 or any(p.a_lat for p in m.pieces) for m in motions)
    changes = sum((p.a_lon != 0 or p.j_lon != 0) + (p.a_lat != 0) for m in motions for p in m.pieces)
    middles = {sum(lanelet.d, Fraction(0)) for lanelet in file.road.lanelets}
    off = sum(2 * m.d - m.width not in middles for m in motions)
    longest = max(sum((p.duration or Fraction(0) for p in m.pieces), Fraction(0)) for m in motions)
    return movers, changes, off, longest
