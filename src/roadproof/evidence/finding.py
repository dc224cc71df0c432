"""Findings: the results of checking evidence, their summary and exit code."""

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from enum import StrEnum
from typing import Annotated, Final, Literal, TypeAlias

from roadproof.evidence.answers.shared import KernelWord, Reason
from roadproof.evidence.codec import LEFT_OUT, Doc, Rule
from roadproof.evidence.subject import DriverSide, SubjectKind, TestOutcome
from roadproof.reasons import NO_REASON, ReasonKind
from roadproof.runtime.records import dataclass
from roadproof.verdict import ExitCode, Verdict


class Acceptance(StrEnum):
    """The outcome of a check.

    ACCEPTED: the evidence shows its verdict. UNDECIDED: the solver gave no answer. UNREADABLE: the file is
    damaged, or uses definitions that are not loaded. FAULT: an error in roadproof.
    """

    ACCEPTED = "accepted"
    REJECTED = "rejected"
    UNDECIDED = "unknown"
    UNREADABLE = "unreadable"
    FAULT = "our fault"

    @property
    def exit_code(self) -> ExitCode:
        return _EXIT[self]


_EXIT: Mapping[Acceptance, ExitCode] = {
    Acceptance.ACCEPTED: ExitCode.AS_EXPECTED,
    Acceptance.REJECTED: ExitCode.UNEXPECTED,
    Acceptance.UNDECIDED: ExitCode.UNKNOWN,
    Acceptance.UNREADABLE: ExitCode.BAD_INPUT,
    Acceptance.FAULT: ExitCode.OUR_FAULT,
}


Kind: TypeAlias = Literal["certificate", "drive", "trace", "boundary", "index", "journal", "test", "none", ""]
STALE: Final = (ReasonKind.TEST_GONE, ReasonKind.TEST_UNKNOWN, ReasonKind.FILE_GONE, ReasonKind.FILE_CHANGED)
"""The reasons that say that the tests of an answer have changed since."""
NO_EVIDENCE: Final = "none"  # the kind of an answer without evidence that holds for all time

ARITHMETIC: Final = "exact integer arithmetic"


class RemarkKind(StrEnum):
    """The kind of limit that a remark of a check states."""

    PARAMETERS = "parameters"
    COLLISIONS = "collisions"


class LimitRemark(str):
    """A remark of a check that states a limit, as its words; code decides by its ``kind``.

    ``limit``: the words of the limit alone.
    """

    kind: RemarkKind
    limit: str

    def __new__(cls, kind: RemarkKind, text: str, limit: str | None = None) -> "LimitRemark":
        made = super().__new__(cls, text)
        made.kind, made.limit = kind, text if limit is None else limit
        return made

    def __reduce__(self) -> "tuple[type[LimitRemark], tuple[RemarkKind, str, str]]":
        return LimitRemark, (self.kind, str(self), self.limit)


def parameter_remark(other: Sequence[str]) -> LimitRemark:
    """Return the remark on the values of parameters; ``other``: those that are not the declared ones."""
    return LimitRemark(RemarkKind.PARAMETERS, f"with {', '.join(other)}" if other else "declared parameters")


@dataclass(frozen=True)
class Finding:
    """The result of checking one claim of a file or index; verdict, label and claim are the evidence's."""

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
        """Return the finding as one line; a reason may add lines."""
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


def _printable(text: str, allowed: str = "") -> str:
    """Return the text with control characters, such as those in names of a file, escaped."""
    return "".join(x if x.isprintable() or x in allowed else ascii(x)[1:-1] for x in text)


@dataclass(frozen=True)
class SecondOpinion:
    """The verdict of a checker other than solver and judge, such as Coq; ``word``: its own word for it."""

    outcome: Acceptance
    reason: Reason
    word: str
    checked: tuple[str, ...] = ()
    unchecked: tuple[str, ...] = ()


def exit_code(findings: Iterable[Finding], strict: bool = False) -> ExitCode:
    """Return the gravest exit code of all findings; UNKNOWN if none is grave but no evidence was accepted.

    ``strict``: UNKNOWN also if an answer has no evidence, such as UNKNOWN or NONE-WITHIN.
    """
    listed = list(findings)
    gravest = max((x.outcome.exit_code for x in listed), default=ExitCode.AS_EXPECTED)
    no_evidence = [x for x in listed if x.kind == NO_EVIDENCE]
    if gravest is ExitCode.AS_EXPECTED and (len(no_evidence) == len(listed) or (strict and no_evidence)):
        return ExitCode.UNKNOWN
    return gravest


def summary(findings: Sequence[Finding], solver: str) -> str:
    """Return a line with the number of claims of each outcome."""
    with_evidence = [finding for finding in findings if finding.kind != NO_EVIDENCE]
    accepted = sum(finding.outcome is Acceptance.ACCEPTED for finding in with_evidence)
    line = f"{accepted} of {len(with_evidence)} accepted by {checkers(with_evidence, solver)}"
    for outcome in (Acceptance.REJECTED, Acceptance.UNDECIDED, Acceptance.UNREADABLE, Acceptance.FAULT):
        count = sum(finding.outcome is outcome for finding in with_evidence)
        line += f", {count} {outcome}" if count else ""
    verdicts = Counter(finding.verdict for finding in findings if finding.kind == NO_EVIDENCE)
    if not verdicts:
        return line
    counts = ", ".join(f"{count} {verdict}" for verdict, count in sorted(verdicts.items()))
    return f"{line}; {verdicts.total()} with nothing to check: {counts}"


def checkers(findings: Sequence[Finding], solver: str) -> str:
    """Return the names of the checkers of these findings, such as ``z3 and the exact judge``.

    Exact arithmetic checks the trees of a NONE-WITHIN, and a kernel may check them too.
    """
    trees = [x for x in findings if x.verdict == Verdict.NONE_WITHIN]
    names = [solver] if len(trees) < len(findings) or any(x.kernel for x in trees) or not findings else []
    names += ["the exact judge"] if len(trees) < len(findings) or not findings else []
    names += [ARITHMETIC] if trees else []
    return " and ".join(filter(None, (", ".join(names[:-1]), names[-1])))
