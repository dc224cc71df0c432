"""A long question: asked in pieces, each answered by itself, kept, and taken up again.

What is asked is a ``Study``; ``conduct`` asks it, in several processes, and with a folder of evidence so that
a run that was broken off goes on where it was.
"""

from collections.abc import Callable, Collection, Container, Iterator, Mapping, Sequence
from contextlib import closing
from pathlib import Path
from typing import Any, Generic, Protocol, TypeVar, runtime_checkable

from roadproof.analysis.study import pool
from roadproof.analysis.study.evidence_store import EvidenceStore, EvidenceTexts, Question
from roadproof.analysis.study.known import KnownAnswer, KnownAnswers
from roadproof.analysis.study.known import told as told_known
from roadproof.analysis.study.pool import Progress
from roadproof.errors import InputError, SharedError, UsageError
from roadproof.evidence.codec import read, write
from roadproof.evidence.strict import JsonObject
from roadproof.reasons import NO_REASON, Reason
from roadproof.runtime.archives import Origin, is_off
from roadproof.runtime.executors import Jobs, Shard, hands_of
from roadproof.runtime.records import dataclass

Piece = TypeVar("Piece")
Answer = TypeVar("Answer")
Record = TypeVar("Record")
Given = TypeVar("Given", contravariant=True)
Group = TypeVar("Group")


class Study(Protocol[Piece, Answer, Record]):
    """A long question. Pieces and answers are plain data that can be sent to other processes.

    A ``Record`` is an answer as it is kept, a definition of ``evidence.answers``.
    """

    @property
    def record_type(self) -> type[Record]:
        """The definition of a kept answer."""

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

    def doubt(self, piece: Piece, reason: Reason) -> Mapping[str, Answer]:
        """The answers to a piece that nothing is known of."""

    def is_sure(self, answer: Answer) -> bool:
        """Whether an answer stands; others are asked again by the next run into the same folder."""

    def wanted(self, known: Mapping[str, Answer]) -> Collection[str]:
        """The names of all answers that the question may need, as far as the ``known`` ones tell."""

    def key(self, name: str) -> str | None:
        """A digest of what an answer depends on besides ``question``: limits, definitions; None where none is
        known before it is asked for.
        """

    def prepare(self) -> None:
        """Import what workers need, once, before they are forked."""

    def record(self, name: str, answer: Answer, shelf: EvidenceStore) -> Record:
        """An answer as it is kept; its evidence goes to the shelf."""

    def recall(self, record: Record, shelf: EvidenceStore) -> tuple[str, Answer]:
        """The inverse of ``record``, with the name that is told from what it says.

        Raises ``InputError`` where it is no whole answer.
        """


@runtime_checkable
class DoubtKeeper(Protocol[Given]):
    """A study some of whose doubts are the same whenever they are asked again: later runs get them."""

    def is_lasting(self, answer: Given) -> bool:
        """Whether an answer is kept for later runs."""


@runtime_checkable
class GroupedStudy(Protocol[Group]):
    """A study some of whose pieces are groups of questions that can be asked alone, too."""

    def parts(self, piece: Group) -> Sequence[Group]:
        """The pieces that are asked instead where the process of a group ended; one where it is no group."""


class Unprepared:
    """A study of which no answer is known before it is asked, and whose workers need nothing beforehand."""

    def wanted(self, known: Mapping[str, Any]) -> Collection[str]:
        return ()

    def key(self, name: str) -> str | None:
        return None

    def prepare(self) -> None:
        pass


@dataclass(frozen=True)
class StudyResult(Generic[Answer, Record]):
    """All answers by name, and the same as they are kept; ``shelf`` has their evidence.

    ``known``: for each answer that was known before the question was asked, from where.
    """

    answers: Mapping[str, Answer]
    records: Mapping[str, Record]
    shelf: EvidenceStore
    known: tuple[Origin, ...] = ()

    def as_data(self, answer: object) -> JsonObject:
        """An answer made of the records as plain data; evidence that has a file is named by its path."""
        return dict(self.shelf.with_paths(write(answer)))


def put_away(
    study: Study[Piece, Answer, Record], answers: Mapping[str, Answer], folder: Path
) -> StudyResult[Answer, Record]:
    """The same answers, kept in a folder. Raises ``UsageError`` where it holds those to another question."""
    shelf = EvidenceStore(folder, study.question)
    records = {name: _keep(study, name, answer, shelf) for name, answer in answers.items()}
    return StudyResult(answers, records, shelf)


def _keep(study: Study[Piece, Answer, Record], name: str, answer: Answer, shelf: EvidenceStore) -> Record:
    record = study.record(name, answer, shelf)
    shelf.keep(name, write(record, timed=False), study.is_sure(answer))
    return record


def conduct(
    study: Study[Piece, Answer, Record],
    folder: Path | None = None,
    hands: Jobs = None,
    progress: Progress | None = None,
    what: str = "pieces",
    say: Callable[[str], None] | None = None,
    each: Callable[[str, Answer], None] | None = None,
    fresh: bool = False,
) -> StudyResult[Answer, Record]:
    """Ask all pieces that a folder does not have the answers of; ``hands``: who does the work.

    Of several runs that divide the question each asks its share, and takes over what others have kept in the
    same folder. ``what`` is the word for many pieces, for ``progress``; ``say`` is told of kept answers that
    do not count, ``each`` of every answer with its name: of kept ones first, then of others as they come.
    Answers that are known (``study.known``) are not asked for, unless ``fresh``.
    Raises ``UsageError`` where the folder holds the answers to another question, ``SharedError`` where the
    rest is for other runs, and what ``study.settle`` raises.
    """
    shard = hands_of(hands).shard
    if shard is not None and folder is None:
        raise UsageError(f"--shard {shard} requires --out, the folder that the runs share")
    run = _Run(study, EvidenceStore(folder, study.question), say, each, fresh)
    run.take_over()
    run.look_up()
    if say is not None:
        for line in told_known(run.origins, len(study.wanted(run.known))):
            say(line)
    is_ours = _share(study, shard)
    while pieces := study.pieces(run.known):
        if run.look_up():
            continue
        ours = [piece for piece in pieces if is_ours(piece)]
        if not ours:
            if run.take_over():
                continue
            unsure = sum(not study.is_sure(answer) for answer in run.known.values())
            raise SharedError(_told(shard, len(run.known) - unsure, unsure, len(pieces), what))
        while ours:
            ours = list(run.settle(ours, hands, progress, what))
    if run.has_remembered:
        run.known_before.make_room()
    return StudyResult(run.known, run.records, run.shelf, tuple(run.origins))


def look_up(study: Study[Piece, Answer, Record]) -> dict[str, Answer]:
    """The answers that are known before a question is asked, by name; nothing is computed."""
    run = _Run(study, EvidenceStore(None, study.question), None, None, False)
    run.look_up()
    return run.known


class _Run(Generic[Piece, Answer, Record]):
    """What is known so far of a study that is asked."""

    def __init__(
        self,
        study: Study[Piece, Answer, Record],
        shelf: EvidenceStore,
        say: Callable[[str], None] | None,
        each: Callable[[str, Answer], None] | None,
        fresh: bool,
    ) -> None:
        self.study, self.shelf, self.say, self.each, self.fresh = study, shelf, say, each, fresh
        question = study.question
        self.known_before = KnownAnswers.to(question.schema, question.said, question.more)
        self.records: dict[str, Record] = {}
        self.known: dict[str, Answer] = {}
        self.origins: list[Origin] = []
        self.has_remembered = False
        self._looked_up: set[str] = set()

    def add(self, name: str, record: Record, answer: Answer) -> None:
        self.records[name], self.known[name] = record, answer
        if self.each is not None:
            self.each(name, answer)

    def take_over(self) -> bool:
        """Whether the folder has answers that are new to us."""
        before = len(self.known)
        for name, record, answer in _kept(self.study, self.shelf, self.known, self.say):
            self.add(name, record, answer)
        return len(self.known) > before

    def look_up(self) -> bool:
        """Take over answers that are known, and then those that are wanted because of them."""
        before = len(self.known)
        while names := [] if self.fresh else self._unseen():
            for name in names:
                self._looked_up.add(name)
                found = _known(self.study, self.known_before, name, self.shelf)
                if found is not None:
                    self.origins.append(found[0])
                    self.add(name, *found[1:])
        return len(self.known) > before

    def _unseen(self) -> list[str]:
        wanted = self.study.wanted(self.known)
        return [x for x in wanted if x not in self.known and x not in self._looked_up]

    def settle(
        self, pieces: Sequence[Piece], hands: Jobs, progress: Progress | None, what: str
    ) -> Sequence[Piece]:
        """Keep the answers to ``pieces``. The result is still to be asked: parts of groups that ended."""
        study, parts = self.study, list[Piece]()

        def lose(piece: Piece, reason: Reason) -> Mapping[str, Answer]:
            alone = study.parts(piece) if isinstance(study, GroupedStudy) else ()
            if len(alone) < 2:
                return study.doubt(piece, reason)
            parts.extend(alone)
            return {}

        if pool.are_forked(pieces, hands):
            study.prepare()
        with closing(pool.work(study.settle, pieces, hands, lose, progress, what)) as answered:
            for _, answers in answered:
                for name, answer in answers.items():
                    self.keep(name, answer)
        return parts

    def keep(self, name: str, answer: Answer) -> None:
        """Keep an answer that was computed, for this run and, where it stands, for later ones."""
        self.add(name, _keep(self.study, name, answer, self.shelf), answer)
        study = self.study
        lasts = study.is_lasting(answer) if isinstance(study, DoubtKeeper) else study.is_sure(answer)
        key = None if is_off() or not lasts else study.key(name)
        if key is not None:
            self.has_remembered = True
            self.known_before.remember(name, key, known_answer(self.study, name, answer, whole=False))


def _known(
    study: Study[Piece, Answer, Record], known: KnownAnswers, name: str, shelf: EvidenceStore
) -> tuple[Origin, Record, Answer] | None:
    """An answer that is known, put on the shelf as if it had been computed."""
    key = study.key(name)
    found = None if key is None else known.find(name, key)
    if key is None or found is None:
        return None
    texts = EvidenceTexts(study.question, found.files)
    content = found.record if shelf.folder is not None else texts.inside(found.record)
    try:
        record = read(study.record_type, content, "a known answer")
        said, answer = study.recall(read(study.record_type, found.record, "a known answer"), texts)
        if said != name:
            return None
        if texts.drives and not known.is_judged(key, found):
            texts.judge()
            known.note_judged(key, found)
    except InputError:  # it is no answer any more: it is computed again
        return None
    shelf.adopt(found.files, whole=found.origin == "shipped")
    shelf.keep(name, write(record, timed=False), study.is_sure(answer))
    return found.origin, record, answer


def known_answer(
    study: Study[Piece, Answer, Record], name: str, answer: Answer, whole: bool = True
) -> KnownAnswer:
    """An answer with the texts of its evidence, as ``EvidenceTexts`` has them."""
    texts = EvidenceTexts(study.question, whole=whole)
    record = write(study.record(name, answer, texts), timed=False)
    return KnownAnswer(record, texts.files)


def _kept(
    study: Study[Piece, Answer, Record],
    shelf: EvidenceStore,
    known: Container[str],
    say: Callable[[str], None] | None,
) -> Iterator[tuple[str, Record, Answer]]:
    """The kept answers that count and are not ``known``, each with its name and its record."""
    for file, content in shelf.answers(say, known):
        try:
            record = read(study.record_type, content, "a kept answer")
            name, answer = study.recall(record, shelf)
            if name != file:
                raise InputError(f"the answer '{file}' is that of '{name}'")
        except InputError as error:
            if say is not None:
                say(f"a stored answer is invalid and is computed again: {error}")
            continue
        yield name, record, answer


def _share(study: Study[Piece, Answer, Record], shard: Shard | None) -> Callable[[Piece], bool]:
    """Whether a piece is one of a shard's, whatever each of the runs knows by now.

    The pieces that are asked first are dealt out in turn, so shards differ by one at most. Later ones go by
    their names.
    """
    if shard is None:
        return lambda piece: True
    first = study.pieces({})
    dealt = {name for piece in first for name in study.doubt(piece, NO_REASON)}
    ours = {name for piece in shard.among(first) for name in study.doubt(piece, NO_REASON)}

    def is_ours(piece: Piece) -> bool:
        name = _name(study, piece)
        return name in ours if name in dealt else shard.has(name)

    return is_ours


def _name(study: Study[Piece, Answer, Record], piece: Piece) -> str:
    """What a piece is called: as the first of its answers."""
    return min(study.doubt(piece, NO_REASON))


def _told(shard: Shard | None, sure: int, unsure: int, left: int, what: str) -> str:
    """How far a run that has its share done is."""
    doubts = f", {unsure} in doubt, to be computed again" if unsure else ""
    return (
        f"shard {shard} is done: {sure} answers are stored{doubts}; other runs process {left} {what}. When "
        "all runs are done, run once without --shard to merge"
    )
