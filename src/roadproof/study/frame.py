"""A long question: asked in pieces, each answered by itself, kept, and taken up again.

What is asked is a ``Study``; ``conduct`` asks it, in several processes, and with a folder of evidence so that
a run that was broken off goes on where it was.
"""

from collections.abc import Callable, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Generic, Protocol, TypeVar

from roadproof.errors import InputError
from roadproof.study import pool
from roadproof.study.pool import Progress
from roadproof.study.shelf import Question, Shelf

Piece = TypeVar("Piece")
Answer = TypeVar("Answer")


class Study(Protocol[Piece, Answer]):
    """A long question. Pieces and answers are plain data that can be sent to other processes."""

    @property
    def question(self) -> Question:
        """What is asked, and on what the answers depend."""

    def pieces(self, known: Mapping[str, Answer]) -> Sequence[Piece]:
        """What is to be asked next; nothing where all that is wanted is among the ``known`` answers.

        It is asked again after all these are answered, so later pieces may rest on earlier answers, and a
        doubt may be asked again.
        """

    def settle(self, piece: Piece) -> Mapping[str, Answer]:
        """The answers to a piece by name, in a process of its own; doubts where the clock cuts it off."""

    def doubt(self, piece: Piece, reason: str) -> Mapping[str, Answer]:
        """The answers to a piece that nothing is known of."""

    def is_sure(self, answer: Answer) -> bool:
        """Whether an answer stands; others are asked again by the next run into the same folder."""

    def record(self, name: str, answer: Answer, shelf: Shelf) -> dict[str, Any]:
        """An answer as plain data; its evidence goes to the shelf."""

    def recall(self, record: Mapping[str, Any], shelf: Shelf) -> tuple[str, Answer]:
        """The inverse of ``record``, with the name that is told from what it says.

        Raises ``InputError`` where it is no whole answer.
        """


@dataclass(frozen=True)
class Conducted(Generic[Answer]):
    """All answers by name, and the same as plain data; evidence that has a file is named by its path."""

    answers: Mapping[str, Answer]
    records: Mapping[str, Mapping[str, Any]]


def put_away(study: Study[Piece, Answer], answers: Mapping[str, Answer], folder: Path) -> Conducted[Answer]:
    """The same answers, kept in a folder. Raises ``UsageError`` where it holds those to another question."""
    shelf = Shelf(folder, study.question)
    records = {
        name: shelf.keep(name, study.record(name, answer, shelf), study.is_sure(answer))
        for name, answer in answers.items()
    }
    return Conducted(answers, {name: shelf.with_paths(record) for name, record in records.items()})


def conduct(
    study: Study[Piece, Answer],
    folder: Path | None = None,
    processes: int | None = None,
    progress: Progress | None = None,
    what: str = "pieces",
    say: Callable[[str], None] | None = None,
    each: Callable[[str, Answer], None] | None = None,
) -> Conducted[Answer]:
    """Ask all pieces that a folder does not have the answers of. ``processes`` None is one a core.

    ``what`` is the word for many pieces, for ``progress``; ``say`` is told of kept answers that do not
    count, ``each`` of every answer with its name: of kept ones first, then of others as they come. Raises
    ``UsageError`` where the folder holds the answers to another question, and what ``study.settle`` raises.
    """
    shelf = Shelf(folder, study.question)
    records: dict[str, dict[str, Any]] = {}
    known: dict[str, Answer] = {}
    for file, record in shelf.answers(say):
        try:
            name, answer = study.recall(record, shelf)
            if name != file:
                raise InputError(f"the answer '{file}' is that of '{name}'")
        except InputError as error:
            if say is not None:
                say(f"asked again, since a kept answer does not count: {error}")
            continue
        records[name], known[name] = dict(record), answer
        if each is not None:
            each(name, answer)
    while pieces := study.pieces(known):
        with closing(pool.work(study.settle, pieces, processes, study.doubt, progress, what)) as answered:
            for _, answers in answered:
                for name, answer in answers.items():
                    made = study.record(name, answer, shelf)
                    records[name] = shelf.keep(name, made, study.is_sure(answer))
                    known[name] = answer
                    if each is not None:
                        each(name, answer)
    return Conducted(known, {name: shelf.with_paths(record) for name, record in records.items()})
