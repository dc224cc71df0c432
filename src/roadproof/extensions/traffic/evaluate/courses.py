"""Manoeuvres that driver models are put into: in which matches they are, and when they begin."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

from roadproof.errors import UsageError
from roadproof.extensions.drivers.driver_settings import DriverSettings
from roadproof.extensions.drivers.manoeuvres import MANOEUVRES, ManoeuvreName
from roadproof.extensions.drivers.models import MODELS, course_in, foreseen
from roadproof.library.elaborate import read_claim
from roadproof.library.specification import Specification
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import with_values, without_names
from roadproof.semantics.sampled.compiled import Monitor, compile

BEGINS = "begins"


@dataclass(frozen=True)
class ManoeuvreTest:
    """A manoeuvre: the ``scenarios`` that it is the course of, and its ``vehicles``, SV first.

    ``begins`` is asked whether it begins in a state (BEGINS). ``models`` are those that speak of it, with
    their ``settings``.
    """

    name: ManoeuvreName
    scenarios: tuple[int, ...]
    vehicles: tuple[str, ...]
    begins: Monitor[str]
    models: tuple[str, ...]
    settings: DriverSettings


def manoeuvre_tests(
    sets: Sequence[Specification],
    values: Mapping[str, Fraction],
    drivers: Sequence[str],
    scenarios: Sequence[int],
) -> Iterator[ManoeuvreTest]:
    """The courses of the scenarios of which one of the models speaks, at ``values`` of parameters (SI).

    Raises ``UsageError`` where a formula is not the same in all sets.
    """
    for name, manoeuvre in MANOEUVRES.items():
        numbers = tuple(number for number in scenarios if course_in(number) == name)
        models = tuple(MODELS[x].name for x in drivers if name in MODELS[x].manoeuvres)
        if numbers and models:
            begins = compile({BEGINS: _meaning(sets, values, foreseen(name, manoeuvre.vehicles))})
            settings = DriverSettings(values, sets[0].options)
            yield ManoeuvreTest(name, numbers, manoeuvre.vehicles, begins, models, settings)


def _meaning(sets: Sequence[Specification], values: Mapping[str, Fraction], text: str) -> Formula:
    first, *others = (with_values(read_claim(x, text).formula, values) for x in sets)
    for other, spec in zip(others, sets[1:], strict=True):
        if without_names(other) != without_names(first):
            raise UsageError(
                f"evaluate: {text} differs between the sets {sets[0].set_name} and {spec.set_name}; "
                "evaluate these sets one at a time"
            )
    return first
