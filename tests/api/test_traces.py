"""One trace, whatever it is given as: the same answer, and that of the command line."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import polars
import pytest

import roadproof as rp
from api.doors import tell
from roadproof.evidence.answers.monitor import Override
from roadproof.evidence.judged import JudgedDrive
from roadproof.frontends.api.traces import MonitorAnswer

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
    assert Override(what="parameter rho", asked="1", said="3/5") in found.place.overruled
    assert Override(what="set", asked="ext", said="base") in found.place.overruled
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
        ({"vehicle": ["SV", "SV", "POV", "POV"]}, "every vehicle needs exactly one row at every time"),
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
