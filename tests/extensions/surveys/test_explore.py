"""Exploring: boundaries that are known by reasoning, every drive judged again at its own value, mutants."""

import json
import os
import signal
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction as F
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from roadproof.engines.encode.unroll import common_step
from roadproof.engines.search import known_drive, placing, stages
from roadproof.engines.search.batches import Engines
from roadproof.engines.search.question import SearchProblem, durations, pose
from roadproof.engines.search.search import SearchStep
from roadproof.engines.search.stages import MOST_STEPS, search_in_stages
from roadproof.engines.setting import Search, SearchOptions, Setting
from roadproof.evidence.answer import ClaimAnswer, undecided
from roadproof.evidence.claim import HELP, Claim
from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.judged import JudgedDrive, judge_file
from roadproof.extensions.surveys.explore import values
from roadproof.extensions.surveys.explore.data import (
    ExplorationSettings,
    ExploredFormula,
    SearchSetup,
    VariationRange,
)
from roadproof.extensions.surveys.explore.explorable import Explorable, SweepVariable
from roadproof.extensions.surveys.explore.question import ExploreQuestion
from roadproof.extensions.surveys.explore.values import ExplorationResult
from roadproof.extensions.surveys.extremes.bracket import Bracket, range_of, starting_ranges
from roadproof.extensions.surveys.extremes.extreme import (
    PROOF,
    Extreme,
    ExtremeQuestion,
    ExtremeSearch,
    decide_steps,
    find_extreme,
)
from roadproof.extensions.surveys.extremes.measure import Sense, between, read_measure
from roadproof.extensions.surveys.extremes.points import JudgementCache, PointFinding, Points
from roadproof.extensions.surveys.staged import dt_of, fit_grid, stand_ins, values_of
from roadproof.frontends.cli.main import main
from roadproof.library.elaborate import read_claim, read_term
from roadproof.library.loading import bundled_library
from roadproof.questions.basis import Basis
from roadproof.questions.decide import decide_claims
from roadproof.reasons import ReasonKind
from roadproof.runtime.budget import BudgetExceeded, Effort, Work
from roadproof.verdict import Verdict
from tables import read_table

LIBRARY = bundled_library()
BASE = LIBRARY.select("base")
# A car gains at most 3 m/s², so this takes two seconds.
FASTER = "v_lon(SV) <= 20 m/s and F[0, minSafe] v_lon(SV) >= 26 m/s"
POSITIVE = st.fractions(F(1, 100), F(50), max_denominator=100)


def search_for(what: str, **values: F) -> Search:
    search_options = SearchOptions(effort=Effort(6), explain=False)
    return Search(BASE, read_claim(BASE, what), Setting(values=values), search_options)


class Settling:
    """Engines that remember the names of the claims that they are asked, and which of them search."""

    def __init__(self) -> None:
        self.engines = Engines(Work(Effort(6), PROOF, staged=True, moves=False))
        self.asked: list[str] = []

    def explore(self, asked: Explorable) -> ExplorationResult:
        asking = values.explore("it", asked, JudgementCache())
        try:
            name, claim = next(asking)
            while True:
                self.asked.append(name)
                name, claim = asking.send(self.answer(name, claim))
        except StopIteration as end:
            found: ExplorationResult = end.value
            return found

    def answer(self, name: str, claim: Claim) -> ClaimAnswer:
        answer, _ = self.engines.answer_claim(claim)
        self.engines.learn(answer)
        return answer


def explore(asked: Explorable) -> ExplorationResult:
    return Settling().explore(asked)


def complaints(explored: ExplorationResult, name: str) -> list[str]:
    """What is wrong with the evidence: each drive file must say its value and be judged to hold there."""
    wrong: list[str] = []
    ends = [x for boundary in explored.boundaries for x in (boundary.inside, boundary.outside)]
    for finding in (*explored.findings, *ends):
        if finding.has_drive:
            assert finding.drive is not None
            file = finding.drive.file
            if file.values.get(name) != finding.at[0]:
                wrong.append(f"{name}={finding.at[0]}, but the file says {file.values.get(name)}")
            if not judge_file(file, LIBRARY).accepted:
                wrong.append(f"{name}={finding.at[0]}: rejected")
    return wrong


def least_time(found: bool, finding: PointFinding) -> bool:
    return finding.at[0] >= 2 if found else finding.at[0] < 2


def test_a_boundary_in_time_is_where_reasoning_puts_it() -> None:
    explored = explore(Explorable(search_for(FASTER), (SweepVariable("minSafe", "s", F(0), F(6)),), 6))
    assert [x.has_drive for x in explored.findings] == [False, False, True, True, True, True]
    [boundary] = explored.boundaries
    assert 2 <= boundary.inside.at[0] <= F(21, 10)
    assert boundary.excluded is not None
    assert F(17, 10) < boundary.excluded.at[0] < 2
    for finding in (*explored.findings, boundary.outside):
        if finding.verdict is not Verdict.UNKNOWN:
            assert least_time(finding.has_drive, finding)
    assert complaints(explored, "minSafe") == []
    assert explored.drives <= explored.searches < 12


def test_a_boundary_in_a_limit_is_where_reasoning_puts_it() -> None:
    what = "v_lon(SV) <= 20 m/s and F[0, 3 s] v_lon(SV) >= 26 m/s"
    variable = SweepVariable("SV.a_lon.max", "m/s^2", F(1), F(3), ("SV",), "a_lon.max")
    explored = explore(Explorable(search_for(what), (variable,), 3))
    [boundary] = explored.boundaries
    assert 2 <= boundary.inside.at[0] <= F(21, 10)
    assert boundary.outside.at[0] < 2
    assert boundary.inside.drive is not None
    file = boundary.inside.drive.file
    assert "G a_lon(SV) <= " in file.formula
    assert judge_file(file, LIBRARY).accepted
    assert "a_lon.max" in boundary.outside.reason
    faster = replace(file, formula=file.formula.replace("a_lon(SV) <= ", "a_lon(SV) <= -"))
    assert not judge_file(faster, LIBRARY).accepted


def test_a_map_is_what_reasoning_makes_it() -> None:
    gain = SweepVariable("SV.a_lon.max", "m/s^2", F(1), F(3), ("SV",), "a_lon.max")
    explored = explore(Explorable(search_for(FASTER), (SweepVariable("minSafe", "s", F(0), F(6)), gain), 3))
    for finding in explored.findings:
        time, limit = finding.at
        assert finding.verdict is (Verdict.WITNESSED if time * limit >= 6 else Verdict.NONE_WITHIN)
    assert explored.boundaries == ()
    assert complaints(explored, "minSafe") == []


def test_one_drive_serves_many_values() -> None:
    what = "scenario_4(SV,POV,L)"
    explored = explore(Explorable(search_for(what), (SweepVariable("minDanger", "s", F(0), F(3)),), 11))
    assert all(x.has_drive for x in explored.findings)
    assert explored.searches <= 3
    assert complaints(explored, "minDanger") == []


def test_values_off_every_grid_are_served_by_drives_of_coarser_ones() -> None:
    what = "v_lon(SV) <= 20 m/s and F[0, minSafe] v_lon(SV) >= 26 m/s and F[0, 2.4 s] v_lon(SV) >= 27 m/s"
    variable = SweepVariable("minSafe", "s", F("2.011"), F("2.413"))
    asked = Explorable(search_for(what), (variable,), 2)
    assert fit_grid(search_for(what, minSafe=F("2.413"))) is None
    explored = explore(asked)
    assert [x.verdict for x in explored.findings] == [Verdict.WITNESSED] * 2
    assert complaints(explored, "minSafe") == []
    tight = replace(asked, variables=(SweepVariable("minSafe", "s", F("1.911"), F("1.913")),), precision=F(1))
    assert {x.verdict for x in explore(tight).findings} == {Verdict.UNKNOWN}


def test_a_drive_that_is_not_natural_is_found_after_those_that_are() -> None:
    """Natural drives begin with 22 m/s or more."""
    what = "v_lon(SV) <= 16 m/s and F[0, minSafe] v_lon(SV) >= 18 m/s"
    explored = explore(Explorable(search_for(what), (SweepVariable("minSafe", "s", F(3), F(6)),), 2))
    assert [x.verdict for x in explored.findings] == [Verdict.WITNESSED] * 2


@pytest.mark.parametrize("verdict", [Verdict.UNKNOWN, Verdict.NONE_WITHIN])
def test_none_within_is_said_where_that_is_shown(verdict: Verdict, monkeypatch: pytest.MonkeyPatch) -> None:
    shown: list[SearchProblem] = []

    def show_none(problem: SearchProblem, options: SearchOptions) -> SearchStep:
        shown.append(problem)
        return SearchStep(verdict, None, ReasonKind.NONE_FOUND())  # type: ignore[arg-type]

    monkeypatch.setattr(stages, "show_none", show_none)
    explored = explore(Explorable(search_for(FASTER), (SweepVariable("minSafe", "s", F(0), F(1)),), 2))
    assert [x.verdict for x in explored.findings] == [verdict] * 2
    assert len(shown) == 2


def test_a_doubt_on_either_side_of_a_bracket_leaves_an_exploration_open() -> None:
    def at(value: int, verdict: Verdict = Verdict.WITNESSED) -> PointFinding:
        return PointFinding((F(value),), read_claim(BASE, "true"), verdict=verdict)  # type: ignore[arg-type]

    measure = read_measure(BASE, "least", "v_lon(SV)")
    for doubtful in range(5):
        verdicts = [Verdict.UNKNOWN if k == doubtful else Verdict.NONE_WITHIN for k in range(5)]
        value, held, missed, best, beyond = (at(k, x) for k, x in enumerate(verdicts))
        boundary, extreme = (
            values.SweepBoundary(held, missed, None),
            Extreme(measure, (), best, beyond, None, 1),
        )
        explored = ExplorationResult((value,), (boundary,), (extreme,))
        assert sorted(explored.verdicts) == sorted(verdicts)


def test_what_is_proved_impossible_takes_no_search() -> None:
    what = "scenario_1(SV,POV,L) and scenario_4(SV,POV,L)"
    explored = explore(Explorable(search_for(what), (SweepVariable("minDanger", "s", F(0), F(3)),), 4))
    assert {x.verdict for x in explored.findings} == {Verdict.IMPOSSIBLE}
    assert all(x.certificate for x in explored.findings)
    assert explored.searches == 0


def test_a_drive_that_keeps_its_old_value_is_caught(monkeypatch: pytest.MonkeyPatch) -> None:
    def forgetful(file: DriveFile, claim: Claim) -> DriveFile:
        return replace(file, formula=claim.query.text)

    monkeypatch.setattr(known_drive, "file_for_claim", forgetful)
    asked = Explorable(search_for(FASTER), (SweepVariable("minSafe", "s", F(3), F(6)),), 3)
    with pytest.raises(ValueError, match="it has minSafe=3, and not 6 on the drive"):
        explore(asked)


def test_a_drive_that_is_not_judged_again_is_caught(monkeypatch: pytest.MonkeyPatch) -> None:
    def believed(file: DriveFile, library: object) -> JudgedDrive:
        """As if it had been judged."""
        judged = object.__new__(JudgedDrive)
        for name, value in (("file", file), ("judgement", None), ("natural", None)):
            object.__setattr__(judged, name, value)
        return judged

    monkeypatch.setattr(placing, "JudgedDrive", believed)
    monkeypatch.setattr(known_drive.LazyJudge, "holds", lambda *_: True)
    asked = Explorable(search_for(FASTER), (SweepVariable("minSafe", "s", F(0), F(6)),), 3)
    assert complaints(explore(asked), "minSafe")


def test_a_leap_that_takes_the_next_value_for_granted_is_caught(monkeypatch: pytest.MonkeyPatch) -> None:
    def hasty(self: object, reached: F, missed: F, precision: F) -> F:
        return between(missed, between(reached, missed))

    monkeypatch.setattr(values.Exploration, "_leap", hasty)
    [boundary] = explore(
        Explorable(search_for(FASTER), (SweepVariable("minSafe", "s", F(0), F(6)),), 3, F(1, 10))
    ).boundaries
    assert boundary.inside.verdict is Verdict.UNKNOWN


def extreme_of(what: str, sense: Sense, term: str, when: str = "") -> tuple[Extreme, PointFinding, DriveFile]:
    """The extreme, its best value, and the drive file that shows it."""
    measure = read_measure(BASE, sense, term, when)
    found = find_extreme(ExtremeQuestion("it", search_for(what), measure, F(1, 10)))
    assert found.best is not None
    assert found.best.drive is not None
    file = found.best.drive.file
    assert judge_file(file, LIBRARY).accepted
    return found, found.best, file


def test_an_extreme_at_the_start_is_where_reasoning_puts_it() -> None:
    found, best, file = extreme_of("F[0, 2.4 s] v_lon(SV) >= 30 m/s", "least", "v_lon(SV)")
    exact = 30 - 3 * F("2.4")
    assert exact <= best.at[0] <= exact + F(1, 5)
    assert found.excluded is not None
    assert exact - F(1, 2) < found.excluded.at[0] < exact
    assert file.drive.vehicles["SV"].v_lon == best.at[0]


def test_an_extreme_at_a_moment_is_where_reasoning_puts_it() -> None:
    what = "v_lon(SV) <= 20 m/s and G a_lon(SV) <= 0 m/s^2"
    found, best, _ = extreme_of(what, "greatest", "v_lon(SV)", "a_lon(SV) <= 0 m/s^2")
    assert F("19.9") <= best.at[0] <= 20
    assert found.outside is not None
    assert found.outside.at[0] > 20


def test_an_infimum_is_bracketed_by_a_proof() -> None:
    found, best, _ = extreme_of("v_lon(SV) > v_lon(POV)", "least", "v_lon(SV) - v_lon(POV)")
    assert 0 < best.at[0] <= F(1, 5)
    assert found.outside is not None
    assert (found.outside.at, found.outside.verdict) == ((0,), Verdict.IMPOSSIBLE)
    assert found.outside.certificate


def test_a_measure_without_end_is_said_to_have_none() -> None:
    found, _, _ = extreme_of("v_lon(SV) >= 30 m/s", "greatest", "s(SV)", "v_lon(SV) >= 20 m/s")
    assert found.endless
    assert found.outside is None


def test_the_drive_of_one_value_is_tried_at_the_others(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where a search stops at its first drive, the better drive of another value goes on from there."""
    variable = SweepVariable("minSafe", "s", F(3), F(4))
    measure = read_measure(BASE, "least", "v_lon(SV)")
    asked = Explorable(search_for("F[0, minSafe] v_lon(SV) >= 30 m/s"), (variable,), 2, F(1), (measure,))
    run = ExtremeSearch.run

    def poor(self: ExtremeSearch, drives: Sequence[JudgedDrive] = ()) -> object:
        if self.question.name == "it-least-2":
            monkeypatch.setattr(self, "steps", 10**6)
        return run(self, drives)

    monkeypatch.setattr(ExtremeSearch, "run", poor)
    settling = Settling()
    three, four = settling.explore(asked).extremes
    assert three.best is not None
    assert four.best is not None
    assert four.best.at[0] <= three.best.at[0] < 25
    assert "it-least-2-again-best" in settling.asked


@given(POSITIVE, POSITIVE, st.lists(POSITIVE, max_size=3))
def test_between_is_strictly_between(low: F, width: F, grains: list[F]) -> None:
    assert low < between(low, low + width, tuple(grains)) < low + width
    assert between(low, low + width, tuple(grains)) == between(low + width, low, tuple(grains))


@given(POSITIVE, POSITIVE)
def test_both_are_multiples_of_the_common_step(a: F, b: F) -> None:
    step = common_step(a, b)
    assert (a / step).denominator == (b / step).denominator == 1
    assert common_step(F(0), b) == b


@given(st.fractions(F(0), F(6), max_denominator=40), st.fractions(F(0), F(6), max_denominator=40))
def test_grids_fit_the_durations(safe: F, danger: F) -> None:
    asked = search_for("scenario_4(SV,POV,L)", minSafe=safe, minDanger=danger)
    formula = asked.query.formula
    fitting = fit_grid(asked)
    for one in [fitting] if fitting is not None else stand_ins(asked):
        horizon, dt = one.setting.horizon, dt_of(one.setting)
        assert dt <= dt_of(asked.setting)
        assert horizon >= asked.setting.horizon
        assert horizon / dt <= MOST_STEPS + 1
        for duration in (*durations(formula, values_of(one)), horizon):
            assert (duration / dt).denominator == 1
    if fitting is not None:
        assert values_of(fitting) == values_of(asked)


def test_the_range_of_a_term_holds_its_values() -> None:
    asked = search_for("scenario_4(SV,POV,L)")
    ranges = starting_ranges(pose(LIBRARY, asked.query, asked.setting))
    term, dimension = read_term(BASE, "v_lon(SV) - v_lon(POV)")
    assert range_of(term, ranges) == (-25, 25)
    assert dimension == (1, -1)
    assert range_of(read_term(BASE, "max(0, a_lon(SV))^2 / 2")[0], ranges) == (0, F(9, 2))
    assert range_of(read_term(BASE, "(a_lon(SV))^2")[0], ranges) == (0, 36)


def test_a_doubt_is_looked_past_before_it_is_the_end() -> None:
    def at(value: int, verdict: Verdict) -> PointFinding:
        return PointFinding((F(value),), read_claim(BASE, "true"), verdict=verdict)

    bracket = Bracket(-1, F(1), F(10), F(30))
    assert bracket.next() == 30
    bracket.miss(at(30, Verdict.NONE_WITHIN))
    assert 10 < bracket.next() < 30
    bracket.miss(at(20, Verdict.UNKNOWN))
    assert 20 < bracket.next() < 30
    bracket.miss(at(25, Verdict.UNKNOWN))
    assert 10 < bracket.next() < 20
    bracket.hold(F(22))
    assert bracket.outside is not None
    assert bracket.outside.at == (25,)
    bracket.hold(F(31))
    assert (bracket.outside, bracket.narrow) == (None, False)
    assert bracket.next() > 31


def test_a_drive_found_later_is_judged_where_none_was_found_before() -> None:
    class Missing(Settling):
        """The first search misses what is there."""

        def answer(self, name: str, claim: Claim) -> ClaimAnswer:
            if name == "it-value-001":
                return undecided(claim, ReasonKind.TOLD("not looked"), Verdict.NONE_WITHIN)
            return super().answer(name, claim)

    settling = Missing()
    explored = settling.explore(
        Explorable(search_for(FASTER), (SweepVariable("minSafe", "s", F(3), F(6)),), 3)
    )
    assert all(finding.has_drive for finding in explored.findings)
    assert explored.boundaries == ()
    assert settling.asked[-1] == "it-value-001-later"


def question_of(
    *formulas: str, low: int = 3, high: int = 6, least: str | None = None, precision: int | None = None
) -> ExploreQuestion:
    """Exploring ``minSafe`` from low to high, or nothing where these are equal."""
    place = SearchSetup(
        road=None, lanes={}, dt=None, reach=F(80), collisions=False, engine="milp", solver="highs"
    )
    asked = ExplorationSettings(
        formulas=tuple(ExploredFormula(scenario=None, set="base", formula=x) for x in formulas),
        vary=(VariationRange(name="minSafe", low=F(low), high=F(high)),) if low < high else (),
        steps=2,
        precision=None if precision is None else F(precision),
        least=least,
        place=place,
    )
    return ExploreQuestion(Basis(BASE, effort=Effort(6)), asked)


TWO = (FASTER, "F[0, minSafe] v_lon(SV) >= 26 m/s")


def test_a_search_that_is_lost_twice_is_a_doubt(monkeypatch: pytest.MonkeyPatch) -> None:
    def deadly(claim: Claim, search: Search) -> ClaimAnswer:
        if claim.query.text == FASTER and search.setting.values["minSafe"] == 6:
            os.kill(os.getpid(), signal.SIGKILL)
        return search_in_stages(claim, search)

    monkeypatch.setattr(stages, "search_in_stages", deadly)
    monkeypatch.setattr("roadproof.questions.decide.is_fork_unsafe", lambda: False)
    question = question_of(*TWO, low=1)
    found = question.view(decide_claims(question, executor=2).answers).explored["formula-01-base"]
    assert found.findings[1].verdict is Verdict.UNKNOWN
    assert "its process ended each time" in found.findings[1].reason
    assert found.findings[0].verdict is not Verdict.WITNESSED


def test_an_extreme_whose_search_is_lost_is_a_doubt(monkeypatch: pytest.MonkeyPatch) -> None:
    def deadly(claim: Claim, search: Search) -> ClaimAnswer:
        if "v_lon(SV) <= " in claim.query.text:
            os.kill(os.getpid(), signal.SIGKILL)
        return search_in_stages(claim, search)

    monkeypatch.setattr(stages, "search_in_stages", deadly)
    monkeypatch.setattr("roadproof.questions.decide.is_fork_unsafe", lambda: False)
    question = question_of(
        "v_lon(SV) > 20 m/s", "v_lon(SV) > 30 m/s", low=3, high=3, least="v_lon(SV)", precision=30
    )
    answers = decide_claims(question, executor=2).answers
    assert any("its process ended each time" in x.reason for x in answers.values())
    (extreme,) = question.view(answers).explored["formula-01-base"].extremes
    assert extreme.best is not None
    assert extreme.best.has_drive


def test_claims_without_an_answer_are_in_doubt() -> None:
    question = question_of(*TWO, least="v_lon(SV)")
    for found in question.view({}).explored.values():
        assert {x.verdict for x in found.findings} == {Verdict.UNKNOWN}
        assert found.extremes == ()


def test_what_the_clock_cuts_off_is_a_doubt(monkeypatch: pytest.MonkeyPatch) -> None:
    def late(*_: object) -> None:
        raise BudgetExceeded(1.0)

    monkeypatch.setattr("roadproof.engines.prove.induction.prove_via_opaque_driver", late)
    question = question_of(FASTER, least="v_lon(SV)")
    answers = decide_claims(question, executor=1).answers
    assert "cut off by the clock" in answers[f"{HELP}formula-01-base-any"].reason
    (found,) = question.view(answers).explored.values()
    assert {x.verdict for x in found.findings} == {Verdict.WITNESSED}


def test_what_is_kept_is_not_explored_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    question = question_of(*TWO, least="v_lon(SV)")
    first = decide_claims(question, tmp_path, 1)
    before = {x.name: x.read_bytes() for x in tmp_path.iterdir()}
    (tmp_path / "formula-02-base-value-001.json").unlink()
    again: list[Claim] = []

    def counted(claim: Claim, search: Search) -> ClaimAnswer:
        again.append(claim)
        return search_in_stages(claim, search)

    monkeypatch.setattr(stages, "search_in_stages", counted)
    decide_claims(question_of(*TWO, least="v_lon(SV)"), tmp_path, 1)
    assert {x.digest() for x in again} <= {first.answers["formula-02-base-value-001"].claim.digest()}
    assert {x.name: x.read_bytes() for x in tmp_path.iterdir()} == before


def test_doubts_are_asked_again_with_more_work_alone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    question = question_of(FASTER, low=0)
    first = decide_claims(question, tmp_path, 1).answers
    again: list[str] = []
    decide = Engines.answer_claim

    def counted(self: Engines, claim: Claim, *more: object) -> object:
        again.append(claim.digest())
        return decide(self, claim, *more)  # type: ignore[arg-type]

    monkeypatch.setattr(Engines, "answer_claim", counted)
    decide_claims(question, tmp_path, 1)
    assert again == []
    decide_claims(replace(question, basis=replace(question.basis, effort=Effort(7))), tmp_path, 1)
    assert again == [x.claim.digest() for x in first.values() if not x.is_final] != []


def test_answers_to_claims_that_are_asked_no_more_are_removed(tmp_path: Path) -> None:
    decide_claims(question_of(FASTER), tmp_path, 1)
    before = {x.name for x in tmp_path.iterdir()}
    content = (tmp_path / "formula-01-base-value-001.json").read_bytes()
    (tmp_path / "formula-01-base-at-4.json").write_bytes(content)
    (tmp_path / "mine.json").write_text("{}")
    decide_claims(question_of(FASTER), tmp_path, 1)
    assert {x.name for x in tmp_path.iterdir()} == before | {"mine.json"}


def test_a_kept_answer_at_another_value_does_not_count(tmp_path: Path) -> None:
    decide_claims(question_of(FASTER), tmp_path, 1)
    path = tmp_path / "formula-01-base-value-001.json"
    data = json.loads(path.read_text())
    data["parameters"]["minSafe"] = "5/2"
    path.write_text(json.dumps(data))
    decide_claims(question_of(FASTER), tmp_path, 1)
    assert json.loads(path.read_text())["parameters"]["minSafe"] == "3"


def run(*words: str) -> int:
    return main(["explore", *words, "--jobs", "1"])


def test_the_command_writes_evidence_that_is_accepted(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out"
    words = ("--vary", "minSafe=1:3", "--steps", "2", "--least", "v_lon(SV)", "--precision", "1/2")
    assert run(FASTER, *words, "--out", str(out)) == 0
    printed = capsys.readouterr().out
    assert "minSafe  1 -# 3 s" in printed
    assert main(["check", str(out), "--jobs", "1"]) == 0
    capsys.readouterr()
    before = {x.name: x.read_bytes() for x in out.iterdir()}
    assert {"formula-01-base.png", "formula-01-base-least-1-best.svg"} <= {*before}
    assert run(FASTER, *words, "--out", str(out), "--no-pictures", "--json", str(tmp_path / "it.json")) == 0
    data = json.loads((tmp_path / "it.json").read_text())
    [explored] = data["explored"]
    assert data["schema"] == "roadproof/explore/2"
    assert [x["at"] for x in explored["values"]] == [["1"], ["3"]]
    assert [x["point"] for x in explored["extremes"]] == [["3"]]
    [reached] = [F(x["best"]["at"][0]) for x in explored["extremes"]]
    assert 17 <= reached <= F("17.2")
    assert {x.name: x.read_bytes() for x in out.iterdir()} == before
    assert run(FASTER, *words[:-1], "1", "--out", str(out)) == 2
    assert "answers to another question" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "code", "complaint"),
    read_table(__file__, "mistakes"),
)
def test_mistakes(
    words: tuple[str, ...], code: int, complaint: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(*words) == code
    assert complaint in capsys.readouterr().err


# --- Exploring formulas about one instant that no engine reads: a drive at a value, or a proof at that value

INSTANT = bundled_library().select("base")
# 30 m/s > 50 m/s^2 * rho, by cubes: wherever rho < 0.6 s.
FAST = "v_lon(SV) = 30 m/s and v_lon(SV)^3 > rho*rho*rho*(50 m/s^2)*(50 m/s^2)*(50 m/s^2)"
RHO = SweepVariable("rho", "s", F(0), F("1.2"))


def search_at(what: str, **values: F) -> Search:
    means = SearchOptions(effort=Effort(6), explain=False)
    return Search(INSTANT, read_claim(INSTANT, what), Setting(values=values), means)


def test_every_value_has_a_drive_or_a_proof() -> None:
    explored = explore(Explorable(search_at(FAST), (RHO,), 5))
    found = {x.at[0]: x.verdict for x in explored.findings}
    assert found == {k * F("0.3"): Verdict.WITNESSED if k < 2 else Verdict.IMPOSSIBLE for k in range(5)}
    [boundary] = explored.boundaries
    assert boundary.inside.at[0] < F("0.6") <= boundary.outside.at[0] < boundary.inside.at[0] + F("0.03")
    assert boundary.outside.verdict is Verdict.IMPOSSIBLE
    assert boundary.outside.assuming == (f"rho = {float(boundary.outside.at[0]):g} s",)


def test_an_extreme_is_bracketed_by_proofs() -> None:
    search = search_at(f"{FAST.replace('= 30', '<= 30')} and v_lon(SV) >= 20 m/s", rho=F("0.5"))
    measure = read_measure(INSTANT, "least", "v_lon(SV)", "")
    extreme = find_extreme(ExtremeQuestion("it", search, measure, F(1, 10)))
    assert extreme.best is not None
    assert extreme.outside is not None
    assert F(25) < extreme.best.at[0] <= extreme.outside.at[0] + F(1, 10)
    assert extreme.outside.verdict is Verdict.IMPOSSIBLE
    assert extreme.outside.at[0] <= 25


@pytest.mark.parametrize(
    ("text", "proved"),
    [
        (f"{FAST} and rho >= 0.7 s", True),  # rho is 0.5 s
        ("v_lon(SV)^3 > v_lon(SV)^3 + 1*(1 m/s)*(1 m/s)*(1 m/s)", True),
        ("v_lon(SV) > v_lon(SV)", False),  # engines read it
        ("G v_lon(SV)^3 > v_lon(SV)^3 + 1*(1 m/s)*(1 m/s)*(1 m/s)", False),  # about more than an instant
        (FAST, False),
    ],
)
def test_what_is_proved_at_values(text: str, proved: bool) -> None:
    search = search_at(text, rho=F("0.5"))
    found = decide_steps(Settling().engines, Points(JudgementCache()).never("it", (), search))
    assert (found is not None) == proved
