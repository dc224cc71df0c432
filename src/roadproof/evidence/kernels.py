"""A second checker of evidence: what it is asked, what it says, and where one is found.

Kernels come with an extension. What one accepts, it accepts by its own word.
"""

from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import field
from enum import StrEnum
from pathlib import Path
from typing import Literal, TypeAlias

from roadproof.errors import MissingSolverError
from roadproof.evidence.answers.shared import Kernel
from roadproof.evidence.certificate import Certificate
from roadproof.evidence.finding import Acceptance, OtherVerdict
from roadproof.extension import imported, listed
from roadproof.library.specification import Library
from roadproof.reasons import NO_REASON, Reason
from roadproof.runtime.executors import Jobs
from roadproof.runtime.pool import Progress
from roadproof.runtime.records import dataclass
from roadproof.verdict import ExitCode

KernelName: TypeAlias = Literal["coq", "extracted"]
"""Coq itself, or the program that it makes of its checkers."""


class Word(StrEnum):
    ACCEPTED = "accepted"
    REFUSED = "refused"
    UNKNOWN = "unknown"


def limits_told(limits: int) -> str:
    """
    >>> limits_told(1), limits_told(2)
    ('1 limit', '2 limits')
    """
    return f"{limits} limit{'s' * (limits != 1)}"


@dataclass(frozen=True)
class Ruling:
    """What Coq says of a certificate. ``lemma``: which fact about one instant was not proved, from 1.

    ``limits``: how many limits of vehicles, which the claim assumes, the theorem has as premises.
    """

    word: Word
    reason: Reason = NO_REASON
    lemma: int | None = None
    limits: int = 0
    axioms: tuple[str, ...] = ()

    @property
    def told(self) -> str:
        """The word, with the premises."""
        return f"{self} under {limits_told(self.limits)}, as premises" if self.limits else str(self)

    def __str__(self) -> str:
        return f"{self.word} (lemma {self.lemma})" if self.lemma is not None else str(self.word)


_OUTCOMES = {
    Word.ACCEPTED: Acceptance.ACCEPTED,
    Word.REFUSED: Acceptance.REJECTED,
    Word.UNKNOWN: Acceptance.UNDECIDED,
}
_EXIT = {
    Word.ACCEPTED: ExitCode.AS_EXPECTED,
    Word.UNKNOWN: ExitCode.UNKNOWN,
    Word.REFUSED: ExitCode.CROSSCHECK_FAILED,
}


@dataclass(frozen=True)
class KernelQuestion:
    """A certificate, a trace, or the file of a certificate or drive; ``home``: its library, or its files."""

    name: str
    certificate: object
    home: Library | tuple[Path, ...]


@dataclass(frozen=True)
class KernelAnswer:
    """Rulings by name; seconds of the processor for all files, megabytes of the largest, axioms used.

    ``version``: of Coq, or of the OCaml that compiled the extracted program.
    """

    version: str
    rulings: Mapping[str, Ruling] = field(default_factory=dict)
    seconds: float = 0.0
    megabytes: float = 0.0
    kernel: KernelName = "coq"

    @property
    def exit_code(self) -> ExitCode:
        """A proof of ours that Coq refuses is a cross-check that failed."""
        return max((_EXIT[x.word] for x in self.rulings.values()), default=ExitCode.AS_EXPECTED)

    @property
    def axioms(self) -> tuple[str, ...]:
        return tuple(sorted({name for x in self.rulings.values() for name in x.axioms}))

    @property
    def kept(self) -> Kernel:
        """As answers have it."""
        return Kernel(
            coqc=self.version if self.kernel == "coq" else "",
            ocaml=self.version if self.kernel == "extracted" else "",
            seconds=round(self.seconds, 1),
            megabytes=round(self.megabytes),
            axioms=self.axioms,
        )

    def __str__(self) -> str:
        if self.kernel == "extracted":
            spent = f"{self.seconds:.2f} s of processor time" if self.seconds else "nothing asked"
            return f"extracted program, OCaml {self.version}: {spent}"
        held = f"at most {self.megabytes:.0f} MB" if self.megabytes else "nothing asked"
        axioms = ", ".join(self.axioms) or "none"
        return f"coqc {self.version}: {self.seconds:.1f} s of processor time, {held}; axioms: {axioms}"


class Kernels(ABC):
    """Those who check evidence again, by their names."""

    @abstractmethod
    def find(self, kernel: KernelName) -> None:
        """Raises ``MissingSolverError`` where what a kernel needs is not installed."""

    @abstractmethod
    def put(
        self,
        asked: Sequence[KernelQuestion],
        jobs: Jobs,
        progress: Progress | None = None,
        kernel: KernelName = "coq",
    ) -> KernelAnswer:
        """Return what a kernel says of each question; nothing of what it knows no kind of.

        Raises ``MissingSolverError``.
        """

    @abstractmethod
    def write(
        self, asked: Sequence[KernelQuestion], folder: Path, jobs: Jobs, kernel: KernelName = "coq"
    ) -> dict[str, Reason]:
        """Write a file for each question; return why there is none, by name, where there is none."""

    @abstractmethod
    def names_of(self, paths: Iterable[Path]) -> dict[Path, str]:
        """Return a name for each file that a kernel can read, too."""

    @abstractmethod
    def find_tableau(self, proof: Certificate, library: Library) -> tuple[str, ...] | None:
        """Return the lines with which a kernel checks a certificate; None where none are found."""


def kernels() -> Kernels:
    """Return the kernels. Raises ``MissingSolverError`` where no extension has any."""
    found = [*listed("kernels")]
    if not found:
        raise MissingSolverError("there is no kernel: no extension that is installed has one")
    made: Kernels = imported(found[0])
    return made


def find_tableau(proof: Certificate, library: Library) -> tuple[str, ...] | None:
    """Return the lines with which a kernel checks a certificate; None where there are none."""
    return kernels().find_tableau(proof, library) if listed("kernels") else None


def ruled(ruling: Ruling) -> OtherVerdict:
    """What Coq says, for a finding."""
    words = "that is a premise" if ruling.limits == 1 else "that are premises"
    said = (f"under {limits_told(ruling.limits)} {words}",) if ruling.limits else ()
    why, unchecked = ruling.reason, ("queries for solvers",)
    return OtherVerdict(_OUTCOMES[ruling.word], why, str(ruling), said, unchecked)
