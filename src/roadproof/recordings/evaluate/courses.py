"""What is asked of matches about driver models: that a manoeuvre begins, and that it ends in a collision."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

from roadproof.drivers.manoeuvres import MANOEUVRES
from roadproof.drivers.models import MODELS, course_in, foreseen, unpreventable
from roadproof.errors import UsageError
from roadproof.library.elaborate import read_claim
from roadproof.library.specification import Specification
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import with_values, without_names
from roadproof.semantics.sampled.compiled import Monitor, compile

BEGINS = "begins"


@dataclass(frozen=True)
class Course:
    """A manoeuvre: the ``scenarios`` that it is the course of, and its ``vehicles``, SV first.

    ``begins`` is asked whether it begins in a state (BEGINS); ``collides``, by the name of a model, whether
    it ends in a collision from this state on though SV is driven so.
    """

    scenarios: tuple[int, ...]
    vehicles: tuple[str, ...]
    begins: Monitor[str]
    collides: Monitor[str]


def courses_of(
    sets: Sequence[Specification],
    values: Mapping[str, Fraction],
    drivers: Sequence[str],
    scenarios: Sequence[int],
) -> Iterator[Course]:
    """The courses of the scenarios of which one of the models speaks, at ``values`` of parameters (SI).

    Raises ``UsageError`` where a formula is not the same in all sets.
    """
    for name, manoeuvre in MANOEUVRES.items():
        numbers = tuple(number for number in scenarios if course_in(number) == name)
        models = [model for model in drivers if name in MODELS[model].manoeuvres]
        if numbers and models:
            texts = {model: unpreventable(name, model, manoeuvre.vehicles) for model in models}
            texts[BEGINS] = foreseen(name, manoeuvre.vehicles)
            formulas = {key: _meaning(sets, values, text) for key, text in texts.items()}
            begins = compile({BEGINS: formulas.pop(BEGINS)})
            yield Course(numbers, manoeuvre.vehicles, begins, compile(formulas))


def _meaning(sets: Sequence[Specification], values: Mapping[str, Fraction], text: str) -> Formula:
    first, *others = (with_values(read_claim(x, text).formula, values) for x in sets)
    for other, spec in zip(others, sets[1:], strict=True):
        if without_names(other) != without_names(first):
            raise UsageError(
                f"evaluate: {text} differs between the sets {sets[0].set_name} and {spec.set_name}; "
                "evaluate these sets one at a time"
            )
    return first
