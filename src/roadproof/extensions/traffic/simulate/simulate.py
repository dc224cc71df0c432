"""Seeded highway traffic of highD's shape: car following by IDM, lane changes by MOBIL.

IDM: Treiber, Hennecke, Helbing, *Congested traffic states in empirical observations and microscopic
simulations*, Phys. Rev. E 62 (2000). MOBIL: Kesting, Treiber, Helbing, *General lane-changing model
MOBIL for car-following models*, Transp. Res. Rec. 1999 (2007). Both carriageways of a recording
advance together, as one set of arrays; decisions fall five times a second, between them
accelerations are constant, so that the 25 Hz samples are exact.

A recording has 25 samples a second in the coordinates of semantics §2, with decimals as highD's.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from roadproof.extensions.traffic.formats.highd_columns import LOWER, UPPER, lanes_of_markings
from roadproof.extensions.traffic.formats.recording import Bools, Floats, Integers, Recording, offsets
from roadproof.extensions.traffic.formats.straight import of_bands, place_recording
from roadproof.extensions.traffic.simulate import traffic as traffic_settings


@dataclass(frozen=True)
class Movement:
    """The result of a simulation: a row a vehicle, and a row a (decision, vehicle) in the section.

    ``lane`` counts from the right; ``change`` is the row of the lane change under way, -1 for none.
    Rows are in order of time; ``s`` is the front's way along the section in driving direction.
    """

    direction: Integers  # per vehicle: 0 or 1
    truck: Bools
    length: Floats
    width: Floats
    step: Integers  # per row
    vehicle: Integers
    s: Floats
    v: Floats
    a: Floats
    lane: Integers
    change: Integers
    change_start: Integers  # per lane change: step
    change_seconds: Floats
    change_to: Integers


STEP_SECONDS = 0.2
"""Time between two decisions."""

_APPROACH = 800.0  # where vehicles enter, before the section, so that traffic has formed when it is seen
_DEPARTURE = 250.0
_WARM_UP = 300  # steps
_SAFE_BRAKING = 4.0  # MOBIL: what a lane change may ask of the new follower
_HARDEST_BRAKING = 9.0


class _Road:
    """All vehicles of both carriageways; lanes are numbered through: direction * tracks + lane."""

    def __init__(self, traffic: traffic_settings.TrafficSettings, random: traffic_settings.Random) -> None:
        self.traffic = traffic
        self.random = random
        self.steps = _WARM_UP + int(np.ceil(traffic.seconds / STEP_SECONDS)) + 1
        self.queues = traffic_settings.draw_arrivals(traffic, self.steps * STEP_SECONDS, random)
        count = sum(len(times) for times in self.queues)
        self.lane_of = np.repeat(np.arange(len(self.queues)), [len(times) for times in self.queues])
        self.drivers = traffic_settings.DriverParameters(self.lane_of, traffic, random)
        self.s = np.zeros(count)
        self.v = np.zeros(count)
        self.change = np.full(count, -1)
        self.brake_until = np.zeros(count, np.int64)
        self.brake_by = np.zeros(count)
        self.active = np.zeros(0, np.int64)
        self.queue_times = np.concatenate(self.queues)
        ends: list[int] = offsets(np.array([len(q) for q in self.queues])).tolist()
        self.next_in_queue, self.queue_ends = ends[:-1], ends[1:]
        self.changes: list[tuple[int, float, int, int]] = []  # step, seconds, to, vehicle
        self.leaves = traffic_settings.leaving_vehicles(traffic, self.lane_of, random)

    def run(self) -> Movement:
        log: list[tuple[npt.NDArray[Any], ...]] = []
        for step in range(self.steps):
            self._enter(step * STEP_SECONDS)
            self._finish_changes(step)
            a = self._decide(step)
            now = self.active
            if step >= _WARM_UP:
                seen = (self.s[now] > -20) & (self.s[now] < self.traffic.section + 60)
                shown = now[seen]
                rows = (np.full(len(shown), step - _WARM_UP), shown, self.s[shown], self.v[shown], a[seen])
                log.append((*rows, self.lane_of[shown] % self.traffic.tracks, self.change[shown]))
            self.s[now] += self.v[now] * STEP_SECONDS + a * STEP_SECONDS**2 / 2
            self.v[now] = np.maximum(0, self.v[now] + a * STEP_SECONDS)
            self.active = now[self.s[now] < self.traffic.section + _DEPARTURE]
        columns = [np.concatenate(parts) for parts in zip(*log, strict=True)]
        changes = np.array([c[:3] for c in self.changes], float).reshape(-1, 3)
        drivers, tracks = self.drivers, self.traffic.tracks
        vehicles = (self.lane_of // tracks, drivers.truck, drivers.length, drivers.width)
        start, to = (changes[:, k].astype(np.int64) for k in (0, 2))
        change = {"change_start": start - _WARM_UP, "change_seconds": changes[:, 1], "change_to": to % tracks}
        return Movement(*vehicles, *columns, **change)

    def _enter(self, time: float) -> None:
        """Add at most one vehicle to each lane, if it is due and the one ahead is far enough away."""
        for lane, vehicle in enumerate(self.next_in_queue):
            if vehicle == self.queue_ends[lane] or self.queue_times[vehicle] > time:
                continue
            ours = self.active[self.lane_of[self.active] == lane]
            speed = self.drivers.desired[vehicle]
            if len(ours):
                last = ours[np.argmin(self.s[ours])]
                speed = min(speed, self.v[last])
                room = self.s[last] - self.drivers.length[last] + _APPROACH
                if room < 2 + self.drivers.headway[vehicle] * speed:
                    continue
            self.s[vehicle], self.v[vehicle] = -_APPROACH, speed
            self.active = np.append(self.active, vehicle)
            self.next_in_queue[lane] += 1

    def _finish_changes(self, step: int) -> None:
        for vehicle in self.active[self.change[self.active] >= 0]:
            start, seconds, to, _ = self.changes[self.change[vehicle]]
            if (step - start) * STEP_SECONDS >= seconds:
                self.lane_of[vehicle] = to
                self.change[vehicle] = -1

    def _decide(self, step: int) -> Floats:
        """Accelerations of the active vehicles from now to the next decision; may begin lane changes.

        A vehicle that changes lanes is present in both: it follows both leaders and leads both followers.
        """
        now = self.active
        place = np.arange(len(now))
        changing = place[self.change[now] >= 0]
        targets = np.array([self.changes[c][2] for c in self.change[now[changing]]], np.int64)
        entry = np.concatenate((place, changing))
        lane = np.concatenate((self.lane_of[now], targets))
        key = lane * 1e6 + self.s[now][entry]
        order = np.argsort(key, kind="stable")
        queue = _Queue(key[order], lane[order], now[entry[order]])
        followed = self._follow(queue.vehicle, queue.leader(np.arange(len(order)) + 1, queue.lane))
        a = np.full(len(now), np.inf)
        np.minimum.at(a, entry[order], followed)
        if self.traffic.ramp != "none":
            room = traffic_settings.room_ahead(
                self.traffic, self.lane_of[now], self.s[now], self.change[now] >= 0
            )
            a = np.minimum(a, self._stop(now, room))
        a = self._brake_at_random(step, a)
        if len(now):
            self._change_lanes(step, queue, a)
        return np.maximum(np.clip(a, -_HARDEST_BRAKING, None), -self.v[now] / STEP_SECONDS)

    def _follow(self, vehicle: Integers, leader: Integers) -> Floats:
        """IDM acceleration of ``vehicle`` behind ``leader`` (-1: free road)."""
        drivers = self.drivers
        v, limit = self.v[vehicle], drivers.acceleration[vehicle]
        gap = np.where(leader >= 0, self.s[leader] - drivers.length[leader] - self.s[vehicle], np.inf)
        approach = v * (v - self.v[leader]) / (2 * np.sqrt(limit * drivers.braking[vehicle]))
        wished = 2.0 + np.maximum(0, v * drivers.headway[vehicle] + np.where(leader >= 0, approach, 0))
        return limit * (1 - (v / drivers.desired[vehicle]) ** 4 - (wished / np.maximum(gap, 0.1)) ** 2)

    def _stop(self, vehicle: Integers, gap: Floats) -> Floats:
        """IDM acceleration of ``vehicle`` before a place that it may not pass."""
        drivers, v = self.drivers, self.v[vehicle]
        limit = drivers.acceleration[vehicle]
        wished = 2.0 + v * drivers.headway[vehicle] + v * v / (2 * np.sqrt(limit * drivers.braking[vehicle]))
        a: Floats = limit * (1 - (v / drivers.desired[vehicle]) ** 4 - (wished / gap) ** 2)
        return a

    def _brake_at_random(self, step: int, a: Floats) -> Floats:
        """Now and then a driver brakes for no reason that others see, which starts a braking wave."""
        now = self.active
        if len(now) and self.random.random() < STEP_SECONDS / 6:
            chosen = now[self.random.integers(len(now))]
            self.brake_until[chosen] = step + self.random.integers(4, 16)
            self.brake_by[chosen] = self.random.uniform(1, 4)
        return np.where(self.brake_until[now] > step, np.minimum(a, -self.brake_by[now]), a)

    def _change_lanes(self, step: int, queue: "_Queue", a: Floats) -> None:
        """MOBIL: at most one vehicle of each direction begins to change lanes at a time."""
        now, lanes = self.active, self.traffic.tracks
        lane = self.lane_of[now]
        place = np.searchsorted(queue.key, lane * 1e6 + self.s[now])
        behind = queue.follower(place - 1, lane)
        old_leader = queue.leader(place + 1, lane)
        relief = _where_known(behind, self._follow(behind, old_leader) - self._follow(behind, now))
        best = np.full(len(now), -np.inf)
        goal = lane.copy()
        for side in (-1, 1):
            target = lane + side
            allowed = (self.change[now] < 0) & (target // lanes == lane // lanes) & (target >= 0)
            allowed &= ~(self.drivers.truck[now] & (target % lanes == lanes - 1) & (self.traffic.lanes > 2))
            if self.traffic.ramp != "none":
                leaves = self.leaves[now]
                allowed &= traffic_settings.may_change(
                    self.traffic, lane, side, self.s[now], self.v[now], leaves
                )
            spot = np.searchsorted(queue.key, target * 1e6 + self.s[now])
            ahead, after = queue.leader(spot, target), queue.follower(spot - 1, target)
            mine = self._follow(now, ahead)
            theirs = _where_known(after, self._follow(after, now), 0.0)
            loss = _where_known(after, theirs - self._follow(after, ahead))
            room = np.where(ahead >= 0, self.s[ahead] - self.drivers.length[ahead] - self.s[now], np.inf)
            room_behind = np.where(after >= 0, self.s[now] - self.drivers.length[now] - self.s[after], np.inf)
            allowed &= (theirs > -_SAFE_BRAKING) & (mine > -_SAFE_BRAKING) & (room > 4) & (room_behind > 4)
            gain = mine - a + self.drivers.politeness[now] * (loss + relief) - side * 0.15
            if self.traffic.ramp != "none":
                gain += traffic_settings.incentive(self.traffic, lane, side, self.leaves[now])
            better = allowed & (gain > 0.25) & (gain > best)
            best[better], goal[better] = gain[better], target[better]
        for way in (0, 1):
            wanting = np.flatnonzero((lane // lanes == way) & np.isfinite(best))
            if len(wanting):
                chosen = wanting[np.argmax(best[wanting])]
                seconds = float(self.random.uniform(3.6, 7.0))
                if self.traffic.ramp != "none":
                    who = now[chosen]
                    across = int(lane[chosen]), int(goal[chosen])
                    seconds = traffic_settings.change_seconds(
                        self.traffic, across, seconds, self.s[who], self.v[who]
                    )
                self.change[now[chosen]] = len(self.changes)
                self.changes.append((step, seconds, int(goal[chosen]), int(now[chosen])))


class _Queue:
    """Vehicles in order of lane and place; a vehicle that changes lanes stands in both."""

    def __init__(self, key: Floats, lane: Integers, vehicle: Integers) -> None:
        self.key, self.lane, self.vehicle = key, lane, vehicle

    def leader(self, place: Integers, lane: Integers) -> Integers:
        """The vehicle at each ``place`` if it is in ``lane``, else -1."""
        inside = (place >= 0) & (place < len(self.vehicle))
        at = np.where(inside, place, 0)
        return np.where(inside & (self.lane[at] == lane), self.vehicle[at], -1)

    follower = leader


def _where_known(vehicle: Integers, value: Floats, otherwise: float = 0.0) -> Floats:
    return np.where(vehicle >= 0, value, otherwise)


def simulate(traffic: traffic_settings.TrafficSettings, seed: int, number: int = 1) -> Recording:
    """Recording ``number`` (named 01, 02, …) of ``traffic``; it depends on ``seed`` and ``number`` only.

    Vehicles are in the recording while their whole box is within the section. All values are rounded
    to the hundredth, so that writing and reading the recording gives the same one.
    """
    random = np.random.default_rng([seed, number])
    movement = _Road(traffic, random).run()
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
    vehicles = {
        "vehicle_id": np.arange(1, len(seen) + 1),
        "direction": np.where(way == 0, UPPER, LOWER),
        "kind": np.where(movement.truck[seen], "Truck", "Car"),
        "length": movement.length[seen],
        "width": movement.width[seen],
        "first_frame": frame[first][by_entry],
    }
    moving = (_two_decimals(x[rows]) for x in (v + a * after, v_lat, a, a_lat))
    return place_recording(road, f"{number:02d}", traffic.rate, vehicles, counts, (s, d, *moving))


def _two_decimals(values: Floats) -> Floats:
    return np.round(values, 2) + 0.0  # no negative zero


def markings_of(traffic: traffic_settings.TrafficSettings) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """y of the markings: upper carriageway, 4.5 m, lower carriageway."""

    def lines(top: float, lanes: int) -> tuple[float, ...]:
        return tuple(round(top + k * traffic.lane_width, 2) for k in range(lanes + 1))

    upper = lines(8.5, traffic.lanes)
    return upper, lines(upper[-1] + 4.5, traffic.tracks)


def _ticks(traffic: traffic_settings.TrafficSettings) -> int:
    return round(STEP_SECONDS * traffic.rate)


def _sample_rows(traffic: traffic_settings.TrafficSettings, movement: Movement) -> tuple[Integers, Integers]:
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
    traffic: traffic_settings.TrafficSettings,
    movement: Movement,
    row: Integers,
    after: Floats,
    random: np.random.Generator,
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
