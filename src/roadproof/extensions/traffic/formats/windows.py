"""A recording in windows of time: each vehicle whole, so that nothing that it does is cut.

A window holds the vehicles that come in during it, and those that are still there when it begins. What some
vehicles do together, in a frame that they share, is in the window in which the last of them comes in.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from roadproof.extensions.traffic.formats.clock import Rate
from roadproof.extensions.traffic.formats.recording import Bools, Integers, Recording
from roadproof.world.road import Zone

MOST_SAMPLES = 1_000_000
"""A recording of more samples is looked at in windows of so many, where its format can be read in parts."""


@dataclass(frozen=True)
class TimeWindow:
    """Vehicles of a recording, with an entry each that says whether they are ``new``: came in during it."""

    recording: Recording
    new: Bools

    def has(self, *vehicles: Integers) -> Bools:
        """Return for each pair or triple whether the last of them came in during this window."""
        new_ones: Bools = np.logical_or.reduce([self.new[index] for index in vehicles])
        return new_ones


@dataclass(frozen=True)
class WindowedRecording:
    """A recording in ``windows``, of which one at a time is in memory, and what is said of the whole."""

    rate: Rate
    zone_names: tuple[Zone, ...]
    windows: Callable[[], Iterator[TimeWindow]]


def undivided(recording: Recording) -> WindowedRecording:
    """All of a recording as one window."""
    whole = TimeWindow(recording, np.ones(recording.vehicles, np.bool_))
    return WindowedRecording(recording.rate, recording.zone_names, lambda: iter((whole,)))


def divide(first_frame: Integers, last_frame: Integers, samples: int) -> Iterator[tuple[Bools, Bools]]:
    """Yield for each window which vehicles are in it, and which of these came in during it.

    A window has as many ``samples`` as it may, but the vehicles that come in at one frame are not divided.
    """
    counts = last_frame - first_frame + 1
    frames = np.unique(first_frame)
    order = np.argsort(first_frame, kind="stable")
    entering = np.add.reduceat(counts[order], np.searchsorted(first_frame[order], frames))
    begin = 0
    while begin < len(frames):
        there = (first_frame < frames[begin]) & (last_frame >= frames[begin])
        room = samples - int(counts[there].sum())
        taken = np.searchsorted(np.cumsum(entering[begin:]), room, side="right")
        end = begin + max(1, int(taken))
        new = (first_frame >= frames[begin]) & (first_frame <= frames[end - 1])
        yield there | new, new
        begin = end
