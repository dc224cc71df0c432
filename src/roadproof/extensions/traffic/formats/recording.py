"""A recording of traffic as plain arrays, whatever file it came from.

Coordinates are those of semantics §2: s along the road in driving direction (front of the box), d across
it to the left (left side of the box), in metres, metres per second and metres per second squared.
Samples are grouped by vehicle and consecutive within one: vehicle v owns rows
``start[v]:start[v + 1]``, and its row of frame f is ``start[v] + f - first_frame[v]``.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
import numpy.typing as npt

from roadproof.world.signals import KINDS, RECORDED, Kind

if TYPE_CHECKING:
    from roadproof.world.road import Lanelet, Zone

Column: TypeAlias = npt.NDArray[Any]

ROWS = 1 << 15
"""So many rows of a few columns of doubles fit the cache of a core."""


def blocks_of(rows: int, overlap: int = 0) -> Iterator[slice]:
    """Slices that cover so many rows; each begins ``overlap`` rows before the end of the one before."""
    for begin in range(0, max(1, rows - overlap), ROWS):
        yield slice(begin, min(begin + ROWS + overlap, rows))


def blockwise(function: Callable[..., Column], *columns: Column) -> Column:
    """Return ``function`` of columns of equal length, computed in blocks; row k must depend on rows k alone.

    >>> blockwise(np.add, np.array([1, 2]), np.array([10, 20])).tolist()
    [11, 22]
    """
    rows = len(columns[0])
    first = function(*(x[:ROWS] for x in columns))
    if rows <= ROWS:
        return first
    made = np.empty((rows, *first.shape[1:]), first.dtype)
    made[:ROWS] = first
    for begin in range(ROWS, rows, ROWS):
        part = slice(begin, begin + ROWS)
        made[part] = function(*(x[part] for x in columns))
    return made


Floats: TypeAlias = npt.NDArray[np.float64]
Integers: TypeAlias = npt.NDArray[np.int64]
Masks: TypeAlias = npt.NDArray[np.uint32]
Bools: TypeAlias = npt.NDArray[np.bool_]

_TRUTHS = {"true": 1.0, "false": 0.0}
# What highD, exiD, CommonRoad and OpenSCENARIO call the kinds that have a name of their own.
_CLASSES: Mapping[str, Kind] = {
    "car": "car",
    "taxi": "car",
    "truck": "truck",
    "bus": "bus",
    "motorcycle": "motorcycle",
    "motorbike": "motorcycle",
}
ZONES: tuple[Zone, ...] = ("main", "merge", "depart")
OF_VEHICLES = ("vehicle_id", "direction", "kind", "length", "width", "first_frame")
OF_SAMPLES = (*RECORDED, "occupancy", "lane", "zones")
"""The fields of ``Recording`` that every recording has for each vehicle, and for each sample."""


@dataclass(frozen=True)
class Lane:
    """A lane of one driving direction; ``d`` is (right, left) where it is a straight band, else None."""

    name: str
    direction: int
    d: tuple[float, float] | None = None


@dataclass(frozen=True)
class Slack:
    """The largest errors of places along a measured road; an entry a sample.

    ``along``, ``across`` (m): ends and sides of the box as it stands in the plane, against s, d and its size;
    infinite where it heads more than 45 degrees away from the road. ``turn`` (rad): how much the road has
    turned up to there, to both sides together. ``off`` (m): the side of the box that is farthest from the
    line that s is measured on.
    """

    along: Floats
    across: Floats
    turn: Floats
    off: Floats


@dataclass(frozen=True)
class Recording:
    """Traffic on one road for some minutes.

    Per vehicle, in order of ``vehicle_id``: ``vehicle_id``, ``direction``, ``kind`` (a class such as
    Car or Truck), ``length``, ``width``, ``first_frame``, and ``start`` (one entry more than vehicles).
    Per sample: the RECORDED signals, ``occupancy`` (bit k: the box overlaps ``lanes[k]`` with positive
    area, semantics §4), ``lane`` (index of the lane that holds the centre of the box, -1 for none) and
    ``zones`` (bit k: the box occupies a lanelet of zone ZONES[k]).
    ``beside`` holds unordered pairs of names of adjacent lanes. ``notes`` says what is odd but usable.
    ``moments``: where other recordings may show the same, a number a sample that says so (repeats.py).
    ``lanelets``: where lanes are more than bands without end, what they consist of, and ``inside``, of shape
    (samples, lanelets), whether the box overlaps each with positive area. On a curved road their bounds only
    tell them apart. ``slack``: what projecting a measured road on a line does to places; None where s and d
    are measured themselves. ``custom_signals``: columns that are no signals of the list, an entry a sample:
    true and false as 1 and 0, NaN where there is no number. ``label``: what the file calls each vehicle,
    where ``kind`` puts several together. ``computed``: a storyboard gives places, speeds and accelerations as
    one motion, so that they are not compared with each other. ``faults``: motions that no vehicle drives.
    """

    name: str
    rate: int | Fraction
    lanes: tuple[Lane, ...]
    beside: frozenset[frozenset[str]]
    vehicle_id: Integers
    direction: Integers
    kind: npt.NDArray[np.str_]
    length: Floats
    width: Floats
    first_frame: Integers
    start: Integers
    s: Floats
    d: Floats
    v_lon: Floats
    v_lat: Floats
    a_lon: Floats
    a_lat: Floats
    occupancy: Masks
    lane: Integers
    zones: Masks
    notes: tuple[str, ...] = ()
    moments: Integers = field(default_factory=lambda: np.zeros(0, np.int64))
    lanelets: tuple[Lanelet, ...] = ()
    inside: Bools = field(default_factory=lambda: np.zeros((0, 0), np.bool_))
    slack: Slack | None = None
    custom_signals: Mapping[str, Floats] = field(default_factory=dict)
    label: npt.NDArray[np.str_] = field(default_factory=lambda: np.zeros(0, np.str_))
    computed: bool = False
    faults: tuple[str, ...] = ()

    @cached_property
    def kind_code(self) -> Integers:
        """The code of each vehicle's kind, as in terms (``signals.KINDS``)."""
        names, index = np.unique(self.label if len(self.label) else self.kind, return_inverse=True)
        codes: Integers = np.array([KINDS.index(kind_called(str(name))) + 1 for name in names], np.int64)
        return codes[index]

    @property
    def vehicles(self) -> int:
        """Return how many vehicles there are."""
        return len(self.vehicle_id)

    @property
    def last_frame(self) -> Integers:
        """The last frame of each vehicle."""
        return self.first_frame + np.diff(self.start) - 1

    @property
    def row_vehicle(self) -> Integers:
        """The index of the vehicle of each sample."""
        return np.repeat(np.arange(self.vehicles), np.diff(self.start))

    @property
    def row_frame(self) -> Integers:
        """The frame of each sample."""
        within: Integers = np.arange(self.start[-1]) - np.repeat(self.start[:-1], np.diff(self.start))
        return within + np.repeat(self.first_frame, np.diff(self.start))

    @property
    def zone_names(self) -> tuple[Zone, ...]:
        """The zones that some vehicle is in at some time, in the order of ZONES."""
        return zones_in([int(np.bitwise_or.reduce(self.zones, initial=0))])

    def beside_mask(self, lane: int) -> int:
        """The lanes adjacent to ``lanes[lane]``, as bits of ``occupancy``."""
        name = self.lanes[lane].name
        return sum(1 << k for k, x in enumerate(self.lanes) if frozenset((x.name, name)) in self.beside)


def zones_in(masks: Iterable[int]) -> tuple[Zone, ...]:
    """The zones that are in some of the ``masks``, in the order of ZONES."""
    met = [*masks]
    return tuple(zone for k, zone in enumerate(ZONES) if any(mask >> k & 1 for mask in met))


def kind_called(name: str) -> Kind:
    """The kind that recordings call by this name: Car, truck, motorbike; what they call otherwise is other.

    >>> kind_called("Truck"), kind_called("bicycle")
    ('truck', 'other')
    """
    return _CLASSES.get(name.lower(), "other")


def own_numbers(values: Iterable[object]) -> Floats:
    """A column as numbers: true and false as 1 and 0, NaN for what is no finite number."""
    return np.array([_own_number(value) for value in values], np.float64)


def _own_number(value: object) -> float:
    if isinstance(value, str):
        value = _TRUTHS.get(value.strip().lower(), value)
    try:
        number = float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        return math.nan
    return number if math.isfinite(number) else math.nan


def keep_vehicles(recording: Recording, selected: Bools) -> Recording:
    """The recording with only the vehicles for which ``selected`` (one entry a vehicle) is true."""
    return _part(recording, selected, np.repeat(selected, np.diff(recording.start)))


def one_vehicle(recording: Recording, vehicle: int) -> Recording:
    """The recording with only the vehicle of this index."""
    start, end = recording.start[vehicle : vehicle + 2].tolist()
    return _part(recording, slice(vehicle, vehicle + 1), slice(start, end))


def _part(recording: Recording, vehicles: Bools | slice, rows: Bools | slice) -> Recording:
    """The recording with some vehicles, whose samples are the ``rows``."""
    fields = ((vehicles, (*OF_VEHICLES, "label")), (rows, (*OF_SAMPLES, "moments", "inside")))
    changed: dict[str, Any] = {
        name: getattr(recording, name)[of]
        for of, names in fields
        for name in names
        if len(getattr(recording, name))
    }
    if recording.slack is not None:
        changed["slack"] = Slack(*(values[rows] for values in vars(recording.slack).values()))
    custom = {name: values[rows] for name, values in recording.custom_signals.items()}
    return replace(
        recording, **changed, custom_signals=custom, start=offsets(np.diff(recording.start)[vehicles])
    )


def join_vehicles(recording: Recording, guests: Recording) -> Recording:
    """The recording with the vehicles of ``guests``, whose ids must all be greater, added at the end.

    Both must have the same rate, lanes and lanelets.
    """
    ours, theirs = ((x.rate, x.lanes, x.lanelets) for x in (recording, guests))
    if ours != theirs:
        raise ValueError("recordings of different roads or rates cannot be joined")
    if recording.slack is not None or guests.slack is not None:
        raise ValueError("recordings of measured roads cannot be joined")
    if len(recording.moments) or len(guests.moments):
        raise ValueError("recordings whose moments others may show cannot be joined")
    if any(x.custom_signals or len(x.label) for x in (recording, guests)):
        raise ValueError("recordings with custom signals or labels cannot be joined")
    if recording.vehicles and guests.vehicle_id.min() <= recording.vehicle_id.max():
        raise ValueError("the ids of the guests must be greater than those of the recording")
    changed: dict[str, Any] = {
        name: np.concatenate((getattr(recording, name), getattr(guests, name)))
        for name in (*OF_VEHICLES, *OF_SAMPLES, "inside")
    }
    changed["start"] = np.concatenate((recording.start, recording.start[-1] + guests.start[1:]))
    return replace(recording, **changed)


def with_notes(recording: Recording, notes: Iterable[str]) -> Recording:
    """The recording with more notes."""
    return replace(recording, notes=(*recording.notes, *notes))


BACKWARDS = -0.5
"""m/s: a slower vehicle drives backwards; others stand, as far as measurements say."""


def backwards(ids: Integers) -> tuple[str, ...]:
    """A note on these vehicles of a recording, which drive backwards: RSS has no safe distance for them."""
    if not len(ids):
        return ()
    shown = ", ".join(map(str, ids[:6].tolist())) + (", …" if len(ids) > 6 else "")
    return (
        f"{len(ids)} vehicles ({shown}) drive backwards: the safe distance of RSS holds for speeds of 0 "
        "or more, so rssViolation and danger decide nothing there",
    )


def offsets(counts: npt.NDArray[Any]) -> Integers:
    """0 and the running sums of ``counts``.

    >>> offsets(np.array([2, 3])).tolist()
    [0, 2, 5]
    """
    return np.concatenate(([0], np.cumsum(counts))).astype(np.int64)


def beside_by_order(lanes: tuple[Lane, ...]) -> frozenset[frozenset[str]]:
    """``Recording.beside`` where the lanes of a direction follow each other across the road."""
    neighbours = pairwise(lanes)
    return frozenset(frozenset((a.name, b.name)) for a, b in neighbours if a.direction == b.direction)


def occupy_bands(
    lanes: tuple[Lane, ...], direction: Integers, d: Floats, width: Floats
) -> tuple[Masks, Integers]:
    """Occupancy bits and lane of the centre for boxes on straight bands (semantics §4).

    All arrays have one entry a sample; metres are compared to the micrometre, so that a box which
    touches a marking in the decimals of the file does so here. A centre on a marking is in the band
    to the left of it.
    """
    if any(band.d is None for band in lanes):
        name = next(band.name for band in lanes if band.d is None)
        raise ValueError(f"lane {name} is no straight band")
    occupancy, lane = np.empty(len(d), np.uint32), np.empty(len(d), np.int64)
    unsigned = np.uint8 if len(lanes) <= 8 else np.uint32
    for part in blocks_of(len(d)):
        left, right = d[part], np.round(d[part] - width[part], 6)
        centre = np.round(d[part] - width[part] / 2, 6)
        ours = {way: direction[part] == way for way in {band.direction for band in lanes}}
        occupied, lane_number = np.zeros(len(left), unsigned), np.zeros(len(left), np.uint8)
        for k, band in enumerate(lanes):
            assert band.d is not None
            low, high = band.d
            there = ours[band.direction] & (left > low) & (right < high)
            np.bitwise_or(occupied, there.view(np.uint8) * unsigned(1 << k), out=occupied)
            inside = ours[band.direction] & (low <= centre) & (centre < high)
            np.maximum(lane_number, inside.view(np.uint8) * np.uint8(k + 1), out=lane_number)
        occupancy[part], lane[part] = occupied, lane_number
    lane -= 1
    return occupancy, lane
