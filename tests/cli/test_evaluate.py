"""roadproof evaluate and simulate: whole runs, kills, bad data, planted drives, and what is refused."""

import csv
import json
import shutil
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import pytest

from roadproof.frontends.cli.main import main
from roadproof.recordings.evaluate import results
from roadproof.recordings.formats.write_highd import write_highd
from roadproof.recordings.simulate.synthetic import simulate
from roadproof.recordings.simulate.traffic import Traffic

ROADPROOF = Path(sys.executable).parent / "roadproof"
TABLES = {f"{x}.{e}" for x in ("results", "comparison") for e in ("txt", "md", "csv", "tex")}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("recordings")
    for number in (1, 2, 3):
        write_highd(simulate(Traffic(seconds=20, lane_width=3.5), seed=6, number=number), path)
    return path


def contents(out: Path) -> dict[str, bytes]:
    """Every file below ``out``, hidden ones too."""
    return {str(p.relative_to(out)): p.read_bytes() for p in sorted(out.rglob("*")) if p.is_file()}


@pytest.fixture(scope="module")
def undisturbed(folder: Path, tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    out = tmp_path_factory.mktemp("undisturbed")
    assert main(["evaluate", str(folder), "--out", str(out), "--jobs", "1", "--no-pictures"]) == 0
    return contents(out)


def test_what_is_written(undisturbed: dict[str, bytes]) -> None:
    recordings = {f"recordings/{x}.json" for x in ("01", "02", "03")}
    others = {"matches.csv", "pairs.csv", "results.json", "answers.md"}
    assert set(undisturbed) == TABLES | recordings | others
    header = undisturbed["matches.csv"].decode().splitlines()[0]
    assert (
        header == "recording,sv,pov,pov2,lane,start_frame,end_frame,min_danger,set,scenario,title,uncertain"
    )
    told = json.loads(undisturbed["results.json"])
    rows = list(csv.DictReader(undisturbed["results.csv"].decode().splitlines()))
    ours = [row for row in rows if row["data"] == "here"]
    assert len(ours) == len(rows) / 2 == 6
    for row, counted in zip(ours, told["table"], strict=True):
        assert (row["set"], int(row["traces"])) == (counted["set"], counted["traces"])
        assert {f"s{i}": str(n) for i, n in counted["scenarios"].items()}.items() <= row.items()
    assert sum(int(row["traces"]) for row in ours) > 0


def test_runs_that_divide_the_recordings_end_with_the_same_bytes(
    folder: Path, undisturbed: dict[str, bytes], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    command = ["evaluate", str(folder), "--out", str(tmp_path), "--jobs", "1", "--no-pictures"]
    assert main([*command, "--shard", "1/2"]) == 0
    assert {x.stem for x in tmp_path.glob("recordings/*")} == {"01", "03"}
    assert "shard 1/2 is done: 2 of 2 recordings" in capsys.readouterr().err
    assert main([*command, "--shard", "2/2"]) == 0
    assert main(command) == 0
    assert "3 of 3 recordings are already evaluated" in capsys.readouterr().err
    assert contents(tmp_path) == undisturbed


@pytest.mark.parametrize("moment", [0.9, 1.6, 2.4])
def test_killed_for_good_and_started_again(
    moment: float, folder: Path, undisturbed: dict[str, bytes], tmp_path: Path
) -> None:
    """SIGKILL leaves no time to tidy up; wherever it strikes, the next run ends with the same bytes."""
    command = [
        str(ROADPROOF),
        "evaluate",
        str(folder),
        "--out",
        str(tmp_path),
        "--jobs",
        "1",
        "--no-pictures",
    ]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    time.sleep(moment)
    process.send_signal(signal.SIGKILL)
    process.wait()
    (tmp_path / "recordings").mkdir(exist_ok=True)
    (tmp_path / "recordings" / ".02.json.ab_d3f9h").write_text("{")  # as a kill inside a write leaves
    assert main(command[1:]) == 0
    assert contents(tmp_path) == undisturbed


def test_figures_are_the_same_bytes_again(folder: Path, tmp_path: Path) -> None:
    one, other = tmp_path / "one", tmp_path / "other"
    for out in (one, other):
        assert main(["evaluate", str(folder), "--out", str(out), "--jobs", "1", "--set", "base"]) == 0
    assert contents(one) == contents(other)
    assert sum(name.startswith("figures/") for name in contents(one)) == 6


def test_a_violated_fact_is_a_crosscheck_failure(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Matches of ext are lost between the monitor and the tables: exit 30, and it is said which."""
    add = results.add_findings

    def loses(totals: results.Totals, findings: results.Findings) -> None:
        kept = tuple(x for x in findings.matches if x.set_name != "ext")
        add(totals, replace(findings, matches=kept))

    monkeypatch.setattr(results, "add_findings", loses)
    assert main(["evaluate", str(folder), "--out", str(tmp_path), "--jobs", "1", "--no-pictures"]) == 30
    said = capsys.readouterr().out
    assert "CROSSCHECK-FAILED" in said
    assert "does not match as much in ext" in said
    assert "CROSSCHECK-FAILED" in (tmp_path / "answers.md").read_text()


def test_the_check_denies_a_wrong_answer(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """--check agrees with what was found, and denies a match and a gap that were put there by hand."""
    ours = tmp_path / "ours"
    ours.mkdir()
    for path in folder.glob("01_*"):
        shutil.copy2(path, ours)
    command = ["evaluate", str(ours), "--out", str(tmp_path / "out"), "--jobs", "1", "--no-pictures"]
    command += [
        "--check",
        "--set",
        "base",
        "--min-danger",
        "0",
        "--no-detectors",
        "--among",
        "1,scenario_4,6",
    ]
    assert main(command) == 0
    saved = tmp_path / "out" / "recordings" / "01.json"
    told = json.loads(saved.read_text())
    match = next(m for m in told["findings"]["matches"] if m[2] is None)
    told["findings"]["matches"].remove(match)
    told["findings"]["matches"].append([*match[:-2], 6 if match[-2] != 6 else 1, match[-1]])
    told["seal"] = results.seal(told["fingerprint"], told["findings"])
    saved.write_text(json.dumps(told))
    capsys.readouterr()
    assert main(command) == 30
    said = capsys.readouterr().out
    assert "found, but the recursive evaluator denies it" in said
    assert "missed, but the recursive evaluator has it" in said


def test_a_bad_recording(folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    ours = tmp_path / "ours"
    shutil.copytree(folder, ours)
    (ours / "02_tracks.csv").write_bytes((folder / "02_tracks.csv").read_bytes()[:-700])
    command = ["evaluate", str(ours), "--out", str(tmp_path / "out"), "--jobs", "1", "--no-pictures"]
    assert main(command) == 3
    assert "02_tracks" in capsys.readouterr().err
    assert not (tmp_path / "out" / "results.txt").exists()
    assert main([*command, "--keep-going"]) == 0
    printed = capsys.readouterr()
    assert "WARNING: 1 recordings could not be used and are left out: 02." in printed.out
    assert "skipped recording 02" in printed.err
    for name in ("results.txt", "comparison.md", "results.tex", "answers.md"):
        assert "WARNING" in (tmp_path / "out" / name).read_text()


@pytest.mark.parametrize(
    ("options", "code", "said"),
    [
        (["--min-danger", "0,zwei"], 2, "--min-danger zwei: write seconds"),
        (["--min-danger", "0,0"], 2, "each once"),
        (["--min-danger", "0.61"], 3, "no multiple of the time step"),
        (["--min-safe", "-1"], 2, "--min-safe -1"),
        (["--set", "base,exd"], 3, "did you mean 'ext'"),
        (["--set", "base,,ext"], 2, "separated by commas"),
        (["--set", "base", "--set", "base"], 2, "a spec set is repeated"),
        (["--among", "1-x"], 2, "is not a range of scenarios"),
        (["--among", "25"], 3, "there is no scenario '25'"),
        (["--sets", "base"], 2, "unrecognized arguments"),
        (["--param", "minDanger=1"], 2, "use --min-danger"),
        (["--param", "rho=fast"], 3, "this is no value"),
        (["--option", "lateral_sign=left"], 3, "must be rss or literal"),
        (["--jobs", "0"], 2, "--jobs 0: write a whole number greater than 0"),
        (["--end", "middle"], 2, "invalid choice"),
    ],
)
def test_refusals(
    options: list[str], code: int, said: str, folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["evaluate", str(folder), "--out", str(tmp_path / "out"), "--jobs", "1", *options]) == code
    message = capsys.readouterr().err
    assert said in message
    assert "Traceback" not in message
    assert not (tmp_path / "out" / "results.txt").exists()


def test_planted_drives_are_found(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Both directions: right pair, roles, lane, frames and scenario, in the set and in the wider ones."""
    traffic, out = tmp_path / "traffic", tmp_path / "out"
    made = ["simulate", "--out", str(traffic), "--seconds", "40", "--seed", "4", "--plant", "1-2,4,8"]
    assert main([*made, "--jobs", "1"]) == 0
    assert main(["evaluate", str(traffic), "--out", str(out), "--jobs", "1", "--no-pictures"]) == 0
    planted = list(csv.DictReader((traffic / "planted.csv").open()))
    found = list(csv.DictReader((out / "matches.csv").open()))
    assert list(planted[0]) == list(found[0])[:-1]
    assert {row["scenario"] for row in planted} == {"1", "2", "4", "8"}
    assert {row["lane"] for row in planted} == {"2", "8"}  # the rightmost lane of each direction
    assert 4 <= len(planted) <= 10
    for row in planted:
        for set_name in ("base", "extA", "ext"):
            assert {**row, "set": set_name, "uncertain": "0"} in found


def test_simulate_is_what_its_seed_says(tmp_path: Path) -> None:
    for name, seed in (("a", "5"), ("b", "5"), ("c", "6")):
        command = [
            "simulate",
            "--out",
            str(tmp_path / name),
            "--seconds",
            "15",
            "--seed",
            seed,
            "--lanes",
            "2",
        ]
        assert main([*command, "--jobs", "1"]) == 0
    assert contents(tmp_path / "a") == contents(tmp_path / "b") != contents(tmp_path / "c")
    assert set(contents(tmp_path / "a")) == {f"01_{x}.csv" for x in ("recordingMeta", "tracksMeta", "tracks")}


@pytest.mark.parametrize(
    ("options", "code", "said"),
    [
        (["--seconds", "0"], 2, "--seconds 0: write a decimal number greater than 0"),
        (["--lanes", "7"], 2, "lanes=7"),
        (["--recordings", "0"], 2, "--recordings 0: write a whole number greater than 0"),
        (["--seed", "-3"], 2, "--seed -3"),
        (["--plant", "9"], 2, "scenarios from 1 to 8"),
        (["--plant", "nowhere.json"], 3, "cannot read nowhere.json"),
    ],
)
def test_simulate_refuses(
    options: list[str], code: int, said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["simulate", "--out", str(tmp_path / "out"), *options]) == code
    assert said in capsys.readouterr().err


def test_drives_that_cannot_be_planted(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "none").mkdir()
    command = ["simulate", "--out", str(tmp_path / "out"), "--seconds", "20", "--plant"]
    assert main([*command, str(tmp_path / "none")]) == 3
    assert "holds no drive files" in capsys.readouterr().err
    (tmp_path / "none" / "x.json").write_text("{}")
    assert main([*command, str(tmp_path / "none")]) == 3
    assert "'schema' is missing" in capsys.readouterr().err
