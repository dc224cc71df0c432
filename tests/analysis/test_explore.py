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

from roadproof.analysis.explore import extreme, search, study, values
from roadproof.analysis.explore.answer import (
    Explorable,
    ExplorationResult,
    Extreme,
    PointFinding,
    Sense,
    Variable,
    between,
    read_measure,
)
from roadproof.analysis.explore.bracket import Bracket, range_of, starting_ranges
from roadproof.analysis.explore.extreme import ExtremeQuestion, find_extreme, find_extremes
from roadproof.analysis.explore.search import (
    MOST_STEPS,
    DriveClaim,
    Reply,
    SearchTask,
    dt_of,
    fit_grid,
    look,
    never,
    stand_ins,
    values_of,
)
from roadproof.analysis.explore.study import Exploration
from roadproof.analysis.explore.values import explore
from roadproof.analysis.study.frame import conduct
from roadproof.engines.encode.unroll import common_step
from roadproof.engines.search.outcome import Search
from roadproof.engines.search.question import SearchOptions, Setting, durations, pose
from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.journal import seal_of
from roadproof.evidence.judged import JudgedDrive, judge_file
from roadproof.frontends.cli.main import main
from roadproof.library.elaborate import read_claim, read_term
from roadproof.library.loading import bundled_library
from roadproof.runtime.budget import BudgetExceeded, Effort
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


def complaints(explored: ExplorationResult, name: str) -> list[str]:
    """What is wrong with the evidence: each drive file must say its value and be judged to hold there."""
    wrong: list[str] = []
    ends = [x for boundary in explored.boundaries for x in (boundary.held, boundary.missed)]
    for finding in (*explored.findings, *ends):
        if finding.found:
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
    explored = explore(Explorable(search_for(FASTER), (Variable("minSafe", "s", F(0), F(6)),), 6))
    assert [x.found for x in explored.findings] == [False, False, True, True, True, True]
    [boundary] = explored.boundaries
    assert 2 <= boundary.held.at[0] <= F(21, 10)
    assert boundary.surely is not None
    assert F(17, 10) < boundary.surely.at[0] < 2
    for finding in (*explored.findings, boundary.missed):
        if finding.verdict is not Verdict.UNKNOWN:
            assert least_time(finding.found, finding)
    assert complaints(explored, "minSafe") == []
    assert explored.drives <= explored.searches < 12


def test_a_boundary_in_a_limit_is_where_reasoning_puts_it() -> None:
    what = "v_lon(SV) <= 20 m/s and F[0, 3 s] v_lon(SV) >= 26 m/s"
    knob = Variable("SV.a_lon.max", "m/s^2", F(1), F(3), ("SV",), "a_lon.max")
    explored = explore(Explorable(search_for(what), (knob,), 3))
    [boundary] = explored.boundaries
    assert 2 <= boundary.held.at[0] <= F(21, 10)
    assert boundary.missed.at[0] < 2
    assert boundary.held.drive is not None
    file = boundary.held.drive.file
    assert "G a_lon(SV) <= " in file.formula
    assert judge_file(file, LIBRARY).accepted
    assert "a_lon.max" in boundary.missed.reason
    faster = replace(file, formula=file.formula.replace("a_lon(SV) <= ", "a_lon(SV) <= -"))
    assert not judge_file(faster, LIBRARY).accepted


def test_a_map_is_what_reasoning_makes_it() -> None:
    gain = Variable("SV.a_lon.max", "m/s^2", F(1), F(3), ("SV",), "a_lon.max")
    explored = explore(Explorable(search_for(FASTER), (Variable("minSafe", "s", F(0), F(6)), gain), 3))
    for finding in explored.findings:
        time, limit = finding.at
        assert finding.verdict is (Verdict.WITNESSED if time * limit >= 6 else Verdict.NONE_WITHIN)
    assert explored.boundaries == ()
    assert complaints(explored, "minSafe") == []


def test_one_drive_serves_many_values() -> None:
    what = "scenario_4(SV,POV,L)"
    explored = explore(Explorable(search_for(what), (Variable("minDanger", "s", F(0), F(3)),), 11))
    assert all(x.found for x in explored.findings)
    assert explored.searches <= 3
    assert complaints(explored, "minDanger") == []


def test_values_off_every_grid_are_served_by_drives_of_coarser_ones() -> None:
    what = "v_lon(SV) <= 20 m/s and F[0, minSafe] v_lon(SV) >= 26 m/s and F[0, 2.4 s] v_lon(SV) >= 27 m/s"
    knob = Variable("minSafe", "s", F("2.011"), F("2.413"))
    asked = Explorable(search_for(what), (knob,), 2)
    assert fit_grid(search_for(what, minSafe=F("2.413"))) is None
    explored = explore(asked)
    assert [x.verdict for x in explored.findings] == [Verdict.WITNESSED] * 2
    assert complaints(explored, "minSafe") == []
    tight = replace(asked, knobs=(Variable("minSafe", "s", F("1.911"), F("1.913")),), precision=F(1))
    assert {x.verdict for x in explore(tight).findings} == {Verdict.UNKNOWN}


def test_what_is_proved_impossible_takes_no_search() -> None:
    what = "scenario_1(SV,POV,L) and scenario_4(SV,POV,L)"
    explored = explore(Explorable(search_for(what), (Variable("minDanger", "s", F(0), F(3)),), 4))
    assert {x.verdict for x in explored.findings} == {Verdict.IMPOSSIBLE}
    assert all(x.certificate for x in explored.findings)
    assert explored.searches == 0


def test_a_drive_that_keeps_its_old_value_is_caught(monkeypatch: pytest.MonkeyPatch) -> None:
    def forgetful(file: DriveFile, claim: DriveClaim) -> DriveFile:
        return replace(file, formula=claim.query.text)

    monkeypatch.setattr(search, "made_for", forgetful)
    asked = Explorable(search_for(FASTER), (Variable("minSafe", "s", F(3), F(6)),), 3)
    assert complaints(explore(asked), "minSafe")


def test_a_drive_that_is_not_judged_again_is_caught(monkeypatch: pytest.MonkeyPatch) -> None:
    def believed(file: DriveFile, library: object) -> JudgedDrive:
        """As if it had been judged."""
        judged = object.__new__(JudgedDrive)
        for name, value in (("file", file), ("judgement", None), ("natural", None)):
            object.__setattr__(judged, name, value)
        return judged

    monkeypatch.setattr(search, "JudgedDrive", believed)
    asked = Explorable(search_for(FASTER), (Variable("minSafe", "s", F(0), F(6)),), 3)
    assert complaints(explore(asked), "minSafe")


def test_a_leap_that_takes_the_next_value_for_granted_is_caught(monkeypatch: pytest.MonkeyPatch) -> None:
    def hasty(self: object, held: PointFinding, missed: PointFinding, precision: F) -> PointFinding:
        return replace(held, at=(between(held.at[0], missed.at[0]),))

    monkeypatch.setattr(values.ExplorationState, "leap", hasty)
    explored = explore(Explorable(search_for(FASTER), (Variable("minSafe", "s", F(0), F(6)),), 3))
    assert complaints(explored, "minSafe")


def extreme_of(what: str, sense: Sense, term: str, when: str = "") -> tuple[Extreme, PointFinding, DriveFile]:
    """The extreme, its best value, and the drive file that shows it."""
    found = find_extreme(ExtremeQuestion(search_for(what), read_measure(BASE, sense, term, when), F(1, 10)))
    assert found.best is not None
    assert found.best.drive is not None
    file = found.best.drive.file
    assert judge_file(file, LIBRARY).accepted
    return found, found.best, file


def test_an_extreme_at_the_start_is_where_reasoning_puts_it() -> None:
    found, best, file = extreme_of("F[0, 2.4 s] v_lon(SV) >= 30 m/s", "least", "v_lon(SV)")
    exact = 30 - 3 * F("2.4")
    assert exact <= best.at[0] <= exact + F(1, 5)
    assert found.surely is not None
    assert exact - F(1, 2) < found.surely.at[0] < exact
    assert file.drive.vehicles["SV"].v_lon == best.at[0]


def test_an_extreme_at_a_moment_is_where_reasoning_puts_it() -> None:
    what = "v_lon(SV) <= 20 m/s and G a_lon(SV) <= 0 m/s^2"
    found, best, _ = extreme_of(what, "greatest", "v_lon(SV)", "a_lon(SV) <= 0 m/s^2")
    assert F("19.9") <= best.at[0] <= 20
    assert found.missed is not None
    assert found.missed.at[0] > 20


def test_an_infimum_is_bracketed_by_a_proof() -> None:
    found, best, _ = extreme_of("v_lon(SV) > v_lon(POV)", "least", "v_lon(SV) - v_lon(POV)")
    assert 0 < best.at[0] <= F(1, 5)
    assert found.missed is not None
    assert (found.missed.at, found.missed.verdict) == ((0,), Verdict.IMPOSSIBLE)
    assert found.missed.certificate


def test_a_measure_without_end_is_said_to_have_none() -> None:
    found, _, _ = extreme_of("v_lon(SV) >= 30 m/s", "greatest", "s(SV)", "v_lon(SV) >= 20 m/s")
    assert found.endless
    assert found.missed is None


def test_the_drive_of_one_value_is_tried_at_the_others() -> None:
    knob = Variable("minSafe", "s", F(1), F(6))
    measure = read_measure(BASE, "least", "v_lon(SV)")
    asked = search_for("F[0, minSafe] v_lon(SV) >= 30 m/s")
    soughts = [ExtremeQuestion(asked, measure, F(1), (knob,), (F(x),)) for x in (4, 3)]
    poor = find_extreme(replace(soughts[0], point=(F(1),)))

    def find(some: Sequence[ExtremeQuestion]) -> list[Extreme]:
        return [poor if x.point == (4,) and not x.seeds else find_extreme(x) for x in some]

    one, other = find_extremes(soughts, find)
    assert poor.best is not None
    assert one.best is not None
    assert other.best is not None
    assert one.best.at[0] <= other.best.at[0] < poor.best.at[0]


@given(POSITIVE, POSITIVE, st.lists(POSITIVE, max_size=3))
def test_between_is_strictly_between(low: F, width: F, grains: list[F]) -> None:
    assert low < between(low, low + width, grains) < low + width
    assert between(low, low + width, grains) == between(low + width, low, grains)


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

    bracket = Bracket(-1, F(1), at(10, Verdict.WITNESSED), F(30))
    assert bracket.next() == 30
    bracket.miss(at(30, Verdict.NONE_WITHIN))
    assert 10 < bracket.next() < 30
    bracket.miss(at(20, Verdict.UNKNOWN))
    assert 20 < bracket.next() < 30
    bracket.miss(at(25, Verdict.UNKNOWN))
    assert 10 < bracket.next() < 20
    bracket.hold(at(22, Verdict.WITNESSED))
    assert bracket.missed is not None
    assert bracket.missed.at == (25,)
    bracket.hold(at(31, Verdict.WITNESSED))
    assert (bracket.missed, bracket.narrow) == (None, False)
    assert bracket.next() > 31


def test_a_drive_found_later_is_judged_where_none_was_found_before() -> None:
    first: list[SearchTask] = []

    def look_all(tasks: Sequence[SearchTask]) -> list[Reply]:
        """The first search misses what is there."""
        if not first:
            first.extend(tasks)
            return [Reply(Verdict.NONE_WITHIN, "not looked") for _ in tasks]
        return [look(task) for task in tasks]

    asked = Explorable(search_for(FASTER), (Variable("minSafe", "s", F(3), F(6)),), 3)
    explored = explore(asked, look_all)
    assert all(finding.found for finding in explored.findings)
    assert explored.boundaries == ()


TWO = (
    Explorable(search_for(FASTER), (Variable("minSafe", "s", F(3), F(6)),), 2),
    Explorable(search_for("F[0, minSafe] v_lon(SV) >= 26 m/s"), (Variable("minSafe", "s", F(3), F(6)),), 2),
)


def test_a_search_that_is_lost_twice_is_a_doubt(monkeypatch: pytest.MonkeyPatch) -> None:
    def deadly(task: SearchTask) -> Reply:
        if task.search.setting.values["minSafe"] == 6:
            os.kill(os.getpid(), signal.SIGKILL)
        return look(task)

    monkeypatch.setattr(study, "look", deadly)
    asked = replace(TWO[0], knobs=(Variable("minSafe", "s", F(1), F(6)),))
    (found,) = conduct(Exploration((asked,), 2), hands=2).answers.values()
    assert (found.findings[1].verdict, found.late) == (Verdict.UNKNOWN, True)
    assert "its process ended each time" in found.findings[1].reason
    assert found.findings[0].verdict is not Verdict.WITNESSED


def test_an_extreme_that_is_lost_twice_is_a_doubt(monkeypatch: pytest.MonkeyPatch) -> None:
    def deadly(sought: ExtremeQuestion, **_: object) -> Extreme:
        os.kill(os.getpid(), signal.SIGKILL)
        raise AssertionError

    monkeypatch.setattr(study, "find_extreme", deadly)
    asked = replace(TWO[0], measures=(read_measure(BASE, "least", "v_lon(SV)"),))
    (found,) = conduct(Exploration((asked,), 2), hands=2).answers.values()
    assert [x.verdict for x in found.findings] == [Verdict.WITNESSED] * 2
    assert [(x.best, x.late) for x in found.extremes] == [(None, True)] * 2
    for missed in (x.missed for x in found.extremes):
        assert missed is not None
        assert missed.verdict is Verdict.UNKNOWN
        assert "its process ended each time" in missed.reason


def test_a_formula_whose_process_dies_is_a_doubt_at_every_value(monkeypatch: pytest.MonkeyPatch) -> None:
    def deadly(asked: Explorable, *rest: object) -> ExplorationResult:
        if asked == TWO[0]:
            os.kill(os.getpid(), signal.SIGKILL)
        return explore(asked)

    monkeypatch.setattr(study, "explore", deadly)
    lost, found = conduct(Exploration(TWO), hands=2).answers.values()
    if not lost.late:
        lost, found = found, lost
    assert {x.verdict for x in lost.findings} == {Verdict.UNKNOWN}
    assert all("its process ended each time" in x.reason for x in lost.findings)
    assert all(x.found for x in found.findings)


def test_what_the_clock_cuts_off_is_a_doubt(monkeypatch: pytest.MonkeyPatch) -> None:
    def late(*_: object) -> None:
        raise BudgetExceeded(1.0)

    for module in (values, extreme):
        monkeypatch.setattr(module, "show_impossible", late)
    asked = replace(TWO[0], measures=(read_measure(BASE, "least", "v_lon(SV)"),))
    (found,) = conduct(Exploration((asked,)), hands=1).answers.values()
    assert found.late
    assert {x.verdict for x in found.findings} == {Verdict.WITNESSED}


def test_what_is_kept_is_not_explored_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    measured = tuple(replace(x, measures=(read_measure(BASE, "least", "v_lon(SV)"),)) for x in TWO)
    asked = Exploration(measured)
    first = conduct(asked, tmp_path, 1)
    names = list(asked.named)
    (tmp_path / f"answers/{names[1]}.json").unlink()
    again: list[str] = []

    def counted(self: Exploration, piece: str) -> dict[str, ExplorationResult]:
        again.append(piece)
        return settle(self, piece)

    settle = Exploration.settle
    monkeypatch.setattr(Exploration, "settle", counted)
    second = conduct(asked, tmp_path, 1)
    assert again == [names[1]]
    assert list(second.answers) == names
    for name in names:
        mine, other = (
            replace(x.answers[name], seconds=0.0, findings=(), boundaries=(), extremes=())
            for x in (first, second)
        )
        assert mine == other
        kept = [replace(x.records[name].exploration, seconds=0) for x in (first, second)]
        assert kept[0] == kept[1]


def test_a_kept_answer_on_another_formula_does_not_count(tmp_path: Path) -> None:
    asked = Exploration(TWO[:1])
    conduct(asked, tmp_path, 1)
    (name,) = asked.named
    path = tmp_path / f"answers/{name}.json"
    data = json.loads(path.read_text())
    data["exploration"]["values"][0]["at"] = ["5/2"]
    data.pop("seal")
    data["seal"] = seal_of(data, asked.question.fingerprint, tmp_path)
    path.write_text(json.dumps(data))
    said: list[str] = []
    conduct(asked, tmp_path, 1, say=said.append)
    assert len(said) == 1
    assert "a stored answer is invalid" in said[0]


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
    data = json.loads((out / "index.json").read_text())
    [explored] = data["explored"]
    assert data["schema"] == "roadproof/explore/1"
    assert [x["at"] for x in explored["values"]] == [["1"], ["3"]]
    assert [x["point"] for x in explored["extremes"]] == [["3"]]
    [reached] = [F(x["best"]["at"][0]) for x in explored["extremes"]]
    assert 17 <= reached <= F("17.2")
    assert list(out.glob("formula-01-base.png"))
    assert list(out.glob("formula-01-base-least-1-best.svg"))
    assert run(FASTER, *words, "--out", str(out), "--no-pictures") == 0
    kept = json.loads((out / "index.json").read_text())
    assert kept["explored"] == data["explored"]
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
RHO = Variable("rho", "s", F(0), F("1.2"))


def search_at(what: str, **values: F) -> Search:
    means = SearchOptions(effort=Effort(6), explain=False)
    return Search(INSTANT, read_claim(INSTANT, what), Setting(values=values), means)


def test_every_value_has_a_drive_or_a_proof() -> None:
    explored = explore(Explorable(search_at(FAST), (RHO,), 5))
    found = {x.at[0]: x.verdict for x in explored.findings}
    assert found == {k * F("0.3"): Verdict.WITNESSED if k < 2 else Verdict.IMPOSSIBLE for k in range(5)}
    [boundary] = explored.boundaries
    assert boundary.held.at[0] < F("0.6") <= boundary.missed.at[0] < boundary.held.at[0] + F("0.03")
    assert boundary.missed.verdict is Verdict.IMPOSSIBLE
    assert boundary.missed.assuming == (f"rho = {float(boundary.missed.at[0]):g} s",)


def test_an_extreme_is_bracketed_by_proofs() -> None:
    search = search_at(f"{FAST.replace('= 30', '<= 30')} and v_lon(SV) >= 20 m/s", rho=F("0.5"))
    measure = read_measure(INSTANT, "least", "v_lon(SV)", "")
    extreme = find_extreme(ExtremeQuestion(search, measure, F(1, 10)))
    assert extreme.best is not None
    assert extreme.missed is not None
    assert F(25) < extreme.best.at[0] <= extreme.missed.at[0] + F(1, 10)
    assert extreme.missed.verdict is Verdict.IMPOSSIBLE
    assert extreme.missed.at[0] <= 25


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
    certificate = never(search, (), search.query, 2.0)
    assert (certificate is not None) == proved


def index_of(folder: Path) -> dict[str, object]:
    found: dict[str, object] = json.loads((folder / "index.json").read_text())
    return found


def test_a_proof_at_another_value_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """What a proof assumes has to be the values of its entry, and what its file says."""
    folder = tmp_path / "explored"
    words = [
        "--vary",
        "rho=0:1.2",
        "--steps",
        "3",
        "--precision",
        "0.3",
        "--no-pictures",
        "--out",
        str(folder),
    ]
    assert main(["explore", FAST, *words]) == 0
    assert main(["check", str(folder)]) == 0
    index = index_of(folder)
    values = index["explored"][0]["values"]  # type: ignore[index]
    assert values[2]["assuming"] == ["rho = 1.2 s"]
    capsys.readouterr()

    def forged(change) -> str:  # type: ignore[no-untyped-def]
        content = index_of(folder)
        change(content["explored"][0]["values"])  # type: ignore[index]
        other = tmp_path / "forged"
        other.mkdir(exist_ok=True)
        for file in folder.glob("*.json"):
            (other / file.name).write_text(file.read_text())
        (other / "index.json").write_text(json.dumps(content))
        assert main(["check", str(other)]) == 10
        return capsys.readouterr().out

    def elsewhere(values: list[dict[str, object]]) -> None:
        values[0] = {**values[2], "at": ["0"]}

    def with_words(values: list[dict[str, object]]) -> None:
        values[0] = {**values[2], "at": ["0"], "assuming": ["rho = 0 s"]}

    def silently(values: list[dict[str, object]]) -> None:
        values[2] = {k: v for k, v in values[2].items() if k != "assuming"}

    def of_a_drive(values: list[dict[str, object]]) -> None:
        values[0] = {**values[0], "assuming": ["rho = 0 s"]}

    assert "assumes rho=6/5, where it is 0" in forged(elsewhere)
    assert "assumes rho = 0 s" in forged(with_words)
    assert "assumes nothing" in forged(silently)
    assert "WITNESSED assumes nothing" in forged(of_a_drive)
