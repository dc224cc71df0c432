"""Horizon, boundedness, degree and size of formulas."""

from fractions import Fraction

import pytest

from roadproof.library.bind import default_values
from roadproof.library.elaborate import apply_definition, read_claim
from roadproof.library.loading import bundled_library
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula
from roadproof.logic.fragment import Sizes, horizon, signal_degree, sizes
from roadproof.logic.rewrite import with_values

BASE = bundled_library().select()
SPEED: t.Term = t.Signal("v_lon", "SV")


def formula(text: str) -> Formula:
    return with_values(read_claim(BASE, text).formula, default_values(BASE.library))


@pytest.mark.parametrize(
    ("text", "seconds"),
    [
        ("v_lon(SV) > 0", Fraction(0)),
        ("G[0, 2 s] v_lon(SV) > 0", Fraction(2)),
        ("F[1, 2] G[0, 600 ms] v_lon(SV) > 0", Fraction(13, 5)),
        ("(F[0, 1] v_lon(SV) > 0) and G[0, 3] v_lon(SV) > 0", Fraction(3)),
        ("(F[0, 1] v_lon(SV) > 0) U[2, 4] G[0, 3] v_lon(SV) > 0", Fraction(7)),
        ("danger(SV, POV)", Fraction(3, 5)),
        ("F v_lon(SV) > 0", None),
        ("G[0, 1] F v_lon(SV) > 0", None),
        ("F[3, inf] v_lon(SV) > 0", None),
        ("scenario_4(SV, POV, L)", None),
    ],
)
def test_horizon(text: str, seconds: Fraction | None) -> None:
    assert horizon(formula(text)) == seconds


def test_a_horizon_needs_values() -> None:
    symbolic = read_claim(BASE, "danger(SV, POV)").formula
    with pytest.raises(ValueError, match="parameter"):
        horizon(symbolic)


@pytest.mark.parametrize(
    ("term", "degree"),
    [
        (t.number(3), 0),
        (t.Size("length", "SV"), 0),
        (SPEED, 1),
        (t.Sum((SPEED, t.number(1))), 1),
        (t.Product((t.number(2), SPEED)), 1),
        (t.Product((SPEED, SPEED)), 2),
        (t.Power(SPEED, 2), 2),
        (t.Power(SPEED, 0), 0),
        (t.Quotient(t.Power(SPEED, 2), t.number(2)), 2),
        (t.Maximum((t.number(1), t.number(2))), 0),
        (t.Maximum((t.number(0), SPEED)), None),
        (t.Inverse(SPEED), None),
        (t.Sum((SPEED, t.Minimum((SPEED, t.number(0))))), None),
        (t.Power(t.Maximum((t.number(0), SPEED)), 2), None),
    ],
)
def test_degree(term: t.Term, degree: int | None) -> None:
    assert signal_degree(term) == degree


def test_sizes_count_distinct_parts_without_names() -> None:
    atom = f.Compare(SPEED, ">", t.number(0, (1, -1)))
    twice = f.Application("both", (), f.And((f.Always(f.FOREVER, atom), f.Not(f.Application("p", (), atom)))))
    assert sizes(twice) == Sizes(subformulas=4, atoms=1, temporal=1, depth=3)
    whole = sizes(apply_definition(BASE, "scenario_4").formula)
    assert whole.temporal == 4  # initSafe, danger, and two untils
