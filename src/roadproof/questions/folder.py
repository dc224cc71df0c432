"""Begins a folder of answers, or goes on in it: ``question.json`` and the specification files beside it."""

import json
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any, Self

from roadproof.errors import InputError, UsageError
from roadproof.evidence.heading import library_of
from roadproof.evidence.specifications import specification_names, write_specifications
from roadproof.evidence.strict import LARGEST_INDEX, Fields, read_json
from roadproof.library.specification import Library
from roadproof.questions.data import basis_data, question_data, read_question
from roadproof.questions.question import QUESTION, Growing, Question, Replacing
from roadproof.runtime.files import make_folder, write_atomic, write_json
from roadproof.runtime.pool import Say
from roadproof.runtime.records import dataclass


def open_folder(
    folder: Path, question: Question[Any], remove_answers: Callable[[], None], say: Say | None
) -> None:
    """Write ``question.json``, or go on in a folder; ``say`` is told of answers that others displace.

    ``remove_answers`` is called where the question replaces another. Raises ``UsageError`` where the folder
    holds another question's answers.
    """
    make_folder(folder)
    write_specifications(folder, question.basis.library)
    head = folder / QUESTION
    former: Any = read_json(head, LARGEST_INDEX) if head.exists() else None
    if former is not None and isinstance(question, Growing):
        question = _grown(folder, question, say)
    data = json.loads(json.dumps(question_data(question)))
    if former is None or isinstance(question, Growing):
        write_json(head, data)
    elif former != data:
        if not isinstance(question, Replacing) or former.get("question") != question.kind:
            raise _other(folder)
        remove_answers()
        write_json(head, data)


@dataclass(frozen=True)
class FormerFolder:
    """A folder before a run: the names in it, None where it was not there, and its question."""

    names: frozenset[str] | None
    question: bytes | None

    @classmethod
    def of(cls, folder: Path) -> Self:
        """Return what is there."""
        head = folder / QUESTION
        names = frozenset(x.name for x in folder.iterdir()) if folder.is_dir() else None
        return cls(names, head.read_bytes() if head.is_file() else None)

    def restore(self, folder: Path, library: Library) -> None:
        """Write the question back, or remove what ``open_folder`` has begun; answers stay with theirs."""
        head = folder / QUESTION
        if self.question is not None:
            write_atomic(head, self.question)
        elif not [x for x in folder.glob("*.json") if x != head]:
            for name in {QUESTION, *specification_names(library)} - (self.names or frozenset()):
                (folder / name).unlink(missing_ok=True)
            if self.names is None:
                with suppress(OSError):
                    folder.rmdir()


def _grown(folder: Path, question: Any, say: Say | None) -> Any:
    """Return the question with former ones of the folder; displaced ones and their views are removed."""
    former = _former(folder, question)
    for name in question.displaced(former):
        if say is not None and (folder / f"{name}.json").exists():
            say(f"the answer '{name}' is that to another search, which this one displaces")
        for path in folder.glob(f"{name}.*"):
            path.unlink()
    return question.beside(former)


def _former(folder: Path, question: Question[Any]) -> Question[Any]:
    """Return the question of the folder. Raises ``UsageError`` where it is of another kind or library."""
    try:
        former = read_question(folder)
    except InputError:
        raise _other(folder) from None
    head = folder / QUESTION
    library = library_of(Fields(read_json(head, LARGEST_INDEX), str(head)))
    is_same = former.kind == question.kind and library == question.basis.library.fingerprint
    if not is_same or basis_data(former.basis) != basis_data(question.basis):
        raise _other(folder)
    return former


def _other(folder: Path) -> UsageError:
    return UsageError(
        f"{folder} holds the answers to another question, or to this one under another library: "
        "name another folder with --out, or remove it"
    )
