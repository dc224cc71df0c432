"""Windows of one recording that overlap: what both show counts once, and what only one shows counts."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from roadproof.analysis.classify.cells import whole_cell
from roadproof.analysis.classify.classes import Classes, plan_of, what_axis
from roadproof.analysis.classify.shares import Shares, count_shares
from roadproof.analysis.classify.text import with_classes, write_classes
from roadproof.library.bind import default_values
from roadproof.library.loading import bundled_library
from roadproof.library.scenarios import COMPARISON
from roadproof.recordings.evaluate.counting import Counts
from roadproof.recordings.evaluate.experiment import Experiment, run_experiment
from roadproof.recordings.evaluate.questions import default_settings
from roadproof.recordings.evaluate.totals import Row, Totals
from roadproof.recordings.formats.repeats import STEPS, moments_of
from roadproof.recordings.formats.sources import find_sources
from traffic.tiny_commonroad import Car, document

SPEEDS = {"rear": (20.0, 0.02), "front": (12.0, 0.03)}
STEPS_SEEN = 40


def motion(speed: float, pull: float, k: int) -> tuple[float, float]:
    """Speed and acceleration at step ``k``, of a driver whose acceleration grows."""
    return speed + pull * (0.1 * k) ** 2 / 2, pull * 0.1 * k


def car(number: int, begin: float, who: str, first: int, last: int) -> Car:
    speed, pull = SPEEDS[who]
    way = np.cumsum([0.0] + [0.1 * motion(speed, pull, k)[0] for k in range(last)])
    centres = tuple((begin + float(way[k]), 1.75) for k in range(first, last))
    return Car(number, 0, centres, motion=tuple(motion(speed, pull, k) for k in range(first, last)))


def window(path: Path, first: int, last: int, ids: tuple[int, int] = (1, 2)) -> None:
    """Steps ``first`` to ``last`` of a drive in which a car closes in on another until it is too near."""
    path.write_text(
        document((car(ids[0], 10.0, "rear", first, last), car(ids[1], 75.0, "front", first, last)))
    )


def evaluate(folder: Path, out: Path) -> Totals:
    settings = replace(default_settings(), scenarios=(4, 12))  # the road begins as a merge zone
    return run_experiment(Experiment(folder, out, settings)).totals


def traces(totals: Totals) -> list[int]:
    return [row.traces for row in merging(totals) if row.set_name == "base"]


def merging(totals: Totals) -> list[Row]:
    """Those of the merge zone: the main lanes of the tiny road lie in it too."""
    return totals.tables["merge zone"]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "windows").mkdir()
    window(tmp_path / "windows" / "a.xml", 0, STEPS_SEEN)
    return tmp_path / "windows"


def test_drives_that_were_made_are_no_windows(folder: Path, tmp_path: Path) -> None:
    """Files of tests may show the same drive on purpose: each counts, as ZAM in their names says."""
    window(folder / "b.xml", 0, STEPS_SEEN)
    for path in folder.glob("*.xml"):
        named = f'benchmarkID="ZAM_Made-{ord(path.stem)}_1_T-1" commonRoadVersion'
        path.write_text(path.read_text().replace("commonRoadVersion", named, 1))
    totals = evaluate(folder, tmp_path / "out")
    assert (traces(totals), totals.violating, totals.repeats) == ([2, 2], 2, [])


def test_a_window_alone_counts(folder: Path, tmp_path: Path) -> None:
    totals = evaluate(folder, tmp_path / "out")
    assert (traces(totals), totals.violating, totals.repeats) == ([1, 1], 1, [])
    assert all(row.matching == 1 for row in merging(totals))


@pytest.mark.parametrize(("first", "ids"), [(0, (7, 8)), (3, (1, 2)), (6, (9, 4))])
def test_what_an_earlier_window_shows_is_left_out(
    first: int, ids: tuple[int, int], folder: Path, tmp_path: Path
) -> None:
    """Other ids, another time 0: the trace, the violation and the matches count once, and that is said."""
    window(folder / "b.xml", first, STEPS_SEEN, ids)
    totals = evaluate(folder, tmp_path / "out")
    assert (traces(totals), totals.violating, totals.repeated) == ([1, 1], 1, 2)
    assert all(row.matching == 1 for row in merging(totals))
    told = json.loads((tmp_path / "out" / "results.json").read_text())
    assert {
        "recording": "b",
        "pair": sorted(ids),
        "what": "trace",
        "min_danger": "0",
        "shown_in": "a",
    } in told["repeats"]
    rows = (tmp_path / "out" / "pairs.csv").read_text().splitlines()
    assert len(rows) == 3
    assert all(row.startswith("a,") for row in rows[1:])


def test_windows_that_follow_each_other_both_count(folder: Path, tmp_path: Path) -> None:
    """Another car, elsewhere in time: nothing is the same."""
    (folder / "b.xml").write_text(
        document(
            (
                car(1, 12.0, "front", 0, STEPS_SEEN),
                Car(2, 0, ((64.0, 1.75),) * STEPS_SEEN, motion=((0.0, 0.0),) * STEPS_SEEN),
            )
        )
    )
    totals = evaluate(folder, tmp_path / "out")
    assert totals.repeats == []
    assert traces(totals)[0] == 2


def test_detections_count_once(folder: Path, tmp_path: Path) -> None:
    window(folder / "b.xml", 2, STEPS_SEEN)
    settings = replace(default_settings(), detectors=COMPARISON)
    one = run_experiment(Experiment(folder / "a.xml", tmp_path / "one", settings)).totals
    both = run_experiment(Experiment(folder, tmp_path / "both", settings)).totals
    assert both.detected == one.detected
    assert (both.recordings, one.recordings) == (2, 1)


def test_moments_are_those_of_motion_not_of_place() -> None:
    """Five changing samples make a moment; standing, steady motion and the last four make none."""
    changing = np.array([[10.0 + 0.1 * k, 0.1] for k in range(12)])
    steady = np.array([[12.192, 0.0]] * 12)
    made = moments_of(np.concatenate((changing, steady, changing[3:])), np.array([0, 12, 24, 33]))
    assert (made[:12] != 0).tolist() == [True] * (12 - STEPS + 1) + [False] * (STEPS - 1)
    assert not made[12:24].any()
    assert made[24:].tolist() == made[3:12].tolist()


def test_the_same_recording_repeats_nothing() -> None:
    counted = Counts()
    assert counted.is_new("a", (1, 2), "trace", 0, (5, 6, 0))
    assert counted.is_new("a", (1, 2), "trace", 0, (6, 7))
    assert counted.is_new("b", (1, 2), "trace", 0, (0, 8))  # 0 is no moment
    assert counted.is_new("b", (1, 2), "trace", 1, (5,))  # another minDanger
    assert not counted.is_new("b", (3, 4), "trace", 0, (9, 7))
    assert [(r.recording, r.first, r.shown_in) for r in counted.repeats] == [("b", 3, "a")]


def test_classes_count_what_two_windows_show_once(folder: Path) -> None:
    """Of a class that holds wherever scenario 12 does: the road begins as a merge zone."""
    library = bundled_library()
    (group,) = (plan := plan_of(library.select(), (12,))).groups
    cells = ((whole_cell(what_axis(plan, group, library.select()), (12,), ()),),)
    classes = Classes(plan, cells, ())
    specification = with_classes(write_classes(classes, library.select()), library.select())

    def shares() -> Shares:
        recordings = [source.read() for source in find_sources(folder)]
        return count_shares(classes, specification, default_values(library), recordings)

    alone = shares()
    assert (alone.all_traces, alone.traces["class_12"], alone.repeated, alone.broken) == (1, 1, 0, [])
    window(folder / "b.xml", 5, STEPS_SEEN, ids=(7, 8))
    both = shares()
    assert (both.all_traces, both.traces["class_12"], both.repeated, both.broken) == (1, 1, 1, [])
    assert both.situations == alone.situations
