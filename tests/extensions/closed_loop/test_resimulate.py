"""A vehicle under test in place of recorded ones: the others move as the files say, and drives are judged."""

import csv
import json
import subprocess
import sys
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import roadproof as rp
from extensions.closed_loop.loops import VEHICLES
from roadproof.errors import InputError, UsageError
from roadproof.evidence.drive_file import load_drive
from roadproof.evidence.judged import judge_file
from roadproof.extensions.closed_loop.resimulation.occurrence import least_gap
from roadproof.extensions.closed_loop.resimulation.resimulating import Resimulated
from roadproof.extensions.closed_loop.simulation import VehicleSamples
from roadproof.frontends.cli.main import main
from roadproof.verdict import ExitCode
from roadproof.world.motion import state_at

US101 = Path(__file__).parents[4] / "shared" / "data" / "us101"
RATE, SEED = 25, 7
COLUMNS = ("x", "y", "width", "height")


@pytest.fixture(scope="session")
def recordings(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("recordings")
    rp.simulate(folder, seconds=60.0, seed=SEED, jobs=1)
    return folder


def resimulated(name: str, recordings: Path, **more: Any) -> Resimulated:
    asked = {"among": range(1, 9), "drivers": ["careful"], "jobs": 1, **more}
    return rp.resimulate(f"{VEHICLES}:{name}", recordings, **asked)


@pytest.fixture(scope="session")
def coasting(recordings: Path, tmp_path_factory: pytest.TempPathFactory) -> Resimulated:
    return resimulated("Speeding", recordings, out=tmp_path_factory.mktemp("coasting") / "out")


def rows_of(recordings: Path) -> dict[int, dict[int, dict[str, str]]]:
    """Return the rows of the recording by vehicle and frame, read from its file alone."""
    rows: dict[int, dict[int, dict[str, str]]] = {}
    with next(recordings.glob("*_tracks.csv")).open() as file:
        for row in csv.DictReader(file):
            rows.setdefault(int(row["id"]), {})[int(row["frame"])] = row
    return rows


def place(row: dict[str, str], way: int) -> tuple[float, float]:
    """Return places along and across the road, up to constants: x grows in direction 2, y grows down."""
    return way * float(row["x"]), -way * float(row["y"])


def test_others_move_as_the_file_says(coasting: Resimulated, recordings: Path) -> None:
    rows = rows_of(recordings)
    compared = 0
    for x in coasting.occurrences:
        assert x.drive is not None
        about, vehicles = x.occurrence, x.drive.file.drive.vehicles
        assert len(vehicles) == len(about.vehicles) + about.others
        numbers = {**about.vehicles, **{n: n[1:] for n in vehicles if n.startswith("V")}}
        first = about.first_frame
        way = 1 if float(rows[int(about.vehicles["SV"])][first]["xVelocity"]) > 0 else -1
        for name, number in numbers.items():
            if name == "SV":
                continue
            begin = np.array(place(rows[int(number)][first], way))
            for frame in range(first, first + int(about.seconds * RATE) + 1, 10):
                state = state_at(vehicles[name], Fraction(frame - first, RATE))
                moved = np.array(place(rows[int(number)][frame], way)) - begin
                mine = float(state.s - vehicles[name].s), float(state.d - vehicles[name].d)
                assert np.abs(moved - mine).max() <= about.deviation + 0.02
                compared += 1
    assert compared > 500
    assert 0 < max(x.occurrence.deviation for x in coasting.occurrences) < 0.05


def test_the_vehicle_under_test_begins_as_recorded(coasting: Resimulated, recordings: Path) -> None:
    rows = rows_of(recordings)
    for x in coasting.occurrences:
        assert x.drive is not None
        about, vehicles = x.occurrence, x.drive.file.drive.vehicles
        other = next(name for name in about.vehicles if name != "SV")
        me, its = (rows[int(about.vehicles[n])][about.first_frame] for n in ("SV", other))
        forward = float(me["xVelocity"]) > 0
        front = [float(r["x"]) + (float(r["width"]) if forward else 0.0) for r in (me, its)]
        apart = (front[1] - front[0]) * (1 if forward else -1)
        assert float(vehicles[other].s - vehicles["SV"].s) == pytest.approx(apart, abs=0.02)
        assert float(vehicles["SV"].v_lon) == pytest.approx(abs(float(me["xVelocity"])), abs=0.001)
        assert float(vehicles["SV"].length) == pytest.approx(float(me["width"]), abs=0.001)


def test_findings_are_judged_drives(coasting: Resimulated) -> None:
    assert {*coasting.findings.values()} == {"FAILS", "KEPT"}
    assert coasting.exit_code is ExitCode.UNEXPECTED
    assert coasting.folder is not None
    for x in coasting.occurrences:
        part = "breaks" if x.finding == "FAILS" else "keeps"
        file = load_drive(coasting.folder / f"{part}-{x.id}.json")
        assert judge_file(file, coasting.question.basis.library).accepted
        assert (x.gap == 0) == (x.finding == "FAILS")


def test_a_driver_model_drives_instead_of_a_controller_that_fails(coasting: Resimulated) -> None:
    judged = [x for x in coasting.view.failures if x.decisions]
    assert judged
    for x in judged:
        for decision in x.decisions:
            assert decision.driver == "careful"
            assert (decision.side == "preventable") <= ("careful" in x.driven)


def test_check_judges_all_drives_again(coasting: Resimulated, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", str(coasting.folder)]) == 0
    drives = sum(1 + len(x.driven) for x in coasting.occurrences)
    assert f"{drives} of {drives} accepted" in capsys.readouterr().out


def test_check_rejects_a_drive_with_another_motion(
    coasting: Resimulated, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert coasting.folder is not None
    for path in coasting.folder.glob("*.json"):
        (tmp_path / path.name).write_bytes(path.read_bytes())
    failing = coasting.view.failures[0]
    path = tmp_path / f"breaks-{failing.id}.json"
    data = json.loads(path.read_text())
    data["vehicles"]["SV"]["s"] = str(Fraction(data["vehicles"]["SV"]["s"]) - 500)
    path.write_text(json.dumps(data))
    assert main(["check", str(tmp_path)]) != 0
    assert "rejected" in capsys.readouterr().out


def boxes_of(rows: dict[int, dict[str, str]], first: int, steps: int) -> list[np.ndarray]:
    """Return x, y, width and height at steps of 0.1 s, on straight lines between frames."""
    frames = sorted(rows)
    at = first + np.arange(steps + 1) * 0.1 * RATE
    return [np.interp(at, frames, [float(rows[k][name]) for k in frames]) for name in COLUMNS]


def test_recorded_gaps_are_those_of_the_file(coasting: Resimulated, recordings: Path) -> None:
    rows, compared = rows_of(recordings), 0
    for x in coasting.occurrences:
        about, gaps = x.occurrence, list[float]()
        steps = int(about.seconds * 10)
        me, *others = (boxes_of(rows[int(n)], about.first_frame, steps) for n in about.vehicles.values())
        for other in others:
            for k in range(steps + 1):
                low, high = sorted(((b[0][k], b[2][k]) for b in (me, other)), key=lambda z: z[0])
                one, two = sorted(((b[1][k], b[3][k]) for b in (me, other)), key=lambda z: z[0])
                if two[0] < one[0] + one[1]:
                    gaps.append(high[0] - low[0] - low[1])
        assert (about.gap is None) == (not gaps)
        if gaps:
            assert about.gap == pytest.approx(min(gaps), abs=0.01)
            compared += 1
    assert compared > 3


def test_other_requirements_are_judged(recordings: Path) -> None:
    kept = resimulated("Coasting", recordings, require=("G v_lon(SV) >= 0 m/s",), drivers=[])
    assert {*kept.findings.values()} == {"KEPT"}
    assert kept.exit_code is ExitCode.AS_EXPECTED
    broken = resimulated("Coasting", recordings, require=("G v_lon(SV) >= 99 m/s",), drivers=[])
    assert {*broken.findings.values()} == {"FAILS"}


def test_the_same_bytes_with_one_and_two_processes(
    coasting: Resimulated, recordings: Path, tmp_path: Path
) -> None:
    again = resimulated("Speeding", recordings, out=tmp_path / "two", jobs=2, fresh=True)
    assert coasting.folder is not None
    assert again.folder is not None
    assert str(again) == str(coasting)
    for path in sorted(coasting.folder.glob("*-*.json")):
        assert (again.folder / path.name).read_bytes() == path.read_bytes()


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("NotANumber", "demand a finite number"),
        ("Raising", "ZeroDivisionError"),
        ("Fickle", "it is not deterministic"),
    ],
)
def test_a_controller_that_fails_to_answer_is_an_error(name: str, message: str, recordings: Path) -> None:
    answer = resimulated(name, recordings, among=[4])
    assert {*answer.findings.values()} == {"ERROR"}
    assert all(message in x.reason for x in answer.occurrences), answer.occurrences[0].reason
    assert answer.exit_code is ExitCode.UNKNOWN


def test_a_controller_that_ends_its_process_ends_no_other(recordings: Path) -> None:
    words = [sys.executable, "-m", "roadproof", "resimulate", f"{VEHICLES}:Dying", str(recordings)]
    words += ["--among", "4", "--drivers", "none", "--quiet"]
    ended = subprocess.run(words, capture_output=True, text=True, timeout=300, check=False)
    assert ended.returncode == ExitCode.UNKNOWN, ended.stderr
    assert ended.stdout.count("exited with 9") == ended.stdout.count("ERROR") > 1


def test_recordings_without_the_scenario_are_refused_by_name(recordings: Path) -> None:
    with pytest.raises(InputError, match="none of the scenarios 9 occurs in it"):
        resimulated("Coasting", recordings, among=[9])
    with pytest.raises(InputError, match="nowhere"):
        resimulated("Coasting", recordings / "nowhere")
    with pytest.raises(UsageError, match="takes at least one step"):
        resimulated("Coasting", recordings, seconds=0.05)
    with pytest.raises(UsageError, match="drivers=nobody"):
        resimulated("Coasting", recordings, drivers=["nobody"])


# --- drive files -----------------------------------------------------------------------------------


@pytest.fixture(scope="session")
def regression(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("regression") / "tests"
    found = rp.falsify(
        f"{VEHICLES}:LateBrake", among=[1, 4], classes=False, drivers=["careful"], simulations=200, jobs=1
    )
    assert len(found.view.failures) == 2
    found.write_tests(folder)
    return folder


def test_the_controller_that_failed_drives_its_tests_as_before(regression: Path) -> None:
    """Its drives are those of the files, fraction by fraction."""
    answer = resimulated("LateBrake", regression, among=None)
    assert answer.findings == {"failure_scenario_1": "FAILS", "failure_scenario_4": "FAILS"}
    for x in answer.occurrences:
        assert x.drive is not None
        file = load_drive(regression / f"{x.occurrence.recording}.json")
        assert x.drive.file.drive == file.drive
        assert x.occurrence.deviation == 0
        assert x.gap == x.occurrence.gap == 0
        assert x.shows == x.occurrence.scenarios
    one = resimulated("LateBrake", regression / "failure-scenario_4.json", among=None)
    assert [*one.findings] == ["failure_scenario_4"]


def test_another_controller_keeps_the_requirements_in_the_tests(regression: Path) -> None:
    answer = resimulated("HardBrake", regression, among=None)
    assert {*answer.findings.values()} == {"KEPT"}
    assert answer.exit_code is ExitCode.AS_EXPECTED
    assert [*resimulated("HardBrake", regression, among=[4]).findings] == ["failure_scenario_4"]


def test_drives_with_other_vehicles_are_refused_by_name(regression: Path, tmp_path: Path) -> None:
    text = (regression / "failure-scenario_4.json").read_text()
    (tmp_path / "a.json").write_text(text.replace('"POV"', '"truck"'))
    with pytest.raises(InputError, match="its vehicles are SV, truck; name them SV and POV"):
        resimulated("Coasting", tmp_path, among=None)
    with pytest.raises(InputError, match="none of the scenarios 9 occurs in it"):
        resimulated("Coasting", regression, among=[9])


def test_files_of_one_name_but_for_signs_have_ids_of_their_own(regression: Path, tmp_path: Path) -> None:
    for name in ("a-b.json", "a_b.json", "a b.json"):
        (tmp_path / name).write_bytes((regression / "failure-scenario_4.json").read_bytes())
    answer = resimulated("LateBrake", tmp_path, among=None, out=tmp_path / "out")
    assert sorted(answer.findings) == ["a_b", "a_b_2", "a_b_3"]
    written = {x.name for x in (tmp_path / "out").glob("breaks-*.json")}
    assert {f"breaks-{x}.json" for x in answer.findings} <= written


def random_tracks(random: np.random.Generator) -> Iterator[VehicleSamples]:
    for _ in range(2):
        s, d = random.uniform(0, 60, 9), random.uniform(-4, 4, 9)
        yield VehicleSamples(s, d, np.zeros(9), np.zeros(9), np.zeros(9))


def test_the_least_gap_is_that_of_boxes() -> None:
    """Against boxes one by one, on random places."""
    random = np.random.default_rng(5)
    for _ in range(300):
        me, other = random_tracks(random)
        gaps = []
        for k in range(9):
            mine = (me.s[k] - 4.5, me.s[k]), (me.d[k] - 2.0, me.d[k])
            its = (other.s[k] - 9.0, other.s[k]), (other.d[k] - 2.5, other.d[k])
            if its[1][0] < mine[1][1] and mine[1][0] < its[1][1]:
                behind, ahead = sorted((mine[0], its[0]), key=lambda x: x[1])
                gaps.append(max(ahead[0] - behind[1], 0.0))
        expected = round(min(gaps), 3) if gaps else None
        assert least_gap({"SV": me, "POV": other}, {"SV": (4.5, 2.0), "POV": (9.0, 2.5)}) == expected


def test_a_page_plays_the_failing_drives(coasting: Resimulated, tmp_path: Path) -> None:
    page = tmp_path / "page.html"
    assert main(["report", str(coasting.folder), "--out", str(page)]) == 0
    text = page.read_text()
    assert "What would it have done?" in text
    for x in coasting.occurrences:
        assert x.id in text


@pytest.mark.skipif(not US101.is_dir(), reason="../shared/data/us101 is not here")
def test_recorded_traffic_of_us101() -> None:
    """Tracks that jump are followed, too; every drive is judged and can be read again."""
    answer = rp.resimulate(
        f"{VEHICLES}:Speeding", US101 / "USA_US101-25_2_T-1.xml", drivers=["careful"], jobs=1
    )
    assert {*answer.findings.values()} <= {"FAILS", "KEPT"}
    assert max(x.occurrence.deviation for x in answer.occurrences) < 0.5
