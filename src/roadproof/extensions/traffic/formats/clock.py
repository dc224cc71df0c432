"""The constant rate of times that a text rounds: 25, 29.97 or 3 samples a second, also in epoch seconds.

The most frequent difference sets the step, so that a mistyped time costs only the vehicles that it is of.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from decimal import Decimal
from fractions import Fraction
from pathlib import Path
from typing import TypeAlias

import numpy as np

from roadproof.errors import InputError
from roadproof.extensions.traffic.formats.recording import Floats, Integers

Rate: TypeAlias = int | Fraction
"""Samples a second: whole, or a fraction such as 30000/1001."""
LARGEST_RATE, LONGEST_STEP = 1000, 60
_DECIMALS = 9
_JITTER = 0.00101
"""s: two times with three decimals are this far from what they stand for, together."""
_SHARE = 0.9
"""A rate that fits so large a share of times is taken before others are tried."""
_FEWEST = 0.5
"""At least this share of times must fit the best rate; the reader names those that do not."""


@dataclass(frozen=True)
class Clock:
    """``begin`` (s) is the time of frame 0, ``rate`` the samples a second.

    ``slack``: how far (s) times may be off.
    """

    begin: float
    rate: Rate
    slack: float

    @property
    def step(self) -> float:
        """The time (s) between two samples."""
        return float(1 / Fraction(self.rate))

    @property
    def notes(self) -> tuple[str, ...]:
        """The time of frame 0, where it is not 0, and a rate that is not whole."""
        begin = (
            (f"frame 0 is time {Decimal(repr(round(self.begin, _DECIMALS))).normalize():f} s",)
            if self.begin
            else ()
        )
        odd = isinstance(self.rate, Fraction)
        return (*begin, f"the rate is {self.rate} samples a second") if odd else begin

    def frames(self, times: Floats) -> Integers:
        """The nearest frame of each time."""
        nearest: Integers = np.round((times - self.begin) * float(self.rate)).astype(np.int64)
        return nearest

    def misses(self, times: Floats) -> Floats:
        """Return how far (s) each time is from its frame."""
        distances: Floats = np.abs(times - self.begin - self.frames(times) / float(self.rate))
        return distances


def clock_of(path: Path, times: Floats, steps: Floats, counts: Integers) -> Clock:
    """The clock of ``times`` (each once, in order), by the ``steps`` between samples of one vehicle.

    ``counts``: how often each step occurs. Raises ``InputError`` where no rate fits nearly all times.

    >>> times = np.array([1.7e9, 1.7e9 + 0.033, 1.7e9 + 0.067, 1.7e9 + 0.1])
    >>> clock_of(Path("a.csv"), times, np.diff(times), np.ones(3, int)).rate
    30
    """
    if not len(steps):
        raise InputError(f"{path}: no vehicle has two samples; at least two are needed")
    unit = _unit_of(times)
    usual, mean = _usual_step(steps, counts, unit)
    if not 1 / LARGEST_RATE / 1.001 <= mean <= LONGEST_STEP:
        rule = f"a step lies between {1 / LARGEST_RATE:g} and {LONGEST_STEP} s"
        raise InputError(f"{path}: time goes on by {mean:g} s; {rule}")
    exact, near = 1 / Fraction(repr(round(usual, _DECIMALS))), _spacing(times)
    mean = _fitted_step(times, mean, 2 * unit + _JITTER + near)
    span = max(1.0, float(times[-1] - times[0]) / mean)
    rates = [*_candidates(mean, unit / span / 2)]
    plain, rounded = [(exact, near)], [(x, unit + near) for x in rates]
    tries = rounded + plain if unit <= 1e-4 * mean else plain + rounded
    tries += [(x, _JITTER) for x in (rates[0], exact)]
    best, share = Clock(float(times[0]), _whole(exact), 0.0), 0.0
    for rate, slack in tries:
        for anchor in (times[0], times[len(times) // 2]):
            clock = _anchored(times, float(anchor), rate, slack)
            fits = _share_of(clock, times, 1.25 * unit + near)
            if fits > share:
                best, share = clock, fits
        if share == 1 or (share >= _SHARE and rate in (exact, rates[0])):
            break
    if share >= _FEWEST:
        return replace(best, slack=max(best.slack, min(_JITTER, 0.1 * best.step)))
    worst = times[int(np.argmax(best.misses(times)))]
    raise InputError(f"{path}: time={worst:.{_DECIMALS}g} breaks the step of {mean:.6g} s; use equal steps")


def rate_text(rate: Rate) -> str:
    """A rate for messages: 25, 29.97 or 30000/1001."""
    return str(rate) if isinstance(rate, int) or float(rate) != round(float(rate), 6) else f"{float(rate):g}"


def samples_in(rate: Rate, seconds: float = 1.0) -> int:
    """The number of samples in about so many seconds, at least one."""
    return max(1, round(float(rate) * seconds))


def rate_for(step: Fraction) -> Rate:
    """The rate of a step (s)."""
    return _whole(1 / step)


def rate_near(step: float) -> Rate:
    """The rate of a step (s) that a file states, perhaps as a rounded reciprocal of a whole number.

    >>> rate_near(0.0333), rate_near(0.04), rate_near(0.15)
    (30, 25, Fraction(20, 3))
    """
    stated = Fraction(repr(step))
    unit = Fraction(
        1, 10 ** max(3, min(_DECIMALS, -int(Decimal(repr(step)).normalize().as_tuple().exponent)))
    )
    whole = round(1 / stated)
    if whole >= 1 and abs(Fraction(1, whole) - stated) <= unit / 2:
        return whole
    return rate_for(stated)


def _whole(rate: Fraction) -> Rate:
    return int(rate) if rate.denominator == 1 else rate


def _unit_of(times: Floats) -> float:
    """The last decimal place (s) that times have."""
    places = next((p for p in range(_DECIMALS) if (np.round(times, p) == times).all()), _DECIMALS)
    return float(10.0**-places)


def _spacing(times: Floats) -> float:
    """The distance (s) of two floats next to each other, with room for a few operations."""
    return 8 * float(np.spacing(np.abs(times).max()))


def _usual_step(steps: Floats, counts: Integers, unit: float) -> tuple[float, float]:
    """The most frequent step, and the mean of all that rounding parts from it."""
    rounded = np.round(steps / unit) * unit if unit > 1e-8 else np.round(steps, _DECIMALS)
    kinds, place = np.unique(np.round(rounded, _DECIMALS), return_inverse=True)
    often = np.bincount(place, weights=counts)
    usual = float(kinds[int(np.argmax(often))])
    if usual <= 0:
        usual = float(steps[int(np.argmax(counts))])
    near = np.abs(steps - usual) <= min(max(1.01 * unit, _JITTER), 0.6 * usual)
    near = near if near.any() else np.abs(steps - usual) <= unit
    return usual, float((steps[near] * counts[near]).sum() / counts[near].sum())


def _fitted_step(times: Floats, step: float, slack: float) -> float:
    """The step that fits best, in the sense of least squares, the times that are near multiples of it."""
    ahead = times - times[0]
    frames = np.round(ahead / step)
    near = np.abs(ahead - frames * step) <= min(slack, 0.3 * step)
    frames, ahead = frames[near], ahead[near]
    if len(frames) < 3:
        return step
    frames = frames - frames.mean()
    return float((frames * ahead).sum() / (frames * frames).sum())


def _candidates(mean: float, slack: float) -> Iterator[Fraction]:
    """The rates that such a mean step may stand for: usual ones first."""
    if mean <= 1.5:
        yield Fraction(max(1, round(1 / mean)))
        yield Fraction(max(1, round(1.001 / mean))) * Fraction(1000, 1001)
    else:
        yield Fraction(1, round(mean))
    low, high = Fraction(1 / (mean + slack)), Fraction(1 / max(mean - slack, mean / 2))
    yield _simplest(low, high)
    yield Fraction(1 / mean).limit_denominator(100_000)


def _simplest(low: Fraction, high: Fraction) -> Fraction:
    """The fraction with the least denominator from ``low`` to ``high``."""
    whole = low.numerator // low.denominator
    if low == whole:
        return Fraction(whole)
    if whole + 1 <= high:
        return Fraction(whole + 1)
    return whole + 1 / _simplest(1 / (high - whole), 1 / (low - whole))


def _share_of(clock: Clock, times: Floats, spread: float) -> float:
    """The share of times that fit a clock; none where they drift from it by more than ``spread``."""
    misses = times - clock.begin - clock.frames(times) / float(clock.rate)
    fits = misses[np.abs(misses) <= clock.slack]
    if not len(fits) or (clock.slack < _JITTER and float(np.ptp(fits)) > spread):
        return 0.0
    return len(fits) / len(times)


def _anchored(times: Floats, anchor: float, rate: Fraction, slack: float) -> Clock:
    """The clock of a rate on which the time ``anchor`` lies."""
    before = round((anchor - float(times[0])) * float(rate))
    return Clock(
        anchor - before / float(rate) if before else anchor, _whole(rate), min(slack, 0.45 / float(rate))
    )
