"""Traces of OSI ground truth, written by an encoder of their own."""

import struct
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from extensions.traffic.planar import Bend, moving, straight
from extensions.traffic.planar_exid import turned
from roadproof.extensions.traffic.formats.recording import Recording

TYPES = {"Car": 4, "Truck": 7, "Bus": 12, "Motorcycle": 10}
"""Numbers of vehicle classes."""


@dataclass(frozen=True)
class Seen:
    """A moving object at a moment: place, yaw, velocity and acceleration in the plane; None if not set."""

    id: int
    size: tuple[float, float]
    place: tuple[float, float]
    yaw: float
    velocity: tuple[float, float] | None
    acceleration: tuple[float, float] | None
    type: int = 2
    kind: int | None = 4


def varint(value: int) -> bytes:
    value %= 1 << 64
    made = bytearray()
    while value > 0x7F:
        made.append(value & 0x7F | 0x80)
        value >>= 7
    return bytes((*made, value))


def number(field: int, value: int) -> bytes:
    return varint(field << 3) + varint(value)


def part(field: int, content: bytes) -> bytes:
    return varint(field << 3 | 2) + varint(len(content)) + content


def doubles(field: int, *values: float | None) -> bytes:
    """A message of doubles in the fields 1, 2, …; None for one that is not set."""
    inner = b"".join(
        varint(k << 3 | 1) + struct.pack("<d", x) for k, x in enumerate(values, 1) if x is not None
    )
    return part(field, inner)


def object_of(seen: Seen) -> bytes:
    base = doubles(1, *seen.size, 1.5) + doubles(2, *seen.place, 0.75) + doubles(3, None, None, seen.yaw)
    base += doubles(4, *seen.velocity, 0.0) if seen.velocity is not None else b""
    base += doubles(5, *seen.acceleration, 0.0) if seen.acceleration is not None else b""
    base += doubles(6, 0.0, 0.0, 0.1)  # the rate of the orientation is not read
    made = part(1, number(1, seen.id)) + part(2, base) + number(3, seen.type) + part(7, b"a model")
    return made if seen.kind is None else made + part(6, number(1, seen.kind) + number(3, 0))


def ground_truth(nanos: int, objects: list[Seen]) -> bytes:
    time = part(2, number(1, nanos // 10**9) + number(2, nanos % 10**9))
    return (
        part(1, number(1, 3))
        + time
        + part(3, number(1, 0))
        + b"".join(part(5, object_of(x)) for x in objects)
    )


def write_osi(
    folder: Path,
    moments: list[list[Seen]],
    rate: int,
    name: str = "trace",
    zero: int = 0,
    wrap: Callable[[bytes], bytes] = lambda message: message,
) -> Path:
    """A trace whose messages are 1/rate s apart from ``zero`` (ns) on."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{name}.osi"
    messages = [wrap(ground_truth(zero + k * 10**9 // rate, x)) for k, x in enumerate(moments)]
    path.write_bytes(b"".join(struct.pack("<I", len(x)) + x for x in messages))
    return path


def moments_of(recording: Recording, bend: Bend = straight) -> list[list[Seen]]:
    """The vehicles of a recording in the plane, a box turned by its motion."""
    moments: list[list[Seen]] = [[] for _ in range(int(recording.last_frame.max()) + 1)]
    for v in range(recording.vehicles):
        rows = slice(recording.start[v], recording.start[v + 1])
        length, width = float(recording.length[v]), float(recording.width[v])
        s, d = recording.s[rows] - length / 2, recording.d[rows] - width / 2
        x, y, way = bend(s, d)
        v_lat = recording.v_lat[rows]
        along, pull, yaw = moving(recording, rows, bend, s, d)
        velocity = np.stack(turned(along, v_lat, way), axis=1)
        force = np.stack(turned(pull - yaw * v_lat, recording.a_lat[rows] + yaw * along, way), axis=1)
        heading = way + np.arctan2(v_lat, along)
        for k in range(len(s)):
            first = int(recording.first_frame[v])
            vectors = (tuple(z[k].tolist()) for z in (velocity, force))
            kind = TYPES[str(recording.kind[v])]
            place = float(x[k]), float(y[k])
            numbers = int(recording.vehicle_id[v]), (length, width), place, float(heading[k])
            moments[first + k].append(Seen(*numbers, *vectors, kind=kind))
    return moments
