"""Vehicles of a recording as traces for the monitor: time-major arrays, lane predicates decided."""

from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Literal

import numpy as np

from roadproof.errors import InputError
from roadproof.extensions.traffic.formats.pairs import row_of
from roadproof.extensions.traffic.formats.recording import ZONES, Bools, Integers, Recording
from roadproof.extensions.traffic.scenario_parts import beside_lane, in_lane, in_zone
from roadproof.library.scenarios import LANE, PAIR, TRIPLE
from roadproof.library.specification import Specification
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import without_names
from roadproof.logic.terms import CustomSignal
from roadproof.semantics.sampled.batch import Array, Batch
from roadproof.world.signals import RECORDED, SIGNALS, SIZES, SignalName, SizeName

OTHER_LANE = "L1"
"""What the lane of a pair's second vehicle is called."""


@dataclass(frozen=True)
class LaneAtom:
    """A state formula that the data layer decides: a vehicle in a lane, beside it, or in a zone."""

    kind: Literal["at", "beside", "zone"]
    vehicle: str
    of: str


def lane_atoms(spec: Specification) -> Iterator[tuple[Formula, LaneAtom]]:
    """The lane predicates of a specification, for the vehicles of pairs and triples and the lanes L, L1."""
    for vehicle in dict.fromkeys((*PAIR, *TRIPLE)):
        for lane in (LANE, OTHER_LANE):
            yield without_names(in_lane(spec, vehicle, lane).formula), LaneAtom("at", vehicle, lane)
            yield without_names(beside_lane(spec, vehicle, lane).formula), LaneAtom("beside", vehicle, lane)
        for zone in ZONES:
            yield without_names(in_zone(spec, vehicle, zone).formula), LaneAtom("zone", vehicle, zone)


KIND: SizeName = "kind"


def gather(
    recording: Recording,
    vehicles: Mapping[str, Integers],
    low: Integers,
    high: Integers,
    signals: Iterable[SignalName | CustomSignal],
    lanes: Mapping[str, Integers] | None = None,
    atoms: Mapping[Formula, LaneAtom] | None = None,
) -> Batch:
    """A batch with one trace for each entry of the arrays, from frame ``low`` to ``high``.

    ``vehicles`` gives vehicle indices by name. ``lanes`` gives, by name, the index of a lane (-1:
    none, which nobody occupies) for each trace; ``atoms`` are decided for the vehicles and lanes
    that are there. Raises ``InputError`` for signals that recordings do not have.
    """
    rows = {name: rows_of(recording, index, low, high) for name, index in vehicles.items()}
    return gather_rows(recording, vehicles, rows, high - low + 1, signals, lanes, atoms)


def gather_one(
    recording: Recording,
    vehicles: Mapping[str, int],
    frames: tuple[int, int],
    signals: Iterable[SignalName | CustomSignal],
    lanes: Mapping[str, int] | None = None,
    atoms: Mapping[Formula, LaneAtom] | None = None,
) -> Batch:
    """Return the batch of one trace, from the first of the ``frames`` to the last (see ``gather``)."""
    index, at = ({name: np.array([k]) for name, k in x.items()} for x in (vehicles, lanes or {}))
    low, high = (np.array([frame]) for frame in frames)
    return gather(recording, index, low, high, signals, at, atoms)


def gather_rows(
    recording: Recording,
    vehicles: Mapping[str, Integers],
    rows: Mapping[str, Integers],
    lengths: Integers,
    signals: Iterable[SignalName | CustomSignal],
    lanes: Mapping[str, Integers] | None = None,
    atoms: Mapping[Formula, LaneAtom] | None = None,
) -> Batch:
    """Return the batch of the samples at ``rows`` (time, traces) of each vehicle (see ``gather``)."""
    requested = tuple(dict.fromkeys(signals))
    own = [signal for signal in requested if isinstance(signal, CustomSignal)]
    recorded = [signal for signal in requested if not isinstance(signal, CustomSignal)]
    for signal in recorded:
        if signal not in RECORDED:
            raise InputError(f"no recording has the signal {signal}, which a formula needs")
    columns = {
        name: recording.custom_signals[name]
        for name in (x.name for x in own)
        if name in recording.custom_signals
    }
    custom_signals_in_order = dict(
        by_vehicle({x: {v: c.take(at) for v, at in rows.items()} for x, c in columns.items()})
    )
    for x in own:
        whose = rows if x.vehicle else ("",)
        refuse_missing([(x.name, v) for v in whose], custom_signals_in_order, f"recording {recording.name}")
    return Batch(
        dt=1 / Fraction(recording.rate),
        lengths=lengths,
        signals={
            **{(x, name): getattr(recording, x).take(at) for name, at in rows.items() for x in recorded},
            **custom_signals_in_order,
        },
        sizes={
            **{(x, v): getattr(recording, x).take(index) for v, index in vehicles.items() for x in SIZES},
            **{(KIND, v): recording.kind_code.take(index) for v, index in vehicles.items()},
        },
        given=dict(_decide(recording, rows, lanes or {}, atoms or {})),
        source=f"recording {recording.name}",
    )


def by_vehicle(columns: Mapping[str, Mapping[str, Array]]) -> Iterator[tuple[tuple[str, str], Array]]:
    """Columns of custom signals, by name and vehicle, as signals of a batch.

    One that is the same for all vehicles at every instant is a signal of no vehicle ('') too.
    """
    for name, values in columns.items():
        for vehicle, column in values.items():
            yield (name, vehicle), column
        first, *others = values.values()
        if all(np.array_equal(first, other, equal_nan=True) for other in others):
            yield (name, ""), first


def refuse_missing(
    required: Iterable[tuple[str, str]], present: Collection[tuple[str, str]], source: str
) -> None:
    """Raise ``InputError`` for a custom signal of which there is no column, or not one for all vehicles."""
    for name, vehicle in required:
        if (name, vehicle) in present:
            continue
        if any(name == known for known, _ in present):
            raise InputError(
                f"{source}: column {name} is not the same for all vehicles at every instant, but signal "
                f"{name} is of no vehicle; declare it of one: signal {name}(a: vehicle): …"
            )
        known = ", ".join(dict.fromkeys(x for x, _ in present if x not in SIGNALS))
        raise InputError(
            f"{source}: there is no column {name}, which signal {name} is read from; "
            f"{f'of custom signals there are {known}' if known else 'there is none of any custom signal'}. "
            "CSV, Parquet and frames may have such columns; or say what it is: signal … derived by …"
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
    bits = np.min_scalar_type((1 << len(recording.lanes)) - 1)
    occupied = {name: recording.occupancy.take(at).astype(bits) for name, at in rows.items()}
    zones: dict[str, Array] = {}
    masks: dict[tuple[str, str], Array] = {}
    own = np.array([1 << k for k in range(len(recording.lanes))] + [0], bits)
    beside = np.array([recording.beside_mask(k) for k in range(len(recording.lanes))] + [0], bits)
    for name, index in lanes.items():
        masks["at", name], masks["beside", name] = own[index], beside[index]
    for formula, atom in atoms.items():
        if atom.vehicle not in rows:
            continue
        if atom.kind == "zone":
            zone = np.uint32(1 << ZONES.index(atom.of))
            if atom.vehicle not in zones:
                zones[atom.vehicle] = recording.zones.take(rows[atom.vehicle])
            yield formula, (zones[atom.vehicle] & zone) != 0
        elif (atom.kind, atom.of) in masks:
            yield formula, (occupied[atom.vehicle] & masks[atom.kind, atom.of]) != 0
