"""Elaboration of arithmetic and of temporal operators, with dimensions and the bounds of intervals."""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Literal, TypeAlias, assert_never

from roadproof.errors import Position, TextError
from roadproof.library.quantity import (
    DURATION,
    SECONDS,
    Quantity,
    dimension_of,
    product_dimension,
    same_dimension,
    unit_name,
)
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.custom_names import custom_signal, signal_is_true
from roadproof.logic.formula import Formula
from roadproof.logic.syntax import (
    Binding,
    Definition,
    ParameterDeclaration,
    SignalDeclaration,
    TemporalOperator,
)
from roadproof.world.units import UNITS

ComparisonOperator: TypeAlias = Literal["<", "<=", ">", ">=", "=", "!="]
ArithmeticOperator: TypeAlias = Literal["+", "-", "*", "/", "^"]
Parameters: TypeAlias = Mapping[str, ParameterDeclaration]


class ValueOfTermError(TextError):
    """The error for a term whose value does not fit, perhaps only for some arguments of a definition."""


def literal(value: Fraction, unit: str) -> Quantity:
    """Return a number as it is written; 0 without a unit fits every dimension."""
    factor, dimension = UNITS[unit or "unitless"]
    return Quantity(t.Number(value * factor, dimension), None if not unit and value == 0 else dimension)


def of_vehicle(name: str, vehicle: str) -> Quantity:
    """Return a size or a signal of a vehicle."""
    for size, dimension in t.SIZE_DIMENSIONS.items():
        if name == size:
            return Quantity(t.Size(size, vehicle), dimension)
    for signal, dimension in t.SIGNAL_DIMENSIONS.items():
        if name == signal:
            return Quantity(t.Signal(signal, vehicle), dimension)
    raise AssertionError(name)


def custom_signal_value(signal: SignalDeclaration, vehicle: str) -> Formula | Quantity:
    """Return a custom signal that is not derived: a number, or the formula that it is true."""
    term = custom_signal(signal, vehicle)
    return signal_is_true(term) if term.truth else Quantity(term, term.dimension)


def check_derived(signal: SignalDeclaration, body: Formula | Quantity, at: Position) -> None:
    """Raise ``TextError`` unless the body of a derived custom signal has the declared type and unit."""
    if isinstance(body, Quantity) != (signal.sort != "bool"):
        kind = "a number" if isinstance(body, Quantity) else "a formula"
        raise TextError(f"signal '{signal.name}' is declared {signal.sort}, but derived by {kind}", at)
    if isinstance(body, Quantity) and body.dimension not in (None, UNITS[signal.sort][1]):
        raise TextError(
            f"signal '{signal.name}' is declared in {signal.sort}, but derived in "
            f"{unit_name(body.dimension)}",
            at,
        )


def argument(
    quantity: Quantity, binding: Binding, definition: Definition, parameters: Parameters, at: Position
) -> Quantity:
    """Return a number as an argument of a definition.

    Raises ``TextError`` for another unit than declared, and for a duration that may be negative.
    """
    dimension = dimension_of(binding.sort)
    if quantity.dimension not in (None, dimension):
        shown = "s" if binding.sort == DURATION else binding.sort
        raise TextError(
            f"argument {binding.name} of '{definition.name}' is in {shown}, "
            f"but this is in {unit_name(quantity.dimension)}",
            at,
        )
    if binding.sort == DURATION and not _is_positive(quantity.term, parameters, or_zero=True):
        raise ValueOfTermError(
            f"argument {binding.name} of '{definition.name}' is a duration, which may never be negative",
            at,
            "Use numbers and parameters declared with where … >= 0, added or multiplied.",
        )
    return Quantity(quantity.term, dimension)


def compare(op: ComparisonOperator, left: Quantity, right: Quantity, at: Position) -> Formula:
    """Return ``left op right``; an equality becomes two comparisons."""
    same_dimension(left, right, "compared", at)
    left_term, right_term = left.term, right.term
    match op:
        case "<" | "<=" | ">" | ">=":
            return f.Compare(left_term, op, right_term)
        case "=":
            return f.And((f.Compare(left_term, "<=", right_term), f.Compare(left_term, ">=", right_term)))
        case "!=":
            return f.Or((f.Compare(left_term, "<", right_term), f.Compare(left_term, ">", right_term)))
        case _:
            assert_never(op)


def negative(quantity: Quantity, at: Position) -> Quantity:
    """Return ``-quantity``."""
    refuse_inverse(at, quantity)
    return Quantity(t.negate(quantity.term), quantity.dimension)


def combine(
    op: ArithmeticOperator, left: Quantity, right: Quantity, parameters: Parameters, at: Position
) -> Quantity:
    """Return ``left op right``. Raises ``TextError`` for wrong dimensions, and a divisor that may be zero."""
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
        case "^":
            exponent = t.constant_value(right.term)
            assert exponent is not None, "the grammar admits only a number as exponent"
            metres, seconds = left.dimension or (0, 0)
            power = int(exponent)
            return Quantity(t.Power(left.term, power), (metres * power, seconds * power))
        case _:
            assert_never(op)


def _refuse_zero(denominator: t.Term, parameters: Parameters, at: Position) -> None:
    if not _is_positive(denominator, parameters):
        raise ValueOfTermError(
            "the divisor must be greater than zero whatever happens",
            at,
            "Use numbers and parameters declared with where … > 0; or multiply the other side of the "
            "comparison; or write inverse(…), where inverse(0) is infinite.",
        )


def _is_positive(term: t.Term, parameters: Parameters, or_zero: bool = False) -> bool:
    """Return whether the form of ``term`` shows that it is positive (or not negative, with ``or_zero``)."""
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
        case t.Variable() | t.Signal() | t.CustomSignal() | t.Inverse():
            return False
        case _:
            assert_never(term)


def absolute(quantity: Quantity, at: Position) -> Quantity:
    """Return ``abs(quantity)``."""
    refuse_inverse(at, quantity)
    return Quantity(t.Maximum((quantity.term, t.negate(quantity.term))), quantity.dimension)


def inverse(quantity: Quantity, at: Position) -> Quantity:
    """Return ``inverse(quantity)``, infinite at 0."""
    refuse_inverse(at, quantity)
    one = Quantity(quantity.term, (0, 0))
    return Quantity(t.Inverse(quantity.term), product_dimension(one, quantity, -1))


def extremum(name: str, quantities: Sequence[Quantity], at: Position) -> Quantity:
    """Return ``max`` or ``min`` of at least one quantity."""
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
    """Return the interval between two bounds. Raises ``TextError`` if it is empty or starts in the past."""
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
    """Return a bound of an interval in seconds: a number, or a term of parameters that is never negative."""
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


def temporal(op: TemporalOperator, left: Formula, interval: f.Interval, right: Formula) -> Formula:
    """Return the formula of a temporal operator; ``left`` counts for those with two sides."""
    match op:
        case "U":
            return f.Until(left, interval, right)
        case "S":
            return f.Since(left, interval, right)
        case "W":
            return f.weak_until(left, interval, right)
        case "R":
            return f.release(left, interval, right)
        case "F":
            return f.Eventually(interval, right)
        case "G":
            return f.Always(interval, right)
        case "O":
            return f.once(interval, right)
        case "H":
            return f.historically(interval, right)
        case _:
            assert_never(op)


def edge(name: str, body: Formula, time: t.Term, at: Position) -> Formula:
    """Return ``rise(body, time)``: it holds, and did not at some instant of the last ``time``.

    Any other ``name`` is ``fall``: the same of its negation. Raises ``TextError`` for a negative time.
    """
    now, before = (body, f.negation(body)) if name == "rise" else (f.negation(body), body)
    return f.conjunction(now, f.once(interval(f.ZERO, time, at), before))
