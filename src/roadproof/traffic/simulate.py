"""Seeded highway traffic of highD's shape: car following by IDM, lane changes by MOBIL.

IDM: Treiber, Hennecke, Helbing, *Congested traffic states in empirical observations and microscopic
simulations*, Phys. Rev. E 62 (2000). MOBIL: Kesting, Treiber, Helbing, *General lane-changing model
MOBIL for car-following models*, Transp. Res. Rec. 1999 (2007). Both carriageways of a recording
advance together, as one set of arrays; decisions fall five times a second, between them
accelerations are constant, so that the 25 Hz samples are exact.
"""

from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from roadproof.errors import UsageError
from roadproof.traffic.recording import Bools, Floats, Integers, offsets

Random: TypeAlias = np.random.Generator


@dataclass(frozen=True)
class Traffic:
    """What to simulate: SI units, ``flow`` in vehicles per hour and direction."""

    seconds: float = 1020.0
    lanes: int = 3
    flow: float = 3350.0
    truck_share: float = 0.18
    section: float = 420.0
    lane_width: float = 3.75
    rate: int = 25

    def __post_init__(self) -> None:
        limits = {
            "seconds": (1, 7200),
            "lanes": (2, 4),
            "flow": (1, 2200 * self.lanes),
            "truck_share": (0, 0.4),
            "section": (100, 5000),
            "lane_width": (3, 5),
        }
        for name, (low, high) in limits.items():
            if not low <= getattr(self, name) <= high:
                raise UsageError(f"simulate: {name}={getattr(self, name)} must lie between {low} and {high}")
        if self.rate % 5:
            raise UsageError(f"simulate: rate={self.rate} must be a multiple of 5 Hz, the rate of decisions")


@dataclass(frozen=True)
class Movement:
    """What the simulation hands out: one row a vehicle and a row a (decision, vehicle) in the section.

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


def move_traffic(traffic: Traffic, random: Random) -> Movement:
    """Simulate ``traffic``; the same seed gives the same movement, to the last bit."""
    return _Road(traffic, random).run()


STEP_SECONDS = 0.2
"""Time between two decisions."""

_APPROACH = 800.0  # where vehicles enter, before the section, so that traffic has formed when it is seen
_DEPARTURE = 250.0
_WARM_UP = 300  # steps
_SAFE_BRAKING = 4.0  # MOBIL: what a lane change may ask of the new follower
_HARDEST_BRAKING = 9.0


class _Drivers:
    """Parameters of every vehicle that will ever enter, drawn once."""

    def __init__(self, lane: Integers, traffic: Traffic, random: Random) -> None:
        count = len(lane)
        preference = np.array([0.75, 0.25] + [0.0] * (traffic.lanes - 2)) * traffic.lanes
        self.truck: Bools = random.random(count) < traffic.truck_share * preference[lane % traffic.lanes]
        truck = self.truck

        def draw(car: tuple[float, float], lorry: tuple[float, float], low: float, high: float) -> Floats:
            mean, spread = (np.where(truck, lorry[k], car[k]) for k in (0, 1))
            drawn: Floats = np.clip(random.normal(mean, spread), low, high)
            return drawn

        self.length = np.where(truck, np.clip(random.normal(14, 3.5, count), 7, 19), 0)
        self.length += np.where(truck, 0, np.clip(random.normal(4.5, 0.4, count), 3.4, 6))
        self.length = np.round(self.length, 2)
        self.width = np.round(draw((1.9, 0.1), (2.5, 0.05), 1.6, 2.6), 2)
        self.desired = draw((36.0, 3.0), (23.8, 0.8), 20, 48)
        self.headway = draw((1.0, 0.3), (1.7, 0.3), 0.5, 3)
        self.acceleration = draw((1.6, 0.3), (0.7, 0.1), 0.4, 2.6)
        self.braking = draw((2.0, 0.3), (1.6, 0.2), 1, 3)
        self.politeness = np.clip(random.normal(0.35, 0.2, count), 0, 1)


class _Road:
    """All vehicles of both carriageways; lanes are numbered through: direction * lanes + lane."""

    def __init__(self, traffic: Traffic, random: Random) -> None:
        self.traffic = traffic
        self.random = random
        self.steps = _WARM_UP + int(np.ceil(traffic.seconds / STEP_SECONDS)) + 1
        self.queues = _draw_arrivals(traffic, self.steps * STEP_SECONDS, random)
        count = sum(len(times) for times in self.queues)
        self.lane_of = np.repeat(np.arange(len(self.queues)), [len(times) for times in self.queues])
        self.drivers = _Drivers(self.lane_of, traffic, random)
        self.s = np.zeros(count)
        self.v = np.zeros(count)
        self.change = np.full(count, -1)
        self.brake_until = np.zeros(count, np.int64)
        self.brake_by = np.zeros(count)
        self.active = np.zeros(0, np.int64)
        self.next_in_queue = [int(k) for k in offsets(np.array([len(q) for q in self.queues]))[:-1]]
        self.queue_times = np.concatenate(self.queues)
        self.queue_ends = [int(k) for k in offsets(np.array([len(q) for q in self.queues]))[1:]]
        self.changes: list[tuple[int, float, int, int]] = []  # step, seconds, to, vehicle
        self.drivers.desired += np.where(self.drivers.truck, 0.0, 1.5 * (self.lane_of % traffic.lanes))

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
                log.append((*rows, self.lane_of[shown] % self.traffic.lanes, self.change[shown]))
            self.s[now] += self.v[now] * STEP_SECONDS + a * STEP_SECONDS**2 / 2
            self.v[now] = np.maximum(0, self.v[now] + a * STEP_SECONDS)
            self.active = now[self.s[now] < self.traffic.section + _DEPARTURE]
        columns = [np.concatenate(parts) for parts in zip(*log, strict=True)]
        changes = np.array([c[:3] for c in self.changes], float).reshape(-1, 3)
        return Movement(
            direction=self.lane_of // self.traffic.lanes,
            truck=self.drivers.truck,
            length=self.drivers.length,
            width=self.drivers.width,
            step=columns[0],
            vehicle=columns[1],
            s=columns[2],
            v=columns[3],
            a=columns[4],
            lane=columns[5],
            change=columns[6],
            change_start=changes[:, 0].astype(np.int64) - _WARM_UP,
            change_seconds=changes[:, 1],
            change_to=changes[:, 2].astype(np.int64) % self.traffic.lanes,
        )

    def _enter(self, time: float) -> None:
        """At most one vehicle a lane, when it is due and the last one is far enough away."""
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
        a = self._brake_at_random(step, a)
        if len(now):
            self._change_lanes(step, queue, a)
        capped: Floats = np.maximum(np.clip(a, -_HARDEST_BRAKING, None), -self.v[now] / STEP_SECONDS)
        return capped

    def _follow(self, vehicle: Integers, leader: Integers) -> Floats:
        """IDM acceleration of ``vehicle`` behind ``leader`` (-1: free road)."""
        drivers = self.drivers
        v, limit = self.v[vehicle], drivers.acceleration[vehicle]
        gap = np.where(leader >= 0, self.s[leader] - drivers.length[leader] - self.s[vehicle], np.inf)
        approach = v * (v - self.v[leader]) / (2 * np.sqrt(limit * drivers.braking[vehicle]))
        wished = 2.0 + np.maximum(0, v * drivers.headway[vehicle] + np.where(leader >= 0, approach, 0))
        a: Floats = limit * (1 - (v / drivers.desired[vehicle]) ** 4 - (wished / np.maximum(gap, 0.1)) ** 2)
        return a

    def _brake_at_random(self, step: int, a: Floats) -> Floats:
        """Now and then a driver brakes for no reason that others see, which starts a braking wave."""
        now = self.active
        if len(now) and self.random.random() < STEP_SECONDS / 6:
            chosen = now[self.random.integers(len(now))]
            self.brake_until[chosen] = step + self.random.integers(4, 16)
            self.brake_by[chosen] = self.random.uniform(1, 4)
        held: Floats = np.where(self.brake_until[now] > step, np.minimum(a, -self.brake_by[now]), a)
        return held

    def _change_lanes(self, step: int, queue: "_Queue", a: Floats) -> None:
        """MOBIL: at most one vehicle of each direction begins to change lanes at a time."""
        now, lanes = self.active, self.traffic.lanes
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
            allowed &= ~(self.drivers.truck[now] & (target % lanes == lanes - 1) & (lanes > 2))
            spot = np.searchsorted(queue.key, target * 1e6 + self.s[now])
            ahead, after = queue.leader(spot, target), queue.follower(spot - 1, target)
            mine = self._follow(now, ahead)
            theirs = _where_known(after, self._follow(after, now), 0.0)
            loss = _where_known(after, theirs - self._follow(after, ahead))
            room = np.where(ahead >= 0, self.s[ahead] - self.drivers.length[ahead] - self.s[now], np.inf)
            room_behind = np.where(after >= 0, self.s[now] - self.drivers.length[now] - self.s[after], np.inf)
            allowed &= (theirs > -_SAFE_BRAKING) & (mine > -_SAFE_BRAKING) & (room > 4) & (room_behind > 4)
            gain = mine - a + self.drivers.politeness[now] * (loss + relief) - side * 0.15
            better = allowed & (gain > 0.25) & (gain > best)
            best[better], goal[better] = gain[better], target[better]
        for way in (0, 1):
            wanting = np.flatnonzero((lane // lanes == way) & np.isfinite(best))
            if len(wanting):
                chosen = wanting[np.argmax(best[wanting])]
                seconds = float(self.random.uniform(3.6, 7.0))
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
        found: Integers = np.where(inside & (self.lane[at] == lane), self.vehicle[at], -1)
        return found

    follower = leader


def _where_known(vehicle: Integers, value: Floats, otherwise: float = 0.0) -> Floats:
    known: Floats = np.where(vehicle >= 0, value, otherwise)
    return known


def _draw_arrivals(traffic: Traffic, seconds: float, random: Random) -> list[Floats]:
    """Arrival times for each lane of both directions: exponential headways after a least one of 0.8 s."""
    shares = np.linspace(0.9, 1.1, traffic.lanes) / traffic.lanes
    arrivals = []
    for share in np.tile(shares, 2):
        mean = 3600 / (traffic.flow * share)
        gaps = 0.8 + random.exponential(max(mean - 0.8, 0.05), int(3 * seconds / mean) + 20)
        times = np.cumsum(gaps)
        arrivals.append(times[times < seconds])
    return arrivals
