"""The JSON document of ``roadproof trace --baseline``: the changes between two states of requirements."""

from collections.abc import Mapping
from typing import Annotated, Final, Literal, TypeAlias

from roadproof.evidence.answers.headings import BaseHeading
from roadproof.evidence.answers.shared import Reason
from roadproof.evidence.codec import Doc, Rule
from roadproof.extensions.assurance.answers.trace import LinkKind, LinkState
from roadproof.runtime.records import dataclass
from roadproof.verdict import ExitCode

SCHEMA: Final = "roadproof/trace-changes/1"
ChangeKind: TypeAlias = Literal["added", "removed", "better", "worse", "text"]


@dataclass(frozen=True, kw_only=True)
class TraceChange:
    """A change of a requirement or of one of its links."""

    requirement: str
    kind: Annotated[LinkKind | None, Doc("Null for the requirement itself.")]
    target: str
    how: ChangeKind
    before: Annotated[LinkState | None, Doc("Null for what was added.")]
    after: Annotated[LinkState | None, Doc("Null for what was removed.")]
    reason: Reason


@dataclass(frozen=True, kw_only=True)
class TraceChangesData(BaseHeading):
    """The changes between two states of requirements."""

    schema: Literal["roadproof/trace-changes/1"] = SCHEMA
    before: Annotated[str, Doc("The file of the first state.")]
    after: str
    changes: tuple[TraceChange, ...]
    counts: Annotated[
        Mapping[str, tuple[Annotated[int, Rule(minimum=0)], Annotated[int, Rule(minimum=0)]]],
        Doc("By state, how many requirements have it before and after."),
    ]

    @property
    def exit_code(self) -> ExitCode:
        """The exit code: 10 where something got worse or was removed, else 0."""
        worse = any(x.how in ("worse", "removed") for x in self.changes)
        return ExitCode.UNEXPECTED if worse else ExitCode.AS_EXPECTED
