"""Drives written by hand for planting, on lanes of 3.5 m whose right edge is d = 0."""

from dataclasses import replace
from fractions import Fraction as F

from roadproof.world.drive import Drive, Motion, Piece


def motion(s: F | int, d: F | int, v: F | int, *pieces: tuple[F | int | None, F | int, F | int]) -> Motion:
    """A car of 4.5 m by 1.8 m; pieces are (duration, a_lon, a_lat), the last without end."""
    made = tuple(Piece(None if t is None else F(t), F(a), F(b)) for t, a, b in (*pieces, (None, 0, 0)))
    return Motion(F(9, 2), F(9, 5), F(s), F(d), F(v), F(0), made)


def cut_in() -> Drive:
    """POV, slower, comes from the left lane into the lane of SV ahead of it: scenario 1 (and danger)."""
    return Drive(
        {
            "SV": motion(10, F(13, 5), 30),
            "POV": motion(90, F(61, 10), 25, (F(8, 5), 0, F(-5, 4)), (F(8, 5), 0, F(5, 4))),
        }
    )


def braking() -> Drive:
    """POV ahead in the lane of SV brakes until it is too near: scenario 4."""
    return Drive({"SV": motion(5, F(13, 5), 29), "POV": motion(80, F(13, 5), 28, (F(2), -4, 0))})


def building_up() -> Drive:
    """As braking, but POV's braking builds up and goes away again: scenario 4, with jerk."""
    smooth = ((F(1), F(0), F(0), F(-5)), (F(1), F(-5), F(0), F(0)), (F(1), F(-5), F(0), F(5)))
    pieces = (*(Piece(*each) for each in smooth), Piece(None, F(0), F(0)))
    drive = braking()
    return Drive({**drive.vehicles, "POV": replace(drive.vehicles["POV"], pieces=pieces)})


def cut_out() -> Drive:
    """POV1 leaves the lane between SV and the slow POV2: scenario 2."""
    return Drive(
        {
            "SV": motion(5, F(13, 5), 25),
            "POV1": motion(70, F(13, 5), 25, (F(8, 5), 0, F(5, 4)), (F(8, 5), 0, F(-5, 4))),
            "POV2": motion(105, F(13, 5), 18),
        }
    )


def late_cut_out() -> Drive:
    """As cut_out, but SV is too near to POV1 at first: the trace starts when the gap has opened."""
    return Drive(
        {
            "SV": motion(5, F(13, 5), 25),
            "POV1": motion(47, F(13, 5), 26, (F(3), 0, 0), (F(8, 5), 0, F(5, 4)), (F(8, 5), 0, F(-5, 4))),
            "POV2": motion(105, F(13, 5), 18),
        }
    )


def swerve() -> Drive:
    """SV comes too near to a slow POV in its lane, then moves out of it, hardly far enough: scenario 8."""
    return Drive(
        {
            "SV": motion(5, F(13, 5), 30, (F(3), 0, 0), (F(7, 5), 0, F(10, 7)), (F(7, 5), 0, F(-10, 7))),
            "POV": motion(105, F(13, 5), 22),
        }
    )
