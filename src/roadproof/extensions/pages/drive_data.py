"""The data of a drive's picture: strips of truth, distances against RSS, danger and road.

Distances and danger are the library's own: its definitions are bound and judged, no formula is written here.
"""

from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from itertools import groupby
from typing import Literal, TypeAlias

from roadproof.errors import RoadproofError
from roadproof.evidence.drive_file import DriveFile
from roadproof.extension import import_entry, list_entries
from roadproof.library.bind import bind, values_with
from roadproof.library.roles import vehicle_order
from roadproof.library.scenarios import danger, too_near_ahead, too_near_left
from roadproof.library.specification import Library, Query, Specification
from roadproof.library.words import words_of
from roadproof.logic.formula import Application, Compare, Formula, nesting, subformulas
from roadproof.runtime.records import dataclass
from roadproof.semantics.exact.algebraic import as_float
from roadproof.semantics.exact.judging import Judgement, judge
from roadproof.semantics.exact.samples import sample_margin
from roadproof.semantics.exact.signals import DriveSignals, TermPieces
from roadproof.semantics.exact.truth import TruthSet
from roadproof.world.motion import states_at
from roadproof.world.road import Road, Zone

Span: TypeAlias = tuple[float, float]
Direction: TypeAlias = Literal["along", "across"]
GRAIN = Fraction(1, 10)


@dataclass(frozen=True)
class Strip:
    """The times (s) at which a part of the formula is true; ``depth``: in how many other parts it is."""

    name: str
    depth: int
    spans: tuple[Span, ...]


@dataclass(frozen=True)
class Distance:
    """Between two boxes in one direction, below 0 where they are beside each other in it; m, by ``GRAIN``.

    ``needed``: the RSS distance that the one behind, or the right one, needs; ``one_behind``: whether that is
    ``one``, so that the distance jumps where it changes.
    """

    one: str
    other: str
    gap: tuple[float, ...]
    needed: tuple[float, ...]
    one_behind: tuple[bool, ...]

    @property
    def runs(self) -> Iterator[slice]:
        """The samples between changes of who is behind."""
        begin = 0
        for _, group in groupby(self.one_behind):
            end = begin + len([*group])
            yield slice(begin, end)
            begin = end


@dataclass(frozen=True)
class Danger:
    """The first time (s) of danger between two vehicles."""

    one: str
    other: str
    begins: float

    def __str__(self) -> str:
        return f"danger between {self.one} and {self.other} from {self.begins:.1f} s on"


@dataclass(frozen=True)
class ShownRoad:
    """The part of a road in a window along it; ``lanes``: name and middle (m).

    ``pieces``: rectangles along × across with their zones.
    """

    lanes: tuple[tuple[str, float], ...]
    pieces: tuple[tuple[Zone, Span, Span], ...]
    across: Span

    @property
    def zones(self) -> tuple[Zone, ...]:
        """The zones that can be seen, each once."""
        return tuple(dict.fromkeys(zone for zone, _, _ in self.pieces))


def vehicles_of(file: DriveFile) -> list[str]:
    """Return the names of the vehicles, SV first, the others by name."""
    return vehicle_order(file.drive.vehicles)


def heading_of(file: DriveFile, library: Library) -> list[str]:
    """The scenario of a drive in words and in a sentence, or its formula."""
    if file.scenario is None:
        return [file.formula]
    words = words_of(library.select(file.set_name, file.options), file.scenario)
    return [f"S{str(words)[1:]}", words.sentence]


def times_of(file: DriveFile, grain: Fraction = GRAIN) -> list[Fraction]:
    """The instants at which curves are drawn, ``grain`` seconds apart."""
    return [k * grain for k in range(int(file.horizon / grain) + 1)]


def _words_of(formula: Formula) -> dict[Application, str]:
    """Return the phrases of extensions for parts of a formula."""
    phrases: dict[Application, str] = {}
    for entry in list_entries("words"):
        phrases = import_entry(entry)(formula) | phrases
    return phrases


def strips_of(judgement: Judgement, horizon: Fraction) -> tuple[Strip, ...]:
    """Every named part of a judged formula, each below the one that it is part of."""
    depths, words = nesting(judgement.formula), _words_of(judgement.formula)
    return tuple(
        Strip(
            words.get(part) or f"{part.name}({', '.join(part.arguments)})",
            depths[part],
            tuple(_spans(truth, float(horizon))),
        )
        for part, truth in judgement.named()
    )


def _spans(truth: TruthSet, horizon: float) -> Iterator[Span]:
    """The stretches of a truth set up to the horizon."""
    for span in truth.spans():
        begin = as_float(span.begin.point)
        if begin <= horizon:
            yield begin, horizon if span.end is None else min(horizon, as_float(span.end.point))


def dangers_of(file: DriveFile, library: Library) -> tuple[Danger, ...]:
    """The first danger of the first vehicle with each other one, as the file's definitions have it."""
    first, *others = vehicles_of(file)
    spans = {other: danger_spans(file, library, first, other) or () for other in others}
    dangers = [Danger(first, other, times[0][0]) for other, times in spans.items() if times]
    return tuple(sorted(dangers, key=lambda x: x.begins))


def danger_spans(file: DriveFile, library: Library, one: str, other: str) -> tuple[Span, ...] | None:
    """Return the times (s) of danger between two vehicles; None where the library does not define danger."""
    formula = _bound(file, library, lambda home: danger(home, one, other))
    if formula is None:
        return None
    return tuple(_spans(judge(formula, file.drive).truth(formula), float(file.horizon)))


def distances_of(
    file: DriveFile, library: Library, direction: Direction, grain: Fraction = GRAIN
) -> tuple[Distance, ...]:
    """Return the distances of the first vehicle from each other one for which the library has one."""
    first, *others = vehicles_of(file)
    made = (_distance(file, library, direction, (first, other), times_of(file, grain)) for other in others)
    return tuple(x for x in made if x is not None)


def _distance(
    file: DriveFile, library: Library, direction: Direction, of: tuple[str, str], times: Sequence[Fraction]
) -> Distance | None:
    one, other = of
    gaps = {pair: _gaps(file, direction, pair, times) for pair in (of, (other, one))}
    margins = {pair: _margins(file, library, direction, pair, times) for pair in gaps}
    gap, needed, one_behind = [], [], []
    for k in range(len(times)):
        pair = max(gaps, key=lambda pair: gaps[pair][k][0])
        known, here = margins[pair], gaps[pair][k][1]
        if known is None:
            return None
        gap.append(here)
        needed.append(here + known[k])
        one_behind.append(pair == (one, other))
    return Distance(one, other, tuple(gap), tuple(needed), tuple(one_behind))


def _gaps(
    file: DriveFile, direction: Direction, pair: tuple[str, str], times: Sequence[Fraction]
) -> list[tuple[float, float]]:
    """Return how much further one vehicle is than another, by the points that are tracked, and the gap.

    The gap is from the front of one to the rear of the other, or from a left to a right side.
    """
    lower, higher = (file.drive.vehicles[name] for name in pair)
    ends = []
    for a, b in zip(states_at(lower, times), states_at(higher, times), strict=True):
        if direction == "along":
            order, size = b.s - a.s, higher.length
        else:
            order, size = b.d - a.d, higher.width
        ends.append((float(order), float(order - size)))
    return ends


def _margins(
    file: DriveFile, library: Library, direction: Direction, pair: tuple[str, str], times: Sequence[Fraction]
) -> Sequence[float] | None:
    """RSS distance less gap at each time; None where the library's definition is of another form."""
    formula = _bound(file, library, lambda home: too_near(home, direction, *pair))
    nearer = None if formula is None else nearer_in(formula)
    if nearer is None:
        return None
    grain = times[1] if len(times) > 1 else GRAIN
    return sample_margin(nearer, TermPieces(DriveSignals(file.drive)), grain, len(times))


def too_near(home: Specification, direction: Direction, low: str, high: str) -> Query:
    """One vehicle is ahead, or left, of the other, and nearer than the RSS distance."""
    return too_near_ahead(home, low, high) if direction == "along" else too_near_left(home, low, high)


def nearer_in(formula: Formula) -> Compare | None:
    """The comparison in ``too_near`` whose margin is RSS distance less gap; None in another form."""
    comparisons = [x for x in subformulas(formula) if isinstance(x, Compare)]
    return comparisons[1] if len(comparisons) == 2 else None


def _bound(file: DriveFile, library: Library, query_of: Callable[[Specification], Query]) -> Formula | None:
    """A formula of the file's set on its road; None where the library has no such definitions."""
    try:
        query = query_of(library.select(file.set_name, file.options))
        return bind(query.formula, file.road, file.lanes, values_with(library, file.values))
    except RoadproofError:
        return None


def window_of(file: DriveFile, times: Sequence[Fraction]) -> Span:
    """Return the window along the road (m from the first vehicle) with all vehicles at these times."""
    first, *_ = vehicles_of(file)
    origins = [x.s for x in states_at(file.drive.vehicles[first], times)]
    places = []
    for motion in file.drive.vehicles.values():
        for state, origin in zip(states_at(motion, times), origins, strict=True):
            front = state.s - origin
            places += [float(front - motion.length), float(front)]
    room = 0.1 * max(40.0, max(places) - min(places))
    return min(-20.0, min(places) - room), max(20.0, max(places) + room)


def road_in(road: Road, origin: Fraction, window: Span) -> ShownRoad:
    """Return the part of a road in a window around ``origin``."""
    pieces: list[tuple[Zone, Span, Span]] = []
    lanes: dict[str, float] = {}
    for lanelet in road.lanelets:
        low = window[0] if lanelet.s[0] is None else max(window[0], float(lanelet.s[0] - origin))
        high = window[1] if lanelet.s[1] is None else min(window[1], float(lanelet.s[1] - origin))
        if low < high:
            right, left = (float(x) for x in lanelet.d)
            pieces.append((lanelet.zone, (low, high), (right, left)))
            lanes.setdefault(lanelet.lane, (right + left) / 2)
    across = [float(x) for lanelet in road.lanelets for x in lanelet.d]
    return ShownRoad(tuple(lanes.items()), tuple(pieces), (min(across), max(across)))


Box: TypeAlias = tuple[float, float, float, float]
"""Left, right, bottom, top."""
