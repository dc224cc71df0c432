"""Drives of all 24 scenarios in the three sets, found by ``witness`` without wishes.

Made by ``roadproof witness --all --objective smooth --set base,extA,ext --no-pictures``, one a line.
"""

import json
from dataclasses import replace
from fractions import Fraction
from functools import cache
from pathlib import Path

from roadproof.evidence.drive_file import DriveFile, read_drive
from roadproof.extensions.exchange.export.subject import ExportSubject
from roadproof.world.drive import Drive, Motion, Piece
from roadproof.world.models import load_road
from roadproof.world.road import Road

DRIVES = Path(__file__).parent / "drives.jsonl"


@cache
def shipped_drives() -> dict[str, DriveFile]:
    """The 72 drives by the names of their files."""
    found = {}
    for number, line in enumerate(DRIVES.read_text("utf-8").splitlines(), 1):
        file = read_drive(json.loads(line), f"{DRIVES}, line {number}")
        found[f"scenario-{file.scenario:02d}-{file.set_name}"] = file
    return found


def subjects() -> list[ExportSubject]:
    """The 72 drives as they are exported together."""
    return [
        ExportSubject(name, number, file) for number, (name, file) in enumerate(shipped_drives().items(), 1)
    ]


def motion(
    *pieces: tuple[str | None, str, str] | tuple[str, str, str, str],
    start: tuple[str, str, str, str] = ("10", "2.6", "30", "0"),
    size: tuple[str, str] = ("4.5", "1.8"),
) -> Motion:
    """A vehicle from (s, d, v_lon, v_lat), with pieces (duration, a_lon, a_lat) or (…, a_lat, j_lon)."""
    made = tuple(Piece(None if t is None else Fraction(t), *map(Fraction, rates)) for t, *rates in pieces)
    return Motion(*map(Fraction, size), *map(Fraction, start), made)


def subject(road: Road | str = "main-2", horizon: str = "4", **motions: Motion) -> ExportSubject:
    """A drive made by hand, of nothing in particular."""
    home = load_road(road) if isinstance(road, str) else road
    file = replace(next(iter(shipped_drives().values())), formula="true", scenario=None, lanes={}, road=home)
    drive = Drive(motions or {"SV": motion((None, "0", "0"))})
    return ExportSubject("made", 1, replace(file, horizon=Fraction(horizon), drive=drive))


TURN = motion(("0.5", "0", "0"), ("1.6", "-1", "1.25"), ("1.6", "0.5", "-1.25"), (None, "0", "0"))
"""A change to the left lane at changing speed."""

SMOOTH = motion(("1", "0", "1.2", "-4"), ("1.5", "-4", "-0.8", "4"), ("1", "3", "0", "-3"), (None, "0", "0"))
"""A change to the left lane during braking that builds up and goes away again, and speeding up likewise."""
WEAVING = motion(
    ("1", "2", "0.3", "-12"), ("2", "-5", "-0.15", "6"), (None, "0", "0"), start=("0", "3", "9", "0.4")
)
"""A slow vehicle on its way across, whose speed along is least and greatest inside pieces."""
