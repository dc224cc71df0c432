"""The JSON document of ``roadproof assurance``: an argument in Goal Structuring Notation (GSN) with the state
of each element.
"""

from collections.abc import Mapping
from typing import Annotated, Final, Literal, TypeAlias

from roadproof.evidence.answers import headings, shared
from roadproof.evidence.codec import LEFT_OUT, Doc, Rule
from roadproof.runtime.records import dataclass

SCHEMA: Final = "roadproof/assurance/1"
Id: TypeAlias = Annotated[str, Rule(least=1)]
ElementStateName: TypeAlias = Annotated[
    Literal["holds", "undeveloped", "undecided", "broken"],
    Doc("Of goals and strategies the worst of their support."),
]


@dataclass(frozen=True, kw_only=True)
class ArgumentLimit:
    """A limit of the evidence: something that it assumes or does not show."""

    name: Annotated[str, Doc("Such as parameters, horizon or readings.")]
    told: Annotated[tuple[str, ...], Doc("Each limit of that name in words.")]


@dataclass(frozen=True, kw_only=True)
class ArgumentSolution:
    """The evidence of a solution with the result of its check."""

    evidence: Annotated[str, Doc("File or folder, as it is from the folder of the case.")]
    expect: Annotated[tuple[str, ...], Doc("Verdicts that the case expects; empty where only a digest is.")]
    select: Annotated[tuple[str, ...], Doc("Patterns of the entries that count; empty for all.")]
    entries: Annotated[int | None, Doc("How many entries the case expects; null for any number.")]
    sha256: Annotated[
        str,
        Rule(pattern="^([0-9a-f]{64})?$"),
        Doc("Of the file; of a folder that of its files' names and digests; empty where it is missing."),
    ]
    verdicts: Annotated[Mapping[str, shared.Count], Doc("Accepted entries by verdict.")]
    reasons: Annotated[tuple[str, ...], Doc("Why it does not hold; empty where it does.")]


@dataclass(frozen=True, kw_only=True)
class ArgumentElement:
    """An element of the argument."""

    id: Id
    kind: Literal["goal", "strategy", "solution", "context", "assumption", "justification"]
    text: Annotated[str, Rule(least=1)]
    state: Annotated[ElementStateName | None, Doc("null of contexts, assumptions and justifications.")]
    supported_by: Annotated[tuple[Id, ...], Doc("Elements that support it: SupportedBy of GSN.")]
    in_context_of: Annotated[tuple[Id, ...], Doc("Elements beside it: InContextOf of GSN.")]
    undeveloped: Annotated[bool, Doc("Whether the case marks it so.")]
    solution: Annotated[ArgumentSolution | None, LEFT_OUT, Doc("Of solutions only.")] = None
    limits: Annotated[
        tuple[ArgumentLimit, ...],
        LEFT_OUT,
        Doc("Of assumptions that roadproof derives from the evidence of a solution."),
    ] = ()


@dataclass(frozen=True, kw_only=True)
class ArgumentOpenPoint:
    """An element that prevents the top goal from holding."""

    element: Id
    state: ElementStateName
    reasons: tuple[str, ...]
    path: Annotated[tuple[Id, ...], Rule(least=1), Doc("From the element up to the top goal.")]
    others: Annotated[shared.Count, Doc("The number of further ways to the top goal.")]


@dataclass(frozen=True, kw_only=True)
class AssuranceData(headings.BaseHeading):
    """An argument in Goal Structuring Notation with the state of each element."""

    schema: Literal["roadproof/assurance/1"] = SCHEMA
    case: Annotated[str, Doc("The file.")]
    sha256: Annotated[str, Rule(pattern="^[0-9a-f]{64}$"), Doc("Of the file.")]
    title: str
    solver: Annotated[Literal["z3", "cvc5"], Doc("Who was asked about certificates.")]
    top: Id
    state: Annotated[ElementStateName, Doc("Of the top goal.")]
    elements: Annotated[
        tuple[ArgumentElement, ...], Rule(least=1), Doc("In the order of the file; derived ones last.")
    ]
    open_points: Annotated[
        tuple[ArgumentOpenPoint, ...], Doc("Why the top goal does not hold; the worst first.")
    ]
