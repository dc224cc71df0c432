"""Sums over a recording that may be larger than memory: a median, and speeds against distances."""

import tempfile
from dataclasses import dataclass
from typing import BinaryIO, cast

import numpy as np

from roadproof.extensions.traffic.formats.clock import Rate
from roadproof.extensions.traffic.formats.recording import Floats, Recording, blocks_of


class Median:
    """Numbers that are added bit by bit; more than ``most`` are put into a file without a name."""

    def __init__(self, most: int) -> None:
        self.most = most
        self.count = 0
        self.held: list[Floats] = []
        self.file: BinaryIO | None = None

    def add(self, numbers: Floats) -> None:
        self.count += len(numbers)
        self.held.append(numbers)
        if sum(map(len, self.held)) > self.most:
            self._put_away()

    def _put_away(self) -> BinaryIO:
        if self.file is None:
            self.file = cast(BinaryIO, tempfile.TemporaryFile())  # noqa: SIM115
        for part in self.held:
            self.file.write(np.ascontiguousarray(part).tobytes())
        self.held = []
        self.file.flush()
        return self.file

    def value(self) -> float:
        """Return the median of all numbers, of which there must be one."""
        if self.file is None:
            return float(np.median(np.concatenate(self.held)))
        numbers = np.memmap(self._put_away(), np.float64)
        middle = [(self.count - 1) // 2, self.count // 2]
        numbers.partition(middle)
        return float(np.mean(numbers[middle]))


MOST = 0.01
"""Above this share of difference on the whole there is a note."""
LEAST_WAY = 100.0
"""m; vehicles must move so far together before their speeds are compared with it."""
SHARE, LEAST = 0.1, 1.0
"""Vehicles whose way and speeds differ by more than this share, or that move by less than so many m, do not
count: the former contradict themselves (``plausible``)."""


def integrate(rate: Floats, frames_a_second: Rate, last: tuple[float, float] | None = None) -> Floats:
    """The integral of a rate up to each sample, straight between samples; only differences mean something.

    ``last``: the integral and the rate at the sample before, where there is one.
    """
    total, twice = np.empty(len(rate)), 2 * float(frames_a_second)
    total[:1] = 0.0 if last is None else last[0] + (rate[0] + last[1]) / twice
    for part in blocks_of(len(rate), overlap=1):
        values = rate[part]
        steps = values[1:] + values[:-1]
        steps /= twice
        if len(steps):
            steps[0] += total[part.start]
            np.cumsum(steps, out=total[part.start + 1 : part.stop])
    return total


@dataclass
class SpeedScale:
    """The ways of all vehicles (m) from their first to their last frame, and the integral of their speeds.

    ``vehicles`` are those that count, ``row`` is the first sample of the first of them.
    """

    way: float = 0.0
    integral: float = 0.0
    vehicles: int = 0
    row: int = 0

    def add(self, recording: Recording, before: int, total: Floats) -> None:
        """Add vehicles, before which there were so many rows; ``total``: the integral of their speeds."""
        first, last = recording.start[:-1], recording.start[1:] - 1
        way, integral = recording.s[last] - recording.s[first], total[last] - total[first]
        greater = np.maximum(np.abs(way), np.abs(integral))
        counts = (greater > LEAST) & (np.abs(way - integral) <= SHARE * greater)
        if not counts.any():
            return
        if not self.vehicles:
            self.row = before + int(first[np.argmax(counts)])
        self.way += float(way[counts].sum())
        self.integral += float(integral[counts].sum())
        self.vehicles += int(np.count_nonzero(counts))

    def text(self) -> str | None:
        """The difference in words; None where it is small, or too little is known."""
        if abs(self.way) < LEAST_WAY:
            return None
        off = self.integral / self.way - 1
        if abs(off) <= MOST:
            return None
        return (
            f"speeds along the road are {100 * abs(off):.1f} % too {'high' if off > 0 else 'low'} on the "
            f"whole: vehicles move {self.way:.0f} m, their speeds add up to {self.integral:.0f} m"
        )
