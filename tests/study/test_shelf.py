"""Kept answers, one file each: only those count that are as they were written, and of this very question."""

import json
from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from evidence.folders import changes, check, places
from roadproof.analysis.basis import Basis
from roadproof.analysis.overlap import Overlap, PairVerdict, name_of
from roadproof.analysis.study.evidence_store import EvidenceStore, Question
from roadproof.analysis.study.frame import conduct
from roadproof.errors import UsageError
from roadproof.evidence.answers.overlap import Record
from roadproof.evidence.codec import read, write
from roadproof.evidence.finding import Acceptance
from roadproof.evidence.journal import ANSWERS, HEAD, seal_of
from roadproof.frontends.cli.main import main
from roadproof.library.loading import build_library, bundled_library
from roadproof.library.scenarios import Scenario
from roadproof.library.specification import Source
from roadproof.verdict import Verdict

BASIS = Basis(bundled_library().select())
PAIRS = ((Scenario(3, "base"), Scenario(4, "base")), (Scenario(5, "base"), Scenario(6, "base")))
STUDY = Overlap(BASIS, PAIRS)
FIRST, SECOND = (name_of(*pair) for pair in PAIRS)


@cache
def answers() -> dict[str, PairVerdict]:
    return dict(conduct(STUDY, hands=1).answers)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder as a run leaves it that was broken off before its index."""
    made = tmp_path / "out"
    shelf = EvidenceStore(made, STUDY.question)
    for name, answer in answers().items():
        shelf.keep(name, write(STUDY.record(name, answer, shelf)), STUDY.is_sure(answer))
    return made


def kept(folder: Path, question: Question | None = None) -> tuple[list[str], list[str]]:
    """The names of the answers that count, and what is told of the others."""
    told: list[str] = []
    found = [name for name, _ in EvidenceStore(folder, question or STUDY.question).answers(told.append)]
    return found, told


def file_of(folder: Path, name: str = FIRST) -> Path:
    return folder / ANSWERS / f"{name}.json"


def record_of(folder: Path, name: str = FIRST) -> Any:
    return json.loads(file_of(folder, name).read_text("utf-8"))


def test_answers_are_kept_and_checked(folder: Path) -> None:
    assert kept(folder) == ([FIRST, SECOND], [])
    findings = check(folder)
    assert [(x.outcome, x.verdict, x.label) for x in findings] == [
        (Acceptance.ACCEPTED, "IMPOSSIBLE", "scenarios 3@base and 4@base"),
        (Acceptance.ACCEPTED, "IMPOSSIBLE", "scenarios 5@base and 6@base"),
    ]


def test_what_is_kept_comes_back_as_it_was(folder: Path) -> None:
    shelf = EvidenceStore(folder, STUDY.question)
    records = (read(Record, content, "a kept answer") for _, content in shelf.answers())
    found = dict(STUDY.recall(record, shelf) for record in records)
    for name, answer in answers().items():
        assert found[name].certificate == answer.certificate
        assert found[name].query is not None
        assert answer.query is not None
        assert found[name].query.formula == answer.query.formula
        assert [core.told for core in found[name].cores] == [core.told for core in answer.cores]


def test_nothing_that_is_kept_is_asked_again(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Overlap, "settle", lambda *_: pytest.fail("asked again"))
    found = conduct(STUDY, folder)
    assert [x.verdict for x in found.answers.values()] == [Verdict.IMPOSSIBLE] * 2
    told = found.as_data(found.records[FIRST])["verdict"]
    assert told["certificate"] == str(folder / f"impossible-{FIRST}.json")


def test_a_folder_may_be_moved(folder: Path, tmp_path: Path) -> None:
    moved = folder.rename(tmp_path / "moved")
    assert kept(moved) == ([FIRST, SECOND], [])


def test_no_change_of_an_answer_counts(folder: Path) -> None:
    """With the seal that was there; and, where it says something else, with one that was made anew."""
    head, first = json.loads((folder / HEAD).read_text("utf-8")), record_of(folder)
    told_only = ("verdict.core", "verdict.cores", "verdict.reason", "verdict.seconds")
    tried, counting = 0, []
    for place in places(first):
        for word, changed in changes(first, place):
            name = f"{'.'.join(map(str, place))}: {word}"
            tried += 1
            file_of(folder).write_text(json.dumps(changed), "utf-8")
            assert kept(folder)[0] == [SECOND], name
            if name.startswith(told_only) or "evidence" not in changed or place[0] in ("seal", "evidence"):
                continue
            try:
                sealed = {**changed, "seal": seal_of(changed, head["question"], folder)}
            except (TypeError, ValueError):
                continue
            file_of(folder).write_text(json.dumps(sealed), "utf-8")
            if kept(folder)[0] != [SECOND]:
                counting.append(name)
    assert tried > 150
    assert counting == []


def test_a_changed_answer_is_rejected_by_check(folder: Path) -> None:
    text = file_of(folder).read_text("utf-8")
    file_of(folder).write_text(text.replace("IMPOSSIBLE", "WITNESSED"), "utf-8")
    assert any(x.outcome is Acceptance.REJECTED and "seal" in x.reason for x in check(folder))


def test_other_evidence_is_found_under_a_new_seal(folder: Path) -> None:
    head, first = json.loads((folder / HEAD).read_text("utf-8")), record_of(folder)
    other = (folder / f"impossible-{SECOND}.json").read_bytes()
    (folder / f"impossible-{FIRST}.json").write_bytes(other)
    sealed = {**first, "seal": seal_of(first, head["question"], folder)}
    file_of(folder).write_text(json.dumps(sealed), "utf-8")
    names, told = kept(folder)
    assert names == [SECOND]
    assert "but its file" in told[0]
    assert any("but its file" in x.reason for x in check(folder))


@pytest.mark.parametrize("gone", [f"impossible-{FIRST}.json", f"{ANSWERS}/{FIRST}.json"])
def test_what_is_gone_is_asked_again(folder: Path, gone: str) -> None:
    (folder / gone).unlink()
    assert kept(folder)[0] == [SECOND]


def test_an_answer_under_another_name_is_no_other_answer(folder: Path) -> None:
    """Each name is that of a pair, and a pair is asked by its name."""
    file_of(folder).rename(file_of(folder, "base-07-base-08"))
    other = Overlap(BASIS, ((Scenario(7, "base"), Scenario(8, "base")),))
    found = conduct(other, folder, hands=1)
    (verdict,) = other.verdicts(found.answers)
    assert (verdict.a.number, verdict.b.number) == (7, 8)


def other_questions() -> Iterator[tuple[str, Question]]:
    library = bundled_library()

    def under(basis: Basis) -> Question:
        return Overlap(basis, PAIRS).question

    def added(text: str) -> Question:
        return under(Basis(build_library([Source("m", text)], library).select()))

    yield "another value", under(replace(BASIS, values={"rho": Fraction(1)}))
    yield "another reading", under(Basis(library.select("base", {"lateral_sign": "literal"})))
    yield "another set", under(Basis(library.select("ext")))
    yield "another library", added("def danger(a, b: vehicle) := true")
    yield "another default", added("param rho = 1 s where rho >= 0")
    yield "another bound", added("param rho = 0.6 s where rho > 0")
    yield "another order of readings", added("option lateral_sign = literal | rss")
    yield "another analysis", replace(STUDY.question, schema="roadproof/redundancy/1")


OTHERS = dict(other_questions())


@pytest.mark.parametrize("other", OTHERS.values(), ids=OTHERS.keys())
def test_answers_to_another_question_are_not_taken_over(folder: Path, other: Question) -> None:
    with pytest.raises(UsageError, match="the answers to another question"):
        kept(folder, other)


def test_answers_of_another_version_are_not_taken_over(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("roadproof.evidence.heading.version", lambda name: "0.0.0")
    with pytest.raises(UsageError, match="the answers to another question"):
        kept(folder)


def test_planted_seals_that_are_not_compared_are_noticed(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    first = record_of(folder)
    slower = {**first, "verdict": {**first["verdict"], "seconds": 9.0}}
    file_of(folder).write_text(json.dumps(slower), "utf-8")
    with monkeypatch.context() as patch:
        patch.setattr("roadproof.evidence.journal.seal_of", lambda record, question, folder: record["seal"])
        assert kept(folder)[0] == [FIRST, SECOND]
    assert kept(folder)[0] == [SECOND]


def test_planted_evidence_that_is_not_looked_at_is_noticed(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    head, first = json.loads((folder / HEAD).read_text("utf-8")), record_of(folder)
    wrong = {**first, "verdict": {**first["verdict"], "verdict": "WITNESSED"}}
    sealed = {**wrong, "seal": seal_of(wrong, head["question"], folder)}
    file_of(folder).write_text(json.dumps(sealed), "utf-8")
    with monkeypatch.context() as patch:
        patch.setattr("roadproof.evidence.journal.read_record", lambda *_: [])
        patch.setattr("roadproof.evidence.journal.faults_of_line", lambda *_: iter(()))
        assert kept(folder)[0] == [FIRST, SECOND]
    assert kept(folder)[0] == [SECOND]


def test_copies_of_specification_files_lie_beside_the_evidence(tmp_path: Path) -> None:
    mine = tmp_path / "mine.spec"
    mine.write_text("def near(a, b: vehicle) := s(a) - s(b) < 10 m\n")
    out = tmp_path / "out"
    assert main(["overlap", "--among", "5,6", "--spec", str(mine), "--out", str(out), "--no-pictures"]) == 0
    assert (out / "mine.spec").read_text() == mine.read_text()
    assert json.loads((out / "index.json").read_text())["specs"] == ["mine.spec"]
    assert main(["check", str(out)]) == 0
