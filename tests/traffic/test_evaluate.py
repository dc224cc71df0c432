"""The evaluation against the slow reference, on planted drives, and its invariants."""

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np
import pytest

from roadproof.errors import InputError, UsageError
from roadproof.library import elaborate as elaborating
from roadproof.library import scenarios
from roadproof.library.elaboration import Elaborator
from roadproof.library.loading import build_library, bundled_library
from roadproof.library.specification import Query, Source, Specification
from roadproof.logic import show
from roadproof.logic.formula import Compare
from roadproof.logic.syntax import Claim
from roadproof.logic.terms import Parameter, number
from roadproof.recordings.evaluate import disturbances, evaluate
from roadproof.recordings.evaluate import questions as module
from roadproof.recordings.evaluate.evaluate import Findings, evaluate_recording
from roadproof.recordings.evaluate.questions import (
    SAFE,
    VIOLATION,
    Danger,
    MonitorKey,
    Questions,
    ask,
    default_settings,
)
from roadproof.recordings.formats.recording import Recording, keep_vehicles
from roadproof.recordings.simulate.plant import Place, plant
from roadproof.recordings.simulate.synthetic import simulate
from roadproof.recordings.simulate.traffic import Traffic
from roadproof.semantics.sampled import compile
from roadproof.semantics.sampled.answers import TruthArrays, Verdicts
from traffic.drives import braking, cut_in, cut_out, late_cut_out, swerve
from traffic.make_recording import Track, cruise, make_recording
from traffic.reference import Reference, Row


@pytest.fixture(scope="module")
def questions() -> Questions:
    return ask(default_settings(), 25)


def rows_of(findings: Findings) -> list[Row]:
    return [
        (m.sv, m.pov, m.pov2, m.lane, m.start_frame, m.end_frame, m.min_danger, m.set_name, m.scenario)
        for m in findings.matches
    ]


def planted_traffic(direction: int) -> tuple[Recording, dict[str, dict[str, int]]]:
    """A short recording of few cars with three drives in it, and who is who in each."""
    recording = simulate(Traffic(seconds=40, flow=500, lane_width=3.5), seed=4)
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
            Place(direction, 20 + 190 * k, Fraction(7 if name == "swerve" else 6), start, right),
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
def case(request: pytest.FixtureRequest, questions: Questions) -> Case:
    recording, who = planted_traffic(request.param)
    recording = keep_vehicles(recording, recording.direction == request.param)
    reference = Reference(recording, questions.settings)
    violating = len(reference.violating)
    return Case(recording, who, Counter(reference.matches()), sorted(reference.traces()), violating)


def agrees(case: Case, questions: Questions) -> bool:
    findings = evaluate_recording(case.recording, questions)
    traces = sorted((t.first, t.second, t.min_danger, t.start_frame, t.end_frame) for t in findings.traces)
    return (Counter(rows_of(findings)), traces, len(findings.violating)) == (
        case.matches,
        case.traces,
        case.violating,
    )


def test_against_the_reference(case: Case, questions: Questions) -> None:
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


def _cut_early(questions: Questions, monkeypatch: pytest.MonkeyPatch) -> Questions:
    return replace(questions, danger_steps=(0, 0))


def _start_outside(questions: Questions, monkeypatch: pytest.MonkeyPatch) -> Questions:
    """Triples start in their first common frame, safe or not."""
    monkeypatch.setattr(disturbances._Lookup, "next_safe", lambda self, index, frame, latest: frame)
    return questions


def _lane_at_the_end(questions: Questions, monkeypatch: pytest.MonkeyPatch) -> Questions:
    lane_at = evaluate._lane_at
    monkeypatch.setattr(evaluate, "_lane_at", lambda r, v, frame: lane_at(r, v, r.last_frame[v]))
    return questions


def _own_lane_for_scenario_7(questions: Questions, monkeypatch: pytest.MonkeyPatch) -> Questions:
    monkeypatch.setattr(module, "lane_owner", lambda specification, scenario: "SV")
    return ask(questions.settings, 25)


def _one_role(questions: Questions, monkeypatch: pytest.MonkeyPatch) -> Questions:
    kept = [replace(m, plain={k: v for k, v in m.plain.items() if k.sv == "first"}) for m in questions.pairs]
    return replace(questions, pairs=tuple(kept))


def _short_reach(questions: Questions, monkeypatch: pytest.MonkeyPatch) -> Questions:
    assert questions.reach is not None
    return replace(questions, reach=replace(questions.reach, rho=0.0, a_max_lat=0.0))


def _swapped_names(questions: Questions, monkeypatch: pytest.MonkeyPatch) -> Questions:
    monkeypatch.setattr(evaluate, "TRIPLE", ("SV", "POV2", "POV1"))
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
    fault: Callable[[Questions, pytest.MonkeyPatch], Questions],
    case: Case,
    questions: Questions,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    assert not agrees(case, fault(questions, monkeypatch))


def test_sets_grow_and_matches_are_disturbances(questions: Questions) -> None:
    recording = simulate(Traffic(seconds=60, lane_width=3.5), seed=8)
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


def test_start_and_end_by_hand(questions: Questions) -> None:
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


def test_start_needs_its_whole_window(questions: Questions) -> None:
    """Safe for 15 samples only (0.56 s): no start there; for 16 samples (0.6 s): a start."""
    for safe_samples, found in ((15, 0), (16, 1)):
        rest = (-28.0, 30.0, 0.0, 0.0, 0.0)
        rows = [(1000.0, *rest) for _ in range(safe_samples + 20)]
        ahead = [(1150.0 if k < safe_samples else 1010.0, *rest) for k in range(safe_samples + 20)]
        findings = evaluate_recording(make_recording([Track(2, 1, rows), Track(2, 1, ahead)]), questions)
        assert sum(t.min_danger == 0 for t in findings.traces) == found


def test_trucks_only_on_request(questions: Questions) -> None:
    tracks = [Track(2, 1, cruise(0.0, 30.0, 300)), Track(2, 1, cruise(200.0, 20.0, 300), kind="Truck")]
    r = make_recording(tracks)
    assert len(evaluate_recording(r, questions).violating) == 0
    wide = ask(replace(questions.settings, classes=("Car", "Truck")), 25)
    assert len(evaluate_recording(r, wide).violating) == 1


def test_prefilter_is_dropped_for_other_dangers(questions: Questions) -> None:
    """With a danger of the user's own the pairs are all looked at: this one reaches 300 m."""
    text = "def rssViolation_lon(a, b: vehicle) := s(b) - s(a) <= 300 m and s(a) - s(b) <= 300 m"
    library = build_library([Source("mine.spec", text)], bundled_library())
    settings = replace(questions.settings, library=library)
    mine = ask(settings, 25)
    assert questions.reach is not None
    assert mine.reach is None
    tracks = [Track(2, 1, cruise(0.0, 30.0, 500)), Track(2, 1, cruise(400.0, 20.0, 500))]
    r = make_recording(tracks)
    assert len(evaluate_recording(r, questions).violating) == 0
    assert len(evaluate_recording(r, mine).violating) == 1


def test_empty_and_lonely(questions: Questions) -> None:
    r = make_recording([Track(2, 1, cruise(0.0, 30.0, 50))])
    findings = evaluate_recording(r, questions)
    assert (findings.violating, findings.traces, findings.matches) == ((), (), ())
    none = keep_vehicles(r, np.zeros(1, bool))
    assert evaluate_recording(none, questions).vehicles == 0


def test_off_the_road(questions: Questions) -> None:
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
        ask(settings, 7)
    with pytest.raises(InputError, match="no spec set"):
        ask(replace(settings, sets=("bass",)), 25)


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

    for user in (elaborating, scenarios):
        monkeypatch.setattr(user, "elaborate", counted)
    monkeypatch.delattr(elaborating, "parse_claim")
    ask(replace(settings, detectors=scenarios.COMPARISON), 25)
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
        ask(replace(default_settings(library), scenarios=(25,)), 25)


def test_a_scenario_of_ones_own_says_its_vehicles_and_its_lane() -> None:
    text = "def scenario_25(SV, A: vehicle, L: lane) := atLane(A, L)\nlane of A for 25"
    library = build_library([Source("mine.spec", text)], bundled_library())
    mine = ask(replace(default_settings(library), sets=("ext",), scenarios=(2, 25)), 25)
    assert set(mine.pairs[0].formulas) == {
        MonitorKey("ext", 25, "first", "L1"),
        MonitorKey("ext", 25, "second", "L"),
    }
    assert set(mine.triples[0].formulas) == {MonitorKey("ext", 2, "first", "L")}


def test_what_is_asked_is_a_value_and_mistakes_show_it_as_text(questions: Questions) -> None:
    assert set(questions.danger.formulas) == {VIOLATION, SAFE, Danger(0), Danger(1)}
    asked = {
        MonitorKey("ext", 7, "first", "L1"),
        MonitorKey("ext", 7, "second", "L"),
        MonitorKey("base", 3, "first", "L"),
    }
    assert asked <= set(questions.pairs[0].formulas)
    assert str(MonitorKey("ext", 7, "first", "L1")) == "ext/7/first"
    with pytest.raises(InputError, match=r"^danger 1: a monitor needs numbers, but x has no value"):
        compile({Danger(1): Compare(Parameter("x"), "<", number(1))})


def test_of_recordings_is_read_what_the_formulas_speak_of(questions: Questions) -> None:
    assert questions.danger.signals == ("s", "d", "v_lon", "v_lat")
    assert questions.pairs[0].signals == ("s", "d", "v_lon", "v_lat", "a_lon")
    sways = "def decelerates(a: vehicle) := a_lon(a) < 0 or a_lat(a) > 0.1 m/s^2"
    source = Source("mine.spec", f"set mine extends ext {{ {sways} }}")
    library = build_library([source], bundled_library())
    mine = ask(replace(default_settings(library), sets=("mine",)), 25)
    assert mine.pairs[0].signals[-1] == "a_lat"
    recording, _ = planted_traffic(1)
    assert evaluate_recording(recording, mine).traces == evaluate_recording(recording, questions).traces != ()


def test_only_traces_in_which_danger_arises_are_counted(questions: Questions) -> None:
    @dataclass
    class Answers:
        """A monitor that says of four traces: true, false, undecided, undecided; read otherwise, false."""

        def evaluate(self, seen: object, convention: str) -> Verdicts:
            other = convention != questions.settings.convention
            true, false = ([not other, False, False, False], [other, True, other, other])
            return Verdicts(convention, {"it": TruthArrays(np.array(true), np.array(false))}, {})

    tally = evaluate._Tally(questions)
    for arises, counts in (([1, 1, 1, 1], (4, 2, 1)), ([0, 1, 1, 0], (6, 3, 1)), ([1, 0, 0, 0], (7, 3, 2))):
        seen = np.array(arises, bool)
        assert tally.ask(Answers(), None, seen)["it"].tolist() == [bool(arises[0]), False, False, False]
        assert (tally.asked, tally.undecided, tally.differing) == counts
