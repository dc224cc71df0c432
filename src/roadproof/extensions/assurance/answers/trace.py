"""The answer of ``roadproof trace``: what shows each requirement."""

from enum import StrEnum
from typing import Annotated, Final, Literal, TypeAlias

from roadproof.evidence.answers.shared import (
    Fingerprint,
    Options,
    Parameters,
    PlainHeading,
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
    """What evidence, checked again, says of a link; the best comes first.

    PROVED: for all time. WITNESSED: by a judged drive. UNKNOWN: not decided. STALE: it was shown, and
    something that it rests on is another now. MISSING: there is no evidence. REJECTED: there is evidence, and
    it does not show what it says. REFUTED: the opposite is shown.
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
        """0 is the best."""
        return [*LinkState].index(self)

    @property
    def is_shown(self) -> bool:
        """Whether the requirement may rest on it."""
        return self in (LinkState.PROVED, LinkState.WITNESSED)

    @property
    def exit_code(self) -> ExitCode:
        """20 where nothing is decided, 10 for all that is neither shown nor undecided."""
        if self.is_shown:
            return ExitCode.AS_EXPECTED
        return ExitCode.UNKNOWN if self is LinkState.UNKNOWN else ExitCode.UNEXPECTED


@dataclass(frozen=True, kw_only=True)
class Position:
    """Where a requirement is written."""

    file: str
    line: Annotated[int, Rule(minimum=1)] = 1
    column: Annotated[int, Rule(minimum=1)] = 1


@dataclass(frozen=True, kw_only=True)
class LinkedEvidence:
    """A finding of ``roadproof check``."""

    where: Annotated[str, Doc("The file, or the entry of an index.")]
    label: Annotated[str, Doc("What it is of, such as P1 scenario 4 base.")]
    verdict: Annotated[str, Doc("As the evidence itself gives it; empty where nothing can be said.")]
    claim: str
    outcome: Acceptance
    reason: Reason


@dataclass(frozen=True, kw_only=True)
class TracedLink:
    """A link of a requirement."""

    kind: LinkKind
    target: Annotated[str, Rule(least=1), Doc("As the requirement names it.")]
    state: LinkState
    reason: Reason
    changes: Annotated[
        tuple[str, ...], Doc("What the link rests on and is another now, such as parameter rho: 3/5 -> 1/2.")
    ]
    evidence: tuple[LinkedEvidence, ...]


@dataclass(frozen=True, kw_only=True)
class TracedRequirement:
    """A requirement."""

    id: Annotated[str, Rule(least=1)]
    title: str
    text: str
    parents: Annotated[tuple[str, ...], Doc("The requirements that it is a part of or derived from.")]
    place: Position
    state: Annotated[LinkState, Doc("The worst of its links and parts; missing where it has none.")]
    links: tuple[TracedLink, ...]


@dataclass(frozen=True, kw_only=True)
class Answer(PlainHeading):
    """What shows each requirement."""

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
        """10 where a requirement is not shown or evidence is rejected, 20 where one is not decided."""
        codes = [x.state.exit_code for x in self.requirements] or [ExitCode.UNKNOWN]
        codes += [_beside(x.outcome) for x in self.unlinked]
        return ExitCode.UNEXPECTED if ExitCode.UNEXPECTED in codes else max(codes)


def _beside(outcome: Acceptance) -> ExitCode:
    """The exit code of evidence that no requirement names."""
    decided = outcome.exit_code in (ExitCode.AS_EXPECTED, ExitCode.UNKNOWN)
    return outcome.exit_code if decided else ExitCode.UNEXPECTED
