"""Traffic, simulated and evaluated, through both doors."""

import csv
import json
from pathlib import Path

import pytest

import roadproof as rp
from api.doors import tell
from roadproof.frontends.api.recordings import Evaluation
from roadproof.frontends.api.simulating import Simulation


@pytest.fixture(scope="module")
def simulated(tmp_path_factory: pytest.TempPathFactory) -> Simulation:
    drives = rp.witness(1, 4, jobs=1).drives
    told: list[str] = []
    folder = tmp_path_factory.mktemp("traffic")
    made = rp.simulate(folder / "sim", seconds=40, seed=7, plant=drives, jobs=1, tell=told.append)
    assert told == ["[1/1] recording 01"]
    return made


@pytest.fixture(scope="module")
def evaluated(simulated: Simulation) -> Evaluation:
    return rp.evaluate(simulated.folder, among="1-4", detectors=False, jobs=1)


def test_simulated_traffic_is_that_of_the_command_line(simulated: Simulation, tmp_path: Path) -> None:
    rp.witness(1, 4, jobs=1).save(tmp_path / "drives", pictures=False)
    line = ["simulate", "--out", str(tmp_path / "sim"), "--seconds", "40", "--seed", "7"]
    code, text, _ = tell([*line, "--plant", str(tmp_path / "drives")])
    assert (code, f"{len(simulated.planted)} drives planted" in text) == (0, True)
    for file in simulated.folder.iterdir():
        assert file.read_bytes() == (tmp_path / "sim" / file.name).read_bytes()
    with (simulated.folder / "planted.csv").open() as planted:
        rows = [tuple(row) for row in csv.reader(planted)]
    frame = simulated.to_frame()
    assert tuple(frame.columns) == rows[0]
    assert [tuple("" if x is None else str(x) for x in row) for row in frame.rows()] == rows[1:]


def test_traffic_is_evaluated_as_by_the_command_line(
    simulated: Simulation, evaluated: Evaluation, tmp_path: Path
) -> None:
    line = ["evaluate", str(simulated.folder), "--out", str(tmp_path), "--among", "1-4", "--no-detectors"]
    code, text, _ = tell([*line, "--no-pictures"])
    told = (tmp_path / "answers.md", tmp_path / "results.json", tmp_path / "matches.csv")
    assert all(path.is_file() for path in told)
    assert evaluated.exit_code == code == 0
    assert str(evaluated).strip() == text.replace(f" in {told[0]}", "").strip()
    data = json.loads(tell([*line, "--no-pictures", "--json", "-"])[1])
    assert json.loads(json.dumps(evaluated.as_data())) == data
    with told[2].open() as matches:
        assert evaluated.matches().height == len([*csv.reader(matches)]) - 1


def test_frames_of_traffic(simulated: Simulation, evaluated: Evaluation) -> None:
    results, matches, pairs = evaluated.to_frame(), evaluated.matches(), evaluated.pairs()
    counts = ["traces", "matching", "recall", "s1", "s2", "s3", "s4"]
    assert results.columns == ["sector", "minDanger", "set", *counts]
    assert results.height == 6
    for row in results.rows(named=True):
        of_row = pairs.filter(minDanger=row["minDanger"])
        assert (of_row.height, of_row[row["set"]].sum()) == (row["traces"], row["matching"])
    planted = {(x.sv, x.pov, x.scenario) for x in simulated.planted}
    assert planted <= {*zip(matches["SV"], matches["POV"], matches["scenario"], strict=True)}
    assert evaluated.folder is None
    assert repr(evaluated) == "<Evaluated: 1 recordings, 6 rows>"
    assert evaluated._repr_html_().startswith("<pre>Disturbance")
    assert evaluated.plot().png.startswith(b"\x89PNG")


def test_a_pair_of_a_recording(simulated: Simulation) -> None:
    row = simulated.to_frame().filter(scenario=4).row(0, named=True)
    on = f"{simulated.folder}/01_tracks.csv:{row['sv']},{row['pov']}"
    frames = (row["start_frame"], row["end_frame"])
    found = rp.monitor(4, on, frames=frames)
    line = ["monitor", "4", on, "--frames", f"{frames[0]}-{frames[1]}"]
    assert str(found) == tell(line)[1].strip()
    assert found.verdict == "true"


def test_answers_are_asked_again(tmp_path: Path) -> None:
    rp.simulate(tmp_path / "sim", seconds=10, flow=2000, seed=7, jobs=1)
    asked = {"using": rp.load("base"), "among": "3-4", "min_danger": (0,), "detectors": False, "jobs": 1}
    told: list[str] = []
    found = rp.evaluate(tmp_path / "sim", tmp_path / "out", check=True, tell=told.append, **asked)
    assert told[-1] == "checked 01: 0 answers denied"
    assert (found.denied, found.folder) == ((), tmp_path / "out")
    assert (tmp_path / "out" / "results.json").is_file()
