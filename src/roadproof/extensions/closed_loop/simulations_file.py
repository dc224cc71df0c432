"""The file with the simulations of a search: their number, and where they lie on a plane."""

from collections import Counter
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final, Literal, TypeAlias

from roadproof.evidence.answer_files import OwnEvidence
from roadproof.evidence.codec import Doc, Rule
from roadproof.evidence.finding import Acceptance, Finding
from roadproof.library.specification import Library
from roadproof.reasons import NO_REASON, ReasonKind
from roadproof.runtime.records import dataclass
from roadproof.verdict import Verdict

if TYPE_CHECKING:
    from roadproof.evidence.claim import Claim

SIMULATIONS: Final = "roadproof/simulations/1"
PointKind: TypeAlias = Literal["other", "shown", "fails", "preventable"]
Count: TypeAlias = Annotated[int, Rule(minimum=0)]


@dataclass(frozen=True, kw_only=True)
class SimulationPoint:
    """A simulation on the plane of two knobs."""

    gap: Annotated[float, Doc("The gap to the last POV at the start, in m.")]
    faster: Annotated[float, Doc("How much faster SV is than that POV at the start, in m/s.")]
    kind: Annotated[
        PointKind,
        Doc(
            "other: not the target; fails: a requirement is broken; preventable: a driver model prevents it."
        ),
    ]


@dataclass(frozen=True, kw_only=True)
class PreventedFrom:
    """A point of the boundary of a driver model: the least gap at which it prevents a collision."""

    gap: Annotated[float, Doc("The gap to the last POV at the start, in m.")]
    faster: Annotated[float, Doc("How much faster SV is than that POV at the start, in m/s.")]


@dataclass(frozen=True, kw_only=True)
class SimulationsFile(OwnEvidence):
    """All simulations of the search for one target. It shows no verdict: the drives beside it do."""

    schema: Literal["roadproof/simulations/1"] = SIMULATIONS
    target: Annotated[str, Rule(least=1)]
    key: Annotated[str, Doc("A digest of the controller, the target, and the settings of the search.")]
    count: Count
    first_failure: Count
    first_preventable: Count
    reductions: Annotated[Count, Doc("Further simulations that made the failure simple.")]
    nearest: float | None
    values: Annotated[
        Mapping[str, float], Doc("The knobs of the failing drive (SI); empty where there is none.")
    ]
    fault: Annotated[str, Doc("The error of the controller that ended the search; empty for none.")]
    points: tuple[SimulationPoint, ...]
    guide: Annotated[str, Doc("The driver model of the boundary; empty where none speaks of the target.")]
    boundary: Annotated[
        tuple[PreventedFrom, ...],
        Doc("On samples, with the other knobs as in the failing drive, and nobody driving SV before."),
    ]

    def fault_for(self, claim: "Claim") -> str:
        """Return why the file is about another claim: another controller, target or search."""
        return "" if self.key == getattr(claim.mode, "key", None) else "it is about another search"

    def check(self, path: Path, library: Library) -> Finding:
        """Return whether the numbers of the file agree; the controller is not run again."""
        kinds = Counter(x.kind for x in self.points)
        fails = kinds["fails"] + kinds["preventable"]
        problem = ""
        if self.count != len(self.points):
            problem = f"count={self.count}, but it has {len(self.points)} simulations"
        elif max(self.first_failure, self.first_preventable) > self.count:
            problem = "its first failure comes after its last simulation"
        elif self.first_failure and not fails:
            problem = "it has a first failure, but none of its simulations fails"
        return Finding(
            str(path),
            "",
            Acceptance.REJECTED if problem else Acceptance.ACCEPTED,
            ReasonKind.TOLD(problem) if problem else NO_REASON,
            Verdict.UNKNOWN,
            "",
            self.claim,
            () if problem else (f"{self.count} simulations counted",),
            ("what the controller does in them",),
        )
