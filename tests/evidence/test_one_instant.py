"""What is asked about one instant: SMT-LIB text, cases of maxima, and atoms, against plain evaluation."""

from fractions import Fraction
from itertools import islice

import pytest
from hypothesis import HealthCheck, Phase, find, given, settings
from hypothesis import strategies as st

from examples import some
from proving.claims import holds, specification
from roadproof.engines.solve.smt import check_sat
from roadproof.errors import InputError
from roadproof.evidence import atoms as atoms_module
from roadproof.evidence import cases, state
from roadproof.evidence.atoms import Atoms, up_to_variables
from roadproof.evidence.derivation import derive_lemma_queries
from roadproof.evidence.times import Moment, read_moment
from roadproof.library.elaborate import read_claim
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.rewrite import rename, road_names, without_names
from roadproof.runtime.budget import Effort
from tables import read_table

U, V, W = (t.Variable(name, (1, -1)) for name in "uvw")
B = t.Parameter("b_min", (1, -2))
POSITIVE = {"b_min": ">"}
numbers = st.integers(-3, 3).map(lambda n: Fraction(n, 2))
leaves = st.one_of(st.sampled_from([U, V, W]), numbers.map(t.number))
terms = st.recursive(
    leaves,
    lambda inner: st.one_of(
        st.tuples(inner, inner).map(t.Sum),
        st.tuples(numbers.map(t.number), inner).map(t.Product),
        st.tuples(inner, inner).map(t.Product),
        st.lists(inner, min_size=1, max_size=3).map(tuple).map(t.Maximum),
        st.lists(inner, min_size=1, max_size=3).map(tuple).map(t.Minimum),
        st.builds(t.Power, inner, st.integers(0, 2)),
        st.builds(t.Quotient, inner, st.sampled_from([B, t.number(2), t.Product((t.number(2), B))])),
    ),
    max_leaves=5,
)
extrema = st.builds(
    lambda kind, pair: kind(pair), st.sampled_from([t.Maximum, t.Minimum]), st.tuples(leaves, leaves)
)
shapes = st.one_of(
    st.tuples(numbers.map(t.number), extrema).map(t.Product),
    st.tuples(extrema, extrema).map(t.Sum),
    st.builds(t.Power, extrema, st.just(2)),
    st.builds(t.Quotient, st.tuples(leaves, extrema).map(t.Sum), st.just(B)),
    leaves.map(t.Inverse),
)
sides = st.one_of(shapes, terms, leaves)
comparisons = st.builds(f.Compare, sides, st.sampled_from(["<", "<=", ">", ">="]), sides)
formulas = st.one_of(
    comparisons,
    comparisons.map(f.Not),
    st.tuples(comparisons, comparisons).map(f.And),
    st.tuples(comparisons, comparisons).map(f.Or),
)
values = st.fixed_dictionaries(
    {
        "u": numbers,
        "v": numbers,
        "w": numbers,
        "b_min": st.sampled_from([Fraction(1, 2), Fraction(1), Fraction(3)]),
    }
)
quickly = settings(max_examples=80, deadline=None, derandomize=True, database=None)
search = settings(quickly, max_examples=300, phases=[Phase.generate], suppress_health_check=list(HealthCheck))


def text_agrees(formula, at) -> bool:
    """Whether z3 finds the formula true at the values exactly where it is."""
    lines = state.declarations([formula], POSITIVE)
    fixed = [
        f"(assert (= {name} {state.smt_rational(value)}))"
        for name, value in at.items()
        if any(f" {name} " in line for line in lines)
    ]
    script = "\n".join([*lines, *fixed, f"(assert {state.state(formula)})", "(check-sat)"])
    return check_sat(script) == ("sat" if holds(formula, at) else "unsat")


def cases_agree(parts, at) -> bool:
    """Whether some case holds where all parts do, and no case holds elsewhere."""
    expected = all(holds(part, at) for part in parts)
    return expected == any(all(holds(x, at) for x in case) for case in cases.split(parts))


@settings(quickly)
@given(formulas, values)
def test_smt_text_says_what_the_formula_says(formula, at):
    assert text_agrees(formula, at)


@settings(quickly, max_examples=some(200))
@given(st.lists(formulas, min_size=1, max_size=2), values)
def test_cases_cover_what_they_come_from_and_no_more(parts, at):
    assert cases_agree(parts, at)


@pytest.mark.parametrize("kind", [t.Maximum, t.Minimum])
@pytest.mark.parametrize("op", ["<", "<=", ">", ">="])
def test_what_is_added_to_a_maximum_needs_no_cases(kind, op):
    """On either side of a comparison: cases multiply, and beyond a number of them there are none."""
    greatest = t.Sum((U, kind((V, W))))
    for sides in ((greatest, B), (B, greatest)):
        assert len(cases.split([f.Compare(sides[0], op, sides[1])])) == 1


@given(formulas)
@settings(quickly)
def test_cases_have_no_maxima_unless_there_are_too_many(formula):
    found = cases.split([formula])
    assert len(found) <= cases.MOST_CASES
    if len(found) > 1:
        for case in found:
            shown = "".join(state.state(x) for x in case)
            assert ("ite (>=" not in shown and "ite (<=" not in shown) or "Inverse" in repr(case)


# --- planted faults ------------------------------------------------------------------------------

true_comparisons, true_extremum, true_lift = cases._comparisons, state._extremum, cases._lift
true_cases, true_comparison, true_quotient = cases._cases, state.comparison, state._quotient


def lost_case(monkeypatch):
    monkeypatch.setattr(cases, "_cases", lambda formulas: islice(true_cases(formulas), 1))


def swapped_sides(monkeypatch):
    monkeypatch.setattr(cases, "_comparisons", lambda extremum: true_comparisons(extremum)[::-1])


def lost_condition(monkeypatch):
    """A case no longer says when it applies, so it may come from nothing that held."""

    def forget(formulas):
        return (case[: len(formulas)] for case in true_cases(formulas))

    monkeypatch.setattr(cases, "_cases", forget)


def scaled_without_turning(monkeypatch):
    """-max(x, y) stays a maximum."""

    def outward(term):
        match term:
            case t.Product((t.Number(factor, _), (t.Maximum() | t.Minimum()) as inner)):
                return type(inner)(tuple(t.Product((t.Number(factor), x)) for x in inner.terms))
        return term

    monkeypatch.setattr(cases, "_outward", outward)


def maximum_as_minimum(monkeypatch):
    flipped = {">=": "<=", "<=": ">="}
    monkeypatch.setattr(state, "_extremum", lambda terms, op: true_extremum(terms, flipped[op]))


def inverse_of_zero_is_zero(monkeypatch):
    def comparison(compare):
        def finite(side):
            if isinstance(side, t.Inverse):
                return f"(ite (= {state.term(side.term)} 0.0) 0.0 (/ 1.0 {state.term(side.term)}))"
            return state.term(side)

        return f"({compare.op} {finite(compare.left)} {finite(compare.right)})"

    monkeypatch.setattr(state, "comparison", comparison)


def strictness_lost(monkeypatch):
    monkeypatch.setattr(
        state,
        "comparison",
        lambda x: true_comparison(f.Compare(x.left, {"<": "<=", ">": ">="}.get(x.op, x.op), x.right)),
    )


def divisor_lost(monkeypatch):
    monkeypatch.setattr(state, "_quotient", lambda quotient: state.term(quotient.numerator))


@pytest.mark.parametrize(
    "fault", [lost_case, swapped_sides, lost_condition, scaled_without_turning], ids=lambda x: x.__name__
)
def test_a_fault_in_the_cases_is_caught(fault, monkeypatch):
    fault(monkeypatch)
    pairs = st.tuples(st.lists(formulas, min_size=1, max_size=2), values)
    find(pairs, lambda pair: not cases_agree(*pair), settings=search)


@pytest.mark.parametrize(
    "fault",
    [maximum_as_minimum, inverse_of_zero_is_zero, strictness_lost, divisor_lost],
    ids=lambda x: x.__name__,
)
def test_a_fault_in_the_text_is_caught(fault, monkeypatch):
    fault(monkeypatch)
    find(st.tuples(formulas, values), lambda pair: not text_agrees(*pair), settings=search)


# --- lemmas --------------------------------------------------------------------------------------


def lemma_answers(claim: str) -> set[str]:
    known = Atoms()
    named = known.abstract(read_claim(specification(), claim).formula)
    literals = [(part.name, True) for part in f.subformulas(named) if isinstance(part, f.Application)]
    bounds = {name: p.bound for name, p in specification().library.parameters.items()}
    return {
        check_sat(query, meter=Effort(5).meter()) for query in derive_lemma_queries(known, literals, bounds)
    }


@pytest.mark.parametrize(
    ("claim", "always"),
    read_table(__file__, "a_lemma_is_unsat_where_it_always_holds"),
)
def test_a_lemma_is_unsat_where_it_always_holds(claim, always):
    assert lemma_answers(claim) == {"unsat"} if always else "sat" in lemma_answers(claim)


# --- atoms and their names -----------------------------------------------------------------------


def positive(name, op=">"):
    return f.Compare(t.Signal(name, "SV"), op, t.number(0))


NAMESAKES = f.Or(
    (f.Application("near", ("SV",), positive("s")), f.Application("near", ("SV",), positive("d")))
)


def names_tell_apart(formula) -> bool:
    return without_names(Atoms().abstract(formula)) == without_names(formula)


def test_two_meanings_have_two_names():
    known = Atoms()
    first, second = known.abstract(NAMESAKES).parts
    assert first.name != second.name
    assert known.meaning(first.name) == positive("s")
    assert known.meaning(second.name) == positive("d")
    assert names_tell_apart(NAMESAKES)
    with pytest.raises(InputError):
        known.meaning("far(SV)")


def test_a_name_for_two_meanings_is_caught(monkeypatch):
    true_atom = Atoms._atom

    def by_text(self, formula):
        made = true_atom(self, formula)
        name = made.name.partition(" #")[0]
        return f.Application(name, (), self.named[name])

    monkeypatch.setattr(atoms_module.Atoms, "_atom", by_text)
    assert not names_tell_apart(NAMESAKES)


def test_one_meaning_has_one_name():
    known = Atoms()
    once = f.And(
        (f.Application("near", ("SV",), positive("s")), f.Application("close", ("SV",), positive("s")))
    )
    first, second = known.abstract(once).parts
    assert first == second


def somewhere(variable, lane="L", vehicle="SV"):
    return f.Some(variable, f.Domain("lanelets", lane), f.Occupies(vehicle, variable))


def test_bound_variables_do_not_tell_atoms_apart():
    first, second, third = (
        Atoms().abstract(f.And((somewhere("l"), somewhere("m"), somewhere("l", "M")))).parts
    )
    assert first.name == second.name != third.name


def test_renaming_leaves_bound_variables_alone():
    """∃M ∈ adjacent(L). ∃l ∈ lanelets(M). occ(SV, l)"""
    inner = f.Some("M", f.Domain("adjacent", "L"), somewhere("l", "M"))
    assert rename(inner, "M", "M1") == inner
    assert rename(inner, "L", "K") == f.Some("M", f.Domain("adjacent", "K"), somewhere("l", "M"))
    outer = f.Some("M", f.Domain("adjacent", "M"), somewhere("l", "M"))
    assert rename(outer, "M", "K") == f.Some("M", f.Domain("adjacent", "K"), somewhere("l", "M"))


def test_renaming_captures_nothing():
    """∃K ∈ adjacent(L). SV and POV are in M and in K: M becomes K, and that K is another one."""
    both = f.And((somewhere("l", "M"), somewhere("l", "K", "POV")))
    renamed = rename(f.Some("K", f.Domain("adjacent", "L"), both), "M", "K")
    assert renamed.variable not in ("K", "M", "L")
    assert renamed.body == f.And((somewhere("l", "K"), somewhere("l", renamed.variable, "POV")))
    assert road_names(renamed) >= {"K", "L", renamed.variable}


def test_up_to_variables_keeps_what_is_free():
    nested = f.Every("M", f.Domain("adjacent", "L"), somewhere("l", "M"))
    alike = f.Every("N", f.Domain("adjacent", "L"), somewhere("k", "N"))
    other = f.Every("N", f.Domain("adjacent", "L"), somewhere("k", "M"))
    assert up_to_variables(nested) == up_to_variables(alike) != up_to_variables(other)


# --- moments -------------------------------------------------------------------------------------

moments = st.builds(
    lambda parts, constant: Moment(tuple(sorted((n, k) for n, k in parts.items() if k)), constant),
    st.dictionaries(st.sampled_from(["t1", "t12", "minSafe"]), numbers),
    numbers,
)


@given(moments, moments)
@settings(quickly)
def test_moments_print_and_read_back_alike(left, right):
    assert read_moment(str(left)) == left
    assert read_moment(str(left + right)) == left + right
    assert (left + right) - right == left


@pytest.mark.parametrize(
    "text", ["t1 +", "+", "t1 - - t2", "(t1)", "t1*t2", "1/0", "1e5x!", "t1;", "t1\nt2)"]
)
def test_what_is_no_moment_is_refused(text):
    with pytest.raises(InputError):
        read_moment(text)
