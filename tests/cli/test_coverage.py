"""``roadproof coverage``: evidence in files, runs that go on, pictures, and mistakes."""

import json
from pathlib import Path

import pytest

from planting import plant
from roadproof.analysis.coverage import claims, classes, settling
from roadproof.analysis.coverage.classes import Found, Group, Survey, groups_of
from roadproof.analysis.requests import Asked
from roadproof.cli import coverage
from roadproof.cli.coverage_files import Evidence
from roadproof.cli.main import main
from roadproof.errors import UsageError
from roadproof.verdict import ExitCode

WANTED = ("behaviourPOV_4", "behaviourSV_8")
"""Components that are asked for here, without their conditions: the rest takes minutes."""


@pytest.fixture
def few(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Few classes, one claim, a part of the catalogue; what comes is the roads that were looked up in it."""
    roads: list[str] = []
    every, look_up = groups_of, settling.find_in_catalogue

    def some_groups(survey: Survey) -> list[Group]:
        return [Group(x.component) for x in every(survey) if x.name in WANTED]

    def some_drives(survey: Survey, road: str, start: int, step: int) -> list[Found]:
        roads.append(road)
        return look_up(survey, road, 0, 97) if start == 0 and road == "main-2" else []

    monkeypatch.setattr(claims, "claims_of", lambda _: ("F danger(SV,POV) -> scenario_1(SV,POV,L)",))
    monkeypatch.setattr(classes, "groups_of", some_groups)
    monkeypatch.setattr(settling, "find_in_catalogue", some_drives)
    return roads


def run(out: Path, *more: str) -> int:
    command = ["coverage", "--set", "ext", "--jobs", "1", "--effort", "0.2", "--out", str(out), *more]
    return main(command)


def test_evidence_in_files_and_going_on(
    few: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out"
    assert run(out, "--road", "main-2") == ExitCode.UNEXPECTED
    printed = capsys.readouterr().out
    assert "scenario 4, behaviourPOV_4: POV ahead is slower" in printed
    assert "complete: cutIn" in printed
    data = json.loads((out / "index.json").read_text())
    assert (data["schema"], data["verdict"], data["wider"]) == ("roadproof/coverage/1", "GAPS", ["complete"])
    by_key = {(x["component"], x["condition"]): x for x in data["classes"]}
    assert by_key["behaviourSV_8", ""]["verdict"] == "IMPOSSIBLE"
    first = by_key["behaviourPOV_4", ""]
    assert first["verdict"] == "WITNESSED"
    assert all(gap["drive"].endswith(".json") for gap in data["gaps"])
    assert data["gaps"][first["gaps"][0] - 1]["elsewhere"].keys() >= {"main-3", "merge", "depart"}
    assert len(list(out.glob("gap-*.png"))) == len(data["gaps"])
    assert main(["check", str(out), "--jobs", "1"]) == 0
    few.clear()
    assert run(out, "--road", "main-2", "--no-pictures") == ExitCode.UNEXPECTED
    again = json.loads((out / "index.json").read_text())
    assert [x["certificate"] for x in again["classes"]] == [x["certificate"] for x in data["classes"]]
    assert len((out / "answers.jsonl").read_text().splitlines()) == 1 + len(WANTED)
    assert few == []


def neither_gap_nor_proof(monkeypatch: pytest.MonkeyPatch, out: Path) -> tuple[int, str]:
    """Exit code and verdict where one of two claims is not proved and the one class asked for is empty."""
    some = ("danger(SV,POV) -> danger(POV,SV)", "F danger(SV,POV) -> scenario_1(SV,POV,L)")
    monkeypatch.setattr(claims, "claims_of", lambda _: some)
    every = groups_of

    def one_group(survey: Survey) -> list[Group]:
        return [Group(x.component) for x in every(survey) if x.name == "behaviourSV_8"]

    monkeypatch.setattr(classes, "groups_of", one_group)
    monkeypatch.setattr(settling, "find_in_catalogue", lambda *_: [])
    code = run(out, "--no-pictures")
    data = json.loads((out / "index.json").read_text())
    assert data["gaps"] == []
    return code, data["verdict"]


def test_neither_gap_nor_proof_is_unknown(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    assert neither_gap_nor_proof(monkeypatch, tmp_path / "out") == (ExitCode.UNKNOWN, "UNKNOWN")


FAULTS = [
    (
        "ExitCode.UNEXPECTED if gaps else ExitCode.UNKNOWN",
        "ExitCode.UNEXPECTED if gaps else ExitCode.AS_EXPECTED",
    ),
    ("ExitCode.AS_EXPECTED if proved else", "ExitCode.AS_EXPECTED if not gaps else"),
    ("str(Verdict.COVERED)\n        if proved", "str(Verdict.COVERED)\n        if not gaps"),
    ("proved = all(", "proved = any("),
]


@pytest.mark.parametrize(("right", "wrong"), FAULTS)
def test_a_doubt_that_passes_for_an_answer_is_noticed(
    right: str, wrong: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    plant(monkeypatch, coverage, "_answer", right, wrong)
    assert neither_gap_nor_proof(monkeypatch, tmp_path / "out") != (ExitCode.UNKNOWN, "UNKNOWN")


def test_answers_that_compare_with_other_sets_are_not_taken_over(tmp_path: Path) -> None:
    """Which set is the first to catch a drive is part of an answer, so it depends on the sets compared."""
    asked = Asked(("base",))
    Evidence(tmp_path, Survey(asked, ("extA", "ext")))
    Evidence(tmp_path, Survey(asked, ("extA", "ext"), roads=("main-3",)))
    with pytest.raises(UsageError, match="another question"):
        Evidence(tmp_path, Survey(asked, ("extA", "ext", "complete")))


def test_a_folder_with_other_answers_is_left_alone(
    few: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "answers.jsonl").write_text('{"question": "another"}\n')
    assert run(tmp_path) == ExitCode.USAGE
    assert "holds the answers to another question" in capsys.readouterr().err
    assert [x.name for x in tmp_path.iterdir()] == ["answers.jsonl"]


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
