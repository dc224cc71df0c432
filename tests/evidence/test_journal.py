"""Journals as they are read: lines with their numbers, a last line that was cut short, and their answers."""

import json
from pathlib import Path
from typing import Any

import pytest

from evidence.folders import check
from roadproof.errors import InputError
from roadproof.evidence.finding import Acceptance
from roadproof.evidence.journal import NAME, Journal, head_of, read_journal, seal_of

SCHEMA = "roadproof/overlap/1"
SAID: dict[str, Any] = {"set": "base", "lanes": "same", "roles": "same", "start": "same", "options": {}}
SAID |= {"parameters": {}, "specs": []}
NO_EVIDENCE = {"certificate": None, "drive": None}
HEAD = head_of(SCHEMA, "which?", SAID)


def answer(a: int, b: int, folder: Path) -> dict[str, Any]:
    """An answer that promises nothing, so that no file is needed."""
    pair = {"a": a, "b": b, "set_a": "base", "set_b": "base", "verdict": "UNKNOWN", "formula": "true"}
    record: dict[str, Any] = {"evidence": [], "verdict": {**pair, "core": [], "cores": [], **NO_EVIDENCE}}
    return {**record, "seal": seal_of(record, "which?", folder)}


def written(folder: Path, end: str = "\n") -> Journal:
    lines = [HEAD, answer(1, 2, folder), answer(3, 4, folder)]
    (folder / NAME).write_text("\n".join(map(json.dumps, lines)) + end, "utf-8")
    return read_journal(folder / NAME)


def test_lines_are_numbered_as_in_the_file(tmp_path: Path) -> None:
    journal = written(tmp_path)
    assert [(int(x.name), x.fault) for x in journal.lines] == [(2, ""), (3, "")]
    assert not journal.torn


@pytest.mark.parametrize(
    ("end", "numbers"),
    [
        ("", [2, 3]),  # whole, but for the end of its line
        ('\n{"evidence": [], "ver', [2, 3]),
        ("\n\n\n", [2, 3]),
    ],
)
def test_a_last_line_that_was_cut_short_does_not_count(end: str, numbers: list[int], tmp_path: Path) -> None:
    journal = written(tmp_path, end)
    assert [int(x.name) for x in journal.lines] == numbers
    assert journal.torn == (not end.endswith("\n"))
    assert all(not x.fault for x in journal.lines)


def test_a_line_that_is_damaged_in_the_middle_is_told(tmp_path: Path) -> None:
    written(tmp_path)
    head, first, second = (tmp_path / NAME).read_text("utf-8").splitlines()
    (tmp_path / NAME).write_text(f"{head}\n{first[:-9]}\n{second}\n", "utf-8")
    journal = read_journal(tmp_path / NAME)
    assert [(int(x.name), bool(x.fault)) for x in journal.lines] == [(2, True), (3, False)]
    assert "line 2" in journal.lines[0].fault


def test_a_journal_of_one_line_has_no_answers(tmp_path: Path) -> None:
    for end in ("", "\n"):
        (tmp_path / NAME).write_text(json.dumps(HEAD) + end, "utf-8")
        journal = read_journal(tmp_path / NAME)
        assert (journal.lines, journal.torn) == ((), False)


def test_a_seal_is_of_the_answer_and_the_question(tmp_path: Path) -> None:
    written(tmp_path)
    text = (tmp_path / NAME).read_text("utf-8")
    for old, new in (('"a": 1', '"a": 5'), ("which?", "what?")):
        (tmp_path / NAME).write_text(text.replace(old, new), "utf-8")
        assert "not what its seal was made for" in read_journal(tmp_path / NAME).lines[0].fault


def test_what_is_no_journal_is_refused(tmp_path: Path) -> None:
    for head in ({**HEAD, "schema": "roadproof/journal/9"}, {**HEAD, "of": "roadproof/nothing/1"}):
        (tmp_path / NAME).write_text(json.dumps(head) + "\n", "utf-8")
        with pytest.raises(InputError, match=r"schema=|there are journals of"):
            read_journal(tmp_path / NAME)


def test_a_folder_with_a_journal_alone_is_what_the_journal_says(tmp_path: Path) -> None:
    written(tmp_path)
    found = check(tmp_path)
    assert {x.outcome for x in found} == {Acceptance.ACCEPTED}
    assert [x.label for x in found] == ["scenarios 1@base and 2@base", "scenarios 3@base and 4@base"]
