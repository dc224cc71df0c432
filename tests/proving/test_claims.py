"""A table of claims, each with the verdict it deserves; refutations are judged again by other means."""

import json
from collections import Counter
from dataclasses import replace
from fractions import Fraction
from random import Random

import pytest
from hypothesis import HealthCheck, Phase, event, given, note, settings
from hypothesis import strategies as st

import roadproof as rp
from cli.test_schemas import validator
from evidence.probe import probe
from extensions.kernel.needs import needs_coq
from proving.claims import (
    BEYOND,
    INVALID,
    NEEDS_INFINITELY_MANY_SWITCHES,
    PROVED,
    VALID,
    VALID_MORE,
    VALID_ON_ROADS,
    P,
    Q,
    R,
    _opaquely,
    _with_numbers,
    is_false_on,
    negated,
    settle,
    speaks_of_all_lanes,
    specification,
)
from proving.on_roads import claim_text, is_false_there, is_true_here, random_claim, random_road, random_trace
from rejection import rejection_reason
from roadproof.engines.prove.unknown import NO_REMEDY, Cause, StopPoint, UnknownReport, unknown_report
from roadproof.engines.solve.smt import check_sat
from roadproof.evidence.atoms import Atoms
from roadproof.evidence.certificate_file import certificate_data, read_certificate_data
from roadproof.frontends.api.checking import check
from roadproof.frontends.cli.main import main
from roadproof.library.bind import default_values
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.logic import formula as f
from roadproof.runtime.budget import Effort
from roadproof.semantics.exact import judge
from roadproof.semantics.exact.truth import from_switches
from roadproof.verdict import Verdict
from tables import read_table

library = specification().library


@pytest.mark.parametrize("claim", [*VALID, *VALID_ON_ROADS, *VALID_MORE])
def test_proves_what_is_valid(claim):
    result = settle(claim)
    assert result.verdict in PROVED, result.reason
    assert rejection_reason(result.certificate, library, check_sat) is None
    for title, query in result.certificate.queries:
        assert check_sat(query, "cvc5", Effort(10).meter()) == "unsat", title


@pytest.mark.parametrize("claim", INVALID)
def test_refutes_what_is_not_valid(claim):
    result = settle(claim)
    assert result.verdict is Verdict.REFUTED, result.reason
    assert result.certificate is None
    if not speaks_of_all_lanes(claim):
        assert is_false_on(result.countermodel, claim)


@pytest.mark.parametrize("claim", VALID)
def test_does_not_prove_the_negation_of_what_is_valid(claim):
    assert settle(negated(claim)).verdict is not Verdict.PROVED


@pytest.mark.parametrize("claim", NEEDS_INFINITELY_MANY_SWITCHES)
def test_refutes_by_a_trace_that_repeats_where_no_finite_one_decides(claim):
    result = settle(claim, units=1)
    assert result.verdict is Verdict.REFUTED
    assert result.countermodel.loop is not None


@pytest.mark.parametrize("claim", BEYOND)
def test_does_not_refute_what_is_true_of_every_road(claim):
    assert settle(claim).verdict is not Verdict.REFUTED


# --- Random claims: what is proved holds on random traces, what is refuted fails where it is said to

UNITS = 0.5
WINDOWS = read_table(__file__, "windows")
windows = st.sampled_from(WINDOWS)
trees = st.recursive(
    st.sampled_from([(P,), (Q,), (R,)]),
    lambda inner: st.one_of(
        st.tuples(st.just("not"), inner),
        st.tuples(st.sampled_from(["and", "or", "->"]), inner, inner),
        st.tuples(st.sampled_from("FG"), windows, inner),
        st.tuples(st.just("U"), windows, inner, inner),
    ),
    max_leaves=4,
)


def show(tree) -> str:
    match tree:
        case (atom,):
            return atom
        case ("not", body):
            return f"not ({show(body)})"
        case ("F" | "G" as op, window, body):
            return f"{op}{window} ({show(body)})"
        case ("U", window, left, right):
            return f"({show(left)}) U{window} ({show(right)})"
        case (op, left, right):
            return f"(({show(left)}) {op} ({show(right)}))"


@st.composite
def changed(draw, tree):
    """``tree`` with one part turned into another: often implied by it, often not."""
    places = len(tree)
    if len(tree) == 1 or draw(st.integers(0, 2)) == 0:
        return draw(
            st.one_of(
                st.just(tree),
                st.tuples(st.just("or"), st.just(tree), trees),
                st.tuples(st.just("F"), windows, st.just(tree)),
                trees,
            )
        )
    if tree[0] in ("F", "G", "U") and draw(st.booleans()):
        return (tree[0], draw(windows), *tree[2:])
    if tree[0] == "U" and draw(st.booleans()):
        return ("F", tree[1], tree[3])
    place = draw(st.integers(places - (2 if tree[0] in ("U", "and", "or", "->") else 1), places - 1))
    return (*tree[:place], draw(changed(tree[place])), *tree[place + 1 :])


@st.composite
def claims(draw):
    premise = draw(trees)
    return f"{show(premise)} -> {show(draw(changed(premise)))}"


times = st.integers(0, 12).map(lambda n: Fraction(n, 4))


@st.composite
def truth_sets(draw):
    points = sorted({Fraction(0), *draw(st.lists(times, max_size=4))})
    return from_switches([(point, draw(st.booleans()), draw(st.booleans())) for point in points])


traces = st.fixed_dictionaries(
    {
        "atoms": st.tuples(truth_sets(), truth_sets(), truth_sets()),
        "minSafe": st.sampled_from([Fraction(0), Fraction(1, 2), Fraction(1)]),
        "minDanger": st.sampled_from([Fraction(0), Fraction(3, 4), Fraction(1), Fraction(2)]),
    }
)


def is_true_on(claim: str, trace) -> bool:
    atoms = Atoms()
    abstracted = atoms.abstract(read_claim(specification(), claim).formula)
    parameters = default_values(specification().library) | {k: trace[k] for k in ("minSafe", "minDanger")}
    named = dict(zip((P, Q, R), trace["atoms"], strict=True))
    given_sets = {
        part: named[part.name.replace(", ", ",")]
        for part in _opaquely(abstracted)
        if isinstance(part, f.Application)
    }
    return judge(_with_numbers(abstracted, parameters), None, given_sets).holds


seen: Counter[str] = Counter()


@settings(
    max_examples=40,
    deadline=None,
    derandomize=True,
    database=None,
    phases=[Phase.generate],
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large],
)
@given(claims(), st.lists(traces, min_size=12, max_size=12))
def test_verdicts_of_random_claims(claim, tried):
    result = settle(claim, units=UNITS)
    note(f"{result.verdict}: {claim} {result.reason}")
    event(str(result.verdict))
    seen[str(result.verdict)] += 1
    if result.verdict in PROVED:
        assert result.certificate is not None
        assert rejection_reason(result.certificate, specification().library, check_sat) is None
        assert rejection_reason(result.certificate, specification().library, by_cvc5) is None
        for trace in tried:
            assert is_true_on(claim, trace)
    elif result.verdict is Verdict.REFUTED:
        assert is_false_on(result.countermodel, claim)
        assert probe(specification(), claim, 0.2) != "unsat"
    else:
        assert result.verdict is Verdict.UNKNOWN
        assert result.reason


def by_cvc5(query: str) -> str:
    return check_sat(query, "cvc5", Effort(20).meter())


def test_random_claims_were_mostly_decided():
    """Run after the test above; UNKNOWN counts for nothing, so there must be enough of the others."""
    if not seen:
        pytest.skip("the random claims were not settled in this process")
    print(dict(seen))
    assert seen[str(Verdict.PROVED)] + seen[str(Verdict.VACUOUS)] >= 10
    assert seen[str(Verdict.REFUTED)] >= 10
    assert seen[str(Verdict.UNKNOWN)] <= sum(seen.values()) / 3


# --- Random claims about lanes, zones and boxes, against random roads and traces, by definition -----

CLAIMS = 48
WORLDS = 30


@pytest.mark.parametrize("seed", range(CLAIMS))
def test_verdicts_on_random_roads(seed):
    rng = Random(seed)
    tree = random_claim(rng)
    claim = claim_text(tree)
    result = settle(claim, units=0.5)
    seen[str(result.verdict)] += 1
    if result.verdict in PROVED:
        for _ in range(WORLDS):
            assert is_true_here(tree, random_road(rng), random_trace(rng)), claim
    elif result.verdict is Verdict.REFUTED:
        assert is_false_there(tree, result.countermodel), claim
    else:
        assert result.verdict is Verdict.UNKNOWN
        assert result.reason


def test_most_were_decided():
    """Run after the tests above; UNKNOWN counts for nothing."""
    if sum(seen.values()) < CLAIMS:
        pytest.skip("not all of the claims were settled in this process")
    assert seen[str(Verdict.PROVED)] + seen[str(Verdict.VACUOUS)] >= CLAIMS / 6
    assert seen[str(Verdict.REFUTED)] >= CLAIMS / 3
    assert seen[str(Verdict.UNKNOWN)] <= CLAIMS / 4


# --- Causes of UNKNOWN: each from where the search stopped and from the form of the claim, never from words

small_specification = bundled_library().select("base")
AT_P, AT_Q = "atLane(SV,L)", "atLane(POV,L)"


def doubt(
    claim: str, stop: StopPoint = StopPoint.WORK, said: tuple[str, ...] = (), units: float = 60
) -> UnknownReport:
    return unknown_report(
        read_claim(small_specification, claim), said, stop, Effort(units), True, "the detail"
    )


@pytest.mark.parametrize(
    ("claim", "cause"),
    [
        (f"G ({AT_P} -> F[1,1] {AT_P}) and {AT_P} -> G F {AT_P}", Cause.INDUCTION),
        (f"G ({AT_P} -> F[0,1] {AT_Q}) -> G {AT_Q}", Cause.INDUCTION),
        (f"G F {AT_P} -> F G {AT_P}", Cause.ALTERNATION),
        (f"not (G F {AT_P} and G F {AT_Q})", Cause.ALTERNATION),
        (f"G (not {AT_P} or true U {AT_Q}) -> {AT_Q}", Cause.ALTERNATION),
        (f"{AT_P} and F {AT_Q} -> {AT_P} U {AT_Q}", Cause.FIRST_INSTANT),
        # An until that is supposed has its first instant, and a bounded G has an end.
        (f"{AT_P} U {AT_Q} -> F {AT_Q}", Cause.WORK),
        (f"G[0,5] F {AT_P} -> F {AT_P} and {AT_Q}", Cause.WORK),
        (f"F G {AT_P} -> G {AT_P}", Cause.WORK),
    ],
)
def test_the_form_of_a_claim_tells_the_cause(claim, cause):
    assert doubt(claim).cause is cause
    assert doubt(claim, StopPoint.ROUNDS).cause is cause
    assert doubt(claim, units=1).cause is Cause.WORK


@pytest.mark.parametrize(
    ("claim", "said", "cause"),
    [
        ("s(SV) <= 0 m -> G[1,1] s(SV) <= 9 m", ("motion", "a_lon(SV) <= 2 m/s^2"), Cause.SECOND_ORDER),
        ("d(SV) <= 0 m and G a_lat(SV) <= 0 m/s^2 -> G[1,1] d(SV) <= 9 m", ("motion",), Cause.SECOND_ORDER),
        ("s(SV) <= 0 m -> G[1,1] s(SV) <= 9 m", ("motion", "a_lat(SV) <= 2 m/s^2"), Cause.FACTS),
        ("s(SV) <= 0 m -> G[1,1] s(SV) <= 9 m", ("motion",), Cause.FACTS),
        (f"{AT_P} and F {AT_Q} -> {AT_P} U {AT_Q}", ("motion",), Cause.FACTS),
    ],
)
def test_of_motions_also_what_is_assumed_tells_it(claim, said, cause):
    found = doubt(claim, StopPoint.FACTS, said)
    assert found.cause is cause
    assert "traces" not in found.tried


@pytest.mark.parametrize(
    "stop", [StopPoint.CLOCK, StopPoint.PROCESS, StopPoint.SOLVER, StopPoint.LANES, StopPoint.CERTIFICATE]
)
def test_where_a_search_stopped_by_itself_the_form_does_not_matter(stop):
    assert doubt(f"G F {AT_P} -> F G {AT_P}", stop).cause == Cause(stop)


@pytest.mark.parametrize("cause", Cause)
def test_every_cause_says_what_was_tried_and_what_helps(cause):
    found = UnknownReport(cause, ("proof",), 60, "the detail")
    schema = validator("verdicts.json").schema["$defs"]["unknown_report_data"]
    assert cause in schema["properties"]["cause"]["enum"]
    if cause in (Cause.CLOCK, Cause.PROCESS):
        assert str(found) == "the detail"
    else:
        assert "tried: a proof" in str(found)
        assert (NO_REMEDY if found.remedy is None else found.remedy.text) in str(found)
        assert ("more work may help" in str(found)) == found.effort_helps


def test_the_whole_limit_is_named_not_that_of_a_part(capsys):
    claim = "assuming motion: scenario_4(SV,POV,L) -> G s(SV) < s(POV) + 9 m"
    main(["prove", claim, "--effort", "0.5", "--no-drive", "--json", "-"])
    data = json.loads(capsys.readouterr().out)
    assert not [*validator("verdicts.json").iter_errors(data)]
    (entry,) = data["verdicts"]
    assert (entry["doubt"]["cause"], entry["doubt"]["tried"]) == ("work", ["proof"])
    told = "no answer within 0.5 units of work; tried: a proof; more work may help:"
    assert entry["reason"].startswith(told)


def test_an_answer_has_no_doubt():
    assert "doubt" not in rp.prove("true", jobs=1).as_data()["verdicts"][0]


# --- The sentences about what a proof uses: each is said where the certificate shows it, and only there

LIMIT, OTHER = "a_lon(SV) <= 3 m/s^2", "a_lon(SV) >= -6 m/s^2"
NEITHER = "the proof uses neither a limit nor a fact about motion: the claim holds without them"
NO_FACT = "the proof uses no fact about motion: the claim holds without them"
GROWTH = "within(v_lon(SV), 4 m/s, 3 m/s^2, 1 s)"


def proved(claim: str, **asked):
    answer = rp.prove(claim, jobs=1, **asked)
    assert str(answer.verdict) == "PROVED"
    return answer, answer.answers[0].certificate


@pytest.mark.parametrize(
    ("claim", "limits", "facts", "unused"),
    [
        (f"assuming motion, {LIMIT}: a_lon(SV) <= 4 m/s^2", (LIMIT,), 0, ()),
        (f"assuming motion, {LIMIT}, {OTHER}: a_lon(SV) <= 4 m/s^2", (LIMIT,), 0, (OTHER,)),
        (f"assuming motion, {LIMIT}: v_lon(SV) <= 4 m/s -> v_lon(SV) <= 5 m/s", (), 0, (LIMIT,)),
        ("assuming motion: v_lon(SV) <= 4 m/s -> v_lon(SV) <= 5 m/s", (), 0, ()),
        (f"assuming motion, {LIMIT}: v_lon(SV) <= 4 m/s -> G[0,1] v_lon(SV) <= 7 m/s", (LIMIT,), 1, ()),
        ("assuming motion: v_lon(SV) < 4 m/s and F v_lon(SV) > 4 m/s -> F v_lon(SV) = 4 m/s", (), 1, ()),
        # The claim says the same as the limit, so that its proof does without.
        (f"assuming motion, {LIMIT}: G {LIMIT} -> a_lon(SV) <= 5 m/s^2", (), 0, (LIMIT,)),
        (f"assuming motion, {LIMIT}, minDanger = 0.6 s: {LIMIT} or F[0,minDanger] true", (), 0, (LIMIT,)),
    ],
)
def test_premises_are_those_of_the_certificate(claim, limits, facts, unused):
    answer, certificate = proved(claim)
    assumed = certificate.assumed
    assert (assumed.limits, len(assumed.axioms), assumed.unused) == (limits, facts, unused)
    assert rejection_reason(certificate, bundled_library(), check_sat) is None
    entry = answer.as_data()["verdicts"][0]
    assert entry["premises"] == [*limits, *map(str, assumed.axioms)]
    assert answer.rows()[0]["premises"] == "; ".join(entry["premises"])
    assert not [*validator("verdicts.json").iter_errors(answer.as_data())]
    data = certificate_data(certificate)
    assert not [*validator("certificate.json").iter_errors(data)]
    assert read_certificate_data(data, "it") == certificate
    text = str(answer)
    assert (NEITHER in text or NO_FACT in text) == (not limits and not facts)
    assert (f"of the limits: {', '.join(limits)}\n" in text + "\n") == bool(limits)
    assert ("of motion: " in text) == bool(facts)


def test_without_motion_nothing_is_said_of_it():
    answer, _ = proved("v_lon(SV) <= 4 m/s -> v_lon(SV) <= 5 m/s")
    assert "motion" not in str(answer)


def test_limits_of_a_model_are_told_apart():
    answer, certificate = proved("a_lon(SV) <= 10 m/s^2", assume="motion", vehicles={"SV": "car"})
    assert certificate.assumed.limits == (LIMIT,)
    assert f"  of the limits: {LIMIT}\n  limits not used: {OTHER}" in str(answer)


def test_a_limit_that_is_used_cannot_be_called_unused():
    _, certificate = proved(f"assuming motion, {LIMIT}: a_lon(SV) <= 4 m/s^2")
    forged = replace(certificate, assumed=replace(certificate.assumed, unused=(LIMIT,)))
    assert rejection_reason(forged, bundled_library(), check_sat) is not None


def test_only_a_limit_that_is_said_can_be_unused():
    _, certificate = proved(f"assuming motion, {LIMIT}: v_lon(SV) <= 4 m/s -> v_lon(SV) <= 5 m/s")
    forged = replace(certificate, assumed=replace(certificate.assumed, unused=(LIMIT, OTHER)))
    assert "the claim does not say these limits" in rejection_reason(forged, bundled_library(), check_sat)


def test_a_certificate_of_earlier_has_all_limits_as_premises():
    _, certificate = proved(f"assuming motion, {LIMIT}: a_lon(SV) <= 4 m/s^2")
    data = certificate_data(certificate)
    assert "unused" not in data
    assert read_certificate_data(data, "it").assumed.limits == (LIMIT,)


@pytest.mark.parametrize(
    "claim",
    ["v_lon(SV) <= 4 m/s -> v_lon(SV) <= 5 m/s", "a_lon(SV) <= 4 m/s^2", "a_lon(SV) <= 2 m/s^2"],
)
def test_limits_that_contradict_each_other_make_every_claim_vacuous(claim):
    """Also one that follows without them, or from one of them alone."""
    found = rp.prove(f"assuming motion, {LIMIT}, a_lon(SV) >= 5 m/s^2: {claim}", jobs=1)
    assert str(found.verdict) == "VACUOUS"
    assert found.rows()[0]["reason"] == "what is assumed contradicts itself, so every claim follows"


@pytest.mark.parametrize(
    ("claim", "told"),
    [
        ("assuming motion: false", "false on a drive without vehicles, judged exactly in dense time"),
        ("assuming motion: F[0 s, 1 s] some M in lanes: false", "false on a drive without vehicles"),
        ("assuming motion: rho < 1 s", "judged exactly in dense time, with rho=1"),
        ("assuming motion: F[rho, 2 s] true", "judged exactly in dense time, with rho=3"),
        ("assuming motion: F[0 s, 1 s] (true U[rho, 2 s] true)", "with rho=3"),
    ],
)
def test_a_claim_about_no_vehicle_is_refuted_under_motion(claim, told, tmp_path):
    """Facts about motion do not concern it."""
    found = rp.prove(claim, jobs=1, out=tmp_path)
    assert (found.verdict, found.rows()[0]["refuted_by"]) == (Verdict.REFUTED, "drive")
    assert told in str(found)
    assert check(tmp_path, jobs=1).accepted


LESS = "a_lon(SV) <= 4 m/s^2"
LATER = "v_lon(SV) <= 4 m/s -> G[0,1] v_lon(SV) <= 7 m/s"
ALWAYS = "a_lon(SV) > 0 or true"


@needs_coq
def test_coq_names_limits_as_limits(tmp_path):
    for name, claim in (("limit", LESS), ("both", LATER), ("none", ALWAYS)):
        rp.prove(f"assuming motion, {LIMIT}: {claim}", jobs=1, out=tmp_path / name)
    told = str(check(*(tmp_path / x for x in ("limit", "both", "none")), kernel="coq", jobs=1)).splitlines()
    for claim, under in ((LESS, True), (LATER, True), (ALWAYS, False)):
        (line,) = [x for x in told if claim in x]
        assert ("under 1 limit that is a premise; not checked: queries for solvers]" in line) == under
        assert ("premise" in line) == under
