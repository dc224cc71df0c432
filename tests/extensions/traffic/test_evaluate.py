"""The evaluation against the slow reference, on planted drives, and its invariants."""

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from extensions.traffic.drives import braking, cut_in, cut_out, late_cut_out, swerve
from extensions.traffic.make_recording import LANES, Track, cruise, make_recording
from extensions.traffic.reference import Reference, Row
from roadproof.errors import InputError, UsageError
from roadproof.extensions.traffic import scenario_parts
from roadproof.extensions.traffic.evaluate import disturbances, evaluate
from roadproof.extensions.traffic.evaluate import questions as module
from roadproof.extensions.traffic.evaluate.disturbances import NEVER, Disturbances, _last, _Lookup, _next
from roadproof.extensions.traffic.evaluate.evaluate import Findings, evaluate_recording
from roadproof.extensions.traffic.evaluate.one_trace import cut_trace, read_samples
from roadproof.extensions.traffic.evaluate.questions import (
    SAFE,
    VIOLATION,
    DangerKey,
    EvaluationQuestions,
    MonitorKey,
    compile_questions,
    default_settings,
)
from roadproof.extensions.traffic.evaluate.recheck import recheck
from roadproof.extensions.traffic.formats import pairs as recorded_pairs
from roadproof.extensions.traffic.formats.neighbours import NONE, find_neighbours
from roadproof.extensions.traffic.formats.pairs import Pairs
from roadproof.extensions.traffic.formats.recording import Bools, Recording, keep_vehicles
from roadproof.extensions.traffic.formats.samples import HEADER
from roadproof.extensions.traffic.scenario_parts import lane_owner
from roadproof.extensions.traffic.simulate.planting import PlantingPlace, plant
from roadproof.extensions.traffic.simulate.simulate import simulate
from roadproof.extensions.traffic.simulate.traffic import TrafficSettings
from roadproof.library import elaborate as elaborating
from roadproof.library.bind import occupies
from roadproof.library.elaboration import Elaborator
from roadproof.library.loading import build_library, bundled_library
from roadproof.library.scenarios import Scenario
from roadproof.library.specification import Query, Source, Specification
from roadproof.logic import show
from roadproof.logic.formula import Compare
from roadproof.logic.rewrite import with_values
from roadproof.logic.syntax import Claim
from roadproof.logic.terms import Parameter, number
from roadproof.semantics.sampled import compile
from roadproof.semantics.sampled.answers import TruthArrays, Verdicts
from roadproof.world.models import load_road


@pytest.fixture(scope="module")
def questions() -> EvaluationQuestions:
    return compile_questions(default_settings(), 25)


def rows_of(findings: Findings) -> list[Row]:
    return [
        (m.sv, m.pov, m.pov2, m.lane, m.start_frame, m.end_frame, m.min_danger, m.set_name, m.scenario)
        for m in findings.matches
    ]


def planted_traffic(direction: int) -> tuple[Recording, dict[str, dict[str, int]]]:
    """A short recording of few cars with three drives in it, and who is who in each."""
    recording = simulate(TrafficSettings(seconds=40, flow=500, lane_width=3.5), seed=4)
    drives = {
        "cut-in": cut_in(),
        "braking": braking(),
        "cut-out": cut_out(),
        "late cut-out": late_cut_out(),
        "swerve": swerve(),
    }
    who = {}
    for k, (name, drive) in enumerate(drives.items()):
        right = min(x.d[0] for x in recording.lanes if x.direction == direction and x.d)
        start = -410.0 if direction == 1 else 10.0
        recording, truth = plant(
            recording,
            drive,
            PlantingPlace(direction, 20 + 190 * k, Fraction(7 if name == "swerve" else 6), start, right),
        )
        who[name] = dict(truth.vehicles)
    return recording, who


@dataclass(frozen=True)
class Case:
    """Traffic of one direction with planted drives, and what the slow reference finds in it."""

    recording: Recording
    who: dict[str, dict[str, int]]
    matches: Counter[Row]
    traces: list[tuple[int, int, int, int, int]]
    violating: int


@pytest.fixture(scope="module", params=[1, 2])
def case(request: pytest.FixtureRequest, questions: EvaluationQuestions) -> Case:
    recording, who = planted_traffic(request.param)
    recording = keep_vehicles(recording, recording.direction == request.param)
    reference = Reference(recording, questions.settings)
    violating = len(reference.violating)
    return Case(recording, who, Counter(reference.matches()), sorted(reference.traces()), violating)


def agrees(case: Case, questions: EvaluationQuestions) -> bool:
    findings = evaluate_recording(case.recording, questions)
    traces = sorted((t.first, t.second, t.min_danger, t.start_frame, t.end_frame) for t in findings.traces)
    return (Counter(rows_of(findings)), traces, len(findings.violating)) == (
        case.matches,
        case.traces,
        case.violating,
    )


def test_against_the_reference(case: Case, questions: EvaluationQuestions) -> None:
    assert agrees(case, questions)
    assert len({row[8] for row in case.matches}) >= 5
    # Planted drives are found at the right pair, scenario and start, in all sets.
    cut, brake, out, late, swerve = case.who.values()
    expected = {
        (cut["SV"], cut["POV"], None, 20, 1),
        (brake["SV"], brake["POV"], None, 210, 4),
        (out["SV"], out["POV1"], out["POV2"], 400, 2),
        (swerve["SV"], swerve["POV"], None, 780, 8),
    }
    for set_name in ("base", "extA", "ext"):
        for k in (0, 1):
            rows = {(*r[:3], r[4], r[8]) for r in case.matches if (r[7], r[6]) == (set_name, k)}
            assert expected <= rows
            late_starts = {r[3] for r in rows if r[:3] == (late["SV"], late["POV1"], late["POV2"])}
            assert len(late_starts) == 1
            assert 590 + 30 < min(late_starts) < 590 + 50


def _cut_early(questions: EvaluationQuestions, monkeypatch: pytest.MonkeyPatch) -> EvaluationQuestions:
    return replace(questions, danger_steps=(0, 0))


def _start_outside(questions: EvaluationQuestions, monkeypatch: pytest.MonkeyPatch) -> EvaluationQuestions:
    """Triples start in their first common frame, safe or not."""
    monkeypatch.setattr(disturbances._Lookup, "next_safe", lambda self, index, frame, latest: frame)
    return questions


def _lane_at_the_end(questions: EvaluationQuestions, monkeypatch: pytest.MonkeyPatch) -> EvaluationQuestions:
    lane_at = evaluate._lane_at
    monkeypatch.setattr(evaluate, "_lane_at", lambda r, v, frame: lane_at(r, v, r.last_frame[v]))
    return questions


def _own_lane_for_scenario_7(
    questions: EvaluationQuestions, monkeypatch: pytest.MonkeyPatch
) -> EvaluationQuestions:
    monkeypatch.setattr(module.scenario_parts, "lane_owner", lambda specification, scenario: "SV")
    return compile_questions(questions.settings, 25)


def _one_role(questions: EvaluationQuestions, monkeypatch: pytest.MonkeyPatch) -> EvaluationQuestions:
    kept = [replace(m, plain={k: v for k, v in m.plain.items() if k.sv == "first"}) for m in questions.pairs]
    return replace(questions, pairs=tuple(kept))


def _short_reach(questions: EvaluationQuestions, monkeypatch: pytest.MonkeyPatch) -> EvaluationQuestions:
    assert questions.reach is not None
    return replace(questions, reach=replace(questions.reach, rho=0.0, a_max_lat=0.0))


def _swapped_names(questions: EvaluationQuestions, monkeypatch: pytest.MonkeyPatch) -> EvaluationQuestions:
    monkeypatch.setattr(recorded_pairs, "TRIPLE", ("SV", "POV2", "POV1"))
    return questions


@pytest.mark.parametrize(
    "fault",
    [
        _cut_early,
        _start_outside,
        _lane_at_the_end,
        _own_lane_for_scenario_7,
        _one_role,
        _short_reach,
        _swapped_names,
    ],
)
def test_planted_faults_are_caught(
    fault: Callable[[EvaluationQuestions, pytest.MonkeyPatch], EvaluationQuestions],
    case: Case,
    questions: EvaluationQuestions,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    assert not agrees(case, fault(questions, monkeypatch))


def test_sets_grow_and_matches_are_disturbances(questions: EvaluationQuestions) -> None:
    recording = simulate(TrafficSettings(seconds=60, lane_width=3.5), seed=8)
    findings = evaluate_recording(recording, questions)
    assert len(findings.matches) > 50
    traces = {(t.first, t.second, t.min_danger): t for t in findings.traces}
    by_set = {name: set() for name in ("base", "extA", "ext")}
    for m in findings.matches:
        by_set[m.set_name].add((m.sv, m.pov, m.pov2, m.min_danger, m.scenario))
        trace = traces[*m.pair, m.min_danger]
        if m.pov2 is None:
            assert (m.start_frame, m.end_frame) == (trace.start_frame, trace.end_frame)
    assert by_set["base"] < by_set["extA"] < by_set["ext"]
    # s3 = s4 in base, up to pairs that begin in different lanes (semantics §6).
    straddling = {key[:2] for key, t in traces.items() if t.first_lane != t.second_lane}
    for k in (0, 1):
        three, four = (
            {(min(x[:2]), max(x[:2])) for x in by_set["base"] if x[3] == k and x[4] == number}
            for number in (3, 4)
        )
        assert three ^ four <= straddling
        assert three & four


def test_start_and_end_by_hand(questions: EvaluationQuestions) -> None:
    """SV closes in at 10 m/s from 200 m; the RSS distance of 30 and 20 m/s is 84.65 m beside the length."""
    distance = 84.65
    tracks = [Track(2, 5, cruise(0.0, 30.0, 400)), Track(2, 1, cruise(200.0, 20.0, 340))]
    r = make_recording(tracks)
    findings = evaluate_recording(r, questions)
    # From frame 5 to 340 the gap of the fronts is 200 + 4·0.8 - 0.4·k at frame 5 + k.
    first = next(k for k in range(400) if 203.2 - 0.4 * k <= 4.5 + distance)
    assert 5 + first < 320
    assert len(findings.violating) == 1
    starts = [(t.min_danger, t.start_frame, t.end_frame) for t in findings.traces]
    assert starts == [(0, 5, 340), (1, 5, 340)]
    assert {(m.sv, m.pov, m.scenario) for m in findings.matches if m.set_name == "base"} == {
        (1, 2, 4),
        (2, 1, 3),
    }
    # Cut off just before the violation there is no disturbance; with it, minDanger 0 alone.
    for frames, ends in ((first, []), (first + 1, [0]), (first + 15, [0]), (first + 16, [0, 1])):
        short = make_recording([Track(2, 5, cruise(0.0, 30.0, frames)), tracks[1]])
        found = evaluate_recording(short, questions)
        assert [t.min_danger for t in found.traces] == ends


def test_start_needs_its_whole_window(questions: EvaluationQuestions) -> None:
    """Safe for 15 samples only (0.56 s): no start there; for 16 samples (0.6 s): a start."""
    for safe_samples, found in ((15, 0), (16, 1)):
        rest = (-28.0, 30.0, 0.0, 0.0, 0.0)
        rows = [(1000.0, *rest) for _ in range(safe_samples + 20)]
        ahead = [(1150.0 if k < safe_samples else 1010.0, *rest) for k in range(safe_samples + 20)]
        findings = evaluate_recording(make_recording([Track(2, 1, rows), Track(2, 1, ahead)]), questions)
        assert sum(t.min_danger == 0 for t in findings.traces) == found


def test_trucks_only_on_request(questions: EvaluationQuestions) -> None:
    tracks = [Track(2, 1, cruise(0.0, 30.0, 300)), Track(2, 1, cruise(200.0, 20.0, 300), kind="Truck")]
    r = make_recording(tracks)
    assert len(evaluate_recording(r, questions).violating) == 0
    wide = compile_questions(replace(questions.settings, classes=("Car", "Truck")), 25)
    assert len(evaluate_recording(r, wide).violating) == 1
    assert evaluate_recording(r, wide).notes == evaluate_recording(r, questions).notes == ()


def test_classes_that_no_vehicle_has_are_told(questions: EvaluationQuestions) -> None:
    """They are found nowhere, and a table of zeros looks like an answer."""
    r = make_recording([Track(2, 1, cruise(0.0, 30.0, 50)), Track(2, 1, cruise(9.0, 30.0, 50), kind="Truck")])
    wrong = compile_questions(replace(questions.settings, classes=("car", "Bike")), 25)
    assert evaluate_recording(r, wrong).notes == (
        "no vehicle of class car, Bike: its classes are Car, Truck",
    )


def test_prefilter_is_dropped_for_other_dangers(questions: EvaluationQuestions) -> None:
    """With a danger of the user's own the pairs are all looked at: this one reaches 300 m."""
    text = "def rssViolation_lon(a, b: vehicle) := s(b) - s(a) <= 300 m and s(a) - s(b) <= 300 m"
    library = build_library([Source("mine.spec", text)], bundled_library())
    settings = replace(questions.settings, library=library)
    mine = compile_questions(settings, 25)
    assert questions.reach is not None
    assert mine.reach is None
    tracks = [Track(2, 1, cruise(0.0, 30.0, 500)), Track(2, 1, cruise(400.0, 20.0, 500))]
    r = make_recording(tracks)
    assert len(evaluate_recording(r, questions).violating) == 0
    assert len(evaluate_recording(r, mine).violating) == 1


def test_empty_and_lonely(questions: EvaluationQuestions) -> None:
    r = make_recording([Track(2, 1, cruise(0.0, 30.0, 50))])
    findings = evaluate_recording(r, questions)
    assert (findings.violating, findings.traces, findings.matches) == ((), (), ())
    none = keep_vehicles(r, np.zeros(1, bool))
    assert evaluate_recording(none, questions).vehicles == 0


def test_off_the_road(questions: EvaluationQuestions) -> None:
    """A vehicle on no lane is in no lane: danger may arise, but nothing matches, and no lane is named."""
    behind, ahead = cruise(0.0, 30.0, 400, d=-32.5), cruise(200.0, 20.0, 400, d=-34.5)
    findings = evaluate_recording(make_recording([Track(2, 1, behind), Track(2, 1, ahead)]), questions)
    assert {(t.first_lane, t.second_lane) for t in findings.traces} == {("8", "")}
    assert findings.matches == ()


def test_wrong_settings() -> None:
    settings = default_settings()
    with pytest.raises(UsageError, match="scenarios"):
        replace(settings, scenarios=(25,))
    with pytest.raises(UsageError, match="sets"):
        replace(settings, sets=())
    with pytest.raises(UsageError, match="minDanger"):
        replace(settings, min_danger=(Fraction(-1),))
    with pytest.raises(InputError, match=r"0\.6 s is no multiple of the time step"):
        compile_questions(settings, 7)
    with pytest.raises(InputError, match="no spec set"):
        compile_questions(replace(settings, sets=("bass",)), 25)


def test_each_claim_is_elaborated_once_and_no_text_is_read(monkeypatch: pytest.MonkeyPatch) -> None:
    """Claims of the settings' specifications, and of the bundled one that they are compared with.

    Here both are one specification; some claims of it are elaborated for each.
    """
    settings = default_settings()
    asked: Counter[tuple[int, str]] = Counter()
    kept: list[Specification] = []
    honest = elaborating.elaborate

    def counted(specification: Specification, claim: Claim, walk: Elaborator | None = None) -> Query:
        kept.append(specification)
        asked[id(specification), show.text(claim)] += 1
        return honest(specification, claim, walk)

    for user in (elaborating, scenario_parts):
        monkeypatch.setattr(user, "elaborate", counted)
    monkeypatch.delattr(elaborating, "parse_claim")
    compile_questions(replace(settings, detectors=scenario_parts.COMPARISON), 25)
    assert {*asked.values()} <= {1, 2}
    assert asked.total() == 65


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("def scenario_25(SV, A, B, C: vehicle, L: lane) := atLane(C, L)", "about 4 vehicles"),
        ("def scenario_25(SV: vehicle, L: lane) := atLane(SV, L)", "about 1 vehicles"),
        (
            'def scenario_25(SV, POV1, POV2: vehicle, L: lane) := true\nlane of POV2 for 25 "odd"',
            "L is the lane of POV2",
        ),
    ],
)
def test_scenarios_that_recordings_are_not_asked_for(text: str, said: str) -> None:
    library = build_library([Source("mine.spec", text)], bundled_library())
    with pytest.raises(InputError, match=said):
        compile_questions(replace(default_settings(library), scenarios=(25,)), 25)


def test_a_scenario_of_ones_own_says_its_vehicles_and_its_lane() -> None:
    text = "def scenario_25(SV, A: vehicle, L: lane) := atLane(A, L)\nlane of A for 25"
    library = build_library([Source("mine.spec", text)], bundled_library())
    mine = compile_questions(replace(default_settings(library), sets=("ext",), scenarios=(2, 25)), 25)
    assert set(mine.pairs[0].formulas) == {
        MonitorKey("ext", 25, "first", "L1"),
        MonitorKey("ext", 25, "second", "L"),
    }
    assert set(mine.triples[0].formulas) == {MonitorKey("ext", 2, "first", "L")}


def test_what_is_asked_is_a_value_and_mistakes_show_it_as_text(questions: EvaluationQuestions) -> None:
    assert set(questions.danger.formulas) == {VIOLATION, SAFE, DangerKey(0), DangerKey(1)}
    asked = {
        MonitorKey("ext", 7, "first", "L1"),
        MonitorKey("ext", 7, "second", "L"),
        MonitorKey("base", 3, "first", "L"),
    }
    assert asked <= set(questions.pairs[0].formulas)
    assert str(MonitorKey("ext", 7, "first", "L1")) == "ext/7/first"
    with pytest.raises(InputError, match=r"^danger 1: a monitor needs numbers, but x has no value"):
        compile({DangerKey(1): Compare(Parameter("x"), "<", number(1))})


def test_of_recordings_is_read_what_the_formulas_speak_of(questions: EvaluationQuestions) -> None:
    assert questions.danger.signals == ("s", "d", "v_lon", "v_lat")
    assert questions.pairs[0].signals == ("s", "d", "v_lon", "v_lat", "a_lon")
    sways = "def decelerates(a: vehicle) := a_lon(a) < 0 or a_lat(a) > 0.1 m/s^2"
    source = Source("mine.spec", f"set mine extends ext {{ {sways} }}")
    library = build_library([source], bundled_library())
    mine = compile_questions(replace(default_settings(library), sets=("mine",)), 25)
    assert mine.pairs[0].signals[-1] == "a_lat"
    recording, _ = planted_traffic(1)
    assert evaluate_recording(recording, mine).traces == evaluate_recording(recording, questions).traces != ()


def test_only_traces_in_which_danger_arises_are_counted(questions: EvaluationQuestions) -> None:
    @dataclass
    class Answers:
        """A monitor that says of four traces: true, false, undecided, undecided; read otherwise, false."""

        def evaluate(self, seen: object, convention: str) -> Verdicts:
            other = convention != questions.settings.convention
            true, false = ([not other, False, False, False], [other, True, other, other])
            return Verdicts(convention, {"it": TruthArrays(np.array(true), np.array(false))}, {})

        def holds(self, seen: object, convention: str) -> dict[str, Bools]:
            return {"it": self.evaluate(seen, convention).answers["it"].true}

    tally = evaluate._Tally(questions)
    for arises, counts in (([1, 1, 1, 1], (4, 2, 1)), ([0, 1, 1, 0], (6, 3, 1)), ([1, 0, 0, 0], (7, 3, 2))):
        seen = np.array(arises, bool)
        assert tally.ask(Answers(), None, seen)["it"].tolist() == [bool(arises[0]), False, False, False]
        assert (tally.asked, tally.undecided, tally.differing) == counts


# --- Answers of an evaluation asked once more: what is right is not denied, and what is wrong is named


@pytest.fixture(scope="module")
def recording() -> Recording:
    """A drive with two vehicles and one with three, and nobody else."""
    whole, who = planted_traffic(1)
    kept = [number for name in ("cut-in", "cut-out") for number in who[name].values()]
    return keep_vehicles(whole, np.isin(whole.vehicle_id, kept))


@pytest.fixture(scope="module")
def findings(recording: Recording, questions: EvaluationQuestions) -> Findings:
    found = evaluate_recording(recording, questions)
    assert {x.pov2 is None for x in found.matches} == {True, False}
    return found


def test_what_is_right_is_not_denied(
    recording: Recording, questions: EvaluationQuestions, findings: Findings
) -> None:
    assert list(recheck(recording, questions, findings)) == []


def test_a_match_that_was_missed_is_named(
    recording: Recording, questions: EvaluationQuestions, findings: Findings
) -> None:
    for match in [x for x in findings.matches if x.pov2 is None][:3]:
        less = replace(findings, matches=tuple(x for x in findings.matches if x != match))
        (line,) = recheck(recording, questions, less)
        assert f"vehicles {match.sv}, {match.pov}, frames" in line
        assert f"scenario {match.scenario}: missed" in line


def test_a_match_too_many_is_named(
    recording: Recording, questions: EvaluationQuestions, findings: Findings
) -> None:
    """Two vehicles in another scenario about the same lane, and three in another lane."""
    others = []
    for match in findings.matches:
        if match.pov2 is None:
            asked = [x.number for x in questions.pairs[match.min_danger].formulas]
            alike = [n for n in asked if _owner(n) == _owner(match.scenario)]
            others += [replace(match, scenario=n) for n in alike]
        else:
            others += [replace(match, lane=x.name) for x in recording.lanes]
    for many in (False, True):
        wrong = next(x for x in others if x not in findings.matches and (x.pov2 is not None) == many)
        (line,) = recheck(recording, questions, replace(findings, matches=(*findings.matches, wrong)))
        assert f"scenario {wrong.scenario}: found, but the recursive evaluator denies it" in line


def _owner(number: int) -> str:
    return lane_owner(bundled_library().select(), Scenario(number, "base"))


# --- Where danger begins and safety comes back, looked up pair by pair and frame by frame -----------


def column(*values: int) -> np.ndarray:
    return np.array(values)[:, None]


def test_the_next_and_the_last_true_sample_of_each_frame() -> None:
    """Frame 0 is a frame like others, and where there is none it is not told."""
    frames = column(0, 1, 2, 3)
    truth = column(0, 1, 0, 0).astype(bool)
    assert _next(truth, frames).ravel().tolist() == [1, 1, NEVER, NEVER]
    assert _last(truth, frames).ravel().tolist() == [-1, 1, 1, 1]
    assert _last(column(1, 0, 0, 0).astype(bool), frames).ravel().tolist() == [0, 0, 0, 0]


def found() -> Disturbances:
    """Vehicles 0 and 1 in frames 5 to 7, in danger from 6 on; 0 and 2 in frames 2 and 3, always in danger."""
    pairs = Pairs(*(np.array(x) for x in ([0, 0], [1, 2], [5, 2], [7, 3])))
    safe = np.array([5, NEVER, NEVER, NEVER, NEVER])
    last = np.array([-1, 6, 7, 2, 3])
    start, end = np.array([5, NEVER]), (np.array([7, -1]),)
    return Disturbances(pairs, pairs, start, end, np.array([0, 3, 5]), safe, (last,))


def test_a_frame_of_a_pair_is_looked_up() -> None:
    ones, others = np.array([1, 0, 1, 2, 2, 1]), np.array([0, 1, 0, 0, 1, 2])
    look = _Lookup(found(), ones, others)
    frames = np.array([7, 5, 4, 3, 3, 6])
    # 0 and 1 before their first frame; 1 and 2 are no such pair
    assert look.last_danger(0, frames).tolist() == [7, -1, -1, 3, -1, -1]


def test_a_pair_that_never_violates_is_always_safe() -> None:
    look = _Lookup(found(), np.array([0, 0, 1]), np.array([1, 1, 2]))
    index, latest = np.arange(3), np.array([7, 7, 7])
    assert look.next_safe(index, np.array([5, 6, 6]), latest).tolist() == [5, NEVER, 6]
    assert look.next_safe(index, np.array([5, 5, 8]), np.array([4, 7, 7])).tolist() == [NEVER, 5, NEVER]


# --- One trace from a file of samples or cut out of a recording: signals, sizes, and who is in which lane

ROAD = load_road("main-2")
# A in the right lane, B ahead of it in the left one and faster.
A, B = "0,5.3,20,0,0,0,4.5,1.8", "40,6.1,30,0,0,0,5,2"


def written(path: Path, *rows: str) -> Path:
    path.write_text("\n".join((",".join(HEADER), *rows)) + "\n", "utf-8")
    return path


def test_two_times_are_enough(tmp_path: Path) -> None:
    path = written(tmp_path / "two.csv", f"1.5,A,{A}", f"1.5,B,{B}", f"1.9,A,{A}", f"1.9,B,{B}")
    trace = read_samples(path, ROAD)
    assert (trace.batch.dt, trace.batch.samples, trace.first) == (Fraction(2, 5), 2, "1.5 s")
    assert trace.batch.signals["v_lon", "B"].ravel().tolist() == [30, 30]
    assert trace.batch.sizes["length", "A"].tolist() == [4.5]
    assert (trace.source, trace.road) == (str(path), ROAD)
    with pytest.raises(InputError, match="fewer than two times; at least two samples are needed"):
        read_samples(written(path, f"1.5,A,{A}", f"1.5,B,{B}"), ROAD)


def of_way(way: int) -> list[str]:
    return [lane.name for lane in LANES if lane.direction == way]


@pytest.mark.parametrize("way", [1, 2])
def test_a_cut_knows_the_lanes_of_its_direction(way: int) -> None:
    """SV changes from one lane to the next; what it occupies is told frame by frame."""
    first, second = [lane for lane in LANES if lane.direction == way][:2]
    assert first.d is not None
    assert second.d is not None
    middles = [sum(lane.d) / 2 + 0.9 for lane in (first, second)]
    rows = [*cruise(0, 30, 4, middles[0]), *cruise(4.8, 30, 6, middles[1])]
    recording = make_recording([Track(way, 0, cruise(50, 30, 10, middles[0])), Track(way, 0, rows)])
    trace = cut_trace(recording, "here", {"SV": 1, "POV": 0}, (2, 7))
    assert [x.lane for x in trace.road.lanelets] == of_way(way)
    assert trace.lanes == {"SV": first.name, "POV": first.name}
    assert (trace.first, trace.batch.samples) == ("frame 2", 6)
    assert len(trace.batch.given) == 2 * len(of_way(way))

    def held(vehicle: str, lane: str) -> list[bool]:
        (lanelet,) = trace.road.lanelets_of(lane)
        known: np.ndarray = trace.batch.given[with_values(occupies(vehicle, lanelet), {})]
        return [bool(x) for x in known.ravel()]

    assert held("SV", first.name) == [True] * 2 + [False] * 4
    assert held("SV", second.name) == [False] * 2 + [True] * 4
    assert held("POV", first.name) == [True] * 6
    assert held("POV", second.name) == [False] * 6


def test_a_vehicle_beside_the_road_has_no_neighbours() -> None:
    band = LANES[1].d
    assert LANES[1].direction == 1
    assert band is not None
    for off in (-100.0, 100.0):
        recording = make_recording(
            [Track(1, 0, [(0.0, off, 20, 0, 0, 0)]), Track(1, 0, [(5.0, band[1], 20, 0, 0, 0)])]
        )
        assert recording.lane.tolist()[0] == NONE
        found = find_neighbours(recording)
        for rows in (found.preceding, found.following, *found.beside.values()):
            assert rows.tolist() == [NONE, NONE]
