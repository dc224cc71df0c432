"""Simple drives that a set misses, to begin with; and whether a set that covers all needs its definitions.

Simple drives are tried before any solver is asked, since many gaps are found in them, in a form that is easy
to read. Nothing rests on them: every drive is judged.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import combinations, islice, product

from roadproof.analysis.basis import Basis
from roadproof.analysis.coverage.classes import (
    PROOF,
    GapClasses,
    claims_of,
    missed,
    numbers_on,
    replaced_in,
    sectors_of,
    two_vehicle_numbers,
)
from roadproof.engines.prove.prover import prove
from roadproof.evidence.answers.coverage import NeedVerdict
from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.judged import JudgedDrive
from roadproof.evidence.settled import Settled
from roadproof.library.bind import bind
from roadproof.library.elaborate import entered_below
from roadproof.library.notes import Entered
from roadproof.library.scenarios import PAIR, danger_comes, name_of, numbers_of
from roadproof.library.specification import Specification
from roadproof.logic.custom_names import own_of
from roadproof.logic.formula import Formula, transform
from roadproof.logic.restore import as_syntax
from roadproof.logic.show import text
from roadproof.runtime.budget import BudgetExceeded
from roadproof.semantics.exact.exact import judge
from roadproof.semantics.exact.replay import first_breach, first_overlap
from roadproof.verdict import Verdict
from roadproof.world.drive import Drive, Motion, Piece
from roadproof.world.models import load_road, load_vehicle
from roadproof.world.road import Lanelet, Road, pairs
from roadproof.world.vehicle import Vehicle

HORIZON = Fraction(14)
MOVE = Fraction(4)  # seconds for one move across
CLOSE = Fraction(1, 20)  # metres from a marking
CRUISE = Fraction(25)
ZERO = Fraction(0)


@dataclass(frozen=True)
class Across:
    """Metres to the left in one move each, one after the other, from ``start`` s on.

    ``place``: where in its lane the vehicle starts: -1 at the right marking, 0 in the middle, 1 at the left,
    2 across the left one.
    """

    place: int
    moves: tuple[Fraction, ...] = ()
    start: Fraction = Fraction(1)


@dataclass(frozen=True)
class Approach:
    """How SV comes near POV, which starts ``gap`` m ahead of it, front to front.

    ``faster``: by how many m/s SV is faster at the start; ``speeds_up`` and ``slows_down``: from when on
    (s) SV gains, or POV loses, speed for 2 s.
    """

    gap: Fraction
    faster: Fraction = ZERO
    speeds_up: Fraction | None = None
    slows_down: Fraction | None = None


def simple_drives(road: Road, vehicle: Vehicle) -> Iterator[Drive]:
    """All simple drives on a road of parallel lanes.

    One of the vehicles does not move across, or both move alike. Where there are more than two lanes, only
    drives on which both move, with a lane between them at the start.
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
) -> Iterator[tuple[Fraction, Across]]:
    """Ways across the road that stay on it, each with where its left edge starts."""
    width = lanes[0][1] - lanes[0][0]
    lane_change, drift = width, (width - vehicle.width) / 2 - CLOSE
    ways = [Across(place) for place in (-1, 0, 1, 2)]
    for side in (1, -1):
        ways.append(Across(0, (side * drift,)))
        ways.append(Across(-side, (side * drift * 7 / 10,)))
        ways.append(Across(0, (side * lane_change,)))
        ways.append(Across(0, (side * lane_change,), Fraction(8)))
        ways.append(Across(0, (side * lane_change, -side * lane_change)))
        ways.append(Across(0, (side * drift, -side * drift, side * lane_change)))
    for (right, left), way in product(lanes, ways):
        free = (left - right - vehicle.width) / 2 - CLOSE
        start = left + CLOSE if way.place == 2 else (right + left + vehicle.width) / 2 + way.place * free
        edges = [start, *(start + sum(way.moves[: k + 1]) for k in range(len(way.moves)))]
        if all(lanes[0][0] <= d - vehicle.width and d <= lanes[-1][1] for d in edges):
            yield start, way


def _motion(
    vehicle: Vehicle,
    across: tuple[Fraction, Across],
    s: Fraction,
    speed: Fraction,
    changes: Fraction | None,
    by: Fraction,
) -> Motion:
    """A motion that changes its speed for 2 s from ``changes`` on, by ``by`` m/s each second."""
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


TRIAL = "trial"
MOST_COMBINED = 4


class Trials:
    """Judges drives under the sets ``wider`` (each extends the one before) and under choices from them."""

    def __init__(self, basis: Basis, wider: Sequence[str]) -> None:
        self.specification = basis.specification
        self.sectors = sectors_of(basis.specification)
        self.wider = tuple(wider)
        self.values = basis.all_values()
        self.bound: dict[tuple[str, tuple[str, ...] | None, Road], Formula] = {}

    def first(self, file: DriveFile) -> str:
        """The first of the wider sets that catches the drive; empty where none does."""
        return next((name for name in self.wider if not self.misses(file, name, None)), "")

    def smallest(self, file: DriveFile) -> tuple[tuple[str, ...], ...]:
        """The smallest choices of definitions of the first set that catches the drive which do, too."""
        name = self.first(file)
        if not name:
            return ()
        names = replaced_in(self.specification, self.specification.in_set(name))
        for size in range(1, min(len(names), MOST_COMBINED) + 1):
            catching = tuple(x for x in combinations(names, size) if not self.misses(file, name, x))
            if catching:
                return catching
        return (names,)

    def trial(self, wide: str, names: Sequence[str]) -> Specification:
        """The trial set: the set with the definitions ``names`` of ``wide`` in place of its own."""
        narrow, other = self.specification, self.specification.in_set(wide)
        taken = {name: other.definitions[name] for name in names}
        return Specification(narrow.library, TRIAL, narrow.options, {**narrow.definitions, **taken})

    def misses(self, file: DriveFile, wide: str, names: tuple[str, ...] | None) -> bool:
        """Whether the drive is a gap of ``wide``, or of the trial set with its definitions ``names``."""
        key = (wide, names, file.road)
        if key not in self.bound:
            tried = self.specification.in_set(wide) if names is None else self.trial(wide, names)
            gap = missed(tried, numbers_on(file.road, self.specification, self.sectors))
            self.bound[key] = bind(gap.formula, file.road, {}, self.values)
        return judge(self.bound[key], file.drive).holds


@dataclass(frozen=True)
class FoundGap:
    """A drive that the set misses; ``first``: the first of the wider sets that catches it, or empty.

    ``classes``: the keys of all parts for which it is a near miss. It is no evidence yet: what it shows of
    a class is judged when an answer is made of it.
    """

    file: DriveFile
    first: str
    classes: tuple[str, ...]

    @property
    def effort(self) -> tuple[int, int, int, Fraction]:
        """What makes a drive hard to read: vehicles that move across the road, accelerations, vehicles that
        start off the middle of a lane; and how long it takes (s)."""
        motions = self.file.drive.vehicles.values()
        movers = sum(m.v_lat != 0 or any(p.a_lat for p in m.pieces) for m in motions)
        changes = sum((p.a_lon != 0 or p.j_lon != 0) + (p.a_lat != 0) for m in motions for p in m.pieces)
        middles = {sum(lanelet.d, Fraction(0)) for lanelet in self.file.road.lanelets}
        off = sum(2 * m.d - m.width not in middles for m in motions)
        longest = max(sum((p.duration or Fraction(0) for p in m.pieces), Fraction(0)) for m in motions)
        return movers, changes, off, longest


def find_among_simple(
    road: Road, start: int, step: int, classes: GapClasses, trials: Trials
) -> list[FoundGap]:
    """The gaps among every ``step``-th of the simple drives; of those alike the ones with least effort."""
    specification = classes.specification
    gap = bind(classes.missed(classes.numbers_on(road)).formula, road, {}, classes.values)
    gap = transform(gap, lambda part: part)
    best: dict[tuple[str, tuple[str, ...]], FoundGap] = {}
    if own_of([gap]):
        return []  # simple drives say nothing of own signals
    for drive in _dangerous(specification, classes.values, road, start, step):
        if not judge(gap, drive).holds:
            continue
        name, options = specification.set_name, specification.options
        file = DriveFile(None, name, "", HORIZON, {}, classes.values, options, road, drive)
        found = FoundGap(file, trials.first(file), classes.of(file))
        key = (found.first, found.classes)
        if key not in best or found.effort < best[key].effort:
            best[key] = found
    return list(best.values())


def _dangerous(
    specification: Specification, values: Mapping[str, Fraction], road: Road, start: int = 0, step: int = 1
) -> Iterator[Drive]:
    """The simple drives on which danger arises, within the limits of cars: every ``step``-th of all."""
    car = load_vehicle("car")
    begins = bind(danger_comes(specification, *PAIR).formula, road, {}, values)
    for drive in islice(simple_drives(road, car), start, None, step):
        if not judge(begins, drive).holds or first_overlap(drive, HORIZON) is not None:
            continue
        if first_breach(drive, dict.fromkeys(drive.vehicles, car), None) is None:
            yield drive


@dataclass(frozen=True)
class Need(Settled[NeedVerdict]):
    """WITNESSED: ``drive`` is missed without the definition, as it is in ``parent``, and caught with it.

    PROVED: the set covers everything without it, too. UNKNOWN: neither was found. The formula of the drive
    says what is missed with all definitions written out, as no shipped set is the one without the definition.
    """

    definition: str
    parent: str


# Two cars fit side by side in its lane, as they do not on the reference roads.
WIDE = Road(
    "one lane of 5 m",
    (Lanelet("m1", "main-1", "main", "main", (None, None), (ZERO, Fraction(5))),),
    pairs([]),
)


def parent_of(specification: Specification) -> str:
    """The set that a set extends, empty where it extends none."""
    return specification.library.sets[specification.set_name].parent


def replaced_by(specification: Specification) -> tuple[str, ...]:
    """The definitions that a set replaces in the set that it extends, if it does."""
    parent = parent_of(specification)
    return replaced_in(specification.in_set(parent), specification) if parent else ()


def mixed_definitions(home: Specification, other: Specification) -> Entered:
    """Every definition of a set, by set and name, that scenarios are made of where some definitions are those
    of another set: below its scenarios, and below the definitions that differ between the two.

    Raises ``TextError``.
    """
    names = [*map(name_of, numbers_of(other)), *map(name_of, numbers_of(home))]
    names += [*replaced_in(home, other), *replaced_in(other, home)]
    found: Entered = {}
    for each in (home, other):
        for name in dict.fromkeys(names):
            if name in each.definitions:
                found |= entered_below(each, name)
    return found


def find_need(basis: Basis, name: str) -> Need:
    """Whether a set needs the definition ``name``, one of ``replaced_by``."""
    wide, parent = basis.specification.set_name, parent_of(basis.specification)
    trials = Trials(replace(basis, specification=basis.specification.in_set(parent)), (wide,))
    kept = tuple(n for n in replaced_by(basis.specification) if n != name)
    without = trials.trial(wide, kept)
    # Simple drives say nothing of own signals.
    for road in () if basis.library.freedom else (load_road("main-2"), WIDE):
        for drive in _dangerous(trials.specification, trials.values, road):
            options = basis.specification.options
            file = DriveFile(None, wide, "", HORIZON, {}, trials.values, options, road, drive)
            if trials.misses(file, wide, kept):
                return Need(name, parent, verdict=Verdict.WITNESSED, drive=_judged(basis, without, file))
    return Need(name, parent, verdict=_covers(basis, without))


def _judged(basis: Basis, without: Specification, file: DriveFile) -> JudgedDrive:
    """The drive as one that is missed without the definition, judged as a reader would."""
    query = missed(without, two_vehicle_numbers(without))
    formula = text(as_syntax(query.formula, expand=True))
    return JudgedDrive(replace(file, formula=formula), basis.library)


def _covers(basis: Basis, without: Specification) -> NeedVerdict:
    """PROVED where coverage is proved without the definition, too, else UNKNOWN."""
    effort = basis.effort.of(PROOF)
    try:
        proved = all(prove(without, x, effort).verdict is Verdict.PROVED for x in claims_of(without))
    except BudgetExceeded:
        return Verdict.UNKNOWN
    return Verdict.PROVED if proved else Verdict.UNKNOWN
