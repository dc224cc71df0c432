"""Studies that have no function of their own, asked as those that have: a verdict for each answer."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Protocol, TypeVar, Unpack

from roadproof.analysis.basis import Basis
from roadproof.analysis.study.frame import Study
from roadproof.errors import UsageError
from roadproof.evidence.certificate import Certificate
from roadproof.evidence.judged import JudgedDrive
from roadproof.evidence.kinds import Evidence
from roadproof.frontends.api.definitions import Among, Definitions, load
from roadproof.frontends.api.settings import basis_of
from roadproof.frontends.api.studied import StudyAnswers
from roadproof.frontends.report.sheet import Column, Sheet
from roadproof.frontends.settings.keywords import AskKeywords
from roadproof.frontends.settings.option import takes
from roadproof.frontends.settings.studies import Ask
from roadproof.library.scenarios import numbers_of
from roadproof.verdict import Verdict


class StudyAnswer(Protocol):
    """An answer with its evidence, if it has any; ``reason`` says why it is in doubt."""

    @property
    def verdict(self) -> Verdict: ...

    @property
    def reason(self) -> str: ...

    @property
    def certificate(self) -> Certificate | None: ...

    @property
    def drive(self) -> JudgedDrive | None: ...


A = TypeVar("A", bound=StudyAnswer)


class Verdicts(Protocol):
    """A kept answer with one entry of the index."""

    @property
    def verdict(self) -> object: ...


R = TypeVar("R", bound=Verdicts)


class Listing(Study[Any, A, R], Protocol[A, R]):
    """A study that knows the names of all answers, and the definition of its index."""

    @property
    def index_type(self) -> Callable[..., object]:
        """The definition of the index, with ``seconds`` and ``verdicts``."""

    @property
    def names(self) -> Sequence[str]:
        """The names in the order of the index, which is a list of what is recorded."""


class Answers(StudyAnswers[Listing[A, R], A, R]):
    """The answers to a study, each with a verdict."""

    @property
    def each(self) -> dict[str, A]:
        """The answers by name, in order."""
        return {name: self.found.answers[name] for name in self.study.names}

    @property
    def verdicts(self) -> dict[str, Verdict]:
        return {name: x.verdict for name, x in self.each.items()}

    @property
    def evidence(self) -> tuple[Evidence, ...]:
        return tuple(y for x in self.each.values() if (y := x.certificate or x.drive) is not None)

    @property
    def _sheet(self) -> Sheet[tuple[str, A]]:
        return Sheet(
            (
                Column("name", lambda x: x[0]),
                Column("verdict", lambda x: x[1].verdict),
                Column("reason", lambda x: x[1].reason),
            ),
            [*self.each.items()],
        )

    def _index(self, records: Mapping[str, R]) -> object:
        verdicts = tuple(records[name].verdict for name in self.study.names)
        heading = self.study.question.heading
        return self.study.index_type(**heading, seconds=round(self.seconds, 1), verdicts=verdicts)

    def __str__(self) -> str:
        lines = [f"{x.verdict:<11} {name}{x.reason and f': {x.reason}'}" for name, x in self.each.items()]
        return "\n".join([*lines, f"{len(lines)} answers in {self.seconds:.1f} s"])


@takes(Ask)
def ask(
    about: Callable[[Basis, tuple[int, ...]], Listing[A, R]],
    among: Among = None,
    using: Definitions | None = None,
    **options: Unpack[AskKeywords],
) -> Answers[A, R]:
    """The answers to a study that ``about`` makes of definitions and of the numbers of scenarios.

    ``among``: scenarios such as "1,3-8" (all where None). ``effort``, a number of units, is for one drive;
    ``out``: a folder in which answers are kept as they come; ``say`` is told of kept ones that do not count.
    Raises ``InputError``, ``UsageError``.
    """
    given = Ask.of(options)
    home = using or load()
    numbers = home.among(among) or numbers_of(home.specification)
    study = about(basis_of(home, given, given.vehicles), numbers)
    if not study.names:
        raise UsageError(f"--among {among} selects no scenario: select others")
    return Answers[A, R].asked(study, given)
