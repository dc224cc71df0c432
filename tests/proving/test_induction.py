"""Inductions over steps of time: true on every trace, derived again by whoever checks, and nothing more."""

from dataclasses import replace
from fractions import Fraction
from functools import partial
from random import Random

import pytest

import roadproof as rp
from cli.test_schemas import validator
from kernel.needs import needs_coq
from roadproof.engines.prove.induction import inductions
from roadproof.engines.solve.smt import ask
from roadproof.errors import InputError
from roadproof.evidence.certificate import certificate_data, read_certificate_data, refusal
from roadproof.frontends.api.checking import check
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.library.motion import Axiom, axiom_formula
from roadproof.logic import formula as f
from roadproof.logic import motion
from roadproof.logic import terms as t
from roadproof.semantics.exact import judge
from roadproof.semantics.exact.truth import from_switches

library = bundled_library()
specification = library.select("base")
P = "atLane(SV,L)"
STEP = f"G ({P} -> F[1,1] {P})"
TRUE = [
    (f"{STEP} and {P} -> G F {P}", "steps"),
    (f"{STEP} and {P} -> G F[0,1] {P}", "steps"),
    (f"{STEP} and F {P} -> F G F {P}", "steps"),
    (f"G (not {P} -> F[1,2] not {P}) and not {P} -> G F[0,2] not {P}", "steps"),
    (f"G ({P} -> G[0,2] {P}) and {P} -> G {P}", "lasts"),
    (f"assuming motion: {STEP} and {P} -> G F {P}", "steps"),
]


def certificate_of(claim: str):
    answer = rp.prove(claim, effort=8, drive=False, jobs=1)
    assert str(answer.verdict) == "PROVED"
    return answer, answer.answers[0].settled.result.certificate


@pytest.mark.parametrize(("claim", "schema"), TRUE)
def test_a_claim_is_proved_and_its_certificate_is_derived_again(claim, schema):
    answer, certificate = certificate_of(claim)
    assert {x.schema for x in certificate.assumed.axioms} == {schema}
    for solver in ("z3", "cvc5"):
        assert refusal(certificate, library, partial(ask, solver=solver)) is None
    data = certificate_data(certificate)
    assert not [*validator("certificate.json").iter_errors(data)]
    assert read_certificate_data(data, "it") == certificate
    assert "by induction over time: " in str(answer)
    assert ("the claim holds without them" in str(answer)) == claim.startswith("assuming")
    assert "of motion: " not in str(answer)


@pytest.mark.parametrize(
    "claim",
    [
        f"G ({P} -> F[0,1] {P}) and {P} -> G F {P}",
        f"G ({P} -> F[1,1] {P}) and {P} -> F G {P}",
        f"{STEP} and F {P} -> G F[0,1] {P}",
        f"G ({P} -> F[1,1] atLane(POV,L)) and {P} -> G F {P}",
        f"G ({P} -> G[1,2] {P}) and {P} -> G {P}",
    ],
)
def test_a_claim_that_is_false_is_not_proved(claim):
    assert str(rp.prove(claim, effort=1, drive=False, jobs=1).verdict) in ("REFUTED", "UNKNOWN")


def test_an_induction_that_no_proof_uses_is_no_premise():
    _, certificate = certificate_of(f"{STEP} and {P} -> F[2,2] {P}")
    assert certificate.assumed.axioms == ()


@pytest.mark.parametrize(
    "axiom",
    [
        Axiom("steps", (P, "0 s", "1 s")),
        Axiom("steps", (P, "minSafe", "1 s")),
        Axiom("steps", (P, "1 s", "rho")),
        Axiom("lasts", (P, "0 s")),
        Axiom("lasts", (P, "-1 s")),
        Axiom("lasts", ("atLane(POV9,L)", "1 s")),
        Axiom("lasts", (P,)),
        Axiom("lasts", ("s(SV)", "1 s")),
    ],
    ids=str,
)
def test_refuses_what_is_no_induction(axiom):
    with pytest.raises(InputError):
        axiom_formula(specification, read_claim(specification, P), axiom)


def test_a_step_inside_a_quantifier_is_left_out():
    query = read_claim(specification, "every M in lanes: G (atLane(SV,M) -> F[1,1] atLane(SV,M))")
    assert not [*inductions(specification, query)]


# --- truth: judged on random traces, and planted faults -------------------------------------------


SIGNAL = f.Application("p", (), f.Compare(t.Signal("s", "SV"), "<", t.Signal("s", "POV")))
ONE, TWO = (t.number(seconds, (0, 1)) for seconds in (1, 2))


def random_truth(seed: int):
    """p in turns, in steps of half a second."""
    pick, time, switches = Random(seed), Fraction(0), []
    for _ in range(pick.randint(1, 12)):
        switches.append((time, pick.random() < 0.6, pick.random() < 0.6))
        time += Fraction(pick.randint(1, 3), 2)
    last = pick.random() < 0.7
    return from_switches([*switches, (time, last, last)])


TRUTHS = [random_truth(seed) for seed in range(2000)]


def holds_on_all(formula: f.Formula) -> bool:
    return all(judge(formula, None, {SIGNAL: truth}).holds for truth in TRUTHS)


def test_the_schemas_hold_on_every_trace():
    assert holds_on_all(motion.steps(SIGNAL, ONE, ONE))
    assert holds_on_all(motion.steps(SIGNAL, ONE, TWO))
    assert holds_on_all(motion.lasts(SIGNAL, ONE))


@pytest.mark.parametrize(
    ("again", "always"),
    [
        (f.Eventually(f.Interval(f.ZERO, ONE), SIGNAL), f.Always(f.FOREVER, f.Eventually(f.FOREVER, SIGNAL))),
        (f.Eventually(f.Interval(ONE, ONE), SIGNAL), f.Always(f.FOREVER, SIGNAL)),
        (f.Always(f.Interval(ONE, TWO), SIGNAL), f.Always(f.FOREVER, SIGNAL)),
        (f.TRUE, f.Always(f.FOREVER, f.Eventually(f.FOREVER, SIGNAL))),
    ],
    ids=["a step of no time", "all times", "a gap", "no step"],
)
def test_a_fault_in_a_schema_is_noticed(again, always):
    supposed = f.conjunction(SIGNAL, f.Always(f.FOREVER, f.implication(SIGNAL, again)))
    assert not holds_on_all(f.Always(f.FOREVER, f.implication(supposed, always)))


# --- planted faults: certificates ----------------------------------------------------------------


def test_a_certificate_with_another_induction_is_refused():
    _, certificate = certificate_of(TRUE[0][0])
    (axiom,) = certificate.assumed.axioms
    for other in (
        Axiom("steps", (P, "0 s", "1 s")),
        Axiom("steps", (P, "2 s", "2 s")),
        Axiom("lasts", (P, "1 s")),
        replace(axiom, arguments=("atLane(POV,L)", "1 s", "1 s")),
    ):
        forged = replace(certificate, assumed=replace(certificate.assumed, axioms=(other,)))
        assert refusal(forged, library, ask) is not None
    assert refusal(replace(certificate, assumed=replace(certificate.assumed, axioms=())), library, ask)


def test_a_mutant_of_the_schema_is_noticed_by_who_has_the_right_one(monkeypatch):
    """Planted: steps may take no time."""
    claim = f"G ({P} -> F[0,1] {P}) and {P} -> G F {P}"
    with monkeypatch.context() as patch:
        patch.setattr(motion, "_check", lambda time: None)
        _, certificate = certificate_of(claim)
    assert refusal(certificate, library, ask) is not None


@needs_coq
def test_coq_has_the_induction_as_a_premise(tmp_path):
    rp.prove(TRUE[0][0], jobs=1, out=tmp_path)
    told = str(check(tmp_path, kernel="coq", jobs=1))
    assert "kernel: accepted; under 1 induction over time that is a premise;" in told
    assert "that the inductions hold on every trace" in told
    assert "motion" not in told
