"""Coverage: the proposed set is proved to have no gap, and each of its definitions is needed for that."""

import json
from fractions import Fraction as F
from pathlib import Path

import pytest

from roadproof.analysis.coverage import _Finding, claims_of, missed, replaced_in, two_vehicle_numbers
from roadproof.analysis.overlap import Asked
from roadproof.analysis.placing import Shown, judge_drive
from roadproof.cli.main import main
from roadproof.evidence.witness import DriveFile, as_json, judge_file
from roadproof.logic.show import text
from roadproof.prove.prover import prove
from roadproof.spec.library import Source, build_library, bundled_library
from roadproof.verdict import Verdict
from roadproof.world.drive import Drive, Motion, Piece
from roadproof.world.models import load_road

LIBRARY = bundled_library()
COMPLETE = LIBRARY.select("complete")


def without(name: str) -> Verdict:
    """The verdict on coverage of the main road by ``complete`` with one definition as it is in ext."""
    kept = [n for n in replaced_in(LIBRARY.select("ext"), COMPLETE) if n != name]
    body = "\n".join(text(COMPLETE.definitions[n]) for n in kept)
    library = build_library([Source("trial", f"set trial extends ext {{\n{body}\n}}")], LIBRARY)
    specification = library.select("trial")
    return prove(specification, claims_of(specification)[0], 10.0).verdict


def test_what_the_proposed_set_replaces() -> None:
    assert set(replaced_in(LIBRARY.select("ext"), COMPLETE)) == {
        "cutIn",
        "cutOut",
        "accel",
        "decel",
        "aheadOf",
        "initialCondition_8",
    }
    assert two_vehicle_numbers(COMPLETE) == tuple(n for n in range(1, 25) if n % 8 != 2)


@pytest.mark.parametrize("name", ["cutIn", "initialCondition_8", "aheadOf"])
def test_the_proof_fails_without_a_definition(name: str) -> None:
    assert without(name) is not Verdict.PROVED


def test_the_command_proves_the_proposed_set(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out"
    assert main(["coverage", "--set", "complete", "--out", str(out), "--json", "-"]) == 0
    data = json.loads(capsys.readouterr().out)
    assert data["verdict"] == "COVERED"
    assert [x["verdict"] for x in data["claims"]] == ["PROVED"] * 4
    assert main(["check", str(out), "--jobs", "1"]) == 0
    assert "4 of 4 accepted" in capsys.readouterr().out


def beside() -> DriveFile:
    """POV comes up in the lane beside SV's and drifts towards the marking, without crossing it."""
    steady = Piece(None, F(0), F(0))
    drift = (Piece(F(4), F(0), F(0)), Piece(F(1), F(0), F(-1)), Piece(F(1), F(0), F(1)), steady)
    mine = Motion(F("4.5"), F("1.8"), F(0), F("2.65"), F(25), F(0), (steady,))
    theirs = Motion(F("4.5"), F("1.8"), F(-40), F("6.4"), F(32), F(0), drift)
    formula = missed(two_vehicle_numbers(LIBRARY.select("ext")))
    drive = Drive({"SV": mine, "POV": theirs})
    return DriveFile(None, "ext", formula, F(6), {}, {}, {}, load_road("main-2"), drive)


def test_danger_from_beside_the_lane_is_a_gap_that_cut_in_catches() -> None:
    file = beside()
    assert judge_file(file, LIBRARY).accepted
    finding = _Finding(Asked(("ext",)), "complete", "main-2", replaced_in(LIBRARY.select("ext"), COMPLETE))
    assert finding._smallest(file) == (("cutIn",),)
    shown = Shown(file.formula, as_json(file, {}))
    covered = "(some M in lanes: scenario_1@complete(SV,POV,M))"
    assert judge_drive(shown, covered, LIBRARY)
    assert not judge_drive(shown, covered.replace("complete", "ext"), LIBRARY)
