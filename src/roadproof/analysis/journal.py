"""Answers kept as they come, so that a run that was broken off goes on where it was.

A folder holds the evidence files of the answers (certificates and drives) and ``answers.jsonl``: a first
line that says what was asked, then a line for each answer with the names of its files.
"""

import hashlib
import json
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from roadproof.errors import InputError, UsageError
from roadproof.spec.library import Library

NAME = "answers.jsonl"


def fingerprint(library: Library, question: Mapping[str, str]) -> str:
    """A short text that changes with the question and with any text of the library."""
    texts = sorted({source.text for source in library.sources.values()})
    return hashlib.sha256(json.dumps([dict(question), texts], sort_keys=True).encode()).hexdigest()[:16]


class Journal:
    """The answers to one question in a folder; raises ``UsageError`` where it holds another's."""

    def __init__(self, folder: Path, question: str) -> None:
        self.folder = folder
        self.path = folder / NAME
        self.question = question
        try:
            folder.mkdir(parents=True, exist_ok=True)
            if not self.path.exists():
                self._append({"question": question})
        except OSError as error:
            raise InputError(
                f"cannot write into {folder}: {error.strerror}; name another folder with --out"
            ) from None

    def answers(self) -> list[dict[str, Any]]:
        """The answers whose evidence files are all still there; a last line cut short is left out.

        An answer without evidence is a doubt, to be asked again.
        """
        try:
            lines = self.path.read_text("utf-8").splitlines()
        except (OSError, UnicodeDecodeError) as error:
            raise InputError(f"cannot read {self.path}: {error}") from None
        entries = [entry for line in lines if (entry := _parsed(line)) is not None]
        if not entries or entries[0].get("question") != self.question:
            raise UsageError(
                f"{self.folder} holds the answers to another question, or to this one under another library: "
                f"name another folder with --out, or remove {self.path}"
            )
        return [e for e in entries[1:] if e.get("evidence") and self._all_there(e["evidence"])]

    def add(self, answer: Mapping[str, Any]) -> None:
        """Append one answer; the files that ``evidence`` names have been written before."""
        self._append(answer)

    def _all_there(self, names: Sequence[str]) -> bool:
        return all((self.folder / name).is_file() for name in names)

    def _append(self, entry: Mapping[str, Any]) -> None:
        torn = self.path.exists() and self.path.stat().st_size > 0 and not self._ends_well()
        with self.path.open("a", encoding="utf-8") as file:
            file.write(("\n" if torn else "") + json.dumps(entry, ensure_ascii=False) + "\n")
            file.flush()
            os.fsync(file.fileno())

    def _ends_well(self) -> bool:
        with self.path.open("rb") as file:
            file.seek(-1, os.SEEK_END)
            return file.read(1) == b"\n"


def _parsed(line: str) -> dict[str, Any] | None:
    try:
        entry = json.loads(line)
    except ValueError:
        return None
    return entry if isinstance(entry, dict) else None
