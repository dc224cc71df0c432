"""Claims about lanes, zones and boxes as plain tuples; their truth on a road and a trace by definition.

Nothing here comes from the program but the class of roads: a claim is a tree of tuples with a text,
and its truth is worked out over the states of a trace, one after the other.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise, product
from random import Random

from roadproof.evidence.countermodel import Countermodel
from roadproof.world.road import Lanelet, Road, Zone

VEHICLES = ("SV", "POV")
ZONES: tuple[Zone, ...] = ("main", "merge", "depart")


# --- claims --------------------------------------------------------------------------------------


def random_claim(rng: Random):
    """A tree that speaks of the free lane L and the free lanelet l, often of the form A -> B."""
    if rng.random() < 0.7:
        left = random_tree(rng, rng.randint(1, 3), ("L",), ("l",))
        right = changed(rng, left) if rng.random() < 0.6 else random_tree(rng, 2, ("L",), ("l",))
        return ("->", left, right)
    return random_tree(rng, 4, ("L",), ("l",))


def random_tree(rng: Random, depth: int, lanes: tuple[str, ...], lanelets: tuple[str, ...]):
    if depth == 0:
        return random_atom(rng, lanes, lanelets)
    kind = rng.choice(["not", "and", "or", "F", "G", "U", "over", "over", "over", "atom"])
    inner = lambda: random_tree(rng, depth - 1, lanes, lanelets)  # noqa: E731
    match kind:
        case "not" | "F" | "G":
            return (kind, inner())
        case "and" | "or" | "U":
            return (kind, inner(), inner())
        case "over":
            return random_quantifier(rng, depth - 1, lanes, lanelets)
        case _:
            return random_atom(rng, lanes, lanelets)


def random_quantifier(rng: Random, depth: int, lanes: tuple[str, ...], lanelets: tuple[str, ...]):
    word = rng.choice(["some", "every"])
    if rng.random() < 0.4:
        name = f"K{len(lanes)}"
        domain = ("lanes",) if rng.random() < 0.6 else ("adjacentLanes", rng.choice(lanes))
        return (word, name, domain, random_tree(rng, depth, (*lanes, name), lanelets))
    name = f"l{len(lanelets)}"
    domain = ("lanelets", rng.choice(lanes)) if rng.random() < 0.6 else ("zone", rng.choice(ZONES))
    return (word, name, domain, random_tree(rng, depth, lanes, (*lanelets, name)))


def random_atom(rng: Random, lanes: tuple[str, ...], lanelets: tuple[str, ...]):
    a, b = rng.sample(VEHICLES, 2)
    match rng.randrange(6):
        case 0 | 1:
            return ("occ", a, rng.choice(lanelets[1:] or lanelets))
        case 2:
            return ("on", a, ("lanelets", rng.choice(lanes)))
        case 3:
            return ("on", a, ("zone", rng.choice(ZONES)))
        case 4:
            return ("compare", rng.choice("sd"), rng.choice(["<=", "<", "="]), a, b)
        case _:
            return (
                "compare",
                rng.choice(["rear", "right", "length", "width"]),
                rng.choice(["<=", "="]),
                a,
                b,
            )


def changed(rng: Random, tree):
    """The tree with one part turned into another: often implied by it, often not."""
    match tree:
        case ("some" | "every" as word, name, domain, body):
            if rng.random() < 0.3:
                word = "every" if word == "some" else "some"
            elif domain[0] == "zone" and rng.random() < 0.4:
                domain = ("zone", rng.choice(ZONES))
            elif domain[0] in ("zone", "lanelets") and rng.random() < 0.4:
                return (word, "K9", ("lanes",), (word, name, ("lanelets", "K9"), body))
            return (word, name, domain, changed(rng, body) if rng.random() < 0.5 else body)
        case ("not" | "F" | "G" as word, body):
            return (word, changed(rng, body)) if rng.random() < 0.5 else body
        case ("and" | "or" | "U" as word, left, right):
            return rng.choice([(word, changed(rng, left), right), (word, left, changed(rng, right)), right])
        case ("occ", a, _):
            return rng.choice([tree, ("F", tree), ("on", a, ("zone", rng.choice(ZONES)))])
        case ("on", a, _):
            return rng.choice([tree, ("F", tree), ("on", a, ("lanelets", "L"))])
        case _:
            return tree


def text_of(tree) -> str:
    match tree:
        case ("not" | "F" | "G" as word, body):
            return f"{word} ({text_of(body)})"
        case ("and" | "or" | "U" | "->" as word, left, right):
            return f"(({text_of(left)}) {word} ({text_of(right)}))"
        case ("some" | "every" as word, name, domain, body):
            return f"({word} {name} in {domain_text(domain)}: {text_of(body)})"
        case ("occ", a, lanelet):
            return f"occ({a}, {lanelet})"
        case ("on", a, domain):
            return f"(some x in {domain_text(domain)}: occ({a}, x))"
        case ("compare", what, op, a, b):
            return f"{side_text(what, a)} {op} {side_text(what, b)}"
    raise AssertionError(tree)


SIDES = {"rear": ("s", "length"), "right": ("d", "width")}


def side_text(what: str, a: str) -> str:
    first, *minus = SIDES.get(what, (what,))
    return " - ".join(f"{name}({a})" for name in (first, *minus))


def domain_text(domain) -> str:
    return domain[0] if len(domain) == 1 else f"{domain[0]}({domain[1]})"


def claim_text(tree) -> str:
    given = "given l: lanelet: " if "l" in free_lanelets(tree, frozenset()) else ""
    return f"{given}{text_of(tree)}"


def free_lanelets(tree, bound: frozenset[str]) -> set[str]:
    match tree:
        case ("occ", _, lanelet):
            return {lanelet} - bound
        case ("some" | "every", name, _, body):
            return free_lanelets(body, bound | {name})
        case _:
            return set().union(*(free_lanelets(x, bound) for x in tree if isinstance(x, tuple) and x))


# --- truth ---------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Segment:
    """A point in time, or all of what lies between two; ``values`` has s, d, length, width by vehicle."""

    is_point: bool
    values: Mapping[tuple[str, str], Fraction]


def truth(tree, road: Road, trace: list[Segment], names: Mapping[str, str], at: int = 0) -> bool:
    """Whether the tree is true on the road in segment ``at``; ``names`` gives variables their element."""
    here = trace[at].values
    match tree:
        case ("not", body):
            return not truth(body, road, trace, names, at)
        case ("and", left, right):
            return truth(left, road, trace, names, at) and truth(right, road, trace, names, at)
        case ("or", left, right):
            return truth(left, road, trace, names, at) or truth(right, road, trace, names, at)
        case ("->", left, right):
            return not truth(left, road, trace, names, at) or truth(right, road, trace, names, at)
        case ("F", body):
            return any(truth(body, road, trace, names, k) for k in range(at, len(trace)))
        case ("G", body):
            return all(truth(body, road, trace, names, k) for k in range(at, len(trace)))
        case ("U", left, right):
            return any(until(left, right, road, trace, names, at, k) for k in range(at, len(trace)))
        case ("some", name, domain, body):
            return any(
                truth(body, road, trace, {**names, name: e}, at) for e in elements(domain, road, names)
            )
        case ("every", name, domain, body):
            return all(
                truth(body, road, trace, {**names, name: e}, at) for e in elements(domain, road, names)
            )
        case ("occ", a, lanelet):
            return occupies(a, names[lanelet], road, here)
        case ("on", a, domain):
            return any(occupies(a, lanelet, road, here) for lanelet in elements(domain, road, names))
        case ("compare", what, op, a, b):
            x, y = side(what, a, here), side(what, b, here)
            return {"<=": x <= y, "<": x < y, "=": x == y}[op]
    raise AssertionError(tree)


def until(left, right, road, trace, names, at: int, end: int) -> bool:
    """Whether ``right`` comes in segment ``end``, and ``left`` holds at all moments before it."""
    inside = end > at and not trace[end].is_point
    before = range(at, end + 1 if inside else end)
    return truth(right, road, trace, names, end) and all(truth(left, road, trace, names, k) for k in before)


def side(what: str, a: str, here) -> Fraction:
    if what in SIDES:
        return here[SIDES[what][0], a] - here[SIDES[what][1], a]
    return here[what, a]


def occupies(a: str, lanelet_id: str, road: Road, here) -> bool:
    """Box and rectangle have a common part of positive area."""
    (lanelet,) = [x for x in road.lanelets if x.id == lanelet_id]
    low, high = lanelet.s
    overlap_s = min(here["s", a], here["s", a] if high is None else high) - max(
        side("rear", a, here), side("rear", a, here) if low is None else low
    )
    overlap_d = min(here["d", a], lanelet.d[1]) - max(side("right", a, here), lanelet.d[0])
    return overlap_s > 0 and overlap_d > 0


def elements(domain, road: Road, names: Mapping[str, str]) -> list[str]:
    match domain:
        case ("lanes",):
            return sorted({x.lane for x in road.lanelets})
        case ("lanelets", lane):
            return [x.id for x in road.lanelets if x.lane == names[lane]]
        case ("zone", zone):
            return [x.id for x in road.lanelets if x.zone == zone]
        case ("adjacentLanes", lane):
            pairs = neighbours(road)
            return sorted({x.lane for x in road.lanelets if frozenset((x.lane, names[lane])) in pairs})
    raise AssertionError(domain)


def neighbours(road: Road) -> set[frozenset[str]]:
    """Lanes with lanelets that share a piece of their left and right boundaries (semantics §4)."""
    found = set()
    for a, b in product(road.lanelets, road.lanelets):
        low = max(a.s[0], b.s[0])
        high = min(a.s[1], b.s[1])
        if a.lane != b.lane and a.d[1] == b.d[0] and low < high:
            found.add(frozenset((a.lane, b.lane)))
    return found


def is_road(road: Road) -> bool:
    """Lanelets with an area and a name of their own; lanes that are chains of one attribute."""
    lanes = {x.lane: [y for y in road.lanelets if y.lane == x.lane] for x in road.lanelets}
    chains = [sorted(lane, key=lambda x: x.s[0]) for lane in lanes.values()]
    return (
        len({x.id for x in road.lanelets}) == len(road.lanelets) > 0
        and all(x.s[0] < x.s[1] and x.d[0] < x.d[1] and x.zone in ZONES for x in road.lanelets)
        and all(len({x.attribute for x in chain}) == 1 for chain in chains)
        and all(a.s[1] == b.s[0] for chain in chains for a, b in pairwise(chain))
        and all(max(a.d[0], b.d[0]) < min(a.d[1], b.d[1]) for chain in chains for a, b in pairwise(chain))
        and {frozenset(pair) for pair in road.adjacent} == neighbours(road)
    )


def is_false_there(tree, found: Countermodel) -> bool:
    """Whether a countermodel, by its numbers and its road, is one."""
    speaks = found.road is not None
    road = found.road if speaks else random_road(Random(0))
    trace: list[Segment] = []
    states = [values_of(instant.values) for instant in found.instants]
    for number, state in enumerate(states):
        between = state if found.interpolation == "before" else states[min(number + 1, len(states) - 1)]
        trace += [Segment(True, state), Segment(False, between)]
    names = {"L": "L", "l": "l"}
    return (not speaks or is_road(road)) and not truth(tree, road, trace, names)


def values_of(values: Mapping[str, Fraction]) -> dict[tuple[str, str], Fraction]:
    return {tuple(name.removesuffix(")").split("(")): value for name, value in values.items() if "(" in name}


# --- worlds --------------------------------------------------------------------------------------


def random_road(rng: Random) -> Road:
    """One to three lanes, each a chain of one to three lanelets, on a small grid so that much touches."""
    lanelets: list[Lanelet] = []
    for number in range(rng.randint(1, 3)):
        s, d = rng.randint(0, 4), rng.randint(0, 4)
        width = rng.randint(1, 3)
        for part in range(rng.randint(1, 3)):
            end = s + rng.randint(1, 4)
            lanelets.append(
                Lanelet(
                    f"k{number}.{part}",
                    f"k{number}",
                    rng.choice(ZONES),
                    "main",
                    (Fraction(s), Fraction(end)),
                    (Fraction(d), Fraction(d + width)),
                )
            )
            s, d = end, max(0, d + rng.randint(1 - width, width - 1))
    road = Road("random", tuple(lanelets), frozenset())
    return Road("random", road.lanelets, frozenset(neighbours(road)))


def random_trace(rng: Random) -> list[Segment]:
    sizes = {(size, v): Fraction(rng.randint(1, 4)) for size in ("length", "width") for v in VEHICLES}

    def state():
        return sizes | {(name, v): Fraction(rng.randint(0, 9)) for name in "sd" for v in VEHICLES}

    return [Segment(k % 2 == 0, state()) for k in range(2 * rng.randint(1, 3))]


def is_true_here(tree, road: Road, trace: list[Segment]) -> bool:
    """Whether the tree is true for every lane as L and every lanelet as l."""
    lanes, lanelets = sorted({x.lane for x in road.lanelets}), [x.id for x in road.lanelets]
    return all(truth(tree, road, trace, {"L": a, "l": b}) for a, b in product(lanes, lanelets))
