"""Formulas made of what users wrote: parts added to a claim, comparisons with a number, as text again."""

from collections.abc import Iterable
from fractions import Fraction

from roadproof.logic import syntax
from roadproof.logic.parse import parse_claim
from roadproof.logic.show import text
from roadproof.logic.syntax import BinaryOperator, Expression
from roadproof.logic.terms import Dimension
from roadproof.units import SI


def conjoin(claim: str, parts: Iterable[Expression]) -> str:
    """``claim`` and all of ``parts``, its ``given`` kept in front; as it is where there are none."""
    added = tuple(parts)
    if not added:
        return claim
    parsed = parse_claim(claim)
    return text(syntax.Claim(parsed.given, syntax.Chain("and", (parsed.body, *added))))


def given_of(claim: syntax.Claim) -> str:
    """What a claim declares in front, as text to be put in front of others."""
    if not claim.given:
        return ""
    return text(syntax.Claim(claim.given, syntax.Literal_(True))).removesuffix("true")


def expression(written: str) -> Expression:
    """What a user wrote, as a part to be added. Raises ``TextError``."""
    return parse_claim(written).body


def compared(left: Expression, op: BinaryOperator, value: Fraction, dimension: Dimension) -> Expression:
    """``left op value``, where ``value`` is in SI units of ``dimension``."""
    return syntax.Binary(op, left, quantity(value, dimension))


def quantity(value: Fraction, dimension: Dimension) -> Expression:
    """A number with its unit; where no unit has that dimension, a product of metres and seconds."""
    unit = SI.get(dimension)
    number: Expression = syntax.Literal_(abs(value), "" if unit in (None, "unitless") else unit or "")
    if unit is None:
        for power, base in zip(dimension, ("m", "s"), strict=True):
            for _ in range(abs(power)):
                number = syntax.Binary("*" if power > 0 else "/", number, syntax.Literal_(Fraction(1), base))
    return syntax.Prefix("-", number) if value < 0 else number


def unit_text(dimension: Dimension) -> str:
    """The unit in which values of ``dimension`` are printed; empty without dimension."""
    if dimension == (0, 0):
        return ""
    metres, seconds = dimension
    return SI.get(dimension) or f"m^{metres} s^{seconds}"


def eventually(parts: Iterable[Expression]) -> Expression:
    """At some moment, all of ``parts``."""
    return syntax.Temporal("F", None, None, syntax.Chain("and", tuple(parts)))


def always(part: Expression) -> Expression:
    """At all times, ``part``."""
    return syntax.Temporal("G", None, None, part)
