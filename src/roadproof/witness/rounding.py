"""Solver values to a drive of rationals.

Speeds at the samples are rounded and positions follow from them, so errors do not add up along the
drive: at most grain·dt/2 a step.
"""

from collections.abc import Mapping, Sequence
from fractions import Fraction

from roadproof.encode.motion import Layout
from roadproof.world.drive import Drive, Motion, Piece
from roadproof.world.vehicle import Vehicle


def round_drive(
    layout: Layout,
    vehicles: Mapping[str, Vehicle],
    values: Sequence[float | Fraction],
    grain: Fraction | None = Fraction(1, 1000),
) -> Drive:
    """The drive with the given column values; speeds in multiples of ``grain`` m/s, None for exact."""

    def rounded(value: float | Fraction, step: Fraction | None) -> Fraction:
        return Fraction(value) if step is None else round(Fraction(value) / step) * step

    place = None if grain is None else grain * 10
    motions = {}
    for name in layout.vehicles:
        starts = {signal: rounded(values[layout.column(name, signal, 0)], place) for signal in ("s", "d")}
        speeds = {
            signal: [
                rounded(values[layout.column(name, signal, k)], grain) for k in range(layout.grid.steps + 1)
            ]
            for signal in ("v_lon", "v_lat")
        }
        motions[name] = Motion(
            vehicles[name].length,
            vehicles[name].width,
            starts["s"],
            starts["d"],
            speeds["v_lon"][0],
            speeds["v_lat"][0],
            _pieces(speeds["v_lon"], speeds["v_lat"], layout.grid.dt),
        )
    return Drive(motions)


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
