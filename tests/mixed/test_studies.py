"""Studies of which some parts are decided and some are not: changes, searches, classes."""

import json
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from roadproof.analysis import placing, redundancy
from roadproof.analysis.basis import Basis
from roadproof.analysis.classify.classes import plan_of
from roadproof.analysis.classify.divide import CellAnswer, CellTask, Dividing, Undivided, _division, divide
from roadproof.analysis.redundancy import ChangeFinding, Redundancy, learn
from roadproof.engines.prove.prover import Result
from roadproof.errors import InputError
from roadproof.evidence.certificate import read_certificate_data
from roadproof.evidence.drive_file import load_drive
from roadproof.evidence.journal import ANSWERS
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.library.scenarios import Scenario
from roadproof.reasons import Why
from roadproof.runtime.budget import Effort
from roadproof.verdict import Verdict

ROOT = Path(__file__).parents[2]
HOME = bundled_library().select()
BASIS = Basis(HOME)
DRIVE_FILE = load_drive(ROOT / "examples/catalogue/tests/drives/braking.json")
DRIVE: Any = SimpleNamespace(file=DRIVE_FILE)
PROOF = ROOT / "proofs/P4-scenario-03-base.json"
CERTIFICATE: Any = read_certificate_data(json.loads(PROOF.read_text("utf-8")), "proof")
V = Verdict
ONE, TWO, THREE = (Scenario(k, "base") for k in (1, 2, 3))


def of(**fields: Any) -> Any:
    return SimpleNamespace(**fields)


# --- changes -----------------------------------------------------------------------------------------


def examining(monkeypatch: pytest.MonkeyPatch, results: dict[int, Result], drives: Any = ()) -> Any:
    jobs = redundancy._ExaminationJobs(BASIS, THREE)
    answers = iter(results.values())
    monkeypatch.setattr(Basis, "proof_of", lambda *_, **__: next(answers))
    monkeypatch.setattr(redundancy, "ask", lambda _: of(drives=drives))
    return jobs


CHANGES = list(redundancy.changes_of(HOME, redundancy._ExaminationJobs(BASIS, THREE).query))
UNKNOWN = Result(verdict=V.UNKNOWN, reason=Why.STATE("none", ""))


@pytest.mark.parametrize(
    ("first", "second", "drives", "verdict"),
    [
        (UNKNOWN, UNKNOWN, (), V.UNKNOWN),
        (UNKNOWN, UNKNOWN, (DRIVE,), V.REFUTED),
        (UNKNOWN, Result(verdict=V.PROVED, certificate=CERTIFICATE), (DRIVE,), V.PROVED),
        (Result(verdict=V.PROVED, certificate=CERTIFICATE), UNKNOWN, (), V.PROVED),
        (Result(verdict=V.REFUTED, countermodel=of()), UNKNOWN, (), V.REFUTED),  # type: ignore[arg-type]
        (Result(verdict=V.PROVED), UNKNOWN, (), V.UNKNOWN),
    ],
)
def test_a_change_without_proof_drive_and_trace_is_in_doubt(
    first: Result, second: Result, drives: Any, verdict: Verdict, monkeypatch: pytest.MonkeyPatch
) -> None:
    jobs = examining(monkeypatch, {1: first, 2: second}, drives)
    found = jobs._decide(CHANGES[0])
    assert found.verdict is verdict
    assert (found.assuming is not None) is (verdict is V.PROVED and not first.holds)
    assert (found.certificate is not None) is (verdict is V.PROVED)
    if found.assuming is not None:
        claim = found.claim.text
        assert claim.count("->") >= 2, "both ways"


def test_a_drive_shows_a_change_where_the_judge_finds_so(monkeypatch: pytest.MonkeyPatch) -> None:
    jobs = examining(monkeypatch, {})
    holds = iter([False, True])
    seen: list[Any] = []
    monkeypatch.setattr(redundancy, "judge", lambda *_: of(holds=next(holds)))
    monkeypatch.setattr(redundancy, "judged_as", lambda *_: DRIVE)
    monkeypatch.setattr(redundancy, "bind", lambda formula, road, lanes, values: seen.append(values))
    query = jobs.query
    assert jobs._tells_apart(DRIVE, query, False) is None
    assert jobs._tells_apart(DRIVE, query, False) is DRIVE
    assert {*seen[0]} == {*HOME.library.parameters}
    assert jobs._tells_apart(DRIVE, of(vehicles=("SV", "POV", "POV9")), False) is None


def test_only_what_was_looked_for_in_vain_is_not_looked_for_again() -> None:
    def finding(**fields: Any) -> ChangeFinding:
        return ChangeFinding(CHANGES[0], of(), **fields)  # type: ignore[arg-type]

    assert learn((finding(verdict=V.UNKNOWN),)).vain
    assert learn((finding(verdict=V.REFUTED),)).vain, "a trace refutes it, and no drive was found"
    for sure in (
        finding(verdict=V.UNKNOWN, late=True),
        finding(verdict=V.PROVED, certificate=CERTIFICATE),
        finding(verdict=V.REFUTED, drive=DRIVE),
    ):
        assert not learn((sure,)).vain


def test_both_values_of_a_part_are_tried_on_the_side_where_they_matter() -> None:
    by_part: dict[Any, list[Any]] = {}
    for x in CHANGES:
        by_part.setdefault((x.where, x.part), []).append(x)
    for those in by_part.values():
        assert sorted(x.value for x in those) == [False, True] * (len(those) // 2) or len(those) % 2 == 0
        assert {x.value for x in those} == {False, True}
        assert {x.weakens for x in those} == {False, True}
    negated = read_claim(HOME, "not (danger(SV,POV) and aheadOf(SV,POV))")
    inside = [x for x in redundancy.changes_of(HOME, negated) if x.part.startswith("danger(")]
    assert [(x.value, x.weakens) for x in inside] == [(True, False), (False, True)]


@pytest.mark.parametrize("change", ["one less", "another text"])
def test_kept_findings_are_on_the_changes_that_there_are(change: str) -> None:
    study = Redundancy(BASIS, (3,))
    doubt = redundancy._ExaminationJobs(BASIS, THREE)
    answer = tuple(doubt.doubt(x, Why.TOLD("why")) for x in CHANGES)
    assert all(x.late and x.verdict is V.UNKNOWN for x in answer)
    shelf: Any = of(certificate=lambda *_: None, drive=lambda *_: None)
    shelf.read_certificate = shelf.read_drive = lambda _: None
    record = study.record("scenario-03", answer, shelf)
    assert study.recall(record, shelf)[0] == "scenario-03"
    first, *rest = record.verdicts
    wrong = record.verdicts[:-1] if change == "one less" else (replace(first, changed="true"), *rest)
    with pytest.raises(InputError, match="finding"):
        study.recall(replace(record, verdicts=wrong), shelf)


def test_another_question_about_changes_is_another_folder() -> None:
    usual = Redundancy(BASIS, (3,)).question.fingerprint
    assert Redundancy(BASIS, (3,), whole=True).question.fingerprint != usual
    harder = Redundancy(replace(BASIS, effort=Effort(61.0)), (3,))
    assert harder.question.fingerprint != usual
    assert ANSWERS


# --- searches for drives, and drives on other roads -----------------------------------------------------


def test_searches_are_told_apart_and_lost_ones_are_doubts_of_themselves() -> None:
    from roadproof.analysis.witnesses import WitnessStudy
    from roadproof.engines.search.outcome import Search
    from roadproof.engines.search.question import SearchOptions, Setting

    def search(text: str = "danger(SV,POV)", **more: Any) -> Search:
        return Search(HOME, read_claim(HOME, text), *more.pop("place", (Setting(), SearchOptions())), **more)

    def key(one: Search) -> str:
        study = WitnessStudy((one,))
        return study.key(*study.named)

    usual = key(search())
    others = [
        search("aheadOf(SV,POV)"),
        search(place=(Setting(), SearchOptions("severe"))),
        search(place=(Setting(), SearchOptions(effort=Effort(3.0)))),
        search(place=(Setting(values={"rho": 2}), SearchOptions())),  # type: ignore[dict-item]
        search(place=(Setting(horizon=3), SearchOptions())),  # type: ignore[arg-type]
        search(count=2),
    ]
    assert usual == key(search())
    assert len({usual, *map(key, others)}) == 1 + len(others)
    two = WitnessStudy((search(), search("aheadOf(SV,POV)")))
    names = two.names
    doubts = two.doubt(names, Why.PROCESS("SIGKILL"))
    assert [doubts[x].query.text for x in names] == ["danger(SV,POV)", "aheadOf(SV,POV)"]
    assert two.parts(names) == [(x,) for x in names]
    assert {x.verdict for x in doubts.values()} == {V.UNKNOWN}
    fewer = of(verdict=V.WITNESSED, drives=(DRIVE,), reason=Why.FEWER_DRIVES(1, 2, "none"))
    sure = [two.is_sure(x) for x in (fewer, of(verdict=V.WITNESSED, drives=(DRIVE,), reason=""))]
    assert sure == [False, True]


def test_a_definition_below_a_search_is_a_part_of_its_key() -> None:
    import roadproof as rp
    from roadproof.analysis.witnesses import WitnessStudy
    from roadproof.engines.search.outcome import Search
    from roadproof.engines.search.question import SearchOptions, Setting

    keys = set()
    for speed in (20, 21):
        home = rp.load(specs=[f"def fast(a: vehicle) := v_lon(a) > {speed} m/s\n"])
        study = WitnessStudy((Search(home.specification, home.read("fast(SV)"), Setting(), SearchOptions()),))
        keys.add(study.key(*study.named))
    assert len(keys) == 2


def test_a_zone_is_moved_under_each_vehicle() -> None:
    from roadproof.world.models import load_road

    road = load_road("merge")
    ends = {end for x in road.lanelets for end in x.s if end is not None}
    middles = {x.s - x.length / 2 for x in DRIVE_FILE.drive.vehicles.values()}
    moved = [*placing._moved_under(road, DRIVE_FILE.drive)]
    assert len(moved) == len(ends) * len(DRIVE_FILE.drive.vehicles)
    for there in moved:
        assert middles & {end for x in there.lanelets for end in x.s if end is not None}


def test_a_drive_of_another_formula_is_of_no_scenario(monkeypatch: pytest.MonkeyPatch) -> None:
    made: list[Any] = []
    monkeypatch.setattr(placing, "JudgedDrive", lambda file, library: made.append(file))
    asked = read_claim(HOME, "v_lon(SV) > minSafe*1 m/s^2")
    placing.judged_as(replace(DRIVE_FILE, scenario=4, values={"rho": Fraction(1)}), asked, HOME.library)
    assert (made[0].formula, made[0].scenario) == (asked.text, None)
    assert made[0].values == {"rho": 1, "minSafe": Fraction(3, 5)}


# --- a division of which a part is in doubt ------------------------------------------------------------


def test_a_division_in_doubt_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    from roadproof.analysis.classify.cells import Cell, Outline

    plan = plan_of(HOME, (3, 4))
    study = Dividing(BASIS, plan)
    cells = [Cell((3,), (3,), ()), Cell((4,), (4,), ())]
    outline = Outline((((3,), ()), ((4,), ())), ())
    tasks = [CellTask(plan.what(x.holds), 0, x.holds, ()) for x in cells]
    late = Why.CLOCK(3.0)
    told = [CellAnswer(cells[0]), CellAnswer(cells[1], late)]
    made = _division(plan, [outline], tasks, told)
    assert [(x.about, x.reason) for x in made.doubts] == [
        (f"whether there is a shorter text for {tasks[1].name}", late)
    ]
    assert [study.is_sure(x) for x in (outline, Undivided(late), *told)] == [True, False, True, False]
    lost = study.doubt(tasks[1], late)[tasks[1].name]
    assert isinstance(lost, CellAnswer)
    assert lost.reason == late
    answers = {"axis-0": Undivided(late)}
    monkeypatch.setattr("roadproof.analysis.classify.divide.conduct", lambda *_, **__: of(answers=answers))
    cut = divide(BASIS, plan)
    assert cut.cut_off
    assert [x.reason for x in cut.doubts] == [late]
    assert cut.classes.all() == ()
