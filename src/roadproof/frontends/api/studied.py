"""Answers to long questions: asked in pieces, kept in a folder as they come, and taken up again."""

import time
from abc import abstractmethod
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Generic, Self, TypeVar

from roadproof.analysis.study.evidence_store import write_index
from roadproof.analysis.study.frame import Study, StudyResult, conduct, put_away
from roadproof.drivers.restriction import restriction_of
from roadproof.evidence.codec import write
from roadproof.evidence.judged import JudgedDrive
from roadproof.evidence.strict import JsonObject
from roadproof.frontends.api.answer import Answer, Picture, picture
from roadproof.frontends.settings.groups import Run
from roadproof.library.specification import Library
from roadproof.runtime.files import write_whole
from roadproof.runtime.records import dataclass
from roadproof.verdict import ExitCode, Verdict

if TYPE_CHECKING:
    pass

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
