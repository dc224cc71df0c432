"""Conditions at time 0 that no engine reads: starts imply them, drives are judged on all that is asked."""

from dataclasses import replace
from fractions import Fraction

import pytest

from planting import plant
from roadproof.engines.search import initial_candidates, search
from roadproof.engines.search.ask import Search, answer, reads_all
from roadproof.engines.search.initial_candidates import space_of, unread
from roadproof.engines.search.question import SearchOptions, Setting, pose
from roadproof.engines.search.sampling import holds
from roadproof.library.loading import bundled_library
from roadproof.library.scenario_references import read_query
from roadproof.logic import formula as f
from roadproof.logic.rewrite import signals_of
from roadproof.runtime.budget import Effort
from roadproof.semantics.exact.exact import judge
from roadproof.verdict import Verdict

HOME = bundled_library().select()
CUBE = "v_lon(SV)*v_lon(SV)*v_lon(SV) > 30*v_lon(POV)^2*1 m/s"
GAP = "(s(POV) - s(SV))*v_lon(POV)^2 < 10000*1 m*1 m/s*1 m/s"


def asked(text, units=20, home=HOME, **setting):
    scenario, query = read_query(home, text)
    return Search(home, query, Setting(**setting), SearchOptions(effort=Effort(units)), 1, scenario)


def question(text, **setting):
    posed = asked(text, **setting)
    return pose(HOME.library, posed.query, posed.setting)


def found_starts(text, most=6):
    posed = question(text)
    return posed, [
        (lanes, start)
        for lanes in posed.lanes
        for start in initial_candidates.starts(posed, lanes, unread(posed, lanes), most)
    ]


@pytest.mark.parametrize(
    ("text", "count"),
    [
        ("v_lon(SV) > v_lon(POV)", 0),
        ("scenario_4(SV,POV,L)", 0),
        ("j_lon(SV)*v_lon(SV)*v_lon(SV) <= 0*1 m/s*1 m/s*1 m/s^3", 0),  # there is no jerk on a grid
        (CUBE, 1),
        (f"not (F ({GAP})) and {CUBE}", 1),  # at one instant; the other part is about all
        (f"not ({CUBE} or not {GAP})", 2),
    ],
)
def test_which_parts_are_not_read(text, count):
    posed = question(text)
    assert {len(unread(posed, lanes)) for lanes in posed.lanes} == {count}
    assert reads_all(asked(text)) == (count == 0)


@pytest.mark.parametrize("text", [f"{CUBE} and {GAP}", f"scenario_4(SV,POV,L) and {CUBE} and {GAP}"])
def test_a_start_implies_what_it_stands_for(text):
    """Any state that keeps its conditions, judged: at both ends of its interval and between."""
    posed, found = found_starts(text)
    space = space_of(posed)
    assert found
    for lanes, start in found:
        parts = f.conjunction(*unread(posed, lanes))
        assert start.replaced == set(unread(posed, lanes))
        wide = 0
        for share in (Fraction(0), Fraction(1, 3), Fraction(1)):
            state = {x: Fraction(7) for x in space.ranges}
            for x in start.conditions:
                other = Fraction(0) if x.beside is None else state[x.beside]
                state[x.signal] = other + x.low + share * (x.high - x.low)
                wide += x.low < x.high
            assert holds(parts, state, space.sizes)
        assert wide == 3
        assert set(signals_of([start.without(posed.bound(lanes))])) <= {"s", "d", "v_lon", "v_lat", "a_lon"}


@pytest.mark.parametrize(
    "text",
    [
        f"scenario_4(SV,POV,L) and {CUBE}",
        f"{CUBE} and v_lon(SV) = 90 km/h and F v_lon(SV) < 20 m/s",
        "scenario_1(SV,POV,L) and v_lat(POV)*v_lat(POV)*v_lon(POV) > 10*(1 m/s)*(1 m/s)*(1 m/s)",
    ],
)
def test_a_drive_is_found_and_judged_on_all_of_the_formula(text):
    outcome = answer(asked(text))
    assert outcome.verdict is Verdict.WITNESSED
    [judged] = outcome.drives
    assert judged.judgement.holds
    assert judge(judged.judgement.formula, judged.file.drive).holds


def test_the_same_drive_every_time():
    text = f"{CUBE} and {GAP} and F v_lon(SV) < 20 m/s"
    one, other = (answer(asked(text)).drives[0].as_data() for _ in range(2))
    assert one == other


def test_where_no_start_gives_a_drive_nothing_is_denied():
    """No drive is that fast so soon; yet only some starts were tried, so it is no NONE-WITHIN."""
    outcome = answer(asked(f"{CUBE} and F[0.6 s, 0.6 s] v_lon(SV) > v_lon(POV) + 30 m/s"))
    assert outcome.verdict is Verdict.UNKNOWN
    assert outcome.limits is None
    assert "sampled states" in outcome.reason
    assert "others were not tried" in outcome.reason


def test_where_no_state_is_found_nothing_is_denied():
    outcome = answer(asked("v_lon(SV)*v_lon(SV)*v_lon(SV) > 64000.5*(1 m/s)*(1 m/s)*(1 m/s)"))
    assert outcome.verdict is Verdict.UNKNOWN
    assert "no state in which it holds was found" in outcome.reason


def test_a_proof_that_there_is_none_stays_possible():
    outcome = answer(asked("v_lon(SV)^3 < v_lon(POV)^3 and v_lon(SV)^3 > v_lon(POV)^3 and F danger(SV,POV)"))
    assert outcome.verdict is Verdict.IMPOSSIBLE


# The interval is where the part does not hold; nothing is asked of the start at all.
FAULTS = {
    "the interval is wrong": (
        *(initial_candidates, "_free", "return inner if inner[0] <= value <= inner[1] else (value, value)"),
        "return value + 20, value + 21",
    ),
    "no conditions": (initial_candidates, "conditions", "return tuple(found)", "return ()"),
}
NEAR = "(s(POV) - s(SV))^3 < 3375*(1 m)*(1 m)*(1 m) and (s(POV) - s(SV))^3 > 125*(1 m)*(1 m)*(1 m)"
FAST = "v_lon(SV)^3 > 59319*(1 m/s)*(1 m/s)*(1 m/s) and F v_lon(SV) < v_lon(POV)"


def test_without_a_fault_there_is_a_drive():
    assert answer(asked(f"{NEAR} and {FAST}", 1)).verdict is Verdict.WITNESSED


@pytest.mark.parametrize("fault", FAULTS)
def test_a_start_that_implies_too_little_is_caught_by_the_judge(fault, monkeypatch):
    plant(monkeypatch, *FAULTS[fault])
    monkeypatch.setattr(search, "STARTS", 2)
    outcome = answer(asked(f"{NEAR} and {FAST}", 1))
    assert (outcome.verdict, outcome.drives) == (Verdict.UNKNOWN, ())


def test_a_search_with_a_start_never_says_that_there_is_none():
    posed, found = found_starts(f"{CUBE} and {GAP}")
    lanes, start = found[0]
    begun = replace(posed, start=start, lanes=(lanes,))
    impossible = replace(begun, query=read_query(HOME, f"{CUBE} and {GAP} and v_lon(SV) > 100 m/s")[1])
    assert search._Search(impossible, SearchOptions(effort=Effort(5)), ()).run().verdict is Verdict.UNKNOWN
