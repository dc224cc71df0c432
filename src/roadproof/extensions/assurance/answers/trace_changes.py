"""The answer of ``roadproof trace --baseline``: what changed between two states of requirements."""

from collections.abc import Mapping
from typing import Annotated, Final, Literal, TypeAlias

from roadproof.evidence.answers.shared import PlainHeading, Reason
from roadproof.evidence.codec import Doc, Rule
from roadproof.extensions.assurance.answers.trace import LinkKind, LinkState
from roadproof.runtime.records import dataclass
from roadproof.verdict import ExitCode

SCHEMA: Final = "roadproof/trace-changes/1"
Way: TypeAlias = Literal["added", "removed", "better", "worse", "text"]


@dataclass(frozen=True, kw_only=True)
class Change:
    """A requirement, or a link of one, in two states."""

    requirement: str
    kind: Annotated[LinkKind | None, Doc("Null for the requirement itself.")]
    target: str
    how: Way
    before: Annotated[LinkState | None, Doc("Null for what was added.")]
    after: Annotated[LinkState | None, Doc("Null for what was removed.")]
    reason: Reason


@dataclass(frozen=True, kw_only=True)
class Changes(PlainHeading):
    """What changed between two states of requirements."""

    schema: Literal["roadproof/trace-changes/1"] = SCHEMA
    before: Annotated[str, Doc("The file of the first state.")]
    after: str
    changes: tuple[Change, ...]
    counts: Annotated[
        Mapping[str, tuple[Annotated[int, Rule(minimum=0)], Annotated[int, Rule(minimum=0)]]],
        Doc("By state, how many requirements have it before and after."),
    ]

    @property
    def exit_code(self) -> ExitCode:
        """10 where something got worse, or was removed."""
        worse = any(x.how in ("worse", "removed") for x in self.changes)
        return ExitCode.UNEXPECTED if worse else ExitCode.AS_EXPECTED
