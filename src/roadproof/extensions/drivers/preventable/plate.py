"""Plates: a driver model over a plane of initial values; and the file that says where a formula holds."""

from collections.abc import Mapping
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final, Literal, TypeAlias

from roadproof.evidence.answer_files import OwnEvidence
from roadproof.evidence.checking import other_readings
from roadproof.evidence.codec import Doc, Rule
from roadproof.evidence.finding import Acceptance, Finding
from roadproof.extensions.drivers.manoeuvres import MANOEUVRES, ManoeuvreName, Plane, plane_of
from roadproof.extensions.drivers.models import ModelName
from roadproof.library.bind import default_values
from roadproof.library.specification import Library
from roadproof.reasons import NO_REASON, Why
from roadproof.runtime.records import dataclass
from roadproof.verdict import Verdict

if TYPE_CHECKING:
    from roadproof.evidence.claim import Claim
    from roadproof.extensions.drivers import lines as drawn

BOUNDARY: Final = "roadproof/boundary/1"
Range: TypeAlias = tuple[Fraction, Fraction]


@dataclass(frozen=True, kw_only=True)
class Plate:
    """One model over the plane of two initial values, in SI units."""

    manoeuvre: ManoeuvreName
    model: Annotated[ModelName, Doc("The driver model.")]
    fixed: Annotated[Mapping[str, Fraction], Doc("Initial values that all places share, by name.")]
    along: Annotated[Range, Doc("The range of the initial value that each line runs along.")]
    across: Annotated[Range, Doc("The range of the initial value that differs from line to line.")]
    lines: Annotated[int, Rule(minimum=2), Doc("How many lines there are.")]

    @property
    def plane(self) -> Plane:
        """The plane of the plate. Raises ``UsageError``."""
        return plane_of(MANOEUVRES[self.manoeuvre], self.fixed, self.along, self.across, self.lines)


@dataclass(frozen=True, kw_only=True)
class End:
    """An end of a span."""

    near: Annotated[float, Doc("Rounded to a millionth.")]
    exact: Annotated[
        str, Rule(least=1), Doc("The number, or the polynomial of which it is the root that is near.")
    ]


@dataclass(frozen=True, kw_only=True)
class Line:
    """Where along a line a collision is unpreventable."""

    at: Annotated[Fraction, Doc("The initial value that differs from line to line, in SI units.")]
    unpreventable: Annotated[
        tuple[tuple[End, End], ...],
        Doc(
            "Spans of the line in which the formula is true, from and to; on a stepped plate, first and last "
            "of neighbouring places at which it is."
        ),
    ]

    @staticmethod
    def of(line: "drawn.Line") -> "Line":
        """Return a line as files have it."""
        spans = tuple(
            (End(near=a.near, exact=a.exact), End(near=b.near, exact=b.exact)) for a, b in line.spans
        )
        return Line(at=line.at, unpreventable=spans)

    @property
    def drawn(self) -> "drawn.Line":
        """The inverse of ``of``."""
        from roadproof.extensions.drivers import lines as drawn

        spans = (
            (drawn.End(float(a.near), a.exact), drawn.End(float(b.near), b.exact))
            for a, b in self.unpreventable
        )
        return drawn.Line(self.at, tuple(spans))


@dataclass(frozen=True, kw_only=True)
class BoundaryFile(OwnEvidence):
    """Where on the lines of a plate a formula holds, with exact ends."""

    schema: Literal["roadproof/boundary/1"] = BOUNDARY
    parameters: Annotated[
        Mapping[str, Fraction], Doc("Values of parameters on which it depends, in SI units.")
    ]
    plate: Plate
    lines: tuple[Line, ...]

    def fault_for(self, claim: "Claim") -> str:
        """Return why it is about another claim: other parameters, or another plate."""
        if self.parameters != {x.name: x.value for x in claim.parameters}:
            return "its parameters have other values"
        return "" if self.plate == getattr(claim.mode, "plate", None) else "it is about another plate"

    def check(self, path: Path, library: Library) -> Finding:
        """Return what the file shows: lines are worked out again from the formula or the model's motion."""
        from roadproof.extensions.drivers.preventable.boundary import fault_of  # loads the models

        reason = Why.TOLD(fault) if (fault := fault_of(self, library)) else NO_REASON
        outcome = Acceptance.REJECTED if reason else Acceptance.ACCEPTED
        declared = default_values(library)
        other = [f"{name}={x}" for name, x in sorted(self.parameters.items()) if declared.get(name) != x]
        told = f"with {', '.join(other)}" if other else "declared parameters"
        checked = () if reason else ("worked out again", told, *other_readings(self.options, library))
        return Finding(str(path), "boundary", outcome, reason, Verdict.DERIVED, "", self.claim, checked)
