"""Terms made of terms: what may be compared, added and divided, and what may bound an interval."""

from collections.abc import Mapping, Sequence
from fractions import Fraction

from roadproof.errors import Position, TextError
from roadproof.library.quantity import SECONDS, Quantity, product_dimension, same_dimension, unit_name
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.custom_names import own_signal, own_truth
from roadproof.logic.formula import Formula
from roadproof.logic.syntax import Binding, Definition, ParameterDeclaration, SignalDeclaration
from roadproof.world.units import UNITS

COMPARISONS = ("<", "<=", ">", ">=", "=", "!=")
Parameters = Mapping[str, ParameterDeclaration]


class ValueOfTermError(TextError):
    """A term does not fit because of what it may be worth, which may depend on a definition's arguments."""


def literal(value: Fraction, unit: str) -> Quantity:
    """A number as it is written; 0 without a unit fits every dimension."""
    factor, dimension = UNITS[unit or "unitless"]
    return Quantity(t.Number(value * factor, dimension), None if not unit and value == 0 else dimension)


def of_vehicle(name: str, vehicle: str) -> Quantity:
    """A size or a signal of a vehicle."""
    for size, dimension in t.SIZE_DIMENSIONS.items():
        if name == size:
            return Quantity(t.Size(size, vehicle), dimension)
    for signal, dimension in t.SIGNAL_DIMENSIONS.items():
        if name == signal:
            return Quantity(t.Signal(signal, vehicle), dimension)
    raise AssertionError(name)


def own(signal: SignalDeclaration, vehicle: str) -> Formula | Quantity:
    """An own signal that is not derived: a number, or that it is true."""
    made = own_signal(signal, vehicle)
    return own_truth(made) if made.truth else Quantity(made, made.dimension)


def check_derived(signal: SignalDeclaration, made: Formula | Quantity, at: Position) -> None:
    """What an own signal is derived by has to be what it is declared as."""
    if isinstance(made, Quantity) != (signal.sort != "bool"):
        found = "a number" if isinstance(made, Quantity) else "a formula"
        raise TextError(f"signal '{signal.name}' is declared {signal.sort}, but derived by {found}", at)
    if isinstance(made, Quantity) and made.dimension not in (None, UNITS[signal.sort][1]):
        raise TextError(
            f"signal '{signal.name}' is declared in {signal.sort}, but derived in "
            f"{unit_name(made.dimension)}",
            at,
        )


def argument(given: Quantity, binding: Binding, definition: Definition, at: Position) -> Quantity:
    """A number as an argument of a definition, in the unit that it is declared with."""
    wanted = UNITS[binding.sort][1]
    if given.dimension not in (None, wanted):
        raise TextError(
            f"argument {binding.name} of '{definition.name}' is in {binding.sort}, "
            f"but this is in {unit_name(given.dimension)}",
            at,
        )
    return Quantity(given.term, wanted)


def compare(op: str, left: Quantity, right: Quantity, at: Position) -> Formula:
    """``left op right``; an equality is two comparisons."""
    same_dimension(left, right, "compared", at)
    one, other = left.term, right.term
    match op:
        case "<" | "<=" | ">" | ">=":
            return f.Compare(one, op, other)
        case "=":
            return f.And((f.Compare(one, "<=", other), f.Compare(one, ">=", other)))
        case _:
            return f.Or((f.Compare(one, "<", other), f.Compare(one, ">", other)))


def negative(quantity: Quantity, at: Position) -> Quantity:
    """``-quantity``."""
    refuse_inverse(at, quantity)
    return Quantity(t.negate(quantity.term), quantity.dimension)


def combine(op: str, left: Quantity, right: Quantity, parameters: Parameters, at: Position) -> Quantity:
    """``left op right`` where ``op`` is + - * / or ^."""
    refuse_inverse(at, left, right)
    match op:
        case "+":
            return Quantity(t.Sum((left.term, right.term)), same_dimension(left, right, "added", at))
        case "-":
            return Quantity(t.subtract(left.term, right.term), same_dimension(left, right, "added", at))
        case "*":
            return Quantity(t.Product((left.term, right.term)), product_dimension(left, right, 1))
        case "/":
            _refuse_zero(right.term, parameters, at)
            return Quantity(t.Quotient(left.term, right.term), product_dimension(left, right, -1))
        case _:
            exponent = t.constant_value(right.term)
            assert exponent is not None, "the grammar admits only a number as exponent"
            metres, seconds = left.dimension or (0, 0)
            power = int(exponent)
            return Quantity(t.Power(left.term, power), (metres * power, seconds * power))


def _refuse_zero(denominator: t.Term, parameters: Parameters, at: Position) -> None:
    if not _is_positive(denominator, parameters):
        raise ValueOfTermError(
            "the divisor must be greater than zero whatever happens",
            at,
            "Use numbers and parameters declared with where … > 0; or multiply the other side of the "
            "comparison; or write inverse(…), where inverse(0) is infinite.",
        )


def _is_positive(term: t.Term, parameters: Parameters, or_zero: bool = False) -> bool:
    """Whether ``term`` is greater than zero (or not below it) by its form alone."""
    match term:
        case t.Number(value, _):
            return value > 0 or (or_zero and value == 0)
        case t.Parameter(name, _):
            bound = parameters[name].bound
            return bound == ">" or (or_zero and bound == ">=")
        case t.Size():
            return True
        case t.Sum() | t.Product() | t.Power() | t.Quotient() | t.Maximum() | t.Minimum():
            return all(_is_positive(child, parameters, or_zero) for child in t.children(term))
        case _:
            return False


def absolute(quantity: Quantity, at: Position) -> Quantity:
    """``abs(quantity)``."""
    refuse_inverse(at, quantity)
    return Quantity(t.Maximum((quantity.term, t.negate(quantity.term))), quantity.dimension)


def inverse(quantity: Quantity, at: Position) -> Quantity:
    """``inverse(quantity)``, infinite at 0."""
    refuse_inverse(at, quantity)
    one = Quantity(quantity.term, (0, 0))
    return Quantity(t.Inverse(quantity.term), product_dimension(one, quantity, -1))


def extremum(name: str, quantities: Sequence[Quantity], at: Position) -> Quantity:
    """``max`` or ``min`` of at least one quantity."""
    for other in quantities[1:]:
        same_dimension(quantities[0], other, "compared", at)
    refuse_inverse(at, *quantities)
    dimension = next((q.dimension for q in quantities if q.dimension is not None), None)
    make = t.Maximum if name == "max" else t.Minimum
    return Quantity(make(tuple(q.term for q in quantities)), dimension)


def refuse_inverse(at: Position, *quantities: Quantity) -> None:
    if any(isinstance(quantity.term, t.Inverse) for quantity in quantities):
        raise TextError("inverse(…) may only stand alone on one side of a comparison", at)


def interval(low: t.Term, high: t.Term | None, at: Position) -> f.Interval:
    """The interval between two bounds. Raises ``TextError`` where it is empty or starts in the past."""
    low_value = t.constant_value(low)
    high_value = None if high is None else t.constant_value(high)
    if low_value is not None and low_value < 0:
        raise ValueOfTermError(f"an interval may not start in the past: low={low_value}", at)
    if low_value is not None and high_value is not None and high_value < low_value:
        raise ValueOfTermError(
            f"the interval is empty: low={low_value} is above high={high_value}",
            at,
            "Write the smaller bound first.",
        )
    return f.Interval(low, high)


def bound(quantity: Quantity, parameters: Parameters, at: Position) -> t.Term:
    """A bound of an interval, in seconds: a number, or a term of parameters that is never negative."""
    value = t.constant_value(quantity.term)
    if (value is None or quantity.dimension not in (None, (0, 0))) and quantity.dimension != SECONDS:
        raise TextError(f"an interval bound is a time, but this is in {unit_name(quantity.dimension)}", at)
    if any(isinstance(leaf, t.Varying) for leaf in t.leaves(quantity.term)):
        raise TextError("an interval bound may not depend on a vehicle's motion", at)
    if value is None and not _is_positive(quantity.term, parameters, or_zero=True):
        raise ValueOfTermError(
            "an interval bound may never be negative",
            at,
            "Use numbers and parameters declared with where … >= 0, added or multiplied.",
        )
    return quantity.term if value is None else t.Number(value, SECONDS)
