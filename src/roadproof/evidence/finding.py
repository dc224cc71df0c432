"""What comes out where evidence is checked."""

from collections.abc import Iterable, Sequence
from enum import StrEnum
from typing import Annotated, Final, Literal, TypeAlias

from roadproof.evidence.answers.shared import KernelWord, Reason
from roadproof.evidence.codec import LEFT_OUT, Doc, Rule
from roadproof.evidence.subject import DriverSide, SubjectKind, TestOutcome
from roadproof.reasons import NO_REASON, Why
from roadproof.runtime.records import dataclass
from roadproof.verdict import ExitCode, Verdict


class Acceptance(StrEnum):
    """ACCEPTED: it shows what it says. UNDECIDED: the solver did not decide. UNREADABLE: nothing can be said,
    since it is damaged, or speaks of definitions that are not at hand. FAULT: ours."""

    ACCEPTED = "accepted"
    REJECTED = "rejected"
    UNDECIDED = "unknown"
    UNREADABLE = "unreadable"
    FAULT = "our fault"

    @property
    def exit_code(self) -> ExitCode:
        return _EXIT[self]


_EXIT = {
    Acceptance.ACCEPTED: ExitCode.AS_EXPECTED,
    Acceptance.REJECTED: ExitCode.UNEXPECTED,
    Acceptance.UNDECIDED: ExitCode.UNKNOWN,
    Acceptance.UNREADABLE: ExitCode.BAD_INPUT,
    Acceptance.FAULT: ExitCode.OUR_FAULT,
}


Kind: TypeAlias = Literal["certificate", "drive", "trace", "boundary", "index", "journal", "test", "none", ""]
STALE: Final = (Why.TEST_GONE, Why.TEST_UNKNOWN, Why.FILE_GONE, Why.FILE_CHANGED)
"""Why an answer is about tests that are others now."""
NO_EVIDENCE: Final = "none"  # the kind of an answer that promises nothing, or nothing that is for all time

ARITHMETIC: Final = "exact integer arithmetic"


@dataclass(frozen=True)
class Finding:
    """One claim of a file or of an index; the evidence itself gives verdict, label and claim."""

    where: Annotated[str, Doc("The file, or the entry of an index.")]
    kind: Annotated[
        Kind,
        Doc(
            "test: a test of a catalogue, judged again; none: an answer that promises nothing; empty: what "
            "the file is cannot be told."
        ),
    ]
    outcome: Acceptance
    reason: Annotated[Reason, Doc("Why it is not accepted; empty where it is.")] = NO_REASON
    verdict: Annotated[
        str, Doc("As the evidence itself gives it, such as PROVED; empty where nothing can be said.")
    ] = ""
    label: Annotated[str, Doc("What it is of, such as P1 scenario 4 base.")] = ""
    claim: str = ""
    checked: Annotated[tuple[str, ...], Doc("What was looked at, in words.")] = ()
    unchecked: Annotated[tuple[str, ...], Doc("What was not, in words.")] = ()
    subject: Annotated[
        SubjectKind, LEFT_OUT, Doc("The kind of thing that it is about; links of requirements match on it.")
    ] = SubjectKind.OTHER
    name: Annotated[str, LEFT_OUT, Doc("The name of a subject that has a kind, such as that of a test.")] = ""
    shows: Annotated[TestOutcome, LEFT_OUT, Doc("What a test of a catalogue shows.")] = ""
    set: Annotated[
        str, Rule(least=1), LEFT_OUT, Doc("The spec set of an entry of an index that has no file.")
    ] = ""
    drivers: Annotated[
        tuple[DriverSide, ...], LEFT_OUT, Doc("What becomes of a test of a catalogue under driver models.")
    ] = ()
    kernel: Annotated[
        KernelWord, LEFT_OUT, Doc("What Coq says of a certificate or drive, where it was asked.")
    ] = ""

    def __str__(self) -> str:
        """The finding in a line; a reason may have more of them."""
        if self.outcome is not Acceptance.ACCEPTED:
            named = f"{self.label}  " if self.label else ""
            return _printable(f"{self.outcome:<9} {named}{self.where}: {self.reason}", "\n")
        line = f"{self.verdict:<9} {f'{self.label}  ' if self.label else ''}{' '.join(self.claim.split())}"
        kernel = (f"kernel: {self.kernel}",) * bool(self.kernel)
        notes = [
            *kernel,
            *self.checked,
            *(f"not checked: {', '.join(self.unchecked)}",) * bool(self.unchecked),
        ]
        return _printable(line + (f"  [{'; '.join(notes)}]" if notes else ""))


def _printable(text: str, besides: str = "") -> str:
    """A text whose control characters, such as those in names of a file, are written as escapes."""
    return "".join(x if x.isprintable() or x in besides else ascii(x)[1:-1] for x in text)


@dataclass(frozen=True)
class OtherVerdict:
    """What another than solver and judge says: ``word`` in its own word."""

    outcome: Acceptance
    reason: Reason
    word: str
    checked: tuple[str, ...] = ()
    unchecked: tuple[str, ...] = ()


def exit_code(findings: Iterable[Finding], strict: bool = False) -> ExitCode:
    """The gravest of all findings; UNKNOWN where none is grave, but no evidence at all was accepted.

    ``strict``: UNKNOWN also where an answer has no evidence, such as UNKNOWN or NONE-WITHIN.
    """
    found = list(findings)
    gravest = max((x.outcome.exit_code for x in found), default=ExitCode.AS_EXPECTED)
    without = [x for x in found if x.kind == NO_EVIDENCE]
    if gravest is ExitCode.AS_EXPECTED and (len(without) == len(found) or (strict and without)):
        return ExitCode.UNKNOWN
    return gravest


def summary(findings: Sequence[Finding], solver: str) -> str:
    """How many claims came out how, in a line."""
    counted = [finding for finding in findings if finding.kind != NO_EVIDENCE]
    accepted = sum(finding.outcome is Acceptance.ACCEPTED for finding in counted)
    line = f"{accepted} of {len(counted)} accepted by {checkers(counted, solver)}"
    for outcome in (Acceptance.REJECTED, Acceptance.UNDECIDED, Acceptance.UNREADABLE, Acceptance.FAULT):
        count = sum(finding.outcome is outcome for finding in counted)
        line += f", {count} {outcome}" if count else ""
    without = len(findings) - len(counted)
    return line + (f"; {without} without evidence" if without else "")


def checkers(findings: Sequence[Finding], solver: str) -> str:
    """What checked these, in words: trees of a NONE-WITHIN are added up, and a kernel checks them too."""
    trees = [x for x in findings if x.verdict == Verdict.NONE_WITHIN]
    names = [solver] if len(trees) < len(findings) or any(x.kernel for x in trees) or not findings else []
    names += ["the exact judge"] if len(trees) < len(findings) or not findings else []
    names += [ARITHMETIC] if trees else []
    return " and ".join(filter(None, (", ".join(names[:-1]), names[-1])))
