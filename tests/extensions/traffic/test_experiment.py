"""Runs over several recordings: resumed after a kill, jobs, bad recordings, and what is written."""

import csv
import dataclasses
import json
import os
import shutil
from collections import Counter
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import polars as pl
import pytest

from extensions.traffic.drives import braking, cut_in
from extensions.traffic.planar import commonroad_of
from extensions.traffic.sampled import csv_of, lower_road, toml_of, write_samples
from roadproof.errors import InputError
from roadproof.extensions.surveys.coverage.traffic import disturbances_in, recordings_in
from roadproof.extensions.traffic.evaluate import experiment as module
from roadproof.extensions.traffic.evaluate.evaluate import DisturbanceTrace, Findings
from roadproof.extensions.traffic.evaluate.experiment import Experiment, run_experiment
from roadproof.extensions.traffic.evaluate.matching import Match
from roadproof.extensions.traffic.evaluate.questions import default_settings
from roadproof.extensions.traffic.evaluate.results import as_json
from roadproof.extensions.traffic.evaluate.totals import add_findings, begin_totals
from roadproof.extensions.traffic.formats.highd import read_highd
from roadproof.extensions.traffic.formats.recording import keep_vehicles
from roadproof.extensions.traffic.formats.samples import read_columns
from roadproof.extensions.traffic.formats.sources import find_sources
from roadproof.extensions.traffic.formats.write_highd import write_highd
from roadproof.extensions.traffic.simulate.planting import PlantingPlace, plant
from roadproof.extensions.traffic.simulate.simulate import simulate
from roadproof.extensions.traffic.simulate.traffic import TrafficSettings
from roadproof.frontends.cli.main import main
from roadproof.library.loading import bundled_library
from roadproof.questions.basis import Basis
from roadproof.runtime.executors import Executor

US101 = Path(__file__).parents[4] / "shared" / "data" / "us101"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("recordings")
    for number in (1, 2, 3):
        write_highd(simulate(TrafficSettings(seconds=20, lane_width=3.5), seed=6, number=number), path)
    return path


def contents(out: Path) -> dict[str, bytes]:
    return {str(p.relative_to(out)): p.read_bytes() for p in sorted(out.rglob("*")) if p.is_file()}


@pytest.fixture(scope="module")
def undisturbed(folder: Path, tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    out = tmp_path_factory.mktemp("undisturbed")
    run_experiment(Experiment(folder, out, default_settings()))
    return contents(out)


def test_files_and_their_numbers(undisturbed: dict[str, bytes]) -> None:
    assert set(undisturbed) == {
        "matches.csv",
        "pairs.csv",
        "results.json",
        *(f"recordings/{x}.json" for x in ("01", "02", "03")),
    }
    told = json.loads(undisturbed["results.json"])
    assert told["schema"] == "roadproof/traffic-results/5"
    assert told["recordings"] == 3
    assert told["checks"]["broken"] == []
    matches = list(csv.DictReader(undisturbed["matches.csv"].decode().splitlines()))
    pairs = list(csv.DictReader(undisturbed["pairs.csv"].decode().splitlines()))
    assert len(told["table"]) == 6
    for row in told["table"]:
        danger = {"0": "0", "3/5": "0.6"}[row["min_danger"]]
        ours = [m for m in matches if (m["min_danger"], m["set"]) == (danger, row["set"])]
        chosen = [p for p in pairs if p["min_danger"] == danger]
        assert row["traces"] == len(chosen) > 0
        two = {(m["recording"], *sorted((m["sv"], m["pov"]))) for m in ours if not m["pov2"]}
        assert row["matching"] == len(two) > 0
        assert row["recall"] == len(two) / len(chosen)
        assert row["matching_with_three_cars"] == sum(int(p[row["set"]]) for p in chosen)
        for i, count in row["scenarios"].items():
            who = {
                (m["recording"], *sorted((m["sv"], m["pov2"] or m["pov"])))
                for m in ours
                if m["scenario"] == i
            }
            assert count == len(who)
    assert set(Counter(m["recording"] for m in matches)) == {"01", "02", "03"}


@pytest.mark.parametrize("moment", [1, 2, 3, 4, 5])
def test_killed_and_started_again(
    moment: int, folder: Path, undisturbed: dict[str, bytes], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Killed while the ``moment``-th file is being put in its place: the next run ends the same."""
    replace_file, calls = os.replace, [0]

    def killed(source: str, target: Path) -> None:
        calls[0] += 1
        if calls[0] == moment:
            raise KeyboardInterrupt
        replace_file(source, target)

    monkeypatch.setattr(os, "replace", killed)
    with pytest.raises(KeyboardInterrupt):
        run_experiment(Experiment(folder, tmp_path, default_settings()))
    monkeypatch.setattr(os, "replace", replace_file)
    assert not list(tmp_path.rglob(".*"))
    (tmp_path / "recordings").mkdir(exist_ok=True)
    (tmp_path / "recordings" / ".03.json.killed").write_text("{")  # what a hard kill may leave
    told: list[str] = []
    run_experiment(Experiment(folder, tmp_path, default_settings()), told.append)
    (tmp_path / "recordings" / ".03.json.killed").unlink()
    assert contents(tmp_path) == undisturbed
    evaluated = [line for line in told if line.startswith("[")]
    assert len(evaluated) == max(0, 4 - moment)


def test_two_jobs_give_the_same_bytes(
    folder: Path, undisturbed: dict[str, bytes], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    workers = []
    true_answers = module.run_jobs

    def run_jobs(work: Any, jobs: Any, hands: Executor, **more: Any) -> Any:
        workers.append(hands.processes)
        return true_answers(work, jobs, hands, **more)

    monkeypatch.setattr(module, "run_jobs", run_jobs)
    run_experiment(Experiment(folder, tmp_path, default_settings(), Executor(2)))
    assert contents(tmp_path) == undisturbed
    assert workers == [2]


def test_results_of_other_settings_or_files_are_not_reused(folder: Path, tmp_path: Path) -> None:
    ours = tmp_path / "ours"
    shutil.copytree(folder, ours)
    (ours / "03_tracks.csv").unlink()
    (ours / "03_tracksMeta.csv").unlink()
    (ours / "03_recordingMeta.csv").unlink()
    out = tmp_path / "out"
    settings = default_settings()
    run_experiment(Experiment(ours, out, settings))

    def evaluated(chosen: object) -> int:
        told: list[str] = []
        run_experiment(Experiment(ours, out, chosen), told.append)  # type: ignore[arg-type]
        return sum(line.startswith("[") for line in told)

    assert evaluated(settings) == 0
    assert evaluated(replace(settings, values={**settings.values, "rho": Fraction(1)})) == 2
    assert evaluated(settings) == 2
    write_highd(simulate(TrafficSettings(seconds=21), seed=9, number=1), ours)
    assert evaluated(settings) == 1
    (out / "recordings" / "02.json").write_text('{"schema": "roadproof/recording-findings/1"')
    assert evaluated(settings) == 1


def test_bad_recordings(folder: Path, tmp_path: Path) -> None:
    ours = tmp_path / "ours"
    shutil.copytree(folder, ours)
    text = (ours / "02_tracks.csv").read_text().splitlines()
    (ours / "02_tracks.csv").write_text("\n".join(text[:-30]) + "\n")
    lenient = run_experiment(Experiment(ours, tmp_path / "lenient", default_settings()))
    assert not lenient.failed
    assert any("left out" in note for note in lenient.totals.notes["02"])
    with pytest.raises(InputError, match="02_tracks"):
        run_experiment(Experiment(ours, tmp_path / "a", default_settings(), strict=True))
    assert not (tmp_path / "a" / "results.json").exists()
    told: list[str] = []
    outcome = run_experiment(
        Experiment(ours, tmp_path / "b", default_settings(), keep_going=True, strict=True), told.append
    )
    assert list(outcome.failed) == ["02"]
    assert outcome.totals.recordings == 2
    assert any("left out" in line for line in told)
    assert "02" in json.loads((tmp_path / "b" / "results.json").read_text())["failed"]
    for number in ("01", "03"):
        (ours / f"{number}_tracks.csv").write_text("")
    with pytest.raises(InputError, match="none could be used"):
        run_experiment(Experiment(ours, tmp_path / "c", default_settings(), keep_going=True, strict=True))


def test_unwritable_output(folder: Path, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="cannot write"):
        run_experiment(Experiment(folder, tmp_path / "file" / "out", default_settings()))


def match(sv: int, pov: int, set_name: str, scenario: int) -> Match:
    return Match(sv, pov, None, "2", 1, 50, 0, set_name, scenario)


@pytest.mark.parametrize(
    ("matches", "lanes", "broken"),
    [
        ([match(1, 2, s, n) for s in ("base", "extA", "ext") for n in (3, 4)], ("2", "2"), None),
        ([match(1, 2, s, 4) for s in ("base", "extA", "ext")], ("2", "3"), None),
        ([match(1, 2, s, 4) for s in ("base", "extA", "ext")], ("2", "2"), "only one of scenarios 3 and 4"),
        ([match(1, 2, "base", 1)], ("2", "2"), "does not match as much in extA"),
        ([match(1, 2, s, 1) for s in ("extA", "base")], ("2", "2"), "does not match as much in ext"),
        ([match(1, 5, s, 1) for s in ("base", "extA", "ext")], ("2", "2"), "is no disturbance"),
    ],
)
def test_facts_are_checked(matches: list[Match], lanes: tuple[str, str], broken: str | None) -> None:
    traces = (DisturbanceTrace(1, 2, 0, 1, 50, *lanes, ("main road",)),)
    totals = begin_totals(default_settings())
    add_findings(
        totals, Findings("01", 9, 99, ((1, 2),), 0, 1, 0, 0, traces, tuple(matches), (), (), ("main road",))
    )
    told = as_json(totals, {})["checks"]
    assert (broken is None and told["broken"] == []) or any(str(broken) in x for x in told["broken"])
    three_and_four = {m.scenario for m in matches} & {3, 4}
    assert len(told["unequal_3_4"]) == (len(three_and_four) == 1)


def test_sources(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="not a folder"):
        find_sources(tmp_path / "nothing")
    (tmp_path / "a.xml").write_text("")
    assert [s.name for s in find_sources(tmp_path)] == ["a"]
    assert [s.name for s in find_sources(tmp_path / "a.xml")] == ["a"]
    (tmp_path / "01_tracks.csv").write_text("")
    with pytest.raises(InputError, match="highD and CommonRoad files in one folder"):
        find_sources(tmp_path)
    assert [s.format.name for s in find_sources(tmp_path / "01_tracks.csv")] == ["highD"]
    (tmp_path / "notes.txt").write_text("")
    with pytest.raises(InputError, match=r"no recording; recordings are highD: XX_recordingMeta.csv"):
        find_sources(tmp_path / "notes.txt")


@pytest.mark.skipif(not US101.is_dir(), reason="the US-101 recordings are not here: ../shared/data/us101")
def test_us101(tmp_path: Path) -> None:
    """Real traffic at 10 Hz: facts hold, something is found, noise is reported."""
    outcome = run_experiment(Experiment(US101, tmp_path, default_settings()))
    told = json.loads((tmp_path / "results.json").read_text())
    assert outcome.totals.recordings == 8
    assert told["checks"]["broken"] == []
    assert all(row["matching"] > 0 for row in told["table"])
    assert any("overlap" in note for notes in told["notes"].values() for note in notes)


def test_questions_are_compiled_once(folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    asked, honest = [], module.compile_questions
    monkeypatch.setattr(module, "_compiled", {})
    monkeypatch.setattr(
        module,
        "compile_questions",
        lambda settings, *on: asked.append(on) or honest(settings, *on),
    )
    run_experiment(Experiment(folder, tmp_path, default_settings()))
    assert asked == [(25, ("main",))]


# --- Every command takes every format: one traffic in several of them gives one answer --------------

FORMATS = {"highD": "01_tracks.csv", "CSV": "01.csv", "Parquet": "01.parquet", "CommonRoad": "01.xml"}


@pytest.fixture(scope="module")
def folders(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """The same vehicles, which drive on lower lanes only, in each format; frames are counted from 0."""
    root = tmp_path_factory.mktemp("formats")
    recording = simulate(TrafficSettings(seconds=20, lane_width=3.5), seed=4)
    right = min(lane.d[0] for lane in recording.lanes if lane.direction == 2 and lane.d)
    for drive, frame in ((cut_in(), 20), (braking(), 250)):
        recording, _ = plant(recording, drive, PlantingPlace(2, frame, 6, 10.0, right))
    ours = keep_vehicles(recording, recording.direction == 2)
    shifted = dataclasses.replace(ours, first_frame=ours.first_frame - ours.first_frame.min())
    write_highd(shifted, root / "highD")
    read = read_highd(root / "highD", "01")
    path = write_samples(root / "CSV", "01", csv_of(read), toml_of(lower_road(read)))
    (root / "Parquet").mkdir()
    (root / "Parquet" / "01_road.toml").write_bytes(path.with_name("01_road.toml").read_bytes())
    pl.DataFrame(dict(read_columns(path).columns)).write_parquet(root / "Parquet" / "01.parquet")
    (root / "CommonRoad").mkdir()
    (root / "CommonRoad" / "01.xml").write_text(commonroad_of(read, lower_road(read)))
    return {name: root / name for name in FORMATS}


def evaluated(folder: Path, out: Path) -> list[str]:
    """Matches without the name of the recording, and without whether they are uncertain."""
    assert main(["evaluate", str(folder), "--out", str(out), "--no-pictures", "--jobs", "1"]) == 0
    lines = (out / "matches.csv").read_text().splitlines()
    return [line.partition(",")[2].rpartition(",")[0] for line in lines]


def test_evaluate(folders: dict[str, Path], tmp_path: Path) -> None:
    expected = evaluated(folders["highD"], tmp_path / "highD")
    assert len(expected) > 10
    for name, file in FORMATS.items():
        assert evaluated(folders[name] / file, tmp_path / f"{name}-file") == expected, name


def test_monitor(folders: dict[str, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A match of scenario 1 and one of 4, and what is not one, as an evaluation has them."""
    rows = list(csv.reader(evaluated(folders["highD"], tmp_path / "o")[1:]))
    chosen = [next(row for row in rows if row[6:9] == ["0.6", "base", number]) for number in ("1", "4")]
    capsys.readouterr()
    for sv, pov, _, lane, first, last, _, _, number, _ in chosen:
        for name, file in FORMATS.items():
            trace = f"{folders[name] / file}:{sv},{pov}"
            for asked, code in ((number, 0), (str(5 - int(number)), 10)):
                assert main(["monitor", asked, trace, "--frames", f"{first}-{last}", "--json", "-"]) in (
                    code,
                    20,
                )
                told = json.loads(capsys.readouterr().out)
                assert (told["verdict"] == "true") == (code == 0)
                assert told["lanes"]["L"] == lane


def test_coverage(folders: dict[str, Path]) -> None:
    basis = Basis(bundled_library().select())
    expected = list(disturbances_in(basis, recordings_in(folders["highD"])))
    assert any(trace.missed for trace in expected)
    assert not all(trace.missed for trace in expected)
    for name in ("CommonRoad", "CSV"):
        assert list(disturbances_in(basis, recordings_in(folders[name]))) == expected, name
