"""Drives in recorded or simulated traffic: where each goes, and what must be found there.

A drive is planted only if the plain recursive evaluator confirms, on the samples as they are written
and on the trace cut as an evaluation cuts it, that the drive's scenario is true there; so what is
written down as planted is a ground truth for recall.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import cycle

import numpy as np

from roadproof.errors import UsageError
from roadproof.evidence.drive_file import DriveFile
from roadproof.extensions.traffic import scenario_parts
from roadproof.extensions.traffic.evaluate.one_trace import OneTrace, cut_trace
from roadproof.extensions.traffic.evaluate.recheck import trace_of
from roadproof.extensions.traffic.evaluate.recursive import TraceReader
from roadproof.extensions.traffic.evaluate.results import MATCH_COLUMNS
from roadproof.extensions.traffic.formats.clock import Rate
from roadproof.extensions.traffic.formats.highd_columns import LOWER, UPPER
from roadproof.extensions.traffic.formats.recording import (
    Bools,
    Column,
    Floats,
    Recording,
    join_vehicles,
    keep_vehicles,
)
from roadproof.extensions.traffic.formats.straight import StraightRoad, place_recording
from roadproof.library import scenarios
from roadproof.library.bind import bind, default_values
from roadproof.library.elaborate import read_claim
from roadproof.library.roles import vehicle_order
from roadproof.library.scenario_references import vehicles_by_role
from roadproof.library.specification import Library
from roadproof.library.words import words_of
from roadproof.semantics.sampled.batch import steps_of
from roadproof.world.drive import Drive
from roadproof.world.motion import state_at, states_at
from roadproof.world.signals import RECORDED, SIZES


@dataclass(frozen=True)
class PlantingPlace:
    """A place for a drive: its time 0 is at ``start_frame``, its (0, 0) at (``s``, ``d``) of the recording.

    ``seconds`` of the drive are planted; vehicles that come nearer to it than ``clear_along`` and
    ``clear_across`` (m, between boxes) are taken out of the recording.
    """

    direction: int
    start_frame: int
    seconds: Fraction
    s: float
    d: float
    clear_along: float = 8.0
    clear_across: float = 0.5


@dataclass(frozen=True)
class PlantedDrive:
    """The ground truth of a planted drive: who (id by the drive's name) and when."""

    recording: str
    vehicles: Mapping[str, int]
    first_frame: int
    last_frame: int
    removed: tuple[int, ...]


def plant(recording: Recording, drive: Drive, place: PlantingPlace) -> tuple[Recording, PlantedDrive]:
    """``recording`` with ``drive`` in it, sampled exactly and rounded to hundredths, and who is who.

    The drive's vehicles are cars that are seen in the same frames, from its time 0 on, so that the
    trace of the planted vehicles starts where the drive does. Raises ``UsageError`` where the drive
    does not fit into the section, the time or the lanes that the recording shows.
    """
    frames = int(place.seconds * float(recording.rate)) + 1
    last = place.start_frame + frames - 1
    _check_time(recording, place, last)
    names = sorted(drive.vehicles)
    samples = [_sample(drive, name, frames, place, recording.rate) for name in names]
    ids = int(recording.vehicle_id.max(initial=0)) + 1 + np.arange(len(names))
    vehicles: dict[str, Column] = {
        "vehicle_id": ids,
        "direction": np.full(len(names), place.direction),
        "kind": np.full(len(names), "Car"),
        **{x: np.array([round(float(getattr(drive.vehicles[n], x)), 2) for n in names]) for x in SIZES},
        "first_frame": np.full(len(names), place.start_frame),
    }
    guests = place_recording(
        StraightRoad(recording.lanes, recording.beside, ()),
        recording.name,
        recording.rate,
        vehicles,
        np.full(len(names), frames),
        map(np.concatenate, zip(*samples, strict=True)),
    )
    _check_section(recording, guests, names)
    in_the_way = _in_the_way(recording, guests, place)
    merged = join_vehicles(keep_vehicles(recording, ~in_the_way), guests)
    who = dict(zip(names, ids.tolist(), strict=True))
    removed = tuple(recording.vehicle_id[in_the_way].tolist())
    return merged, PlantedDrive(recording.name, who, place.start_frame, last, removed)


def _sample(drive: Drive, name: str, frames: int, place: PlantingPlace, rate: Rate) -> list[Floats]:
    motion = drive.vehicles[name]
    states = states_at(motion, (k / Fraction(rate) for k in range(frames)))
    shifts = {"s": place.s, "d": place.d}
    return [
        np.round([float(getattr(x, signal)) + shifts.get(signal, 0.0) for x in states], 2) + 0.0
        for signal in RECORDED
    ]


def _check_time(recording: Recording, place: PlantingPlace, last: int) -> None:
    first, end = int(recording.first_frame.min()), int(recording.last_frame.max())
    if not (place.seconds > 0 and first <= place.start_frame and last <= end):
        raise UsageError(
            f"plant: start_frame={place.start_frame}, seconds={float(place.seconds):g}: the drive must lie "
            f"within the frames {first} to {end} of recording {recording.name}"
        )


def _check_section(recording: Recording, guests: Recording, names: list[str]) -> None:
    """The guests must stay where the recording's own vehicles are seen, and on its lanes."""
    way = int(guests.direction[0])
    if way not in recording.direction:
        raise UsageError(f"plant: direction={way} has no vehicles in recording {recording.name}")
    low, high = _section(recording, way)
    vehicle = guests.row_vehicle
    outside = (guests.s > high) | (guests.s - guests.length[vehicle] < low) | (guests.occupancy == 0)
    if outside.any():
        row = int(np.argmax(outside))
        raise UsageError(
            f"plant: vehicle {names[vehicle[row]]} is at s={guests.s[row]:g}, d={guests.d[row]:g} in frame "
            f"{guests.row_frame[row]}: it must stay within s={low:g} to {high:g} and on the lanes of "
            f"recording {recording.name}; move the drive or plant fewer seconds"
        )


def _section(recording: Recording, way: int) -> tuple[float, float]:
    """Return the ends (m) of the section on which the vehicles of a direction are seen."""
    ours = np.repeat(recording.direction == way, np.diff(recording.start))
    rear = recording.s - recording.length[recording.row_vehicle]
    return float(rear[ours].min()), float(recording.s[ours].max())


def _in_the_way(recording: Recording, guests: Recording, place: PlantingPlace) -> Bools:
    """Return which vehicles of the recording come too near to a guest at any time."""
    vehicle, frame = recording.row_vehicle, recording.row_frame
    first, counts = place.start_frame, int(guests.start[1])
    rows = np.flatnonzero(
        (recording.direction[vehicle] == place.direction) & (frame >= first) & (frame < first + counts)
    )
    in_the_way = np.zeros(recording.vehicles, bool)
    who, when = vehicle[rows], frame[rows] - first
    for k in range(guests.vehicles):
        at = guests.start[k] + when
        near = np.ones(len(rows), bool)
        for mine, theirs, size, own, margin in (
            (recording.s, guests.s, recording.length, guests.length[k], place.clear_along),
            (recording.d, guests.d, recording.width, guests.width[k], place.clear_across),
        ):
            near &= mine[rows] > theirs[at] - own - margin
            near &= mine[rows] - size[who] < theirs[at] + margin
        in_the_way[who[near]] = True
    return in_the_way


PLANTED_COLUMNS = MATCH_COLUMNS[:-1]
PAUSE = 50
"""Frames between two planted drives of one direction."""


@dataclass(frozen=True)
class PlantedRow:
    """One row of planted.csv, in the terms of matches.csv."""

    recording: str
    sv: int
    pov: int
    pov2: int | None
    lane: str
    start_frame: int
    end_frame: int
    min_danger: Fraction
    set_name: str
    scenario: int
    title: str


def lane_width(files: Iterable[DriveFile]) -> float:
    """The width (m) of all lanes of all drives' roads. Raises ``UsageError`` where they differ."""
    widths = {x.d[1] - x.d[0] for file in files for x in file.road.lanelets}
    if len(widths) != 1:
        shown = ", ".join(f"{float(w):g}" for w in sorted(widths))
        raise UsageError(f"plant: lanes of the drives' roads are {shown} m wide; one width is needed")
    return float(widths.pop())


def plantable(file: DriveFile) -> str:
    """Return why a drive cannot be planted on a straight main road; "" if it can be tried."""
    if file.scenario is None:
        return "it is a drive of no scenario"
    if any(x.zone != "main" or x.s != (None, None) for x in file.road.lanelets):
        return f"its road {file.road.name} is more than a straight main road"
    return ""


def with_roles(file: DriveFile, library: Library) -> DriveFile:
    """A drive of a scenario whose vehicles, where the formula gives them other names, are called as roles."""
    if file.scenario is None:
        return file
    specification = library.select(file.set_name, file.options)
    scenario = scenarios.Scenario(file.scenario, file.set_name)
    own = vehicles_by_role(specification, read_claim(specification, file.formula).claim, scenario)
    if not own:
        return file
    roles = {name: role for role, name in own.items()}
    drive = file.drive.cast({roles.get(name, name): name for name in file.drive.vehicles})
    return replace(file, drive=drive, formula=scenarios.apply_scenario(specification, scenario).text)


def plant_drives(
    recording: Recording, files: Sequence[DriveFile], library: Library
) -> tuple[Recording, list[PlantedRow], list[str]]:
    """``recording`` with the drives in turn wherever there is time, what is true, and what was left out.

    Both directions get drives, one after the other. Raises ``UsageError`` for a road with more lanes
    than the recording has.
    """
    truths: list[PlantedRow] = []
    left_out: list[str] = []
    turn = iter(cycle(range(len(files))))
    for way in (LOWER, UPPER):
        frame = int(recording.first_frame.min()) + PAUSE
        refused: set[int] = set()
        while len(refused) < len(files):
            k = next(turn)
            place = _place(recording, files[k], way, frame)
            if frame + int(place.seconds * float(recording.rate)) + PAUSE > int(recording.last_frame.max()):
                refused.add(k)
                continue
            merged, planted = plant(recording, files[k].drive, place)
            outcome = _confirm(merged, planted, files[k], library)
            if isinstance(outcome, str):
                refused.add(k)
                left_out.append(f"scenario {files[k].scenario}, {files[k].set_name}: {outcome}")
                continue
            recording = merged
            truths.append(outcome)
            frame = planted.last_frame + PAUSE
    return recording, truths, list(dict.fromkeys(left_out))


def _place(recording: Recording, file: DriveFile, way: int, frame: int) -> PlantingPlace:
    """The drive's road over the rightmost lanes, its last vehicle just inside the section."""
    bands = [lane.d for lane in recording.lanes if lane.direction == way and lane.d is not None]
    if len(file.road.lanes) > len(bands):
        raise UsageError(
            f"plant: road {file.road.name} has {len(file.road.lanes)} lanes, the recording {len(bands)}; "
            "simulate more lanes"
        )
    right = min(band[0] for band in bands) - float(min(x.d[0] for x in file.road.lanelets))
    low, high = _section(recording, way)
    motions = file.drive.vehicles.values()
    s = low + 0.5 - min(float(m.s - m.length) for m in motions)
    dt = 1 / Fraction(recording.rate)
    steps = int(file.horizon / dt)
    while steps > 1 and max(float(state_at(m, steps * dt).s) for m in motions) + s > high - 0.5:
        steps -= 1
    return PlantingPlace(way, frame, steps * dt, round(s, 2), right)


def _confirm(
    recording: Recording, planted: PlantedDrive, file: DriveFile, library: Library
) -> PlantedRow | str:
    """The truth of a planted drive, or why its scenario cannot be told from the samples."""
    number = file.scenario
    assert number is not None
    names = vehicle_order(file.drive.vehicles)
    index = {n: int(np.flatnonzero(recording.vehicle_id == planted.vehicles[n])[0]) for n in names}
    spec = library.select(file.set_name, file.options)
    values = {**default_values(library), **file.values}
    whole = cut_trace(recording, "planted", index, (planted.first_frame, planted.last_frame))
    endangers = bind(
        scenarios.danger(spec, *scenario_parts.danger_pair(names)).formula, whole.road, {}, values
    )
    reading = TraceReader(trace_of(whole.batch))
    dangers = [k for k in range(whole.batch.samples) if reading.holds(endangers, k, "strong")]
    if not dangers:
        return "no danger within the section"
    last = planted.first_frame + dangers[-1] + steps_of(values[scenarios.MIN_DANGER], whole.batch.dt)
    lane = whole.lanes.get(scenario_parts.lane_owner(spec, scenarios.Scenario(number, file.set_name)), "")
    if not _same_lane(whole, file, lane):
        return f"its lane {file.lanes.get(scenarios.LANE)} is not the one that an evaluation takes"
    cut = cut_trace(recording, "planted", index, (planted.first_frame, last))
    formula = bind(read_claim(spec, file.formula).formula, cut.road, {scenarios.LANE: lane}, values)
    if not TraceReader(trace_of(cut.batch)).holds(formula, 0, "strong"):
        return "the trace ends with its last danger, before the scenario is complete"
    ids = planted.vehicles
    pov2 = ids[names[2]] if len(names) > 2 else None
    return PlantedRow(
        recording.name,
        ids[scenarios.SUBJECT],
        ids[names[1]],
        pov2,
        lane,
        planted.first_frame,
        last,
        values[scenarios.MIN_DANGER],
        file.set_name,
        number,
        words_of(spec, number).title,
    )


def _same_lane(trace: OneTrace, file: DriveFile, lane: str) -> bool:
    """Return whether ``lane`` lies over the drive's own L, counted from the right."""
    ours = sorted(trace.road.lanelets, key=lambda x: x.d[0])
    theirs = sorted(file.road.lanelets, key=lambda x: x.d[0])
    places = {x.lane: k for k, x in enumerate(theirs)}
    return file.lanes.get(scenarios.LANE) in places and lane == ours[places[file.lanes[scenarios.LANE]]].lane


def rows_of(truths: Iterable[PlantedRow]) -> Iterator[list[object]]:
    """Rows of planted.csv, in the order of PLANTED_COLUMNS."""
    for x in truths:
        danger = f"{float(x.min_danger):g}"
        pov2 = "" if x.pov2 is None else x.pov2
        frames = (x.start_frame, x.end_frame, danger)
        yield [x.recording, x.sv, x.pov, pov2, x.lane, *frames, x.set_name, x.scenario, x.title]
