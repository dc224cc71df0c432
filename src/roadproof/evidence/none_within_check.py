"""Checks the trees of a NONE-WITHIN: the encoder derives the program of each lane assignment again."""

from collections.abc import Callable, Iterator
from typing import TypeAlias

from roadproof.evidence.answers import none_within as json_types
from roadproof.evidence.none_within import NoneWithinFile
from roadproof.evidence.program import DisjunctiveProgram, refutes
from roadproof.library.specification import Library
from roadproof.runtime.records import dataclass
from roadproof.world.models import load_road, load_vehicle, names_of


@dataclass(frozen=True)
class Derived:
    """The programs that the encoder derives, one for each lane assignment, and the limits as text."""

    programs: tuple[DisjunctiveProgram, ...]
    limits: str


Derive: TypeAlias = Callable[[NoneWithinFile, Library], Derived]


def first_fault(file: NoneWithinFile, derived: Derived) -> str:
    """Return why a tree does not refute its program; empty if all do."""
    for (lanes, tree), program in zip(file.refutations, derived.programs, strict=True):
        if not refutes(program, tree):
            named = ", ".join(f"{name}={lane}" for name, lane in lanes.items())
            return f"its tree{f' for {named}' if named else ''} does not refute the program of the question"
    return ""


def deviations(file: NoneWithinFile) -> Iterator[str]:
    """Yield a text for each vehicle model and road that differs from the bundled one of the same name."""
    for vehicle, model in file.vehicles.items():
        bundled = load_vehicle(model.name) if model.name in names_of("vehicles") else None
        fields = (name for name in json_types.VehicleModelData.__annotations__ if name != "name")
        changed = [x for x in fields if bundled is None or getattr(model, x) != getattr(bundled, x)]
        if changed:
            yield f"{vehicle}={model.name} with " + ", ".join(
                f"{x}={_value_text(getattr(model, x))}" for x in changed
            )
    road = file.road
    if road.name not in names_of("roads") or load_road(road.name) != road:
        yield f"road {road.name} as in the file, with {len(road.lanelets)} lanelets"


def _value_text(value: object) -> str:
    return f"{value[0]}..{value[1]}" if isinstance(value, tuple) else str(value)
