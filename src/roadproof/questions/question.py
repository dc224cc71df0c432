"""What a question is: plain data that list claims, and show the answers to them."""

from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from typing import Any, ClassVar, Protocol, Self, TypeAlias, TypeVar, runtime_checkable

from roadproof.engines.modifier import modifier_of
from roadproof.evidence.answer import Answer, undecided
from roadproof.evidence.claim import Claim
from roadproof.evidence.finding import Finding
from roadproof.evidence.heading import heading
from roadproof.evidence.judged import JudgedDrive
from roadproof.evidence.subject import Subject
from roadproof.questions.basis import Basis
from roadproof.reasons import NO_REASON, Reason
from roadproof.runtime.budget import Work

View = TypeVar("View", covariant=True)
T = TypeVar("T")
Place: TypeAlias = Callable[[str, Answer], object]
"""Where an answer is: the path of its file, or the evidence itself."""
Answers: TypeAlias = Mapping[str, Answer]
"""Answers by the names of their claims."""
Steps: TypeAlias = Generator[tuple[str, Claim], Answer, None]
"""Claims with their names; after each its answer is sent, on which the next may depend."""


class Batch(Protocol):
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
        """What the claims are read with, and what drives may be."""

    @property
    def work(self) -> Work:
        """The work that is allowed for a claim."""

    @property
    def asked(self) -> object:
        """What is asked beside the basis: a definition for ``evidence.codec``."""

    @classmethod
    def of(cls, basis: Basis, asked: object, where: str) -> Self:
        """Return the question that plain data ask. Raises ``InputError``."""

    def batches(self, known: Answers) -> Sequence[Batch]:
        """Return the batches that can be settled, given what is known of others.

        Those that were settled before are among them. It is asked again until there is no new one.
        """

    def label(self, name: str) -> str:
        """Return what the claim of a name is about, in words."""

    def view(self, known: Answers) -> View:
        """Return what the answers show together. Claims without an answer are in doubt."""

    def data(self, view: Any, place: Place, seconds: float) -> object:
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
class Doubted(Protocol):
    """A question of which more might be asked, had nothing been cut off."""

    @property
    def doubted(self) -> Sequence[tuple[str, Reason]]:
        """What is in doubt beside the claims, and why."""


@runtime_checkable
class Doubting(Protocol):
    """A question whose answers leave more in doubt than their claims say."""

    def doubts(self, known: Answers) -> Sequence[tuple[str, Reason]]:
        """Return what is in doubt, and why."""


@runtime_checkable
class Linkable(Protocol):
    """A question about subjects that requirements link to."""

    def subject(self, name: str) -> Subject:
        """Return what the claim of a name is about."""


@runtime_checkable
class Telling(Protocol):
    """A question that says more of a checked answer than its label."""

    def tell(self, name: str, answer: Answer, found: Finding) -> Finding:
        """Return what was found, with what the answer shows."""


def walk(batch: Batch, find: Callable[[str, Claim], Answer | None]) -> Iterator[tuple[str, Claim]]:
    """Yield the claim of a batch that ``find`` has no answer to; what follows depends on it."""
    steps = batch.steps()
    try:
        name, claim = next(steps)
        while (answer := find(name, claim)) is not None:
            name, claim = steps.send(answer)
    except StopIteration:
        return
    steps.close()
    yield name, claim


def seen(asking: Generator[tuple[str, Claim], Answer, T], known: Answers) -> T:
    """Return what answers show; claims without one are in doubt."""
    try:
        name, claim = next(asking)
        while True:
            name, claim = asking.send(known.get(name) or undecided(claim, NO_REASON))
    except StopIteration as end:
        found: T = end.value
        return found


def heading_of(schema: str, basis: Basis) -> dict[str, Any]:
    """Return how a view begins as plain data: its kind, the version, the library, what begins so."""
    modifier = modifier_of(basis.specification.options)
    return heading(schema, basis.library) | ({} if modifier is None else modifier.as_data(schema))
