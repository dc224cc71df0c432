"""Few atoms that are enough: against all truth tables of random formulas."""

import random
from itertools import product

import roadproof as rp
from preventing.read import specification
from roadproof.drivers.lemmas import lemmas_for
from roadproof.drivers.models import models_for
from roadproof.engines.prove.explanation import is_plain, reason
from roadproof.evidence.atoms import Atoms
from roadproof.library.elaborate import read_claim
from roadproof.logic import formula as f
from roadproof.logic.formula import Application, Formula

NAMES = ("p", "q", "r", "s")


def atom(name: str) -> Formula:
    return Application(name, (), f.Truth(True))


def random_formula(rng: random.Random, depth: int) -> Formula:
    kind = rng.choice(["atom", "not", "and", "or", "truth"]) if depth else "atom"
    if kind == "atom":
        return atom(rng.choice(NAMES))
    if kind == "truth":
        return f.Truth(rng.random() < 0.5)
    if kind == "not":
        return f.Not(random_formula(rng, depth - 1))
    parts = tuple(random_formula(rng, depth - 1) for _ in range(rng.randint(1, 3)))
    return f.And(parts) if kind == "and" else f.Or(parts)


def value(formula: Formula, truths: dict[str, bool]) -> bool:
    match formula:
        case f.Truth(known):
            return known
        case Application(name, _, _):
            return truths[name]
        case f.Not(body):
            return not value(body, truths)
        case f.And(parts):
            return all(value(x, truths) for x in parts)
        case f.Or(parts):
            return any(value(x, truths) for x in parts)
        case _:
            raise AssertionError


def all_truths():
    return [dict(zip(NAMES, x, strict=True)) for x in product((False, True), repeat=len(NAMES))]


def test_what_is_told_is_true_and_enough():
    rng = random.Random(1)
    fewer = 0
    for _ in range(100):
        formula = random_formula(rng, 4)
        for truths in all_truths():
            found = value(formula, truths)
            assert reason(formula, not found, truths) is None
            why = reason(formula, found, truths)
            assert why is not None
            assert why.items() <= truths.items()
            fewer += len(why) < len(NAMES)
            assert all(value(formula, x) == found for x in all_truths() if why.items() <= x.items())
    assert fewer > 500


def test_one_of_several_is_enough():
    p, q, r = map(atom, "pqr")
    truths = {"p": True, "q": True, "r": True}
    assert reason(f.Or((f.And((p, q)), r)), True, truths) == {"r": True}
    assert reason(f.And((p, f.Not(q))), False, truths) == {"q": True}
    assert reason(p, True, {}) is None


def test_only_what_is_about_one_instant_is_plain():
    later = read_claim(specification(), "danger(SV, POV) -> G danger(SV, POV)")
    assert not is_plain(Atoms().abstract(later.formula))
    assert is_plain(f.Not(f.Or((atom("p"), f.Truth(False)))))


def test_a_state_is_asked_about_in_full_where_its_reason_is_not_enough():
    """``hits`` has a case in which one of two conditions of the premise is no help without the other."""
    lemma = next(x for x in lemmas_for("cut-in", models_for("cut-in", ("careful",))) if "slow" in x.name)
    answer = rp.prove(lemma.claim, using=rp.load(specs=["driver"]), declared=True, jobs=1)
    assert str(answer.verdict) == "PROVED"
