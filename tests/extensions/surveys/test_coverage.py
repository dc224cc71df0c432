"""Coverage: the proposed set is proved to have no gap, and each of its definitions is needed for that."""

from dataclasses import replace
from fractions import Fraction as F
from pathlib import Path
from typing import TypeVar

import pytest

from engine_calls import prove
from roadproof.engines.search.batches import Engines
from roadproof.engines.search.minimal import simplest
from roadproof.errors import InputError
from roadproof.evidence.certificate_file import to_json
from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.judged import judge_file
from roadproof.evidence.verdict_with_evidence import ProofResult
from roadproof.extensions.surveys.coverage import gap_drives
from roadproof.extensions.surveys.coverage.answers import (
    Answers,
    ClassAnswer,
    GapTrace,
    GapTraffic,
    Need,
    verdict_on,
    with_counts,
)
from roadproof.extensions.surveys.coverage.claims import GapClaims
from roadproof.extensions.surveys.coverage.classes import (
    GapClasses,
    GapGroup,
    ScenarioPart,
    changed_definitions,
    claims_of,
    gap_formula,
    in_either_role,
    parts_of,
    sectors_of,
    sets_between,
    two_vehicle_numbers,
)
from roadproof.extensions.surveys.coverage.gap_drives import GapDrive, SimpleDrives, Trials, own_definitions
from roadproof.extensions.surveys.coverage.gap_search import GapRoads, GapSearch, ask_need, work_of
from roadproof.extensions.surveys.coverage.simple_drives import HORIZON, simple_drives
from roadproof.extensions.surveys.extremes.points import ClaimGenerator
from roadproof.frontends.cli.main import main
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import build_library, bundled_library
from roadproof.library.specification import Source
from roadproof.logic.show import text
from roadproof.questions.basis import Basis
from roadproof.runtime.budget import Effort
from roadproof.semantics.exact.replay import first_breach
from roadproof.verdict import Verdict
from roadproof.world.drive import Drive, Motion, Piece
from roadproof.world.models import load_road, load_vehicle
from roadproof.world.road import Road

LIBRARY = bundled_library()
COMPLETE = LIBRARY.select("complete")
REPLACED = ("aheadOf", "cutIn", "cutOut", "decel", "initialCondition_8")
T = TypeVar("T")
STEADY = Piece(None, F(0), F(0))


def of_set(name: str) -> Basis:
    return Basis(LIBRARY.select(name))


def answered(asking: ClaimGenerator[T], claims: GapClaims) -> T:
    """What answers show, each claim settled by itself."""
    try:
        name, claim = next(asking)
        while True:
            name, claim = asking.send(Engines(work_of(name, claims)).answer_claim(claim)[0])
    except StopIteration as end:
        found: T = end.value
        return found


def needed_by(basis: Basis, name: str) -> Need:
    claims = GapClaims(basis)
    return answered(ask_need(claims, name), claims)


def without(name: str) -> Verdict:
    """The verdict on coverage of the main road by ``complete`` with one definition as it is in ext."""
    kept = [n for n in changed_definitions(LIBRARY.select("ext"), COMPLETE) if n != name]
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
    formula = gap_formula(specification, two_vehicle_numbers(specification)).text
    return DriveFile(None, set_name, formula, F(14), {}, {}, {}, load_road(road), drive)


def test_what_the_proposed_set_replaces() -> None:
    assert sorted(changed_definitions(LIBRARY.select("ext"), COMPLETE)) == list(REPLACED)
    assert two_vehicle_numbers(COMPLETE) == tuple(n for n in range(1, 25) if n % 8 != 2)
    assert sectors_of(COMPLETE)[1] == (9, 11, 12, 13, 14, 15, 16)


def test_the_sets_on_the_way() -> None:
    assert sets_between(LIBRARY, "base", "complete") == ("extA", "ext", "complete")
    assert sets_between(LIBRARY, "ext", "base") == sets_between(LIBRARY, "ext", "ext") == ()


@pytest.mark.parametrize("name", ["cutIn", "decel", "initialCondition_8"])
def test_the_proof_fails_without_a_definition(name: str) -> None:
    assert without(name) is not Verdict.PROVED


def test_coverage_of_the_main_road_is_proved(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    claims = GapClaims(of_set("complete"))
    for number, name in enumerate(("covered-1", "covered-4")):
        covered, _ = Engines(work_of(name, claims)).answer_claim(claims.coverage_claims[name])
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
    assert sorted(own_definitions(COMPLETE)) == list(REPLACED)
    need = needed_by(of_set("complete"), "cutIn")
    assert need.verdict is Verdict.WITNESSED
    assert need.drive is not None
    assert judge_file(need.drive.file, LIBRARY).accepted
    assert not judge_file(file_of(need.drive.file.drive, "complete"), LIBRARY).accepted


def test_what_the_clock_cuts_off_is_in_doubt(monkeypatch: pytest.MonkeyPatch) -> None:
    basis = replace(of_set("complete"), effort=Effort(1.0, timeout=0.0001))
    claims = GapClaims(basis)
    covered, _ = Engines(work_of("covered-1", claims)).answer_claim(claims.coverage_claims["covered-1"])
    assert covered.verdict is Verdict.UNKNOWN
    assert "cut off by the clock" in covered.reason
    monkeypatch.setattr(gap_drives, "simple_drives", lambda *_: ())
    assert needed_by(basis, "cutIn").verdict is Verdict.UNKNOWN


def test_a_set_that_extends_nothing_needs_nothing() -> None:
    assert own_definitions(LIBRARY.select()) == ()


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


# --- Drives made simpler: what is said of them stays true, and what is not needed goes --------------

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


# --- Parts of scenarios: what they are, and that leaving one out weakens the scenario ---------------


def keys(set_name: str, number: int) -> list[str]:
    return [part.key for part in parts_of(LIBRARY.select(set_name), number)]


def test_components_come_with_their_conditions() -> None:
    assert keys("base", 4) == [
        "initialCondition_4",
        "initialCondition_4: aheadOf(SV, POV)",
        "initialCondition_4: sameLane(SV, POV, L) or inAdjLanes(SV, POV, L)",
        "behaviourSV_4",
        "behaviourPOV_4",
        "behaviourPOV_4: fasterThan(POV, SV) U danger(SV, POV) in decel",
        "behaviourPOV_4: laneKeep(POV, L) U danger(SV, POV) in decel",
    ]
    assert keys("base", 1)[1:] == [
        "behaviourPOV_1",
        "behaviourPOV_1: not sameLane(POV, SV, L) in cutIn",
        "behaviourPOV_1: danger(SV, POV) in cutIn",
        "behaviourPOV_1: sameLane(SV, POV, L) in cutIn",
        "behaviourPOV_1: aheadOf(SV, POV) in cutIn",
    ]


def test_a_component_that_is_true_is_no_part() -> None:
    assert not [key for key in keys("base", 1) if key.startswith("initialCondition")]


def test_a_disjunction_is_one_condition() -> None:
    wanted = "behaviourPOV_4: (fasterThan(POV, SV) or decelerates(POV)) U danger(SV, POV) in decel"
    assert wanted in keys("ext", 4)


def test_parts_of_other_sectors_are_those_of_the_first() -> None:
    for number in (12, 20):
        conditions = [part.condition for part in parts_of(LIBRARY.select("ext"), number)]
        mine = [part.condition for part in parts_of(LIBRARY.select("ext"), 4)]
        assert [x.partition(" in ")[0] for x in conditions] == [x.partition(" in ")[0] for x in mine]


@pytest.mark.parametrize("set_name", ["base", "complete"])
def test_no_two_parts_have_one_key(set_name: str) -> None:
    specification = LIBRARY.select(set_name)
    found = [p.key for n in two_vehicle_numbers(specification) for p in parts_of(specification, n)]
    assert len(found) == len(set(found))


def weakens(set_name: str, part: ScenarioPart) -> bool:
    claim = f"scenario_{part.scenario}(SV,POV,L) -> ({part.without.text})"
    return prove(LIBRARY.select(set_name), claim, Effort(5.0)).verdict is Verdict.PROVED


@pytest.mark.parametrize("number", [1, 4, 6])
def test_leaving_a_part_out_weakens_the_scenario(number: int) -> None:
    assert all(weakens("ext", part) for part in parts_of(LIBRARY.select("ext"), number))


def test_a_part_left_out_of_the_wrong_scenario_does_not() -> None:
    (first, *_) = parts_of(LIBRARY.select("ext"), 4)
    wrong = ScenarioPart(3, first.component, first.description, first.condition, first.without, first.finest)
    assert not weakens("ext", wrong)


# --- Classes of gaps: drives are judged, proofs are checked, and no drive is in a class that is proved empty

EXT = Basis(LIBRARY.select("ext"), effort=Effort(0.1))
CLASSES = GapClasses(EXT)
CLAIMS = GapClaims(EXT, ("complete",))
ROADS = GapRoads((load_road("main-2"),), (load_road("merge"),))
TRIALS = CLAIMS.trials


@pytest.fixture(scope="module")
def known() -> list[GapDrive]:
    """Gaps of ext from some of the simple drives."""
    return [*SimpleDrives(load_road("main-2"), CLASSES, TRIALS).best(0, 61).values()]


def settle(group: GapGroup, known: list[GapDrive] | None = None) -> Answers:
    return answered(GapSearch(CLAIMS, ROADS, group, tuple(known or ()), ()).run(), CLAIMS)


def group(name: str) -> GapGroup:
    return next(x for x in CLASSES.groups() if x.title == name)


def test_simple_drives_stay_within_the_limits_and_reach_danger(known: list[GapDrive]) -> None:
    limits = load_vehicle("car")
    assert len(known) >= 5
    for found in known:
        drive = found.file.drive
        assert first_breach(drive, dict.fromkeys(drive.vehicles, limits), None) is None
        formula = gap_formula(EXT.specification, sectors_of(EXT.specification)[0]).text
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


def test_a_class_with_drives_has_no_proof(known: list[GapDrive]) -> None:
    """A wrong claim of emptiness would be the worst mistake."""
    seen = {key for found in known for key in found.classes}
    parts = [p for x in CLASSES.groups() for p in x.parts if p is not None and p.key in seen]
    every = in_either_role(EXT.specification, sectors_of(EXT.specification)[0])
    scenarios = " or ".join(x.text for x in every)
    for part in parts[:: len(parts) // 4]:
        claim = f"{part.without.text} and F danger(SV,POV) -> {scenarios}"
        assert prove(LIBRARY.select("ext"), claim, Effort(1.0)).certificate is None


def test_known_drives_are_evidence_for_a_component_and_its_conditions(known: list[GapDrive]) -> None:
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
    placed = answers[0].gaps[0].elsewhere["merge"].drive.file
    assert "scenario_12" in placed.formula
    assert judge_file(placed, LIBRARY).accepted
    assert whole.component is not None
    assert whole.component.key in CLASSES.of(placed)


def test_a_gap_is_in_the_classes_of_its_components_and_of_conditions(known: list[GapDrive]) -> None:
    conditions = {p.key: x.title for x in CLASSES.groups() for p in x.conditions}
    for found in known:
        assert {conditions[key] for key in found.classes if key in conditions} <= set(found.classes)


def test_roles_exchanged_give_the_same_classes(known: list[GapDrive]) -> None:
    for found in known[:3]:
        vehicles = found.file.drive.vehicles
        other = Drive({"SV": vehicles["POV"], "POV": vehicles["SV"]})
        assert CLASSES.of(replace(found.file, drive=other)) == found.classes


def test_where_no_search_is_possible_the_answer_says_so() -> None:
    off_the_grid = replace(EXT, values={"minDanger": F(1, 997)})
    claims = GapClaims(off_the_grid)
    group = GapGroup(claims.groups["behaviourPOV_8"].component)
    (answer,) = answered(GapSearch(claims, ROADS, group, (), ()).run(), claims)
    assert answer.verdict is Verdict.UNKNOWN
    assert answer.reason.startswith("on main-2: no search: ")


def test_a_class_that_the_clock_cuts_off_is_in_doubt() -> None:
    late = GapClaims(replace(EXT, effort=Effort(0.1, timeout=0.0001)), ("complete",))
    every = answered(GapSearch(late, ROADS, group("behaviourSV_8"), (), ()).run(), late)
    assert {x.verdict for x in every} == {Verdict.UNKNOWN}
    assert all("cut off by the clock" in x.reason for x in every)


# --- Gaps in recordings: what overlapping windows show counts once, and what is proved empty must not occur

BASIS = Basis(bundled_library().select())
FIRST, SECOND, *_ = GapClasses(BASIS).parts
GAP = GapTrace("01", 3, 5, (10, 40), True, (FIRST.key,), False)
ALONE = GapTrace("02", 1, 2, (0, 9), True, (), True)
TRAFFIC = GapTraffic(Path("recordings"), 7, (GAP, GAP, ALONE), 0)


def test_how_often_a_class_occurs_and_where() -> None:
    answer = ClassAnswer(FIRST, verdict=Verdict.UNKNOWN, reason="on main-2: none")
    seen = with_counts(answer, TRAFFIC)
    where = "recording 01, vehicles 3 and 5, frames 10 to 40"
    assert (seen.verdict, seen.in_traffic, seen.trace) == (Verdict.UNKNOWN, 2, where)
    assert seen.reason == f"occurs in {where}"
    assert with_counts(ClassAnswer(None, verdict=Verdict.WITNESSED), TRAFFIC).in_traffic == 1
    never = with_counts(ClassAnswer(SECOND, verdict=Verdict.IMPOSSIBLE), TRAFFIC)
    assert (never.verdict, never.in_traffic, never.trace) == (Verdict.IMPOSSIBLE, 0, "")


def test_what_is_proved_not_to_be_and_occurs_is_our_fault() -> None:
    broken = with_counts(ClassAnswer(FIRST, verdict=Verdict.IMPOSSIBLE), TRAFFIC)
    assert broken.verdict is Verdict.CROSSCHECK_FAILED
    assert verdict_on([], [broken], TRAFFIC) is Verdict.CROSSCHECK_FAILED
    proved = [ProofResult(claim, verdict=Verdict.PROVED) for claim in claims_of(BASIS.specification)]
    assert verdict_on(proved, [], None) is Verdict.COVERED
    assert verdict_on(proved, [], TRAFFIC) is Verdict.CROSSCHECK_FAILED


def test_a_trace_is_told_under_all_its_classes() -> None:
    missed = TRAFFIC.data.missed
    assert [x.classes for x in missed] == [(FIRST.key,), (FIRST.key,), ("",)]
    assert missed[0].pair == "3 and 5, frames 10 to 40"


def test_windows_that_overlap_count_once(tmp_path: Path) -> None:
    pytest.importorskip("polars")
    from extensions.traffic.test_figures import STEPS_SEEN, window
    from roadproof.extensions.surveys.coverage.traffic import count_in_traffic, recordings_in

    window(tmp_path / "a.xml", 0, STEPS_SEEN)
    alone = count_in_traffic(BASIS, recordings_in(tmp_path), print)
    assert (alone.disturbances, alone.repeats) == (1, 0)
    window(tmp_path / "b.xml", 3, STEPS_SEEN, (9, 4))
    both = count_in_traffic(BASIS, recordings_in(tmp_path), print)
    assert (both.disturbances, both.missed, both.repeats) == (1, alone.missed, 1)


def test_a_recording_under_two_names_is_refused(tmp_path: Path) -> None:
    pytest.importorskip("polars")
    from extensions.traffic.test_figures import STEPS_SEEN, window
    from roadproof.extensions.surveys.coverage.traffic import recordings_in

    for name in ("a.xml", "b.xml"):
        window(tmp_path / name, 0, STEPS_SEEN)
    with pytest.raises(InputError, match="the same content as"):
        recordings_in(tmp_path)
