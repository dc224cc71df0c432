"""Solver values to a drive of rationals.

Speeds at the samples are rounded and positions follow from them, so errors do not add up along the
drive: at most grain·dt/2 a step.
"""

from collections.abc import Mapping, Sequence
from fractions import Fraction

from roadproof.engines.encode.motion import Layout
from roadproof.engines.search.initial_conditions import Start
from roadproof.logic.custom_names import HALF
from roadproof.logic.terms import Signal
from roadproof.world.drive import Course, Drive, Motion, Piece
from roadproof.world.signals import SignalName
from roadproof.world.vehicle import Vehicle


def round_drive(
    layout: Layout,
    vehicles: Mapping[str, Vehicle],
    values: Sequence[float | Fraction],
    grain: Fraction | None = Fraction(1, 1000),
    begun: Start | None = None,
) -> Drive:
    """The drive with the given column values; speeds in multiples of ``grain`` m/s, None for exact.

    What a start says to be one value is that one, whatever the grain.
    """
    said = {} if begun is None else begun.exact

    def rounded(value: float | Fraction, step: Fraction | None) -> Fraction:
        return Fraction(value) if step is None else round(Fraction(value) / step) * step

    def start(name: str, signal: SignalName) -> Fraction:
        condition = said.get(Signal(signal, name))
        if condition is not None:
            other = condition.beside
            return condition.low + (0 if other is None else start(other.vehicle, other.name))
        return rounded(values[layout.column(name, signal, 0)], None if grain is None else grain * 10)

    def speeds(name: str, signal: SignalName, change: SignalName) -> list[Fraction]:
        columns = [layout.column(name, signal, k) for k in range(layout.grid.steps + 1)]
        found = [rounded(values[column], grain) for column in columns]
        if Signal(signal, name) in said:
            found[0] = said[Signal(signal, name)].low
        if Signal(change, name) in said:
            found[1] = found[0] + said[Signal(change, name)].low * layout.grid.dt
        return found

    motions = {}
    for name in layout.vehicles:
        along, across = speeds(name, "v_lon", "a_lon"), speeds(name, "v_lat", "a_lat")
        motions[name] = Motion(
            vehicles[name].length,
            vehicles[name].width,
            start(name, "s"),
            start(name, "d"),
            along[0],
            across[0],
            _pieces(along, across, layout.grid.dt),
            vehicles[name].kind,
        )
    return Drive(motions, _courses(layout, values, grain))


def _courses(
    layout: Layout, values: Sequence[float | Fraction], grain: Fraction | None
) -> dict[tuple[str, str], Course]:
    """Own signals, each constant from a sample to the next; equal neighbours are one piece."""
    made: dict[tuple[str, str], Course] = {}
    for own in layout.own:
        name, vehicle = own.signal.name, own.signal.vehicle
        course: list[tuple[Fraction, Fraction]] = []
        for step in range(layout.grid.steps + 1):
            value = Fraction(values[layout.own_column(vehicle, name, step)])
            if own.signal.truth:
                value = Fraction(value > HALF)
            elif grain is not None:
                value = min(max(round(value / grain) * grain, own.range[0]), own.range[1])
            if not course or course[-1][1] != value:
                course.append((step * layout.grid.dt, value))
        made[name, vehicle] = tuple(course)
    return made


def _pieces(along: Sequence[Fraction], across: Sequence[Fraction], dt: Fraction) -> tuple[Piece, ...]:
    """Constant accelerations between samples; equal neighbours are one piece."""
    pieces: list[Piece] = []
    for k in range(len(along) - 1):
        a_lon, a_lat = (along[k + 1] - along[k]) / dt, (across[k + 1] - across[k]) / dt
        before = pieces[-1] if pieces else None
        if (
            before is not None
            and before.duration is not None
            and (before.a_lon, before.a_lat) == (a_lon, a_lat)
        ):
            pieces[-1] = Piece(before.duration + dt, a_lon, a_lat)
        else:
            pieces.append(Piece(dt, a_lon, a_lat))
    return (*pieces, Piece(None, Fraction(0), Fraction(0)))
