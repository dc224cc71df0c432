"""Numbers as users give them, exactly: decimals, fractions, with a unit or without."""

import math
import re
from decimal import Decimal
from fractions import Fraction
from typing import TypeAlias

from roadproof.errors import InputError
from roadproof.library.specification import unknown
from roadproof.world.units import UNITS

Number: TypeAlias = int | float | Fraction | Decimal | str

_VALUE = re.compile(r"([+-]?\d{1,30}(?:\.\d{1,30})?(?:/\d{1,30})?)\s*([A-Za-z][A-Za-z/^0-9]*)?")


def exact(name: str, value: Number, unit: str) -> Fraction:
    """A value in SI units; a bare number is in ``unit``, a float is the decimal that Python shows.

    Raises ``InputError`` that names ``name``.
    """
    if isinstance(value, str):
        return read_value(name, value, unit)
    if isinstance(value, bool) or not isinstance(value, int | float | Fraction | Decimal):
        raise InputError(f"{name}={value!r}: this is no number; write 3, 0.6, Fraction(3, 5) or '600 ms'")
    if not math.isfinite(value):
        raise InputError(f"{name}={value}: the number must be finite")
    number = Fraction(repr(value)) if isinstance(value, float) else Fraction(value)
    return number * UNITS[unit][0]


def read_value(name: str, text: str, unit: str) -> Fraction:
    """A value in SI units; without unit it is in ``unit``. Raises ``InputError`` that names ``name``."""
    short = name.rpartition(" ")[2]
    read = _VALUE.fullmatch(text.strip())
    if read is None:
        raise InputError(
            f"{name}={text}: this is no value; write a decimal or a fraction, with a unit if you "
            f"like, such as {short}=0.6, {short}=3/5 or '{short}=0.6 {unit}'"
        )
    number, given = read[1], read[2] or unit
    if given not in UNITS:
        raise InputError(f"{name}={text}: {unknown('unit', given, UNITS)}")
    if UNITS[given][1] != UNITS[unit][1]:
        raise InputError(f"{name}={text}: {short} is in {unit}, which {given} does not measure")
    top, _, bottom = number.partition("/")
    if bottom and Fraction(bottom) == 0:
        raise InputError(f"{name}={text}: the denominator is zero")
    return Fraction(top) / Fraction(bottom or 1) * UNITS[given][0]
