"""Recordings in CommonRoad XML, version 2020a: dynamic obstacles on lanelets, projected on their road.

``NAME_zones.toml`` beside the file may say which lanelets are of ramps, and in which zone.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial
from itertools import pairwise
from pathlib import Path

import numpy as np

from roadproof.errors import InputError
from roadproof.extensions.exchange.commonroad_obstacles import Obstacle, ObstacleRules, read_obstacles
from roadproof.extensions.maps.commonroad import lanelets_of
from roadproof.extensions.maps.harmless import COMMONROAD
from roadproof.extensions.maps.network import ZONES_ENDING
from roadproof.extensions.maps.xml_reader import Element, number_in, parts_not_read, read_xml, summary_of
from roadproof.extensions.traffic.formats.clock import LARGEST_RATE, LONGEST_STEP, Rate, rate_near, samples_in
from roadproof.extensions.traffic.formats.lanelets import network_of
from roadproof.extensions.traffic.formats.measured_roads import MeasuredTraffic, place_traffic
from roadproof.extensions.traffic.formats.off_line import follows_line, leave_out_strays
from roadproof.extensions.traffic.formats.overlaps import describe_overlaps
from roadproof.extensions.traffic.formats.plausible import SHARE, ContradictionChecks
from roadproof.extensions.traffic.formats.recording import (
    Bools,
    Floats,
    Integers,
    Recording,
    offsets,
    with_notes,
)
from roadproof.extensions.traffic.formats.reliable import contradicts_motion, first_names, reliable_part
from roadproof.extensions.traffic.formats.repeats import moments_of
from roadproof.extensions.traffic.formats.source import Format, find_files
from roadproof.world.not_read import not_read_note


def read_commonroad(path: Path, strict: bool = True, truck_length: float = 7.0) -> Recording:
    """The traffic of a CommonRoad file; frame k is time step k.

    Unless ``strict``, pedestrians, cyclists, parked vehicles and bad vehicles are left out, and values that
    states do not have are computed from the others.

    A vehicle longer than ``truck_length`` (m) counts as a truck whatever its type says, since data
    sets such as NGSIM's label every vehicle a car. ``notes`` tell of overlapping vehicles, of noise
    and of obstacles that were left out. Raises ``InputError`` for files that are no such recording.
    """
    root = read_xml(path, "commonRoad")
    if root.get("commonRoadVersion") != "2020a":
        problem = f"commonRoadVersion={root.get('commonRoadVersion')}"
        raise InputError(f"{path}: {problem}: commonRoad of version 2020a is needed")
    step = number_in(path, root.get("timeStepSize"), "timeStepSize of commonRoad")
    if not 1 / LARGEST_RATE <= step <= LONGEST_STEP:
        problem = f"a step lies between {1 / LARGEST_RATE:g} and {LONGEST_STEP} s"
        raise InputError(f"{path}: timeStepSize={step}: {problem}")
    rate = rate_near(step)
    network = network_of(path, lanelets_of(path, root), strict)
    obstacles, notes = read_obstacles(path, root, ObstacleRules(rate, truck_length, strict))
    omissions = not_read_note(path, summary_of(parts_not_read(root, COMMONROAD)), strict)
    traffic = _traffic(path.stem, rate, obstacles, (*notes, *omissions))
    if _is_synthetic(root):
        traffic = replace(traffic, moments=np.zeros_like(traffic.moments))
    whole = place_traffic(traffic, network)
    strays = _motion_matches_velocity(traffic) & ~follows_line(traffic.centre, whole)
    fitting = leave_out_strays(whole, ~strays, strict)
    recording = reliable_part(fitting, strict, partial(_contradiction_notes, path, fitting))
    return with_notes(recording, (*_consistent_motion_note(traffic, whole, recording), *_describe(recording)))


def subject_of_problem(path: Path) -> str:
    """The id of the obstacle that begins as the only planning problem says; empty where none does.

    Exporters of drives keep the vehicle under test as an obstacle beside the problem. Raises ``InputError``.
    """
    root = read_xml(path, "commonRoad")
    problems = root.findall("planningProblem/initialState")
    if len(problems) != 1:
        return ""
    start = _initial_values(problems[0])
    candidates = [
        node.get("id", "")
        for node in root.findall("dynamicObstacle")
        if start is not None and _are_close(start, _initial_values(node.find("initialState")))
    ]
    return candidates[0] if len(candidates) == 1 else ""


_INITIAL_VALUES = ("time/exact", "position/point/x", "position/point/y", "velocity/exact")


def _initial_values(node: Element | None) -> tuple[float, ...] | None:
    """Time, place and speed of an initial state, where it has exact ones."""
    try:
        return None if node is None else tuple(float(node.findtext(x) or "") for x in _INITIAL_VALUES)
    except ValueError:
        return None


def _are_close(one: tuple[float, ...], other: tuple[float, ...] | None) -> bool:
    return other is not None and all(abs(a - b) < 0.01 for a, b in zip(one, other, strict=True))


def _consistent_motion_note(traffic: MeasuredTraffic, whole: Recording, part: Recording) -> Iterator[str]:
    """A note on vehicles that were left out for the reference line, as they move as their velocities say."""
    lost = ~np.isin(whole.vehicle_id, part.vehicle_id)
    if lost.any():
        lost &= _motion_matches_velocity(traffic)
    ids = [int(whole.vehicle_id[v]) for v in np.flatnonzero(lost) if contradicts_motion(whole, int(v))]
    if ids:
        yield (
            f"of the vehicles left out, {len(ids)} ({first_names(ids)}) "
            "move in the plane as their velocities say: "
            "the reference line of the road does not follow their way"
        )


def _motion_matches_velocity(traffic: MeasuredTraffic) -> Bools:
    """Return for each vehicle whether it moves as its velocities say, in nine seconds of ten."""
    matches = np.ones(len(traffic.vehicle_id), np.bool_)
    speed = np.hypot(*traffic.velocity.T)
    for v, (begin, end) in enumerate(pairwise(traffic.start.tolist())):
        way = np.hypot(*np.diff(traffic.centre[begin:end], axis=0).T)
        expected = (speed[begin : end - 1] + speed[begin + 1 : end]) / 2 / float(traffic.rate)
        seconds = np.ones(min(samples_in(traffic.rate), len(way)))
        if not len(seconds):
            continue
        one, other = np.convolve(way, seconds, "valid"), np.convolve(expected, seconds, "valid")
        greater = np.maximum(one, other)
        wrong = (greater > 1) & (np.abs(one - other) > SHARE * greater + 0.2)
        matches[v] = np.count_nonzero(wrong) <= SHARE * len(wrong)
    return matches


def _is_synthetic(root: Element) -> bool:
    """Return whether the traffic was made and not recorded: ZAM stands for no country in a benchmark's name.

    Then no file is a window of what another shows.
    """
    return root.get("benchmarkID", "").removeprefix("C-").startswith("ZAM_")


def _traffic(name: str, rate: Rate, obstacles: Sequence[Obstacle], notes: tuple[str, ...]) -> MeasuredTraffic:
    counts = np.array([len(o.states) for o in obstacles])
    states = np.concatenate([o.states for o in obstacles])
    length, width = (np.array([getattr(o, x) for o in obstacles]) for x in ("length", "width"))
    sizes = np.repeat(np.stack((length, width), axis=1), counts, axis=0)
    heading, speed, pull, drift = states[:, 2], states[:, 3], states[:, 4], states[:, 5]
    forward = np.stack((np.cos(heading), np.sin(heading)), axis=1)
    aside = np.stack((-np.sin(heading), np.cos(heading)), axis=1)
    start = offsets(counts)
    return MeasuredTraffic(
        name=name,
        rate=rate,
        vehicle_id=np.array([o.id for o in obstacles]),
        kind=np.array([o.kind for o in obstacles]),
        label=np.array([o.label for o in obstacles]),
        length=length,
        width=width,
        first_frame=np.array([o.first_step for o in obstacles]),
        start=start,
        centre=states[:, :2],
        heading=heading,
        velocity=speed[:, None] * forward + drift[:, None] * aside,
        acceleration=pull[:, None] * forward + _rate_of_drift(drift, start, rate)[:, None] * aside,
        acceleration_turns=False,
        notes=notes,
        moments=moments_of(np.column_stack((speed, pull, sizes)), start),
    )


def _rate_of_drift(drift: Floats, start: Integers, rate: Rate) -> Floats:
    """Return the change of velocityY in a second from each sample to the next, the last one repeated.

    States have no acceleration across the box.
    """
    step = np.diff(drift, append=0.0) * float(rate)
    last = start[1:] - 1
    step[last] = np.where(np.diff(start) > 1, step[last - 1], 0.0)
    return step


def _contradiction_notes(
    path: Path, whole: Recording, checks: ContradictionChecks, rows: Integers
) -> Iterator[str]:
    """Notes on what the file contradicts itself in. Raises ``InputError`` where that is too much."""
    ids, frames = whole.vehicle_id[whole.row_vehicle][rows], whole.row_frame[rows]
    contradictions = [
        (f"{ids[x.row]}, time step {frames[x.row]}: {x.text}", x.refused) for x in checks.contradictions()
    ]
    off = checks.off_road()
    if off is not None:
        contradictions.append(
            (f"{ids[off.row]}: on no lanelet at any time, like {off.count} obstacles", off.refused)
        )
    for message, refused in contradictions:
        if refused:
            raise InputError(f"{path}: dynamicObstacle {message}")
        yield f"dynamicObstacle {message}"


def _describe(recording: Recording) -> Iterator[str]:
    """Notes on overlaps, noise and vehicles beside the road."""
    yield from describe_overlaps(recording)
    low, high = np.percentile(recording.a_lon, [0.5, 99.5])
    yield f"accelerations: 99 % within {low:.1f} and {high:.1f} m/s²"
    off = int(np.count_nonzero(recording.lane < 0))
    if off:
        yield f"{off} of {len(recording.s)} samples have the centre of the box on no lane"


FORMAT = Format(
    "CommonRoad",
    "NAME.xml of CommonRoad 2020a",
    partial(find_files, suffix=".xml", ending=ZONES_ENDING),
    read_commonroad,
    "{0}: timeStepSize={step:g}",
)
