"""Answers kept as they come, so that a run that was broken off goes on where it was.

A folder holds the evidence files of the answers (certificates and drives) and ``answers.jsonl``, a journal as
``evidence/journal.py`` reads it. An answer counts again only where its seal holds and it says what its
evidence says; others are told of, and asked again.
"""

import json
import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from roadproof.errors import InputError, UsageError
from roadproof.evidence.journal import NAME, answers_of, head_of, read_journal, seal_of
from roadproof.files import make_folder, write_whole
from roadproof.study.shelf import Question, inside


def on_stderr(text: str) -> None:
    import sys

    print(text, file=sys.stderr, flush=True)


class Journal:
    """The answers to one question in a folder; raises ``UsageError`` where it holds another's."""

    def __init__(self, folder: Path, question: Question) -> None:
        self.folder = folder
        self.path = folder / NAME
        self.question = question.fingerprint
        self.library = question.library
        self.head = head_of(question.schema, self.question, question.said)
        make_folder(folder)
        if not self.path.exists():
            self._write([self.head])

    def answers(self, say: Callable[[str], None] = on_stderr) -> list[dict[str, Any]]:
        """The answers that count; those that do not are told of by ``say``, and removed.

        An answer without evidence is a doubt, to be asked again. A last line cut short is left out.
        """
        kept: list[dict[str, Any]] = []
        try:
            journal = read_journal(self.path)
        except InputError as error:
            raise UsageError(self._foreign(f"it is no journal of this version ({error})")) from None
        if journal.head.content != self.head:
            raise UsageError(self._foreign("to this one under another library"))
        for line in answers_of(journal, self.library):
            if line.fault:
                say(f"asked again, since a kept answer does not count: {line.fault}")
            elif line.record is not None and line.record.items("evidence"):
                kept.append(line.record.content)
        self._write([self.head, *kept])
        return [self._with_paths(record, set(record["evidence"])) for record in kept]

    def _foreign(self, otherwise: str) -> str:
        return (
            f"{self.folder} holds the answers to another question, or {otherwise}: name another folder with "
            f"--out, or remove {self.path}"
        )

    def add(self, answer: Mapping[str, Any]) -> None:
        """Append one answer under its seal; the files that ``evidence`` names have been written before."""
        record = inside(dict(answer), self.folder)
        record["seal"] = seal_of(record, self.question, self.folder)
        with self.path.open("a", encoding="utf-8") as file:
            file.write(_line(record))
            file.flush()
            os.fsync(file.fileno())

    def _write(self, records: list[dict[str, Any]]) -> None:
        write_whole(self.path, "".join(map(_line, records)).encode())

    def _with_paths(self, data: Any, names: set[str]) -> Any:
        """``data`` with the names of evidence files as paths from here."""
        match data:
            case dict():
                return {k: v if k == "evidence" else self._with_paths(v, names) for k, v in data.items()}
            case list():
                return [self._with_paths(item, names) for item in data]
            case str() if data in names:
                return str(self.folder / data)
            case _:
                return data


def _line(record: Mapping[str, Any]) -> str:
    return json.dumps(record, ensure_ascii=False) + "\n"
