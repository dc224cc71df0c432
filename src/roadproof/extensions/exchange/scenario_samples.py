"""Samples of the vehicles of an OpenSCENARIO file, from vertices or from a storyboard that was run.

Between vertices places are interpolated by cubics; speeds and accelerations are those of the cubics.
"""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from roadproof.errors import InputError
from roadproof.extensions.exchange.storyboard.box import ObjectBox
from roadproof.extensions.exchange.storyboard.conditions import TICKS
from roadproof.extensions.exchange.storyboard.curves import curve
from roadproof.extensions.exchange.storyboard.play import Play
from roadproof.extensions.traffic.evaluate.robust import MOST_SAMPLES
from roadproof.extensions.traffic.formats.recording import Floats
from roadproof.extensions.traffic.formats.samples import LABEL, TIME, VEHICLE
from roadproof.extensions.traffic.formats.table import Column, ColumnTable
from roadproof.world.not_read import LEFT_OUT
from roadproof.world.road import Road
from roadproof.world.signals import RECORDED, SIZES

RATE = 25
"""Samples a second."""


@dataclass(frozen=True)
class CentreLine:
    """Vertices of the centre of a box in road coordinates, by time (s, m)."""

    time: Floats
    s: Floats
    d: Floats


class Samples(ColumnTable):
    """Samples whose place is said by vehicle and time, as the file has vertices in place of rows."""

    def cell(self, row: int, column: str) -> str:
        vehicle, time = self.columns[VEHICLE][row], self.columns[TIME][row]
        value = self.columns[column][row]
        shown = value if isinstance(value, str) else f"{value:g}"
        return f"vehicle {vehicle} at {time:g} s, {column}={shown}"


def centre_line(vertices: Floats, box: ObjectBox, road: Road) -> CentreLine:
    """Return the centre of the box, along and beside the reference line of the road."""
    time, x, y, heading = vertices.T
    ahead, left = box.centre
    x = x + ahead * np.cos(heading) - left * np.sin(heading)
    y = y + ahead * np.sin(heading) + left * np.cos(heading)
    if road.line is None:
        return CentreLine(time, x, y)
    s, d = np.array([road.line.locate(float(a), float(b)) for a, b in zip(x, y, strict=True)]).T
    return CentreLine(time, s, d)


def sample_centre_lines(
    path: Path, boxes: Mapping[str, ObjectBox], ways: Mapping[str, CentreLine]
) -> ColumnTable:
    """Return the samples of boxes whose centres move so. Raises ``InputError`` if there are too many."""
    tables = []
    for name, way in ways.items():
        first, last = math.ceil(way.time[0] * RATE - 1e-6), math.floor(way.time[-1] * RATE + 1e-6)
        if last - first >= MOST_SAMPLES:
            raise InputError(
                f"{path}: the trajectory of {name} lasts {way.time[-1] - way.time[0]:g} s; at most "
                f"{MOST_SAMPLES // RATE:,} s are read"
            )
        times = np.clip(np.arange(first, last + 1) / RATE, way.time[0], way.time[-1])
        s, v_lon, a_lon = curve(way.time, way.s, times)
        d, v_lat, a_lat = curve(way.time, way.d, times)
        moving = (s, d, v_lon, v_lat, a_lon, a_lat)
        tables.append(_rows(name, boxes[name], np.arange(first, last + 1) / RATE, moving))
    return _joined(path, tables)


def sample_play(path: Path, boxes: Mapping[str, ObjectBox], play: Play) -> tuple[ColumnTable, list[str]]:
    """Return the states of a storyboard, RATE a second, and notes on objects that are left out.

    An object is another vehicle after it was put somewhere else, or was away.
    """
    step = TICKS // RATE
    tables, notes = [], []
    against = sorted(x for x in boxes if any(x in now and not now[x].forward for now in play.states))
    for name, box in boxes.items():
        parts = [x for x in _presences(name, play, step) if len(x) > 1] if box.recorded else []
        for k, ticks in enumerate(parts):
            states = [play.states[tick][name] for tick in ticks]
            moving = np.array([[getattr(x, y) for x in states] for y in map(str, RECORDED)])
            moving[:2] += np.array(box.centre)[:, None]
            called = f"{name} ({k + 1})" if k else name
            tables.append(_rows(called, box, np.array(ticks) / TICKS, tuple(moving)))
        if len(parts) > 1:
            notes.append(f"{name} is put somewhere else: from then on it is {name} (2)")
        if not parts and box.recorded and name not in against:
            notes.append(
                f"left out, as no TeleportAction, AddEntityAction or trajectory says where it is: {name}"
                if name not in play.controlled
                else f"{LEFT_OUT}, as the file does not say where it is: {name}, {play.controlled[name]}"
            )
        elif name in play.controlled:
            notes.append(f"{LEFT_OUT} from then on: {name}, {play.controlled[name]}")
    for rule, names in (
        ("they are no motor vehicles", sorted(x for x, box in boxes.items() if not box.recorded)),
        ("they drive against the others", [x for x in against if boxes[x].recorded]),
    ):
        if names:
            notes.append(f"left out, as {rule}: {', '.join(names)}")
    if not tables:
        raise InputError(f"{path}: no motor vehicle is on the road: {'; '.join(notes)}")
    return _joined(path, tables), notes


def _presences(name: str, play: Play, step: int) -> Iterator[list[int]]:
    """Ticks at which an object drives along the road, every ``step``-th, from one jump to the next one."""
    ticks: list[int] = []
    for tick in range(0, len(play.states), step):
        there = name in play.states[tick] and play.states[tick][name].forward
        jumps = there and any(play.jumps(name, x) for x in range(max(tick - step, 0) + 1, tick + 1))
        if ticks and (not there or jumps):
            yield ticks
            ticks = []
        if there:
            ticks.append(tick)
    if ticks:
        yield ticks


def _rows(name: str, box: ObjectBox, times: Floats, moving: tuple[Floats, ...]) -> dict[str, Column]:
    """The samples of a vehicle whose middle moves so: its front-left corner, as in all recordings."""
    s, d, *rates = moving
    columns: dict[str, Column] = {
        TIME: times,
        VEHICLE: np.full(len(times), name),
        "kind": np.full(len(times), box.kind),
        LABEL: np.full(len(times), box.label),
    }
    corner = (s + box.length / 2, d + box.width / 2, *rates)
    columns |= zip(map(str, RECORDED), corner, strict=True)
    return columns | {str(x): np.full(len(times), getattr(box, x)) for x in SIZES}


def _joined(path: Path, tables: list[dict[str, Column]]) -> ColumnTable:
    columns = {column: np.concatenate([x[column] for x in tables]) for column in tables[0]}
    return Samples(path, columns, len(columns[TIME]))
