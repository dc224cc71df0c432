"""The comparison detectors: by hand, and batches and pre-filter against the recursive evaluator."""

from dataclasses import replace
from fractions import Fraction
from itertools import permutations

import numpy as np
import pytest

from roadproof.library.loading import build_library, bundled_library
from roadproof.library.scenarios import COMPARISON
from roadproof.library.specification import Source
from roadproof.recordings.evaluate import detectors
from roadproof.recordings.evaluate.detectors import Detection, find_detections
from roadproof.recordings.evaluate.evaluate import evaluate_recording
from roadproof.recordings.evaluate.questions import Questions, ask, default_settings
from roadproof.recordings.evaluate.results import as_json
from roadproof.recordings.evaluate.totals import add_findings, begin_totals
from roadproof.recordings.formats.pairs import DetectionRange, common_pairs
from roadproof.recordings.formats.recording import Recording
from roadproof.recordings.simulate.plant import Place, plant
from roadproof.recordings.simulate.synthetic import simulate
from roadproof.recordings.simulate.traffic import Traffic
from roadproof.semantics.sampled.recursive import TraceReader
from traffic.drives import braking, cut_in
from traffic.make_recording import LANES, Track, cruise, make_recording
from traffic.reference import Reference

Shown = set[tuple[str, int, int, str]]


@pytest.fixture(scope="module")
def questions() -> Questions:
    return ask(replace(default_settings(), detectors=COMPARISON), 25)


def shown(recording: Recording, questions: Questions) -> Shown:
    found = find_detections(recording, questions, common_pairs(recording, np.ones(recording.vehicles, bool)))
    assert list(found) == sorted(found, key=lambda x: (x.detector, x.sv, x.pov, x.lane))
    return {(x.detector, x.sv, x.pov, x.lane) for x in found}


def brute(recording: Recording, questions: Questions) -> Shown:
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
def test_by_hand(name: str, questions: Questions) -> None:
    sv, pov, expected = BY_HAND[name]
    recording = make_recording([Track(2, 1, sv), Track(2, 1, pov)])
    found = shown(recording, questions)
    assert found == brute(recording, questions)
    assert {x[0] for x in found if x[1:] == (1, 2, "7")} == expected
    assert all(x[1:] == (1, 2, "7") for x in found)


@pytest.fixture(scope="module")
def busy() -> tuple[Recording, Shown]:
    recording = simulate(Traffic(seconds=7, flow=1200, lane_width=3.5), seed=3)
    recording, _ = plant(recording, cut_in(), Place(2, 5, Fraction(6), 10.0, -34.0))
    recording, _ = plant(recording, braking(), Place(1, 5, Fraction(6), -410.0, 8.5))
    recording = replace(recording, kind=np.full(recording.vehicles, "Car"))
    return recording, brute(recording, ask(replace(default_settings(), detectors=COMPARISON), 25))


def test_simulated_traffic_against_brute_force(busy: tuple[Recording, Shown], questions: Questions) -> None:
    recording, expected = busy
    assert shown(recording, questions) == expected
    assert len({x[0] for x in expected}) >= 2
    # Without the pre-filter the answer is the same; with one that sees too little it is not.
    assert questions.sight is not None
    assert shown(recording, replace(questions, sight=None)) == expected
    assert shown(recording, replace(questions, sight=DetectionRange(0.0, 0.0, 5.0))) != expected


def test_one_lane_only_is_caught(
    busy: tuple[Recording, Shown], questions: Questions, monkeypatch: pytest.MonkeyPatch
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
    mine = ask(replace(default_settings(library), detectors=("faraway",)), 25)
    assert mine.sight is None
    recording = make_recording([Track(2, 1, cruise(0, 30, 9)), Track(2, 1, cruise(360, 30, 9, d=-24.5))])
    assert shown(recording, mine) == {("faraway", 1, 2, "7")}


def test_counts_are_of_unordered_pairs(questions: Questions) -> None:
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
    assert evaluate_recording(recording, ask(default_settings(), 25)).detections == ()
