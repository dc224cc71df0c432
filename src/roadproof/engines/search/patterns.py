"""Builds many short drives: each vehicle has three pieces of equal length and a last one.

A pattern is a row of shares in [0, 1), each of which chooses from a list. The same row makes samples for
the monitor, in floating point, and a drive for the judge, in rational numbers.
"""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from roadproof.logic.custom_names import code_of
from roadproof.runtime.records import dataclass
from roadproof.semantics.sampled.batch import Batch
from roadproof.world.drive import Drive, Motion, Piece
from roadproof.world.signals import STARTING
from roadproof.world.vehicle import Range, Vehicle

Shares: TypeAlias = NDArray[Any]
PIECES = 3  # before the last piece
# Lateral accelerations of the pieces, as multiples of width / duration squared: none, or one lane over.
SWERVES = ((0, 0, 0), (0, 0, 0), (0, 0, 0), (1, -1, 0), (-1, 1, 0), (0, 1, -1), (0, -1, 1))
COLUMNS = 8  # of one vehicle; before them is one for the duration


@dataclass(frozen=True)
class Menu:
    """The building blocks for the motion of one vehicle, in SI units.

    ``speed`` and ``acceleration`` are the ranges that the motion keeps along the road; ``drifts``: speeds
    across the road at the start.
    """

    model: Vehicle
    speed: Range
    acceleration: Range
    speeds: tuple[Fraction, ...]
    accelerations: tuple[Fraction, ...]
    last: tuple[Fraction, ...]
    places: tuple[Fraction, ...]
    sides: tuple[Fraction, ...]
    swerve: Fraction
    drifts: tuple[Fraction, ...] = (Fraction(0),)


@dataclass(frozen=True)
class Patterns:
    """``menus`` by vehicle; ``durations`` are those of a piece, in s."""

    menus: Mapping[str, Menu]
    durations: tuple[Fraction, ...]

    @property
    def columns(self) -> int:
        """The number of shares that make a drive; those of drifts come last, where vehicles drift."""
        drifting = any(len(menu.drifts) > 1 for menu in self.menus.values())
        return 1 + (COLUMNS + drifting) * len(self.menus)

    def _drift(self, place: int) -> int:
        """The column of the drift of a vehicle, by its place; any where no vehicle drifts."""
        drift = 1 + COLUMNS * len(self.menus) + place
        return drift if drift < self.columns else 0

    def drive(self, row: Sequence[float]) -> Drive:
        """The drive of one row of shares."""
        duration = _chosen(self.durations, row[0])
        return Drive(
            {
                name: _motion(
                    menu, duration, row[1 + COLUMNS * k : 1 + COLUMNS * (k + 1)], row[self._drift(k)]
                )
                for k, (name, menu) in enumerate(self.menus.items())
            }
        )

    def batch(self, rows: Shares, dt: Fraction, steps: int) -> Batch:
        """Samples of all drives, ``dt`` seconds apart, ``steps`` beside the first."""
        durations = _floats(self.durations, rows[:, 0])
        times = np.arange(steps + 1)[:, None] * float(dt)
        signals: dict[tuple[str, str], Any] = {}
        sizes: dict[tuple[Any, str], Any] = {}
        ones = np.ones(len(rows))
        for k, (name, menu) in enumerate(self.menus.items()):
            own = rows[:, 1 + COLUMNS * k : 1 + COLUMNS * (k + 1)]
            for signal, values in _samples(menu, durations, own, rows[:, self._drift(k)], times).items():
                signals[signal, name] = values
            sizes["length", name] = float(menu.model.length) * ones
            sizes["width", name] = float(menu.model.width) * ones
            if menu.model.kind is not None:
                sizes["kind", name] = code_of(menu.model.kind) * ones
        return Batch(dt, np.full(len(rows), steps + 1, dtype=np.int64), signals, sizes)


def spread(first: int, count: int, columns: int) -> Shares:
    """Return evenly spread rows of shares: multiples of the roots of primes (H. Weyl, 1916)."""
    primes = [n for n in range(2, 400) if all(n % p for p in range(2, int(n**0.5) + 1))][:columns]
    roots = np.sqrt(np.array(primes, dtype=np.float64))
    return np.asarray(np.mod(np.arange(first + 1, first + count + 1)[:, None] * roots[None, :], 1.0))


def _chosen(values: Sequence[Fraction], share: float) -> Fraction:
    return values[min(int(share * len(values)), len(values) - 1)]


def _floats(values: Sequence[Fraction], shares: Shares) -> Shares:
    table = np.array([float(x) for x in values])
    return table[np.minimum((shares * len(values)).astype(np.int64), len(values) - 1)]


def _motion(menu: Menu, duration: Fraction, row: Sequence[float], share: float) -> Motion:
    speed = initial_speed = _chosen(menu.speeds, row[0])
    swerve = SWERVES[min(int(row[7] * len(SWERVES)), len(SWERVES) - 1)]
    pieces: list[Piece] = []
    for k in range(PIECES):
        target = speed + _chosen(menu.accelerations, row[3 + k]) * duration
        after = min(max(target, menu.speed[0]), menu.speed[1])
        pieces.append(Piece(duration, (after - speed) / duration, swerve[k] * menu.swerve / duration**2))
        speed = after
    pieces.append(Piece(None, _chosen(menu.last, row[6]), Fraction(0)))
    place, side = _chosen(menu.places, row[1]), _chosen(menu.sides, row[2])
    model, drift = menu.model, _chosen(menu.drifts, share)
    return Motion(
        model.length, model.width, place, side, initial_speed, drift, tuple(pieces), kind=model.kind
    )


def _samples(menu: Menu, durations: Shares, rows: Shares, shares: Shares, times: Shares) -> dict[str, Shares]:
    """Return the signals of the motions of all rows, sampled at ``times``, as ``_motion`` builds them."""
    speed = initial_speed = _floats(menu.speeds, rows[:, 0])
    along: list[Shares] = []
    for k in range(PIECES):
        target = speed + _floats(menu.accelerations, rows[:, 3 + k]) * durations
        after = np.clip(target, float(menu.speed[0]), float(menu.speed[1]))
        along.append((after - speed) / durations)
        speed = after
    along.append(_floats(menu.last, rows[:, 6]))
    table = np.array(SWERVES, dtype=np.float64)
    chosen = table[np.minimum((rows[:, 7] * len(SWERVES)).astype(np.int64), len(SWERVES) - 1)]
    across = [chosen[:, k] * float(menu.swerve) / durations**2 for k in range(PIECES)]
    across.append(np.zeros(len(rows)))
    s, v_lon, a_lon = _course(_floats(menu.places, rows[:, 1]), initial_speed, along, durations, times)
    d, v_lat, a_lat = _course(
        _floats(menu.sides, rows[:, 2]), _floats(menu.drifts, shares), across, durations, times
    )
    named = dict(zip(STARTING, (s, d, v_lon, v_lat), strict=True))
    return named | {"a_lon": a_lon, "a_lat": a_lat, "j_lon": np.zeros_like(s)}


def _course(
    place: Shares, speed: Shares, accelerations: Sequence[Shares], durations: Shares, times: Shares
) -> tuple[Shares, Shares, Shares]:
    """Return place, speed and acceleration at ``times``, shape (times, rows)."""
    s = place + 0.0 * times
    v, a = 0.0 * s, 0.0 * s
    number = np.minimum(np.floor(times / durations + 1e-9), len(accelerations) - 1)
    for k, acceleration in enumerate(accelerations):
        passed = np.maximum(times - k * durations, 0.0)
        if k + 1 < len(accelerations):
            passed = np.minimum(passed, durations)
        s = s + speed * passed + acceleration * passed**2 / 2
        a = np.where(number == k, acceleration, a)
        last = speed + acceleration * passed
        speed = last if k + 1 == len(accelerations) else speed + acceleration * durations
        v = np.where(number == k, last, v)
    return s, v, a
