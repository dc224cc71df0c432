"""Vehicles of a recording as traces for the monitor: time-major arrays, lane predicates decided."""

from collections.abc import Iterable, Iterator, Mapping
from fractions import Fraction

import numpy as np

from roadproof.errors import InputError
from roadproof.evaluation.lane_atoms import LaneAtom
from roadproof.formats.pairs import row_of
from roadproof.formats.recording import ZONES, Bools, Integers, Recording
from roadproof.logic.formula import Formula
from roadproof.monitoring.batch import Array, Batch
from roadproof.signals import RECORDED, SIZES, SignalName


def gather(
    recording: Recording,
    vehicles: Mapping[str, Integers],
    low: Integers,
    high: Integers,
    signals: Iterable[SignalName],
    lanes: Mapping[str, Integers] | None = None,
    atoms: Mapping[Formula, LaneAtom] | None = None,
) -> Batch:
    """A batch with one trace for each entry of the arrays, from frame ``low`` to ``high``.

    ``vehicles`` gives vehicle indices by name. ``lanes`` gives, by name, the index of a lane (-1:
    none, which nobody occupies) for each trace; ``atoms`` are decided for the vehicles and lanes
    that are there. Raises ``InputError`` for signals that recordings do not have.
    """
    wanted = tuple(dict.fromkeys(signals))
    for signal in wanted:
        if signal not in RECORDED:
            raise InputError(f"no recording has the signal {signal}, which a formula needs")
    rows = {name: rows_of(recording, index, low, high) for name, index in vehicles.items()}
    return Batch(
        dt=Fraction(1, recording.rate),
        lengths=high - low + 1,
        signals={(x, name): getattr(recording, x)[at] for name, at in rows.items() for x in wanted},
        sizes={(x, name): getattr(recording, x)[index] for name, index in vehicles.items() for x in SIZES},
        given=dict(_decide(recording, rows, lanes or {}, atoms or {})),
    )


def blocks(low: Integers, high: Integers, cells: int) -> Iterator[Integers]:
    """Indices of traces in blocks of similar lengths, each of about so many samples."""
    counts = high - low + 1
    order = np.argsort(counts, kind="stable")[::-1]
    begin = 0
    while begin < len(order):
        size = max(64, cells // int(counts[order[begin]]))
        yield order[begin : begin + size]
        begin += size


def rows_of(recording: Recording, vehicle: Integers, low: Integers, high: Integers) -> Integers:
    """Sample rows, shape (time, traces); after its end a trace repeats its last sample."""
    counts = high - low
    first = row_of(recording, vehicle, low)
    rows: Integers = first + np.minimum(np.arange(int(counts.max()) + 1)[:, None], counts)
    return rows


def _decide(
    recording: Recording,
    rows: Mapping[str, Integers],
    lanes: Mapping[str, Integers],
    atoms: Mapping[Formula, LaneAtom],
) -> Iterator[tuple[Formula, Bools]]:
    occupied = {name: recording.occupancy[at] for name, at in rows.items()}
    masks: dict[tuple[str, str], Array] = {}
    own = np.array([1 << k for k in range(len(recording.lanes))] + [0], np.uint32)
    beside = np.array([recording.beside_mask(k) for k in range(len(recording.lanes))] + [0], np.uint32)
    for name, index in lanes.items():
        masks["at", name], masks["beside", name] = own[index], beside[index]
    for formula, atom in atoms.items():
        if atom.vehicle not in rows:
            continue
        if atom.kind == "zone":
            zone = np.uint32(1 << ZONES.index(atom.of))
            yield formula, (recording.zones[rows[atom.vehicle]] & zone) != 0
        elif (atom.kind, atom.of) in masks:
            yield formula, (occupied[atom.vehicle] & masks[atom.kind, atom.of]) != 0
