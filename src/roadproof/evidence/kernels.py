"""The interface of kernels: second checkers of evidence, such as Coq, that extensions provide.

A kernel gives its verdict independently of the solvers and of the exact judge.
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
from roadproof.evidence.finding import Acceptance, SecondOpinion
from roadproof.extension import import_entry, list_entries
from roadproof.library.specification import Library
from roadproof.reasons import NO_REASON, Reason
from roadproof.runtime.executors import Jobs
from roadproof.runtime.pool import Progress
from roadproof.runtime.records import dataclass
from roadproof.verdict import ExitCode

KernelName: TypeAlias = Literal["coq", "extracted"]
"""Coq itself, or the program that it makes of its checkers."""


class KernelVerdict(StrEnum):
    """The verdict of a kernel on one file."""

    ACCEPTED = "accepted"
    REFUSED = "refused"
    UNKNOWN = "unknown"


def limits_text(limits: int) -> str:
    """Return the number of limits as text.

    >>> limits_text(1), limits_text(2)
    ('1 limit', '2 limits')
    """
    return f"{limits} limit{'s' * (limits != 1)}"


@dataclass(frozen=True)
class KernelRuling:
    """The verdict of a kernel with its reason; ``lemma``: the number, from 1, of the lemma that was not
    proved.

    ``limits``: the number of limits of vehicles that the claim assumes and the theorem has as premises.
    """

    verdict: KernelVerdict
    reason: Reason = NO_REASON
    lemma: int | None = None
    limits: int = 0
    axioms: tuple[str, ...] = ()

    @property
    def text_with_premises(self) -> str:
        """The verdict as text, with the number of limits that are premises."""
        return f"{self} under {limits_text(self.limits)}, as premises" if self.limits else str(self)

    def __str__(self) -> str:
        return f"{self.verdict} (lemma {self.lemma})" if self.lemma is not None else str(self.verdict)


_OUTCOMES: Mapping[KernelVerdict, Acceptance] = {
    KernelVerdict.ACCEPTED: Acceptance.ACCEPTED,
    KernelVerdict.REFUSED: Acceptance.REJECTED,
    KernelVerdict.UNKNOWN: Acceptance.UNDECIDED,
}
_EXIT: Mapping[KernelVerdict, ExitCode] = {
    KernelVerdict.ACCEPTED: ExitCode.AS_EXPECTED,
    KernelVerdict.UNKNOWN: ExitCode.UNKNOWN,
    KernelVerdict.REFUSED: ExitCode.CROSSCHECK_FAILED,
}


@dataclass(frozen=True)
class KernelQuestion:
    """A question to a kernel: a certificate, a trace, or the path of a file of evidence.

    ``home``: the library that it is read with, or its specification files.
    """

    name: str
    certificate: object
    home: Library | tuple[Path, ...]


@dataclass(frozen=True)
class KernelAnswer:
    """The rulings of a kernel by name, and its resources: processor time of all files, memory of the largest.

    ``version``: of Coq, or of the OCaml that compiled the extracted program.
    """

    version: str
    rulings: Mapping[str, KernelRuling] = field(default_factory=dict)
    seconds: float = 0.0
    megabytes: float = 0.0
    kernel: KernelName = "coq"

    @property
    def exit_code(self) -> ExitCode:
        """The exit code; a proof that the kernel refuses counts as a failed cross-check."""
        return max((_EXIT[x.verdict] for x in self.rulings.values()), default=ExitCode.AS_EXPECTED)

    @property
    def axioms(self) -> tuple[str, ...]:
        """The axioms of Coq that the accepted theorems use."""
        return tuple(sorted({name for x in self.rulings.values() for name in x.axioms}))

    @property
    def data(self) -> Kernel:
        """The JSON form of the resources and axioms."""
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
        memory = f"at most {self.megabytes:.0f} MB" if self.megabytes else "nothing asked"
        axioms = ", ".join(self.axioms) or "none"
        return f"coqc {self.version}: {self.seconds:.1f} s of processor time, {memory}; axioms: {axioms}"


class Kernels(ABC):
    """The kernels that an extension provides."""

    @abstractmethod
    def require_installed(self, kernel: KernelName) -> None:
        """Raise ``MissingSolverError`` if a program that the kernel needs is not installed."""

    @abstractmethod
    def check(
        self,
        questions: Sequence[KernelQuestion],
        jobs: Jobs,
        progress: Progress | None = None,
        kernel: KernelName = "coq",
    ) -> KernelAnswer:
        """Return the rulings of a kernel; questions of a kind that it does not know get none.

        Raises ``MissingSolverError``.
        """

    @abstractmethod
    def write(
        self, questions: Sequence[KernelQuestion], folder: Path, jobs: Jobs, kernel: KernelName = "coq"
    ) -> dict[str, Reason]:
        """Write a source file for each question into a folder; return reasons for missing ones, by name."""

    @abstractmethod
    def names_of(self, paths: Iterable[Path]) -> dict[Path, str]:
        """Return for each file a name that is also valid in a kernel."""

    @abstractmethod
    def find_tableau(self, proof: Certificate, library: Library) -> tuple[str, ...] | None:
        """Return the lines by which a kernel can check a certificate; None if none are found."""


def kernels() -> Kernels:
    """Return the kernels. Raises ``MissingSolverError`` if no extension provides any."""
    names = [*list_entries("kernels")]
    if not names:
        raise MissingSolverError("there is no kernel: no extension that is installed has one")
    kernels_of_extension: Kernels = import_entry(names[0])
    return kernels_of_extension


def find_tableau(proof: Certificate, library: Library) -> tuple[str, ...] | None:
    """Return the lines by which a kernel can check a certificate; None if none are found."""
    return kernels().find_tableau(proof, library) if list_entries("kernels") else None


def second_opinion(ruling: KernelRuling) -> SecondOpinion:
    """Return the ruling of a kernel in the form that findings use."""
    words = "that is a premise" if ruling.limits == 1 else "that are premises"
    checked = (f"under {limits_text(ruling.limits)} {words}",) if ruling.limits else ()
    why, unchecked = ruling.reason, ("queries for solvers",)
    return SecondOpinion(_OUTCOMES[ruling.verdict], why, str(ruling), checked, unchecked)
