"""The checks of the readers, repeated on a recording that was converted: its files may have been changed."""

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import numpy as np

from roadproof.errors import InputError
from roadproof.extensions.traffic.formats.clock import LARGEST_RATE, LONGEST_STEP, Rate
from roadproof.extensions.traffic.formats.plausible import (
    LARGEST_ACCELERATION,
    LARGEST_SIZE,
    LARGEST_SPEED,
    Contradiction,
    ContradictionChecks,
)
from roadproof.extensions.traffic.formats.recording import (
    ZONES,
    Bools,
    Floats,
    Integers,
    Lane,
    Recording,
    beside_by_order,
)
from roadproof.extensions.traffic.formats.samples import LARGEST_PLACE
from roadproof.extensions.traffic.formats.straight import Placement, StraightRoad, place
from roadproof.extensions.traffic.formats.table import largest_magnitude
from roadproof.world.signals import RECORDED

_TURNED = 1.5
"""Components of a velocity grow by at most the root of 2 where they are turned along a measured road."""
_ROUNDING = 0.015
"""m; highD rounds sizes in two files, and boxes are placed by either."""


class PlausibilityChecks:
    """Checks of one recording, whose vehicles are added one after the other, each whole."""

    def __init__(self, head: Path, rate: Rate, lanes: tuple[Lane, ...]) -> None:
        self.head = head
        if not 1 / LONGEST_STEP <= rate <= LARGEST_RATE:
            raise InputError(f"{head}, rate={rate}: must lie between 1/{LONGEST_STEP} and {LARGEST_RATE}")
        self.doubting = ContradictionChecks(rate, lanes)
        self.ids: list[Integers] = []
        self.frames: list[tuple[Integers, Integers]] = []
        self.rows = 0

    def add(self, recording: Recording) -> None:
        """Check the next vehicles. Raises ``InputError``."""
        _check_cells(self.head, recording)
        _check_places(self.head, recording)
        self.doubting.add(recording)
        self.ids.append(recording.vehicle_id)
        self.frames.append((recording.start[:-1] + self.rows, recording.first_frame))
        self.rows += len(recording.s)

    def notes(self, known: Sequence[str]) -> tuple[str, ...]:
        """Return the contradictions that the ``known`` notes do not mention. Raises ``InputError``."""
        ids = np.concatenate(self.ids)
        if (np.diff(ids) <= 0).any():
            raise InputError(f"{self.head}, vehicle_id: ids must differ and ascend")
        return tuple(
            text for text, why in self._contradictions(ids) if not any(why in note for note in known)
        )

    def _contradictions(self, ids: Integers) -> Iterator[tuple[str, str]]:
        for contradiction in self.doubting.contradictions():
            yield (
                self._note(self._at(contradiction, ids), contradiction.text, contradiction.refused),
                contradiction.text,
            )
        off = self.doubting.off_road()
        if off is not None:
            text = f"on no lane at any time, like {off.count} vehicles"
            yield self._note(f"vehicle {ids[off.vehicle]}", text, off.refused), f"like {off.count} "

    def _at(self, contradiction: Contradiction, ids: Integers) -> str:
        start, first = (np.concatenate([x[k] for x in self.frames]) for k in (0, 1))
        vehicle = int(np.searchsorted(start, contradiction.row, "right")) - 1
        frame = int(first[vehicle] + contradiction.row - start[vehicle])
        return f"{contradiction.signal} of vehicle {ids[vehicle]} at frame {frame}"

    def _note(self, where: str, text: str, refused: bool) -> str:
        if refused:
            raise InputError(f"{self.head}, {where}: {text}")
        return f"{self.head.name}, {where}: {text}"


def _check_cells(head: Path, recording: Recording) -> None:
    """Refuse cells with impossible values, and cells of lanes or zones that the road lacks."""
    straight = recording.slack is None
    turned, place, across = (
        (1.0, LARGEST_PLACE, LARGEST_ACCELERATION) if straight else (_TURNED, np.inf, np.inf)
    )
    speed, along = LARGEST_SPEED * turned, LARGEST_ACCELERATION * turned
    for column, most in zip(RECORDED, (place, place, speed, speed, along, across), strict=True):
        values: Floats = getattr(recording, column)
        reach = largest_magnitude(values)
        if reach <= most and reach < np.inf:
            continue
        fine = np.isfinite(values) & (np.abs(values) <= most)
        _require_all(head, recording, fine, column, f"must be finite and lie between {-most:g} and {most:g}")
    for name in ("length", "width"):
        size: Floats = getattr(recording, name)
        if not (np.isfinite(size) & (size > 0) & (size <= LARGEST_SIZE)).all():
            raise InputError(f"{head}, {name}: sizes are greater than 0 and at most {LARGEST_SIZE:g} m")
    lanes = len(recording.lanes)
    there = (recording.lane >= -1) & (recording.lane < lanes)
    _require_all(head, recording, there, "lane", f"there are {lanes} lanes")
    for name, bits in (("occupancy", lanes), ("zones", len(ZONES))):
        if int(getattr(recording, name).max()) >> bits:
            known = getattr(recording, name).astype(np.int64) >> bits == 0
            _require_all(head, recording, known, name, "no such bit")


def _check_places(head: Path, recording: Recording) -> None:
    """Lanes, zones and lanelets of each box, derived again where the road is straight."""
    if recording.slack is not None:
        if any(lane.d is not None for lane in recording.lanes):
            raise InputError(f"{head}, lanes: lanes of a measured road are no straight bands")
        _check_lanelets(head, recording)
        return
    road = StraightRoad(recording.lanes, recording.beside, recording.lanelets)
    if not recording.lanelets and recording.beside != beside_by_order(recording.lanes):
        raise InputError(f"{head}, beside: lanes are beside each other in the order of their bands")
    placed = _placed(recording, road, 0.0)
    if all(np.array_equal(getattr(placed, x), getattr(recording, x)) for x in _PLACED):
        return
    least, most = _placed(recording, road, -_ROUNDING), _placed(recording, road, _ROUNDING)
    for name in ("occupancy", "zones", "inside"):
        low, actual, high = (getattr(x, name) for x in (least, recording, most))
        fine = (low & ~actual == 0) & (actual & ~high == 0)
        rows = fine.all(axis=1) if fine.ndim > 1 else fine
        _require_all(head, recording, rows, name, "the box and the road say otherwise")
    lane = recording.lane
    centre = (lane == least.lane) | (lane == placed.lane) | (lane == most.lane)
    _require_all(head, recording, centre, "lane", "the centre of the box and the road say otherwise")


_PLACED = ("occupancy", "lane", "zones", "inside")


def _placed(recording: Recording, road: StraightRoad, more: float) -> Placement:
    """Return where boxes are that are larger by ``more`` (m) in both directions."""
    counts = np.diff(recording.start)
    direction = np.repeat(recording.direction, counts)
    length, width = (np.repeat(x, counts) + more for x in (recording.length, recording.width))
    return place(road, direction, recording.s, recording.d, length, width)


def _check_lanelets(head: Path, recording: Recording) -> None:
    """The lanes and zones of each box, which follow from the lanelets that it is in."""
    index = {lane.name: k for k, lane in enumerate(recording.lanes)}
    masks: tuple[tuple[str, Callable[[int], int]], ...] = (
        ("occupancy", lambda j: index[recording.lanelets[j].lane]),
        ("zones", lambda j: ZONES.index(recording.lanelets[j].zone)),
    )
    for name, bit_of in masks:
        from_lanelets = np.zeros(len(recording.s), np.uint32)
        for j in range(recording.inside.shape[1]):
            from_lanelets |= recording.inside[:, j].astype(np.uint32) << np.uint32(bit_of(j))
        _require_all(
            head, recording, from_lanelets == getattr(recording, name), name, "the lanelets say otherwise"
        )
    own = np.array([1 << k for k in range(len(recording.lanes))] + [0xFFFFFFFF], np.uint32)
    on_lane = (recording.lane < 0) | (recording.occupancy & own[recording.lane] != 0)
    _require_all(head, recording, on_lane, "lane", "the box is not on that lane")


def _require_all(head: Path, recording: Recording, fine: Bools, column: str, rule: str) -> None:
    """Raise ``InputError`` for the first sample that is not ``fine``."""
    if fine.all():
        return
    row = int(np.argmin(fine))
    vehicle = int(np.searchsorted(recording.start, row, "right")) - 1
    frame = int(recording.first_frame[vehicle] + row - recording.start[vehicle])
    where = f"{column}={getattr(recording, column)[row]} of vehicle {recording.vehicle_id[vehicle]}"
    raise InputError(f"{head}, {where} at frame {frame}: {rule}")
