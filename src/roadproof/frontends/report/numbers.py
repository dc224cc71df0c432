"""Numbers as text: of things, of seconds, and decimals without exponent."""

from decimal import Decimal
from fractions import Fraction


def count(number: int, noun: str) -> str:
    """A number with its noun: ``1 plate``, ``2 plates``."""
    return f"{number} {noun}{'' if number == 1 else 's'}"


def took(seconds: float | None, comma: str = "") -> str:
    """Return the time (s) of an answer as text; empty for None, as of answers read from a file."""
    return "" if seconds is None else f"{comma} in {seconds:.1f} s"


def decimal(value: Fraction | float) -> str:
    """The shortest decimal that is read as the same float, without exponent (as ``xs:decimal`` wants it).

    >>> decimal(Fraction(1, 40000000)), decimal(3.5), decimal(Fraction(7))
    ('0.000000025', '3.5', '7')
    """
    text = format(Decimal(repr(float(value) + 0.0)), "f")
    return text.rstrip("0").rstrip(".") if "." in text else text
