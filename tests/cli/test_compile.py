"""roadproof compile and rp.compile: the same files, whole or none, and what they promise."""

import re
from pathlib import Path

import pytest

import roadproof as rp
from roadproof.frontends.cli.main import main


def test_both_doors_write_the_same(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    line = ["compile", "1,4", "danger(SV,POV)", "F danger(SV,POV)", "danger(SV,POV)"]
    assert (
        main([*line, "--to", "c", "--out", str(tmp_path / "out"), "--set", "ext", "--param", "rho=0.3"]) == 0
    )
    using = rp.load("ext", params={"rho": 0.3})
    made = rp.compile(line[1:], out=tmp_path / "other", using=using)
    assert sorted(made.files) == ["monitor.c", "monitor.h"]
    for name, text in made.files.items():
        assert (tmp_path / "out" / name).read_text() == text == (tmp_path / "other" / name).read_text()
    labels = ["scenario_1", "scenario_4", "danger_SV_POV", "formula_4", "danger_SV_POV_2"]
    assert [*made.to_frame()["function"]] == [f"{label}_step" for label in labels]
    told = capsys.readouterr().out.splitlines()
    assert told[0].split() == ["function", "verdicts", "about", "delay", "memory"]
    assert f"written to {tmp_path / 'out'}: monitor.h, monitor.c" in told


def test_what_the_header_promises() -> None:
    made = rp.compile(["danger(SV,POV)", 4], dt="20 ms", name="watch")
    header = made.files["watch.h"]
    each, start = made.rows()
    assert (each["about"], each["delay"]) == ("each sample", 0.6)
    assert (start["about"], start["delay"]) == ("the first sample", 0.6)
    assert re.findall(r"#define (\w+)_DELAY 30u\n#define \1_REST (\d+)u", header) == [
        ("DANGER_SV_POV", "30"),
        ("SCENARIO_4", "1"),
    ]
    assert f"#define SCENARIO_4_BYTES {start['memory']}u" in header
    assert "    double s_SV; /* m: front end of SV along the road */" in header
    assert (
        "    uint8_t atLane_POV_beside_L; /* some M in adjacentLanes(L): atLane(POV, M) holds now */"
        in header
    )


def test_on_a_road_samples_have_no_flags() -> None:
    made = rp.compile(4, road="main-3", lanes={"L": "main-1"})
    assert "uint8_t atLane" not in made.files["monitor.h"]
    assert "uint8_t atLane" in rp.compile(4).files["monitor.h"]


def test_nothing_is_written_where_a_formula_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    line = ["compile", "4", "G[0, 0.05] v_lon(SV) > 3 m/s", "--to", "c", "--out", str(tmp_path / "out")]
    assert main(line) == 3
    assert "is no multiple of the time step" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()
