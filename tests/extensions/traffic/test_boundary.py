"""Measured roads: what the projection is off by, and which matches depend on that."""

import math
from collections import Counter
from dataclasses import replace
from fractions import Fraction
from itertools import permutations
from random import Random

import numpy as np
import pytest

from extensions.traffic.drives import braking, cut_in, swerve
from extensions.traffic.make_recording import LANES, Track, cruise, make_recording
from extensions.traffic.planar import commonroad_of
from extensions.traffic.reference import Reference
from extensions.traffic.sampled import lower_road
from extensions.traffic.test_evaluate import planted_traffic
from planting import plant as plant_fault
from roadproof.extensions.exchange.commonroad import read_commonroad
from roadproof.extensions.traffic.evaluate import boundary, detectors
from roadproof.extensions.traffic.evaluate.boundary import TraceQuestions, TruthBounds, truth_bounds
from roadproof.extensions.traffic.evaluate.detectors import Detection, find_detections
from roadproof.extensions.traffic.evaluate.evaluate import Findings, evaluate_recording
from roadproof.extensions.traffic.evaluate.matching import PossibleMatch
from roadproof.extensions.traffic.evaluate.questions import (
    EvaluationQuestions,
    EvaluationSettings,
    MonitorKey,
    askable,
    compile_questions,
    default_settings,
)
from roadproof.extensions.traffic.evaluate.recheck import recheck
from roadproof.extensions.traffic.evaluate.recursive import TraceReader
from roadproof.extensions.traffic.evaluate.results import as_json, uncertain_pairs
from roadproof.extensions.traffic.evaluate.sectors import ANYWHERE, is_possible, sectors_of
from roadproof.extensions.traffic.evaluate.totals import add_findings, begin_totals
from roadproof.extensions.traffic.formats.pairs import DetectionRange, common_pairs
from roadproof.extensions.traffic.formats.recording import (
    ZONES,
    Bools,
    Floats,
    Recording,
    Slack,
    keep_vehicles,
)
from roadproof.extensions.traffic.report.research_questions import answer_questions
from roadproof.extensions.traffic.report.traffic import results_tables
from roadproof.extensions.traffic.scenario_parts import COMPARISON
from roadproof.extensions.traffic.simulate.planting import PlantingPlace, plant
from roadproof.extensions.traffic.simulate.simulate import simulate
from roadproof.extensions.traffic.simulate.traffic import TrafficSettings
from roadproof.extensions.traffic.simulate.traffic import TrafficSettings as Simulated
from roadproof.library.loading import build_library, bundled_library
from roadproof.library.specification import Source
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Compare, Formula
from roadproof.semantics.sampled.compiled import compile as compile_formulas

RADIUS, LENGTH = 300.0, 300.0
Answers = dict[MonitorKey, Bools]


def clothoid(s: Floats, d: Floats) -> tuple[Floats, Floats, Floats]:
    """Straight up to 0 m, then ever more bent to the left, down to a radius of 300 m at 300 m, and on so."""
    at = np.arange(-800.0, 1601.0, 0.25)
    bend = np.clip(at, 0, LENGTH) / (RADIUS * LENGTH)
    heading = np.concatenate(([0.0], np.cumsum((bend[1:] + bend[:-1]) / 2 * 0.25)))
    middle = (heading[1:] + heading[:-1]) / 2
    x, y = (np.concatenate(([0.0], np.cumsum(0.25 * part(middle)))) for part in (np.cos, np.sin))
    turned = np.interp(s, at, heading)
    on_x, on_y = np.interp(s, at, x), np.interp(s, at, y)
    return on_x - d * np.sin(turned), on_y + d * np.cos(turned), turned


@pytest.fixture(scope="module")
def traffic() -> Recording:
    """Lower lanes only, with planted drives; the road is moved so that the middle lane is on the line."""
    recording = simulate(TrafficSettings(seconds=24, lane_width=3.5, section=420), seed=4)
    right = min(lane.d[0] for lane in recording.lanes if lane.direction == 2 and lane.d)
    for drive, frame in ((cut_in(), 20), (braking(), 200), (swerve(), 380)):
        recording, _ = plant(recording, drive, PlantingPlace(2, frame, 6, 10.0, right))
    ours = keep_vehicles(recording, recording.direction == 2)
    return replace(ours, first_frame=ours.first_frame - ours.first_frame.min())


def found(recording: Recording) -> Findings:
    return evaluate_recording(recording, compile_questions(default_settings(), recording.rate))


def key(findings: Findings) -> set[tuple[object, ...]]:
    return {
        (m.sv, m.pov, m.pov2, m.start_frame, m.end_frame, m.min_danger, m.set_name, m.scenario)
        for m in findings.matches
    }


@pytest.fixture(scope="module")
def bent(traffic: Recording, tmp_path_factory: pytest.TempPathFactory) -> Recording:
    """The traffic bent along the clothoid, and read back from CommonRoad."""
    road = lower_road(traffic)
    middle = float(sum(road.lanelets[1].d)) / 2
    path = tmp_path_factory.mktemp("bent") / "a.xml"
    path.write_text(
        commonroad_of(traffic, road, lambda s, d: clothoid(s, d - middle), ends=(-500, 1000), step=5.0)
    )
    return read_commonroad(path)


def test_a_bent_drive_gives_the_matches_of_the_original(traffic: Recording, bent: Recording) -> None:
    assert np.diff(bent.s).max() > 0
    shift = bent.s - traffic.s
    assert np.ptp(shift) < 0.25  # chords of 5 m, and boxes that are turned by their motion
    expected, told = found(traffic), found(bent)
    assert {m.scenario for m in expected.matches} >= {1, 3, 4, 8}
    assert key(told) == key(expected)
    assert len(told.traces) == len(expected.traces)


def test_what_is_off_grows_with_the_bend(bent: Recording) -> None:
    """The reference line is the middle lane's: 3.5 m beside it a way is off by 3.5/R."""
    assert bent.slack is not None
    slack = bent.slack
    s = bent.s - bent.length[bent.row_vehicle] / 2 - 500  # of the centre; the line begins at -500 m
    far = s > LENGTH
    assert np.abs(slack.turn[far] - (LENGTH / 2 + s[far] - LENGTH) / RADIUS).max() < 0.02
    assert slack.along.max() < 0.6
    assert np.median(slack.along) < 0.05
    assert slack.off.max() < 7.5
    assert far.sum() > 1000


def test_the_way_between_two_vehicles_is_off_by_no_more_than_said() -> None:
    """On an arc, two vehicles d beside the line and an angle apart: the way between is (R - d) times it."""
    radius = 200.0
    for d in (-7.0, 0.0, 7.0):
        for apart in (0.05, 0.2, 0.4):
            slack = Slack(np.zeros(2), np.zeros(2), np.array([0.1, 0.1 + apart]), np.full(2, abs(d)))
            compare = Compare(t.subtract(t.Signal("s", "POV"), t.Signal("s", "SV")), ">", t.number(0))
            rows = {"SV": np.array([[0]]), "POV": np.array([[1]])}
            said = boundary._place_error(compare, slack, rows)[0, 0]
            assert abs(radius * apart - (radius - d) * apart) <= said + 1e-9


def gap(least: float) -> Formula:
    ahead = t.subtract(t.Signal("s", "POV"), t.Signal("s", "SV"))
    return Compare(ahead, ">", t.number(Fraction(str(least)), (1, 0)))


def pair(along: float) -> Recording:
    recording = make_recording([Track(2, 0, cruise(0, 30, 10)), Track(2, 0, cruise(20, 30, 10))])
    off = np.full(20, along)
    return replace(recording, slack=Slack(off, off, np.zeros(20), np.zeros(20)))


def bounds(recording: Recording, formula: Formula) -> tuple[bool, bool]:
    """Whether it surely holds on the only trace, and whether it may."""
    one = np.array([0])
    assert recording.slack is not None
    asked = TraceQuestions({"it": formula}, {"SV": one, "POV": one + 1}, one, one + 9, {}, {}, "truncated")
    found = truth_bounds(recording, recording.slack, asked)["it"]
    return bool(found.surely[0]), bool(found.perhaps[0])


SURE, UNSURE, NEVER = (True, True), (False, True), (False, False)


@pytest.mark.parametrize(
    ("formula", "sure", "unsure"),
    [
        (gap(19), 0.49, 0.51),
        (f.Not(gap(21)), 0.49, 0.51),
        (f.Always(f.Interval(t.number(0), t.number(Fraction(1, 5), (0, 1))), gap(18)), 0.9, 1.1),
        (f.conjunction(gap(19), f.Not(gap(20.4))), 0.15, 0.25),
        (Compare(t.Signal("v_lon", "SV"), ">", t.number(29, (1, -1))), 9.0, math.inf),
        (Compare(t.Maximum((t.Signal("s", "SV"), t.number(0))), ">=", t.number(0)), 0.0, math.nan),
    ],
)
def test_by_hand(formula: Formula, sure: float, unsure: float) -> None:
    """The gap is 20 m at all times, and each of two vehicles may be off; so a denial never holds, or may."""
    if math.isnan(unsure):
        assert bounds(pair(0.0), formula) == UNSURE  # no sum of places: nothing is known
        return
    assert bounds(pair(sure), formula) == SURE
    assert bounds(pair(sure), f.Not(formula)) == NEVER
    if math.isfinite(unsure):
        assert bounds(pair(unsure), formula) == UNSURE
        assert bounds(pair(unsure), f.Not(formula)) == UNSURE


def moved(recording: Recording, seed: int) -> Recording:
    """Every place moved by what it may be off by, at random: each sample, or each vehicle for a while."""
    random = np.random.default_rng(seed)
    assert recording.slack is not None
    stretch = (1, 25, 10_000)[seed % 3]
    of_sample = recording.row_vehicle * 10_000 + recording.row_frame // stretch
    _, index = np.unique(of_sample, return_inverse=True)
    along, across = (
        random.choice([-1, 1], index.max() + 1)[index] * x
        for x in (recording.slack.along, recording.slack.across)
    )
    return replace(recording, s=recording.s + along, d=recording.d + across)


def measured(recording: Recording, off: float = 0.3) -> Recording:
    """The same places, each of which may be off by so many metres."""
    each = np.full(len(recording.s), off)
    return replace(recording, slack=Slack(each, each, np.zeros_like(each), np.zeros_like(each)))


def questions_to(recording: Recording, questions: EvaluationQuestions) -> TraceQuestions[MonitorKey]:
    """All questions about pairs, to all traces on which danger arises."""
    traces = [x for x in evaluate_recording(recording, questions).traces if x.min_danger == 0]
    place = {int(number): k for k, number in enumerate(recording.vehicle_id)}
    first, second = (np.array([place[getattr(x, name)] for x in traces]) for name in ("first", "second"))
    low, high = (np.array([getattr(x, name) for x in traces]) for name in ("start_frame", "end_frame"))
    at = {"L": first, "L1": second}
    lanes = {x: recording.lane[recording.start[v] + low - recording.first_frame[v]] for x, v in at.items()}
    (monitor,) = questions.pairs
    vehicles = {"SV": first, "POV": second}
    return TraceQuestions(monitor.formulas, vehicles, low, high, lanes, questions.lane_atoms, "truncated")


def answers_on(
    recording: Recording, asked: TraceQuestions[MonitorKey], questions: EvaluationQuestions
) -> Answers:
    (monitor,) = questions.pairs
    rows = (asked.vehicles, asked.low, asked.high, monitor.signals, asked.lanes, questions.lane_atoms)
    return monitor.holds(boundary.gather(recording, *rows))


@pytest.mark.parametrize("off", [0.05, 0.3])
def test_matches_stay_within_their_bounds_when_places_move(traffic: Recording, off: float) -> None:
    """The cut of a trace is kept, as the answer is about it."""
    recording, questions = measured(traffic, off), compile_questions(PAIRS_ONLY, 25)
    asked = questions_to(recording, questions)
    assert recording.slack is not None
    found, now = truth_bounds(recording, recording.slack, asked), answers_on(recording, asked, questions)
    sure = impossible = lost = 0
    for seed in range(12):
        for key, true in answers_on(moved(recording, seed), asked, questions).items():
            assert not (found[key].surely & ~true).any()
            assert not (true & ~found[key].perhaps).any()
            lost += np.count_nonzero(now[key] & ~true)
            sure += np.count_nonzero(found[key].surely)
            impossible += np.count_nonzero(~found[key].perhaps)
    assert min(sure, impossible) > 50
    assert off < 0.3 or lost > 5


TERMS = (
    t.Signal("s", "SV"),
    t.Signal("d", "POV"),
    t.subtract(t.Signal("s", "POV"), t.Signal("s", "SV")),
    t.Sum((t.Product((t.number(2), t.Signal("d", "SV"))), t.Signal("d", "POV"))),
)


def random_formula(dice: Random, depth: int) -> Formula:
    """Places about 0 m compared with numbers, under all connectives; windows of up to 4 samples."""
    if depth == 0 or dice.random() < 0.1:
        limit = t.number(Fraction(dice.randrange(-20, 21), 10), (1, 0))
        return Compare(dice.choice(TERMS), dice.choice(("<", "<=", ">", ">=")), limit)
    low = dice.randrange(3)
    ends = (t.number(Fraction(k, 25), (0, 1)) for k in (low, low + dice.randrange(3)))
    interval = f.Interval(*ends)
    one, other = (random_formula(dice, depth - 1) for _ in range(2))
    match dice.randrange(6):
        case 0:
            return f.Not(one)
        case 1:
            return f.conjunction(one, other)
        case 2:
            return f.disjunction(one, other)
        case 3:
            return f.Always(interval, one)
        case 4:
            return f.Eventually(interval, one)
        case _:
            return f.Until(one, interval, other)


def wandering(dice: Random) -> Recording:
    """Two vehicles whose places wander about 0 m, each sample with an error of its own, or none."""
    random = np.random.default_rng(dice.randrange(1 << 32))
    recording = make_recording([Track(2, 0, cruise(0, 30, 10))] * 2)
    s, d = random.normal(0, 1.2, (2, 20))
    along, across = random.choice([0.0, 0.1, 0.5], (2, 20))
    return replace(recording, s=s, d=d, slack=Slack(along, across, np.zeros(20), np.zeros(20)))


def breaches(seeds: range) -> Counter[str]:
    """How often places that move within their errors make an answer that its bounds exclude, and others."""
    seen: Counter[str] = Counter()
    one = np.array([0])
    vehicles, frames = {"SV": one, "POV": one + 1}, (one, one + 9)
    for seed in seeds:
        dice = Random(seed)
        recording = wandering(dice)
        assert recording.slack is not None
        formulas = {k: random_formula(dice, 3) for k in range(12)}
        asked = TraceQuestions(formulas, vehicles, *frames, {}, {}, "truncated")
        found = truth_bounds(recording, recording.slack, asked)
        monitor = compile_formulas(formulas)
        now = monitor.holds(boundary.gather(recording, vehicles, *frames, ("s", "d")))
        for move in range(12):
            batch = boundary.gather(moved(recording, 12 * seed + move), vehicles, *frames, ("s", "d"))
            for key, true in monitor.holds(batch).items():
                sure, perhaps = bool(found[key].surely[0]), bool(found[key].perhaps[0])
                seen["sure, but false"] += sure and not true[0]
                seen["true, but not possible"] += bool(true[0]) and not perhaps
                seen["changed"] += bool(true[0] != now[key][0])
                seen["sure"] += sure
                seen["impossible"] += not perhaps
    return seen


def test_bounds_of_random_formulas_hold_however_places_move() -> None:
    """1,200 formulas, each with 12 moves."""
    seen = breaches(range(100))
    assert (seen["sure, but false"], seen["true, but not possible"]) == (0, 0)
    assert min(seen["sure"], seen["impossible"], 5 * seen["changed"]) > 1000, seen


@pytest.mark.parametrize(
    ("before", "after", "shown"),
    [
        ("self.visit(body, not helps)", "self.visit(body, helps)", "sure, but false"),
        ("self.visit(body, not helps)", "self.visit(body, helps)", "true, but not possible"),
        ("[0 if helps else 1]", "[0]", "true, but not possible"),
        ("[0 if helps else 1]", "[1]", "sure, but false"),
    ],
)
def test_a_wrong_polarity_is_caught(
    before: str, after: str, shown: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Planted faults: a comparison that hurts is taken as one that helps, or the other way round."""
    plant_fault(monkeypatch, boundary._BoundedFormulas, "_made", before, after)
    assert breaches(range(8))[shown] > 0


PAIRS_ONLY = replace(default_settings(), min_danger=(Fraction(0),), scenarios=(1, 3, 4, 5, 6, 7, 8))


def test_possible_matches_are_those_that_the_bounds_allow(traffic: Recording) -> None:
    """Of all traces and questions: a match, a possible match, or neither; and in blocks as all at once."""
    recording, questions = measured(traffic), compile_questions(PAIRS_ONLY, 25)
    findings = evaluate_recording(recording, questions)
    asked = questions_to(recording, questions)
    assert recording.slack is not None
    found, now = truth_bounds(recording, recording.slack, asked), answers_on(recording, asked, questions)
    expected = set()
    for key, bound in found.items():
        for k in np.flatnonzero(bound.perhaps & ~now[key]).tolist():
            ids = (int(recording.vehicle_id[asked.vehicles[x][k]]) for x in ("SV", "POV"))
            expected.add(PossibleMatch(*ids, 0, key.set_name, key.number))
    assert set(findings.possible) == expected
    assert len(expected) > 5
    assert len(findings.possible) == len(expected)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(boundary, "_CELLS", 500)
        again: dict[MonitorKey, TruthBounds] = truth_bounds(recording, recording.slack, asked)
    for key, bound in found.items():
        assert again[key].surely.tolist() == bound.surely.tolist()
        assert again[key].perhaps.tolist() == bound.perhaps.tolist()


def test_recall_has_bounds(traffic: Recording) -> None:
    """In totals, results.json, tables and text, counted from the rows one by one."""
    recording, questions = measured(traffic), compile_questions(PAIRS_ONLY, 25)
    findings = evaluate_recording(recording, questions)
    totals = begin_totals(PAIRS_ONLY)
    add_findings(totals, findings)
    row = totals.rows[0]
    ours = [x for x in findings.matches if x.set_name == "base"]
    sure = {x.pair for x in ours if not x.uncertain}
    perhaps = {x.pair for x in ours} | {x.pair for x in findings.possible if x.set_name == "base"}
    assert row.bounds == (len(sure), len(perhaps))
    assert len(sure) < row.matching < len(perhaps) <= row.traces
    kept = as_json(totals, {})["table"][0]
    assert kept["recall_interval"] == [len(sure) / row.traces, len(perhaps) / row.traces]
    violating = set(findings.violating)
    low, high = (len(x & violating) / totals.violating for x in (sure, perhaps))
    assert kept["recall_without_init_safe_interval"] == [low, high]
    (table,) = results_tables(totals).values()
    told = f"{100 * len(sure) / row.traces:.1f} to {100 * len(perhaps) / row.traces:.1f}%"
    assert table.rows[0][table.columns.index("within errors")] == told
    text = answer_questions(totals)
    assert f"({row.matching} of {row.traces} traces on the main road; {told} within errors of places)" in text
    assert f"; {100 * low:.1f} to {100 * high:.1f}% within errors of places) match a scenario" in text
    uncertain = {pair for pair, k, name in uncertain_pairs(findings) if (k, name) == (0, "base")}
    assert uncertain == perhaps - sure


def test_recordings_in_road_coordinates_are_sure(traffic: Recording) -> None:
    told = found(traffic)
    assert not any(m.uncertain for m in told.matches)
    assert told.possible == ()
    totals = begin_totals(default_settings())
    add_findings(totals, told)
    assert all(x.bounds == (x.matching, x.matching) for x in totals.rows)
    assert all("within errors" not in x.columns for x in results_tables(totals).values())
    assert not any("depend" in note for note in told.notes)


# --- The comparison detectors: by hand, and batches and pre-filter against the recursive evaluator --

Shown = set[tuple[str, int, int, str]]


@pytest.fixture(scope="module")
def questions() -> EvaluationQuestions:
    return compile_questions(replace(default_settings(), detectors=COMPARISON), 25)


def shown(recording: Recording, questions: EvaluationQuestions) -> Shown:
    found = find_detections(recording, questions, common_pairs(recording, np.ones(recording.vehicles, bool)))
    assert list(found) == sorted(found, key=lambda x: (x.detector, x.sv, x.pov, x.lane))
    return {(x.detector, x.sv, x.pov, x.lane) for x in found}


def brute(recording: Recording, questions: EvaluationQuestions) -> Shown:
    """Every pair, role and lane, one trace at a time."""
    reference, found = Reference(recording, questions.settings), set()
    for sv, pov in permutations(range(recording.vehicles), 2):
        frames = reference.common(sv, pov)
        for k, lane in enumerate(LANES if frames else ()):
            if lane.direction == recording.direction[sv]:
                reading = TraceReader(reference.trace(frames, {"SV": sv, "POV": pov}, {"L": k}))
                ids = int(recording.vehicle_id[sv]), int(recording.vehicle_id[pov])
                for name in COMPARISON:
                    if reading.holds(reference.formula("base", f"{name}(SV, POV, L)", 0), 0, "strong"):
                        found.add((name, *ids, lane.name))
    return found


def change(s: float, v: float, frames: int, a: float = 0.0) -> list[tuple[float, ...]]:
    """From the left lane (6) into the middle one (7) at 1 m/s, d from -24.5 to -28."""
    rows = []
    for k in range(frames):
        t = k / 25
        moving = t < 3.5
        rows.append((s + v * t, -24.5 - min(t, 3.5), v, -1.0 if moving else 0.0, a, 0.0))
    return rows


def brake(s: float, v: float, a: float, frames: int) -> list[tuple[float, ...]]:
    return [
        (s + v * t + a * t * t / 2, -28.0, v + a * t, 0.0, a, 0.0) for t in (k / 25 for k in range(frames))
    ]


BY_HAND = {
    # 60 m ahead at the same speed: 1.85 s of headway at 30 m/s, no closing speed.
    "cut-in near by THW": (cruise(0, 30, 120), change(60, 30, 120), {"cutIn_thw", "cutIn_free"}),
    # 80 m ahead: 2.5 s of headway, but still within 100 m.
    "cut-in not near": (cruise(0, 30, 120), change(80, 30, 120), {"cutIn_free"}),
    # 130 m ahead and 30 m/s slower: 4 s reach 120 m when the vehicle enters the lane.
    "cut-in near by TTC": (cruise(0, 35, 120), change(150, 5, 120), {"cutIn_ttc", "cutIn_free"}),
    "braking hard": (cruise(0, 30, 75), brake(50, 30, -4, 75), {"decel_thw", "decel_ttc", "decel_free"}),
    "braking softly": (cruise(0, 30, 75), brake(50, 30, -1, 75), {"decel_free"}),
    "following": (cruise(0, 30, 75), cruise(30, 30, 75), set()),
}


@pytest.mark.parametrize("name", BY_HAND)
def test_detectors_by_hand(name: str, questions: EvaluationQuestions) -> None:
    sv, pov, expected = BY_HAND[name]
    recording = make_recording([Track(2, 1, sv), Track(2, 1, pov)])
    found = shown(recording, questions)
    assert found == brute(recording, questions)
    assert {x[0] for x in found if x[1:] == (1, 2, "7")} == expected
    assert all(x[1:] == (1, 2, "7") for x in found)


@pytest.fixture(scope="module")
def busy() -> tuple[Recording, Shown]:
    recording = simulate(Simulated(seconds=7, flow=1200, lane_width=3.5), seed=3)
    recording, _ = plant(recording, cut_in(), PlantingPlace(2, 5, Fraction(6), 10.0, -34.0))
    recording, _ = plant(recording, braking(), PlantingPlace(1, 5, Fraction(6), -410.0, 8.5))
    recording = replace(recording, kind=np.full(recording.vehicles, "Car"))
    return recording, brute(
        recording, compile_questions(replace(default_settings(), detectors=COMPARISON), 25)
    )


def test_simulated_traffic_against_brute_force(
    busy: tuple[Recording, Shown], questions: EvaluationQuestions
) -> None:
    recording, expected = busy
    assert shown(recording, questions) == expected
    assert len({x[0] for x in expected}) >= 2
    # Without the pre-filter the answer is the same; with one that sees too little it is not.
    assert questions.sight is not None
    assert shown(recording, replace(questions, sight=None)) == expected
    assert shown(recording, replace(questions, sight=DetectionRange(0.0, 0.0, 5.0))) != expected


def test_one_lane_only_is_caught(
    busy: tuple[Recording, Shown], questions: EvaluationQuestions, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Planted fault: only the rightmost of the lanes that may be asked for is."""
    recording, expected = busy
    whole = detectors.pairs_in_sight

    def first_lane(*arguments: object) -> object:
        pairs, lanes = whole(*arguments)  # type: ignore[arg-type]
        return pairs, lanes & np.uint32(0b001001)

    monkeypatch.setattr(detectors, "pairs_in_sight", first_lane)
    assert shown(recording, questions) < expected


def test_own_detector_is_asked_of_all_pairs() -> None:
    text = "def faraway(SV, POV: vehicle, L: lane) := atLane(SV, L) and s(POV) - s(SV) > 350 m"
    library = build_library([Source("mine.spec", text)], bundled_library())
    mine = compile_questions(replace(default_settings(library), detectors=("faraway",)), 25)
    assert mine.sight is None
    recording = make_recording([Track(2, 1, cruise(0, 30, 9)), Track(2, 1, cruise(360, 30, 9, d=-24.5))])
    assert shown(recording, mine) == {("faraway", 1, 2, "7")}


def test_counts_are_of_unordered_pairs(questions: EvaluationQuestions) -> None:
    recording = make_recording([Track(2, 1, x) for x in BY_HAND["braking hard"][:2]])
    findings = evaluate_recording(recording, questions)
    assert {x.detector for x in findings.detections} == {"decel_thw", "decel_ttc", "decel_free"}
    totals = begin_totals(questions.settings)
    twice = (*findings.detections, Detection("decel_thw", 2, 1, "7"), Detection("decel_thw", 1, 2, "6"))
    add_findings(totals, replace(findings, detections=twice))
    assert as_json(totals, {})["detectors"] == {
        name: int(name.startswith("decel")) for name in questions.settings.detectors
    }


def test_no_detectors_unless_asked_for() -> None:
    recording = make_recording([Track(2, 1, x) for x in BY_HAND["braking hard"][:2]])
    assert evaluate_recording(recording, compile_questions(default_settings(), 25)).detections == ()


# --- Road sectors: which scenarios are asked of which recording, and what is counted where ----------

BASE = bundled_library().select("base")
SETTINGS = replace(default_settings(), scenarios=askable(BASE), sets=("base", "ext"))
MAIN, MERGE, DEPART = (np.uint32(1 << k) for k in range(len(ZONES)))
Found = Counter[tuple[object, ...]]


@pytest.fixture(scope="module")
def recording() -> Recording:
    """Cut-ins, braking, cut-outs and swerves on a main road of one direction."""
    return planted_traffic(2)[0]


def everywhere(recording: Recording, zone: np.uint32) -> Recording:
    return replace(recording, zones=np.full(len(recording.zones), zone, np.uint32))


def findings_of(recording: Recording, settings: EvaluationSettings = SETTINGS) -> Findings:
    questions = compile_questions(settings, recording.rate, recording.zone_names)
    findings = evaluate_recording(recording, questions)
    assert [*recheck(recording, questions, findings)] == []
    return findings


def matches(findings: Findings, less: int = 0) -> Found:
    """All matches, the scenarios' numbers less so many."""
    return Counter(
        (m.sv, m.pov, m.pov2, m.start_frame, m.end_frame, m.min_danger, m.set_name, m.scenario - less)
        for m in findings.matches
    )


def test_the_three_sectors() -> None:
    found = {x.name: (x.scenarios, x.of_three) for x in sectors_of(BASE, SETTINGS.scenarios)}
    assert found == {
        "main road": ((1, 2, 3, 4, 5, 6, 7, 8), (2,)),
        "merge zone": ((9, 10, 11, 12, 13, 14, 15, 16), (10,)),
        "departure zone": ((17, 18, 19, 20, 21, 22, 23, 24), (18,)),
    }


@pytest.mark.parametrize(
    ("zones", "names"),
    [
        (("main",), ["main road"]),
        (("merge",), ["merge zone"]),
        (("main", "depart"), ["main road", "departure zone"]),
        (ZONES, ["main road", "merge zone", "departure zone"]),
        ((), []),
    ],
)
def test_what_a_road_allows(zones: tuple[str, ...], names: list[str]) -> None:
    assert [x.name for x in sectors_of(BASE, SETTINGS.scenarios) if is_possible(x, zones)] == names


def test_what_is_not_understood_is_asked() -> None:
    text = """
    def roadSector_25(SV, POV: vehicle) "beside a merge zone"
      := not inMergeZone(SV) and G not inDepartZone(POV)
    def disturb_25(SV, POV: vehicle, L: lane) := atLane(SV, L)
    def scenario_25(SV, POV: vehicle, L: lane) := roadSector_25(SV, POV) and disturb_25(SV, POV, L)
    def scenario_26(SV, POV: vehicle, L: lane) := atLane(SV, L) and F danger(SV, POV)
    """
    bundled = bundled_library()
    library = build_library([*bundled.sources.values(), Source("mine.spec", text)])
    chosen = library.select("base")
    beside, free = sectors_of(chosen, (25, 26))
    assert (beside.name, free.name, free.where) == ("beside a merge zone", ANYWHERE, None)
    assert all(is_possible(x, zones) for x in (beside, free) for zones in (("main",), ("merge",), ()))
    assert askable(chosen)[-2:] == (25, 26)


def test_the_same_traffic_in_a_zone_shows_the_scenarios_of_that_zone(recording: Recording) -> None:
    """Behaviour does not ask where it happens, so matches are the same with numbers 8 and 16 higher."""
    on_main = findings_of(everywhere(recording, MAIN))
    assert on_main.sectors == ("main road",)
    assert {number for *_, number in matches(on_main)} >= {1, 2, 4, 8}
    for zone, more, name in ((MERGE, 8, "merge zone"), (DEPART, 16, "departure zone")):
        found = findings_of(everywhere(recording, zone))
        assert found.sectors == (name,)
        assert matches(found, more) == matches(on_main)
        assert {x.sectors for x in found.traces} == {(name,)}
    both = findings_of(everywhere(recording, MERGE | DEPART))
    assert {x.sectors for x in both.traces} == {("merge zone", "departure zone")}
    assert len(both.matches) == 2 * len(on_main.matches)


def test_traces_are_counted_where_they_begin(recording: Recording) -> None:
    """The right half of the road is a merge zone: each trace is in one table, and none is in two."""
    middle = float(np.median(recording.s))
    zones = np.where(recording.s > middle, MERGE, MAIN).astype(np.uint32)
    found = findings_of(replace(recording, zones=zones))
    totals = begin_totals(SETTINGS)
    add_findings(totals, found)
    assert [*totals.shown] == ["main road", "merge zone"]
    main, merge = (rows[0] for rows in totals.shown.values())
    assert main.traces > 0
    assert merge.traces > 0
    assert main.traces + merge.traces == sum(x.min_danger == 0 for x in found.traces)
    for row in (main, merge):
        assert 0 < row.matching <= row.traces
    tables = results_tables(totals)
    assert [*tables] == ["results", "results-merge-zone"]
    assert tables["results-merge-zone"].columns[-1] == "s16"
    assert not any("paper*" in row for row in tables["results-merge-zone"].rows)
    assert any("s17 to s24 were not asked" in note for note in tables["results"].notes)


def test_a_recording_without_the_zone_has_no_table_of_it(recording: Recording) -> None:
    totals = begin_totals(replace(SETTINGS, min_danger=(Fraction(0),)))
    add_findings(
        totals, findings_of(everywhere(recording, MAIN), replace(SETTINGS, min_danger=(Fraction(0),)))
    )
    (table,) = results_tables(totals).values()
    assert table.title == "Disturbance traces that match a scenario"
    assert any("No recording has a merge zone or a departure zone, so s9 to s24" in x for x in table.notes)
