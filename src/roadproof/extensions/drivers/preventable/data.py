"""The question and the answer of ``roadproof preventable`` as plain data."""

from collections.abc import Mapping
from fractions import Fraction
from typing import Annotated, Final, Literal, TypeAlias

from roadproof.evidence.answers import headings, shared
from roadproof.evidence.codec import LEFT_OUT, Doc, Rule
from roadproof.extensions.drivers.lines import Side
from roadproof.extensions.drivers.manoeuvres import ManoeuvreName
from roadproof.extensions.drivers.preventable.own_tests import OwnTest
from roadproof.extensions.drivers.preventable.plate import PlateLineData, Range
from roadproof.runtime.records import dataclass
from roadproof.verdict import ClaimVerdict, Verdict

SCHEMA: Final = "roadproof/preventable/1"
MOST_LINES: Final = 2000
Name: TypeAlias = Annotated[str, Rule(least=1)]
Number: TypeAlias = Literal[1, 2, 4, 5, 6, 8]
Values: TypeAlias = Annotated[Mapping[str, shared.Rational], Doc("Initial values by name, in SI units.")]
SideVerdict: TypeAlias = Literal[Verdict.WITNESSED, Verdict.UNKNOWN]


@dataclass(frozen=True, kw_only=True)
class Choice:
    """An initial value that differs from plate to plate."""

    name: Name
    values: Annotated[tuple[Fraction, ...], Rule(least=1), Doc("In SI units.")]


@dataclass(frozen=True, kw_only=True)
class PlateRequest:
    """Driver models over planes of initial values of a manoeuvre."""

    manoeuvre: ManoeuvreName
    scenario: Annotated[
        Number | None,
        Doc("The scenario that drives should be of, where the manoeuvre was asked for by its number."),
    ] = None
    models: Annotated[tuple[Name, ...], Rule(least=1, unique=True)]
    fixed: Annotated[Mapping[str, Fraction], Doc("Initial values of all plates by name, in SI units.")]
    sheet: Annotated[tuple[Choice, ...], Doc("There is a plate for each choice of these.")]
    along: Annotated[Range, Doc("The range of the initial value that each line runs along.")]
    across: Annotated[Range, Doc("The range of the initial value that differs from line to line.")]
    lines: Annotated[int, Rule(minimum=2), Doc("How many lines a plate has.")]
    lemmas: Annotated[bool, Doc("Whether lemmas are proved that the formulas are the boundary.")]
    tests: Annotated[tuple[OwnTest, ...], LEFT_OUT, Doc("Tests of the reader, to be drawn as points.")] = ()


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
    drive: shared.DriveField
    reason: shared.Reason


@dataclass(frozen=True, kw_only=True)
class PlateData:
    """One model over the plane of two initial values."""

    name: Name
    model: Annotated[Name, Doc("The driver model.")]
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
    lines: tuple[PlateLineData, ...]
    boundary: Annotated[
        str | None, LEFT_OUT, Doc("The file that says where the lines are; left out without --out.")
    ] = None
    shown: tuple[SideDrive, ...]
    reason: shared.Reason


@dataclass(frozen=True, kw_only=True)
class LemmaData:
    """A lemma that the formula of a model is its boundary."""

    name: Name
    title: Annotated[str, Rule(least=1), Doc("What it says, in words.")]
    claim: shared.Formula
    assuming: shared.Assuming
    verdict: ClaimVerdict
    certificate: shared.CertificateField
    reason: shared.Reason


@dataclass(frozen=True, kw_only=True)
class PreventableData(headings.AnswerHeading):
    """The answer of ``preventable``: the initial values from which a driver prevents a collision."""

    schema: Literal["roadproof/preventable/1"] = SCHEMA
    set: shared.SetName
    manoeuvre: ManoeuvreName
    scenario: Annotated[
        Number | None,
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
    view: shared.Dense = "dense"
    seconds: shared.Seconds = 0.0
    idle: Annotated[
        tuple[Name, ...],
        Doc("Options and parameters that were chosen, and on which no boundary here depends."),
    ] = ()
    plates: tuple[PlateData, ...]
    lemmas: Annotated[tuple[LemmaData, ...], Doc("That the formulas are the boundary.")]
    tests: Annotated[tuple[OwnTest, ...], LEFT_OUT, Doc("Tests of the reader, to be drawn as points.")] = ()
