"""The JSON document of ``roadproof trace``: requirements, their links, and the evidence for each."""

from enum import StrEnum
from typing import Annotated, Final, Literal, TypeAlias

from roadproof.evidence.answers.headings import BaseHeading
from roadproof.evidence.answers.shared import (
    Fingerprint,
    Options,
    Parameters,
    Reason,
    SetName,
    Specifications,
)
from roadproof.evidence.codec import Doc, Rule
from roadproof.evidence.finding import Acceptance
from roadproof.runtime.records import dataclass
from roadproof.verdict import ExitCode

SCHEMA: Final = "roadproof/trace/1"
LinkKind: TypeAlias = Literal["claim", "scenario", "test", "driver", "plate", "evidence"]


class LinkState(StrEnum):
    """The state of a link according to the evidence, which is checked again; ordered from best to worst.

    PROVED: proved for all time. WITNESSED: shown by a judged drive. UNKNOWN: not decided. STALE: was shown,
    but something that the link rests on has changed. MISSING: no evidence. REJECTED: the evidence does not
    show its claim. REFUTED: the opposite is shown.
    """

    PROVED = "proved"
    WITNESSED = "witnessed"
    UNKNOWN = "unknown"
    STALE = "stale"
    MISSING = "missing"
    REJECTED = "rejected"
    REFUTED = "refuted"

    @property
    def rank(self) -> int:
        """The position in the order of states; 0 is the best."""
        return [*LinkState].index(self)

    @property
    def is_shown(self) -> bool:
        """Return whether the link is shown: PROVED or WITNESSED."""
        return self in (LinkState.PROVED, LinkState.WITNESSED)

    @property
    def exit_code(self) -> ExitCode:
        """The exit code of a link: 0 where it is shown, 20 where it is undecided, else 10."""
        if self.is_shown:
            return ExitCode.AS_EXPECTED
        return ExitCode.UNKNOWN if self is LinkState.UNKNOWN else ExitCode.UNEXPECTED


@dataclass(frozen=True, kw_only=True)
class RequirementPlace:
    """The file, line and column of a requirement."""

    file: str
    line: Annotated[int, Rule(minimum=1)] = 1
    column: Annotated[int, Rule(minimum=1)] = 1


@dataclass(frozen=True, kw_only=True)
class LinkedEvidence:
    """A finding of ``roadproof check`` about one piece of evidence."""

    where: Annotated[str, Doc("The file, or the entry of an index.")]
    label: Annotated[str, Doc("What it is of, such as P1 scenario 4 base.")]
    verdict: Annotated[str, Doc("As the evidence itself gives it; empty where nothing can be said.")]
    claim: str
    outcome: Acceptance
    reason: Reason


@dataclass(frozen=True, kw_only=True)
class TracedLink:
    """A link of a requirement with its state."""

    kind: LinkKind
    target: Annotated[str, Rule(least=1), Doc("As the requirement names it.")]
    state: LinkState
    reason: Reason
    shows: Annotated[
        tuple[str, ...],
        Doc("What accepted evidence says in figures and names: targets of a test, margins under a driver."),
    ]
    changes: Annotated[
        tuple[str, ...], Doc("What the link rests on and is another now, such as parameter rho: 3/5 -> 1/2.")
    ]
    evidence: tuple[LinkedEvidence, ...]


@dataclass(frozen=True, kw_only=True)
class TracedRequirement:
    """A requirement with its state."""

    id: Annotated[str, Rule(least=1)]
    title: str
    text: str
    edition: Annotated[str, Doc("Of the document that it comes from; empty where unknown.")]
    clause: Annotated[str, Doc("Of the document that it comes from; empty where unknown.")]
    parents: Annotated[tuple[str, ...], Doc("The requirements that it is a part of or derived from.")]
    place: RequirementPlace
    state: Annotated[LinkState, Doc("The worst of its links and parts; missing where it has none.")]
    links: tuple[TracedLink, ...]


@dataclass(frozen=True, kw_only=True)
class TraceData(BaseHeading):
    """Requirements with the evidence for each."""

    schema: Literal["roadproof/trace/1"] = SCHEMA
    library: Annotated[Fingerprint, Doc("Of the library at hand with the specification files of the trace.")]
    file: Annotated[str, Doc("The file of the requirements.")]
    set: SetName
    options: Options
    parameters: Parameters
    specs: Specifications
    locked: Annotated[bool, Doc("Whether a lock file says what the links rested on when they were accepted.")]
    requirements: tuple[TracedRequirement, ...]
    unlinked: Annotated[tuple[LinkedEvidence, ...], Doc("Evidence that no requirement names.")]
    notes: Annotated[tuple[str, ...], Doc("What was left out of the file, and why.")]

    @property
    def exit_code(self) -> ExitCode:
        """The exit code: 10 where a requirement is not shown or evidence is rejected, 20 where one is
        undecided.
        """
        codes = [x.state.exit_code for x in self.requirements] or [ExitCode.UNKNOWN]
        codes += [_beside(x.outcome) for x in self.unlinked]
        return ExitCode.UNEXPECTED if ExitCode.UNEXPECTED in codes else max(codes)


def _beside(outcome: Acceptance) -> ExitCode:
    """Return the exit code of evidence that no requirement names."""
    decided = outcome.exit_code in (ExitCode.AS_EXPECTED, ExitCode.UNKNOWN)
    return outcome.exit_code if decided else ExitCode.UNEXPECTED
