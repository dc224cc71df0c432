"""Exported drives, read back and monitored: verdicts and truth intervals are those of the drive.

All 24 scenarios in the three sets, and 200 random formulas; what is compared is every named part of a
formula at every sample.
"""

import math
import random
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction as F
from functools import cache
from itertools import pairwise, permutations
from pathlib import Path

import numpy as np
import polars
import pytest

from extensions.exchange.exporting.shipped_drives import (
    SMOOTH,
    TURN,
    WEAVING,
    motion,
    shipped_drives,
    subject,
    subjects,
)
from fuzz.held import CALLS
from planting import plant
from roadproof.errors import InputError
from roadproof.extensions.exchange.export import openscenario
from roadproof.extensions.exchange.export.points import axle_to_centre, centre, heading, rear_axle
from roadproof.extensions.exchange.export.registry import FORMATS
from roadproof.extensions.exchange.export.subject import ExportSubject, span_of
from roadproof.extensions.exchange.exporting import export
from roadproof.extensions.traffic.evaluate.one_trace import OneTrace, read_pair, read_samples, sample_drive
from roadproof.extensions.traffic.formats.large import write_large
from roadproof.extensions.traffic.formats.sources import find_source
from roadproof.extensions.traffic.monitoring import MonitorAnswer, monitor, of_file
from roadproof.frontends.api.definitions import load
from roadproof.frontends.api.driving import drive
from roadproof.frontends.api.driving import motion as given
from roadproof.library.bind import bind
from roadproof.library.elaborate import read_claim
from roadproof.library.roles import vehicle_order
from roadproof.library.scenarios import roles
from roadproof.semantics.sampled.compiled import compile
from roadproof.world.drive import Motion
from roadproof.world.motion import State, state_at
from roadproof.world.signals import RECORDED

STEP = 0.04


@dataclass(frozen=True)
class Read:
    """A trace that was read back, and what it calls the lane that L stands for."""

    trace: OneTrace
    lane: str


def written(made: ExportSubject, format_: str, folder: Path) -> Path:
    for name, content in FORMATS[format_](made).items():
        (folder / name).write_bytes(content)
    return folder


def by_id(made: ExportSubject) -> str:
    """SV is 1 in every format, and the others follow."""
    return ",".join(str(k) for k, _ in enumerate(made.vehicles, 1))


def as_csv(made: ExportSubject, folder: Path) -> Read:
    """As one trace, on the road beside the file."""
    return Read(read_samples(written(made, "csv", folder) / f"{made.name}.csv"), made.file.lanes["L"])


def as_csv_recording(made: ExportSubject, folder: Path) -> Read:
    """As a recording, whose vehicles are numbered."""
    path = written(made, "csv", folder) / f"{made.name}.csv"
    return Read(read_pair(f"{path}:{by_id(made)}"), made.file.lanes["L"])


def as_highd(made: ExportSubject, folder: Path) -> Read:
    """Lanes are called as on the road beside the files, or by laneId, which counts from the upper left."""
    name = f"{made.number:02d}"
    path = written(made, "highd", folder) / f"{name}_tracks.csv"
    read = read_pair(f"{path}:{by_id(made)}")
    if (folder / f"{name}_road.toml").exists():
        return Read(read, made.file.lanes["L"])
    left = sorted(made.file.road.lanelets, key=lambda x: x.d, reverse=True)
    return Read(read, str(4 + [x.lane for x in left].index(made.file.lanes["L"])))


def as_commonroad(made: ExportSubject, folder: Path) -> Read:
    """A lane is called by its first lanelet, and lanelets count from 1001, section by section."""
    path = written(made, "commonroad", folder) / f"{made.name}.xml"
    lanes = [x.lane for section in made.layout.sections for x in section.lanelets]
    return Read(read_pair(f"{path}:{by_id(made)}"), str(1001 + lanes.index(made.file.lanes["L"])))


READERS: Mapping[str, Callable[[ExportSubject, Path], Read]] = {
    "csv": as_csv,
    "csv, as a recording": as_csv_recording,
    "highd": as_highd,
    "commonroad": as_commonroad,
}


def spans(found: MonitorAnswer) -> list[list[tuple[float, float]]]:
    """When each named part is true, in the order in which they are found; lanes may be called otherwise."""
    return [[*x.true] for x in found.observed.strips]


@cache
def original(name: str) -> MonitorAnswer:
    """The drive's own samples."""
    file = shipped_drives()[name]
    return monitor(file.scenario or file.formula, file, view="recorded")


@pytest.mark.parametrize("format_", READERS)
@pytest.mark.parametrize("made", subjects(), ids=lambda x: x.name)
def test_verdicts_and_truth_intervals_are_those_of_the_drive(
    made: ExportSubject, format_: str, tmp_path: Path
) -> None:
    read = READERS[format_](made, tmp_path)
    found = monitor(made.file.scenario or "", read.trace, of_file(made.file), lanes={"L": read.lane})
    assert found.verdict == original(made.name).verdict == "true"
    ours, theirs = spans(original(made.name)), spans(found)
    assert len(ours) == len(theirs) > 10
    for part, (each, again) in enumerate(zip(ours, theirs, strict=True)):
        assert len(each) == len(again), part
        for one, other in zip(each, again, strict=True):
            assert np.abs(np.subtract(one, other)).max() <= STEP + 1e-9, part


@pytest.mark.parametrize("format_", READERS)
def test_a_drive_with_jerk_is_read_back_as_it_was(format_: str, tmp_path: Path) -> None:
    vehicles = {
        "SV": given(0, 2.6, 29, along=[(1, 0, -1), (1, -1, 1)]),
        "POV": given(70, 2.8, 28, along=[(1, 0, -4), (2, -4, 0), (1, -4, 4)]),
    }
    made = ExportSubject("smooth", 1, drive(4, vehicles, load("ext")).file)
    read = READERS[format_](made, tmp_path)
    ours = monitor(4, made.file, view="recorded")
    found = monitor(4, read.trace, of_file(made.file), lanes={"L": read.lane})
    assert found.verdict == ours.verdict == "true"
    for each, again in zip(spans(ours), spans(found), strict=True):
        assert again == pytest.approx(np.array(each), abs=STEP + 1e-9) if each else again == each
    samples = sample_drive(made.file.drive, made.file.road, F(6), F(1, 25), "drive")
    for signal in (
        x for x in RECORDED if (x, format_) != ("a_lat", "commonroad")
    ):  # which has no place for it
        for name in vehicles:
            columns = [x.batch.signals[signal, name][:, 0] for x in (samples, read.trace)]
            begins = [x[0] if signal in ("s", "d") else 0.0 for x in columns]  # roads begin elsewhere
            assert columns[1] - begins[1] == pytest.approx(columns[0] - begins[0], abs=1e-6), (signal, name)


@pytest.mark.parametrize("name", [*shipped_drives()][::9])
def test_samples_are_true_where_dense_time_is(name: str) -> None:
    """Away from the ends of dense intervals, for the parts that speak of one instant."""
    file = shipped_drives()[name]
    dense = {x.name: x.true for x in monitor(file.scenario or "", file).observed.strips}
    compared = 0
    for strip in original(name).observed.strips:
        ends = [end for span in dense[strip.name] for end in span]
        if strip.undecided or strip.name == original(name).observed.formula:
            continue
        for k in range(int(file.horizon / F(STEP).limit_denominator()) + 1):
            time = k * STEP
            if all(abs(time - end) > STEP for end in ends):
                inside = any(begin <= time <= end for begin, end in dense[strip.name])
                sampled = any(begin - 1e-9 <= time <= end + 1e-9 for begin, end in strip.true)
                compared += 1
                assert inside == sampled, (strip.name, time)
    assert compared > 1000


def random_formula(rng: random.Random, drive: OneTrace) -> str:
    """Comparisons whose limits lie between values that the drive has, definitions, time and logic."""

    def comparison() -> str:
        signal = rng.choice(RECORDED)
        one, other = rng.sample([*drive.lanes], 2)
        values = drive.batch.signals[signal, one] - drive.batch.signals[signal, other]
        text = f"{signal}({one}) - {signal}({other})"
        if signal not in ("s", "d") and rng.random() < 0.5:  # where a road begins is up to a recording
            values, text = drive.batch.signals[signal, one], f"{signal}({one})"
        seen = np.unique(np.round(values, 5))
        k = rng.randrange(len(seen))
        limit = seen[k] + 1e-3 if k + 1 == len(seen) else (seen[k] + seen[k + 1]) / 2
        unit = {"s": "m", "d": "m", "v": "m/s", "a": "m/s^2"}[signal.partition("_")[0]]
        return f"{text} {rng.choice(['<', '<=', '>', '>='])} {limit:.6f} {unit}"

    def window() -> str:
        low = rng.randrange(0, 40)
        high = "inf" if rng.random() < 0.2 else f"{(low + rng.randrange(0, 60)) * STEP:.2f} s"
        return f"[{low * STEP:.2f} s, {high}]"

    def made(depth: int) -> str:
        if depth == 0 or rng.random() < 0.2:
            return rng.choice(CALLS) if rng.random() < 0.3 else comparison()
        match rng.randrange(6):
            case 0:
                return f"not ({made(depth - 1)})"
            case 1 | 2:
                return f"({made(depth - 1)}) {rng.choice(['and', 'or'])} ({made(depth - 1)})"
            case 3:
                return f"F{window()} ({made(depth - 1)})"
            case 4:
                return f"G{window()} ({made(depth - 1)})"
            case _:
                return f"({made(depth - 1)}) U{window()} ({made(depth - 1)})"

    return made(3)


PAIRS = [made for made in subjects() if len(made.vehicles) == 2]


@pytest.mark.parametrize("block", range(10))
def test_random_formulas_have_the_truth_of_the_drive(block: int, tmp_path: Path) -> None:
    """20 formulas on each of 10 drives: the same samples are true, and the same false."""
    made = PAIRS[(7 * block) % len(PAIRS)]
    ours = sample_drive(made.file.drive, made.file.road, made.file.horizon, F(1, 25), "drive")
    traces = {name: reader(made, tmp_path) for name, reader in READERS.items()}
    home, rng = of_file(made.file), random.Random(block)
    seen = set()
    for _ in range(20):
        text = random_formula(rng, ours)
        query = read_claim(home.specification, text)

        def answer(on: OneTrace, lane: str, query=query) -> np.ndarray:
            formula = bind(query.formula, on.road, {"L": lane}, home.all_values())
            found = compile({"it": formula}).evaluate(on.batch, at="all").answers["it"]
            return np.stack([found.true[:, 0], found.false[:, 0]])

        expected = answer(ours, made.file.lanes["L"])
        seen.add(expected.tobytes())
        for name, read in traces.items():
            differ = answer(read.trace, read.lane) != expected
            if "a_lat" in text and name == "commonroad":
                continue  # which the format has no place for, so that it may be a sample late
            assert not differ.any(), (name, text, np.flatnonzero(differ.any(axis=0)))
    assert len(seen) > 10


def test_planted_fault_a_sample_of_another_vehicle_is_noticed(tmp_path: Path) -> None:
    """Where SV and POV change places, some scenario's verdict does."""
    made = next(x for x in PAIRS if x.file.scenario == 4)
    path = written(made, "csv", tmp_path) / f"{made.name}.csv"
    home, lanes = of_file(made.file), made.file.lanes
    assert monitor(4, f"{path}:1,2", home, lanes=lanes).verdict == "true"
    assert monitor(4, f"{path}:2,1", home, lanes=lanes).verdict == "false"


# --- Straight lines between vertices against the exact motion, at many times between them -----------

HARD = motion(("1", "-6", "1.5"), ("1", "3", "-1.5"), (None, "0", "0"), start=("0", "2.6", "12", "1"))


def worst(vertices: tuple[State, ...], car: Motion) -> float:
    """How far the centre or the rear axle of the interpolated box is from that of the drive."""
    found, ahead = 0.0, float(axle_to_centre(car.length))
    for a, b in pairwise(vertices):
        ends = [(*rear_axle(x, car, heading(x)), heading(x)) for x in (a, b)]
        for k in range(17):
            share = k / 16
            x, y, turned = (p + share * (q - p) for p, q in zip(*ends, strict=True))
            state = state_at(car, a.time + (b.time - a.time) * F(k, 16))
            axle = rear_axle(state, car, heading(state))
            middle = centre(state, car.length, car.width)
            turned_middle = x + ahead * math.cos(turned), y + ahead * math.sin(turned)
            found = max(found, math.dist((x, y), axle), math.dist(turned_middle, map(float, middle)))
    return found


@pytest.mark.parametrize(
    "car",
    [
        TURN,
        HARD,
        SMOOTH,
        WEAVING,
        *(m for f in [*shipped_drives().values()][::6] for m in f.drive.vehicles.values()),
    ],
)
def test_lines_are_within_their_bound_and_a_centimetre_of_the_drive(car: Motion) -> None:
    line = openscenario.polyline_of(car, F(6))
    assert (line.vertices[0].time, line.vertices[-1].time) == (0, 6)
    assert worst(line.vertices, car) <= line.bound + 1e-12 <= 0.01 + 1e-12


def test_braking_alone_is_bounded_by_an_eighth_of_the_square() -> None:
    car = motion((None, "-4", "0"))
    line = openscenario.polyline_of(car, F(2))
    steps = {b.time - a.time for a, b in pairwise(line.vertices)}
    assert steps == {F(1, 8)}
    assert line.bound == pytest.approx(4 * (1 / 8) ** 2 / 8)
    assert worst(line.vertices, car) == pytest.approx(line.bound)  # it is reached in the middle


def test_a_steady_drive_needs_its_two_ends() -> None:
    line = openscenario.polyline_of(motion((None, "0", "0")), F(6))
    assert (len(line.vertices), line.bound) == (2, 0.0)


def test_every_change_of_acceleration_is_a_vertex() -> None:
    times = {x.time for x in openscenario.polyline_of(TURN, F(6)).vertices}
    assert {F("0.5"), F("2.1"), F("3.7")} <= times


@pytest.mark.parametrize("car", [TURN, HARD, SMOOTH, WEAVING])
def test_planted_fault_too_few_vertices_are_noticed(car: Motion) -> None:
    line = openscenario.polyline_of(car, F(6))
    assert worst(line.vertices[::4], car) > 0.01


@pytest.mark.parametrize("car", [TURN, HARD, SMOOTH])
def test_planted_fault_a_bound_without_the_turning_would_be_broken_or_loose(car: Motion) -> None:
    """The bound is no guess: it is above what is so, and within a few times of it."""
    line = openscenario.polyline_of(car, F(6))
    assert line.bound / 4 < worst(line.vertices, car) <= line.bound


def test_a_bound_has_the_greatest_acceleration_between_its_vertices() -> None:
    """From none to -6 m/s²: the last line is the one that is farthest from the drive, and near its bound."""
    car = motion(("2", "0", "0", "-3"), (None, "0", "0"))
    line = openscenario.polyline_of(car, F(2))
    assert line.bound * 0.8 < worst(line.vertices, car) <= line.bound <= 0.01


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("for x in (state, end))", "for x in (state,))"),
        ("max(abs(state.v_lat), abs(end.v_lat))", "0"),
        ("max(abs(state.v_lat), abs(end.v_lat))", "abs(state.v_lat) / 10"),
        ("+ swerving / slowest**2", ""),
    ],
)
def test_planted_fault_a_bound_that_forgets_jerk_is_broken(
    monkeypatch: pytest.MonkeyPatch, right: str, wrong: str
) -> None:
    cars = [
        motion(("2", "0", "0", "-3"), (None, "0", "0")),
        motion(("1", "0", "0", "60"), (None, "0", "0"), start=("0", "2", "10", "3"), size=("400", "2")),
        motion(("1", "0", "3", "60"), (None, "0", "0"), start=("0", "2", "10", "0"), size=("400", "2")),
    ]

    def broken() -> bool:
        made = [(car, openscenario.polyline_of(car, F(1), 0.01)) for car in cars]
        return any(worst(line.vertices, car) > line.bound + 1e-12 for car, line in made)

    assert not broken()
    plant(monkeypatch, openscenario, "_segment", right, wrong)
    assert broken()


def test_speeds_accelerations_and_headings_between_vertices_are_within_what_is_said() -> None:
    for car in (SMOOTH, WEAVING, HARD, TURN):
        line = openscenario.polyline_of(car, F(4))
        states = [state_at(car, F(k, 200)) for k in range(801)]
        assert max(x.v_lon for x in states) <= max(x.v_lon for x in line.vertices)
        assert min(x.v_lon for x in states) >= min(x.v_lon for x in line.vertices)
        assert min(line.accelerations) <= min(x.a_lon for x in states)
        assert max(x.a_lon for x in states) <= max(line.accelerations)
        turned = max(abs(heading(x) or 0.0) for x in states)
        assert turned <= line.turned <= 1.2 * turned


def test_an_acceleration_that_is_reached_only_before_a_jump_counts() -> None:
    car = motion(("2", "0", "0", "6"), (None, "0", "0"))
    assert max(openscenario.polyline_of(car, F(3)).accelerations) == 12
    assert b'maxAcceleration="12"' in openscenario.files(subject(SV=car))["made.xosc"]


def test_a_speed_that_is_greatest_inside_a_piece_counts() -> None:
    """From 30 m/s at 10 m/s², which falls by 10 m/s³: 35 m/s after 1 s, 30 m/s again after 2 s."""
    car = motion(("2", "10", "0", "-10"), (None, "0", "0"))
    assert b'maxSpeed="45"' in openscenario.files(subject(SV=car))["made.xosc"]
    fast = motion(("2", "30", "0", "-30"), (None, "0", "0"))  # 45 m/s are 162 km/h
    assert b'max="170"' in openscenario.files(subject(SV=fast))["made.xodr"]


@pytest.mark.parametrize("starts", ["1", "0.99"])
def test_a_vehicle_that_goes_back_inside_a_piece_is_refused(starts: str) -> None:
    """v = 1 - 2·t + t² touches 0 after 1 s; from less it falls below."""
    car = motion(("2", "-2", "0", "2"), (None, "0", "0"), start=("0", "2", starts, "0"))
    if starts == "1":
        assert min(x.v_lon for x in openscenario.polyline_of(car, F(3)).vertices) == 0
        return
    with pytest.raises(InputError, match=r"at 1 s a vehicle has v_lon=-0\.01 m/s"):
        openscenario.polyline_of(car, F(3))


def test_the_road_reaches_as_far_as_a_vehicle_goes_back() -> None:
    """v = -1 + t²/2: the front is least at √2 s, and the road is cut a margin before its rear there."""
    car = motion(("4", "0", "0", "1"), (None, "0", "0"), start=("0.4428", "2.6", "-1", "0"))
    low, high = span_of([car], F(4))
    least = -(2**0.5) * 2 / 3 + 0.4428
    assert float(low) == pytest.approx(least - 4.5, abs=1e-9)
    assert high == state_at(car, F(4)).s


def test_a_vehicle_that_stops_keeps_its_heading() -> None:
    straight = openscenario.polyline_of(motion(("5", "-6", "0"), (None, "0", "0")), F(6))
    assert (straight.vertices[-1].v_lon, straight.headings[-1]) == (0, 0.0)
    slanting = motion(("5", "-6", "-0.6"), (None, "0", "0"), start=("0", "2", "30", "3"))
    line = openscenario.polyline_of(slanting, F(6))
    assert [*line.headings] == pytest.approx([math.atan(0.1)] * len(line.headings))
    assert line.bound <= 0.01
    starts = motion((None, "2", "0.2"), start=("0", "2", "0", "0"))
    assert openscenario.polyline_of(starts, F(2)).headings[0] == pytest.approx(math.atan(0.1))


@pytest.mark.parametrize(
    ("car", "message"),
    [
        (motion((None, "-6", "0")), "v_lon=-0.375 m/s: other tools want vehicles that drive forwards"),
        (motion((None, "0", "1"), start=("0", "2", "0", "-1")), "v_lon=0 m/s: other tools want"),
        (
            motion(("1", "-1", "-0.1"), (None, "1", "0"), start=("0", "2", "1", "0.1")),
            "turns where it all but stands, at 1 s",
        ),
        (
            motion(("1", "-0.999999", "0.001"), (None, "1", "0"), start=("0", "2", "1", "-0.0005")),
            "turns where it all but stands",
        ),
    ],
)
def test_vehicles_without_a_heading_are_refused(car: Motion, message: str) -> None:
    with pytest.raises(InputError, match=message):
        openscenario.polyline_of(car, F(6))


# --- Who is who in exported files: vehicle 1 is SV and the others follow by name, in every format that is
# read
# Drives of two and three vehicles whose roles are not symmetric, written in each format, read back as
# vehicles of a recording; a permutation of the numbers must change the vehicles, and a verdict with them.

READ = {"openscenario": "made.xosc", "commonroad": "made.xml", "highd": "01_tracks.csv", "csv": "made.csv"}
"""Formats that are read as recordings, and the file to name. A road alone (OpenDRIVE) has no vehicle."""
DRIVES = [f"scenario-{number:02d}-{name}" for number in (2, 4, 7, 12, 18) for name in ("base", "ext")]


def path_of(made: ExportSubject, format_: str, folder: Path) -> Path:
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
    made = ExportSubject("made", 1, shipped_drives()[drive])
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


def lane_of(made: ExportSubject, name: str) -> str:
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
    made = ExportSubject("made", 1, shipped_drives()[drive])
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
    file = shipped_drives()["scenario-04-base"]
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
