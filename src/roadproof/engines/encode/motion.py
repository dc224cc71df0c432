"""Vehicles as pairs of double integrators without jerk, exact at the samples (semantics §2).

The unknowns of a vehicle are position and speed along and across the road at each sample; the
acceleration between two samples is constant, so it is the difference of speeds over dt, and
positions follow the trapezoid rule exactly. After the last sample there is no acceleration.
"""

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from itertools import chain
from typing import assert_never

from roadproof.engines.encode.problem import LimitKind, Origin, RealColumn, Row, Unknown, row_of
from roadproof.engines.encode.unroll import Grid
from roadproof.logic import terms as t
from roadproof.logic.custom_names import custom_signals_of
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import leaves_of
from roadproof.runtime.records import dataclass
from roadproof.world.polynomial import Polynomial, affine, constant, variable
from roadproof.world.signals import STARTING, CustomSignalName, SignalName
from roadproof.world.vehicle import Range, Vehicle

WIDEST = Fraction(1000)
"""Where a signal has no bound, values are looked for up to this, or twice the largest number beside it."""


@dataclass(frozen=True)
class CustomSignalRange:
    """A custom signal and the range (SI) in which a search chooses its values."""

    signal: t.CustomSignal
    range: Range


def custom_signal_ranges(formula: Formula) -> tuple[CustomSignalRange, ...]:
    """Return the custom signals of a bound formula with their search ranges, ordered by name and vehicle."""
    numbers = [abs(x.value) for x in leaves_of(formula) if isinstance(x, t.Number)]
    widest = max(WIDEST, 2 * max(numbers, default=Fraction(0)))
    return tuple(
        CustomSignalRange(signal, search_range(signal, widest)) for signal in custom_signals_of([formula])
    )


def search_range(signal: t.CustomSignal, widest: Fraction) -> Range:
    """Return the bounds of a custom signal; a missing one is ``widest`` beyond 0 and the other bound."""
    if signal.truth:
        return Fraction(0), Fraction(1)
    low, high = signal.low, signal.high
    return (
        min(-widest, Fraction(0) if high is None else high - widest) if low is None else low,
        max(widest, Fraction(0) if low is None else low + widest) if high is None else high,
    )


def custom_signal_index(custom_signals: Sequence[CustomSignalRange], name: str, vehicle: str) -> int:
    """Return the index of the custom signal with that name and vehicle."""
    return next(
        k for k, x in enumerate(custom_signals) if (x.signal.name, x.signal.vehicle) == (name, vehicle)
    )


# A position and the speed that it grows by.
_ALONG: tuple[SignalName, SignalName] = ("s", "v_lon")
_ACROSS: tuple[SignalName, SignalName] = ("d", "v_lat")


@dataclass(frozen=True)
class ColumnLayout:
    """The numbering of columns: one column for each starting signal of each vehicle at each sample."""

    vehicles: tuple[str, ...]
    grid: Grid
    custom_signals: tuple[CustomSignalRange, ...] = ()

    def column(self, vehicle: str, signal: SignalName, step: int) -> int:
        """Return the column of a signal at a sample. Raises ``ValueError`` for derived signals."""
        if signal not in STARTING:
            raise ValueError(f"signal={signal} has no columns: those that have are {', '.join(STARTING)}")
        samples = self.grid.steps + 1
        row = self.vehicles.index(vehicle) * len(STARTING) + STARTING.index(signal)
        return row * samples + step

    def unknowns(self, vehicle: str) -> Iterator[Unknown]:
        """Yield the unknowns of a vehicle in the order of their columns."""
        for signal in STARTING:
            for step in range(self.grid.steps + 1):
                yield Unknown(vehicle, signal, step)

    def custom_signal_column(self, vehicle: str, name: str, step: int) -> int:
        """Return the column of a custom signal; these come after the columns of all vehicles."""
        rows = len(self.vehicles) * len(STARTING) + custom_signal_index(self.custom_signals, name, vehicle)
        return rows * (self.grid.steps + 1) + step

    def custom_signal_unknowns(self) -> Iterator[RealColumn]:
        """Yield the columns of custom signals in their order."""
        for x in self.custom_signals:
            for step in range(self.grid.steps + 1):
                yield RealColumn(Unknown(x.signal.vehicle, CustomSignalName(x.signal.name), step), *x.range)

    def state(self, vehicle: str, signal: SignalName | CustomSignalName, step: int) -> Polynomial[int]:
        """Return a signal at a sample; accelerations are those of the step that begins there."""
        if isinstance(signal, CustomSignalName):
            return variable(self.custom_signal_column(vehicle, signal, step))
        match signal:
            case "s" | "d" | "v_lon" | "v_lat":
                return variable(self.column(vehicle, signal, step))
            case "a_lon":
                return self._change("v_lon", vehicle, step)
            case "a_lat":
                return self._change("v_lat", vehicle, step)
            case "j_lon":
                return constant(Fraction(0))
            case _:
                assert_never(signal)

    def _change(self, speed: SignalName, vehicle: str, step: int) -> Polynomial[int]:
        """The acceleration from a sample to the next; after the last there is none."""
        if step == self.grid.steps:
            return constant(Fraction(0))
        before, after = self.column(vehicle, speed, step), self.column(vehicle, speed, step + 1)
        return affine([(after, 1 / self.grid.dt), (before, -1 / self.grid.dt)])


def encode_motions(
    vehicles: Mapping[str, Vehicle],
    layout: ColumnLayout,
    starts: Mapping[str, Range],
    across: Mapping[str, Range],
    natural: bool,
    inside: Fraction,
    straight: Collection[str],
) -> tuple[tuple[RealColumn, ...], tuple[Row, ...]]:
    """Columns and rows for ``vehicles``; the columns of custom signals come last.

    ``starts``: where the front of each vehicle may be at time 0; ``across``: where its left side may
    be at all (m). ``natural`` asks in addition that no vehicle moves across the road at the first
    and last sample and that accelerations change by no more than the vehicle's jumps, from and to
    none at the end; the first speed is then the vehicle's cruising speed. ``inside`` is how far
    accelerations stay inside their limits, so that rounding cannot break them. Vehicles in
    ``straight`` never move across the road.
    """
    grid = layout.grid
    columns = tuple(
        RealColumn(of, *_bounds(of, vehicle, grid, starts[name], across[name], natural, name in straight))
        for name, vehicle in vehicles.items()
        for of in layout.unknowns(name)
    )
    rows = (_rows(name, vehicle, layout, natural, inside) for name, vehicle in vehicles.items())
    return (*columns, *layout.custom_signal_unknowns()), tuple(chain.from_iterable(rows))


def _bounds(
    of: Unknown, vehicle: Vehicle, grid: Grid, start: Range, across: Range, natural: bool, straight: bool
) -> Range:
    slow, fast = vehicle.v_lon
    match of.signal:
        case "s":
            time = of.step * grid.dt
            return start[0] + slow * time, start[1] + fast * time
        case "d":
            return across
        case "v_lon":
            return vehicle.cruise if natural and of.step == 0 else vehicle.v_lon
        case "v_lat" if straight:
            return Fraction(0), Fraction(0)
        case "v_lat" if natural:
            away = min(of.step, grid.steps - of.step) * grid.dt
            bound = away * max(vehicle.a_lat[1], -vehicle.a_lat[0])
            return max(vehicle.v_lat[0], -bound), min(vehicle.v_lat[1], bound)
        case "v_lat":
            return vehicle.v_lat
        case _:  # open: only signals that a drive starts with have columns
            raise ValueError(f"signal={of.signal}: the bounds of its columns are not known")


def _rows(
    name: str, vehicle: Vehicle, layout: ColumnLayout, natural: bool, inside: Fraction
) -> Iterable[Row]:
    grid = layout.grid
    half = grid.dt / 2
    limits_of: Mapping[SignalName, Range] = {"a_lon": vehicle.a_lon, "a_lat": vehicle.a_lat}

    def column(signal: SignalName, k: int) -> int:
        return layout.column(name, signal, k)

    def origin(limit: LimitKind, k: int) -> Origin:
        return Origin(limit, k, (name,))

    for k in range(grid.steps):
        for place, speed in (_ALONG, _ACROSS):
            moved = [(column(place, k + 1), Fraction(1)), (column(place, k), Fraction(-1))]
            driven = [(column(speed, k), -half), (column(speed, k + 1), -half)]
            yield row_of(affine(moved + driven), Fraction(0), Fraction(0), origin(LimitKind.MOTION, k))
        for acceleration, limits in limits_of.items():
            yield row_of(
                layout.state(name, acceleration, k),
                limits[0] + inside,
                limits[1] - inside,
                origin(LimitKind.ACCELERATION, k),
            )
    for k in range(grid.steps + 1):
        for sign in (1, -1):
            share = [(column("v_lon", k), vehicle.lateral_share), (column("v_lat", k), Fraction(sign))]
            yield row_of(affine(share), inside, None, origin(LimitKind.LATERAL_SHARE, k))
    if natural:
        yield from _jumps(name, vehicle, layout, inside)


def _jumps(name: str, vehicle: Vehicle, layout: ColumnLayout, inside: Fraction) -> Iterable[Row]:
    jumps: Mapping[SignalName, Fraction] = {"a_lon": vehicle.jump_lon, "a_lat": vehicle.jump_lat}
    for acceleration, jump in jumps.items():
        for k in range(layout.grid.steps):
            later = layout.state(name, acceleration, k + 1)
            change = later + layout.state(name, acceleration, k).scaled(Fraction(-1))
            yield row_of(change, inside - jump, jump - inside, Origin(LimitKind.JUMP, k, (name,)))
