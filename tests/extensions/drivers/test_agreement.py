"""Matches of ``evaluate --drivers`` as samples: ``monitor`` and ``catalogue`` say the same of each model."""

from collections.abc import Iterator
from fractions import Fraction as F
from itertools import combinations, count
from pathlib import Path

import numpy as np

import roadproof as rp
from extensions.drivers.read import library, values
from extensions.drivers.test_replay import RATE, Maker, track_of
from extensions.traffic.make_recording import Track, make_recording
from extensions.traffic.sampled import toml_of
from roadproof.extensions.drivers.manoeuvres import MANOEUVRES
from roadproof.extensions.drivers.models import MODELS, course_in
from roadproof.extensions.drivers.sampled_replay import Track as Samples
from roadproof.extensions.traffic.evaluate.evaluate import evaluate_recording
from roadproof.extensions.traffic.evaluate.foretelling import last_common
from roadproof.extensions.traffic.evaluate.matching import Match
from roadproof.extensions.traffic.evaluate.one_trace import road_of
from roadproof.extensions.traffic.evaluate.questions import (
    EvaluationQuestions,
    EvaluationSettings,
    compile_questions,
)
from roadproof.extensions.traffic.formats.recording import Recording

ALL = tuple(MODELS)
SECONDS = 8
_RIGHT = -34.0  # m: the right lane there
HEAD = "time,vehicle,s,d,v_lon,v_lat,a_lon,a_lat,length,width"


def questions() -> EvaluationQuestions:
    known = EvaluationSettings(library(), {}, values(), ("base",), (F(0),), (1, 2, 4), drivers=ALL)
    return compile_questions(known, RATE)


def recordings() -> Iterator[Recording]:
    """Random tests as recordings of 8 s, or shorter: no vehicle drives through another."""
    for k in count():
        maker = Maker(("agree", k))
        drive, _ = maker.test(("cut-in", "deceleration", "cut-out")[k % 3])
        made = [track_of(x) for x in drive.vehicles.values()]
        frames = min((touching(a, b) for a, b in combinations(made, 2)), default=0)
        tracks = []
        for x in made:
            across = np.zeros(len(x.s))
            rows = np.stack((x.s, x.d + _RIGHT, x.v_lon, x.v_lat, x.a_lon, across), axis=1)[:frames]
            tracks.append(Track(2, 0, rows.tolist(), x.length, x.width))
        if frames > RATE:
            yield make_recording(tracks, RATE)


def touching(a: Samples, b: Samples) -> int:
    """The first sample at which boxes touch; at most that after 8 s."""
    along = (a.s >= b.s - b.length) & (b.s >= a.s - a.length)
    across = (a.d >= b.d - b.width) & (b.d >= a.d - a.width)
    found = np.flatnonzero(along & across)
    return min(SECONDS * RATE, int(found[0]) if len(found) else SECONDS * RATE)


def matched(asked: EvaluationQuestions) -> Iterator[tuple[Recording, Match]]:
    for recording in recordings():
        for match in evaluate_recording(recording, asked).matches:
            if match.labels and match.begun is not None:
                yield recording, match
                break


def samples_of(recording: Recording, match: Match, path: Path) -> None:
    """Write the frames of a match, up to the last with all vehicles, with the roles as names."""
    ids = [x for x in (match.sv, match.pov, match.pov2) if x is not None]
    course = course_in(match.scenario)
    assert course is not None
    who = np.array([[x - 1] for x in ids])
    last = int(last_common(recording, who)[0])
    lines = [HEAD]
    for frame in range(match.start_frame, last + 1):
        for number, role in zip(ids, MANOEUVRES[course].vehicles, strict=True):
            row = recording.start[number - 1] + frame - recording.first_frame[number - 1]
            signals = (getattr(recording, x)[row] for x in ("s", "d", "v_lon", "v_lat", "a_lon", "a_lat"))
            sizes = recording.length[number - 1], recording.width[number - 1]
            time = (frame - match.start_frame) / RATE
            lines.append(",".join((repr(time), role, *(repr(float(x)) for x in (*signals, *sizes)))))
    path.write_text("\n".join(lines) + "\n")
    path.with_name(f"{path.stem}_road.toml").write_text(toml_of(road_of(recording, 2)))


def check(folder: Path, cases: int) -> int:
    """Compare so many verdicts of models, and return how many there were."""
    asked, compared, tests = questions(), 0, dict[str, tuple[Match, dict[str, str]]]()
    folder.mkdir()
    for k, (recording, match) in enumerate(matched(asked)):
        labels = {x: label for x, label in zip(ALL, match.labels, strict=True) if label}
        samples_of(recording, match, folder / f"t{k}.csv")
        tests[f"t{k}"] = match, labels
        compared += len(labels)
        if compared >= cases:
            break
    home = rp.load(params={"minDanger": 0})
    found = rp.catalogue(folder, using=home, among="1,2,4", classes=False, jobs=1)
    decided: dict[tuple[str, str], dict[str, str]] = {}
    for test, x in found.decisions:
        decided.setdefault((test, x.scenario), {})[x.driver] = x.side
    for name, (match, labels) in tests.items():
        scenario = f"scenario_{match.scenario}"
        assert decided.get((name, scenario)) == labels, (name, match)
        heard = rp.monitor(match.scenario, folder / f"{name}.csv", home, drivers=tuple(labels))
        assert {x.driver: x.side for x in heard.decisions} == labels, (name, match)
    return compared


def test_cases_that_all_three_are_asked(tmp_path: Path) -> None:
    assert check(tmp_path / "tests", 24) >= 24


def test_five_hundred_cases_that_all_three_are_asked(tmp_path: Path) -> None:
    assert check(tmp_path / "tests", 500) >= 500
