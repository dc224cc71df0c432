"""A search for drives as values, and its typed outcome, without solvers: a known answer needs none."""

from collections.abc import Mapping, Sequence
from dataclasses import field
from typing import TYPE_CHECKING

from roadproof.engines.search.limits import SearchLimits
from roadproof.evidence.judged import JudgedDrive
from roadproof.library.specification import Query
from roadproof.reasons import Reason, ReasonKind
from roadproof.runtime.records import dataclass
from roadproof.verdict import DriveVerdict

if TYPE_CHECKING:
    from roadproof.engines.search.impossible import Impossibility


@dataclass(frozen=True)
class SearchOutcome:
    """The verdict of a search, with judged drives, a proof that there is none, or the excluded limits.

    ``seconds`` by stage; ``sizes`` of the last solved problem. ``exhausted``: the same work finds no more.
    """

    scenario: int | None
    set_name: str
    query: Query
    road: str
    verdict: DriveVerdict
    reason: Reason
    drives: tuple[JudgedDrive, ...] = ()
    natural: bool = False
    seconds: Mapping[str, float] = field(default_factory=dict)
    sizes: Mapping[str, int] = field(default_factory=dict)
    impossibility: "Impossibility | None" = None
    limits: SearchLimits | None = None
    exhausted: bool = False

    def reason_with(self, options: Sequence[str]) -> Reason:
        """Return the reason; for a NONE-WITHIN it names those ``options`` that widen its limits."""
        return self.reason if self.limits is None else ReasonKind.TOLD(self.limits.text(options))
