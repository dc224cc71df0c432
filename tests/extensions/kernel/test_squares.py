"""Sums of squares from semidefinite programming: found, written for Coq, refused where changed."""

import random
import re
from fractions import Fraction

import pytest

import roadproof as rp
from extensions.kernel import raw
from extensions.kernel.needs import needs_coq
from extensions.kernel.test_products import asked
from planting import plant
from roadproof.extensions.kernel import accept, cone, squares
from roadproof.extensions.kernel.accept import prepare
from roadproof.extensions.kernel.cone import Constraint
from roadproof.extensions.kernel.constructors import term
from roadproof.extensions.kernel.coq import ready
from roadproof.extensions.kernel.instant import find_instant_proof
from roadproof.extensions.kernel.reduction import reduce_constraints
from roadproof.extensions.kernel.source import HEAD
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.logic.rewrite import without_names
from roadproof.world.polynomial import Polynomial
from tables import read_table

CLAIMS = read_table(__file__, "claims")


def _module(claim):
    found = rp.prove(claim, drive=False, jobs=1)
    return prepare("one", found.answers[0].certificate, bundled_library()).module


@needs_coq
def test_coq_accepts_sums_of_squares_without_its_tactics(monkeypatch):
    texts = []

    def noted(*asked):
        made = prepare(*asked)
        texts.append(made.module.text)
        return made

    monkeypatch.setattr(accept, "prepare", noted)
    found = rp.prove(*CLAIMS, kernel="coq", drive=False, jobs=1)
    assert [x["kernel"]["says"] for x in found.as_data()["verdicts"]] == ["accepted"] * len(CLAIMS)
    assert len(texts) == len(CLAIMS)
    assert not [text for text in texts if "some_instant" in text]


@needs_coq
def test_a_square_with_a_wrong_weight_is_not_accepted(monkeypatch):
    plant(monkeypatch, squares, "_column", "weight /= whole**2", "weight /= whole")
    found = rp.prove(CLAIMS[0], kernel="coq", drive=False, jobs=1)
    (entry,) = found.as_data()["verdicts"]
    assert entry["kernel"]["says"] == "unknown (lemma 1)"


@needs_coq
def test_roots_with_a_changed_number_are_refused():
    r = random.Random(1)
    before, claimed, find_instant_proof = asked(_module(CLAIMS[0]).text)
    places = [
        m for m in re.finditer(r"\d+", find_instant_proof) if "square_" in find_instant_proof[: m.start()]
    ]
    tried = [find_instant_proof] + [
        find_instant_proof[: m.start()] + str(int(m[0]) + 1) + find_instant_proof[m.end() :]
        for m in r.sample(places, 8)
    ]
    out = [HEAD, before]
    for place, changed in enumerate(tried):
        out.append(f"Definition reason_{place} : Roadproof.Products.reason := {changed}.\n")
        out.append(f"Eval vm_compute in (Roadproof.Products.settles {claimed} reason_{place}).\n")
    with ready() as coq:
        ran = coq.run("".join(out) + "End one.\n")
    assert ran.code == 0, ran.errors[:500]
    answers = re.findall(r"= (true|false)\n", ran.output)
    assert answers[0] == "true"
    assert answers[1:].count("false") >= 5, answers


def _polynomial(**terms):
    return Polynomial(
        {tuple(map(int, m[1:].split("_"))) if m != "one" else (): Fraction(q) for m, q in terms.items()}
    )


@pytest.mark.parametrize("seed", range(3))
def test_reduced_inequalities_have_the_signs_of_those_given(seed):
    """On points where the equation is true; two positions become their difference."""
    r = random.Random(seed)
    gap = _polynomial(x1=1, x2=-1)
    speed = _polynomial(x3=1)
    constraints = [
        Constraint("above", gap * gap + speed),
        Constraint("at least", gap * speed - _polynomial(x4=1)),
        Constraint("zero", _polynomial(x4=2, x3_3=-1)),
    ]
    reduction = reduce_constraints(constraints)
    assert not reduction.equations
    assert len(reduction.lifted) == 2
    for _ in range(20):
        point = {v: Fraction(r.randint(-9, 9), r.randint(1, 4)) for v in (1, 2, 3)}
        point[4] = point[3] ** 2 / 2
        for one, other in zip(constraints, reduction.inequalities, strict=False):
            given = one.polynomial.value(point.__getitem__)
            found = reduction.lift(other.polynomial).value(point.__getitem__)
            assert (given > 0, given < 0) == (found > 0, found < 0)


def test_a_sum_of_inequalities_is_kept_where_each_speaks_of_a_direction_that_is_left_out():
    """What is nonlinear depends on 2 - 1 and 2 + 3; 1 and 3 are at least 0, so 3 + 1 is."""
    gap, way = _polynomial(x2=1, x1=-1), _polynomial(x2=1, x3=1)
    hard = Constraint("above", gap * way)
    sizes = [Constraint("at least", _polynomial(x1=1)), Constraint("above", _polynomial(x3=1))]
    reduction = reduce_constraints([hard, *sizes])
    (linear,) = (x for x in reduction.inequalities if x.polynomial.degree == 1)
    lifted = reduction.lift(linear.polynomial)
    assert linear.strict
    assert lifted == _polynomial(x1=1, x3=1).scaled(lifted.terms[(1,)])
    assert len(reduce_constraints([hard, sizes[0]]).inequalities) == 1


@pytest.mark.parametrize(("strict", "left"), [(False, 3), (True, 4)])
def test_linear_inequalities_that_follow_are_left_out(strict, left):
    """x + y follows from x and y where it need not be above 0, and x + 1 does in any case."""
    x, y = _polynomial(x1=1), _polynomial(x2=1)
    linear = [x, y, x + _polynomial(one=1)]
    constraints = [Constraint("at least", p) for p in (*linear, x * y * x - y)]
    constraints.append(Constraint("above" if strict else "at least", x + y))
    assert len(reduce_constraints(constraints).inequalities) == left


def test_no_sum_of_squares_is_found_for_what_has_a_solution():
    x = _polynomial(x1=1)
    assert squares.contradiction([Constraint("at least", x), Constraint("above", x * x - x)]) is None


def test_cases_that_share_products_find_what_each_finds_alone():
    """Also where the constraint at a place is another one in another case."""
    x, y = (Polynomial({(k,): Fraction(1)}) for k in (1, 2))
    common = (Constraint("above", x), Constraint("above", y))
    known: cone.Products = {}
    for last in (x * y + y, (x * y).scaled(Fraction(-1)), x.scaled(Fraction(-2))):
        case = (*common, Constraint("above", last))
        for level in (1, 2, 3):
            alone, shared = cone.contradiction(case, level), cone.contradiction(case, level, known)
            assert alone[1] == shared[1]
            assert (alone[0] and alone[0].proof_text()) == (shared[0] and shared[0].proof_text())
    assert alone[0] is not None


def test_programs_that_are_too_large_are_not_built():
    many = [Constraint("above", Polynomial({(k,): Fraction(1)})) for k in range(1, 200)]
    known: cone.Products = {}
    assert cone.contradiction(many, 2, known) == (None, cone.MOST_COLUMNS + 1)
    assert not known


# Six disjunctions, of which the last alone matters.
CHOICES = " and ".join(f"({x} <= 0 m or {x} > 1 m)" for x in "abcde")
MANY_CASES = f"given a, b, c, d, e, x, y: m: {CHOICES} and (x >= 1 m or y >= 1 m) -> x > 0 m or y > 0 m"


@needs_coq
def test_what_contradicts_itself_once_closes_every_case_that_has_it():
    """Two contradictions, not one for each of 64 cases; Coq refuses them where they are about others."""
    fact = without_names(read_claim(bundled_library().select("base", {}), MANY_CASES).formula)
    found = find_instant_proof(fact, {}, ())
    assert found.proof_text.count("Absurd") <= 14
    places = list(re.finditer(r"given_ (\d+)", found.proof_text))
    others = [
        f"{found.proof_text[: x.start(1)]}{int(x[1]) + by}{found.proof_text[x.end(1) :]}"
        for x in places
        for by in (-1, 1)
        if int(x[1]) + by >= 0
    ]
    atoms = "; ".join(map(term, found.atoms))
    out = [HEAD, "Open Scope Q_scope.\nOpen Scope nat_scope.\n"]
    for why in [found.proof_text, *others]:
        out.append(
            f"Eval vm_compute in (Roadproof.Products.settles [] [{atoms}] {raw.formula(fact)} {why}).\n"
        )
    with ready() as coq:
        ran = coq.run("".join(out))
    assert ran.code == 0, ran.errors[:500]
    answers = re.findall(r"= (true|false)\n", ran.output)
    assert answers == ["true", *["false"] * len(others)]
