"""Classes of gaps: drives are judged, proofs are checked, and no drive is in a class that is proved empty."""

from dataclasses import replace
from fractions import Fraction as F
from pathlib import Path

import pytest

from asking import prove
from roadproof.analysis.basis import Basis
from roadproof.analysis.coverage.answers import Answers
from roadproof.analysis.coverage.claims import in_either_role, missed, sectors_of
from roadproof.analysis.coverage.classes import GapClasses, GapGroup, GapSurvey
from roadproof.analysis.coverage.found import FoundGap, Trials, find_among_simple
from roadproof.analysis.coverage.settling import ClassGroup
from roadproof.evidence.certificate import to_json
from roadproof.evidence.judged import judge_file
from roadproof.frontends.cli.main import main
from roadproof.library.loading import bundled_library
from roadproof.runtime.budget import Effort
from roadproof.semantics.exact.replay import first_breach
from roadproof.verdict import Verdict
from roadproof.world.drive import Drive
from roadproof.world.models import load_road, load_vehicle

LIBRARY = bundled_library()
EXT = Basis(LIBRARY.select("ext"), effort=Effort(0.1))
CLASSES = GapClasses(EXT)
SURVEY = GapSurvey(EXT, ("complete",), (load_road("main-2"),), (load_road("merge"),))
TRIALS = Trials(EXT, SURVEY.wider)


@pytest.fixture(scope="module")
def known() -> list[FoundGap]:
    """Gaps of ext from some of the simple drives."""
    return find_among_simple(load_road("main-2"), 0, 61, CLASSES, TRIALS)


def settle(group: GapGroup, known: list[FoundGap] | None = None) -> Answers:
    return ClassGroup(SURVEY, group, known or [], CLASSES, TRIALS).run()


def group(name: str) -> GapGroup:
    return next(x for x in CLASSES.groups() if x.title == name)


def test_simple_drives_stay_within_the_limits_and_reach_danger(known: list[FoundGap]) -> None:
    limits = load_vehicle("car")
    assert len(known) >= 5
    for found in known:
        drive = found.file.drive
        assert first_breach(drive, dict.fromkeys(drive.vehicles, limits), None) is None
        formula = missed(EXT.specification, sectors_of(EXT.specification)[0]).text
        assert judge_file(replace(found.file, formula=formula), LIBRARY).accepted
        assert found.first == "complete"


def test_an_empty_class_is_proved_and_the_certificate_checked(tmp_path: Path) -> None:
    part = next(p for p in group("behaviourSV_8").conditions if p.condition.startswith("atLane"))
    (answer,) = settle(GapGroup(part))
    assert answer.verdict is Verdict.IMPOSSIBLE
    assert answer.claim is not None
    assert answer.claim.text.count("->") in (3, 6)
    assert answer.certificate is not None
    path = tmp_path / "empty.json"
    path.write_text(to_json(answer.certificate), "utf-8")
    assert main(["check", str(path), "--jobs", "1"]) == 0


def test_a_class_with_drives_has_no_proof(known: list[FoundGap]) -> None:
    """A wrong claim of emptiness would be the worst mistake."""
    seen = {key for found in known for key in found.classes}
    parts = [p for x in CLASSES.groups() for p in x.parts if p is not None and p.key in seen]
    every = in_either_role(EXT.specification, sectors_of(EXT.specification)[0])
    scenarios = " or ".join(x.text for x in every)
    for part in parts[:: len(parts) // 4]:
        claim = f"{part.without.text} and F danger(SV,POV) -> {scenarios}"
        assert prove(LIBRARY.select("ext"), claim, Effort(1.0)).certificate is None


def test_known_drives_are_evidence_for_a_component_and_its_conditions(known: list[FoundGap]) -> None:
    wanted = "laneKeep(POV, L) U danger(SV, POV) in decel"
    whole = group("behaviourPOV_4")
    part = next(p for p in whole.conditions if p.condition == wanted)
    drives = [x for x in known if part.key in x.classes]
    assert drives
    answers = settle(GapGroup(whole.component, (part,)), drives)
    assert [x.verdict for x in answers] == [Verdict.WITNESSED] * 2
    for answer in answers:
        (gap,) = answer.gaps
        assert gap.first == "complete"
        assert part.without.text in gap.drive.file.formula or answer.part is not part
        assert judge_file(gap.drive.file, LIBRARY).accepted
    placed = answers[0].gaps[0].elsewhere["merge"].file
    assert "scenario_12" in placed.formula
    assert judge_file(placed, LIBRARY).accepted
    assert whole.component is not None
    assert whole.component.key in CLASSES.of(placed)


def test_a_gap_is_in_the_classes_of_its_components_and_of_conditions(known: list[FoundGap]) -> None:
    conditions = {p.key: x.title for x in CLASSES.groups() for p in x.conditions}
    for found in known:
        assert {conditions[key] for key in found.classes if key in conditions} <= set(found.classes)


def test_roles_exchanged_give_the_same_classes(known: list[FoundGap]) -> None:
    for found in known[:3]:
        vehicles = found.file.drive.vehicles
        other = Drive({"SV": vehicles["POV"], "POV": vehicles["SV"]})
        assert CLASSES.of(replace(found.file, drive=other)) == found.classes


def test_where_no_search_is_possible_the_answer_says_so() -> None:
    off_the_grid = replace(EXT, values={"minDanger": F(1, 997)})
    classes = GapClasses(off_the_grid)
    survey = replace(SURVEY, basis=off_the_grid, wider=())
    part = next(x.component for x in classes.groups() if x.title == "behaviourPOV_8")
    (answer,) = ClassGroup(survey, GapGroup(part), [], classes, Trials(off_the_grid, ())).run()
    assert answer.verdict is Verdict.UNKNOWN
    assert "no search on main-2" in answer.reason


def test_what_the_clock_cuts_off_is_in_doubt() -> None:
    late = replace(EXT, effort=Effort(0.1, timeout=0.0001))
    every = ClassGroup(replace(SURVEY, basis=late), group("behaviourSV_8"), [], CLASSES, TRIALS).run()
    assert {x.verdict for x in every} == {Verdict.UNKNOWN}
    assert all("cut off by the clock" in x.reason for x in every)
