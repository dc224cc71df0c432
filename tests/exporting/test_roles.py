"""Who is who in exported files: vehicle 1 is SV and the others follow by name, in every format that is read.

Drives of two and three vehicles whose roles are not symmetric, written in each format, read back as vehicles
of a recording; a permutation of the numbers must change the vehicles, and a verdict with them.
"""

from itertools import permutations
from pathlib import Path

import numpy as np
import polars
import pytest

from exporting.kept import kept, motion, subject
from roadproof.frontends.api.exporting import export
from roadproof.frontends.api.traces import monitor, of_file
from roadproof.library.scenarios import roles, vehicle_order
from roadproof.recordings.evaluate.one_trace import OneTrace, read_pair
from roadproof.recordings.export.registry import FORMATS
from roadproof.recordings.export.subject import Subject
from roadproof.recordings.formats.large import write_large
from roadproof.recordings.formats.sources import find_source

READ = {"openscenario": "made.xosc", "commonroad": "made.xml", "highd": "01_tracks.csv", "csv": "made.csv"}
"""Formats that are read as recordings, and the file to name. A road alone (OpenDRIVE) has no vehicle."""
DRIVES = [f"scenario-{number:02d}-{name}" for number in (2, 4, 7, 12, 18) for name in ("base", "ext")]


def path_of(made: Subject, format_: str, folder: Path) -> Path:
    """The exported file, or the same samples as Parquet."""
    for name, content in FORMATS["csv" if format_ == "parquet" else format_](made).items():
        (folder / name).write_bytes(content)
    if format_ == "parquet":
        polars.read_csv(folder / "made.csv").write_parquet(folder / "made.parquet")
        return folder / "made.parquet"
    return folder / READ[format_]


def named(trace: OneTrace, vehicle: str) -> tuple[float, ...]:
    """Size and speeds of a vehicle at the start: the same wherever a road begins."""
    sizes = (float(np.ravel(trace.batch.sizes[x, vehicle])[0]) for x in ("length", "width"))
    return (*sizes, *(float(trace.batch.signals[x, vehicle][0, 0]) for x in ("v_lon", "v_lat")))


def test_every_format_is_read_or_has_no_vehicle() -> None:
    assert {*READ, "opendrive"} == {*FORMATS}


@pytest.mark.parametrize("format_", [*READ, "parquet"])
@pytest.mark.parametrize("drive", DRIVES)
def test_numbers_are_roles_in_every_format(drive: str, format_: str, tmp_path: Path) -> None:
    made = Subject("made", 1, kept()[drive])
    path = path_of(made, format_, tmp_path)
    names = roles(len(made.vehicles))
    assert tuple(made.vehicles) == names
    home = of_file(made.file)

    def read(order: tuple[int, ...]) -> OneTrace:
        return read_pair(f"{path}:{','.join(map(str, order))}")

    own = tuple(range(1, len(names) + 1))
    trace = read(own)
    for name, car in made.vehicles.items():
        expected = [float(getattr(car, x)) for x in ("length", "width", "v_lon", "v_lat")]
        near = 0.3 if format_ == "openscenario" else 1e-6  # speeds are estimated from places
        assert named(trace, name) == pytest.approx(expected, abs=near), name

    def verdict(order: tuple[int, ...]) -> str:
        lane = trace.lanes["SV"] if made.file.lanes["L"] == lane_of(made, "SV") else trace.lanes[names[1]]
        return monitor(made.file.scenario or "", read(order), home, lanes={"L": lane}).verdict

    assert verdict(own) == "true"
    others = [order for order in permutations(own) if order != own]
    assert "false" in {verdict(order) for order in others}


def lane_of(made: Subject, name: str) -> str:
    """The lane of the centre of a vehicle's box at time 0."""
    car = made.vehicles[name]
    s, d = car.s - car.length / 2, car.d - car.width / 2
    for lanelet in made.file.road.lanelets:
        begin, end = lanelet.s
        inside = (begin is None or begin <= s) and (end is None or s <= end)
        if inside and lanelet.d[0] <= d < lanelet.d[1]:
            return lanelet.lane
    raise AssertionError(name)


@pytest.mark.parametrize("format_", [*READ, "parquet"])
@pytest.mark.parametrize(
    "names", [("POV", "SV"), ("Ego", "SV", "POV"), ("Z", "SV", "a"), ("b", "a"), ("c10", "c9")]
)
def test_vehicles_of_any_name_have_the_same_numbers_in_every_format(
    names: tuple[str, ...], format_: str, tmp_path: Path
) -> None:
    """Each vehicle is told by its length."""
    cars = {
        name: motion((None, "0", "0"), start=(str(60 * k), "2.6", "30", "0"), size=(str(4 + k), "1.8"))
        for k, name in enumerate(names)
    }
    made = subject(**cars)
    recording = find_source(path_of(made, format_, tmp_path)).read()
    found = dict(zip(recording.vehicle_id.tolist(), recording.length.tolist(), strict=True))
    order = vehicle_order(names)
    assert order == [*(["SV"] if "SV" in names else []), *sorted({*names} - {"SV"})]
    assert found == pytest.approx({k: 4.0 + names.index(name) for k, name in enumerate(order, 1)})


@pytest.mark.parametrize("drive", ["scenario-04-base", "scenario-02-base"])
def test_a_converted_recording_has_the_same_numbers(drive: str, tmp_path: Path) -> None:
    """Large files are numbered by a reader of their own, in pieces."""
    made = Subject("made", 1, kept()[drive])
    head = write_large(path_of(made, "csv", tmp_path), tmp_path, {}, "")
    recording = find_source(head).read()
    assert recording.vehicle_id.tolist() == [*made.ids.values()]
    assert recording.v_lon[recording.start[:-1]] == pytest.approx(
        [float(x.v_lon) for x in made.vehicles.values()]
    )
    told = ", ".join(f"{name} is {number}" for name, number in made.ids.items())
    assert f"vehicles are numbered: {told}" in recording.notes


def test_files_written_by_the_command_have_the_roles(tmp_path: Path) -> None:
    """`export` itself, with all formats at once, for a drive whose roles cannot be exchanged."""
    file = kept()["scenario-04-base"]
    export([file], to=[*READ], out=tmp_path)
    seen = {}
    for format_ in READ:
        (path,) = [
            x
            for x in (tmp_path / format_).iterdir()
            if x.suffix in (".xosc", ".xml")
            or x.name.endswith("_tracks.csv")
            or format_ == "csv" == x.suffix[1:]
        ]
        trace = read_pair(f"{path}:1,2")
        seen[format_] = named(trace, "SV")[0], named(trace, "POV")[0]
        gap = trace.batch.signals["s", "POV"][0, 0] - trace.batch.signals["s", "SV"][0, 0]
        assert gap == pytest.approx(
            float(file.drive.vehicles["POV"].s - file.drive.vehicles["SV"].s), abs=0.02
        )
    assert len({*seen.values()}) == 1
