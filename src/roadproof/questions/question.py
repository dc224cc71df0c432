"""The protocol of questions: plain data that list claims, and show the answers to them."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, ClassVar, Final, Protocol, Self, TypeAlias, TypeVar, runtime_checkable

from roadproof.engines.modifier import find_modifier
from roadproof.errors import InputError
from roadproof.evidence.answer import ClaimAnswer
from roadproof.evidence.claim import Claim, Exists
from roadproof.reasons import Reason
from roadproof.runtime.canonical import digest

if TYPE_CHECKING:
    from roadproof.evidence.finding import Finding
    from roadproof.evidence.judged import JudgedDrive
    from roadproof.evidence.subject import Subject
    from roadproof.questions.basis import Basis
    from roadproof.runtime.budget import Work

QUESTION: Final = "question.json"
"""The file of a folder of answers that says what was asked."""
View = TypeVar("View", covariant=True)
T = TypeVar("T")
EvidencePlace: TypeAlias = Callable[[str, ClaimAnswer], object]
"""Where an answer is: the path of its file, or the evidence itself."""
Answers: TypeAlias = Mapping[str, ClaimAnswer]
"""Answers by the names of their claims."""
Steps: TypeAlias = Generator[tuple[str, Claim], ClaimAnswer, None]
"""Claims with their names; after each its answer is sent, on which the next may depend."""


class QuestionBatch(Protocol):
    """Claims that one process settles, since answers to some help with others. It can be sent elsewhere."""

    @property
    def name(self) -> str:
        """A word that no other batch of the question has."""

    def steps(self) -> Steps:
        """Yield each claim, and be sent its answer."""


class Question(Protocol[View]):
    """A question about many claims. Names of claims are names of files."""

    kind: ClassVar[str]
    """The word for the question: the command that asks it."""

    @property
    def basis(self) -> Basis:
        """The definitions and limits of the claims."""

    @property
    def work(self) -> Work:
        """The work that is allowed for a claim."""

    @property
    def settings(self) -> object:
        """The further settings of the question: a definition for ``evidence.codec``."""

    @classmethod
    def of(cls, basis: Basis, settings: object, where: str) -> Self:
        """Return the question that plain data ask. Raises ``InputError``."""

    def batches(self, known: Answers) -> Sequence[QuestionBatch]:
        """Return the batches that can be settled, given what is known of others.

        Those that were settled before are among them. It is asked again until there is no new one.
        """

    def label(self, name: str) -> str:
        """Return what the claim of a name is about, in words."""

    def view(self, known: Answers) -> View:
        """Return what the answers show together. Claims without an answer are in doubt."""

    def data(self, view: Any, place: EvidencePlace, seconds: float) -> object:
        """Return a view as a definition for ``evidence.codec``, which ``--json`` prints."""


@runtime_checkable
class OwnWork(Protocol):
    """A batch with other work for a claim than its question allows."""

    @property
    def work(self) -> Work:
        """The work that is allowed for a claim."""


@runtime_checkable
class WorkByName(Protocol):
    """A batch with other work for each claim than its question allows."""

    def work_of(self, name: str) -> Work:
        """Return the work that is allowed for the claim of a name."""


@runtime_checkable
class Seeded(Protocol):
    """A batch with drives that may serve its claims."""

    @property
    def seeds(self) -> tuple[JudgedDrive, ...]:
        """The drives."""


@runtime_checkable
class Proposing(Protocol):
    """A batch that knows drives which may show one of its claims, before any is looked for."""

    def proposed(self, name: str, known: Answers) -> Iterator[JudgedDrive]:
        """Yield drives for the claim of a name, given the answers to claims of the batch before it."""


@runtime_checkable
class Growing(Protocol):
    """A question whose folder holds the answers to former ones, too."""

    def beside(self, former: Any) -> Any:
        """Return the question about what was asked before, too."""

    def displaced(self, former: Any) -> list[str]:
        """Return the names of former answers in whose place there are others now."""


@runtime_checkable
class Replacing(Protocol):
    """A question that takes the place of another of its kind in a folder: its claims follow from a search."""

    replaces: ClassVar[bool]


@runtime_checkable
class HasUnknowns(Protocol):
    """A question of which more might be asked, had nothing been cut off."""

    @property
    def undecided_parts(self) -> Sequence[tuple[str, Reason]]:
        """Other undecided parts of the question, with reasons."""


@runtime_checkable
class FindsUnknowns(Protocol):
    """A question whose answers leave more in doubt than their claims say."""

    def unknowns(self, known: Answers) -> Sequence[tuple[str, Reason]]:
        """Return what is in doubt, and why."""


@runtime_checkable
class Linkable(Protocol):
    """A question about subjects that requirements link to."""

    def subject(self, name: str) -> Subject:
        """Return what the claim of a name is about."""


@runtime_checkable
class Annotating(Protocol):
    """A question that says more of a checked answer than its label."""

    def annotate(self, name: str, answer: ClaimAnswer, finding: Finding) -> Finding:
        """Return what was found, with what the answer shows."""


def work_of(usual: Work, batch: QuestionBatch, name: str) -> Work:
    """Return the work for a claim: the ``usual`` work of the question, unless its batch has another."""
    if isinstance(batch, WorkByName):
        return batch.work_of(name)
    return batch.work if isinstance(batch, OwnWork) else usual


def require_place(answer: ClaimAnswer, work: Work, where: str) -> None:
    """Require the road, the lanes and the boxes that a claim asks for, unless drives are moved.

    Raises ``InputError``, which names ``where`` the drive is.
    """
    mode, judged = answer.claim.mode, answer.drive
    moves = work.moves and not work.alone
    if moves or judged is None or not isinstance(mode, Exists):
        return
    file = judged.file
    if mode.road is not None and file.road != mode.road:
        raise InputError(f"{where}: its drive is on road {file.road.name!r}, and another one is asked for")
    for variable, lane in mode.lanes.items():
        if file.lanes.get(variable) != lane:
            raise InputError(f"{where}: {variable} is {file.lanes.get(variable)} on its drive, not {lane}")
    for name, motion in file.drive.vehicles.items():
        model = mode.vehicles.get(name, mode.vehicles.get(""))
        if model is not None and (motion.kind, motion.length, motion.width) != (
            model.kind,
            model.length,
            model.width,
        ):
            raise InputError(f"{where}: {name} has not the kind, length and width of {model.name}")


def walk_batch(
    batch: QuestionBatch, find: Callable[[str, Claim], ClaimAnswer | None]
) -> Iterator[tuple[str, Claim]]:
    """Yield the first claim of a batch, with its name, to which ``find`` has no answer; else nothing.

    While it is iterated, it calls ``find`` for each claim in turn and sends the answer to the batch.
    """
    steps = batch.steps()
    try:
        name, claim = next(steps)
        while (answer := find(name, claim)) is not None:
            name, claim = steps.send(answer)
    except StopIteration:
        return
    steps.close()
    yield name, claim


class EarlierAnswers:
    """The answers to the claims of a batch before the next one, which its engines know as they decide it.

    What they show may decide the next claim. An undecided answer is therefore stored with their digest.
    """

    def __init__(self, batch: QuestionBatch) -> None:
        self.batch = batch
        self.answers: dict[str, ClaimAnswer] = {}

    def add(self, name: str, answer: ClaimAnswer) -> None:
        """Add the answer to the next claim."""
        self.answers[name] = answer

    def digest(self) -> str:
        """Return the digest of the claims with their verdicts, and of the drives of the batch itself."""
        seeds = self.batch.seeds if isinstance(self.batch, Seeded) else ()
        verdicts = [(x.claim.digest(), x.verdict) for x in self.answers.values()]
        return digest([x.file.drive for x in seeds], verdicts)


def walk_with_earlier(
    batch: QuestionBatch, find: Callable[[str, Claim, EarlierAnswers], ClaimAnswer | None]
) -> Iterator[tuple[str, Claim]]:
    """Walk a batch as ``walk_batch``; ``find`` is given the answers to the claims before each, too."""
    earlier = EarlierAnswers(batch)

    def find_next(name: str, claim: Claim) -> ClaimAnswer | None:
        """Return the answer to the next claim, and note it."""
        answer = find(name, claim, earlier)
        if answer is not None:
            earlier.add(name, answer)
        return answer

    yield from walk_batch(batch, find_next)


def heading_of(schema: str, basis: Basis) -> dict[str, Any]:
    """Return how a view begins as plain data: its kind, the version, the library, what begins so."""
    from roadproof.evidence.heading import heading  # here: for data alone

    modifier = find_modifier(basis.specification.options)
    return heading(schema, basis.library) | ({} if modifier is None else modifier.as_data(schema))
