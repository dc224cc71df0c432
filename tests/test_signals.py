"""One list of signals and one of units: what they say is so, and no second one stands in the source."""

import ast
from fractions import Fraction
from pathlib import Path
from typing import get_args

import pytest

from roadproof.extensions.traffic.formats.recording import Recording
from roadproof.logic import terms as t
from roadproof.logic.parse import parse_claim
from roadproof.semantics.exact.polynomial import polynomial
from roadproof.semantics.exact.signals import DriveSignals
from roadproof.world.drive import Drive, Motion, Piece
from roadproof.world.motion import State
from roadproof.world.signals import FIXED, LIMITED, RECORDED, SIGNALS, SIZES, STARTING, SignalName, SizeName
from roadproof.world.units import SI, UNITS
from roadproof.world.vehicle import Vehicle

SOURCE = Path(__file__).parents[1] / "src" / "roadproof"
# They keep lists of their own until the list of signals is theirs too.
HALF = Fraction(1, 2)
MOTION = Motion(*map(Fraction, (4, 2, 7, 3, 20, 1)), (Piece(None, Fraction(-2), HALF),))


def fields(kind):
    return set(kind.__dataclass_fields__)


def test_the_table_has_every_name_and_no_other():
    assert tuple(SIGNALS) == get_args(SignalName)
    assert get_args(SizeName) == FIXED


def test_what_the_list_says_is_where_it_says():
    assert set(STARTING) <= fields(Motion)
    assert {x for x, about in SIGNALS.items() if about.stored == "piece"} == fields(Piece) - {"duration"}
    assert set(RECORDED) | set(SIZES) <= fields(Recording)
    assert set(LIMITED) | set(SIZES) <= fields(Vehicle)
    assert all(hasattr(State(*map(Fraction, range(8))), name) for name in SIGNALS)
    assert {about.unit for about in SIGNALS.values()} | set(SIZES.values()) <= set(SI.values())


@pytest.mark.parametrize("name", [name for name, about in SIGNALS.items() if about.rate_of])
def test_a_rate_is_the_derivative_of_what_it_is_the_rate_of(name):
    drive = DriveSignals(Drive({"SV": MOTION}))
    ((_, course),) = drive.signal(t.Signal(SIGNALS[name].rate_of, "SV"))
    ((_, rate),) = drive.signal(t.Signal(name, "SV"))
    factors = [Fraction(x, course.denominator) for x in course.numerators]
    assert rate == polynomial(*(k * factor for k, factor in enumerate(factors) if k))


def lists_in(path, names):
    """Lines of tuples, lists, sets, literal types and keys of dictionaries with four of ``names`` or more."""
    for node in ast.walk(ast.parse(path.read_text())):
        match node:
            case (
                ast.Tuple(elts=members)
                | ast.List(elts=members)
                | ast.Set(elts=members)
                | ast.Dict(keys=members)
            ):
                written = {member.value for member in members if isinstance(member, ast.Constant)}
                if len(written & set(names)) >= 4:
                    yield node.lineno


def files_with(names):
    return {str(p.relative_to(SOURCE)) for p in SOURCE.rglob("*.py") if list(lists_in(p, names))}


def test_no_second_list_of_signals_stands_in_the_source():
    assert files_with(SIGNALS) == {"world/signals.py"}


def test_no_second_table_of_units_stands_in_the_source():
    assert files_with(UNITS) - files_with(SIGNALS) == {"world/units.py"}


def test_a_list_is_found(tmp_path):
    """The search itself: what it must see, and what it must not."""
    path = tmp_path / "lists.py"
    lists = ['("s", "d", "v_lon", "a_lon")', '{"s": 1, "d": 2}', 'Literal["a_lon", "a_lat", "d", "s"]']
    lists += ['{"s": 1, "d": 2, "v_lat": 3, "v_lon": 4}', 'f("s", "d", "v_lon", "v_lat")']
    path.write_text("\n".join(f"A = {text}" for text in lists))
    assert set(lists_in(path, SIGNALS)) == {1, 3, 4}


@pytest.mark.parametrize("unit", UNITS)
def test_the_grammar_reads_every_unit(unit):
    assert parse_claim(f"3 {unit} < 4 {unit}", "claim").body.left.unit == unit
