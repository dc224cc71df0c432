"""Causes of UNKNOWN: each from where the search stopped and from the form of the claim, never from words."""

import json

import pytest

import roadproof as rp
from cli.test_schemas import validator
from roadproof.engines.prove.doubt import Cause, Doubt, Stop, Try, doubt_of
from roadproof.frontends.cli.main import main
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.runtime.budget import Effort

specification = bundled_library().select("base")
P, Q = "atLane(SV,L)", "atLane(POV,L)"


def doubt(claim: str, stop: Stop = Stop.WORK, said: tuple[str, ...] = (), units: float = 60) -> Doubt:
    return doubt_of(read_claim(specification, claim), said, stop, Effort(units), True, "the detail")


@pytest.mark.parametrize(
    ("claim", "cause"),
    [
        (f"G ({P} -> F[1,1] {P}) and {P} -> G F {P}", Cause.INDUCTION),
        (f"G ({P} -> F[0,1] {Q}) -> G {Q}", Cause.INDUCTION),
        (f"G F {P} -> F G {P}", Cause.ALTERNATION),
        (f"not (G F {P} and G F {Q})", Cause.ALTERNATION),
        (f"G (not {P} or true U {Q}) -> {Q}", Cause.ALTERNATION),
        (f"{P} and F {Q} -> {P} U {Q}", Cause.FIRST_INSTANT),
        # An until that is supposed has its first instant, and a bounded G has an end.
        (f"{P} U {Q} -> F {Q}", Cause.WORK),
        (f"G[0,5] F {P} -> F {P} and {Q}", Cause.WORK),
        (f"F G {P} -> G {P}", Cause.WORK),
    ],
)
def test_the_form_of_a_claim_tells_the_cause(claim, cause):
    assert doubt(claim).cause is cause
    assert doubt(claim, Stop.ROUNDS).cause is cause
    assert doubt(claim, units=1).cause is Cause.WORK


@pytest.mark.parametrize(
    ("claim", "said", "cause"),
    [
        ("s(SV) <= 0 m -> G[1,1] s(SV) <= 9 m", ("motion", "a_lon(SV) <= 2 m/s^2"), Cause.SECOND_ORDER),
        ("d(SV) <= 0 m and G a_lat(SV) <= 0 m/s^2 -> G[1,1] d(SV) <= 9 m", ("motion",), Cause.SECOND_ORDER),
        ("s(SV) <= 0 m -> G[1,1] s(SV) <= 9 m", ("motion", "a_lat(SV) <= 2 m/s^2"), Cause.FACTS),
        ("s(SV) <= 0 m -> G[1,1] s(SV) <= 9 m", ("motion",), Cause.FACTS),
        (f"{P} and F {Q} -> {P} U {Q}", ("motion",), Cause.FACTS),
    ],
)
def test_of_motions_also_what_is_assumed_tells_it(claim, said, cause):
    found = doubt(claim, Stop.FACTS, said)
    assert found.cause is cause
    assert Try.TRACES not in found.tried


@pytest.mark.parametrize("stop", [Stop.CLOCK, Stop.PROCESS, Stop.SOLVER, Stop.LANES, Stop.CERTIFICATE])
def test_where_a_search_stopped_by_itself_the_form_does_not_matter(stop):
    assert doubt(f"G F {P} -> F G {P}", stop).cause == Cause(stop)


@pytest.mark.parametrize("cause", Cause)
def test_every_cause_says_what_was_tried_and_what_helps(cause):
    found = Doubt(cause, (Try.PROOF,), 60, "the detail")
    schema = validator("verdicts.json").schema["$defs"]["doubt"]
    assert cause in schema["properties"]["cause"]["enum"]
    if cause in (Cause.CLOCK, Cause.PROCESS):
        assert str(found) == "the detail"
    else:
        assert "tried: a proof" in str(found)
        assert found.remedy in str(found)
        assert ("more work may help" in str(found)) == found.cause.effort_helps


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
