"""Driver models put into a test, simulated in steps of a millisecond, without roadproof.extensions.drivers.

A vehicle is its first state and its pieces, all floats; models are as the regulations say, in m and s.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from extensions.drivers.fuzzy_again import accelerations

STEP = 0.001
WANDER, EVALUATION, DRIFT, DELAY, RAMP, FULL, AEB = 0.375, 0.4, 0.72, 0.75, 0.6, 7.59294, 8.3385
TTC, HARD = 2.0, 5.0
PAST, R157, EU = 0.3, (0.35, 6.0), (0.1 + 0.15, 6.0)
RHO, FASTER, LEAST = 0.6, 5.0, 6.0
LOOK = 100  # steps from look to look of the fuzzy safety model


@dataclass(frozen=True)
class Car:
    """``pieces``: duration, acceleration and jerk along, acceleration across; then it goes straight on."""

    s: float
    d: float
    v: float
    u: float
    pieces: tuple[tuple[float, float, float, float], ...]
    length: float
    width: float


@dataclass(frozen=True)
class Case:
    """SV, POV (and POV2 behind it in a cut-out); lane of each: right and left edge."""

    manoeuvre: str
    cars: tuple[Car, ...]
    own: tuple[float, float]
    its: tuple[float, float]
    since: float


def motion(car: Car, times: np.ndarray, brakes: bool = True, since: float = 0.0) -> dict[str, np.ndarray]:
    """Integrated step by step; not ``brakes``: without what brakes after ``since``."""
    at, middles, across = np.zeros(len(times)), np.zeros(len(times)), np.zeros(len(times))
    begin = 0.0
    for lasts, acceleration, jerk, lateral in car.pieces:
        now = (times >= begin - 1e-9) & (times < begin + lasts - 1e-9)
        at[now] = acceleration + jerk * (times[now] - begin)
        middles[now] = acceleration + jerk * (times[now] + STEP / 2 - begin)
        across[now] = lateral
        begin += lasts
    if not brakes:
        middles[(times >= since - 1e-9) & (middles < 0)] = 0

    def summed(value: float, rates: np.ndarray) -> np.ndarray:
        return value + np.concatenate(([0.0], np.cumsum(rates[:-1]))) * STEP

    v, u = summed(car.v, middles), summed(car.u, across)
    s = summed(car.s, v + np.append(np.diff(v), 0) / 2)
    d = summed(car.d, u + np.append(np.diff(u), 0) / 2)
    return {"a": at, "v": v, "s": s, "u": u, "d": d}


@lru_cache(maxsize=2)
def motions(case: Case, seconds: float) -> list[dict[str, np.ndarray]]:
    """SV's, without its braking, and those of the others."""
    times = np.arange(round(seconds / STEP) + 1) * STEP
    return [motion(case.cars[0], times, False, case.since), *(motion(x, times) for x in case.cars[1:])]


def first(times: np.ndarray, condition: np.ndarray, since: float) -> float | None:
    found = np.flatnonzero(condition & (times >= since - 1e-9))
    return float(times[found[0]]) if len(found) else None


def later(time: float | None, delay: float) -> float | None:
    return None if time is None else time + delay


def ramp(times: np.ndarray, begin: float, full: float) -> np.ndarray:
    return full * np.clip((times - begin) / RAMP, 0, 1)


@dataclass(frozen=True)
class Found:
    """``word``: the verdict, or later where SV still comes nearer at the end.

    ``gap``: the least that is left while side by side across; ``time``, ``faster``: of the touch.
    """

    word: str
    gap: float | None = None
    time: float | None = None
    faster: float | None = None


class Simulation:
    def __init__(self, case: Case, seconds: float = 40.0, nearer: float = 0.0) -> None:
        self.case = case
        self.times = np.arange(round(seconds / STEP) + 1) * STEP
        mine, *self.others = motions(case, seconds)
        self.me = {**mine, "s": mine["s"] + nearer}

    def beside(self, k: int) -> np.ndarray:
        me, other = self.case.cars[0], self.case.cars[k + 1]
        mine, its = self.me["d"], self.others[k]["d"]
        return (mine - me.width <= its + 1e-9) & (its - other.width <= mine + 1e-9)

    def gap(self, k: int) -> np.ndarray:
        return self.others[k]["s"] - self.case.cars[k + 1].length - self.me["s"]

    def off(self, metres: float) -> np.ndarray:
        """POV's middle is so far off the middle of its lane, towards SV (in a cut-out, to any side)."""
        middle = self.others[0]["d"] - self.case.cars[1].width / 2 - sum(self.case.its) / 2
        if self.case.manoeuvre == "cut-out":
            return np.abs(middle) >= metres - 1e-9
        side = 1 if self.case.own[0] > self.case.its[0] else -1
        return middle * side >= metres - 1e-9

    def over(self, metres: float) -> np.ndarray:
        its, wide = self.others[0]["d"], self.case.cars[1].width
        if self.case.own[0] > self.case.its[0]:
            return its - self.case.own[0] >= metres - 1e-9
        return self.case.own[1] - (its - wide) >= metres - 1e-9

    def braking_of(self, model: str, options: dict[str, str]) -> np.ndarray:
        """SV's braking at each instant; negative where it accelerates."""
        times, since = self.times, self.case.since
        nothing = np.zeros(len(times))
        if model in ("r157", "eu1426"):
            delay, full = R157 if model == "r157" else EU
            begin = later(first(times, self.over(PAST), since), delay)
            return nothing if begin is None else np.where(times >= begin, full, 0.0)
        if model == "rss":
            near = self.beside(0)
            if self.case.manoeuvre == "deceleration":
                near = near & (self.others[0]["a"] < 0) & (self.gap(0) >= 0)
            begin = first(times, near, since)
            if begin is None:
                return nothing
            return np.where(times < begin, 0.0, np.where(times < begin + RHO, -FASTER, LEAST))
        return self.careful(options)

    def careful(self, options: dict[str, str]) -> np.ndarray:
        times, since, nothing = self.times, self.case.since, np.zeros(len(self.times))
        if self.case.manoeuvre == "cut-out":
            begin = later(first(times, self.off(WANDER), since), EVALUATION + DELAY)
            return nothing if begin is None else ramp(times, begin, FULL)
        if self.case.manoeuvre == "deceleration":
            a = self.others[0]["a"]
            seen = a <= -HARD + 1e-9 if options.get("cc_threshold") == "hard" else a < 0
            begin = later(first(times, seen & self.beside(0) & (self.gap(0) >= 0), since), EVALUATION + DELAY)
            return nothing if begin is None else ramp(times, begin, FULL)
        reading, gate = options.get("cc_perception", "time"), options.get("cc_gate", "none")
        seen = {
            "time": self.off(WANDER),
            "distance": self.off(WANDER + DRIFT),
            "overlap": self.beside(0),
        }[reading]
        weighs = EVALUATION if reading == "time" else 0.0
        begin = first(times, seen, since)
        faster = self.me["v"] - self.others[0]["v"]
        soon = (self.gap(0) <= TTC * faster) & (faster > 0)
        if begin is not None and gate == "before_perception":
            begin = first(times, soon, begin)
        begin = later(begin, weighs)
        if begin is not None and gate == "before_delay":
            begin = first(times, soon, begin)
        begin = later(begin, DELAY)
        driver = nothing if begin is None else ramp(times, begin, FULL)
        return self.aided(driver, begin, options.get("cc_aeb", "none"))

    def aided(self, driver: np.ndarray, begin: float | None, how: str) -> np.ndarray:
        me, other = self.case.cars[:2]
        mine, its = self.me["d"], self.others[0]["d"]
        low, high = mine - me.width - (its - other.width), mine - its
        wrap = first(
            self.times, (low <= 1e-9) & (high >= -1e-9) | (low >= -1e-9) & (high <= 1e-9), self.case.since
        )
        if how == "none" or wrap is None:
            return driver
        aeb = ramp(self.times, wrap, AEB)
        if how == "max":
            return np.maximum(driver, aeb)
        if how == "add":
            return np.minimum(driver + aeb, np.maximum(AEB, driver))
        since = wrap if begin is None else min(wrap, begin)
        return np.where(self.times >= wrap, ramp(self.times, since, AEB), driver)

    def looks(self, knows: float) -> Iterator[tuple[float, ...]]:
        """What the fuzzy safety model sees ten times a second, from when it ``knows`` of the other on.

        As it is asked for the next look, SV is where its braking has brought it.
        """
        last, me, own = len(self.others) - 1, self.case.cars[0], self.me
        other, car = self.others[last], self.case.cars[last + 1]
        is_left = other["d"] - car.width / 2 >= own["d"] - me.width / 2
        apart = np.where(is_left, other["d"] - car.width - own["d"], own["d"] - me.width - other["d"])
        shrinks = np.where(is_left, own["u"] - other["u"], other["u"] - own["u"])
        for k in range(round(self.case.since / STEP), len(self.times) - LOOK, LOOK):
            gap = other["s"][k] - car.length - self.me["s"][k]
            self.now = k
            if self.times[k] >= knows - 1e-9:
                yield tuple(map(float, (gap, self.me["v"][k], other["v"][k], apart[k], shrinks[k])))

    def controlled(self, late: float) -> Found:
        """SV has its new speed from each look on; before it first brakes it moves as in the test."""
        known: float | None = self.case.since
        if self.case.manoeuvre == "cut-out":
            known = later(first(self.times, self.off(WANDER), self.case.since), late)
        if known is None:
            return self.judged()
        lengths = self.case.cars[0].length + self.case.cars[-1].length
        s, v = self.me["s"].copy(), self.me["v"].copy()
        self.me = {**self.me, "s": s, "v": v}
        has_braked = False
        for acceleration in accelerations(self.looks(known), lengths):
            has_braked = has_braked or acceleration < 0
            if has_braked:
                k = self.now
                v[k : k + LOOK + 1] = max(0.0, v[k] + float(acceleration) * LOOK * STEP)
                s[k : k + LOOK + 1] = s[k] + v[k] * STEP * np.arange(LOOK + 1)
                if v[k] == 0:
                    break
        if has_braked:
            v[self.now :] = v[self.now]
            s[self.now :] = s[self.now] + v[self.now] * STEP * np.arange(len(s) - self.now)
        return self.judged()

    def run(self, model: str, options: dict[str, str] | None = None, late: float = 0.0) -> Found:
        if model == "fsm":
            return self.controlled(late)
        braking = self.braking_of(model, options or {})
        steps = round(late / STEP)
        if steps > 0:
            braking = np.concatenate((np.zeros(steps), braking[:-steps]))
        elif steps < 0:
            braking = np.concatenate((braking[-steps:], np.full(-steps, braking[-1])))
        responds = np.flatnonzero(braking)
        if len(responds):
            k = responds[0]
            mean = (braking[k:-1] + braking[k + 1 :]) / 2
            v = np.maximum(self.me["v"][k] - np.concatenate(([0.0], np.cumsum(mean))) * STEP, 0)
            stopped = np.flatnonzero(v <= 0)
            if len(stopped):
                v[stopped[0] :] = 0
            gone = np.concatenate(([0.0], np.cumsum((v[:-1] + v[1:]) / 2))) * STEP
            self.me = {
                **self.me,
                "v": np.concatenate((self.me["v"][:k], v)),
                "s": np.concatenate((self.me["s"][:k], self.me["s"][k] + gone)),
            }
        return self.judged()

    def judged(self) -> Found:
        k, car = len(self.others) - 1, self.case.cars[0]
        gap, beside = self.gap(k), self.beside(k)
        now = self.times >= self.case.since - 1e-9
        front = self.others[k]["s"]
        touch = first(self.times, beside & (gap <= 0) & (self.me["s"] - car.length <= front), self.case.since)
        past = first(self.times, self.me["s"] - car.length > front, self.case.since)
        if touch is not None and (past is None or touch <= past):
            at = round(touch / STEP)
            return Found("collides", time=touch, faster=float(self.me["v"][at] - self.others[k]["v"][at]))
        if past is not None:
            return Found("undecided")
        if self.me["v"][-1] > self.others[k]["v"][-1] + STEP:
            return Found("later")
        left = gap[beside & now]
        return Found("prevented", gap=float(left.min()) if len(left) else None)
