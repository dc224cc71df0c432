"""An independent simulation of places of plates, stepped at a clock's rate: any parameters, all at once.

It knows nothing of formulas, and shares nothing with the driver models of roadproof. Every value is an
array, one number for each place. Names are those of parameters of ``driver.spec`` and of initial values.
"""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]
RATE, SECONDS = 400, 25


class Response:
    """What a model has noticed of POV up to a step, and how hard SV brakes."""

    def __init__(self, model: str, x: Mapping[str, Floats], options: Mapping[str, str]) -> None:
        self.model, self.x, self.options = model, x, options
        self.seen, self.open, self.wrap = (np.full(len(x["Ve0"]), np.inf) for _ in range(3))

    def look(self, time: float, across: Floats, ahead: Floats, faster: Floats, beside: Floats) -> None:
        """``across``: how far POV has moved; ``beside``: the gap across; ``ahead``: the gap along."""
        x, reading = self.x, self.options.get("cc_perception", "time")
        if self.model == "careful":
            far = x["cc_wander"] + (x["cc_drift"] if reading == "distance" else 0)
            sees = beside <= 0 if reading == "overlap" else across >= far
        elif self.model == "rss":
            sees = beside <= 0
        else:
            sees = across >= x["dy0"] / 2 + x["r157_past"]
        near = (ahead <= x["cc_ttc"] * faster) & (faster > 0)
        gate, weighed = self.options.get("cc_gate", "none"), x["cc_evaluation"] * (reading == "time")
        if self.model == "careful" and gate == "before_perception":
            sees = sees & near | (self.seen < np.inf)
        self.seen = np.where(sees, np.minimum(self.seen, time), self.seen)
        opens = (
            near & (time >= self.seen + weighed) if gate == "before_delay" else time >= self.seen + weighed
        )
        self.open = np.where(opens, np.minimum(self.open, time), self.open)
        wraps = beside + x["width"] <= 0
        self.wrap = np.where(wraps, np.minimum(self.wrap, time), self.wrap)

    def braking(self, time: float) -> Floats:
        x = self.x
        match self.model:
            case "careful":
                begin = self.open + x["cc_delay"]
                return self.aided(time, begin, x["cc_braking"] * self.grown(time, begin))
            case "rss":
                after = time - self.seen
                return np.where(after < 0, 0.0, np.where(after < x["rho"], -x["a_max"], x["b_min"]))
            case "r157":
                return np.where(time >= self.seen + x["r157_delay"], x["r157_braking"], 0.0)
            case _:
                delay = x["eu1426_delay"] + x["eu1426_ramp"] / 2
                return np.where(time >= self.seen + delay, x["eu1426_braking"], 0.0)

    def grown(self, time: float, begin: Floats) -> Floats:
        return np.clip((time - begin) / self.x["cc_ramp"], 0, 1)

    def aided(self, time: float, begin: Floats, driver: Floats) -> Floats:
        full, how = self.x["aeb_braking"], self.options.get("cc_aeb", "none")
        aeb = full * self.grown(time, self.wrap)
        match how:
            case "max":
                return np.maximum(driver, aeb)
            case "add":
                return np.minimum(driver + aeb, full)
            case "replace":
                begun = full * self.grown(time, np.minimum(begin, self.wrap))
                return np.where(time >= self.wrap, begun, driver)
            case _:
                return driver


def cut_in(model: str, x: Mapping[str, Floats], options: Mapping[str, str]) -> tuple[Bools, Bools]:
    """Whether the boxes touch before SV has passed POV; and whether they do after it has."""
    other = x["Ve0"] - x["dV0"]
    response, speed, gained = Response(model, x, options), x["Ve0"].copy(), np.zeros(len(other))
    touched, passed, later = (np.zeros(len(other), bool) for _ in range(3))
    for k in range(RATE * SECONDS):
        time = k / RATE
        across = x["Vy"] * time
        ahead, beside = x["dx0"] - gained, x["dy0"] - across
        passed |= ~touched & (ahead < -2 * x["length"])
        meets = (beside <= 0) & (ahead <= 0) & (ahead >= -2 * x["length"])
        touched |= meets & ~passed
        later |= meets & passed
        response.look(time, across, ahead, speed - other, beside)
        slower = np.maximum(speed - response.braking(time + 0.5 / RATE) / RATE, 0)
        gained += ((speed + slower) / 2 - other) / RATE
        speed = slower
    return touched, later & ~touched


def braking_leader(
    model: str, x: Mapping[str, Floats], options: Mapping[str, str], perceived: Bools
) -> Bools:
    """Whether SV runs into a leader that brakes until it stands."""
    other, speed, left = x["Ve0"] - x["dV0"], x["Ve0"].copy(), x["dx0"].copy()
    touched = np.zeros(len(speed), bool)
    for k in range(RATE * SECONDS):
        time = (k + 0.5) / RATE
        if model == "rss":
            mine = np.where(time < x["rho"], -x["a_max"], x["b_min"])
        else:
            begin = x["cc_evaluation"] + x["cc_delay"]
            mine = np.where(perceived, x["cc_braking"] * np.clip((time - begin) / x["cc_ramp"], 0, 1), 0.0)
        slower, faster = np.maximum(other - x["Gx"] / RATE, 0), np.maximum(speed - mine / RATE, 0)
        left = left + ((other + slower) - (speed + faster)) / 2 / RATE
        other, speed = slower, faster
        touched |= left <= 0
    return touched


def cut_out(x: Mapping[str, Floats]) -> Bools:
    """Whether the careful driver runs into the vehicle that a cut-out reveals."""
    speed, left = x["Ve0"].copy(), x["headway"] * x["Ve0"] + x["length"] + x["dx0_f"]
    begin = x["cc_wander"] / x["Vy"] + x["cc_evaluation"] + x["cc_delay"]
    touched = np.zeros(len(speed), bool)
    for k in range(RATE * SECONDS):
        grown = np.clip(((k + 0.5) / RATE - begin) / x["cc_ramp"], 0, 1)
        slower = np.maximum(speed - x["cc_braking"] * grown / RATE, 0)
        left = left + (x["Vf0"] - (speed + slower) / 2) / RATE
        speed = slower
        touched |= left <= 0
    return touched
