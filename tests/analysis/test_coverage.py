"""Coverage: the proposed set is proved to have no gap, and each of its definitions is needed for that."""

from dataclasses import replace
from fractions import Fraction as F
from pathlib import Path

import pytest

from asking import prove
from roadproof.analysis.basis import Basis
from roadproof.analysis.coverage import needed
from roadproof.analysis.coverage.claims import (
    PROOF,
    claims_of,
    missed,
    replaced_in,
    sectors_of,
    sets_between,
    two_vehicle_numbers,
)
from roadproof.analysis.coverage.classes import GapClasses
from roadproof.analysis.coverage.found import Trials
from roadproof.analysis.coverage.needed import find_need, replaced_by
from roadproof.analysis.coverage.simple import HORIZON, simple_drives
from roadproof.evidence.certificate import to_json
from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.judged import judge_file
from roadproof.frontends.cli.main import main
from roadproof.library.loading import build_library, bundled_library
from roadproof.library.specification import Source
from roadproof.logic.show import text
from roadproof.runtime.budget import Effort
from roadproof.semantics.exact.replay import first_breach
from roadproof.verdict import Verdict
from roadproof.world.drive import Drive, Motion, Piece
from roadproof.world.models import load_road, load_vehicle
from roadproof.world.road import Road

LIBRARY = bundled_library()
COMPLETE = LIBRARY.select("complete")
REPLACED = ("aheadOf", "cutIn", "cutOut", "decel", "initialCondition_8")
STEADY = Piece(None, F(0), F(0))


def of_set(name: str) -> Basis:
    return Basis(LIBRARY.select(name))


def without(name: str) -> Verdict:
    """The verdict on coverage of the main road by ``complete`` with one definition as it is in ext."""
    kept = [n for n in replaced_in(LIBRARY.select("ext"), COMPLETE) if n != name]
    body = "\n".join(text(COMPLETE.definitions[n]) for n in kept)
    library = build_library([Source("trial", f"set trial extends ext {{\n{body}\n}}")], LIBRARY)
    specification = library.select("trial")
    return prove(specification, claims_of(specification)[0].text, Effort(1.5)).verdict


def caught_without(name: str, drive: Drive, road: Road) -> bool:
    """Whether ``complete`` catches the drive with one definition as it is in ext."""
    file = DriveFile(None, "ext", "", F(14), {}, {}, {}, road, drive)
    return not Trials(of_set("ext"), ("complete",)).misses(
        file, "complete", tuple(n for n in REPLACED if n != name)
    )


def car(s: str, d: str, speed: int, *pieces: Piece) -> Motion:
    return Motion(F("4.5"), F("1.8"), F(s), F(d), F(speed), F(0), (*pieces, STEADY))


def file_of(drive: Drive, set_name: str = "ext", road: str = "main-2") -> DriveFile:
    specification = LIBRARY.select(set_name)
    formula = missed(specification, two_vehicle_numbers(specification)).text
    return DriveFile(None, set_name, formula, F(14), {}, {}, {}, load_road(road), drive)


def test_what_the_proposed_set_replaces() -> None:
    assert sorted(replaced_in(LIBRARY.select("ext"), COMPLETE)) == list(REPLACED)
    assert two_vehicle_numbers(COMPLETE) == tuple(n for n in range(1, 25) if n % 8 != 2)
    assert sectors_of(COMPLETE)[1] == (9, 11, 12, 13, 14, 15, 16)


def test_the_sets_on_the_way() -> None:
    assert sets_between(LIBRARY, "base", "complete") == ("extA", "ext", "complete")
    assert sets_between(LIBRARY, "ext", "base") == sets_between(LIBRARY, "ext", "ext") == ()


@pytest.mark.parametrize("name", ["cutIn", "decel", "initialCondition_8"])
def test_the_proof_fails_without_a_definition(name: str) -> None:
    assert without(name) is not Verdict.PROVED


def test_coverage_of_the_main_road_is_proved(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    main_road, *_, sectors = claims_of(COMPLETE)
    for number, claim in enumerate((main_road, sectors)):
        covered = of_set("complete").settle(claim, claim, PROOF, "coverage")
        assert covered.verdict is Verdict.PROVED
        assert covered.certificate is not None
        (tmp_path / f"{number}.json").write_text(to_json(covered.certificate), "utf-8")
    assert main(["check", str(tmp_path), "--jobs", "1"]) == 0
    assert "2 of 2 accepted" in capsys.readouterr().out


def beside() -> Drive:
    """POV comes up in the lane beside SV's and drifts towards the marking, without crossing it."""
    drift = (Piece(F(4), F(0), F(0)), Piece(F(1), F(0), F(-1)), Piece(F(1), F(0), F(1)))
    return Drive({"SV": car("0", "2.65", 25), "POV": car("-40", "6.4", 32, *drift)})


def away_and_back() -> Drive:
    """SV and POV leave their lane together and come back, and only then SV comes too near."""
    swing = (Piece(F("1.5"), F(0), F(1)), Piece(F(3), F(0), F(-1)), Piece(F("1.5"), F(0), F(1)))
    faster = Piece(F(5), F(1), F(0))
    return Drive({"SV": car("0", "3.3", 25, *swing, faster), "POV": car("70", "3.3", 25, *swing)})


def side_by_side() -> Drive:
    """Fronts level in one lane, SV with two wheels beside the road; then SV drifts towards POV."""
    drift = (Piece(F(1), F(0), F(0)), Piece(F(1), F(0), F("0.5")), Piece(F(1), F(0), F("-0.5")))
    return Drive({"SV": car("0", "0.5", 25, *drift), "POV": car("0", "3.45", 24)})


def test_danger_from_beside_the_lane_is_a_gap_that_cut_in_catches() -> None:
    file = file_of(beside())
    assert judge_file(file, LIBRARY).accepted
    assert Trials(of_set("ext"), ("complete",)).smallest(file) == (("cutIn",),)
    covered = "(some M in lanes: scenario_1@complete(SV,POV,M))"
    assert judge_file(replace(file, formula=covered), LIBRARY).accepted
    assert not judge_file(replace(file, formula=covered.replace("complete", "ext")), LIBRARY).accepted


def test_why_scenarios_miss_danger_from_beside_the_lane() -> None:
    found = GapClasses(of_set("ext")).of(file_of(beside()))
    assert "behaviourPOV_1: F[0, minDanger] sameLane(SV, POV, L) in cutIn" in found
    assert "behaviourPOV_1: not sameLane(POV, SV, L) in cutIn" not in found


@pytest.mark.parametrize(("name", "drive"), [("cutOut", away_and_back()), ("aheadOf", side_by_side())])
def test_drives_that_are_missed_without_a_definition(name: str, drive: Drive) -> None:
    limits = dict.fromkeys(drive.vehicles, load_vehicle("car"))
    assert first_breach(drive, limits, None) is None
    assert not judge_file(file_of(drive, "complete"), LIBRARY).accepted
    assert judge_file(file_of(drive, "ext"), LIBRARY).accepted
    assert [n for n in REPLACED if not caught_without(n, drive, load_road("main-2"))] == [name]


def test_a_definition_is_shown_needed() -> None:
    assert sorted(replaced_by(COMPLETE)) == list(REPLACED)
    need = find_need(of_set("complete"), "cutIn")
    assert need.verdict is Verdict.WITNESSED
    assert need.drive is not None
    assert judge_file(need.drive.file, LIBRARY).accepted
    assert not judge_file(file_of(need.drive.file.drive, "complete"), LIBRARY).accepted


def test_what_the_clock_cuts_off_is_in_doubt(monkeypatch: pytest.MonkeyPatch) -> None:
    basis = replace(of_set("complete"), effort=Effort(1.0, timeout=0.0001))
    covered = basis.settle(claims_of(COMPLETE)[0], claims_of(COMPLETE)[0], PROOF, "coverage")
    assert covered.verdict is Verdict.UNKNOWN
    assert "cut off by the clock" in covered.reason
    monkeypatch.setattr(needed, "simple_drives", lambda *_: ())
    assert find_need(basis, "cutIn").verdict is Verdict.UNKNOWN


def test_a_set_that_extends_nothing_needs_nothing() -> None:
    assert replaced_by(LIBRARY.select()) == ()


def test_a_trial_set_with_nothing_of_a_wider_set_is_not_that_set() -> None:
    """One object judges under both, and what it remembers of one is not taken for the other."""
    trials = Trials(of_set("ext"), ("complete",))
    road, car = load_road("main-2"), load_vehicle("car")
    options = trials.specification.options
    files = (
        DriveFile(None, "ext", "", HORIZON, {}, trials.values, options, road, drive)
        for drive in simple_drives(road, car)
    )
    file = next(x for x in files if trials.misses(x, "complete", ()))
    assert not trials.misses(file, "complete", None)
    assert trials.misses(file, "complete", ())
