"""The JSON file that shows a NONE-WITHIN: a question with its limits, and a tree for each lane assignment."""

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from typing import assert_never, get_args

from roadproof.errors import InputError
from roadproof.evidence.answers import none_within as json_types
from roadproof.evidence.codec import read, write
from roadproof.evidence.drive_file import road_data, road_of
from roadproof.evidence.none_within import NoneWithinFile
from roadproof.evidence.program import CaseSplit, ColumnSplit, Fact, FactKind, Tree, WeightedSum
from roadproof.evidence.strict import JsonObject, is_rational, rational
from roadproof.world.signals import LIMITED, SIZES
from roadproof.world.vehicle import Vehicle


def none_within_data(file: NoneWithinFile) -> JsonObject:
    """Return the file as JSON."""
    models = {
        name: json_types.VehicleModelData(
            **{key: getattr(x, key) for key in json_types.VehicleModelData.__annotations__}
        )
        for name, x in file.vehicles.items()
    }
    return write(
        json_types.NoneWithinData(
            scenario=file.scenario,
            set=file.set_name,
            formula=file.formula,
            horizon=file.horizon,
            dt=file.dt,
            reach=file.reach,
            overlaps_allowed=file.overlaps_allowed,
            parameters={name: str(x) for name, x in file.values.items()} | dict(file.options),
            road=road_data(file.road),
            vehicles=models,
            refutations=tuple(
                json_types.RefutationTree(lanes=lanes, tree=tuple(lines_of(tree)))
                for lanes, tree in file.refutations
            ),
        )
    )


def read_none_within(content: object, where: str) -> NoneWithinFile:
    """Return the file in parsed JSON, the inverse of ``none_within_data``. Raises ``InputError``."""
    stored: json_types.NoneWithinData = read(json_types.NoneWithinData, content, where)
    if stored.horizon < 0 or stored.dt <= 0 or stored.reach < 0:
        raise InputError(f"{where}: horizon and reach must be at least 0, and dt above 0")
    road = road_of(stored.road, f"{where}, road")
    if not road.lanelets:
        raise InputError(f"{where}, road: it needs at least one lanelet")
    parameters = stored.parameters
    numbers = {n: rational(x, f"{where}, parameters.{n}") for n, x in parameters.items() if is_rational(x)}
    return NoneWithinFile(
        stored.scenario,
        stored.set,
        stored.formula,
        stored.horizon,
        stored.dt,
        stored.reach,
        stored.overlaps_allowed,
        numbers,
        {name: x for name, x in parameters.items() if name not in numbers},
        road,
        {name: _vehicle(x, f"{where}, vehicle {name}") for name, x in stored.vehicles.items()},
        tuple(
            (x.lanes, tree_of(x.tree, f"{where}, refutation {k}"))
            for k, x in enumerate(stored.refutations, 1)
        ),
    )


def _vehicle(stored: json_types.VehicleModelData, where: str) -> Vehicle:
    """Return the vehicle model; fields that the file lacks concern natural drives only, and get defaults."""
    for size in SIZES:
        if getattr(stored, size) <= 0:
            raise InputError(f"{where}: {size}={getattr(stored, size)}, but it must be greater than 0")
    if stored.v_lon[0] < 0:
        raise InputError(f"{where}: v_lon starts at {stored.v_lon[0]}, but a vehicle never reverses")
    for name in LIMITED:
        low, high = getattr(stored, name)
        if low > high:
            raise InputError(f"{where}: {name} from {low} to {high} is empty")
    return Vehicle(
        **{name: getattr(stored, name) for name in json_types.VehicleModelData.__annotations__},
        cruise=stored.v_lon,
        jump_lon=Fraction(0),
        jump_lat=Fraction(0),
    )


def lines_of(tree: Tree) -> Iterator[str]:
    """Yield a line for each node of a tree, parents first: ``sum`` with facts, ``cases`` or ``cut`` with
    numbers.
    """
    waiting: list[Tree] = [tree]
    while waiting:
        branch = waiting.pop()
        match branch:
            case WeightedSum(weights):
                yield "sum " + ", ".join(f"{_fact(fact)} * {weight}" for fact, weight in weights)
            case CaseSplit(node, trees):
                yield f"cases {node} {len(trees)}"
                waiting += reversed(trees)
            case ColumnSplit(column, at, low, high):
                yield f"cut {column} {at}"
                waiting += [high, low]
            case _:
                assert_never(branch)


_ENDS: Mapping[str, int] = {"corner": 2, "tangent": 1}


def _fact(fact: Fact) -> str:
    ends = fact.ends[: _ENDS.get(fact.kind, 0)]
    return " ".join(map(str, (fact.kind, fact.number, *ends)))


def tree_of(lines: Sequence[str], where: str) -> Tree:
    """Return the tree of its lines, the inverse of ``lines_of``. Raises ``InputError``."""
    subtrees: list[Tree] = []
    for line in reversed(lines):
        word, _, rest = line.partition(" ")
        try:
            if word == "sum":
                subtrees.append(WeightedSum(tuple(_weight(x) for x in rest.split(", "))))
                continue
            first, second = map(int, rest.split(" "))
            count = second if word == "cases" else 2
            if count < 0 or count > len(subtrees):
                raise ValueError
            parts = tuple(subtrees.pop() for _ in range(count))
            subtrees.append(
                CaseSplit(first, parts) if word == "cases" else ColumnSplit(first, second, *parts)
            )
        except ValueError:
            raise InputError(f"{where}: {line[:60]!r} is no node of a tree") from None
    if len(subtrees) != 1:
        raise InputError(f"{where}: its lines are no tree")
    return subtrees[0]


def _weight(text: str) -> tuple[Fact, int]:
    """Return a fact and its multiplier from text. Raises ``ValueError``."""
    fact, weight = text.split(" * ")
    word, number, *ends = fact.split(" ")
    kind = next(x for x in (*get_args(FactKind), None) if x in (word, None))
    if kind is None or len(ends) != _ENDS.get(kind, 0):
        raise ValueError
    first, second = (*map(int, ends), 0, 0)[:2]
    return Fact(kind, int(number), (first, second)), int(weight)
