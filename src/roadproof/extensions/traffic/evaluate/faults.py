"""Samples that no motion of vehicles can have: jumps, and vehicles that drive through each other."""

from collections.abc import Iterator
from itertools import combinations, permutations

import numpy as np

from roadproof.extensions.traffic.evaluate.one_trace import OneTrace
from roadproof.semantics.sampled.batch import Array
from roadproof.world.signals import SignalName

_JUMPS: tuple[tuple[SignalName, SignalName, float], ...] = (("s", "v_lon", 2.0), ("d", "v_lat", 1.0))
"""How far (m) a place may be from where the speed leads from one sample to the next."""
_ASIDE = 0.1
"""m: boxes that overlap less across the road may pass each other."""


def faults_of(trace: OneTrace) -> tuple[str, ...]:
    """Return the first fault of each kind of each vehicle and pair, in words."""
    jumps = [x for name in trace.lanes for x in _jumps(trace, name)]
    return (*jumps, *(x for pair in combinations(trace.lanes, 2) for x in _passes(trace, *pair)))


def _column(trace: OneTrace, signal: str, name: str) -> Array:
    return trace.batch.signals[signal, name][: int(trace.batch.lengths[0]), 0]


def _jumps(trace: OneTrace, name: str) -> Iterator[str]:
    """A line for the first jump along the road, and one for the first across it."""
    step = float(trace.batch.dt)
    for place, speed, most in _JUMPS:
        change, rate = np.diff(_column(trace, place, name)), _column(trace, speed, name)
        off = np.abs(change - (rate[1:] + rate[:-1]) / 2 * step)
        if len(off) and off.max() > most:
            k = int(np.argmax(off > most))
            yield (
                f"vehicle {name}: {place} changes by {change[k]:.4g} m in the {step:.4g} s from sample {k}, "
                f"but {speed} is {rate[k]:.4g} m/s: no vehicle jumps"
            )


def _passes(trace: OneTrace, one: str, other: str) -> Iterator[str]:
    """A line where the middle of one box passes that of the other while they overlap across the road."""
    sizes = trace.batch.sizes
    middle = {x: _column(trace, "s", x) - sizes["length", x][0] / 2 for x in (one, other)}
    left = {x: _column(trace, "d", x) for x in (one, other)}
    right = {x: left[x] - sizes["width", x][0] for x in (one, other)}
    overlap = np.minimum(left[one], left[other]) - np.maximum(right[one], right[other]) > _ASIDE
    for back, front in permutations((one, other)):
        ahead = middle[front] - middle[back] > 0
        through = ahead[:-1] & ~ahead[1:] & overlap[:-1] & overlap[1:]
        if through.any():
            time = int(np.argmax(through)) * float(trace.batch.dt)
            yield f"vehicle {back} drives through {front} {time:.4g} s after the first sample"
