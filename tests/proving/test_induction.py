"""Inductions over steps of time: true on every trace, derived again by whoever checks, and nothing more."""

import json
from dataclasses import replace
from fractions import Fraction
from functools import partial
from random import Random

import pytest

import roadproof as rp
from cli.test_schemas import validator
from engine_calls import prove
from extensions.kernel.needs import needs_coq
from rejection import rejection_reason
from roadproof.engines.prove import lasso, prover
from roadproof.engines.prove.induction import inductions
from roadproof.engines.search.decide import decide_claim
from roadproof.engines.solve.smt import check_sat
from roadproof.errors import InputError
from roadproof.evidence.certificate_file import certificate_data, read_certificate_data
from roadproof.evidence.countermodel import Countermodel, Instant, Loop, read_trace, trace_data
from roadproof.evidence.finding import Acceptance
from roadproof.evidence.refutation import fault_of, judge_trace
from roadproof.frontends.api.checking import check
from roadproof.library.assumption import Axiom
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.library.motion import axiom_formula
from roadproof.logic import formula as f
from roadproof.logic import motion
from roadproof.logic import terms as t
from roadproof.runtime.budget import Effort
from roadproof.semantics.exact import judge
from roadproof.semantics.exact.truth import from_switches
from roadproof.verdict import Verdict

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
    return answer, answer.answers[0].certificate


@pytest.mark.parametrize(("claim", "schema"), TRUE)
def test_a_claim_is_proved_and_its_certificate_is_derived_again(claim, schema):
    answer, certificate = certificate_of(claim)
    assert {x.schema for x in certificate.assumed.axioms} == {schema}
    for solver in ("z3", "cvc5"):
        assert rejection_reason(certificate, library, partial(check_sat, solver=solver)) is None
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
        assert rejection_reason(forged, library, check_sat) is not None
    assert rejection_reason(
        replace(certificate, assumed=replace(certificate.assumed, axioms=())), library, check_sat
    )


def test_a_mutant_of_the_schema_is_noticed_by_who_has_the_right_one(monkeypatch):
    """Planted: steps may take no time."""
    claim = f"G ({P} -> F[0,1] {P}) and {P} -> G F {P}"
    with monkeypatch.context() as patch:
        patch.setattr(motion, "_check", lambda time: None)
        _, certificate = certificate_of(claim)
    assert rejection_reason(certificate, library, check_sat) is not None


@needs_coq
def test_coq_proves_the_induction(tmp_path):
    rp.prove(TRUE[0][0], jobs=1, out=tmp_path)
    told = str(check(tmp_path, kernel="coq", jobs=1))
    assert "kernel: accepted; not checked: queries for solvers]" in told
    assert "motion" not in told


# --- Traces that repeat themselves, and states of their own after an instant: found, judged, checked

HOME = bundled_library().select()
FAST = "v_lon(SV) > 10 m/s"
ALTERNATING = f"G F {FAST} -> F G {FAST}"
# True at single instants again and again, and false after each.
POINTS = f"G ({FAST} -> F[0, 1 s] not {FAST}) and G F[0, 1 s] {FAST} -> F G[0, 0.5 s] {FAST}"
ON_A_ROAD = "G F atLane(SV,L) -> F G atLane(SV,L)"


@pytest.mark.parametrize("claim", [ALTERNATING, POINTS, ON_A_ROAD])
def test_a_claim_that_only_a_repeating_trace_refutes(claim):
    found = prove(HOME, claim)
    assert found.verdict is Verdict.REFUTED
    assert found.countermodel.loop is not None
    assert judge_trace(trace_data(found.countermodel), HOME, claim, "here")[0] is Acceptance.ACCEPTED


@pytest.mark.parametrize("claim", [f"F G {FAST} -> G F {FAST}", f"G F {FAST} or F G not {FAST}"])
def test_what_holds_is_not_refuted(claim):
    assert prove(HOME, claim).verdict is Verdict.PROVED


def test_the_finder_alone_is_not_believed(monkeypatch):
    """Whatever it takes for a refutation is judged from the numbers of the trace."""
    from roadproof.semantics.exact.truth import NEVER

    monkeypatch.setattr(lasso, "judge_periodic", lambda *_: NEVER)
    assert prove(HOME, f"F G {FAST} -> G F {FAST}").verdict is Verdict.PROVED
    found = prove(HOME, ALTERNATING)
    assert found.countermodel is None or fault_of(found.countermodel, read(ALTERNATING), {}) is None


def read(claim):
    return read_claim(HOME, claim).formula


def trace(*speeds, loop=None, interpolation="before"):
    """Instants a second apart; a speed may be a pair: at the instant and after it."""
    instants = []
    for k, speed in enumerate(speeds):
        at, after = speed if isinstance(speed, tuple) else (speed, None)
        own = None if after is None else {"v_lon(SV)": Fraction(after)}
        instants.append(Instant(Fraction(k), {"v_lon(SV)": Fraction(at)}, {}, own))
    return Countermodel(tuple(instants), {}, interpolation, None, loop)


def loop(start, period):
    return Loop(Fraction(start), Fraction(period))


def test_a_state_after_an_instant():
    """The claim of a left-open boundary: 10 m/s up to an instant and at it, more after it."""
    claim = read(f"not {FAST} and F {FAST} -> (not {FAST}) U {FAST}")
    assert fault_of(trace(10, (10, 11)), claim, {}) is None
    assert fault_of(trace(10, 11), claim, {}) == "the claim is true on it"


def test_a_trace_repeats_itself_only_where_it_says_so():
    claim = read(ALTERNATING)
    assert fault_of(trace(11, 5, loop=loop(0, 2)), claim, {}) is None
    assert fault_of(trace(11, 5), claim, {}) == "the claim is true on it"
    assert fault_of(trace(11, 5, loop=loop(1, 1)), claim, {}) == "the claim is true on it"


@pytest.mark.parametrize("fault", [loop(0, 1), loop(0, 0), loop(0, -2), loop(3, 2), loop(1, Fraction(-1, 2))])
def test_a_loop_that_fits_no_instants(fault):
    assert "repeats itself" in fault_of(trace(11, 5, loop=fault), read(ALTERNATING), {})


def test_a_loop_that_takes_the_state_of_the_instant_after():
    assert "of the one before" in fault_of(
        trace(11, 5, loop=loop(0, 2), interpolation="after"), read(ALTERNATING), {}
    )


def test_a_size_that_changes_after_an_instant():
    made = trace(11, (5, 11), loop=loop(0, 2))
    first, second = made.instants
    wider = replace(second, after={**second.after, "width(SV)": Fraction(2)})
    assert "width" in fault_of(replace(made, instants=(first, wider)), read(ALTERNATING), {})


@pytest.mark.parametrize(
    "made", [trace(11, 5), trace(11, (5, 11), loop=loop(1, 3)), trace((1, 2), 3, interpolation="after")]
)
def test_written_and_read_again(made):
    data = json.loads(json.dumps(trace_data(made)))
    assert read_trace(data, "here") == made


def test_what_was_written_before_there_were_loops_says_nothing_of_them():
    data = trace_data(trace(11, 5))
    assert set(data) == {"kind", "between", "parameters", "road", "instants"}
    assert set(data["instants"][0]) == {"time", "true", "values"}


@pytest.mark.parametrize(
    "forge",
    [
        lambda data: data.pop("repeats"),
        lambda data: data["repeats"].update(period="3"),
        lambda data: data["repeats"].update({"from": "1", "period": "1"}),
        lambda data: data["instants"][1].update(values={"v_lon(SV)": "11"}, after={"v_lon(SV)": "11"}),
        lambda data: data["instants"][0].update(values={"v_lon(SV)": "9"}, after={"v_lon(SV)": "9"}),
    ],
)
def test_a_forged_trace_is_rejected(forge):
    # "period=3" keeps the claim false: a round may be longer; all others make the claim true.
    data = trace_data(trace((11, 11), (5, 5), loop=loop(0, 2)))
    forge(data)
    accepted = data.get("repeats", {}).get("period") == "3"
    found = judge_trace(data, HOME, ALTERNATING, "here")[0]
    assert found is (Acceptance.ACCEPTED if accepted else Acceptance.REJECTED)


def test_the_answer_says_that_it_repeats_itself(tmp_path):
    answer = rp.prove(ALTERNATING, jobs=1, drive=False)
    assert "from 0 s on it repeats itself every 2 s" in str(answer)
    answer.save(tmp_path / "out")
    assert rp.check(tmp_path / "out").exit_code == 0


# --- VACUOUS rests on a derived query, as PROVED does -----------------------------------------------

SPECIFICATION = bundled_library().select("base")
CLAIM = "scenario_1(SV,POV,L) and scenario_4(SV,POV,L) -> dangerArises(SV,POV)"


def test_a_premise_that_never_holds() -> None:
    assert prove(SPECIFICATION, CLAIM).verdict is Verdict.VACUOUS


def test_the_finder_of_vacuity_is_not_believed(monkeypatch: pytest.MonkeyPatch) -> None:
    satisfiable = "(set-logic QF_LRA)(check-sat)"
    monkeypatch.setattr(prover, "derive_query", lambda *_: satisfiable)
    monkeypatch.setattr(prover, "_is_quickly_proved", prover._is_quickly_proved.__wrapped__)
    assert prove(SPECIFICATION, CLAIM).verdict is Verdict.PROVED


@pytest.mark.parametrize(
    "claim",
    [
        "minDanger = 0.6 s and minDanger = 1 s -> false",
        "v_lon(SV) > 3 m/s and v_lon(SV) < 2 m/s -> false",
        "not (v_lon(SV) > 3 m/s or v_lon(SV) < 4 m/s) -> false",
    ],
)
def test_nothing_follows_but_false(claim: str) -> None:
    assert prove(SPECIFICATION, claim).verdict is Verdict.VACUOUS


@pytest.mark.parametrize(
    "claim",
    [
        "true -> not (v_lon(SV) > 3 m/s and v_lon(SV) < 2 m/s)",
        "not (v_lon(SV) > 3 m/s and v_lon(SV) < 2 m/s)",
        "minDanger = 0.6 s -> not minDanger = 1 s",
    ],
)
def test_a_conclusion_that_is_a_negation(claim: str) -> None:
    assert prove(SPECIFICATION, claim).verdict is Verdict.PROVED


def vacuous(claim: str, *said: str) -> bool:
    found = decide_claim(
        SPECIFICATION, read_claim(SPECIFICATION, claim), Effort(3), assumed=("motion", *said)
    )
    assert found.result.holds
    return found.verdict is Verdict.VACUOUS


def test_limits_that_contradict_each_other() -> None:
    never = "a_lon(SV) <= 1 m/s^2", "a_lon(SV) >= 2 m/s^2"
    assert vacuous("v_lon(SV) > 3 m/s", *never)
    assert vacuous("v_lon(SV) > 3 m/s or v_lon(SV) < 4 m/s", *never)
    assert not vacuous("a_lon(SV) <= 3 m/s^2", never[0])
    assert vacuous("a_lon(SV) > 3 m/s^2 -> v_lon(SV) > 3 m/s", never[0])


def test_a_premise_that_can_hold() -> None:
    assert prove(SPECIFICATION, "scenario_1(SV,POV,L) -> dangerArises(SV,POV)").verdict is Verdict.PROVED
