"""The answer of ``roadproof preventable``: plates with drives on both sides, and lemmas."""

from collections.abc import Mapping
from fractions import Fraction
from typing import Annotated, ClassVar, Final, Literal, TypeAlias

from roadproof.drivers import lines as drawn
from roadproof.drivers.lines import Side
from roadproof.drivers.manoeuvres import ManoeuvreName
from roadproof.drivers.models import ModelName
from roadproof.evidence.answers import shared
from roadproof.evidence.codec import LEFT_OUT, UNCHECKED, Doc, Rule
from roadproof.runtime.records import dataclass
from roadproof.verdict import ClaimVerdict, Verdict

SCHEMA: Final = "roadproof/preventable/1"
Name: TypeAlias = Annotated[str, Rule(least=1)]
Values: TypeAlias = Annotated[Mapping[str, shared.Rational], Doc("Initial values by name, in SI units.")]
SideVerdict: TypeAlias = Literal[Verdict.WITNESSED, Verdict.UNKNOWN]


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

    at: shared.Rational
    unpreventable: Annotated[
        tuple[tuple[End, End], ...],
        Doc(
            "Spans of the line in which the formula is true, from and to; on a stepped plate, first and last "
            "of neighbouring places at which it is."
        ),
    ]

    @staticmethod
    def of(line: drawn.Line) -> "Line":
        """A line as it is kept."""
        spans = tuple((_kept_end(begin), _kept_end(end)) for begin, end in line.spans)
        return Line(at=str(line.at), unpreventable=spans)

    @property
    def drawn(self) -> drawn.Line:
        """The inverse of ``of``."""
        spans = tuple((_end(begin), _end(end)) for begin, end in self.unpreventable)
        return drawn.Line(Fraction(self.at), spans)


def _kept_end(end: drawn.End) -> End:
    return End(near=end.near, exact=end.exact)


def _end(end: End) -> drawn.End:
    return drawn.End(float(end.near), end.exact)


@dataclass(frozen=True, kw_only=True)
class SideDrive:
    """A drive on one side of the boundary."""

    side: Side
    at: Values
    verdict: SideVerdict
    formula: Annotated[str, Doc("What holds on the drive; empty where there is none.")]
    scenario: Annotated[
        str,
        Doc(
            "The scenario that the drive is of, as a formula, or what happens in it; empty where it is of "
            "none."
        ),
    ]
    drive: shared.KeptDrive
    reason: shared.Reason


@dataclass(frozen=True, kw_only=True)
class Plate:
    """One model over the plane of two initial values."""

    name: Name
    model: Annotated[ModelName, Doc("The driver model.")]
    fixed: Values
    verdict: Annotated[SideVerdict, Doc("Whether each side that the plane has is shown by a drive.")]
    formula: Annotated[
        shared.Formula,
        Doc(
            "What is true where a collision is unpreventable: of the state there, or, on a stepped plate, of "
            "the drive from there."
        ),
    ]
    stepped: Annotated[
        str,
        Doc(
            "Empty where the ends of the spans are exact. Else the model is a controller that looks at a "
            "clock's rate: each end is a place that was looked at, and nothing is claimed of what lies "
            "between places."
        ),
    ]
    motion: Annotated[
        str,
        Doc(
            "Empty where a formula of the state says where a collision is unpreventable. Else there is none: "
            "the ends are worked out from the motion, exactly, and the formula is of the drives."
        ),
    ]
    lines: tuple[Line, ...]
    shown: tuple[SideDrive, ...]
    reason: shared.Reason


@dataclass(frozen=True, kw_only=True)
class Lemma:
    """A lemma that the formula of a model is its boundary."""

    name: Name
    title: Annotated[str, Rule(least=1), UNCHECKED, Doc("What it says, in words.")]
    claim: shared.Formula
    assuming: shared.Assuming
    verdict: ClaimVerdict
    certificate: shared.KeptCertificate
    reason: shared.Reason


@dataclass(frozen=True, kw_only=True)
class Preamble:
    """What an index says once for all plates."""

    set: shared.SetName
    manoeuvre: ManoeuvreName
    scenario: Annotated[
        Literal[1, 2, 4, 5, 6, 8] | None,
        Doc("The scenario that drives should be of, where the manoeuvre was asked for by its number."),
    ]
    along: Annotated[
        tuple[Name, shared.Rational, shared.Rational],
        Doc("The initial value that each line runs along, with its range (SI)."),
    ]
    across: Annotated[
        tuple[
            Name,
            shared.Rational,
            shared.Rational,
            Annotated[str, Rule(pattern="^[0-9]{1,6}$", called="number of lines")],
        ],
        Doc(
            "The initial value that differs from line to line, with its range (SI), and how many lines "
            "there are."
        ),
    ]
    options: shared.Options
    parameters: shared.Parameters
    specs: shared.Specifications


@dataclass(frozen=True, kw_only=True)
class Index(Preamble, shared.Heading):
    """From which initial values a driver prevents a collision."""

    schema: Literal["roadproof/preventable/1"] = SCHEMA
    view: shared.Dense = "dense"
    seconds: shared.Seconds = 0.0
    idle: Annotated[
        tuple[Name, ...],
        Doc("Options and parameters that were chosen, and on which no boundary here depends."),
    ] = ()
    plates: tuple[Plate, ...]
    lemmas: Annotated[tuple[Lemma, ...], Doc("That the formulas are the boundary.")]


@dataclass(frozen=True, kw_only=True)
class Record:
    """A kept answer: a plate or a lemma."""

    ALTERNATIVES: ClassVar = (("plate",), ("lemma",))
    plate: Annotated[Plate | None, LEFT_OUT] = None
    lemma: Annotated[Lemma | None, LEFT_OUT] = None
