"""Files that show a NONE-WITHIN: a question with its limits, and a tree for each assignment of lanes.

The encoder derives a program for each assignment from the question; reading the file checks its fields only.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from fractions import Fraction
from typing import TypeAlias, assert_never, get_args

from roadproof.errors import InputError
from roadproof.evidence.answers import none_within as kept
from roadproof.evidence.codec import read, write
from roadproof.evidence.drive_file import road_of, road_said
from roadproof.evidence.program import Cases, Cut, Fact, Kind, Program, Sum, Tree, refutes
from roadproof.evidence.strict import JsonObject, is_rational, rational
from roadproof.library.specification import Library
from roadproof.runtime.records import dataclass
from roadproof.world.models import load_road, load_vehicle, names_of
from roadproof.world.road import Road
from roadproof.world.signals import LIMITED, SIZES
from roadproof.world.vehicle import Vehicle

SCHEMA = kept.SCHEMA


@dataclass(frozen=True)
class NoneWithinFile:
    """A question with its limits; ``refutations``: each assignment of free lanes with its tree."""

    scenario: int | None
    set_name: str
    formula: str
    horizon: Fraction
    dt: Fraction
    reach: Fraction
    overlaps_allowed: bool
    values: Mapping[str, Fraction]
    options: Mapping[str, str]
    road: Road
    vehicles: Mapping[str, Vehicle]
    refutations: tuple[tuple[Mapping[str, str], Tree], ...]


@dataclass(frozen=True)
class Derived:
    """What the encoder makes of a file: a program for each of its assignments of lanes, and its limits."""

    programs: tuple[Program, ...]
    limits: str


Derive: TypeAlias = Callable[[NoneWithinFile, Library], Derived]


def first_fault(file: NoneWithinFile, derived: Derived) -> str:
    """Why a file does not show what it says, '' where it does."""
    for (lanes, tree), program in zip(file.refutations, derived.programs, strict=True):
        if not refutes(program, tree):
            named = ", ".join(f"{name}={lane}" for name, lane in lanes.items())
            return f"its tree{f' for {named}' if named else ''} does not refute the program of the question"
    return ""


def own_parts(file: NoneWithinFile) -> Iterator[str]:
    """Where models and the road are not those that roadproof has under their names."""
    for vehicle, model in file.vehicles.items():
        known = load_vehicle(model.name) if model.name in names_of("vehicles") else None
        fields = (name for name in kept.Model.__annotations__ if name != "name")
        own = [x for x in fields if known is None or getattr(model, x) != getattr(known, x)]
        if own:
            yield f"{vehicle}={model.name} with " + ", ".join(f"{x}={_told(getattr(model, x))}" for x in own)
    road = file.road
    if road.name not in names_of("roads") or load_road(road.name) != road:
        yield f"road {road.name} as in the file, with {len(road.lanelets)} lanelets"


def _told(value: object) -> str:
    return f"{value[0]}..{value[1]}" if isinstance(value, tuple) else str(value)


def none_within_data(file: NoneWithinFile) -> JsonObject:
    """The file as plain data."""
    models = {
        name: kept.Model(**{key: getattr(x, key) for key in kept.Model.__annotations__})
        for name, x in file.vehicles.items()
    }
    return write(
        kept.NoneWithin(
            scenario=file.scenario,
            set=file.set_name,
            formula=file.formula,
            horizon=file.horizon,
            dt=file.dt,
            reach=file.reach,
            overlaps_allowed=file.overlaps_allowed,
            parameters={name: str(x) for name, x in file.values.items()} | dict(file.options),
            road=road_said(file.road),
            vehicles=models,
            refutations=tuple(
                kept.Refutation(lanes=lanes, tree=tuple(lines_of(tree))) for lanes, tree in file.refutations
            ),
        )
    )


def read_none_within(content: object, where: str) -> NoneWithinFile:
    """The inverse of ``none_within_data``. Raises ``InputError``."""
    said: kept.NoneWithin = read(kept.NoneWithin, content, where)
    if said.horizon < 0 or said.dt <= 0 or said.reach < 0:
        raise InputError(f"{where}: horizon and reach must be at least 0, and dt above 0")
    road = road_of(said.road, f"{where}, road")
    if not road.lanelets:
        raise InputError(f"{where}, road: it needs at least one lanelet")
    written = said.parameters
    numbers = {n: rational(x, f"{where}, parameters.{n}") for n, x in written.items() if is_rational(x)}
    return NoneWithinFile(
        said.scenario,
        said.set,
        said.formula,
        said.horizon,
        said.dt,
        said.reach,
        said.overlaps_allowed,
        numbers,
        {name: x for name, x in written.items() if name not in numbers},
        road,
        {name: _vehicle(x, f"{where}, vehicle {name}") for name, x in said.vehicles.items()},
        tuple(
            (x.lanes, tree_of(x.tree, f"{where}, refutation {k}")) for k, x in enumerate(said.refutations, 1)
        ),
    )


def _vehicle(said: kept.Model, where: str) -> Vehicle:
    """Only natural drives depend on the fields that the file does not have."""
    for size in SIZES:
        if getattr(said, size) <= 0:
            raise InputError(f"{where}: {size}={getattr(said, size)}, but it must be greater than 0")
    if said.v_lon[0] < 0:
        raise InputError(f"{where}: v_lon starts at {said.v_lon[0]}, but a vehicle never reverses")
    for name in LIMITED:
        low, high = getattr(said, name)
        if low > high:
            raise InputError(f"{where}: {name} from {low} to {high} is empty")
    return Vehicle(
        **{name: getattr(said, name) for name in kept.Model.__annotations__},
        cruise=said.v_lon,
        jump_lon=Fraction(0),
        jump_lat=Fraction(0),
    )


# --- trees as lines: each node before its branches -----------------------------------------------------


def lines_of(tree: Tree) -> Iterator[str]:
    """``sum`` with facts and multipliers, ``cases`` with node and number of parts, ``cut`` with its place."""
    waiting: list[Tree] = [tree]
    while waiting:
        found = waiting.pop()
        match found:
            case Sum(weights):
                yield "sum " + ", ".join(f"{_fact(fact)} * {weight}" for fact, weight in weights)
            case Cases(node, trees):
                yield f"cases {node} {len(trees)}"
                waiting += reversed(trees)
            case Cut(column, at, low, high):
                yield f"cut {column} {at}"
                waiting += [high, low]
            case _:
                assert_never(found)


_ENDS: Mapping[str, int] = {"corner": 2, "tangent": 1}


def _fact(fact: Fact) -> str:
    ends = fact.ends[: _ENDS.get(fact.kind, 0)]
    return " ".join(map(str, (fact.kind, fact.number, *ends)))


def tree_of(lines: Sequence[str], where: str) -> Tree:
    """The inverse of ``lines_of``. Raises ``InputError``."""
    done: list[Tree] = []
    for line in reversed(lines):
        word, _, rest = line.partition(" ")
        try:
            if word == "sum":
                done.append(Sum(tuple(_weight(x) for x in rest.split(", "))))
                continue
            first, second = map(int, rest.split(" "))
            count = second if word == "cases" else 2
            if count < 0 or count > len(done):
                raise ValueError
            parts = tuple(done.pop() for _ in range(count))
            done.append(Cases(first, parts) if word == "cases" else Cut(first, second, *parts))
        except ValueError:
            raise InputError(f"{where}: {line[:60]!r} is no node of a tree") from None
    if len(done) != 1:
        raise InputError(f"{where}: its lines are no tree")
    return done[0]


def _weight(text: str) -> tuple[Fact, int]:
    """Raises ``ValueError``."""
    fact, weight = text.split(" * ")
    word, number, *ends = fact.split(" ")
    kind = next(x for x in (*get_args(Kind), None) if x in (word, None))
    if kind is None or len(ends) != _ENDS.get(kind, 0):
        raise ValueError
    first, second = (*map(int, ends), 0, 0)[:2]
    return Fact(kind, int(number), (first, second)), int(weight)
