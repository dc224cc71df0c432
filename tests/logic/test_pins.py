"""Which premises leave a parameter one value: tried against values that make the formula false."""

from fractions import Fraction
from itertools import product

import pytest

from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.logic import formula as f
from roadproof.logic.initial_conditions import pins
from roadproof.logic.rewrite import with_values

specification = bundled_library().select()
HERE = Fraction(3, 5)


def pinned(claim: str) -> dict[str, Fraction]:
    return pins(read_claim(specification, claim).formula)


@pytest.mark.parametrize(
    "claim",
    [
        "minDanger = 0.6 s -> danger(SV,POV)",
        "initSafe(SV,POV) and (0.6 s = minDanger and rssViolation(SV,POV)) -> danger(SV,POV)",
        "not (minDanger = 600 ms and danger(SV,POV))",
        "not F (danger(SV,POV) and minDanger = 0.6 s)",
        "not (danger(SV,POV) U (rssViolation(SV,POV) and minDanger = 0.6 s))",
        "danger(SV,POV) or G (minDanger = 0.6 s -> rssViolation(SV,POV))",
        "minDanger <= 0.6 s and minDanger >= 0.6 s -> danger(SV,POV)",
        "(minDanger = 0.6 s -> danger(SV,POV)) and (rho = 1 s and minDanger = 0.6 s -> danger(POV,SV))",
        "not ((minDanger = 0.6 s and danger(SV,POV)) or (danger(POV,SV) and minDanger = 0.6 s))",
        "not (some M in lanes: atLane(SV,M) and minDanger = 0.6 s)",
    ],
)
def test_a_premise_pins_a_parameter(claim):
    assert pinned(claim) == {"minDanger": HERE}


@pytest.mark.parametrize(
    "claim",
    [
        "danger(SV,POV)",
        "minDanger = 0.6 s and danger(SV,POV)",
        "minDanger = 0.6 s or danger(POV,SV) -> danger(SV,POV)",
        "minDanger <= 0.6 s -> danger(SV,POV)",
        "minDanger < 0.6 s and minDanger > 0.6 s -> danger(SV,POV)",
        "minDanger = rho -> danger(SV,POV)",
        "2*minDanger = 1.2 s -> danger(SV,POV)",
        "minDanger = 0.6 s and minDanger = 0.7 s -> danger(SV,POV)",
        "not G (minDanger = 0.6 s and danger(SV,POV))",
        "not (minDanger = 0.6 s U danger(SV,POV))",
        "(minDanger = 0.6 s -> danger(SV,POV)) and danger(POV,SV)",
        "minDanger = 0.6 s <-> danger(SV,POV)",
    ],
)
def test_what_pins_nothing(claim):
    assert pinned(claim) == {}


def test_wherever_a_formula_is_false_its_pins_hold():
    """All combinations of two parameters, two operators and three shapes, at all values nearby."""
    texts = [f"{n} {op} {v} s" for n in ("rho", "minSafe") for op in ("=", "<=") for v in (0, 1)]
    seen = 0
    for one, other, last in product(texts, repeat=3):
        for shape in ("{} and {} -> {}", "{} -> ({} -> {})", "not ({} or ({} and {}))"):
            made = read_claim(specification, shape.format(one, other, last)).formula
            found = pins(made)
            for rho, safe in product((0, 1, 2), repeat=2) if found else ():
                values = {"rho": Fraction(rho), "minSafe": Fraction(safe)}
                if not truth(with_values(made, values)):
                    seen += 1
                    assert {n: values[n] for n in found} == found, made
    assert seen > 300


def truth(formula: f.Formula) -> bool:
    match formula:
        case f.Compare(left, "<=", right):
            return left.value <= right.value
        case f.Compare(left, ">=", right):
            return left.value >= right.value
        case f.Not(body):
            return not truth(body)
        case f.And(parts):
            return all(map(truth, parts))
        case f.Or(parts):
            return any(map(truth, parts))
        case _:
            raise AssertionError(formula)
