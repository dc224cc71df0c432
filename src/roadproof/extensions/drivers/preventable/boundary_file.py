"""The file that says where on the lines of a plate a formula holds."""

from collections.abc import Mapping
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final, Literal

from roadproof.evidence.answer_files import OwnEvidence
from roadproof.evidence.checking import other_readings
from roadproof.evidence.codec import Doc
from roadproof.evidence.finding import Acceptance, Finding, parameter_remark
from roadproof.extensions.drivers.preventable.plate import Plate, PlateLineData
from roadproof.library.bind import default_values
from roadproof.library.specification import Library
from roadproof.reasons import NO_REASON, ReasonKind
from roadproof.runtime.records import dataclass
from roadproof.verdict import Verdict

if TYPE_CHECKING:
    from roadproof.evidence.claim import Claim

BOUNDARY: Final = "roadproof/boundary/1"


@dataclass(frozen=True, kw_only=True)
class BoundaryFile(OwnEvidence):
    """The places on the lines of a plate at which a formula holds, with exact ends."""

    schema: Literal["roadproof/boundary/1"] = BOUNDARY
    parameters: Annotated[
        Mapping[str, Fraction], Doc("Values of parameters on which it depends, in SI units.")
    ]
    plate: Plate
    lines: tuple[PlateLineData, ...]

    def fault_for(self, claim: "Claim") -> str:
        """Return why it is about another claim: other parameters, or another plate."""
        if self.parameters != {x.name: x.value for x in claim.parameters}:
            return "its parameters have other values"
        return "" if self.plate == getattr(claim.mode, "plate", None) else "it is about another plate"

    def check(self, path: Path, library: Library) -> Finding:
        """Return what the file shows: lines are worked out again from the formula or the model's motion."""
        from roadproof.extensions.drivers.preventable.boundary import fault_of  # loads the models

        reason = ReasonKind.TOLD(fault) if (fault := fault_of(self, library)) else NO_REASON
        outcome = Acceptance.REJECTED if reason else Acceptance.ACCEPTED
        declared = default_values(library)
        other = [f"{name}={x}" for name, x in sorted(self.parameters.items()) if declared.get(name) != x]
        readings = other_readings(self.options, library)
        checked = () if reason else ("worked out again", parameter_remark(other), *readings)
        return Finding(str(path), "boundary", outcome, reason, Verdict.DERIVED, "", self.claim, checked)
