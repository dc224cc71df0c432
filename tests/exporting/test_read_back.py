"""Exported drives, read back and monitored: verdicts and truth intervals are those of the drive.

All 24 scenarios in the three sets, and 200 random formulas; what is compared is every named part of a
formula at every sample.
"""

import random
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction as F
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from exporting.kept import kept, subjects
from fuzz.held import CALLS
from roadproof.frontends.api.definitions import load
from roadproof.frontends.api.driving import drive
from roadproof.frontends.api.driving import motion as given
from roadproof.frontends.api.traces import MonitorAnswer, monitor, of_file
from roadproof.library.bind import bind
from roadproof.library.elaborate import read_claim
from roadproof.recordings.evaluate.one_trace import OneTrace, read_pair, read_samples, sample_drive
from roadproof.recordings.export.registry import FORMATS
from roadproof.recordings.export.subject import Subject
from roadproof.semantics.sampled.compiled import compile
from roadproof.world.signals import RECORDED

STEP = 0.04


@dataclass(frozen=True)
class Read:
    """A trace that was read back, and what it calls the lane that L stands for."""

    trace: OneTrace
    lane: str


def written(made: Subject, format_: str, folder: Path) -> Path:
    for name, content in FORMATS[format_](made).items():
        (folder / name).write_bytes(content)
    return folder


def by_id(made: Subject) -> str:
    """SV is 1 in every format, and the others follow."""
    return ",".join(str(k) for k, _ in enumerate(made.vehicles, 1))


def as_csv(made: Subject, folder: Path) -> Read:
    """As one trace, on the road beside the file."""
    return Read(read_samples(written(made, "csv", folder) / f"{made.name}.csv"), made.file.lanes["L"])


def as_csv_recording(made: Subject, folder: Path) -> Read:
    """As a recording, whose vehicles are numbered."""
    path = written(made, "csv", folder) / f"{made.name}.csv"
    return Read(read_pair(f"{path}:{by_id(made)}"), made.file.lanes["L"])


def as_highd(made: Subject, folder: Path) -> Read:
    """Lanes are called as on the road beside the files, or by laneId, which counts from the upper left."""
    name = f"{made.number:02d}"
    path = written(made, "highd", folder) / f"{name}_tracks.csv"
    read = read_pair(f"{path}:{by_id(made)}")
    if (folder / f"{name}_road.toml").exists():
        return Read(read, made.file.lanes["L"])
    left = sorted(made.file.road.lanelets, key=lambda x: x.d, reverse=True)
    return Read(read, str(4 + [x.lane for x in left].index(made.file.lanes["L"])))


def as_commonroad(made: Subject, folder: Path) -> Read:
    """A lane is called by its first lanelet, and lanelets count from 1001, section by section."""
    path = written(made, "commonroad", folder) / f"{made.name}.xml"
    lanes = [x.lane for section in made.layout.sections for x in section.lanelets]
    return Read(read_pair(f"{path}:{by_id(made)}"), str(1001 + lanes.index(made.file.lanes["L"])))


READERS: Mapping[str, Callable[[Subject, Path], Read]] = {
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
    file = kept()[name]
    return monitor(file.scenario or file.formula, file, view="recorded")


@pytest.mark.parametrize("format_", READERS)
@pytest.mark.parametrize("made", subjects(), ids=lambda x: x.name)
def test_verdicts_and_truth_intervals_are_those_of_the_drive(
    made: Subject, format_: str, tmp_path: Path
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
    made = Subject("smooth", 1, drive(4, vehicles, load("ext")).file)
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


@pytest.mark.parametrize("name", [*kept()][::9])
def test_samples_are_true_where_dense_time_is(name: str) -> None:
    """Away from the ends of dense intervals, for the parts that speak of one instant."""
    file = kept()[name]
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
