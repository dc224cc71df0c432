"""The drive of a scenario, offered for those that differ from it in the road sector only."""

import os
import signal
from dataclasses import replace
from fractions import Fraction

import pytest

import roadproof as rp
from engine_calls import search_for, search_problem
from roadproof.engines.search import search, siblings
from roadproof.engines.search.question import FoundDrive, SearchProblem
from roadproof.engines.setting import Search, SearchOptions, Setting
from roadproof.evidence.judged import judge_file
from roadproof.extensions.catalogue.completing import search_drive_or_unknown, unknown_outcome
from roadproof.frontends.api.drives import witness_question
from roadproof.frontends.settings.questions import Witness
from roadproof.library.loading import bundled_library, load_library
from roadproof.library.scenario_references import read_query
from roadproof.library.specification import Source
from roadproof.questions.decide import decide_claims
from roadproof.reasons import ReasonKind
from roadproof.runtime.budget import Effort
from roadproof.verdict import Verdict
from roadproof.world.drive import Drive
from roadproof.world.models import load_road


@pytest.fixture
def solved(monkeypatch):
    """A list that grows with each question to a solver; no search is remembered."""
    true_solve, calls = search.solve_mixed, []

    def solve(problem, *given, **more):
        calls.append(len(problem.columns))
        return true_solve(problem, *given, **more)

    monkeypatch.setattr(search, "solve_mixed", solve)
    monkeypatch.setattr(siblings, "_remembered", {})
    return calls


def test_one_search_answers_a_scenario_in_every_sector(solved):
    first = search_drive_or_unknown(search_for("4")).drives[0].file
    asked = len(solved)
    for number, road in (("12", "merge"), ("20", "depart")):
        outcome = search_drive_or_unknown(search_for(number))
        file = outcome.drives[0].file
        assert (outcome.verdict, outcome.natural, outcome.scenario) == (Verdict.WITNESSED, True, int(number))
        assert (file.road, file.drive, file.lanes) == (load_road(road), first.drive, first.lanes)
        assert judge_file(file, bundled_library()).accepted
    assert len(solved) == asked


def test_the_drive_is_the_same_where_the_scenario_is_asked_alone(solved, monkeypatch):
    together = [search_drive_or_unknown(search_for(number)).drives[0].file for number in ("3", "11")]
    monkeypatch.setattr(siblings, "_remembered", {})
    assert search_drive_or_unknown(search_for("11")).drives[0].file == together[1]


def test_equal_formulas_of_two_sets_are_searched_once(solved):
    base = search_drive_or_unknown(search_for("5"))
    asked = len(solved)
    other = search_drive_or_unknown(search_for("5", set_name="extA"))
    assert (other.drives[0].file.drive, len(solved)) == (base.drives[0].file.drive, asked)
    assert other.drives[0].file.set_name == "extA"


@pytest.mark.parametrize("more", [{"road": "merge"}, {"lanes": {"L": "main-1"}}])
def test_chosen_places_are_searched_by_themselves(solved, more):
    asked = search_for("12", **more)
    assert siblings._first_twin(asked.specification, 12, asked.query, asked.setting) is None


def test_a_scenario_whose_sibling_gives_no_drive_is_searched(solved, monkeypatch):
    monkeypatch.setattr(siblings, "move_to_road", lambda *_: None)
    outcome = search_drive_or_unknown(search_for("12"))
    assert (outcome.verdict, outcome.natural) == (Verdict.WITNESSED, True)
    assert len(solved) > 1


_OTHERS = """
def scenario_101(SV, POV: vehicle, L: lane) := roadSector_101(SV, POV) and F[0 s, 3 s] v_lon(SV) > 10 m/s
def roadSector_101(SV, POV: vehicle) := true
def scenario_102(SV, POV, POV2: vehicle, L: lane) := roadSector_102(POV2) and F[0 s, 3 s] v_lon(SV) > 10 m/s
def roadSector_102(POV2: vehicle) := mergeZone(POV2)
def scenario_103(SV, POV: vehicle, L: lane) := roadSector_103(SV) and F[0 s, 3 s] v_lon(SV) > 10 m/s
def roadSector_103(SV: vehicle) := mergeZone(SV) and kind(SV) = truck
def scenario_201(SV, POV: vehicle, L: lane) := roadSector_201(SV, POV) and F[0 s, 2 s] v_lon(SV) > 10 m/s
def roadSector_201(SV, POV: vehicle) := F[0 s, 0.001 s] v_lon(SV) > 9 m/s
def scenario_202(SV, POV: vehicle, L: lane) := roadSector_202(SV, POV) and F[0 s, 2 s] v_lon(SV) > 10 m/s
def roadSector_202(SV, POV: vehicle) := mergeZone(SV, POV)
"""


@pytest.mark.parametrize(
    ("number", "vehicles"), [("102", ["POV", "POV2", "SV"]), ("103", ["POV", "SV"]), ("202", ["POV", "SV"])]
)
def test_a_sibling_that_cannot_be_asked_or_has_other_vehicles_is_passed_over(solved, number, vehicles):
    specification = load_library([Source("own.spec", _OTHERS)]).select("base")
    scenario, query = read_query(specification, number)
    first = siblings._first_twin(specification, int(number), query, Setting())
    assert first is not None
    outcome = search_drive_or_unknown(
        Search(specification, query, Setting(), SearchOptions(effort=Effort(30)), (), scenario)
    )
    drive = outcome.drives[0].file.drive
    assert (outcome.verdict, sorted(drive.vehicles)) == (Verdict.WITNESSED, vehicles)


@pytest.mark.parametrize("numbers", [("4", "12", "20"), ("20", "12", "4")])
def test_a_first_scenario_without_a_drive_is_searched_once_for_all(solved, monkeypatch, numbers):
    searched = []

    def search_in_vain(question, search_options):
        searched.append(question.query.text.replace(" ", ""))
        return search.SearchStep(Verdict.UNKNOWN, None, ReasonKind.NONE_FOUND())

    monkeypatch.setattr("roadproof.engines.search.search.find_witness", search_in_vain)
    monkeypatch.setattr("roadproof.engines.search.impossible.show_impossible", lambda *_: None)
    outcomes = [search_drive_or_unknown(search_for(number)) for number in numbers]
    assert [outcome.verdict for outcome in outcomes] == [Verdict.UNKNOWN] * 3
    assert sorted(searched) == [f"scenario_{number}(SV,POV,L)" for number in ("12", "20", "4")]


# --- Drives that are none of another question ------------------------------------------------------


@pytest.fixture(scope="module")
def pair() -> tuple[SearchProblem, FoundDrive]:
    """The question for scenario 12, and the drive of scenario 4."""
    first = search_for("4")
    attempt = siblings.find_once(search_problem(first), first.search_options)
    assert attempt.witness is not None
    return search_problem(search_for("12")), attempt.witness


def moved(found: FoundDrive, s: int = 0, d: Fraction = Fraction(0)) -> FoundDrive:
    motions = {name: replace(x, s=x.s + s, d=x.d + d) for name, x in found.drive.vehicles.items()}
    return replace(found, drive=Drive(motions))


def test_a_drive_is_put_on_another_road(pair):
    question, found = pair
    put = siblings.move_to_road(question, found)
    assert put is not None
    assert put.drive == found.drive
    assert put.formula == question.bound(found.lanes) != found.formula


@pytest.mark.parametrize("s", [-2000, 2000])
def test_a_drive_outside_of_the_zone_is_refused(pair, s):
    question, found = pair
    assert siblings._keeps(question, moved(found, s))
    assert siblings.move_to_road(question, moved(found, s)) is None


@pytest.mark.parametrize("d", [Fraction(9, 10), Fraction(-9, 10), Fraction(-9)])
def test_a_drive_beside_the_middle_of_its_lane_or_of_the_road_is_refused(pair, d):
    question, found = pair
    assert not siblings._keeps(question, moved(found, d=d))
    assert siblings.move_to_road(question, moved(found, d=d)) is None


def test_a_drive_in_a_lane_that_is_not_asked_for_is_refused(pair):
    question, found = pair
    assert siblings.move_to_road(replace(question, lanes=({"L": "main-2"},)), found) is None


# --- Which questions are asked together ------------------------------------------------------------


def question(*what, using=None):
    return witness_question(what, using or rp.load("base"), Witness(jobs=1))


def test_scenarios_alike_are_one_batch_whatever_their_set():
    asked = question(4, 12, 5, 20, "v_lon(SV) > 20 m/s", using=rp.load("base", "ext"))
    alike = [f"scenario-{n:02}-{x}" for n in (4, 12, 20) for x in ("base", "ext")]
    batches = [sorted(batch.names) for batch in asked.batches({})]
    assert sorted(alike) in batches
    assert [len(x) for x in batches].count(1) == 2, "a formula is asked for in each set by itself"
    turned = question(20, 4, 12, using=rp.load("base", "ext"))
    assert [sorted(batch.names) for batch in turned.batches({})] == [sorted(alike)]


def test_of_scenarios_alike_only_that_whose_process_dies_is_in_doubt(monkeypatch):
    def die_at_12(search):
        if search.query.text.startswith("scenario_12("):
            os.kill(os.getpid(), signal.SIGKILL)
        return unknown_outcome(search, ReasonKind.NONE_FOUND())

    monkeypatch.setattr("roadproof.engines.search.single_claim.search_drive", die_at_12)
    monkeypatch.setattr("roadproof.questions.decide.is_fork_unsafe", lambda: False)
    asked = question(4, 12, 20, 5)
    answers = decide_claims(asked, executor=2).answers
    dead = {name for name, answer in answers.items() if answer.reason.kind is ReasonKind.PROCESS}
    assert (len(answers), dead) == (4, {"scenario-12-base"})
