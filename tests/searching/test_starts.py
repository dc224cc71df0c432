"""Conditions at time 0 that no engine reads: starts imply them, drives are judged on all that is asked."""

import random
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

import roadproof as rp
from planting import plant
from roadproof.engines.search import decide, initial_candidates, refute, sampling, search
from roadproof.engines.search.decide import decide_claim as settled
from roadproof.engines.search.drive_search import engine_reads_all
from roadproof.engines.search.initial_candidates import not_encodable, space_of
from roadproof.engines.search.question import pose
from roadproof.engines.search.refute import sampled_drive
from roadproof.engines.search.sampling import Space, holds, states
from roadproof.engines.setting import Search, SearchOptions, Setting
from roadproof.extensions.catalogue.completing import search_drive_or_unknown
from roadproof.library.bind import bind
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.library.scenario_references import read_query
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.rewrite import is_cubic_state, signals_of
from roadproof.logic.terms import Signal, Size
from roadproof.runtime.budget import Effort
from roadproof.semantics.exact.judging import judge
from roadproof.verdict import Verdict
from roadproof.world.models import load_road

HOME = bundled_library().select()
CUBE = "v_lon(SV)*v_lon(SV)*v_lon(SV) > 30*v_lon(POV)^2*1 m/s"
GAP = "(s(POV) - s(SV))*v_lon(POV)^2 < 10000*1 m*1 m/s*1 m/s"


def asked(text, units=20, home=HOME, **setting):
    scenario, query = read_query(home, text)
    return Search(home, query, Setting(**setting), SearchOptions(effort=Effort(units)), scenario=scenario)


def question(text, **setting):
    search_problem = asked(text, **setting)
    return pose(HOME.library, search_problem.query, search_problem.setting)


def found_starts(text, most=6):
    search_problem = question(text)
    return search_problem, [
        (lanes, start)
        for lanes in search_problem.lanes
        for start in initial_candidates.sampled_starts(
            search_problem, lanes, not_encodable(search_problem, lanes), most
        )
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
    search_problem = question(text)
    assert {len(not_encodable(search_problem, lanes)) for lanes in search_problem.lanes} == {count}
    assert engine_reads_all(asked(text)) == (count == 0)


@pytest.mark.parametrize("text", [f"{CUBE} and {GAP}", f"scenario_4(SV,POV,L) and {CUBE} and {GAP}"])
def test_a_start_implies_what_it_stands_for(text):
    """Any state that keeps its conditions, judged: at both ends of its interval and between."""
    search_problem, found = found_starts(text)
    space = space_of(search_problem)
    assert found
    for lanes, start in found:
        parts = f.conjunction(*not_encodable(search_problem, lanes))
        assert start.replaced == set(not_encodable(search_problem, lanes))
        wide = 0
        for share in (Fraction(0), Fraction(1, 3), Fraction(1)):
            state = {x: Fraction(7) for x in space.ranges}
            for x in start.conditions:
                other = Fraction(0) if x.beside is None else state[x.beside]
                state[x.signal] = other + x.low + share * (x.high - x.low)
                wide += x.low < x.high
            assert holds(parts, state, space.sizes)
        assert wide == 3
        assert set(signals_of([start.without(search_problem.bound(lanes))])) <= {
            "s",
            "d",
            "v_lon",
            "v_lat",
            "a_lon",
        }


@pytest.mark.parametrize(
    "text",
    [
        f"scenario_4(SV,POV,L) and {CUBE}",
        f"{CUBE} and v_lon(SV) = 90 km/h and F v_lon(SV) < 20 m/s",
        "scenario_1(SV,POV,L) and v_lat(POV)*v_lat(POV)*v_lon(POV) > 10*(1 m/s)*(1 m/s)*(1 m/s)",
    ],
)
def test_a_drive_is_found_and_judged_on_all_of_the_formula(text):
    outcome = search_drive_or_unknown(asked(text))
    assert outcome.verdict is Verdict.WITNESSED
    [judged] = outcome.drives
    assert judged.judgement.holds
    assert judge(judged.judgement.formula, judged.file.drive).holds


def test_the_same_drive_every_time():
    text = f"{CUBE} and {GAP} and F v_lon(SV) < 20 m/s"
    one, other = (search_drive_or_unknown(asked(text)).drives[0].as_data() for _ in range(2))
    assert one == other


def test_where_no_start_gives_a_drive_nothing_is_denied():
    """No drive is that fast so soon; yet only some starts were tried, so it is no NONE-WITHIN."""
    outcome = search_drive_or_unknown(asked(f"{CUBE} and F[0.6 s, 0.6 s] v_lon(SV) > v_lon(POV) + 30 m/s"))
    assert outcome.verdict is Verdict.UNKNOWN
    assert outcome.limits is None
    assert "sampled states" in outcome.reason
    assert "others were not tried" in outcome.reason


def test_where_no_state_is_found_nothing_is_denied():
    outcome = search_drive_or_unknown(
        asked("v_lon(SV)*v_lon(SV)*v_lon(SV) > 64000.5*(1 m/s)*(1 m/s)*(1 m/s)")
    )
    assert outcome.verdict is Verdict.UNKNOWN
    assert "no state in which it holds was found" in outcome.reason


def test_a_proof_that_there_is_none_stays_possible():
    outcome = search_drive_or_unknown(
        asked("v_lon(SV)^3 < v_lon(POV)^3 and v_lon(SV)^3 > v_lon(POV)^3 and F danger(SV,POV)")
    )
    assert outcome.verdict is Verdict.IMPOSSIBLE


# The interval is where the part does not hold; nothing is asked of the start at all.
FAULTS = {
    "the interval is wrong": (
        *(
            initial_candidates,
            "_free_range",
            "return inner if inner[0] <= value <= inner[1] else (value, value)",
        ),
        "return value + 20, value + 21",
    ),
    "no conditions": (initial_candidates, "start_conditions", "return tuple(made)", "return ()"),
}
NEAR = "(s(POV) - s(SV))^3 < 3375*(1 m)*(1 m)*(1 m) and (s(POV) - s(SV))^3 > 125*(1 m)*(1 m)*(1 m)"
FAST = "v_lon(SV)^3 > 59319*(1 m/s)*(1 m/s)*(1 m/s) and F v_lon(SV) < v_lon(POV)"


def test_without_a_fault_there_is_a_drive():
    assert search_drive_or_unknown(asked(f"{NEAR} and {FAST}", 1)).verdict is Verdict.WITNESSED


@pytest.mark.parametrize("fault", FAULTS)
def test_a_start_that_implies_too_little_is_caught_by_the_judge(fault, monkeypatch):
    plant(monkeypatch, *FAULTS[fault])
    monkeypatch.setattr(search, "STARTS", 2)
    outcome = search_drive_or_unknown(asked(f"{NEAR} and {FAST}", 1))
    assert (outcome.verdict, outcome.drives) == (Verdict.UNKNOWN, ())


def test_a_search_with_a_start_never_says_that_there_is_none():
    search_problem, found = found_starts(f"{CUBE} and {GAP}")
    lanes, start = found[0]
    begun = replace(search_problem, start=start, lanes=(lanes,))
    impossible = replace(begun, query=read_query(HOME, f"{CUBE} and {GAP} and v_lon(SV) > 100 m/s")[1])
    assert (
        search._GridSearch(impossible, SearchOptions(effort=Effort(5)), ()).run().verdict is Verdict.UNKNOWN
    )


# --- Claims about one instant that no engine reads: refuted from a sampled state, by a drive that is judged

FALSE = "v_lon(SV)*v_lon(SV)*v_lon(SV) <= v_lon(SV)*v_lon(POV)^2 or v_lon(SV) <= v_lon(POV)"
TRUE = "v_lon(SV) >= 0 and v_lon(POV) >= v_lon(SV) -> v_lon(SV)^3 <= v_lon(POV)^3"


def claim(text):
    return read_claim(HOME, text)


def sampled(text, values=None):
    return sampled_drive(HOME, claim(text), values or {}, Setting())


def test_a_false_claim_is_refuted_by_constant_motion():
    drive = sampled(FALSE)
    assert all(len(x.pieces) == 1 for x in drive.file.drive.vehicles.values())
    assert judge(drive.judgement.formula, drive.file.drive).holds


def test_a_claim_that_is_so_is_not_refuted():
    assert sampled(TRUE) is None


def test_states_beyond_the_limits_of_the_vehicles_are_looked_at():
    drive = sampled("v_lon(SV)^3 <= 64000*(1 m/s)*(1 m/s)*(1 m/s)")  # 40 m/s, which a car drives at most
    assert drive.file.drive.vehicles["SV"].v_lon > 40


def test_at_the_values_that_are_asked_for():
    text = "v_lon(SV)^3 <= rho*rho*rho*(120 m/s^2)*(120 m/s^2)*(120 m/s^2)"
    assert sampled(text) is None  # 72 m/s, which is far beyond what a car drives
    assert sampled(text, {"rho": Fraction(1, 5)}).file.values["rho"] == Fraction(1, 5)


@pytest.mark.parametrize(
    ("text", "cubic"),
    [
        (FALSE, True),
        ("v_lon(SV)^2 <= v_lon(POV)^2", False),
        (f"G ({FALSE})", False),
        ("given v: m/s: v*v*v <= v*v_lon(SV)^2", False),
        (f"atLane(SV, L) and ({FALSE})", False),
    ],
)
def test_of_which_claims_states_are_sampled(text, cubic):
    assert is_cubic_state(claim(text).formula) == cubic
    assert cubic or sampled(text) is None


def test_a_state_in_which_the_claim_is_true_is_no_refutation(monkeypatch):
    """A state that nobody has judged is handed on; the drive is judged all the same."""
    monkeypatch.setattr(
        refute, "states", lambda _, space, most: [{x: low for x, (low, _) in space.ranges.items()}]
    )
    assert sampled(TRUE) is None


def test_what_a_proof_does_not_decide_quickly_is_sampled(monkeypatch):
    """With no work for z3 the drive comes from a sampled state; with none for samples it stays in doubt."""
    monkeypatch.setattr(decide, "BRIEF", 1e-6)
    monkeypatch.setattr("roadproof.engines.search.refute.quick_drive", lambda *_: None)
    found = settled(HOME, claim(FALSE), Effort(2e-6))
    assert found.verdict is Verdict.REFUTED
    assert found.refuted_by == "drive"
    monkeypatch.setattr(decide._Decider, "_quick", lambda _: None)
    monkeypatch.setattr(decide._Decider, "_searched", lambda *_: None)
    assert settled(HOME, claim(FALSE), Effort(2e-6)).verdict is Verdict.UNKNOWN


def test_driver_models_are_told_apart_both_ways():
    home = rp.load(specs=["driver"])
    names = ("unpreventable_cutIn_r157(SV,POV)", "unpreventable_cutIn_eu1426(SV,POV)")
    found = rp.compare(*names, using=home, jobs=1)
    assert [str(x) for x in found.verdicts.values()] == ["REFUTED", "REFUTED"]
    assert all(drive.judgement.holds for drive in found.evidence)


# --- Sampled states: each holds by the judge, none of a formula without one, the same ones every time

VEHICLES = ("SV", "POV")
RANGES = {"s": 80, "d": 6, "v_lon": 40, "v_lat": 2, "a_lon": 4}
SPACE = Space(
    {Signal(name, v): (Fraction(-most), Fraction(most)) for name, most in RANGES.items() for v in VEHICLES},
    {Size(size, v): x for v in VEHICLES for size, x in (("length", Fraction(4)), ("width", Fraction(2)))},
)


def bound(text):
    return bind(read_claim(HOME, text).formula, load_road("main-2"), {}, {})


STATES = [
    "v_lon(SV)^3 > 100*v_lon(POV)^2*1 m/s and v_lat(SV)*v_lon(POV) < 0*1 m/s*1 m/s",
    "v_lon(SV) = 60 km/h and v_lon(SV)*v_lon(SV)*(s(POV)-s(SV)) > 1000*1 m*1 m/s*1 m/s",
    # thin: 0.2 m of 320 m, where the speeds are within 0.1 m/s of 80 m/s
    "s(POV) - s(SV) > 40 m and s(POV) - s(SV) < 40.2 m"
    " and abs(v_lon(SV) - 20 m/s) < 0.05 m/s and abs(v_lon(POV) - 10 m/s) < 0.05 m/s",
    # equalities, one through the other
    "v_lon(POV) = v_lon(SV) and s(POV) = s(SV) + v_lon(SV)*2 s - 4 m and v_lon(SV)^3 > 8*1 m/s*1 m/s*1 m/s",
    "max(v_lon(SV), v_lon(POV)) = 10 m/s and v_lon(SV) = 10 m/s",
]


@pytest.mark.parametrize("text", STATES)
def test_states_are_found_judged_and_different(text):
    formula = bound(text)
    found = states(formula, SPACE, 8)
    assert found
    assert all(holds(formula, state, SPACE.sizes) for state in found)
    assert len({tuple(sorted((x.name, x.vehicle, v) for x, v in state.items())) for state in found}) == len(
        found
    )
    assert all(SPACE.ranges[x][0] <= v <= SPACE.ranges[x][1] for state in found for x, v in state.items())


def test_the_same_states_every_time():
    formula = bound(STATES[0])
    assert states(formula, SPACE, 8) == states(formula, SPACE, 8)


def test_values_have_few_digits():
    assert all((1000 * v).denominator == 1 for x in states(bound(STATES[0]), SPACE, 8) for v in x.values())


@pytest.mark.parametrize(
    "text",
    [
        "v_lon(SV)^3 > v_lon(SV)^3 + 1*1 m/s*1 m/s*1 m/s",
        "v_lon(SV) = 100 m/s",  # outside the range
        "v_lon(SV) = 10 m/s and v_lon(SV) = 11 m/s",
        "v_lon(SV)^2 < 0*1 m/s*1 m/s",
        "false",
    ],
)
def test_a_formula_without_state_gives_none(text):
    assert states(bound(text), SPACE, 8) == []


def test_what_floating_point_sees_is_not_taken_for_granted(monkeypatch):
    """Where every point is called true, only what the judge accepts comes out."""

    def every_point(self):
        evenly = sampling.spread(0, 64, len(self.axes))
        return np.column_stack([x.values(evenly[:, k]) for k, x in enumerate(self.axes)])

    formula = bound(STATES[0])
    monkeypatch.setattr(sampling._StateSampler, "points", every_point)
    found = states(formula, SPACE, 64)
    assert 0 < len(found) < 64
    assert all(holds(formula, state, SPACE.sizes) for state in found)


def test_random_formulas_against_the_judge():
    """What is handed out holds; where a state chosen at random does, in a large set, some are found."""
    rng = random.Random(16)
    leaves = list(SPACE.ranges)

    def side():
        factors = tuple(rng.choice(leaves) for _ in range(rng.randint(1, 3)))
        return t.Sum((t.Product(factors), t.number(rng.randint(-50, 50))))

    missed = 0
    for _ in range(40):
        parts = [f.Compare(side(), rng.choice(["<", "<=", ">", ">="]), side()) for _ in range(3)]
        formula = f.And((f.Or((parts[0], f.Not(parts[1]))), parts[2]))
        found = states(formula, SPACE, 4)
        assert all(holds(formula, state, SPACE.sizes) for state in found)
        drawn = [{x: Fraction(rng.randint(*map(int, r))) for x, r in SPACE.ranges.items()} for _ in range(20)]
        missed += not found and any(holds(formula, state, SPACE.sizes) for state in drawn)
    assert missed == 0


# --- A claim about one instant that no search can refute is refuted by constant motion from there ---


def test_a_cubic_claim_is_refuted_by_a_steady_drive():
    home = rp.load()
    claim = "v_lon(SV)*v_lon(SV)*v_lon(SV) <= v_lon(SV)*v_lon(POV)*v_lon(POV) or v_lon(SV) <= v_lon(POV)"
    answer = rp.prove(claim, using=home, jobs=1)
    [drive] = answer.evidence
    assert str(answer.verdict) == "REFUTED"
    formula = bind(read_claim(home.specification, claim).formula, drive.file.road, {}, drive.file.values)
    assert not judge(formula, drive.file.drive).holds
    assert all(len(x.pieces) == 1 for x in drive.file.drive.vehicles.values())


def test_a_number_of_the_claims_own_is_refuted_by_a_trace():
    answer = rp.prove("given v: m/s: v*v*v <= v*v_lon(SV)^2", jobs=1)
    assert str(answer.verdict) == "REFUTED"
    assert "by a trace" in str(answer)


def test_two_formulas_about_one_instant_are_compared_without_a_search():
    """At the declared values: the engines cannot bound cubes."""
    first = "v_lon(SV)*v_lon(SV)*v_lon(SV) > rho*a_max*v_lon(POV)^2 and v_lon(POV) > rho*a_max"
    second = "v_lon(SV)*v_lon(SV)*v_lon(SV) > (rho*a_max)^3"
    found = rp.compare(first, second, jobs=1)
    assert [str(x) for x in found.verdicts.values()] == ["PROVED", "REFUTED"]
    _, drive = found.evidence
    assert found.exit_code == 0
    assert len(drive.file.drive.vehicles) == 2
