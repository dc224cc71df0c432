"""One drive in every format that tests are read in: what it covers, and faults that cover nothing."""

import json
import xml.etree.ElementTree as ElementTree
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import pytest

import roadproof as rp
from roadproof.core_record import DRIVES
from roadproof.extensions.traffic.formats.table import polars_module
from roadproof.runtime.archives import shipped_answers
from roadproof.verdict import ExitCode

BASE = Path(__file__).parents[3] / "examples" / "traffic" / "drives" / "scenario-01-base.json"


def drives() -> Iterator[tuple[str, str]]:
    """A shipped drive of each scenario, by name."""
    seen: set[object] = set()
    for text in shipped_answers("witness").values():
        content = json.loads(text)
        known = content.get("schema") in DRIVES and content.get("set") == "base"
        if known and content.get("scenario") is not None and content["scenario"] not in seen:
            seen.add(content["scenario"])
            yield f"{content['scenario']}", text


SHIPPED = dict(drives())


def covered(place: Path | str, start: str = "fixed") -> tuple[list[str], ExitCode, str]:
    """The scenarios that a test covers, the exit code, and what is wrong with it."""
    answer = rp.catalogue(str(place), classes=False, drivers=(), start=start)
    found: Any = answer.as_data()
    told = "; ".join(x["told"] for x in found["faults"])
    return [x["name"] for x in found["targets"] if x["tested"]], answer.exit_code, told


def in_all_formats(drive: Path, folder: Path) -> dict[str, Path]:
    """The drive and its exports, by ending."""
    rp.export([drive], ["openscenario", "commonroad", "csv"], folder)
    found = {x: next(folder.rglob(f"*{x}")) for x in (".xosc", ".xml", ".csv")}
    parquet = found[".csv"].with_suffix(".parquet")
    pl = polars_module()
    pl.read_csv(found[".csv"], schema_overrides={"time": pl.Float64}).write_parquet(parquet)
    return {".json": drive, **found, ".parquet": parquet}


def test_there_are_shipped_drives() -> None:
    assert len(SHIPPED) >= 12, SHIPPED


@pytest.mark.parametrize("name", sorted(SHIPPED, key=int))
def test_a_drive_covers_the_same_in_each_format_with_and_without_ids(name: str, tmp_path: Path) -> None:
    """A drive file fixes where its formula begins, samples do not: both are looked at from every instant."""
    drive = tmp_path / f"scenario-{name}.json"
    drive.write_text(SHIPPED[name], "utf-8")
    files = in_all_formats(drive, tmp_path / "exported")
    ids = ",".join(map(str, range(1, len(json.loads(SHIPPED[name])["vehicles"]) + 1)))
    places = [*files.values(), *(f"{x}:{ids}" for ending, x in files.items() if ending != ".json")]
    found = {str(place): covered(place, start="any")[0] for place in places}
    assert f"scenario_{name}" in covered(drive)[0]
    assert len({*map(tuple, found.values())}) == 1, found


# --- samples and drives that cannot be ------------------------------------------------------------

Change = Callable[[float, float], float]
"""Changes the place of SV along the road at a time (s, m)."""
CHANGES: Mapping[str, tuple[Change, float, bool]] = {
    "jump": (lambda time, place: place + (75 if time > 3 else 0), 0.0, False),
    "through": (lambda time, place: place - 80 + 30 * time, 30.0, True),
    "reversed": (lambda time, place: 200 - place, -2.0, False),
}
"""By fault the place of SV, how its speed changes (-2: it is turned), and whether it is beside POV."""


def speed(fault: str, v: float) -> float:
    more = CHANGES[fault][1]
    return -v if more < 0 else v + more


def csv(fault: str, path: Path) -> None:
    header, *rows = (line.split(",") for line in path.read_text("utf-8").splitlines())
    beside = {row[0]: row[3] for row in rows if row[1] == "POV"}
    for row in rows:
        if row[1] == "SV":
            row[2] = repr(CHANGES[fault][0](float(row[0]), float(row[2])))
            row[4] = repr(speed(fault, float(row[4])))
            row[3] = beside[row[0]] if CHANGES[fault][2] else row[3]
    path.write_text("".join(",".join(row) + "\n" for row in (header, *rows)), "utf-8")


def parquet(fault: str, path: Path) -> None:
    pl = polars_module()
    csv(fault, path.with_suffix(".csv"))
    pl.read_csv(path.with_suffix(".csv"), schema_overrides={"time": pl.Float64}).write_parquet(path)


def openscenario(fault: str, path: Path) -> None:
    tree = ElementTree.parse(path)
    groups = {x.find("Actors/EntityRef").get("entityRef"): x for x in tree.iter("ManeuverGroup")}  # type: ignore[union-attr]
    other = next(groups["POV"].iter("WorldPosition"))
    for vertex in groups["SV"].iter("Vertex"):
        place, time = next(vertex.iter("WorldPosition")), float(vertex.get("time", ""))
        place.set("x", repr(CHANGES[fault][0](time, float(place.get("x", "")))))
        place.set("y", other.get("y", "") if CHANGES[fault][2] else place.get("y", ""))
    if CHANGES[fault][2]:
        for place in groups["POV"].iter("WorldPosition"):
            place.set("y", other.get("y", ""))
    tree.write(path)


def commonroad(fault: str, path: Path) -> None:
    tree = ElementTree.parse(path)
    first, second = (
        [node for node in x.iter() if node.tag in ("initialState", "state")]
        for x in tree.iter("dynamicObstacle")
    )
    step = float(tree.getroot().get("timeStepSize", ""))
    for one, other in zip(first, second, strict=True):
        x, y, v = (one.find(way) for way in ("position/point/x", "position/point/y", "velocity/exact"))
        assert x is not None
        assert y is not None
        assert v is not None
        time = float(one.findtext("time/exact") or "") * step
        x.text = repr(CHANGES[fault][0](time, float(x.text or "")))
        v.text = repr(speed(fault, float(v.text or "")))
        y.text = other.findtext("position/point/y") if CHANGES[fault][2] else y.text
    tree.write(path)


def drive_file(fault: str, path: Path) -> None:
    """A drive of constant speeds; places in dense time cannot jump."""
    content = json.loads(path.read_text("utf-8"))
    content["formula"] = "true"
    del content["scenario"]
    sv, pov = content["vehicles"]["SV"], content["vehicles"]["POV"]
    for x in (sv, pov):
        x["pieces"] = [{"duration": None, "a_lon": "0", "a_lat": "0"}]
    if fault == "reversed":
        sv["v_lon"] = f"-{sv['v_lon']}"
    else:
        sv |= {"s": "-50", "v_lon": "54", "d": pov["d"]}
    path.write_text(json.dumps(content), "utf-8")


WRITERS: Mapping[str, Callable[[str, Path], None]] = {
    ".csv": csv,
    ".parquet": parquet,
    ".xosc": openscenario,
    ".xml": commonroad,
    ".json": drive_file,
}


@pytest.mark.parametrize("ending", sorted(WRITERS))
@pytest.mark.parametrize("fault", sorted(CHANGES))
def test_a_motion_that_cannot_be_covers_nothing(fault: str, ending: str, tmp_path: Path) -> None:
    if (fault, ending) == ("jump", ".json"):
        pytest.skip("a drive says accelerations, so it has no jumps")
    drive = tmp_path / "test.json"
    drive.write_text(BASE.read_text("utf-8"), "utf-8")
    path = in_all_formats(drive, tmp_path / "exported")[ending]
    assert covered(path)[0] == ["scenario_1"]
    WRITERS[ending](fault, path)
    found, code, told = covered(path)
    assert found == []
    assert code == ExitCode.UNEXPECTED
    assert told
