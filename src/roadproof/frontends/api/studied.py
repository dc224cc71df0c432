"""Answers to long questions: asked in pieces, kept in a folder as they come, and taken up again."""

import time
from abc import abstractmethod
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Generic, Protocol, Self, TypeVar, Unpack

from roadproof.analysis.study.evidence_store import write_index
from roadproof.analysis.study.frame import Study, StudyResult, conduct, put_away
from roadproof.drivers.restriction import restriction_of
from roadproof.errors import UsageError
from roadproof.evidence.certificate import Certificate
from roadproof.evidence.codec import write
from roadproof.evidence.judged import JudgedDrive
from roadproof.evidence.kinds import Evidence
from roadproof.evidence.strict import JsonObject
from roadproof.frontends.api.answer import Answer, Picture, picture
from roadproof.frontends.api.definitions import Among, Definitions, definitions_of
from roadproof.frontends.api.settings import basis_of
from roadproof.frontends.report.sheet import Column, Sheet
from roadproof.frontends.settings.groups import Run
from roadproof.frontends.settings.keywords import AskKeywords
from roadproof.frontends.settings.option import takes
from roadproof.frontends.settings.studies import Ask
from roadproof.library.scenarios import numbers_of
from roadproof.library.specification import Library
from roadproof.runtime.files import write_whole
from roadproof.runtime.records import dataclass
from roadproof.verdict import ExitCode, Verdict

if TYPE_CHECKING:
    from roadproof.analysis.basis import Basis

S = TypeVar("S", bound=Study[Any, Any, Any])
A = TypeVar("A")
R = TypeVar("R")


@dataclass(frozen=True, repr=False)
class StudyAnswers(Answer, Generic[S, A, R]):
    """The answers to a ``study``; ``folder`` is where they were kept as they came, if anywhere."""

    study: S
    found: StudyResult[A, R]
    seconds: float
    folder: Path | None = None
    pieces: ClassVar[str] = "pieces"

    @classmethod
    def asked(
        cls,
        study: S,
        given: Run,
        each: Callable[[str, A], None] | None = None,
        more: Callable[[], Mapping[str, object]] = dict,
        begun: float | None = None,
    ) -> Self:
        """Ask ``study`` (``study.frame.conduct``); what was kept in ``given.out`` before is not asked again.

        ``more`` gives further fields of the answer, once all else is answered; ``begun``: since when the
        seconds count.
        """
        since = time.monotonic() if begun is None else begun
        folder = None if given.out is None else Path(given.out)
        found = conduct(study, folder, given.jobs, given.progress, cls.pieces, given.say, each, given.fresh)
        fields = more()
        made = cls(study, found, time.monotonic() - since, folder, **fields)
        if folder is not None:
            made._write_index(folder, found)
        return made

    @abstractmethod
    def _index(self, records: Mapping[str, R]) -> object:
        """The index, made of the answers as they are recorded."""

    def _write_index(self, folder: Path, found: StudyResult[A, R]) -> None:
        write_index(folder, write(self._index(found.records), timed=False))

    @property
    def library(self) -> Library:
        """The definitions that the answers were given with."""
        return self.study.question.library

    def files(self, pictures: bool) -> dict[str, bytes]:
        """What is written beside the evidence to be looked at, by name."""
        return {}

    @property
    def supposed(self) -> tuple[str, ...]:
        """In words, what begins so that is asked about, where a driver model says it."""
        found = restriction_of(self.study.question.options)
        return () if found is None else (str(found),)

    @property
    def exit_code(self) -> ExitCode:
        doubt = Verdict.UNKNOWN in self.verdicts.values()
        return ExitCode.UNKNOWN if doubt else ExitCode.AS_EXPECTED

    def as_data(self) -> JsonObject:
        return self.found.as_data(self._index(self.found.records))

    def _write(self, folder: Path, pictures: bool) -> None:
        kept = self.found if folder == self.folder else put_away(self.study, self.found.answers, folder)
        self._write_index(folder, kept)
        self._add_files(folder, pictures)

    def add_files(self, pictures: bool) -> None:
        """Write what is to be looked at beside the evidence that was kept as it came."""
        if self.folder is not None:
            self._add_files(self.folder, pictures)

    def _add_files(self, folder: Path, pictures: bool) -> None:
        for name, content in self.files(pictures).items():
            write_whole(folder / name, content)


def drive_pictures(
    drives: Iterable[tuple[str, JudgedDrive | None]], library: Library
) -> Iterator[tuple[str, Picture]]:
    """A picture of each drive that there is."""
    from roadproof.frontends.report.drive import draw_drive

    return ((name, picture(draw_drive(x.file, library))) for name, x in drives if x is not None)


def drawn(pictures: Mapping[str, Picture]) -> dict[str, bytes]:
    """Pictures as files by name."""
    return {f"{name}.{kind}": getattr(x, kind) for name, x in pictures.items() for kind in ("png", "svg")}


# --- studies that have no function of their own -----------------------------------------------------


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


V = TypeVar("V", bound=StudyAnswer)


class Verdicts(Protocol):
    """V kept answer with one entry of the index."""

    @property
    def verdict(self) -> object: ...


K = TypeVar("K", bound=Verdicts)


class Listing(Study[Any, V, K], Protocol[V, K]):
    """V study that knows the names of all answers, and the definition of its index."""

    @property
    def index_type(self) -> Callable[..., object]:
        """The definition of the index, with ``seconds`` and ``verdicts``."""

    @property
    def names(self) -> Sequence[str]:
        """The names in the order of the index, which is a list of what is recorded."""


class Answers(StudyAnswers[Listing[V, K], V, K]):
    """The answers to a study, each with a verdict."""

    @property
    def each(self) -> dict[str, V]:
        """The answers by name, in order."""
        return {name: self.found.answers[name] for name in self.study.names}

    @property
    def verdicts(self) -> dict[str, Verdict]:
        return {name: x.verdict for name, x in self.each.items()}

    @property
    def evidence(self) -> tuple[Evidence, ...]:
        return tuple(y for x in self.each.values() if (y := x.certificate or x.drive) is not None)

    @property
    def _sheet(self) -> Sheet[tuple[str, V]]:
        return Sheet(
            (
                Column("name", lambda x: x[0]),
                Column("verdict", lambda x: x[1].verdict),
                Column("reason", lambda x: x[1].reason),
            ),
            [*self.each.items()],
        )

    def _index(self, records: Mapping[str, K]) -> object:
        verdicts = tuple(records[name].verdict for name in self.study.names)
        heading = self.study.question.heading
        return self.study.index_type(**heading, seconds=round(self.seconds, 1), verdicts=verdicts)

    def __str__(self) -> str:
        lines = [f"{x.verdict:<11} {name}{x.reason and f': {x.reason}'}" for name, x in self.each.items()]
        return "\n".join([*lines, f"{len(lines)} answers in {self.seconds:.1f} s"])


@takes(Ask)
def ask(
    about: Callable[["Basis", tuple[int, ...]], Listing[V, K]],
    among: Among = None,
    using: Definitions | None = None,
    **options: Unpack[AskKeywords],
) -> Answers[V, K]:
    """The answers to a study that ``about`` makes of definitions and of the numbers of scenarios.

    ``among``: scenarios such as "1,3-8" (all where None). ``effort``, a number of units, is for one drive;
    ``out``: a folder in which answers are kept as they come; ``say`` is told of kept ones that do not count.
    Raises ``InputError``, ``UsageError``.
    """
    given = Ask.of(options)
    home = definitions_of(using)
    numbers = home.among(among) or numbers_of(home.specification)
    study = about(basis_of(home, given, given.vehicles), numbers)
    if not study.names:
        raise UsageError(f"--among {among} selects no scenario: select others")
    return Answers[V, K].asked(study, given)
