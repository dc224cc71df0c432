"""Formula trees and terms: constructors, identity, walks and rewriting."""

from fractions import Fraction

import pytest

from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import FALSE, TRUE, Formula
from roadproof.logic.rewrite import (
    bounds_of,
    map_terms,
    parameters_of,
    terms_of,
    vehicles_of,
    with_values,
    without_names,
)

SECONDS = (0, 1)
SLOW = f.Compare(t.Signal("v_lon", "SV"), "<", t.Parameter("limit", (1, -1)))
NEAR = f.Compare(t.Signal("s", "POV"), "<=", t.Size("length", "SV"))
ON = f.Some("l", f.Domain("lanelets", "L"), f.Occupies("POV2", "l"))


def test_negation_never_doubles() -> None:
    assert f.negation(TRUE) == FALSE
    assert f.negation(f.negation(SLOW)) == SLOW
    assert f.negation(SLOW) == f.Not(SLOW)


def test_constants_vanish() -> None:
    assert f.conjunction() == TRUE
    assert f.disjunction() == FALSE
    assert f.conjunction(SLOW) == SLOW
    assert f.conjunction(TRUE, SLOW, TRUE, NEAR) == f.And((SLOW, NEAR))
    assert f.conjunction(SLOW, FALSE) == FALSE
    assert f.disjunction(FALSE, SLOW, NEAR) == f.Or((SLOW, NEAR))
    assert f.disjunction(SLOW, TRUE) == TRUE


def test_implication_and_equivalence_are_sugar() -> None:
    assert f.implication(SLOW, NEAR) == f.Or((f.Not(SLOW), NEAR))
    assert f.equivalence(SLOW, NEAR) == f.And((f.Or((f.Not(SLOW), NEAR)), f.Or((f.Not(NEAR), SLOW))))


EVERY_NODE: list[Formula] = [
    TRUE,
    SLOW,
    f.Occupies("SV", "l"),
    ON,
    f.Every("l", f.Domain("zone", "main"), f.Occupies("SV", "l")),
    f.Not(SLOW),
    f.And((SLOW, NEAR)),
    f.Or((SLOW, NEAR)),
    f.Until(SLOW, f.FOREVER, NEAR),
    f.Eventually(f.FOREVER, SLOW),
    f.Always(f.FOREVER, SLOW),
    f.Application("near", ("SV",), NEAR),
]


@pytest.mark.parametrize("formula", EVERY_NODE, ids=lambda formula: type(formula).__name__)
def test_children_can_be_put_back(formula: Formula) -> None:
    assert f.with_children(formula, f.children(formula)) == formula
    assert f.transform(formula, lambda part: part) == formula
    swapped = f.with_children(formula, tuple(f.Not(child) for child in f.children(formula)))
    assert f.children(swapped) == tuple(f.Not(child) for child in f.children(formula))


def test_identity_is_structure() -> None:
    again = f.And((f.Compare(t.Signal("v_lon", "SV"), "<", t.Parameter("limit", (1, -1))), NEAR))
    assert again == f.And((SLOW, NEAR))
    assert hash(again) == hash(f.And((SLOW, NEAR)))
    assert f.Application("a", ("SV",), SLOW) != f.Application("b", ("SV",), SLOW)
    assert f.Compare(NEAR.left, "<", NEAR.right) != NEAR


def test_subformulas_come_once_and_parents_first() -> None:
    both = f.And((f.Not(SLOW), f.Or((SLOW, NEAR))))
    assert list(f.subformulas(both)) == [both, f.Not(SLOW), SLOW, f.Or((SLOW, NEAR)), NEAR]


def test_shared_parts_are_visited_once() -> None:
    formula: Formula = SLOW
    for _ in range(60):
        formula = f.And((formula, formula))
    assert len(list(f.subformulas(formula))) == 61
    assert len(list(f.subformulas(f.transform(formula, f.negation)))) == 122


def test_state_formulas_have_no_temporal_operator() -> None:
    assert f.is_state(f.And((SLOW, ON)))
    assert not f.is_state(f.And((SLOW, f.Always(f.FOREVER, NEAR))))


def test_values_replace_parameters_everywhere() -> None:
    window = f.Interval(f.ZERO, t.Parameter("wait", SECONDS))
    formula = f.Until(SLOW, window, f.Always(window, NEAR))
    assert parameters_of(formula) == ("limit", "wait")
    half = with_values(formula, {"wait": Fraction(1, 2)})
    assert parameters_of(half) == ("limit",)
    assert isinstance(half, f.Until)
    assert half.interval == f.Interval(f.ZERO, t.number(Fraction(1, 2), SECONDS))
    assert bounds_of(half.interval) == (0, Fraction(1, 2))
    with pytest.raises(ValueError, match="still holds a parameter"):
        bounds_of(window)
    assert bounds_of(f.FOREVER) == (0, None)


def test_names_go_without_changing_the_rest() -> None:
    formula = f.Not(f.Application("outer", (), f.And((f.Application("near", ("SV",), NEAR), SLOW))))
    assert without_names(formula) == f.Not(f.And((NEAR, SLOW)))


def test_vehicles_of_signals_sizes_and_occupancy() -> None:
    assert vehicles_of(f.And((SLOW, NEAR, ON))) == ("POV", "POV2", "SV")


def test_terms_of_bounds_too() -> None:
    interval = f.Interval(f.ZERO, t.Parameter("wait", SECONDS))
    assert set(terms_of(f.Eventually(interval, SLOW))) == {
        f.ZERO,
        t.Parameter("wait", SECONDS),
        SLOW.left,
        SLOW.right,
    }


def test_terms_are_mapped_on_both_sides_and_in_bounds() -> None:
    formula = f.Always(f.Interval(f.ZERO, t.number(1, SECONDS)), SLOW)
    mapped = map_terms(formula, lambda term: t.Sum((term, term)))
    assert mapped == f.Always(
        f.Interval(t.Sum((f.ZERO, f.ZERO)), t.Sum((t.number(1, SECONDS),) * 2)),
        f.Compare(t.Sum((SLOW.left, SLOW.left)), "<", t.Sum((SLOW.right, SLOW.right))),
    )


@pytest.mark.parametrize(
    ("term", "value"),
    [
        (t.Sum((t.number(1), t.number(2))), Fraction(3)),
        (t.subtract(t.number(1), t.number(3)), Fraction(-2)),
        (t.Product((t.number(2), t.number(3))), Fraction(6)),
        (t.Power(t.number(-2), 3), Fraction(-8)),
        (t.Quotient(t.number(3), t.number(5)), Fraction(3, 5)),
        (t.Quotient(t.number(3), t.number(0)), None),
        (t.Maximum((t.number(1), t.number(4))), Fraction(4)),
        (t.Minimum((t.number(1), t.number(4))), Fraction(1)),
        (t.Sum((t.number(1), t.Parameter("rho"))), None),
        (t.Inverse(t.number(2)), None),
    ],
)
def test_constant_values(term: t.Term, value: Fraction | None) -> None:
    assert t.constant_value(term) == value


def test_leaves_are_replaced_in_place() -> None:
    term = t.Quotient(
        t.Maximum((t.Signal("s", "SV"), t.Minimum((t.number(0), t.Power(t.Signal("d", "SV"), 2))))),
        t.Parameter("b", (1, -2)),
    )
    renamed = t.replace_leaves(
        term, lambda leaf: t.Signal(leaf.name, "POV") if isinstance(leaf, t.Signal) else leaf
    )
    assert [leaf.vehicle for leaf in t.leaves(renamed) if isinstance(leaf, t.Signal)] == ["POV", "POV"]
    assert t.replace_leaves(term, lambda leaf: leaf) == term
