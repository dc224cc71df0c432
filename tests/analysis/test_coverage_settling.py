"""Classes of gaps: drives are judged, proofs are checked, and no drive is in a class that is proved empty."""

from dataclasses import replace
from fractions import Fraction as F
from pathlib import Path

import pytest

from asking import prove
from roadproof.analysis.coverage.claims import missed, sectors_of, some_scenario
from roadproof.analysis.coverage.classes import Classes, Found, Group, Survey, groups_of, survey_of
from roadproof.analysis.coverage.settling import find_in_catalogue, settle_group
from roadproof.analysis.requests import Asked
from roadproof.cli.main import main
from roadproof.effort import Effort
from roadproof.errors import UsageError
from roadproof.evidence.drive_file import read_drive
from roadproof.evidence.judged import judge_file
from roadproof.judge.replay import first_breach
from roadproof.spec.library import bundled_library
from roadproof.verdict import Verdict
from roadproof.world.drive import Drive
from roadproof.world.models import load_vehicle

LIBRARY = bundled_library()
EXT = Asked(("ext",), effort=Effort(0.1))


@pytest.fixture(scope="module")
def known() -> list[Found]:
    """Gaps of ext from a part of the catalogue."""
    return find_in_catalogue(survey(), "main-2", 0, 61)


def survey() -> Survey:
    return survey_of(EXT, "complete", ("main-2",), ("merge",))


def group(name: str) -> Group:
    return next(x for x in groups_of(survey()) if x.name == name)


def test_the_catalogue_stays_within_the_limits_and_reaches_danger(known: list[Found]) -> None:
    limits = load_vehicle("car")
    assert len(known) >= 5
    for found in known:
        drive = found.file.drive
        assert first_breach(drive, dict.fromkeys(drive.vehicles, limits), None) is None
        formula = missed(sectors_of(LIBRARY.select("ext"))[0])
        assert judge_file(replace(found.file, formula=formula), LIBRARY).accepted
        assert found.first == "complete"


def test_an_empty_class_is_proved_and_the_certificate_checked(tmp_path: Path) -> None:
    part = next(p for p in group("behaviourSV_8").conditions if p.condition.startswith("atLane"))
    (answer,) = settle_group(survey(), Group(part))
    assert answer.verdict is Verdict.IMPOSSIBLE
    assert answer.claim.count("->") in (3, 6)
    assert answer.certificate is not None
    path = tmp_path / "empty.json"
    path.write_text(answer.certificate, "utf-8")
    assert main(["check", str(path), "--jobs", "1"]) == 0


def test_a_class_with_drives_has_no_proof(known: list[Found]) -> None:
    """A wrong claim of emptiness would be the worst mistake."""
    seen = {key for found in known for key in found.classes}
    parts = [p for x in groups_of(survey()) for p in x.parts if p is not None and p.key in seen]
    scenarios = some_scenario(sectors_of(LIBRARY.select("ext"))[0])
    for part in parts[:: len(parts) // 4]:
        claim = f"{part.without} and F danger(SV,POV) -> {scenarios}"
        assert prove(LIBRARY.select("ext"), claim, Effort(1.0)).certificate is None


def test_known_drives_are_evidence_for_a_component_and_its_conditions(known: list[Found]) -> None:
    wanted = "laneKeep(POV, L) U danger(SV, POV) in decel"
    whole = group("behaviourPOV_4")
    part = next(p for p in whole.conditions if p.condition == wanted)
    drives = [x for x in known if part.key in x.classes]
    assert drives
    answers = settle_group(survey(), Group(whole.component, (part,)), drives)
    assert [x.verdict for x in answers] == [Verdict.WITNESSED] * 2
    for answer in answers:
        (gap,) = answer.gaps
        assert gap.first == "complete"
        assert part.without in gap.formula or answer.part is not part
        assert judge_file(read_drive(dict(gap.drive), "gap"), LIBRARY).accepted
    elsewhere = answers[0].gaps[0].elsewhere["merge"]
    assert "scenario_12" in str(elsewhere["formula"])
    placed = read_drive(dict(elsewhere), "gap")
    assert judge_file(placed, LIBRARY).accepted
    assert whole.component is not None
    assert whole.component.key in Classes(EXT).of(placed)


def test_a_gap_is_in_the_classes_of_its_components_and_of_conditions(known: list[Found]) -> None:
    conditions = {p.key: x.name for x in groups_of(survey()) for p in x.conditions}
    for found in known:
        assert {conditions[key] for key in found.classes if key in conditions} <= set(found.classes)


def test_roles_exchanged_give_the_same_classes(known: list[Found]) -> None:
    classes = Classes(EXT)
    for found in known[:3]:
        vehicles = found.file.drive.vehicles
        other = Drive({"SV": vehicles["POV"], "POV": vehicles["SV"]})
        assert classes.of(replace(found.file, drive=other)) == found.classes


def test_a_set_that_is_not_extended() -> None:
    with pytest.raises(UsageError, match="does not extend"):
        survey_of(Asked(("complete",)), "base", ("main-2",))


def test_where_no_search_is_possible_the_answer_says_so() -> None:
    off_the_grid = Asked(("ext",), values={"minDanger": F(1, 7)}, effort=Effort(0.1))
    survey = survey_of(off_the_grid, "", ("main-2",))
    part = next(x.component for x in groups_of(survey) if x.name == "behaviourPOV_8")
    (answer,) = settle_group(survey, Group(part))
    assert answer.verdict is Verdict.UNKNOWN
    assert "no search on main-2" in answer.reason
