"""Drives for scenarios and formulas: judged, natural, and a no that is explained."""

import json
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise

import pytest

import roadproof as rp
from engine_calls import search_for, search_problem
from roadproof.engines.encode.motion import ColumnLayout
from roadproof.engines.encode.problem import evaluate
from roadproof.engines.encode.unroll import Grid
from roadproof.engines.search import search
from roadproof.engines.search.drive_search import search_drive
from roadproof.engines.search.initial_conditions import CLEARLY, differs_from
from roadproof.engines.search.search import find_witness, show_none
from roadproof.engines.search.shape import _with_margin
from roadproof.engines.setting import SearchOptions
from roadproof.engines.solve.bounds import Affine, Bound
from roadproof.engines.solve.smooth import minimise
from roadproof.errors import UsageError
from roadproof.evidence.drive_file import read_drive
from roadproof.evidence.judged import judge_file
from roadproof.library.loading import bundled_library, load_library
from roadproof.library.specification import Source
from roadproof.runtime.budget import Effort
from roadproof.semantics.exact.replay import first_breach, first_overlap
from roadproof.verdict import Verdict
from roadproof.world.drive import Drive, Motion, Piece, value_at
from roadproof.world.models import load_road, load_vehicle
from roadproof.world.motion import piece_starts, state_at

LIBRARY = bundled_library()
MEANS = SearchOptions(effort=Effort(30))


def ask_for(what, set_name="base", **changes):
    return search_drive(search_for(what, set_name, **changes))


def drive_of(outcome, k=0):
    return outcome.drives[k].file


def gap(file, ahead, behind, time):
    first, second = (state_at(file.drive.vehicles[name], time) for name in (ahead, behind))
    return first.s - file.drive.vehicles[ahead].length - second.s


def lateral_spells(motion):
    """How long each movement across the road lasts, in s."""
    spells, begun = [], None
    for state in piece_starts(motion):
        if begun is None and (state.v_lat or state.a_lat):
            begun = state.time
        if begun is not None and not state.v_lat and not state.a_lat:
            spells.append(state.time - begun)
            begun = None
    assert begun is None
    return spells


@pytest.mark.parametrize(
    ("scenario", "set_name"),
    [
        *((1, "base"), (2, "base"), (3, "ext"), (4, "extA"), (5, "ext"), (6, "base"), (7, "base")),
        *((8, "extA"), (9, "ext"), (12, "base"), (16, "base"), (20, "extA"), (24, "base")),
    ],
)
def test_scenarios_have_natural_judged_drives(scenario, set_name):
    outcome = ask_for(str(scenario), set_name)
    assert outcome.verdict is Verdict.WITNESSED
    assert outcome.natural
    file = drive_of(outcome)
    assert judge_file(file, LIBRARY).accepted
    assert first_overlap(file.drive, file.horizon) is None
    car = load_vehicle("car")
    assert first_breach(file.drive, dict.fromkeys(file.drive.vehicles, car), None) is None
    for motion in file.drive.vehicles.values():
        pieces = motion.pieces
        assert all(abs(b.a_lon - a.a_lon) <= 3 for a, b in pairwise(pieces))
        assert all(state.v_lon >= 15 for state in piece_starts(motion))
        spells = lateral_spells(motion)  # of one lane change, in one direction
        assert not spells or 2 <= sum(spells) <= 6
        for state in piece_starts(motion):
            assert abs(state.v_lat) * 10 <= state.v_lon


def test_a_drive_is_rejected_when_it_is_changed():
    file = drive_of(ask_for("4"))
    pov = file.drive.vehicles["POV"]
    gone = replace(file.drive, vehicles={**file.drive.vehicles, "POV": replace(pov, s=pov.s - 500)})
    assert not judge_file(replace(file, drive=gone), LIBRARY).accepted
    touching = {**file.drive.vehicles, "SV": replace(file.drive.vehicles["SV"], s=pov.s - 1)}
    assert not judge_file(replace(file, drive=replace(file.drive, vehicles=touching)), LIBRARY).accepted
    assert not judge_file(replace(file, formula="not (scenario_4(SV, POV, L))"), LIBRARY).accepted
    assert not judge_file(replace(file, lanes={"L": "main-2"}), LIBRARY).accepted


def test_objectives_do_what_they_say():
    nearest = {}
    for objective in ("any", "smooth", "margin", "mild", "severe", "short"):
        outcome = ask_for("4", search_options=replace(MEANS, objective=objective))
        assert outcome.verdict is Verdict.WITNESSED
        file = drive_of(outcome)
        times = [k * Fraction(1, 10) for k in range(int(file.horizon * 10) + 1)]
        nearest[objective] = min(gap(file, "POV", "SV", time) for time in times), file.horizon
    assert nearest["severe"][0] < nearest["mild"][0] - 5
    assert nearest["short"][1] < nearest["smooth"][1]


def test_several_drives_differ_clearly():
    found = [x.file.drive for x in rp.witness("4", count=3, jobs=1).drives]
    assert len(found) == 3
    for i in range(3):
        for k in range(i):
            one, other = found[i].vehicles, found[k].vehicles
            apart = [
                abs(getattr(state_at(one[name], time), signal) - getattr(state_at(other[name], time), signal))
                >= distance - Fraction(1, 10)
                for name in one
                for time in (Fraction(0), Fraction(6))
                for signal, distance in CLEARLY.items()
            ]
            assert any(apart)


def test_overlapping_scenarios_have_a_drive_and_exclusive_ones_a_proof():
    both = ask_for("scenario_4(SV,POV,L) and scenario_6(SV,POV,L)")
    assert both.verdict is Verdict.WITNESSED
    never = ask_for("scenario_1(SV,POV,L) and scenario_4(SV,POV,L)")
    assert never.verdict is Verdict.IMPOSSIBLE
    assert never.impossibility is not None
    assert "not sameLane(POV, SV, L)" in never.impossibility.core_texts
    assert never.impossibility.minimal


def test_none_within_names_its_limits():
    outcome = ask_for("F v_lon(SV) > 41 m/s")
    assert outcome.verdict is Verdict.NONE_WITHIN
    for part in ("main-2", "0.6 s", "SV=car", "--horizon"):
        assert part in outcome.reason


def test_equalities_and_what_comes_after_the_horizon():
    outcome = ask_for("G v_lon(SV) = 30 m/s")
    assert outcome.verdict is Verdict.WITNESSED
    outcome = ask_for("G (s(POV) - s(SV) > 10 m) and F G v_lon(POV) < v_lon(SV)")
    assert outcome.verdict in (Verdict.NONE_WITHIN, Verdict.UNKNOWN, Verdict.IMPOSSIBLE)
    outcome = ask_for("G (s(POV) - s(SV) > 10 m) and F[0, 3 s] v_lon(POV) < v_lon(SV)")
    assert outcome.verdict is Verdict.WITNESSED


def test_both_engines_answer_alike():
    short = {"horizon": Fraction(9, 5)}
    for what, verdict in (("4", Verdict.WITNESSED), ("F v_lon(SV) > 41 m/s", Verdict.NONE_WITHIN)):
        for engine in ("milp", "smt"):
            search_options = replace(MEANS, engine=engine, effort=Effort(240))
            assert ask_for(what, search_options=search_options, **short).verdict is verdict
    cubic = "F v_lon(SV)^3 > 20000 * 1 m/s * 1 m/s * 1 m/s"
    with pytest.raises(UsageError, match="use the engine smt"):
        ask_for(cubic)
    assert ask_for(cubic, search_options=replace(MEANS, engine="smt"), **short).verdict is Verdict.WITNESSED


def test_a_drive_that_the_judge_rejects_is_never_handed_out(monkeypatch):
    true_judge = search.judge

    class No:
        holds = False

    monkeypatch.setattr(search, "judge", lambda formula, drive: No())
    outcome = ask_for("4", search_options=replace(MEANS, effort=Effort(4), refinements=0))
    assert outcome.verdict is Verdict.UNKNOWN
    assert not outcome.drives
    assert true_judge is not search.judge


def test_what_fails_between_the_samples_is_looked_at_more_closely():
    """On samples of 3 s a short peak of speed goes unseen; finer grids find out."""
    peak = "F[0, 3 s] v_lon(SV) > 32 m/s and not (v_lon(SV) > 30 m/s or F[3 s, 3 s] v_lon(SV) > 30 m/s)"
    outcome = ask_for(peak, dt=Fraction(3), horizon=Fraction(6))
    assert outcome.verdict in (Verdict.WITNESSED, Verdict.UNKNOWN, Verdict.NONE_WITHIN)
    if outcome.drives:
        assert judge_file(drive_of(outcome), LIBRARY).accepted


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"dt": Fraction(1, 7)}, "no multiple of dt"),
        ({"horizon": Fraction(7), "dt": Fraction(3, 5)}, "no multiple of dt"),
        ({"horizon": Fraction(6000)}, "at most"),
        ({"lanes": {"L": "main-9"}}, "has the lanes main-1, main-2"),
        ({"lanes": {"M": "main-1"}}, "the formula mentions L"),
        ({"vehicles": {"POV7": "car"}}, "the formula mentions"),
        ({"values": {"minDanger": Fraction(1, 2)}, "dt": Fraction(3, 5)}, "no multiple of dt"),
    ],
)
def test_requests_that_make_no_sense(changes, message):
    with pytest.raises(UsageError, match=message):
        ask_for("4", **changes)


@pytest.mark.parametrize(
    ("what", "horizon", "dt", "steps"),
    [
        ("v_lon(SV) > 20 m/s", 6, Fraction(3, 5), 10),
        ("F[0, 1 s] v_lon(SV) > 20 m/s", 6, Fraction(1, 2), 12),
        ("F[0, 0.5 s] G[0, 0.6 s] v_lon(SV) > 20 m/s", 6, Fraction(1, 10), 60),
        ("scenario_4(SV, POV, L)", 6, Fraction(3, 5), 10),
        ("scenario_4(SV, POV, L)", 5, Fraction(1, 5), 25),
        ("F[0, 0.6 s] v_lon(SV) > 20 m/s", Fraction(501, 100), Fraction(3, 5), 9),
    ],
)
def test_the_step_is_the_coarsest_that_fits(what, horizon, dt, steps):
    assert search_problem(search_for(what, horizon=Fraction(horizon))).grid == Grid(dt, steps)


def test_more_lanes_than_a_search_can_try_are_refused_at_once():
    names = [f"A{number}" for number in range(24)]
    claim = f"given {', '.join(names)}: lane: {' and '.join(f'atLane(SV, {x})' for x in names)}"
    with pytest.raises(UsageError, match=r"in 16,777,216 ways .* fix some, such as lane A0="):
        ask_for(claim)
    fixed = dict.fromkeys(names, "main-1")
    assert ask_for(claim, lanes=fixed).verdict is Verdict.WITNESSED


def test_a_formula_without_vehicles_shows_nothing():
    with pytest.raises(UsageError, match="no vehicle"):
        ask_for("true")


# --- Custom signals and kinds in drives and proofs: found, written, read, and refused where they were changed

SPEC = """
signal red: bool
signal jerk(a: vehicle): m/s^3 in [-10, 10]
signal free(a: vehicle): m
signal wild(a: vehicle): bool derived by jerk(a) > 9 m/s^3
"""
HOME = rp.load(specs=[SPEC])
OWN = load_library([Source("own.spec", SPEC)])
FORMULA = "kind(SV) = truck and not red and F (red and wild(SV)) and F jerk(SV) < 0 and free(SV) > 2000 m"


@pytest.fixture(scope="module")
def found():
    return rp.witness(FORMULA, using=HOME).drives[0].as_data()


def changed(found, change):
    data = json.loads(json.dumps(found))
    change(data)
    return judge_file(read_drive(data, "drive"), OWN)


def test_a_drive_has_a_course_for_each_signal_and_is_judged_again(found):
    assert {(x["signal"], x["vehicle"]) for x in found["signals"]} == {
        ("red", None),
        ("jerk", "SV"),
        ("free", "SV"),
    }
    assert found["vehicles"]["SV"]["kind"] == "truck"
    assert changed(found, lambda data: None).accepted
    assert read_drive(found, "drive").drive == rp.witness(FORMULA, using=HOME).drives[0].file.drive


def course(data, name):
    return next(x for x in data["signals"] if x["signal"] == name)["values"]


CHANGES = {
    "a value beyond the bounds": (
        lambda data: course(data, "jerk")[-1].update(value="11"),
        "within [-10, 10] m/s^3",
    ),
    "no truth value": (lambda data: course(data, "red")[-1].update(value="1/2"), "false or true"),
    "never red": (lambda data: [x.update(value="0") for x in course(data, "red")], "does not hold"),
    "no course": (lambda data: data.pop("signals"), "the drive says nothing of"),
    "another kind": (lambda data: data["vehicles"]["SV"].update(kind="bus"), "does not hold"),
    "no kind": (lambda data: data["vehicles"]["SV"].pop("kind"), "what kind of vehicle SV is"),
}


@pytest.mark.parametrize("name", CHANGES)
def test_a_changed_drive_is_rejected(found, name):
    change, told = CHANGES[name]
    ruling = changed(found, change)
    assert not ruling.accepted
    assert told in ruling.reason


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (lambda data: course(data, "red")[0].update({"from": "1"}), "their times must ascend from 0"),
        (lambda data: data["signals"].append(data["signals"][0]), "is given twice"),
        (lambda data: data["signals"][0].update(vehicle="X"), "which the drive does not have"),
        (lambda data: data["vehicles"]["SV"].update(kind="lorry"), "is none of car, truck"),
    ],
)
def test_what_is_no_course_cannot_be_read(found, change, told):
    with pytest.raises(rp.InputError, match=told):
        changed(found, change)


def test_a_no_names_the_ranges_that_were_tried():
    wide = "free(SV) > 5 m and F (free(SV) < -1001 m and red)"
    assert rp.witness(wide, using=HOME, effort=5).drives  # the largest number widens the range
    clash = "kind(SV) = truck and F v_lon(SV) > 30 m/s or jerk(SV) > 10 m/s^3 and red"
    none = rp.witness(clash, using=HOME, effort=5)
    told = "custom signals constant between samples, jerk(SV) in [-10, 10] m/s^3, red in false or true"
    assert told in str(none)
    assert none.as_data()["verdicts"][0]["limits"]["signals"]["red"] == "false or true"


def test_a_model_that_does_not_say_its_kind_is_refused_where_that_matters():
    car = load_vehicle("car")
    unknown = type(car)(**{**vars(car), "kind": None})
    with pytest.raises(UsageError, match="the model does not say it"):
        rp.witness("kind(SV) = truck", vehicles=unknown)
    assert rp.witness("v_lon(SV) > 20 m/s", vehicles=unknown).drives


TRUE = (
    "G jerk(SV) <= 10 m/s^3",
    "jerk(SV)^2 <= 100 m/s^3 * 1 m/s^3",
    "kind(SV) = car -> G not kind(SV) = bus",
)
FALSE = ("G jerk(SV) < 10 m/s^3", "red -> G red", "free(SV) <= 100000 m", "kind(SV) = car")


def test_the_bound_is_known_at_every_instant_and_nothing_else_is():
    proved = rp.prove(*TRUE, using=HOME)
    assert {str(x) for x in proved.verdicts.values()} == {"PROVED"}
    assert proved.check().exit_code == 0
    refuted = rp.prove(*FALSE, using=HOME)
    assert {str(x) for x in refuted.verdicts.values()} == {"REFUTED"}
    assert "jerk" in refuted.as_data()["signals"]


def test_a_certificate_is_bound_to_the_declared_bounds(tmp_path):
    folder = rp.prove(TRUE[0], using=HOME).save(tmp_path / "kept")
    (spec,) = folder.glob("*.spec")
    spec.write_text(spec.read_text().replace("[-10, 10]", "[-10, 11]"))
    assert rp.check(folder).exit_code == 10


def test_recast_drives_keep_own_signals():
    still = Motion(*map(Fraction, (4, 2, 0, 3, 20, 0)), (Piece(None, Fraction(0), Fraction(0)),))
    red, jerk = ((Fraction(0), Fraction(1)),), ((Fraction(0), Fraction(2)), (Fraction(1), Fraction(3)))
    drive = Drive({"SV": still, "POV": still}, {("red", ""): red, ("jerk", "POV"): jerk})
    assert drive.cast({"A": "POV", "B": "SV"}).custom_signals == {("red", ""): red, ("jerk", "A"): jerk}
    assert [value_at(jerk, Fraction(x, 2)) for x in range(4)] == [2, 2, 3, 3]


# --- What a search tries and what it says where it found nothing; no solver is asked ----------------


def question(what, **changes):
    return search_problem(search_for(what, **changes))


def tried(monkeypatch, doubt, refinements):
    """The steps of the grids that are tried, in order, where every attempt ends in ``doubt``."""
    steps = []

    def attempt(self, lanes, grid, assumptions):
        steps.append(grid.dt)
        self.unknown = doubt

    monkeypatch.setattr(search._GridSearch, "_attempt", attempt)
    search_options = SearchOptions(refinements=refinements, explain=False)
    answer = find_witness(question("v_lon(SV) > 20 m/s", natural=False), search_options)
    assert answer.verdict is Verdict.UNKNOWN
    assert answer.reason == (doubt or "none was found")
    return steps


def test_finer_grids_are_tried_where_there_is_a_doubt(monkeypatch):
    dt = Fraction(3, 5)
    assert tried(monkeypatch, "it fails between the samples", 2) == [dt, dt / 2, dt / 4]
    assert tried(monkeypatch, "it fails between the samples", 0) == [dt]
    assert tried(monkeypatch, "", 2) == [dt]


@pytest.mark.parametrize(("what", "shown"), [("v_lon(SV) > 20 m/s", "main-2"), ("atLane(SV, L)", "L=main-1")])
def test_where_nothing_was_found_it_says_where(what, shown, monkeypatch):
    monkeypatch.setattr(search._GridSearch, "_refute", lambda self, problem: ("", None))
    answer = show_none(question(what, horizon=Fraction(6, 5)), SearchOptions())
    assert answer.verdict is Verdict.UNKNOWN
    assert answer.reason.endswith(f"with the work given for {shown}")


# --- What makes drives alike or different, and inequalities that are kept with a margin -------------

X, Y = Affine(((0, 1.0),), 0.0), Affine(((1, 1.0),), 0.0)
BOUNDS = [Bound(X, 0.5), Bound(X + Y.scaled(-1.0), 0.25), Bound(Y, 0.0)]


def greatest(x_most):
    """The point where the inequalities with a margin hold by as much as they can; y is fixed at 0."""
    box, bounds, cost = _with_margin([(0.0, x_most), (0.0, 0.0)], BOUNDS)
    found = minimise([], box, bounds, [], cost)
    return None if found is None else found[:2]


def test_facts_with_a_margin_hold_by_as_much_as_they_can():
    assert greatest(8.0) == pytest.approx((8.0, 0.0), abs=1e-3)


def test_no_fact_keeps_less_than_the_least_margin():
    assert greatest(0.1) is None


def test_vehicles_clearly_apart_across_are_in_different_lanes():
    """From one side of a lane to the other is no other drive, from lane to lane is."""
    car, layout = load_vehicle("car"), ColumnLayout(("SV",), Grid(Fraction(1), 1))
    right, left = load_road("main-2").lanelets[0].d
    still = (Piece(None, Fraction(0), Fraction(0)),)
    start = right + car.width
    other = Drive({"SV": Motion(car.length, car.width, Fraction(0), start, Fraction(20), Fraction(0), still)})
    for d, clearly in ((left, False), (start + left - right, True)):
        signals = {"s": (0, 20), "d": (d, d), "v_lon": (20, 20), "v_lat": (0, 0)}
        values = {layout.column("SV", x, k): Fraction(pair[k]) for x, pair in signals.items() for k in (0, 1)}
        made = differs_from(layout, other)
        assert evaluate(made, lambda x, v=values: x.polynomial.value(lambda c: v[c]) >= 0) == clearly
