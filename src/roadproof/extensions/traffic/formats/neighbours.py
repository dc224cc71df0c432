"""The neighbours of each vehicle, as in the neighbour columns of highD, for all samples at once.

A vehicle's lane is the one that holds the centre of its box. Left and right are in driving direction.
Vehicles in one place are noise in measured traffic, and a fault in simulated traffic.
"""

from dataclasses import dataclass

import numpy as np

from roadproof.extensions.traffic.formats.recording import Bools, Floats, Integers, Recording

NONE = -1


@dataclass(frozen=True)
class Neighbours:
    """Row indices into the samples, -1 for none."""

    preceding: Integers
    following: Integers
    beside: dict[str, Integers]  # leftPreceding, leftAlongside, leftFollowing, rightPreceding, …


def find_neighbours(recording: Recording) -> Neighbours:
    """Neighbours of every sample of a recording on straight bands."""
    places = _LaneOrder(recording)
    beside: dict[str, Integers] = {}
    for side, shift in (("left", 1), ("right", -1)):
        preceding, alongside, following = places.beside(shift)
        beside |= {
            f"{side}Preceding": preceding,
            f"{side}Alongside": alongside,
            f"{side}Following": following,
        }
    return Neighbours(places.shifted(1), places.shifted(-1), beside)


class _LaneOrder:
    """Samples in order of frame, direction, lane from the right, and front."""

    def __init__(self, recording: Recording) -> None:
        self.front = recording.s
        self.rear = recording.s - recording.length[recording.row_vehicle]
        lanes = recording.lanes
        rank = np.array([_rank(recording, k) for k in range(len(lanes))] + [0])
        on_lane = recording.lane >= 0
        # One free slot at each end of a carriageway keeps neighbours of the outer lanes apart.
        slots = 2 * (len(lanes) + 2)
        direction = np.array([lane.direction for lane in lanes] + [1])[recording.lane]
        self.group = (
            recording.row_frame * slots + (direction - 1) * (len(lanes) + 2) + rank[recording.lane] + 1
        )
        self.group[~on_lane] = -1
        self.order = np.lexsort((self.front, self.group))
        spread = self.front.max() - self.front.min() + 1
        self.key = self.group * spread + (self.front - self.front.min())
        self.sorted_key = self.key[self.order]
        self.sorted_group = self.group[self.order]
        self.spread = spread
        self.on_lane = on_lane

    def shifted(self, step: int) -> Integers:
        """The sample ``step`` places ahead in the same lane and frame."""
        place = np.empty(len(self.order), np.int64)
        place[self.order] = np.arange(len(self.order))
        return np.where(self.on_lane, self._at(place + step, self.group), NONE)

    def beside(self, shift: int) -> tuple[Integers, Integers, Integers]:
        """Preceding, alongside and following in the lane ``shift`` to the left.

        Alongside overlaps along the road; of several the foremost counts.
        """
        group = np.where(self.on_lane, self.group + shift, -2)
        place = np.searchsorted(self.sorted_key, self.key + shift * self.spread, side="right")
        ahead = self._at(place, group)
        level = self._overlaps(ahead)
        alongside = np.where(level, ahead, NONE)
        preceding = np.where(level, self._at(place + 1, group), ahead)
        behind = place - 1
        following = self._at(behind, group)
        while (level := self._overlaps(following)).any():
            alongside = np.where(level & (alongside == NONE), following, alongside)
            behind = behind - level
            following = np.where(level, self._at(behind, group), following)
        return preceding, alongside, following

    def _overlaps(self, other: Integers) -> Bools:
        return (other >= 0) & (self.rear[other] < self.front) & (self.rear < self.front[other])

    def _at(self, place: Integers, group: Integers) -> Integers:
        inside = (place >= 0) & (place < len(self.order))
        at = np.where(inside, place, 0)
        return np.where(inside & (self.sorted_group[at] == group), self.order[at], NONE)


def _rank(recording: Recording, lane: int) -> int:
    """Return how many lanes of the same direction lie to the right."""
    ours = recording.lanes[lane]

    def right_edge(k: int) -> float:
        band = recording.lanes[k].d
        if band is None:
            raise ValueError(f"lane {recording.lanes[k].name} is no straight band")
        return band[0]

    others = (k for k, x in enumerate(recording.lanes) if x.direction == ours.direction)
    return sum(right_edge(k) < right_edge(lane) for k in others)


def gaps_ahead(recording: Recording, preceding: Integers) -> tuple[Floats, Floats, Floats, Floats]:
    """dhw (m, bumper to bumper), thw (s), ttc (s) and the leader's speed (m/s); 0 without a leader.

    ttc is negative where the leader is faster, as in highD, and 0 where speeds are equal.
    """
    known = preceding >= 0
    rear = recording.s - recording.length[recording.row_vehicle]
    dhw = np.where(known, rear[preceding] - recording.s, 0)
    speed = np.where(known, recording.v_lon[preceding], 0)
    closing = recording.v_lon - speed
    moving, approaching = known & (recording.v_lon > 0), known & (closing != 0)
    thw = np.divide(dhw, recording.v_lon, out=np.zeros_like(dhw), where=moving)
    ttc = np.divide(dhw, closing, out=np.zeros_like(dhw), where=approaching)
    return dhw, thw, ttc, speed
