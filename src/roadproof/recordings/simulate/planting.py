"""Witness drives in simulated traffic: where each goes, and what must be found there.

A drive is planted only if the plain recursive evaluator confirms, on the samples as they are written
and on the trace cut as an evaluation cuts it, that the drive's scenario is true there; so what is
written down as planted is a ground truth for recall.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import cycle

import numpy as np

from roadproof.errors import UsageError
from roadproof.evidence.drive_file import DriveFile
from roadproof.library.bind import bind, default_values
from roadproof.library.elaborate import read_claim
from roadproof.library.scenarios import LANE, MIN_DANGER, SUBJECT, Scenario, danger, endangered, lane_owner
from roadproof.library.specification import Library
from roadproof.library.words import words_of
from roadproof.recordings.evaluate.one_trace import OneTrace, cut_trace
from roadproof.recordings.evaluate.recheck import trace_of
from roadproof.recordings.formats.highd import LOWER, UPPER
from roadproof.recordings.formats.recording import Recording
from roadproof.recordings.simulate.plant import Place, PlantedDrive, plant
from roadproof.semantics.sampled.batch import steps_of
from roadproof.semantics.sampled.recursive import TraceReader
from roadproof.world.motion import state_at

PLANTED_COLUMNS = (
    "recording",
    "sv",
    "pov",
    "pov2",
    "lane",
    "start_frame",
    "end_frame",
    "min_danger",
    "set",
    "scenario",
    "title",
)
PAUSE = 50
"""Frames between two planted drives of one direction."""


@dataclass(frozen=True)
class Truth:
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
    """Why a drive cannot be planted on a straight main road; "" if it can be tried."""
    if file.scenario is None:
        return "it is a drive of no scenario"
    if any(x.zone != "main" or x.s != (None, None) for x in file.road.lanelets):
        return f"its road {file.road.name} is more than a straight main road"
    return ""


def plant_drives(
    recording: Recording, files: Sequence[DriveFile], library: Library
) -> tuple[Recording, list[Truth], list[str]]:
    """``recording`` with the drives in turn wherever there is time, what is true, and what was left out.

    Both directions get drives, one after the other. Raises ``UsageError`` for a road with more lanes
    than the recording has.
    """
    truths: list[Truth] = []
    left_out: list[str] = []
    turn = iter(cycle(range(len(files))))
    for way in (LOWER, UPPER):
        frame = int(recording.first_frame.min()) + PAUSE
        refused: set[int] = set()
        while len(refused) < len(files):
            k = next(turn)
            place = _place(recording, files[k], way, frame)
            if frame + int(place.seconds * recording.rate) + PAUSE > int(recording.last_frame.max()):
                refused.add(k)
                continue
            merged, planted = plant(recording, files[k].drive, place)
            found = _confirm(merged, planted, files[k], library)
            if isinstance(found, str):
                refused.add(k)
                left_out.append(f"scenario {files[k].scenario}, {files[k].set_name}: {found}")
                continue
            recording = merged
            truths.append(found)
            frame = planted.last_frame + PAUSE
    return recording, truths, list(dict.fromkeys(left_out))


def _place(recording: Recording, file: DriveFile, way: int, frame: int) -> Place:
    """The drive's road over the rightmost lanes, its last vehicle just inside the section."""
    bands = [lane.d for lane in recording.lanes if lane.direction == way and lane.d is not None]
    if len(file.road.lanes) > len(bands):
        raise UsageError(
            f"plant: road {file.road.name} has {len(file.road.lanes)} lanes, the recording {len(bands)}; "
            "simulate more lanes"
        )
    right = min(band[0] for band in bands) - float(min(x.d[0] for x in file.road.lanelets))
    ours = np.repeat(recording.direction == way, np.diff(recording.start))
    rear = recording.s - recording.length[recording.row_vehicle]
    low, high = float(rear[ours].min()), float(recording.s[ours].max())
    motions = file.drive.vehicles.values()
    s = low + 0.5 - min(float(m.s - m.length) for m in motions)
    dt = Fraction(1, recording.rate)
    steps = int(file.horizon / dt)
    while steps > 1 and max(float(state_at(m, steps * dt).s) for m in motions) + s > high - 0.5:
        steps -= 1
    return Place(way, frame, steps * dt, round(s, 2), right)


def _confirm(recording: Recording, planted: PlantedDrive, file: DriveFile, library: Library) -> Truth | str:
    """The truth of a planted drive, or why its scenario cannot be told from the samples."""
    number = file.scenario
    assert number is not None
    names = sorted(file.drive.vehicles, key=lambda name: (name != SUBJECT, name))
    index = {n: int(np.flatnonzero(recording.vehicle_id == planted.vehicles[n])[0]) for n in names}
    spec = library.select(file.set_name, file.options)
    values = {**default_values(library), **file.values}
    whole = cut_trace(recording, "planted", index, (planted.first_frame, planted.last_frame))
    endangers = bind(danger(spec, *endangered(names)).formula, whole.road, {}, values)
    reading = TraceReader(trace_of(whole.batch))
    dangers = [k for k in range(whole.batch.samples) if reading.holds(endangers, k, "strong")]
    if not dangers:
        return "no danger within the section"
    last = planted.first_frame + dangers[-1] + steps_of(values[MIN_DANGER], whole.batch.dt)
    lane = whole.lanes.get(lane_owner(spec, Scenario(number, file.set_name)), "")
    if not _same_lane(whole, file, lane):
        return f"its lane {file.lanes.get(LANE)} is not the one that an evaluation takes"
    cut = cut_trace(recording, "planted", index, (planted.first_frame, last))
    formula = bind(read_claim(spec, file.formula).formula, cut.road, {LANE: lane}, values)
    if not TraceReader(trace_of(cut.batch)).holds(formula, 0, "strong"):
        return "the trace ends with its last danger, before the scenario is complete"
    ids = planted.vehicles
    pov2 = ids[names[2]] if len(names) > 2 else None
    return Truth(
        recording.name,
        ids[SUBJECT],
        ids[names[1]],
        pov2,
        lane,
        planted.first_frame,
        last,
        values[MIN_DANGER],
        file.set_name,
        number,
        words_of(spec, number).title,
    )


def _same_lane(trace: OneTrace, file: DriveFile, lane: str) -> bool:
    """Whether ``lane`` lies over the drive's own L, counted from the right."""
    ours = sorted(trace.road.lanelets, key=lambda x: x.d[0])
    theirs = sorted(file.road.lanelets, key=lambda x: x.d[0])
    places = {x.lane: k for k, x in enumerate(theirs)}
    return file.lanes.get(LANE) in places and lane == ours[places[file.lanes[LANE]]].lane


def rows_of(truths: Iterable[Truth]) -> Iterator[list[object]]:
    """Rows of planted.csv, in the order of PLANTED_COLUMNS."""
    for x in truths:
        danger = f"{float(x.min_danger):g}"
        pov2 = "" if x.pov2 is None else x.pov2
        frames = (x.start_frame, x.end_frame, danger)
        yield [x.recording, x.sv, x.pov, pov2, x.lane, *frames, x.set_name, x.scenario, x.title]
