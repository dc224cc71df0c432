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
from typing import Any

import pytest

from extensions.traffic.faults import plant_fault
from roadproof.evidence.drive_file import load_drive
from roadproof.extensions.traffic import monitoring as traces
from roadproof.extensions.traffic.evaluate import results, totals
from roadproof.extensions.traffic.evaluate.evaluate import evaluate_recording
from roadproof.extensions.traffic.evaluate.questions import compile_questions, default_settings
from roadproof.extensions.traffic.formats.highd import read_highd
from roadproof.extensions.traffic.formats.write_highd import write_highd
from roadproof.extensions.traffic.simulate.simulate import simulate
from roadproof.extensions.traffic.simulate.traffic import TrafficSettings
from roadproof.frontends.cli.main import main
from roadproof.frontends.report.samples import csv_of

ROADPROOF = Path(sys.executable).parent / "roadproof"
TABLES = {f"{x}.{e}" for x in ("results", "comparison") for e in ("txt", "md", "csv", "tex")}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("recordings")
    for number in (1, 2, 3):
        write_highd(simulate(TrafficSettings(seconds=20, lane_width=3.5), seed=6, number=number), path)
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
    add = totals.add_findings

    def loses(sums: totals.Totals, findings: results.Findings) -> None:
        kept = tuple(x for x in findings.matches if x.set_name != "ext")
        add(sums, replace(findings, matches=kept))

    monkeypatch.setattr(totals, "add_findings", loses)
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
        (["--among", "25"], 3, "there is no scenario 25"),
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


# --- roadproof monitor: drives, samples and vehicles of recordings; verdicts, parts, exit codes, refusals

ROAD = {
    "name": "main-2",
    "lanelets": [
        {"id": f"m{k}", "lane": f"main-{k}", "zone": "main", "attribute": "main", "s": [None, None], "d": d}
        for k, d in ((1, ["0", "7/2"]), (2, ["7/2", "7"]))
    ],
    "adjacent": [["main-1", "main-2"]],
}


def vehicle(s: str, d: str, v: str, *pieces: tuple[str | None, str]) -> dict[str, Any]:
    made = [{"duration": t, "a_lon": a, "a_lat": "0"} for t, a in pieces]
    box = {"length": "9/2", "width": "9/5", "s": s, "d": d, "v_lon": v, "v_lat": "0"}
    return {**box, "pieces": made}


@pytest.fixture
def drive(tmp_path: Path) -> Path:
    """POV brakes from 28 to 20 m/s ahead of SV at 29 m/s, in one lane: scenario 4."""
    data = {
        "schema": "roadproof/drive/1",
        "scenario": 4,
        "set": "base",
        "formula": "scenario_4(SV, POV, L)",
        "horizon": "4",
        "lane": "main-1",
        "parameters": {"minDanger": "3/5"},
        "road": ROAD,
        "vehicles": {
            "SV": vehicle("5", "13/5", "29", (None, "0")),
            "POV": vehicle("80", "14/5", "28", ("2", "-4"), (None, "0")),
        },
    }
    path = tmp_path / "drive.json"
    path.write_text(json.dumps(data))
    return path


def asked(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> tuple[int, dict[str, Any]]:
    code = main(["monitor", *arguments, "--json", "-"])
    return code, json.loads(capsys.readouterr().out)


def test_a_drive_is_judged_in_dense_time(drive: Path, capsys: pytest.CaptureFixture[str]) -> None:
    code, told = asked(["4", str(drive)], capsys)
    assert (code, told["verdict"], told["view"], told["lanes"]["L"]) == (0, "true", "dense", "main-1")
    assert told["schema"] == "roadproof/monitor/2"
    assert told["robustness"] == [pytest.approx(0.2), pytest.approx(0.2)]  # POV is 0.2 m left of SV
    parts = {part["formula"]: part for part in told["parts"]}
    assert parts["laneKeep(SV, main-1)"]["true"] == [[0.0, None]]
    [[begin, end]] = parts["rssViolation(SV, POV)"]["true"]
    assert 0.6 < begin < 4
    assert parts["instSafe(SV, POV)"]["true"][0][1] == pytest.approx(begin)
    assert end is None or end > begin


@pytest.mark.parametrize(
    ("formula", "code", "verdict"),
    [
        ("v_lon(POV) >= 20 m/s", 0, "true"),
        ("G v_lon(SV) > 28 m/s", 0, "true"),
        ("scenario_3(SV, POV, L)", 10, "false"),
        ("F v_lon(POV) < 20 m/s", 10, "false"),
    ],
)
def test_verdicts_and_exit_codes_on_a_drive(
    formula: str, code: int, verdict: str, drive: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    found, told = asked([formula, str(drive)], capsys)
    assert (found, told["verdict"]) == (code, verdict)


@pytest.mark.parametrize(
    ("formula", "code", "verdict", "clipped"),
    [
        ("scenario_4(SV, POV, L)", 0, "true", "true"),
        ("G v_lon(SV) > 28 m/s", 20, "undecided", "true"),
        ("F v_lon(SV) > 30 m/s", 20, "undecided", "false"),
        ("F[0,2] v_lon(SV) > 30 m/s", 10, "false", "false"),
        ("initSafe(POV, SV)", 0, "true", "true"),
    ],
)
def test_samples_end(
    formula: str, code: int, verdict: str, clipped: str, drive: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The same trace by --view recorded and from CSV: three answers, and clip beside them."""
    samples = drive.with_suffix(".csv")
    samples.write_text(csv_of(load_drive(drive)))
    for trace in ([str(drive), "--view", "recorded"], [str(samples)]):
        found, told = asked([formula, *trace], capsys)
        assert (found, told["verdict"], told["under_the_other_end"]) == (code, verdict, clipped)
        _, told = asked([formula, *trace, "--end", "clip"], capsys)
        assert (told["verdict"], told["under_the_other_end"]) == (clipped, verdict)


def test_parts_of_samples(drive: Path, capsys: pytest.CaptureFixture[str]) -> None:
    _, told = asked(["initSafe(SV, POV)", str(drive), "--view", "recorded"], capsys)
    parts = {part["formula"]: part for part in told["parts"]}
    last = parts["instSafe(SV, POV)"]["true"][0][1]
    assert parts["initSafe(SV, POV)"]["true"] == [[0.0, pytest.approx(last - 0.6)]]
    _, told = asked(["G[0,1] v_lon(SV) > 28 m/s", str(drive), "--view", "recorded"], capsys)
    assert told["parts"][0]["true"] == [[0.0, 3.0]]
    assert told["parts"][0]["undecided"] == [[3.04, 4.0]]


def test_pictures(drive: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for name, start in (("a.png", b"\x89PNG"), ("b.svg", b"<?xml")):
        assert main(["monitor", "4", str(drive), "--picture", str(tmp_path / name)]) == 0
        assert (tmp_path / name).read_bytes().startswith(start)
    assert main(["monitor", "4", str(drive), "--picture", str(tmp_path / "c.gif")]) == 2


@pytest.fixture(scope="module")
def recordings(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("recordings")
    write_highd(simulate(TrafficSettings(seconds=30, lane_width=3.5), seed=6), path)
    return path


def test_a_pair_is_answered_as_in_an_evaluation(recordings: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Every match of base and ext, one by one; and the other scenarios are not true there."""
    settings = default_settings()
    found = evaluate_recording(read_highd(recordings, "01"), compile_questions(settings, 25))
    matches = [m for m in found.matches if m.set_name in ("base", "ext") and m.min_danger == 0][:10]
    assert len(matches) > 3
    for match in matches:
        who = ",".join(str(x) for x in (match.sv, match.pov, match.pov2) if x is not None)
        trace = [f"{recordings}/01_tracks.csv:{who}", "--frames", f"{match.start_frame}-{match.end_frame}"]
        options = ["--set", match.set_name, "--param", "minDanger=0"]
        code, told = asked([str(match.scenario), *trace, *options], capsys)
        assert (code, told["verdict"], told["lanes"]["L"]) == (0, "true", match.lane)
        if match.pov2 is None and match.scenario in (1, 4):
            other = 5 - match.scenario  # 1 and 4 exclude each other with one L and one start (semantics §6)
            code, told = asked([str(other), *trace, *options], capsys)
            assert code != 0


def test_lanes_by_name_and_by_vehicle(recordings: Path, capsys: pytest.CaptureFixture[str]) -> None:
    rows = list(csv.DictReader((recordings / "01_tracks.csv").open()))
    ids = sorted({int(row["id"]) for row in rows if row["laneId"] in ("6", "7", "8")})
    first = next(row for row in rows if row["id"] == str(ids[0]))
    trace = f"{recordings}/01_tracks.csv:{ids[0]}"
    code, told = asked(["atLane(SV, L)", trace, "--lane", first["laneId"]], capsys)
    assert (code, told["verdict"], told["lanes"]["L"]) == (0, "true", first["laneId"])
    code, told = asked(["atLane(SV, L)", trace, "--lane", "L=SV"], capsys)
    assert told["lanes"]["L"] == first["laneId"]
    other = next(x for x in ("6", "8") if x != first["laneId"])
    assert main(["monitor", "atLane(SV, L)", trace, "--lane", other]) == 10


HEADER = "time,vehicle,s,d,v_lon,v_lat,a_lon,a_lat,length,width"


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        ([], "the file is empty"),
        (["time,s"], "row 1: missing columns vehicle, d, v_lon"),
        ([f"{HEADER},its colour"], "row 1: columns 'its colour' are not part of the format"),
        ([HEADER], "a header but no rows"),
        ([HEADER, "0,SV,1,2,3,0,0,0,4,2"], "at least two samples"),
        ([HEADER, "0,SV,1,2"], "row 2: the row has 4 fields"),
        (
            [HEADER, "0,SV,1,2,3,0,0,0,4,2", "0.1,SV,nan,2,3,0,0,0,4,2"],
            "row 3, column s=nan: a number must be finite",
        ),
        ([HEADER, "0,SV,1,2,3,0,0,0,4,2", "0.1,SV,1,2,3,0,0,0,5,2"], "length of SV changes"),
        ([HEADER, "0,SV,1,2,3,0,0,0,4,2", "x,SV,1,2,3,0,0,0,4,2"], "time='x'"),
        ([HEADER, "0,SV,1,2,3,0,0,0,4,2", "0,SV,1,2,3,0,0,0,4,2"], "at least two samples"),
        (
            [HEADER, *(f"{t},SV,1,2,3,0,0,0,4,2" for t in ("0", "0.1", "0.3"))],
            "row 4, column time=0.3: samples are 0.1 s apart",
        ),
        (
            [HEADER, "0,SV,1,2,3,0,0,0,4,2", "0,POV,1,2,3,0,0,0,4,2", "0.1,SV,1,2,3,0,0,0,4,2"],
            "every vehicle needs exactly one row",
        ),
        ([HEADER, *(f"{t},SV,1,2,3,0,0,0,0,2" for t in ("0", "0.1"))], "size must be greater than zero"),
    ],
)
def test_bad_samples(lines: list[str], said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "x.csv"
    path.write_text("".join(f"{line}\n" for line in lines))
    assert main(["monitor", "v_lon(SV) > 0", str(path)]) == 3
    message = capsys.readouterr().err
    assert said in message
    assert "Traceback" not in message


def test_order_of_rows_does_not_matter(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    rows = [f"{t},SV,{10 * t},2,{v},0,0,0,4,2" for t, v in ((0, 1), (1, 5), (2, 9))]
    path = tmp_path / "x.csv"
    path.write_text("\n".join([HEADER, rows[2], rows[0], rows[1]]) + "\n")
    assert main(["monitor", "v_lon(SV) < 2 m/s", str(path)]) == 0
    assert "note: x.csv: rows were not in order of time; they were sorted" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "code", "said"),
    [
        (["4", "trace.txt"], 3, "a trace is a drive"),
        (["4", "nowhere.json"], 3, "cannot read nowhere.json"),
        (["4", "nowhere.csv"], 3, "nowhere.csv: the file cannot be read"),
        (["4", "{folder}/01_tracks.csv:1,2,3,4"], 3, "a trace is a drive"),
        (["4", "{folder}/01_tracks.csv:1,99999"], 3, "has no vehicle 99999"),
        (["4", "{folder}/01_tracks.csv:1,1"], 3, "each vehicle may be named once"),
        (["2", "{drive}"], 3, "mentions POV1, POV2"),
        (["25", "{drive}"], 3, "scenario 25"),
        (["4", "{drive}", "--dt", "0"], 2, "--dt 0"),
        (["4", "{drive}", "--lane", "main-9"], 3, "lane L=main-9"),
        (["4", "{folder}/01_tracks.csv:1,2", "--frames", "5"], 2, "--frames 5"),
        (["4", "{folder}/01_tracks.csv:1,2", "--view", "dense"], 2, "requires a drive or OpenSCENARIO file"),
        (["F[0,1/3] v_lon(SV) > 0", "{drive}", "--view", "recorded"], 3, "no multiple of the time step"),
        (["v_lon(SV) >", "{drive}"], 3, "claim, line 1"),
    ],
)
def test_monitor_refuses(
    arguments: list[str],
    code: int,
    said: str,
    recordings: Path,
    drive: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    filled = [x.replace("{folder}", str(recordings)).replace("{drive}", str(drive)) for x in arguments]
    assert main(["monitor", *filled]) == code
    message = capsys.readouterr().err
    assert said in message
    assert "Traceback" not in message


@pytest.mark.parametrize("view", ["dense", "recorded"])
def test_the_command_line_overrules_the_file_and_says_so(
    view: str, drive: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The file says minDanger = 3/5; a formula that holds for values from 1 s on tells which is used."""
    data = json.loads(drive.read_text())
    data["parameters"] |= {"rho": "1/2", "minSafe": "2/5"}
    drive.write_text(json.dumps(data))
    command = ["rho >= 1 s and v_lon(SV) > 0 m/s", str(drive), "--view", view]
    code, told = asked(command, capsys)
    assert (code, told["verdict"]) == (10, "false")
    assert told["overruled"] == []
    code, told = asked([*command, "--param", "rho=1"], capsys)
    assert (code, told["verdict"]) == (0, "true")
    assert told["overruled"] == [{"what": "parameter rho", "asked": "1", "said": "1/2"}]
    assert main(["monitor", *command, "--param", "rho=1"]) == 0
    assert "parameter rho: 1 (the file says 1/2)" in capsys.readouterr().out
    # What is not given stays as in the file, also where the library says otherwise (minSafe 0.6).
    both = "minSafe <= 0.4 s and rho >= 1 s and v_lon(SV) > 0 m/s"
    code, told = asked([both, *command[1:], "--param", "rho=1"], capsys)
    assert (code, told["verdict"]) == (0, "true")


def test_set_and_option_overrule_the_file_and_say_so(drive: Path, capsys: pytest.CaptureFixture[str]) -> None:
    _, told = asked(["4", str(drive)], capsys)
    assert told["overruled"] == []
    _, told = asked(["4", str(drive), "--set", "ext"], capsys)
    assert told["set"] == "ext"
    assert told["overruled"] == [{"what": "set", "asked": "ext", "said": "base"}]
    data = json.loads(drive.read_text())
    drive.write_text(json.dumps(data | {"parameters": {"minDanger": "3/5", "lateral_sign": "literal"}}))
    _, told = asked(["4", str(drive), "--option", "lateral_sign=rss"], capsys)
    assert told["overruled"] == [{"what": "option lateral_sign", "asked": "rss", "said": "literal"}]


def test_a_file_that_overrules_the_command_line_is_caught(
    drive: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Planted fault: the file's values come last."""
    data = json.loads(drive.read_text())
    data["parameters"] |= {"rho": "1/2"}
    drive.write_text(json.dumps(data))
    command = ["rho >= 1 s and v_lon(SV) > 0 m/s", str(drive), "--param", "rho=1"]
    with monkeypatch.context() as patch:
        honest = "{**file.values, **definitions.values}"
        plant_fault(patch, traces, honest, "{**definitions.values, **file.values}")
        assert asked(command, capsys)[0] == 10
    assert asked(command, capsys)[0] == 0


def test_notes_on_the_recording_are_told(
    recordings: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for path in recordings.glob("01_*"):
        (tmp_path / path.name).write_bytes(path.read_bytes())
    lines = (tmp_path / "01_tracks.csv").read_text().splitlines()
    lines[9] = lines[9].rpartition(",")[0] + ",1"
    (tmp_path / "01_tracks.csv").write_text("\n".join(lines) + "\n")
    main(["monitor", "v_lon(SV) > 0 m/s", f"{tmp_path}/01_tracks.csv:1"])
    assert "note: 01_tracks.csv, row 10, column laneId=1: laneId is not" in capsys.readouterr().err
