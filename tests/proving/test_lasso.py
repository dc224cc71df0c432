"""Traces that repeat themselves, and states of their own after an instant: found, judged, checked."""

import json
from dataclasses import replace
from fractions import Fraction

import pytest

import roadproof as rp
from asking import prove
from roadproof.engines.prove import lasso
from roadproof.evidence.finding import Acceptance
from roadproof.evidence.periodic import Loop
from roadproof.evidence.refutation import Countermodel, Instant, fault_of, judge_trace, read_trace, trace_data
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.verdict import Verdict

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


def trace(*speeds, loop=None, held="before"):
    """Instants a second apart; a speed may be a pair: at the instant and after it."""
    instants = []
    for k, speed in enumerate(speeds):
        at, after = speed if isinstance(speed, tuple) else (speed, None)
        own = None if after is None else {"v_lon(SV)": Fraction(after)}
        instants.append(Instant(Fraction(k), {"v_lon(SV)": Fraction(at)}, {}, own))
    return Countermodel(tuple(instants), {}, held, None, loop)


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
    assert "of the one before" in fault_of(trace(11, 5, loop=loop(0, 2), held="after"), read(ALTERNATING), {})


def test_a_size_that_changes_after_an_instant():
    made = trace(11, (5, 11), loop=loop(0, 2))
    first, second = made.instants
    wider = replace(second, after={**second.after, "width(SV)": Fraction(2)})
    assert "width" in fault_of(replace(made, instants=(first, wider)), read(ALTERNATING), {})


@pytest.mark.parametrize(
    "made", [trace(11, 5), trace(11, (5, 11), loop=loop(1, 3)), trace((1, 2), 3, held="after")]
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
