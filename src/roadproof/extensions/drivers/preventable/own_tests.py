"""Tests of the reader as points on plates, from a table of their initial values."""

import csv
import io
from collections.abc import Collection, Iterator, Mapping, Sequence
from fractions import Fraction
from pathlib import Path
from typing import Annotated, Final

from roadproof.errors import InputError
from roadproof.evidence.codec import Doc, Rule
from roadproof.extensions.drivers.manoeuvres import Manoeuvre, Values
from roadproof.extensions.drivers.models import course_in
from roadproof.library.scenarios import number_in
from roadproof.runtime.files import read_text
from roadproof.runtime.records import dataclass

LARGEST: Final = 10_000_000
"""Bytes of a table."""
MOST_TESTS: Final = 5000
_ROWS: Final = 32
"""The rows before one that may say the same of the same test: drivers.csv has one for each driver model."""
_SAME: Final = Fraction(1, 100)
"""The share of a value by which a test may differ from a plate that has its values."""
NAME: Final = "test"


@dataclass(frozen=True, kw_only=True)
class OwnTest:
    """A test of the reader."""

    name: Annotated[str, Rule(least=1)]
    values: Annotated[Mapping[str, Fraction], Doc("Initial values by name, in SI units.")]


@dataclass(frozen=True)
class PlacedTest:
    """A test on the plate that is nearest to it, by the index of the choice of fixed values.

    ``has_values``: whether the test has the fixed values of the plate, to a hundredth; else only its place
    on the plate is its own.
    """

    test: OwnTest
    plate: int
    has_values: bool


def read_tests(path: Path, manoeuvre: Manoeuvre) -> tuple[OwnTest, ...]:
    """Return the tests of a manoeuvre in a CSV file, such as drivers.csv of ``catalogue``.

    A column ``test`` has names; those of initial values have SI units; of a column ``scenario``, rows of
    other manoeuvres are left out, as are rows without the two values that plates vary. Rows that say the
    same are one test. Raises ``InputError``.
    """
    rows = csv.DictReader(io.StringIO(read_text(path, LARGEST, "no table of tests is larger")))
    needed = {NAME, manoeuvre.line, manoeuvre.across}
    if lacking := needed - {*(rows.fieldnames or ())}:
        raise InputError(
            f"{path}: the table has no column {', '.join(sorted(lacking))}: it needs a column of names "
            f"('{NAME}') and of initial values in SI units, as drivers.csv of catalogue has them"
        )
    tests: list[OwnTest] = []
    for number, row in enumerate(rows, 2):
        if not _is_of(manoeuvre, row.get("scenario") or ""):
            continue
        cells = {name: row.get(name) or "" for name in manoeuvre.quantities}
        values = {name: _value(path, number, name, x) for name, x in cells.items() if x}
        if needed - {NAME} <= values.keys():
            own = OwnTest(name=row[NAME] or f"line {number}", values=values)
            tests += [] if own in tests[-_ROWS:] else [own]
        if len(tests) > MOST_TESTS:
            raise InputError(f"{path}: more than {MOST_TESTS} tests; write those of interest into a table")
    return tuple(tests)


def _is_of(manoeuvre: Manoeuvre, scenario: str) -> bool:
    """Return whether a scenario is one of the manoeuvre, or none is named."""
    number = number_in(scenario)
    return not scenario or (number is not None and course_in(number) == manoeuvre.name)


def _value(path: Path, line: int, name: str, text: str) -> Fraction:
    try:
        if len(text) > 40:
            raise ValueError
        return Fraction(text)
    except (ValueError, ZeroDivisionError):
        raise InputError(f"{path}, line {line}: {name}={text[:40]}: write a number in SI units") from None


def placed_tests(
    tests: Sequence[OwnTest],
    manoeuvre: Manoeuvre,
    plates: Sequence[Values],
    ranges: Mapping[str, tuple[Fraction, Fraction]],
) -> Iterator[PlacedTest]:
    """Yield each test that is within the ``ranges`` of plates, on the nearest of them.

    ``plates``: the fixed values of each, to which the usual ones of the manoeuvre are added; ``ranges``: of
    the two values that vary. The nearest plate differs least in the values that a test states, each as a
    share of the plate's.
    """
    whole = [_others(manoeuvre.values(fixed), ranges) for fixed in plates]
    for test in tests:
        if all(low <= test.values[name] <= high for name, (low, high) in ranges.items()) and plates:
            far = [_difference(test.values, x) for x in whole]
            plate = min(range(len(far)), key=far.__getitem__)
            states_all = plates[plate].keys() <= test.values.keys()
            yield PlacedTest(test, plate, states_all and far[plate] <= _SAME)


def _difference(values: Values, fixed: Values) -> Fraction:
    """Return the greatest difference in a value that both state, as a share of the fixed one."""
    both = [(values[name], x) for name, x in fixed.items() if name in values]
    return max((abs(own - x) / abs(x) if x else abs(own) for own, x in both), default=Fraction(0))


def _others(values: Values, names: Collection[str]) -> Values:
    """Return the values but for those of some names."""
    return {name: x for name, x in values.items() if name not in names}
