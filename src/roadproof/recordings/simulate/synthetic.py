"""Recordings made of simulated traffic: 25 Hz, in semantics §2's coordinates, decimals like highD's."""

import numpy as np

from roadproof.recordings.formats.highd import LOWER, UPPER, lanes_of_markings
from roadproof.recordings.formats.recording import Floats, Integers, Recording, offsets
from roadproof.recordings.formats.straight import of_bands, place
from roadproof.recordings.simulate.simulate import STEP_SECONDS, Movement, move_traffic
from roadproof.recordings.simulate.traffic import Traffic


def simulate(traffic: Traffic, seed: int, number: int = 1) -> Recording:
    """Recording ``number`` (named 01, 02, …) of ``traffic``; it depends on ``seed`` and ``number`` only.

    Vehicles are in the recording while their whole box is within the section. All values are rounded
    to the hundredth, so that writing and reading the recording gives the same one.
    """
    random = np.random.default_rng([seed, number])
    movement = move_traffic(traffic, random)
    upper, lower = markings_of(traffic)
    road = of_bands(lanes_of_markings(upper, lower))
    row, tick = _sample_rows(traffic, movement)
    vehicle = movement.vehicle[row]
    order = np.argsort(vehicle, kind="stable")
    row, tick, vehicle = row[order], tick[order], vehicle[order]
    frame = movement.step[row] * _ticks(traffic) + tick + 1

    after = tick / traffic.rate
    v, a = movement.v[row], movement.a[row]
    along = movement.s[row] + v * after + a * after**2 / 2
    d, v_lat, a_lat = _drive_across(traffic, movement, row, after, random)
    first = np.flatnonzero(np.diff(vehicle, prepend=-1) != 0)
    by_entry = np.lexsort((vehicle[first], frame[first]))
    counts = np.diff(np.append(first, len(vehicle)))[by_entry]
    rows = np.repeat(first[by_entry] - offsets(counts)[:-1], counts) + np.arange(len(vehicle))

    seen = vehicle[first][by_entry]
    way = movement.direction[seen]
    up = np.repeat(way == 0, counts)
    ramp = (traffic.tracks - traffic.lanes) * traffic.lane_width  # which the upper carriageway has not
    right_edge = np.where(up, upper[0] - ramp, -lower[-1])
    s: Floats = np.round(along[rows] - np.where(up, traffic.section, 0.0), 2)
    d = np.round(d[rows] + right_edge, 2)
    direction = np.where(way == 0, UPPER, LOWER)
    length, width = movement.length[seen], movement.width[seen]
    sizes = (np.repeat(x, counts) for x in (length, width))
    return Recording(
        name=f"{number:02d}",
        rate=traffic.rate,
        **vars(road),
        vehicle_id=np.arange(1, len(seen) + 1),
        direction=direction,
        kind=np.where(movement.truck[seen], "Truck", "Car"),
        length=length,
        width=width,
        first_frame=frame[first][by_entry],
        start=offsets(counts),
        s=s,
        d=d,
        v_lon=_two_decimals((v + a * after)[rows]),
        v_lat=_two_decimals(v_lat[rows]),
        a_lon=_two_decimals(a[rows]),
        a_lat=_two_decimals(a_lat[rows]),
        **vars(place(road, np.repeat(direction, counts), s, d, *sizes)),
    )


def _two_decimals(values: Floats) -> Floats:
    return np.round(values, 2) + 0.0  # no negative zero


def markings_of(traffic: Traffic) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """y of the markings: upper carriageway, 4.5 m, lower carriageway."""

    def lines(top: float, lanes: int) -> tuple[float, ...]:
        return tuple(round(top + k * traffic.lane_width, 2) for k in range(lanes + 1))

    upper = lines(8.5, traffic.lanes)
    return upper, lines(upper[-1] + 4.5, traffic.tracks)


def _ticks(traffic: Traffic) -> int:
    return round(STEP_SECONDS * traffic.rate)


def _sample_rows(traffic: Traffic, movement: Movement) -> tuple[Integers, Integers]:
    """Row of the movement and tick since it, for every sample in which the box is within the section."""
    ticks = _ticks(traffic)
    row = np.repeat(np.arange(len(movement.step)), ticks)
    tick = np.tile(np.arange(ticks), len(movement.step))
    after = tick / traffic.rate
    front = movement.s[row] + movement.v[row] * after + movement.a[row] * after**2 / 2
    seen = (front <= traffic.section) & (front >= movement.length[movement.vehicle[row]])
    seen &= movement.step[row] * ticks + tick < round(traffic.seconds * traffic.rate)
    return row[seen], tick[seen]


def _drive_across(
    traffic: Traffic, movement: Movement, row: Integers, after: Floats, random: np.random.Generator
) -> tuple[Floats, Floats, Floats]:
    """Left side from the right edge of the road, lateral velocity and acceleration, for every sample.

    A lane change is the quintic with no speed and no acceleration at both ends; within the lane each
    vehicle swings a little about a place of its own.
    """
    vehicle, time = movement.vehicle[row], movement.step[row] * STEP_SECONDS + after
    count = len(movement.direction)
    offset, swing = np.clip(random.normal(0, 0.12, count), -0.3, 0.3), random.uniform(0.02, 0.12, count)
    pulse, phase = 2 * np.pi / random.uniform(7, 16, count), random.uniform(0, 2 * np.pi, count)
    angle = pulse[vehicle] * time + phase[vehicle]
    middle = (movement.lane[row] + 0.5) * traffic.lane_width
    d = middle + movement.width[vehicle] / 2 + offset[vehicle] + swing[vehicle] * np.sin(angle)
    v = swing[vehicle] * pulse[vehicle] * np.cos(angle)
    a = -swing[vehicle] * pulse[vehicle] ** 2 * np.sin(angle)

    changing = np.flatnonzero(movement.change[row] >= 0)
    change = movement.change[row[changing]]
    seconds = movement.change_seconds[change]
    way = (movement.change_to[change] - movement.lane[row[changing]]) * traffic.lane_width
    x = np.clip((time[changing] - movement.change_start[change] * STEP_SECONDS) / seconds, 0, 1)
    d[changing] += way * x**3 * (10 - 15 * x + 6 * x**2)
    v[changing] += way / seconds * 30 * x**2 * (1 - x) ** 2
    a[changing] += way / seconds**2 * 60 * x * (1 - x) * (1 - 2 * x)
    return d, v, a
