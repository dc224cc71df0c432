"""The JSON of ``classify``: settings of the question, and its view."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Annotated, Final, Literal, TypeAlias

from roadproof.evidence.answers import headings, shared
from roadproof.evidence.codec import LEFT_OUT, Doc, Key, Rule
from roadproof.reasons import NO_REASON
from roadproof.runtime.records import dataclass
from roadproof.verdict import ProofVerdict, Verdict

SCHEMA: Final = "roadproof/classify/2"
ExampleVerdict: TypeAlias = Literal[Verdict.WITNESSED, Verdict.UNKNOWN]
Kind: TypeAlias = Literal["exclusive", "covers", "empty"]
Numbers: TypeAlias = Annotated[tuple[shared.Number, ...], Doc("Numbers of scenarios.")]


@dataclass(frozen=True, kw_only=True)
class UndecidedPart:
    """A part of the division that is undecided, because a job was lost or cut off by the clock."""

    about: Annotated[str, Doc("What is in doubt.")]
    reason: shared.Reason


@dataclass(frozen=True, kw_only=True)
class DivisionGroupData:
    """The cells of scenarios between the same vehicles, and what is to be proved to hold never."""

    vehicles: Annotated[tuple[str, ...], Rule(least=2), Doc("The vehicles.")]
    cells: Annotated[tuple[Numbers, ...], Doc("The scenarios that hold in each cell of what happens.")]
    empty: Annotated[tuple[shared.Formula, ...], Doc("What is left out, since it never holds.")] = ()


@dataclass(frozen=True, kw_only=True)
class DivisionData:
    """A division of scenarios, whose classes a specification file defines.

    Nothing of it is taken for granted: it is claimed that classes exclude each other and cover the scenarios.
    """

    scenarios: Annotated[Numbers, Doc("The scenarios that are divided.")]
    groups: tuple[DivisionGroupData, ...] = ()
    places: Annotated[tuple[Numbers, ...], Doc("The scenarios whose road sectors make up each place.")] = ()
    doubts: Annotated[tuple[UndecidedPart, ...], LEFT_OUT] = ()


@dataclass(frozen=True, kw_only=True)
class ClassData:
    """A class, with a drive for it where one was found, and how often it occurs in recordings."""

    name: Annotated[str, Rule(pattern="^[A-Za-z_][A-Za-z0-9_]*$"), Doc("The name of its definition.")]
    vehicles: Annotated[
        tuple[str, ...], Rule(least=2), Doc("The vehicles to which the definition is applied.")
    ]
    scenarios: Annotated[Numbers, Doc("The scenarios that hold in the class.")]
    happens: Annotated[Numbers, Doc("What happens: scenarios, each the first with its disturbance.")]
    where: Annotated[str | None, Doc("The road sectors, such as main; null where they make no difference.")]
    description: Annotated[str, Doc("What happens, in words.")]
    formula: Annotated[shared.Formula, Doc("The definition applied to the vehicles and L.")]
    verdict: ExampleVerdict
    reason: shared.Reason = NO_REASON
    drive: shared.DriveField = None
    situations: Annotated[
        shared.Count | None, Doc("Situations of the class; null where no shares are counted.")
    ] = None
    traces: Annotated[
        shared.Count | None, Doc("Traces with such a situation; null where no shares are counted.")
    ] = None


@dataclass(frozen=True, kw_only=True)
class ClassClaimData:
    """A claim about the classes."""

    name: Annotated[str, Rule(least=1), Doc("What the claim is called, and its file.")]
    kind: Annotated[
        Kind,
        Doc("Classes exclude each other; they cover the same as the scenarios; a combination never occurs."),
    ]
    claim: shared.Formula
    verdict: ProofVerdict
    reason: shared.Reason = NO_REASON
    certificate: shared.CertificateField = None


@dataclass(frozen=True, kw_only=True)
class Situations:
    """Situations by how many vehicles they are of."""

    pairs: Annotated[shared.Count, Key("2"), LEFT_OUT, Doc("Of two vehicles.")] = 0
    triples: Annotated[shared.Count, Key("3"), LEFT_OUT, Doc("Of three vehicles.")] = 0


@dataclass(frozen=True, kw_only=True)
class SharesData:
    """The counts in recordings."""

    source: Annotated[str, Doc("What was counted, in words.")]
    recordings: Annotated[tuple[str, ...], Doc("The names of the recordings.")]
    end: Annotated[Literal["clip"], Doc("Traces are read to their end and no further.")] = "clip"
    traces: Annotated[shared.Count, Doc("Traces on which danger arises.")]
    covered: Annotated[shared.Count, Doc("Those with a class.")]
    repeated: Annotated[shared.Count, Doc("Traces that an earlier recording shows, left out.")] = 0
    situations: Situations
    broken: Annotated[tuple[str, ...], Doc("Situations that are not of one class: our fault.")]


@dataclass(frozen=True, kw_only=True)
class ClassesData(headings.AnswerHeading):
    """Classes of scenarios that exclude each other, and what is proved of them."""

    schema: Literal["roadproof/classify/2"] = SCHEMA
    set: shared.SetName
    options: shared.Options
    parameters: shared.Parameters
    specs: shared.Specifications
    scenarios: Annotated[Numbers, Doc("The scenarios that are divided.")]
    view: shared.Dense = "dense"
    text: Annotated[
        str, Doc("The classes as a specification file; empty where the division was cut off.")
    ] = ""
    classes: tuple[ClassData, ...]
    claims: tuple[ClassClaimData, ...]
    shares: Annotated[SharesData | None, Doc("What was counted; null with --no-shares.")] = None
    doubts: Annotated[
        tuple[UndecidedPart, ...],
        Rule(least=1),
        LEFT_OUT,
        Doc("About the division; left out where there is none."),
    ] = ()
    seconds: shared.Seconds = 0.0


def add_counts(
    data: ClassesData, shares: SharesData, situations: Mapping[str, int], traces: Mapping[str, int]
) -> ClassesData:
    """Return the data with counts in recordings: situations and traces by class."""
    classes = (
        replace(x, situations=situations.get(x.name, 0), traces=traces.get(x.name, 0)) for x in data.classes
    )
    return replace(data, classes=tuple(classes), shares=shares)
