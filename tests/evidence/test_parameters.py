"""The values that a drive is judged with: those of its file, within their bounds and in their units."""

from dataclasses import replace
from fractions import Fraction

import pytest

from evidence.test_drive_file import FILE, LIBRARY
from roadproof.errors import InputError
from roadproof.evidence import judged
from roadproof.evidence.judged import judge_file
from roadproof.library import bind
from roadproof.library.bind import default_values, values_with
from roadproof.library.loading import build_library
from roadproof.library.specification import Library, Source
from roadproof.world.units import UNITS

# The declared values in other units than SI; 130 km/h are 36 1/9 m/s.
MINE = """
param limit = 130 km/h where limit > 0 "as signs say"
param blink = 500 ms where blink >= 0 "as eyes do"
def slow(a: vehicle) := v_lon(a) < limit
def soon(a: vehicle) := F[0, blink] v_lon(a) < 29.6 m/s
"""


def mine() -> Library:
    return build_library([Source("mine.spec", MINE)], LIBRARY)


# SV brakes with 1 m/s² from 30 m/s on for 0.6 s.
SPEEDS = [
    ("slow(SV)", {}, True),
    ("slow(SV)", {"limit": 30}, False),
    ("slow(SV)", {"limit": 31}, True),
    ("v_lon(SV) + 7 m/s < limit", {}, False),
    ("soon(SV)", {}, True),
    ("G[0, blink] v_lon(SV) > 29.45 m/s", {}, True),
    ("soon(SV)", {"blink": Fraction(2, 5)}, False),
    ("G[0, minDanger] v_lon(SV) > 29.5 m/s", {"minDanger": Fraction(1, 2)}, False),
    ("G[0, minDanger] v_lon(SV) > 29.5 m/s", {"minDanger": Fraction(2, 5)}, True),
]


def first_wrong() -> str | None:
    for formula, values, expected in SPEEDS:
        given = {name: Fraction(value) for name, value in values.items()}
        file = replace(FILE, formula=formula, values=given, scenario=None)
        if judge_file(file, mine()).accepted is not expected:
            return f"{formula} with {values}"
    return None


def test_a_drive_is_judged_with_the_values_of_its_file_in_their_units() -> None:
    assert first_wrong() is None
    assert default_values(mine())["limit"] == Fraction(325, 9)
    assert default_values(mine())["blink"] == Fraction(1, 2)


def without_units(monkeypatch: pytest.MonkeyPatch) -> None:
    """The unit of a declared parameter is ignored."""
    monkeypatch.setattr(bind, "UNITS", {unit: (Fraction(1), x) for unit, (_, x) in UNITS.items()})


def declared_only(monkeypatch: pytest.MonkeyPatch) -> None:
    """The values of a drive file are ignored."""
    monkeypatch.setattr(judged, "values_with", lambda library, given: default_values(library))


def file_only_where_undeclared(monkeypatch: pytest.MonkeyPatch) -> None:
    """The declared values come after those of the file."""
    monkeypatch.setattr(judged, "values_with", lambda library, given: {**given, **default_values(library)})


def first_value_only(monkeypatch: pytest.MonkeyPatch) -> None:
    """A value of the file is taken for the declared one in its own unit."""
    monkeypatch.setattr(
        judged,
        "values_with",
        lambda library, given: {
            **default_values(library),
            **{n: v * UNITS[library.parameters[n].unit][0] for n, v in given.items()},
        },
    )


@pytest.mark.parametrize(
    "fault",
    [without_units, declared_only, file_only_where_undeclared, first_value_only],
    ids=lambda fault: fault.__name__,
)
def test_a_planted_fault_is_caught(fault, monkeypatch) -> None:
    fault(monkeypatch)
    assert first_wrong() is not None


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"rho": -3}, r"rho=-3: iso34502.spec, line \d+, column 1: the library demands rho >= 0"),
        ({"b_max": -8}, r"b_max=-8: iso34502.spec, line \d+, column 1: the library demands b_max > 0"),
        ({"b_max": 0}, "the library demands b_max > 0"),
        ({"bmax": 8}, "there is no parameter 'bmax'; did you mean 'b_max'"),
    ],
)
def test_values_out_of_bounds_and_unknown_names_are_refused(values, message) -> None:
    given = {name: Fraction(value) for name, value in values.items()}
    with pytest.raises(InputError, match=message):
        values_with(LIBRARY, given)
    ruling = judge_file(replace(FILE, values={**FILE.values, **given}), LIBRARY)
    assert not ruling.accepted
    assert next(iter(values)) in ruling.reason


def test_a_value_at_its_bound_is_accepted() -> None:
    assert values_with(LIBRARY, {"rho": Fraction(0)})["rho"] == 0
