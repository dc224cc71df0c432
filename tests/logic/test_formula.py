"""Formula trees and terms: constructors, identity, walks and rewriting."""

from fractions import Fraction
from itertools import product

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from examples import some
from judge.cases import comparisons_of, drives, formulas
from roadproof.extensions.traffic.evaluate.horizon import horizon
from roadproof.library.bind import default_values
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import FALSE, TRUE, Compare, Formula
from roadproof.logic.initial_conditions import (
    comparisons_at_start,
    forced_values,
    necessary_at_start,
    top_level_conjuncts,
    without_comparisons,
)
from roadproof.logic.rewrite import (
    bounds_of,
    map_terms,
    parameters_of,
    signal_degree,
    terms_of,
    vehicles_of,
    with_values,
    without_names,
)
from roadproof.semantics.exact.judging import judge
from tables import read_table

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


# --- Horizon, boundedness, degree and size of formulas ----------------------------------------------

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


# --- Which premises leave a parameter one value: tried against values that make the formula false ---

specification = bundled_library().select()
HERE = Fraction(3, 5)


def pinned(claim: str) -> dict[str, Fraction]:
    return forced_values(read_claim(specification, claim).formula)


@pytest.mark.parametrize(
    "claim",
    read_table(__file__, "a_premise_pins_a_parameter"),
)
def test_a_premise_pins_a_parameter(claim):
    assert pinned(claim) == {"minDanger": HERE}


@pytest.mark.parametrize(
    "claim",
    read_table(__file__, "what_pins_nothing"),
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
            found = forced_values(made)
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


# --- What a formula demands of its first instant: true there wherever the formula is ----------------

ATOMS = comparisons_of(["s", "d", "v_lon", "v_lat"])
P, Q = (f.Compare(t.Signal("s", name), ">", t.number(0)) for name in "AB")
NOW = f.Interval(t.number(0), t.number(2))
LATER = f.Interval(t.number(1), t.number(2))


@settings(max_examples=some(300), deadline=None)
@given(formulas(ATOMS), drives)
def test_what_is_demanded_is_so_where_the_formula_is(formula, drive):
    demanded = necessary_at_start(formula)
    assert f.is_state(demanded)
    if judge(formula, drive).holds:
        assert judge(demanded, drive).holds


@settings(max_examples=some(100), deadline=None)
@given(formulas(ATOMS).filter(f.is_state), drives)
def test_all_of_a_formula_about_one_instant_is_demanded(formula, drive):
    assert judge(necessary_at_start(formula), drive).holds == judge(formula, drive).holds


def test_no_more_than_the_first_instant_is_read():
    no_q = f.Compare(Q.left, "<=", Q.right)
    assert necessary_at_start(f.Always(NOW, P)) == P
    assert necessary_at_start(f.Always(LATER, P)) == f.TRUE
    assert necessary_at_start(f.Eventually(NOW, P)) == f.TRUE
    assert necessary_at_start(f.Not(f.Eventually(NOW, Q))) == no_q
    assert necessary_at_start(f.Until(P, NOW, Q)) == f.Or((P, Q))
    assert necessary_at_start(f.Not(f.Until(P, NOW, Q))) == no_q
    assert necessary_at_start(f.And((f.Application("x", (), P), f.Eventually(NOW, Q)))) == P


@settings(max_examples=some(100), deadline=None)
@given(st.booleans(), formulas(ATOMS), drives)
def test_parts_together_are_the_formula(positive, formula, drive):
    whole = f.conjunction(*top_level_conjuncts(formula, positive))
    assert judge(whole, drive).holds == (judge(formula, drive).holds == positive)


# --- What is let go of a formula leaves something that implies it -----------------------------------

A, B, C = (Compare(t.Signal("s", x), ">", t.number(0, (1, 0))) for x in ("A", "B", "C"))
AFTERWARDS = f.Application("later", (), f.Not(f.And((A, f.Or((B, f.Not(C)))))))
FORMULAS: tuple[Formula, ...] = (
    A,
    f.Not(A),
    f.Or((A, B)),
    f.And((f.Not(A), f.Or((B, C)))),
    AFTERWARDS,
    f.Not(AFTERWARDS),
)


def holds(formula: Formula, true: dict[Formula, bool]) -> bool:
    match formula:
        case f.And(parts):
            return all(holds(x, true) for x in parts)
        case f.Or(parts):
            return any(holds(x, true) for x in parts)
        case f.Not(body) | f.Application(_, _, body):
            return holds(body, true) != isinstance(formula, f.Not)
        case f.Truth(value):
            return value
        case _:
            return true[formula]


def test_what_is_left_implies_the_formula_and_does_not_speak_of_it() -> None:
    for formula, values in product(FORMULAS, product((False, True), repeat=3)):
        true: dict[Formula, bool] = dict(zip((A, B, C), values, strict=True))
        left = without_comparisons(formula, {A})
        assert A not in set(comparisons_at_start(left))
        assert not holds(left, true) or holds(formula, true)


def test_what_need_not_be_let_go_stays() -> None:
    true: dict[Formula, bool] = {A: True, B: True, C: False}
    assert holds(without_comparisons(f.Or((A, B)), {A}), true)
    assert not holds(without_comparisons(A, {A}), true)
    assert without_comparisons(f.Or((A, B)), {C}) == f.Or((A, B))
