"""Drives made simpler: what is said of them stays true, and what is not needed goes."""

from dataclasses import replace
from fractions import Fraction as F

from roadproof.analysis.coverage.minimal import simplest
from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.judged import judge_file
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.world.drive import Drive, Motion, Piece
from roadproof.world.models import load_road

LIBRARY = bundled_library()
FORMULA = "initSafe(SV,POV) and F danger(SV,POV) and a_lon(SV) > 0 m/s^2"


def simple(file: DriveFile) -> DriveFile:
    query = read_claim(LIBRARY.select(file.set_name), file.formula)
    return simplest(file, query, LIBRARY)


def laboured() -> DriveFile:
    """SV comes up behind POV, with more accelerations than that needs."""
    pieces = [Piece(F(1), F(a), F(0)) for a in ("0.31", "-0.2", "0.1", "0.4")]
    mine = Motion(
        F("4.5"), F("1.8"), F("0.3"), F("2.65"), F("29.9"), F(0), (*pieces, Piece(None, F(0), F(0)))
    )
    drift = (Piece(F(1), F(0), F("0.1")), Piece(F(1), F(0), F("-0.1")), Piece(None, F(0), F(0)))
    theirs = Motion(F("4.5"), F("1.8"), F("85.2"), F("2.65"), F("25.1"), F(0), drift)
    drive = Drive({"SV": mine, "POV": theirs})
    return DriveFile(None, "base", FORMULA, F(8), {}, {}, {}, load_road("main-2"), drive)


def test_what_is_not_needed_goes() -> None:
    found = simple(laboured())
    assert judge_file(found, LIBRARY).accepted
    theirs, mine = found.drive.vehicles["POV"], found.drive.vehicles["SV"]
    assert theirs.pieces == (Piece(None, F(0), F(0)),)
    assert (mine.s, mine.v_lon, theirs.v_lon) == (0, 30, 25)
    assert len(mine.pieces) == 2


def test_what_the_formula_needs_stays() -> None:
    assert simple(laboured()).drive.vehicles["SV"].pieces[0].a_lon > 0


def test_a_drive_stays_on_the_road_and_within_limits() -> None:
    leaving = replace(laboured(), formula="F d(SV) > 5 m")
    assert simple(leaving).drive.vehicles["SV"] is not None
    fast = laboured().drive.vehicles["SV"]
    beyond = replace(laboured(), drive=Drive({"SV": replace(fast, v_lon=F(60)), "POV": fast}))
    assert simple(replace(beyond, formula="F s(SV) > 0 m")).drive.vehicles["SV"].v_lon == 60
