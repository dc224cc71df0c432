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


def test_the_header_counts_what_a_sample_costs() -> None:
    header = rp.compile("G F[0, 200 ms] (v_lon(SV) > 1 m/s U a_lon(SV) > 0)").files["monitor.h"]
    # two operators without a bound, so four rows; five tables are remembered beside that of the first sample
    assert "A sample costs 24 look-ups in tables." in " ".join(header.replace("\n *", "").split())


@pytest.mark.parametrize(
    ("formula", "options", "told"),
    [
        (
            "G[0, 0.05] v_lon(SV) > 3 m/s",
            {},
            "bound 0.05 s is no multiple of the time step dt=0.04 s",
        ),
        (
            "F (v_lon(SV) > 3 m/s and G[0, 600] v_lon(SV) < 30 m/s and a_lon(SV) > 0)",
            {"memory": 1000},
            "the monitor needs 1904 bytes, to remember 15000 values, and the limit is 1000; raise --memory",
        ),
        (
            " or ".join(f"F G v_lon(SV) > {k} m/s" for k in range(4)),
            {},
            "8 temporal operators of the formula have no upper bound",
        ),
        (
            "some l in lanelets(L): occ(SV, l) and v_lon(SV) > 3 m/s",
            {},
            "name the road of the monitor with --road",
        ),
        ("G[0, 100000] v_lon(SV) > 3 m/s", {}, "the formula looks 2500000 samples ahead at a step of 0.04 s"),
        ("some M in lanes: F atLane(SV, M)", {}, "name the road of the monitor with --road"),
        ("4", {"lanes": {"L": "main-1"}}, "lanes: the lanes of which road?"),
        ("4", {"name": "a b"}, "name=a b: write letters, digits and _"),
        ("4", {"to": "rust"}, "there is no target 'rust'; there are c"),
    ],
)
def test_refused(formula: str, options: dict[str, object], told: str) -> None:
    with pytest.raises(rp.RoadproofError) as refused:
        rp.compile(formula, **options)  # type: ignore[arg-type]
    assert told in str(refused.value)


@pytest.mark.parametrize(
    ("to", "option"),
    [
        *(("c", x) for x in ("--horizon 3", "--reach 50", "--vehicle truck", "--allow-collisions")),
        *(("c", "--drives outer"), ("mps", "--memory 9"), ("smt2", "--name watch"), ("lp", "--name watch")),
    ],
)
def test_an_option_of_another_target_is_refused(
    to: str, option: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["compile", "4", "--to", to, *option.split(), "--out", str(tmp_path / "out")]) == 2
    assert f"to={to} has no such option; it is one of to=" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()
