"""Roads for countermodels: a few lanes and lanelets that a search may name, and a road laid for a model.

Each lane is a chain of rectangles from some first to some last strip; a strip is what lies between
two neighbouring ends of boxes along the road. In a strip, a lane goes through a gap between the
boxes that it must not touch. Gaps are as wide as they can be, so that what a lane can reach it does.
Nothing rests on this: the claim is judged on the road that comes out.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import field, replace
from fractions import Fraction
from heapq import heapify, heappop, heappush
from itertools import count, pairwise
from typing import TypeAlias, get_args

from roadproof.evidence.atoms import is_atom
from roadproof.evidence.derivation import free_prefix
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import free_lanelets, road_names
from roadproof.runtime.records import dataclass
from roadproof.world.lanelet_rules import shared_boundaries
from roadproof.world.road import Lanelet, Road, Zone

FEWEST_LANES = 2
LANELETS_A_LANE = 2


@dataclass(frozen=True)
class Roster:
    """The few lanes of a small road and its lanelets; ``lanelets`` maps each lanelet to its lane."""

    lanes: tuple[str, ...]
    lanelets: Mapping[str, str]

    def members(self, domain: f.Domain) -> list[str]:
        """Return the elements that are, or (for zones and adjacent lanes) may be, in ``domain``."""
        match domain.kind:
            case "lanes":
                return list(self.lanes)
            case "adjacent":
                return [lane for lane in self.lanes if lane != domain.of]
            case "lanelets":
                return [lanelet for lanelet, lane in self.lanelets.items() if lane == domain.of]
            case "zone":
                return list(self.lanelets)

    def elements(self) -> dict[str, f.Domain]:
        lanes = dict.fromkeys(self.lanes, f.Domain("lanes"))
        return lanes | {lanelet: f.Domain("lanelets", lane) for lanelet, lane in self.lanelets.items()}


def roster_for(claim: Formula, lanes: Sequence[str]) -> Roster | None:
    """Return a roster for an abstracted claim; None without a road quantifier outside of atoms.

    A free lanelet is in the last lane.
    """
    quantifiers = open_quantifiers(claim)
    if not quantifiers:
        return None
    prefix = free_prefix("M", {*lanes, *road_names(claim)})
    missing = max(0, FEWEST_LANES - len(lanes))
    names = (*lanes, *(f"{prefix}{number}" for number in range(1, missing + 1)))
    lanelets = dict.fromkeys(free_lanelets(claim), names[-1])
    if lanelets or any(x.domain.kind in ("lanelets", "zone") for x in quantifiers):
        places = [lane for lane in names for _ in range(LANELETS_A_LANE)]
        lanelets |= {f"{prefix}{missing + k}": lane for k, lane in enumerate(places, 1)}
    return Roster(names, lanelets)


def open_quantifiers(formula: Formula) -> list[f.Some | f.Every]:
    """Return the quantifiers over the road outside of atoms."""
    return [x for x in f.subformulas(formula) if isinstance(x, f.Some | f.Every) and not is_atom(x)]


ZONES: tuple[Zone, ...] = get_args(Zone)
MARGIN = Fraction(4)
MOST_ROUTES = 20_000
# Of a lane, a zone ("main") or a lanelet by name; and a box by its place in the list.
Place: TypeAlias = tuple[str, str]
Fact: TypeAlias = tuple[Place, int]


@dataclass(frozen=True)
class Box:
    rear: Fraction
    front: Fraction
    right: Fraction
    left: Fraction


@dataclass(frozen=True)
class RoadLayout:
    """The requirements on a road.

    ``inside`` and ``outside``: facts that a box is, or is not, in a place ``("lane", "L")``,
    ``("zone", "main")`` or ``("lanelet", "l")``. ``lanelets`` gives each named lanelet its lane and possible
    zones; ``adjacent`` are pairs of lanes. ``short``: lanes have no lanelets but those that they need.
    """

    boxes: tuple[Box, ...]
    inside: frozenset[Fact]
    outside: frozenset[Fact]
    lanes: tuple[str, ...]
    lanelets: Mapping[str, tuple[str, tuple[Zone, ...]]]
    adjacent: frozenset[frozenset[str]]
    short: bool


@dataclass(frozen=True)
class Step:
    """One lanelet of a route: strips ``first`` to ``last``, and from ``right`` to ``left`` across."""

    first: int
    last: int
    right: Fraction
    left: Fraction
    zone: Zone
    name: str
    gains: frozenset[Fact]

    def meets(self, other: "Step") -> bool:
        return self.right < other.left and other.right < self.left


@dataclass(frozen=True)
class Route:
    """Steps from the first to ``step``, as a linked list, and the facts that they make true."""

    step: Step
    gains: frozenset[Fact]
    before: "Route | None"

    def steps(self) -> list[Step]:
        """The lanelets from the first on; strips with equal gap and zone as one step."""
        backwards, route = [self.step], self.before
        while route is not None:
            step, after = route.step, backwards[-1]
            alike = (step.right, step.left, step.zone) == (after.right, after.left, after.zone)
            if alike and not step.name and not after.name:
                backwards[-1] = replace(after, first=step.first)
            else:
                backwards.append(step)
            route = route.before
        return backwards[::-1]


def build_road(layout: RoadLayout) -> Road | None:
    """Return a road with the facts of ``layout``, or None; lanes are chains of lanelets."""
    strips = _Strips(layout)
    beside = [lane for lane in layout.lanes if any(lane in pair for pair in layout.adjacent)]
    open_zones = frozenset(fact for fact in layout.inside if fact[0][0] == "zone")
    routes: dict[str, Route] = {}
    for lane in layout.lanes:
        route = strips.route(lane, open_zones, lane in beside)
        if route is None:
            return None
        open_zones -= route.gains
        routes[lane] = route
    while open_zones or not routes:
        lane = _new_name(routes)
        route = strips.route(lane, open_zones, False)
        if route is None or (open_zones and not route.gains & open_zones):
            return None
        open_zones -= route.gains
        routes[lane] = route
    lanelets = [
        lanelet
        for number, (lane, route) in enumerate(routes.items())
        for lanelet in strips.lanelets(lane, route, strips.inset(number, len(routes)))
    ]
    lanelets += _neighbour_tails(lanelets, beside, [(a, b) for a, b in map(sorted, layout.adjacent)])
    placed = tuple(x for lane in routes for x in lanelets if x.lane == lane)
    return Road("made for this trace", placed, shared_boundaries(placed))


def _new_name(taken: Mapping[str, object]) -> str:
    number = 1
    while f"other-{number}" in taken:
        number += 1
    return f"other-{number}"


@dataclass
class _Strips:
    """The strips of a layout, and the boxes in each."""

    layout: RoadLayout
    ends: list[Fraction] = field(init=False)
    lines: list[Fraction] = field(init=False)
    active: list[frozenset[int]] = field(init=False)

    def __post_init__(self) -> None:
        boxes = self.layout.boxes
        along = sorted({end for box in boxes for end in (box.rear, box.front)}) or [Fraction(0)]
        across = sorted({end for box in boxes for end in (box.right, box.left)}) or [Fraction(0)]
        self.ends = [along[0] - MARGIN, *along, along[-1] + MARGIN]
        self.lines = [across[0] - MARGIN, *across, across[-1] + MARGIN]
        self.active = [
            frozenset(j for j, box in enumerate(boxes) if box.rear < high and low < box.front)
            for low, high in pairwise(self.ends)
        ]

    def route(self, lane: str, open_zones: frozenset[Fact], to_the_end: bool) -> Route | None:
        """Return the best route of a lane: with all it must have, most of ``open_zones``, then all strips."""
        layout = self.layout
        names = [name for name, (of, _) in layout.lanelets.items() if of == lane]
        must = {fact for fact in layout.inside if fact[0] == ("lane", lane)}
        must |= {(("lanelet", name), -1) for name in names}
        goals = frozenset(must) | open_zones
        steps = [step for name in names for step in self._named_steps(lane, name, goals)]
        for zone in self._zones():
            for strip in range(len(self.active)):
                steps += self._steps(strip, strip, lane, zone, "", goals)
        routes: list[Route] = []
        for whole in (False,) if layout.short else (True, False):
            routes = [
                route
                for route in self._routes(steps, whole)
                if must <= route.gains
                and (not (whole or to_the_end) or route.step.last == len(self.active) - 1)
            ]
            if any(open_zones <= route.gains for route in routes):
                break
        if layout.short:
            return max(routes, key=lambda route: (len(route.gains), -len(route.steps())), default=None)
        return max(routes, key=lambda route: len(route.gains), default=None)

    def _zones(self) -> list[Zone]:
        """The zones that the layout speaks of, and one that it does not, the main one first."""
        known = {place[1] for place, _ in self.layout.inside | self.layout.outside if place[0] == "zone"}
        others = [zone for zone in ZONES if zone not in known]
        return [zone for zone in ZONES if zone in known or zone in others[:1]]

    def _named_steps(self, lane: str, name: str, goals: frozenset[Fact]) -> Iterator[Step]:
        """Yield ways for a named lanelet, each no longer than it must be."""
        place = ("lanelet", name)
        inside = {j for where, j in self.layout.inside if where == place}
        for zone in self.layout.lanelets[name][1]:
            for first in range(len(self.active)):
                met: frozenset[int] = frozenset()
                for last in range(first, len(self.active)):
                    met |= self.active[last]
                    if inside <= met:
                        yield from self._steps(first, last, lane, zone, name, goals)
                        break

    def _steps(
        self, first: int, last: int, lane: str, zone: Zone, name: str, goals: frozenset[Fact]
    ) -> Iterator[Step]:
        """A step for each gap between the boxes that a lanelet of this lane, zone and name must not touch."""
        boxes, layout = self.layout.boxes, self.layout
        places = [("lane", lane), ("zone", zone), *([("lanelet", name)] if name else [])]
        met = frozenset[int]().union(*self.active[first : last + 1])
        shut = sorted(
            (boxes[j].right, boxes[j].left) for j in met if any((p, j) in layout.outside for p in places)
        )
        begin = self.lines[0]
        for right, left in [*shut, (self.lines[-1], self.lines[-1])]:
            if begin < right:
                hit = {j for j in met if boxes[j].right < right and begin < boxes[j].left}
                gains = {(place, j) for place in places[:2] for j in hit} & goals
                if not name:
                    yield Step(first, last, begin, right, zone, name, frozenset(gains))
                elif all(j in hit for where, j in layout.inside if where == ("lanelet", name)):
                    yield Step(first, last, begin, right, zone, name, frozenset(gains | {(places[2], -1)}))
            begin = max(begin, left)

    def _routes(self, steps: Sequence[Step], whole: bool) -> list[Route]:
        """Routes that gain what no other to the same step does; ``whole``: from the first strip on."""
        by_first: list[list[Step]] = [[] for _ in [*self.active, None]]
        for step in steps:
            by_first[step.first].append(step)
        best: dict[Step, list[Route]] = {}
        order = count()
        waiting = [
            (step.last, -len(step.gains), next(order), Route(step, step.gains, None))
            for step in steps
            if step.first == 0 or not whole
        ]
        heapify(waiting)
        while waiting:
            *_, number, route = heappop(waiting)
            if number > MOST_ROUTES:
                return []
            known = best.setdefault(route.step, [])
            if any(route.gains <= other.gains for other in known):
                continue
            known[:] = [other for other in known if not other.gains <= route.gains]
            known.append(route)
            end = route.step.last
            for step in (*by_first[end], *by_first[end + 1]):
                if step.meets(route.step) and not (step.name and (("lanelet", step.name), -1) in route.gains):
                    gains = route.gains | step.gains
                    heappush(waiting, (step.last, -len(gains), next(order), Route(step, gains, route)))
        return [route for known in best.values() for route in known]

    def lanelets(self, lane: str, route: Route, inset: Fraction) -> Iterator[Lanelet]:
        """The steps of a route as rectangles, each a little narrower than its gap.

        With an inset of its own, no lane shares a boundary with another.
        """
        steps = route.steps()
        low = self.ends[steps[0].first]
        number = 0
        while steps:
            step, *steps = steps
            high = self.ends[step.last + 1]
            if steps and steps[0].first == step.last:
                here = 1 + sum(x.first == step.last for x in steps)
                high = max(low, self.ends[step.last]) + (high - max(low, self.ends[step.last])) / here
            number += 1
            name = step.name or f"{lane}.{number}"
            across = step.right + inset, step.left - inset
            yield Lanelet(name, lane, step.zone, "main", (low, high), across)
            low = high

    def inset(self, number: int, of: int) -> Fraction:
        """The inset of one of several lanes: no two are alike, and none closes a gap."""
        narrowest = min(high - low for low, high in pairwise(self.lines))
        return narrowest * (number + 1) / (8 * of)


def _neighbour_tails(
    lanelets: Sequence[Lanelet], lanes: Sequence[str], pairs: Sequence[tuple[str, str]]
) -> list[Lanelet]:
    """Return lanelets behind all else where adjacent lanes lie side by side, one pair after the other.

    Between such places each lane keeps to a level of its own.
    """
    top = max(x.d[1] for x in lanelets) + MARGIN
    slots = (top, top + 3), (top + 3, top + 6)
    made: list[Lanelet] = []
    for number, lane in enumerate(lanes, 1):
        last = [x for x in lanelets if x.lane == lane][-1]
        level = top + 10 * number, top + 10 * number + 3
        ways = [last.d, level]
        for pair in sorted(pairs):
            ways += [slots[pair.index(lane)] if lane in pair else level, level]
        low = last.s[1] or Fraction(0)
        for place, (before, after) in enumerate(pairwise(ways), 1):
            for end, across in (("a", _around(before, after)), ("b", after)):
                name = f"{lane}.beside.{place}{end}"
                made.append(Lanelet(name, lane, "main", "main", (low, low + 20), across))
                low += 20
    return made


def _around(a: tuple[Fraction, Fraction], b: tuple[Fraction, Fraction]) -> tuple[Fraction, Fraction]:
    return min(a[0], b[0]), max(a[1], b[1])
