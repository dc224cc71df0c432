"""A search for drives as values, and its typed outcome, without solvers: a known answer needs none."""

from collections.abc import Mapping, Sequence
from dataclasses import field, replace
from typing import TYPE_CHECKING

from roadproof.engines.search.limits import Limits
from roadproof.engines.search.question import SearchOptions, Setting, exists, usual_road
from roadproof.evidence.claim import Claim, claim_of
from roadproof.evidence.judged import JudgedDrive
from roadproof.library.specification import Query, Specification
from roadproof.reasons import Reason, Why
from roadproof.runtime.records import dataclass
from roadproof.verdict import DriveVerdict, Verdict
from roadproof.world.drive import Drive

if TYPE_CHECKING:
    from roadproof.engines.search.impossible import Impossibility


@dataclass(frozen=True)
class Search:
    """For a drive on which ``query`` holds, clearly different from those in ``unlike``.

    ``scenario``: whose number it is.
    """

    specification: Specification
    query: Query
    setting: Setting = field(default_factory=Setting)
    search_options: SearchOptions = field(default_factory=SearchOptions)
    unlike: tuple[Drive, ...] = ()
    scenario: int | None = None

    @property
    def claim(self) -> Claim:
        """The claim that there is such a drive, without the effort of looking for it."""
        mode = replace(exists(self.setting, self.search_options), unlike=self.unlike)
        return claim_of(self.specification, self.query, mode, self.setting.values)


@dataclass(frozen=True)
class Outcome:
    """The verdict on a search, with judged drives, a proof that there is none, or the limits it was for.

    ``seconds`` by stage; ``sizes`` of the last problem that was solved. ``exhausted``: the same work finds no
    more.
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
    limits: Limits | None = None
    exhausted: bool = False

    def told(self, options: Sequence[str]) -> Reason:
        """The reason, with those ``options`` that a command has to widen the limits of a NONE-WITHIN."""
        return self.reason if self.limits is None else Why.TOLD(self.limits.text(options))


def undecided(search: Search, reason: Reason, seconds: float = 0.0) -> Outcome:
    """What is said of a search that nothing is known of."""
    road = search.setting.road or usual_road(search.query.formula)
    told = (search.scenario, search.specification.set_name, search.query, road.name)
    return Outcome(*told, Verdict.UNKNOWN, reason, seconds={"all": seconds})
