"""One trace, whatever it is given as: the same answer, and that of the command line."""

import ast
import csv
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import polars
import pytest

import roadproof as rp
from api.both_interfaces import tell
from console import agree, sessions_of
from pages import Example, examples_of, rewritten, run
from roadproof.evidence.judged import JudgedDrive
from roadproof.extensions.traffic.answers.monitor import OverrideData
from roadproof.extensions.traffic.evaluating import Evaluation
from roadproof.extensions.traffic.monitoring import MonitorAnswer
from roadproof.extensions.traffic.simulating import Simulation

pytestmark = pytest.mark.usefixtures("searched_once")

MARGIN = "s(POV) - s(SV) > 10 m"


@pytest.fixture(scope="module")
def drive() -> JudgedDrive:
    [found] = rp.witness(4, jobs=1).drives
    return found


@pytest.fixture(scope="module")
def here(drive: JudgedDrive, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("drives")
    rp.witness(4, jobs=1).save(folder, pictures=False)
    return folder


@pytest.fixture(scope="module")
def frame(here: Path) -> polars.DataFrame:
    return polars.read_csv(here / "scenario-04-base.csv")


def as_told(found: MonitorAnswer, source: str) -> dict[str, Any]:
    """The data of an answer, as if the trace had come from ``source``."""
    return json.loads(json.dumps({**found.as_data(), "trace": source}))  # type: ignore[no-any-return]


@pytest.mark.parametrize("what", ["4", "F danger(SV,POV)", MARGIN, "G aheadOf(SV,POV)"])
def test_a_drive(what: str, drive: JudgedDrive, here: Path) -> None:
    path = str(here / "scenario-04-base.json")
    code, text, _ = tell(["monitor", what, path])
    data = json.loads(tell(["monitor", what, path, "--json", "-"])[1])
    by_path = rp.monitor(what, path)
    assert str(by_path) == text.strip()
    assert by_path.as_data() == data
    assert by_path.exit_code == code
    assert by_path.verdict == data["verdict"]
    for on in (drive, drive.file):
        assert as_told(rp.monitor(what, on), path) == data


def test_a_sampled_drive(drive: JudgedDrive, here: Path) -> None:
    path = str(here / "scenario-04-base.json")
    line = ["monitor", "4", path, "--view", "recorded", "--dt", "1/10", "--end", "clip", "--json", "-"]
    found = rp.monitor(4, drive, view="recorded", dt="1/10", end="clip")
    assert as_told(found, path) == json.loads(tell(line)[1])


def test_what_is_overruled_is_told(drive: JudgedDrive, here: Path) -> None:
    line = ["monitor", "4", str(here / "scenario-04-base.json"), "--set", "ext", "--param", "rho=1"]
    found = rp.monitor(4, drive, rp.load("ext", params={"rho": 1}))
    assert OverrideData(what="parameter rho", asked="1", said="3/5") in found.place.overruled
    assert OverrideData(what="set", asked="ext", said="base") in found.place.overruled
    text = tell(line)[1].strip().replace(str(here / "scenario-04-base.json"), "drive")
    assert str(found) == text


@pytest.mark.parametrize("what", ["4", "F danger(SV,POV)", MARGIN])
def test_samples_as_columns_of_any_kind(what: str, here: Path, frame: polars.DataFrame) -> None:
    path = here / "scenario-04-base.csv"
    data = json.loads(tell(["monitor", what, str(path), "--lane", "main-1", "--json", "-"])[1])
    arrays = {name: frame[name].to_numpy() for name in frame.columns}
    mixed = dict(reversed([(name, list(values)) for name, values in arrays.items()]))
    lanes = {"L": "main-1"} if data["lanes"] else None
    for on in (path, str(path), frame, frame.sort("time", "vehicle"), arrays, mixed, rp.trace(arrays)):
        assert as_told(rp.monitor(what, on, lanes=lanes), str(path)) == data
    assert rp.monitor(what, arrays).place.trace == "columns"


def test_samples_as_a_frame_of_pandas(here: Path, frame: polars.DataFrame) -> None:
    pandas = pytest.importorskip("pandas", reason="pandas is not installed")
    table = pandas.DataFrame({name: frame[name].to_list() for name in frame.columns})
    assert rp.monitor(4, table).as_data() == rp.monitor(4, frame).as_data()


def test_a_trace_of_ones_own() -> None:
    """Two cars at constant speed: SV is 40 m behind and 10 m/s faster, so they meet after 4 s."""
    time = np.repeat(np.arange(0, 3, 0.1), 2)
    first = np.tile([True, False], 30)
    columns: Mapping[str, Any] = {
        "time": time,
        "vehicle": np.where(first, "SV", "POV"),
        "s": np.where(first, 30 * time, 44 + 20 * time),
        "d": np.full(60, 3.0),
        "v_lon": np.where(first, 30, 20),
        **dict.fromkeys(("v_lat", "a_lon", "a_lat"), np.zeros(60)),
        "length": np.full(60, 4.0),
        "width": np.full(60, 2.0),
    }
    found = rp.monitor("s(POV) - s(SV) > 24 m", columns)
    assert found.verdict == "true"
    assert found.robustness == pytest.approx((20, 20))
    [strip] = found.to_frame().rows(named=True)
    assert (strip["verdict"], strip["begin"]) == ("true", 0)
    assert strip["end"] == pytest.approx(1.9)
    assert rp.monitor("s(POV) - s(SV) > 44 m", columns).exit_code == 10
    assert rp.monitor("F (v_lon(SV) < 1 m/s)", columns).verdict == "undecided"
    assert rp.monitor("F (v_lon(SV) < 1 m/s)", columns, end="clip").verdict == "false"


def test_what_it_can_do(drive: JudgedDrive) -> None:
    found = rp.monitor(4, drive)
    assert repr(found) == "<Monitored: true>"
    assert found.plot().png.startswith(b"\x89PNG")
    frame = found.to_frame()
    assert frame.columns == ["part", "verdict", "begin", "end"]
    assert frame["part"][0] == "scenario_4(SV, POV, L)"
    shown = rp.monitor("s(SV) < s(POV)", drive)._repr_html_()
    assert "s(SV) &lt; s(POV)" in shown
    assert "s(SV) < s(POV)" not in shown


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"s": None}, "there is no column s; columns are time, vehicle, s, d"),
        ({"s": [1.0]}, "columns must be equally long"),
        ({"v_lon": [float("nan")] * 4}, "row 0, column v_lon=nan: a finite number is needed"),
        ({"time": [0, 0, 1, 1.5]}, "use equal steps"),
        ({"length": [4, 4, 5, 4]}, "length of SV changes; the size of a vehicle stays the same"),
        ({"vehicle": ["SV", "POV", "SV", "car"]}, "every vehicle needs exactly one row at every time"),
    ],
)
def test_columns_that_are_no_trace(change: dict[str, Any], told: str) -> None:
    columns: dict[str, Any] = {
        "time": [0, 0, 1, 1],
        "vehicle": ["SV", "POV"] * 2,
        **dict.fromkeys(("s", "d", "v_lon", "v_lat", "a_lon", "a_lat"), [1.0] * 4),
        **dict.fromkeys(("length", "width"), [4] * 4),
    }
    rp.trace(columns)
    changed = {name: x for name, x in {**columns, **change}.items() if x is not None}
    with pytest.raises(rp.InputError) as raised:
        rp.trace(changed)
    assert told in str(raised.value)
    with pytest.raises(rp.InputError, match="has no named columns: give a mapping of arrays, or a frame"):
        rp.trace(3)  # type: ignore[arg-type]


# --- Traffic, simulated and evaluated, through both doors -------------------------------------------


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
    counts = ["traces", "matching", "uncertain", "possible", "recall", "s1", "s2", "s3", "s4"]
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


# --- The examples in Python: scripts are run by their README (tests/cli/test_book.py), the notebook here

HERE = Path(__file__).parents[2] / "examples/python"
SCRIPTS = sorted(HERE.glob("*.py"))
NOTEBOOK = HERE / "first_steps.ipynb"


def test_the_page_runs_every_script() -> None:
    sessions = sessions_of((HERE / "README.md").read_text("utf-8"))
    assert {x.command for x in sessions} == {f"python {script.name}" for script in SCRIPTS}
    assert all(len(x.expected) > 5 for x in sessions)


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda x: x.stem)
def test_scripts_are_short(script: Path) -> None:
    source = script.read_text("utf-8")
    assert len(source.splitlines()) <= 60
    assert ast.get_docstring(ast.parse(source))


def cells() -> list[dict[str, Any]]:
    notebook: dict[str, Any] = json.loads(NOTEBOOK.read_text("utf-8"))
    assert (notebook["nbformat"], notebook["nbformat_minor"]) == (4, 5)
    found: list[dict[str, Any]] = notebook["cells"]
    return found


def test_the_notebook_is_well_formed() -> None:
    assert len({cell["id"] for cell in cells()}) == len(cells())
    for cell in cells():
        code = cell["cell_type"] == "code"
        expected = {"cell_type", "id", "metadata", "source"} | (
            {"execution_count", "outputs"} if code else set()
        )
        assert {*cell} == expected
        assert not code or (cell["execution_count"], cell["outputs"]) == (None, [])


def test_the_notebook_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    space: dict[str, Any] = {}
    shown: dict[str, Any] = {}
    for cell in cells():
        if cell["cell_type"] == "code":
            *lines, last = ast.parse("".join(cell["source"])).body
            exec(compile(ast.Module(lines, []), cell["id"], "exec"), space)
            if isinstance(last, ast.Expr):
                shown[cell["id"]] = eval(compile(ast.Expression(last.value), cell["id"], "eval"), space)
            else:
                exec(compile(ast.Module([last], []), cell["id"], "exec"), space)
    assert [*shown["prove"].verdicts.values()] == [rp.Verdict.PROVED, rp.Verdict.REFUTED]
    assert all(shown[name].png.startswith(b"\x89PNG") for name in ("refuted", "witness", "heat-map"))
    assert shown["monitor"]["verdict"][0] == "true"
    assert shown["overlap"]["verdict"].to_list() == ["WITNESSED"]
    assert all({*map(str, counts)} == {"accepted"} for counts in shown["check"])


def test_the_notebook_runs_as_readers_run_it(tmp_path: Path) -> None:
    nbformat = pytest.importorskip("nbformat", reason="nbformat is not installed")
    nbclient = pytest.importorskip("nbclient", reason="nbclient is not installed")
    notebook = nbformat.read(NOTEBOOK, as_version=4)
    nbformat.validate(notebook)
    nbclient.NotebookClient(notebook, resources={"metadata": {"path": str(tmp_path)}}).execute()


# --- Pages of the documentation: what they show of Python is typed in, and prints what they say -----

ROOT = Path(__file__).parents[2]
PAGES = [
    ROOT / "docs/reference/python.md",
    ROOT / "docs/how-to/jupyter.md",
    ROOT / "docs/how-to/c.md",
    ROOT / "README.md",
    *sorted(Path(__file__).parent.joinpath("book").glob("*.md")),
]


@pytest.mark.parametrize("path", PAGES, ids=lambda x: x.stem)
def test_page(path: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {}
    found = [*examples_of(path.read_text("utf-8"))]
    assert found
    for example in found:
        printed = run(example, names)
        told = f"{path.name}:{example.line}: {example.source}" + "\n".join(printed)
        assert agree(printed, example.expected), told


def test_a_difference_is_noticed() -> None:
    page = "```pycon\n>>> x = [\n...     1]\n>>> x\n[2]\n>>> 1 / 0\nZeroDivisionError: …\n```\n"
    first, second, third = examples_of(page)
    assert first == Example("x = [\n    1]\n", (), 2)
    names: dict[str, Any] = {}
    assert run(first, names) == []
    assert not agree(run(second, names), second.expected)
    assert agree(run(third, names), third.expected)
    assert rewritten(page) == page.replace("[2]", "[1]").replace("…", "division by zero")
