"""Recordings on straight roads that are more than lanes without end: which lanelet each box is in.

The road of a recording is a file in the form of models/roads, in the recording's own s and d.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from roadproof.errors import InputError
from roadproof.extensions.traffic.formats.recording import (
    ZONES,
    Bools,
    Column,
    Floats,
    Integers,
    Lane,
    Masks,
    Recording,
    beside_by_order,
    occupy_bands,
    offsets,
)
from roadproof.world.road import Lanelet, Road
from roadproof.world.signals import RECORDED

if TYPE_CHECKING:
    from roadproof.extensions.traffic.formats.clock import Rate

MOST_LANES = 32
"""As many as a mask has bits."""


@dataclass(frozen=True)
class StraightRoad:
    """Lanes, which of them are beside each other, and their lanelets; none where all lanes are bands."""

    lanes: tuple[Lane, ...]
    beside: frozenset[frozenset[str]]
    lanelets: tuple[Lanelet, ...]


@dataclass(frozen=True)
class Placement:
    """The fields of ``Recording`` that places decide: ``occupancy``, ``lane``, ``zones``, and ``inside``."""

    occupancy: Masks
    lane: Integers
    zones: Masks
    inside: Bools


def of_road(road: Road, direction: int, path: Path, others: Iterable[Lane] = ()) -> StraightRoad:
    """``road`` for one direction, with the bands ``others`` of another one. ``path`` is for messages.

    Raises ``InputError`` for more than 32 lanes, and for names that occur twice.
    """
    bands = tuple(others)
    ours = tuple(Lane(name, direction, _band(road, name)) for name in road.lanes)
    for lane in ours:
        if lane.name in {x.name for x in bands}:
            raise InputError(f"{path}: lane={lane.name}: a lane of the other direction has this name")
    lanes = (*bands, *ours)
    if len(lanes) > MOST_LANES:
        raise InputError(f"{path}: {len(lanes)} lanes; at most {MOST_LANES} are supported")
    lanelets = (*(as_lanelet(lane) for lane in bands), *road.lanelets)
    return StraightRoad(lanes, beside_by_order(bands) | road.adjacent, lanelets)


def of_bands(lanes: tuple[Lane, ...]) -> StraightRoad:
    """Lanes without end, beside each other in their order."""
    return StraightRoad(lanes, beside_by_order(lanes), ())


def as_lanelet(lane: Lane) -> Lanelet:
    """A band as one lanelet of the main road, without end."""
    if lane.d is None:
        raise ValueError(f"lane {lane.name} is no straight band")
    right, left = (Fraction(str(x)) for x in lane.d)
    return Lanelet(lane.name, lane.name, "main", "main", (None, None), (right, left))


def place(
    road: StraightRoad, direction: Integers, s: Floats, d: Floats, length: Floats, width: Floats
) -> Placement:
    """Return where boxes are (semantics §4); all arrays have one entry a sample.

    Metres are compared to the micrometre, so that a box which touches a bound in the decimals of its file
    does so here. A centre on a bound is in the lanelet that begins there, or to the left of it.
    """
    if not road.lanelets:
        occupancy, lane = occupy_bands(road.lanes, direction, d, width)
        return Placement(occupancy, lane, (occupancy != 0).astype(np.uint32), np.zeros((0, 0), np.bool_))
    index = {lane.name: k for k, lane in enumerate(road.lanes)}
    occupancy, zones = np.zeros(len(s), np.uint32), np.zeros(len(s), np.uint32)
    lane = np.full(len(s), -1, np.int64)
    inside = np.zeros((len(s), len(road.lanelets)), np.bool_)
    rear, right = np.round(s - length, 6), np.round(d - width, 6)
    along, across = np.round(s - length / 2, 6), np.round(d - width / 2, 6)
    for j, lanelet in enumerate(road.lanelets):
        k = index[lanelet.lane]
        ours = direction == road.lanes[k].direction
        begin = -np.inf if lanelet.s[0] is None else float(lanelet.s[0])
        end = np.inf if lanelet.s[1] is None else float(lanelet.s[1])
        low, high = (float(x) for x in lanelet.d)
        inside[:, j] = ours & (s > begin) & (rear < end) & (d > low) & (right < high)
        occupancy |= inside[:, j].astype(np.uint32) << np.uint32(k)
        zones |= inside[:, j].astype(np.uint32) << np.uint32(ZONES.index(lanelet.zone))
        in_lanelet = (begin <= along) & (along < end) & (low <= across) & (across < high)
        lane[ours & in_lanelet] = k
    return Placement(occupancy, lane, zones, inside)


def place_recording(
    road: StraightRoad,
    name: str,
    rate: Rate,
    vehicles: Mapping[str, Column],
    counts: Integers,
    signals: Iterable[Floats],
) -> Recording:
    """A recording on ``road``, whose samples are placed here.

    ``vehicles``: the fields ``OF_VEHICLES`` of each, ``counts``: of how many samples; ``signals``: an entry
    a sample, in the order of RECORDED.
    """
    columns: dict[str, Any] = {**vehicles, **dict(zip(RECORDED, signals, strict=True))}
    ways, length, width = (np.repeat(columns[x], counts) for x in ("direction", "length", "width"))
    placed = place(road, ways, columns["s"], columns["d"], length, width)
    return Recording(name=name, rate=rate, start=offsets(counts), **columns, **vars(road), **vars(placed))


def _band(road: Road, lane: str) -> tuple[float, float] | None:
    """(right, left) of a lane whose lanelets all have the same."""
    bands = {x.d for x in road.lanelets_of(lane)}
    if len(bands) > 1:
        return None
    ((right, left),) = bands
    return float(right), float(left)
