"""Driver models put to matches: judged drives on both sides as recordings, and what other readers say."""

import csv
import json
from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from functools import cache
from itertools import islice
from pathlib import Path

import numpy as np
import pytest

import roadproof as rp
from extensions.drivers.read import bound, boundary, library, specification, values
from extensions.drivers.recorded import BEFORE, recorded
from extensions.traffic.make_recording import Track, cruise, make_recording
from extensions.traffic.test_windows import cut
from planting import plant
from roadproof.errors import UsageError
from roadproof.extensions.drivers.driver_settings import DriverSettings
from roadproof.extensions.drivers.lines import SIDES, Side
from roadproof.extensions.drivers.manoeuvres import KMH, MANOEUVRES, Manoeuvre, Plane, line
from roadproof.extensions.drivers.models import MODELS, SCENARIOS, course_in, foreseen
from roadproof.extensions.drivers.preventable.beside import beside_boundary
from roadproof.extensions.traffic.evaluate import foretelling
from roadproof.extensions.traffic.evaluate.evaluate import evaluate_recording, evaluate_windows
from roadproof.extensions.traffic.evaluate.matching import Match
from roadproof.extensions.traffic.evaluate.questions import (
    EvaluationQuestions,
    EvaluationSettings,
    compile_questions,
)
from roadproof.extensions.traffic.evaluate.recheck import recheck, trace_of
from roadproof.extensions.traffic.evaluate.recursive import TraceReader as Plain
from roadproof.extensions.traffic.evaluate.traces import gather
from roadproof.extensions.traffic.formats.recording import Integers, Recording
from roadproof.extensions.traffic.formats.write_highd import write_highd
from roadproof.extensions.traffic.simulate.simulate import simulate
from roadproof.extensions.traffic.simulate.traffic import TrafficSettings
from roadproof.frontends.cli.main import main

DRIVERS = ("r157", "careful", "rss", "eu1426")
FIXED: Mapping[str, Mapping[str, Fraction]] = {
    "cut-in": {"Ve0": 60 * KMH, "Vy": Fraction(1)},
    "cut-out": {"Ve0": 60 * KMH},
    "deceleration": {"Ve0": 60 * KMH, "dV0": 20 * KMH},
}
PASSED = {(side, name): set() for side in SIDES for name in MANOEUVRES}
PASSED["preventable", "cut-in"] = {(1, BEFORE, "undecided")}
"""Formulas count places at which SV passes POV as preventable; in a test nothing is claimed of them."""
EACH = [(name, x) for name in MANOEUVRES for x in DRIVERS if name in MODELS[x].manoeuvres]


def questions_with(**options: str) -> EvaluationQuestions:
    known = EvaluationSettings(
        library(), options, values(), ("base", "ext"), (Fraction(0),), (1, 2, 4), drivers=DRIVERS
    )
    return compile_questions(known, 25)


@pytest.fixture(scope="module")
def questions() -> EvaluationQuestions:
    return questions_with()


@cache
def drives(name: str, model: str, side: Side, **options: str) -> list[tuple[dict[str, Fraction], Recording]]:
    """Drives near the boundary that follow the model, as recordings."""
    kind: Manoeuvre = MANOEUVRES[name]
    high = min(kind.range[1], FIXED[name]["Ve0"]) if kind.across == "dV0" else kind.range[1]
    plane = Plane(kind, FIXED[name], kind.along, (kind.range[0], high), 7)
    lines = tuple(line(plane, boundary(name, model, **options), row) for row in plane.rows)
    home = specification(**options)
    near = islice(beside_boundary(plane, lines, side), 4)
    return [(at, recorded(kind, model, at, DriverSettings(values(), home.options))) for at in near]


def told(recording: Recording, asked: EvaluationQuestions, model: str) -> set[tuple[int, int | None, str]]:
    """Scenario, frame and label of each match of vehicle 1 as SV."""
    found = evaluate_recording(recording, asked).matches
    place = asked.settings.drivers.index(model)
    return {(x.scenario, x.begun, x.labels[place]) for x in found if x.sv == 1 and x.labels}


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize(("name", "model"), EACH)
def test_drives_on_both_sides_of_the_boundary(
    questions: EvaluationQuestions, name: str, model: str, side: Side
) -> None:
    number, seen = SCENARIOS[name], 0
    for _, recording in drives(name, model, side):
        labels = {x for x in told(recording, questions, model) if x[0] == number}
        assert labels <= {(number, BEFORE, side), *PASSED[side, name]}
        seen += (number, BEFORE, side) in labels
    assert seen


def test_a_reading_moves_the_boundary(questions: EvaluationQuestions) -> None:
    """What is perceived later is unpreventable from farther away."""
    found = drives("cut-in", "careful", "unpreventable", cc_perception="distance")
    _, recording = max(found, key=lambda x: x[0]["dx0"])
    later = questions_with(cc_perception="distance")
    assert told(recording, later, "careful") == {(1, BEFORE, "unpreventable")}
    assert told(recording, questions, "careful") == {(1, BEFORE, "preventable")}


def test_against_the_recursive_monitor(questions: EvaluationQuestions) -> None:
    """Where SV drives as a model the label is what the plain evaluator says of its formula."""
    checked = 0
    for name, model in EACH:
        for side in SIDES:
            for _, recording in drives(name, model, side)[:1]:
                for match in evaluate_recording(recording, questions).matches:
                    checked += _checked(recording, match, questions, model)
    assert checked >= 12


def _checked(recording: Recording, match: Match, asked: EvaluationQuestions, driver: str) -> int:
    name = course_in(match.scenario)
    if name is None or match.begun is None:
        return 0
    vehicles = MANOEUVRES[name].vehicles
    ids = [match.sv, match.pov, *([] if match.pov2 is None else [match.pov2])]
    low, high = (_array(x) for x in (match.start_frame, match.end_frame))
    who = {v: _array(number - 1) for v, number in zip(vehicles, ids, strict=True)}
    signals = ("s", "d", "v_lon", "v_lat", "a_lon")
    reading = Plain(trace_of(gather(recording, who, low, high, signals)))
    begins, here = bound(foreseen(name, vehicles)), match.begun - match.start_frame
    assert [reading.holds(begins, k, "strong") for k in range(here + 1)] == [False] * here + [True]
    for model, label in zip(asked.settings.drivers, match.labels, strict=True):
        if model == driver and name in MODELS[model].manoeuvres:
            collides = reading.holds(boundary(name, model), here, "strong")
            passed = name == "cut-in" and label == "undecided"
            assert label == "unpreventable" if collides else passed or label == "preventable"
        elif name not in MODELS[model].manoeuvres:
            assert label == ""
    return 1


def _array(number: int) -> Integers:
    return np.array([number])


@pytest.mark.parametrize("name", MANOEUVRES)
def test_a_controller_is_followed_in_matches(name: str) -> None:
    """The label is what becomes of the frames of the match when the fuzzy safety model drives SV."""
    asked = compile_questions(replace(questions_with().settings, drivers=("fsm",)), 25)
    seen = set()
    for side in SIDES:
        for _, recording in drives(name, "careful", side)[:2]:
            found = evaluate_recording(recording, asked)
            labels = {(x.scenario, x.begun, *x.labels) for x in found.matches if x.sv == 1 and x.labels}
            assert list(recheck(recording, asked, found)) == []
            seen |= {x[2] for x in labels if x[:2] == (SCENARIOS[name], BEFORE)}
    assert seen
    assert seen <= {"preventable", "unpreventable", "undecided"}


def test_what_is_never_foreseen(questions: EvaluationQuestions) -> None:
    """POV drifts in without a speed across; it is in the way of SV, which comes nearer, and never brakes."""
    (_, recording), *_ = drives("cut-in", "careful", "unpreventable")
    drifting = replace(recording, v_lat=0 * recording.v_lat)
    assert told(drifting, questions, "careful") == {(1, None, "not covered")}
    slow = make_recording([Track(2, 0, cruise(0, 30, 250)), Track(2, 0, cruise(150, 20, 250))])
    assert told(slow, questions, "careful") == {(4, None, "not covered")}


def test_what_begins_late_is_put_into_the_same_motion(questions: EvaluationQuestions) -> None:
    """POV is given a speed across only late; places, which it has from the beginning, decide."""
    (_, recording), *_ = drives("cut-in", "careful", "unpreventable")
    frames = np.tile(np.arange(len(recording.s) // 2), 2)
    late = replace(recording, v_lat=np.where(frames < BEFORE + 36, 0.0, recording.v_lat))
    assert told(late, questions, "careful") == {(1, BEFORE + 36, "unpreventable")}


def test_check_names_a_label_that_is_wrong(questions: EvaluationQuestions) -> None:
    ((_, recording), *_) = drives("cut-in", "careful", "unpreventable")
    found = evaluate_recording(recording, questions)
    assert list(recheck(recording, questions, found)) == []
    match = next(x for x in found.matches if x.begun == BEFORE)
    for wrong in (
        replace(match, labels=("preventable",) * 4),
        replace(match, begun=BEFORE + 1),
        replace(match, begun=None, labels=("not covered",) * 4),
    ):
        others = tuple(wrong if x is match else x for x in found.matches)
        (denied,) = recheck(recording, questions, replace(found, matches=others))
        assert "but the recursive evaluator has unpreventable" in denied or "r157" not in denied
        assert f"at frame {BEFORE}" in denied


@pytest.mark.parametrize(
    ("owner", "name", "right", "wrong"),
    [
        (foretelling, "_first_frames", "begins.argmax(axis=0)", "begins.argmax(axis=0) + 1"),
        (foretelling, "_first_frames", "begins.any(axis=0)", "~begins.any(axis=0)"),
        (foretelling, "label_of", "x == driver", "x != driver"),
        (foretelling, "label_of", "scene is None", "scene is not None"),
        (foretelling, "scene_in", "frames, TRACKED", "(frames[0], frames[0] + 51), TRACKED"),
    ],
)
def test_planted_faults_are_seen(
    monkeypatch: pytest.MonkeyPatch, owner: object, name: str, right: str, wrong: str
) -> None:
    plant(monkeypatch, owner, name, right, wrong)
    with pytest.raises((AssertionError, ValueError, IndexError, TypeError)):
        _ask_again(questions_with())


def _ask_again(asked: EvaluationQuestions) -> None:
    test_what_begins_late_is_put_into_the_same_motion(asked)
    for side in SIDES:
        test_drives_on_both_sides_of_the_boundary(asked, "cut-in", "careful", side)


def test_the_same_in_windows(questions: EvaluationQuestions) -> None:
    traffic = simulate(TrafficSettings(seconds=40), seed=6)
    made = cut(traffic, 6_000)
    assert len(made) > 3
    whole, windows = evaluate_recording(traffic, questions), evaluate_windows(made, questions)
    labelled = [[(x, x.begun, x.labels) for x in found.matches] for found in (whole, windows)]
    assert labelled[0] == labelled[1]
    assert {label for x in whole.matches for label in x.labels} >= {"preventable", "not covered"}


# --- whole runs --------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("recordings")
    write_highd(simulate(TrafficSettings(seconds=20, lane_width=3.5), seed=7, number=1), path)
    return path


def contents(out: Path) -> dict[str, bytes]:
    return {str(p.relative_to(out)): p.read_bytes() for p in sorted(out.rglob("*")) if p.is_file()}


def run(folder: Path, out: Path, *words: str) -> dict[str, bytes]:
    known = [
        "evaluate",
        str(folder),
        "--out",
        str(out),
        "--jobs",
        "1",
        "--no-pictures",
        "--among",
        "1,2,4,7",
        "--set",
        "base,ext",
    ]
    assert main([*known, *words]) == 0
    return contents(out)


def test_columns_table_and_what_stays(folder: Path, tmp_path: Path) -> None:
    """With drivers there is more and nothing else; without, all is as if they had never been asked for."""
    plain = run(folder, tmp_path / "out")
    asked = run(folder, tmp_path / "out", "--drivers", "careful,r157", "--check")
    again = run(folder, tmp_path / "out")
    assert again == plain
    assert {*asked} - {*plain} == {f"results-drivers.{x}" for x in ("txt", "md", "csv", "tex")}
    for name in ("pairs.csv", "results.csv", "comparison.csv", "answers.md"):
        assert asked[name] == plain[name]
    rows = list(csv.reader(asked["matches.csv"].decode().splitlines()))
    assert [row[:-4] for row in rows] == list(csv.reader(plain["matches.csv"].decode().splitlines()))
    assert rows[0][-4:] == ["careful", "careful_frame", "r157", "r157_frame"]
    for row in rows[1:]:
        known = dict(zip(rows[0], row, strict=True))
        assert (known["careful"] != "") == (known["scenario"] in ("1", "2", "4"))
        assert (known["r157"] != "") == (known["scenario"] == "1")
        for model in ("careful", "r157"):
            assert (known[f"{model}_frame"] != "") == (known[model] in (*SIDES, "undecided"))
    told = json.loads(asked["results.json"])
    assert told["settings"]["drivers"] == ["careful", "r157"]
    counted = {
        (x["set"], x["min_danger"], x["scenario"], x["driver"]): x["preventable"]
        + x["unpreventable"]
        + x["undecided"]
        + x["not_covered"]
        for x in told["drivers"]
    }
    assert len(counted) == 2 * 2 * 4
    assert sum(counted.values()) == sum((row[-4] != "") + (row[-2] != "") for row in rows[1:]) > 0
    less = json.loads(plain["results.json"])
    assert {*told} - {*less} == {"drivers"}
    assert "drivers" not in less["settings"]


def test_from_python(folder: Path) -> None:
    found = rp.evaluate(folder, among=[4], jobs=1, drivers=("rss",))
    rows = found.matches()
    assert {"rss", "rss_frame"} <= {*rows.columns}
    assert rows.height == sum(
        x[label]
        for x in found.as_data()["drivers"]
        for label in ("preventable", "unpreventable", "undecided", "not_covered")
    )
    assert "Matches by whether a driver model" in str(found)


@pytest.mark.parametrize(
    ("drivers", "among", "said"),
    [
        ("carful", "1-8", "'carful'"),
        ("r157", "4", "r157 does not apply to the selected scenarios (4); it applies to 1, 9, 17"),
        ("careful,careful", "1", "one is named twice"),
        ("careful,,r157", "1", "write names separated by commas"),
    ],
)
def test_mistakes_are_named(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], drivers: str, among: str, said: str
) -> None:
    words = ["evaluate", str(folder), "--out", str(tmp_path / "out"), "--drivers", drivers, "--among", among]
    assert main(words) != 0
    assert said in capsys.readouterr().err


def test_definitions_without_drivers_are_refused(folder: Path) -> None:
    with pytest.raises(UsageError, match="the specification 'driver'"):
        rp.evaluate(folder, using=rp.load("base"), drivers=("careful",))
