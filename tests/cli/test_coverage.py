"""``roadproof coverage``: evidence in files, runs that go on, pictures, and mistakes."""

import json
import re
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from planting import plant
from roadproof.core_record import DRIVE
from roadproof.engines.search.batches import Engines
from roadproof.errors import UsageError
from roadproof.evidence.answer import ClaimAnswer, undecided
from roadproof.evidence.claim import Claim
from roadproof.evidence.drive_file import load_drive
from roadproof.extensions.assurance.folder_view import folder_data
from roadproof.extensions.surveys import covering
from roadproof.extensions.surveys.coverage import answers as occurring
from roadproof.extensions.surveys.coverage import claims as coverage_claims
from roadproof.extensions.surveys.coverage import question as coverage_question
from roadproof.extensions.surveys.coverage.classes import GapClasses, GapGroup
from roadproof.extensions.surveys.coverage.gap_drives import GapDrive, SimpleDrives
from roadproof.extensions.surveys.coverage.question import CoverageQuestion, gaps_of
from roadproof.frontends.cli.main import main
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.library.specification import Query, Specification
from roadproof.questions.basis import Basis
from roadproof.questions.checking import read_folder
from roadproof.questions.decide import decide_claims
from roadproof.questions.question import walk_batch
from roadproof.questions.store import Store
from roadproof.reasons import ReasonKind
from roadproof.verdict import ExitCode, Verdict
from roadproof.world.models import load_road
from tables import read_table

WANTED = ("behaviourPOV_4", "behaviourSV_8")
"""Components that are asked for here, without their conditions: the rest takes minutes."""


def components(*wanted: str) -> Callable[[GapClasses], list[GapGroup]]:
    """In place of ``GapClasses.groups``: these components alone."""
    groups = GapClasses.groups
    return lambda classes: [GapGroup(x.component) for x in groups(classes) if x.title in wanted]


def claims(*texts: str) -> Callable[[Specification], tuple[Query, ...]]:
    """In place of ``claims_of``: these claims."""
    return lambda specification: tuple(read_claim(specification, text) for text in texts)


@pytest.fixture
def few(monkeypatch: pytest.MonkeyPatch) -> None:
    """Few classes, some of the simple drives."""
    only_some(monkeypatch)


def only_some(monkeypatch: pytest.MonkeyPatch) -> None:
    best = SimpleDrives.best

    def some_drives(self: SimpleDrives, start: int, step: int) -> dict[int, GapDrive]:
        return best(self, 0, 7 * 14) if start == 0 and self.road.name == "main-2" else {}

    monkeypatch.setattr(GapClasses, "groups", components(*WANTED))
    monkeypatch.setattr(SimpleDrives, "best", some_drives)


def run(out: Path, *more: str) -> int:
    command = ["coverage", "--set", "ext", "--jobs", "1", "--effort", "0.2", "--out", str(out), *more]
    return main(command)


def view_of(out: Path) -> Any:
    return folder_data(out)


def test_evidence_in_files_and_going_on(
    few: None, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    out = tmp_path / "out"
    assert run(out, "--road", "main-2") == ExitCode.UNEXPECTED
    printed = capsys.readouterr().out
    assert "scenario 4: deceleration ahead, lane keep, main road\n" in printed
    assert "\nbehaviourPOV_4: POV ahead is slower\n" in printed
    assert "complete: cutIn" in printed
    data = view_of(out)
    assert (data["schema"], data["verdict"], data["wider"]) == ("roadproof/coverage/2", "GAPS", ["complete"])
    by_key = {(x["component"], x["condition"]): x for x in data["classes"]}
    assert by_key["behaviourSV_8", ""]["verdict"] == "IMPOSSIBLE"
    first = by_key["behaviourPOV_4", ""]
    assert first["verdict"] == "WITNESSED"
    assert all(gap["drive"].endswith(".json") for gap in data["gaps"])
    assert data["gaps"][first["gaps"][0] - 1]["elsewhere"].keys() >= {"main-3", "merge", "depart"}
    assert len(list(out.glob("gap-*.svg"))) == len(data["gaps"])
    assert main(["check", str(out), "--jobs", "1"]) == 0
    kept = {path.name: path.read_bytes() for path in out.glob("*.json")}
    monkeypatch.setattr(Engines, "answer_claim", lambda *_: pytest.fail("asked again"))
    assert run(out, "--road", "main-2", "--no-pictures") == ExitCode.UNEXPECTED
    assert {path.name: path.read_bytes() for path in out.glob("*.json")} == kept
    assert view_of(out) == data


def neither_gap_nor_proof(monkeypatch: pytest.MonkeyPatch, out: Path) -> tuple[int, str]:
    """Exit code and verdict where one of two claims is not proved and the one class asked for is empty."""
    some = ("danger(SV,POV) -> danger(POV,SV)", "F danger(SV,POV) -> scenario_1(SV,POV,L)")
    monkeypatch.setattr(coverage_claims, "claims_of", claims(*some))
    monkeypatch.setattr(GapClasses, "groups", components("behaviourSV_8"))
    monkeypatch.setattr(SimpleDrives, "best", lambda *_: {})
    code = run(out, "--no-pictures")
    data = view_of(out)
    assert data["gaps"] == []
    return code, data["verdict"]


@pytest.fixture(scope="module")
def doubtful(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of that question, whose answers a run with a fault takes up."""
    out = tmp_path_factory.mktemp("doubtful") / "out"
    with pytest.MonkeyPatch.context() as patch:
        assert neither_gap_nor_proof(patch, out) == (ExitCode.UNKNOWN, "UNKNOWN")
    return out


def test_neither_gap_nor_proof_is_unknown(
    doubtful: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    out = shutil.copytree(doubtful, tmp_path / "out")
    assert neither_gap_nor_proof(monkeypatch, out) == (ExitCode.UNKNOWN, "UNKNOWN")


FAULTS = [
    ("verdict_on", "any(x.gaps for x in classes) else Verdict.UNKNOWN", "classes else Verdict.UNKNOWN"),
    ("verdict_on", "for x in classes) else Verdict.UNKNOWN", "for x in classes) else Verdict.COVERED"),
    ("verdict_on", "if proved:", "if not any(x.gaps for x in classes):"),
]


@pytest.mark.parametrize(("name", "right", "wrong"), FAULTS)
def test_a_doubt_that_passes_for_an_answer_is_noticed(
    name: str, right: str, wrong: str, doubtful: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    out = shutil.copytree(doubtful, tmp_path / "out")
    plant(monkeypatch, occurring, name, right, wrong)
    assert neither_gap_nor_proof(monkeypatch, out) != (ExitCode.UNKNOWN, "UNKNOWN")


def test_an_exit_code_that_hides_a_doubt_is_noticed(
    doubtful: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    out = shutil.copytree(doubtful, tmp_path / "out")
    monkeypatch.setitem(covering.CODES, Verdict.UNKNOWN, ExitCode.AS_EXPECTED)
    assert neither_gap_nor_proof(monkeypatch, out) != (ExitCode.UNKNOWN, "UNKNOWN")


def asked(set_name: str, *wider: str, road: str = "main-2", needed: bool = False) -> CoverageQuestion:
    basis = Basis(bundled_library().select(set_name))
    return CoverageQuestion(basis, gaps_of(wider, [load_road(road)], needed=needed))


def test_answers_that_compare_with_other_sets_are_not_taken_over(tmp_path: Path) -> None:
    """Which set is the first to catch a drive is part of an answer, so it depends on the sets compared."""
    first = asked("base", "extA", "ext")
    Store(tmp_path, "coverage", first.work).open(first)
    for other in (asked("base", "extA", "ext", road="main-3"), asked("base", "extA", "ext", "complete")):
        with pytest.raises(UsageError, match="another question"):
            Store(tmp_path, "coverage", other.work).open(other)
    same, wider = (asked("base", *x).simple["help-simple-1-1"] for x in (("extA",), ("extA", "ext")))
    assert same.digest() != wider.digest()


def test_what_is_kept_comes_back_as_it_was(few: None, tmp_path: Path) -> None:
    assert run(tmp_path, "--road", "main-2", "--no-pictures") == ExitCode.UNEXPECTED
    found = read_folder(tmp_path)
    assert found.problems == ()
    witnessed, empty = found.question.view(found.answers).survey.classes
    assert (witnessed.verdict, empty.verdict) == (Verdict.WITNESSED, Verdict.IMPOSSIBLE)
    [gap] = witnessed.gaps
    assert {gap.first, *(x.drive.file.set_name for x in gap.elsewhere.values())} == {"complete", "ext"}
    assert empty.claim is not None
    assert empty.certificate is not None
    assert empty.certificate.claim == empty.claim.text
    assert gap.drive.as_data() == json.loads((tmp_path / f"{gap.shown.name}.json").read_text())


def test_claims_and_needs_are_kept_too(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """A run that was broken off leaves nothing that ``check`` has to reject."""
    monkeypatch.setattr(coverage_question, "own_definitions", lambda _: ("cutIn",))
    coverage = asked("complete", needed=True)
    told = decide_claims(coverage, tmp_path, 1).answers
    names = ["covered-1", "covered-2", "covered-3", "covered-4", "help-needed-cutIn", "needed-cutIn"]
    assert sorted(path.stem for path in tmp_path.glob("*.json")) == [*names, "question"]
    assert main(["check", str(tmp_path), "--jobs", "1"]) == 0
    monkeypatch.setattr(Engines, "answer_claim", lambda *_: pytest.fail("asked again"))
    survey = coverage.view(decide_claims(coverage, tmp_path, 1).answers).survey
    assert survey.verdict is Verdict.COVERED
    [need] = survey.needs
    assert need.drive is not None
    assert need.drive.file == told["needed-cutIn"].evidence.file  # type: ignore[union-attr]


def lost(
    question: CoverageQuestion, sent: Callable[[str, Claim], ClaimAnswer | None]
) -> dict[str, ClaimAnswer]:
    """The answers to all claims: what ``sent`` gives, else a doubt since the process of each ended."""
    known: dict[str, ClaimAnswer] = {}

    def find(name: str, claim: Claim) -> ClaimAnswer:
        made = sent(name, claim) or undecided(claim, ReasonKind.PROCESS("SIGKILL"))
        return known.setdefault(name, made)

    seen: set[str] = set()
    while new := [x for x in question.batches(known) if x.name not in seen]:
        seen |= {x.name for x in new}
        for batch in new:
            [*walk_batch(batch, find)]
    return known


def test_what_is_lost_is_in_doubt(few: None) -> None:
    """Whatever claim ends its process: of coverage, of simple drives, of a component."""
    question = asked("ext", "complete")
    known = lost(question, lambda *_: None)
    assert {x.partition("-")[0] for x in known} == {"covered", "help"}
    survey = question.view(known).survey
    assert survey.verdict is Verdict.UNKNOWN
    assert {x.verdict for x in (*survey.claims, *survey.classes)} == {Verdict.UNKNOWN}
    assert all("SIGKILL" in x.reason for x in (*survey.claims, *survey.classes))
    assert all("some of the simple drives were not looked through" in x.reason for x in survey.classes)
    assert [name for name, _ in question.unknowns(known)] == [f"class {name}" for name in WANTED]
    needing = asked("complete", needed=True)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(CoverageQuestion, "is_covered", lambda *_: True)
        patch.setattr(coverage_question, "is_covered", lambda *_: True)
        patch.setattr(coverage_question, "own_definitions", lambda _: ("cutIn",))
        [need] = needing.view(lost(needing, lambda *_: None)).survey.needs
    assert need.verdict is Verdict.UNKNOWN


def test_a_folder_with_other_answers_is_left_alone(
    few: None, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "question.json").write_text('{"question": "another"}\n')
    assert run(tmp_path) == ExitCode.USAGE
    assert "holds the answers to another question" in capsys.readouterr().err
    assert [x.name for x in tmp_path.rglob("*") if x.is_file()] == ["question.json"]
    assert (tmp_path / "question.json").read_text() == '{"question": "another"}\n'


@pytest.mark.parametrize(
    ("more", "code", "message"),
    [
        (["--wider", "base"], ExitCode.USAGE, "--wider base does not extend --set ext"),
        (["--wider", "none"], ExitCode.BAD_INPUT, "there is no spec set 'none'"),
        (["--timeout", "0"], ExitCode.USAGE, "--timeout 0: write a decimal number greater than 0"),
        (["--road", "moon"], ExitCode.BAD_INPUT, "there is no road 'moon'"),
        (["--on", "nowhere"], ExitCode.BAD_INPUT, "nowhere"),
    ],
)
def test_mistakes(more: list[str], code: int, message: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["coverage", "--set", "ext", *more]) == code
    assert message in capsys.readouterr().err


# --- roadproof witness and compare from the command line --------------------------------------------


def witness(capsys, *arguments):
    code = main(list(arguments))
    captured = capsys.readouterr()
    return code, captured.out, captured.err


def test_a_drive_is_written_and_accepted(tmp_path, capsys):
    code, out, _ = witness(capsys, "witness", "4", "--out", str(tmp_path))
    assert code == 0
    assert "WITNESSED" in out
    assert {p.suffix for p in tmp_path.iterdir() if p.is_file()} == {".json", ".csv", ".svg"}
    file = load_drive(tmp_path / "scenario-04-base.json")
    assert file.scenario == 4
    rows = (tmp_path / "scenario-04-base.csv").read_text("utf-8").splitlines()
    assert rows[0] == "time,vehicle,s,d,v_lon,v_lat,a_lon,a_lat,length,width"
    assert len(rows) == 1 + 2 * 151
    assert (tmp_path / "scenario-04-base.svg").read_bytes().startswith(b"<?xml")
    assert b"<svg" in (tmp_path / "scenario-04-base.svg").read_bytes()
    assert witness(capsys, "check", str(tmp_path))[0] == 0


def test_json_has_verdicts_and_drives(tmp_path, capsys):
    target = tmp_path / "answer.json"
    sets = ("--set", "base", "--set", "ext")
    code, _, _ = witness(capsys, "witness", "3", *sets, "--jobs", "1", "--json", str(target))
    assert code == 0
    data = json.loads(target.read_text("utf-8"))
    assert data["schema"] == "roadproof/witness/1"
    assert [(v["scenario"], v["set"], v["verdict"]) for v in data["verdicts"]] == [
        (3, "base", "WITNESSED"),
        (3, "ext", "WITNESSED"),
    ]
    assert all(v["drives"][0]["schema"] == DRIVE for v in data["verdicts"])
    assert all(v["seconds"]["all"] > 0 and v["sizes"]["inequalities"] > 0 for v in data["verdicts"])


def test_a_list_of_scenarios_gives_a_drive_for_each(capsys):
    code, out, _ = witness(capsys, "witness", "3-4,7", "--jobs", "1")
    assert code == 0
    assert [line.split()[:2] for line in out.splitlines() if line.startswith("scenario")] == [
        ["scenario", "3"],
        ["scenario", "4"],
        ["scenario", "7"],
    ]
    assert out.endswith("3 of 3 witnessed in " + out.rpartition("witnessed in ")[2])
    assert witness(capsys, "witness", "1,99")[::2] == (
        3,
        "roadproof: there is no scenario 99; known scenarios: 1-24\n",
    )
    assert witness(capsys, "witness", "1-")[::2] == (
        2,
        "roadproof: '1-' is not a range of scenarios; write 1-8 or 1,3-8\n",
    )


def test_impossible_names_its_core_and_is_unexpected(capsys):
    code, out, _ = witness(capsys, "witness", "scenario_1(SV,POV,L) and scenario_4(SV,POV,L)")
    assert code == 10
    assert "IMPOSSIBLE" in out
    assert "parts that clash" in out
    assert "not sameLane(POV, SV, L)" in out


def test_none_within_prints_its_limits(capsys):
    code, out, _ = witness(capsys, "witness", "F v_lon(SV) > 41 m/s", "--road", "main-3")
    assert code == 10
    assert "NONE-WITHIN" in out
    assert "road main-3" in out


@pytest.mark.parametrize(
    ("arguments", "code", "message"),
    read_table(__file__, "mistakes_are_explained"),
)
def test_mistakes_are_explained(capsys, arguments, code, message):
    found, _, err = witness(capsys, *arguments)
    assert found == code
    assert message in err
    assert "Traceback" not in err


@pytest.mark.parametrize(
    ("arguments", "relation"),
    [
        (("scenario_3(SV,POV,L)", "scenario_4(POV,SV,L)"), "equivalent"),
        (("scenario_3(SV,POV,L)", "scenario_4(POV,SV,L)", "--set", "extA"), "incomparable"),
        (("4", "4", "--set", "base", "--set", "ext"), "stronger"),
        (("dangerArises(SV,POV)", "scenario_3(SV,POV,L)"), "weaker"),
    ],
)
def test_comparisons_come_with_evidence(capsys, tmp_path, arguments, relation):
    target, folder = tmp_path / "answer.json", tmp_path / "out"
    code, out, _ = witness(capsys, "compare", *arguments, "--json", str(target), "--out", str(folder))
    assert code == 0
    assert relation in out
    data = json.loads(target.read_text("utf-8"))
    assert data["relation"] == relation
    for direction in (data["forward"], data["backward"]):
        assert (direction["certificate"] is None) != (direction["drive"] is None)
    assert len([x for x in folder.iterdir() if x.name != "question.json"]) == 2
    assert witness(capsys, "check", str(folder))[0] == 0


# --- Work limits and the backstop on the command line: one meaning everywhere, and doubt where they end

# What is left of the time when a search begins depends on the machine.
CLOCK = re.compile(r"cut off by the clock after \S+ s, not by the count of work")
PROOF = str(Path(__file__).parents[2] / "proofs/P1-scenario-04-base.json")
# Every command that searches, with the least that it has to be asked.
SEARCHING = {
    "prove": ["P1"],
    "witness": ["4"],
    "check": [PROOF],
    "compare": ["1", "4"],
    "overlap": ["--among", "3,4"],
    "order": ["--set", "base", "--among", "3,4"],
    "redundancy": ["--among", "3"],
    "coverage": ["--set", "ext"],
    "classify": ["--among", "4"],
    "explore": ["4", "--vary", "rho=0:3"],
}
CUT_OFF = [
    ("witness", "4"),
    ("witness", "4", "--engine", "smt"),
    ("prove", "scenario_4(SV,POV,L) -> dangerArises(SV,POV)"),
    ("prove", "scenario_4(SV,POV,L) -> dangerArises(SV,POV)", "--engine", "milp"),
    ("check", PROOF),
    ("compare", "1", "4"),
    ("overlap", "--among", "3,4", "--jobs", "1"),
    ("redundancy", "--among", "3", "--jobs", "1"),
    ("order", "--set", "base", "--among", "3,4", "--jobs", "1"),
    ("explore", "4", "--vary", "rho=0:3", "--steps", "2", "--jobs", "1"),
    ("classify", "--among", "4", "--no-shares", "--jobs", "1"),
]


@pytest.mark.parametrize("line", CUT_OFF, ids=" ".join)
def test_what_the_clock_cuts_off_is_in_doubt_and_says_so(line, capfd):
    assert main([*line, "--timeout", "0.0001"]) == 20
    printed = capfd.readouterr()
    assert CLOCK.search(printed.out + printed.err)


@pytest.mark.parametrize(
    "line", [("witness", "4", "--engine", "smt"), ("prove", "P3", "--set", "base", "--no-drive")]
)
def test_what_work_cuts_off_does_not_speak_of_the_clock(line, capfd):
    assert main([*line, "--effort", "0.0001", "--json", "-"]) == 20
    verdicts = json.loads(capfd.readouterr().out)["verdicts"]
    reasons = {x["reason"].partition(";")[0] for x in verdicts if x["verdict"] == "UNKNOWN"}
    assert {x["verdict"] for x in verdicts} <= {"UNKNOWN", "PROVED"}
    assert reasons == {"no answer within 0.0001 units of work"}


@pytest.mark.parametrize("option", ["--effort", "--timeout"])
@pytest.mark.parametrize("text", ["nan", "inf", "1e300", "0", "-5", "0.0", "much", "", "1_000", "٣"])
def test_limits_that_are_no_numbers_above_zero_are_refused_by_name(option, text, capsys):
    for command, asked in SEARCHING.items():
        assert main([command, *asked, f"{option}={text}"]) == 2
        assert f"roadproof: {option} {text}: write a decimal number greater than 0" in capsys.readouterr().err


@pytest.mark.parametrize("text", ["nan", "inf", "1e300", "0", "-5", "1.5", "many"])
def test_numbers_of_processes_are_refused_by_name(text, capsys):
    for command, asked in SEARCHING.items():
        if command != "compare":
            assert main([command, *asked, f"--jobs={text}"]) == 2
            assert f"roadproof: --jobs {text}: write a whole number greater than 0" in capsys.readouterr().err


def test_limits_are_explained_in_one_way(capsys):
    explained = set()
    for command in SEARCHING:
        with pytest.raises(SystemExit):
            main([command, "--help-all"])
        words = " ".join(capsys.readouterr().out.split())
        assert "counted, so the answer is the same on every machine" in words
        explained.add(words[words.index("--timeout S seconds") :].split(")")[0])
    assert len(explained) == 1
