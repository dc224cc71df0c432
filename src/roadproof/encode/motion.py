"""Vehicles as pairs of double integrators, exact at the samples (SPEC §2).

The unknowns of a vehicle are position and speed along and across the road at each sample; the
acceleration between two samples is constant, so it is the difference of speeds over dt, and
positions follow the trapezoid rule exactly. After the last sample there is no acceleration.
"""

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from fractions import Fraction

from roadproof.encode.polynomial import Polynomial, affine, constant, variable
from roadproof.encode.problem import Column, Row, row_of
from roadproof.encode.unroll import Grid
from roadproof.world.vehicle import Range, Vehicle

SIGNALS = ("s", "d", "v_lon", "v_lat")


@dataclass(frozen=True)
class Layout:
    """Which column holds which signal of which vehicle at which sample."""

    vehicles: tuple[str, ...]
    grid: Grid

    def column(self, vehicle: str, signal: str, step: int) -> int:
        per_vehicle = len(SIGNALS) * (self.grid.steps + 1)
        return (
            self.vehicles.index(vehicle) * per_vehicle + SIGNALS.index(signal) * (self.grid.steps + 1) + step
        )

    def state(self, vehicle: str, signal: str, step: int) -> Polynomial[int]:
        """A signal at a sample; an acceleration is that of the piece which begins there.

        Raises ``ValueError`` for a signal that a drive of samples does not have.
        """
        match signal:
            case "s" | "d" | "v_lon" | "v_lat":
                return variable(self.column(vehicle, signal, step))
            case "a_lon":
                return self._change("v_lon", vehicle, step)
            case "a_lat":
                return self._change("v_lat", vehicle, step)
            case _:
                raise ValueError(f"signal={signal}: a vehicle has {', '.join(SIGNALS)}, a_lon, a_lat")

    def _change(self, speed: str, vehicle: str, step: int) -> Polynomial[int]:
        """The acceleration from a sample to the next; after the last there is none."""
        if step == self.grid.steps:
            return constant(Fraction(0))
        before, after = self.column(vehicle, speed, step), self.column(vehicle, speed, step + 1)
        return affine([(after, 1 / self.grid.dt), (before, -1 / self.grid.dt)])


@dataclass(frozen=True)
class Motions:
    """Columns and rows of all vehicles on one grid."""

    layout: Layout
    columns: tuple[Column, ...]
    rows: tuple[Row, ...]


def encode_motions(
    vehicles: Mapping[str, Vehicle],
    grid: Grid,
    starts: Mapping[str, Range],
    across: Mapping[str, Range],
    natural: bool,
    inside: Fraction,
    straight: Collection[str] = (),
) -> Motions:
    """Columns and rows for ``vehicles``.

    ``starts``: where the front of each vehicle may be at time 0; ``across``: where its left side may
    be at all (m). ``natural`` asks in addition that no vehicle moves across the road at the first
    and last sample and that accelerations change by no more than the vehicle's jumps, from and to
    none at the end; the first speed is then the vehicle's cruising speed. ``inside`` is how far
    accelerations stay inside their limits, so that rounding cannot break them. Vehicles in
    ``straight`` never move across the road.
    """
    layout = Layout(tuple(vehicles), grid)
    columns = [
        column
        for name, vehicle in vehicles.items()
        for column in _columns(name, vehicle, grid, starts[name], across[name], natural, name in straight)
    ]
    rows = [
        row for name, vehicle in vehicles.items() for row in _rows(name, vehicle, layout, natural, inside)
    ]
    return Motions(layout, tuple(columns), tuple(rows))


def _columns(
    name: str, vehicle: Vehicle, grid: Grid, start: Range, across: Range, natural: bool, straight: bool
) -> Iterable[Column]:
    slow, fast = vehicle.v_lon
    for k in range(grid.steps + 1):
        time = k * grid.dt
        yield Column(f"{name}.s.{k}", start[0] + slow * time, start[1] + fast * time)
    for k in range(grid.steps + 1):
        yield Column(f"{name}.d.{k}", *across)
    for k in range(grid.steps + 1):
        yield Column(f"{name}.v_lon.{k}", *(vehicle.cruise if natural and k == 0 else (slow, fast)))
    for k in range(grid.steps + 1):
        low, high = vehicle.v_lat
        if natural:
            away = min(k, grid.steps - k) * grid.dt
            bound = away * max(vehicle.a_lat[1], -vehicle.a_lat[0])
            low, high = max(low, -bound), min(high, bound)
        if straight:
            low = high = Fraction(0)
        yield Column(f"{name}.v_lat.{k}", low, high)


def _rows(name: str, vehicle: Vehicle, layout: Layout, natural: bool, inside: Fraction) -> Iterable[Row]:
    grid = layout.grid
    half = grid.dt / 2

    def column(signal: str, k: int) -> int:
        return layout.column(name, signal, k)

    for k in range(grid.steps):
        for place, speed in (("s", "v_lon"), ("d", "v_lat")):
            moved = [(column(place, k + 1), Fraction(1)), (column(place, k), Fraction(-1))]
            driven = [(column(speed, k), -half), (column(speed, k + 1), -half)]
            yield row_of(affine(moved + driven), Fraction(0), Fraction(0))
        for acceleration, limits in (("a_lon", vehicle.a_lon), ("a_lat", vehicle.a_lat)):
            yield row_of(layout.state(name, acceleration, k), limits[0] + inside, limits[1] - inside)
    for k in range(grid.steps + 1):
        for sign in (1, -1):
            share = [(column("v_lon", k), vehicle.lateral_share), (column("v_lat", k), Fraction(sign))]
            yield row_of(affine(share), inside, None)
    if natural:
        yield from _jumps(name, vehicle, layout, inside)


def _jumps(name: str, vehicle: Vehicle, layout: Layout, inside: Fraction) -> Iterable[Row]:
    for acceleration, jump in (("a_lon", vehicle.jump_lon), ("a_lat", vehicle.jump_lat)):
        for k in range(layout.grid.steps):
            later = layout.state(name, acceleration, k + 1)
            change = later + layout.state(name, acceleration, k).scaled(Fraction(-1))
            yield row_of(change, inside - jump, jump - inside)
