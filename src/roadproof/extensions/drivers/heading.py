"""The field of an answer whose question a driver model restricts."""

from typing import Annotated, Literal, TypeAlias

from roadproof.evidence.answers.shared import Number
from roadproof.evidence.codec import LEFT_OUT, Doc, Rule
from roadproof.evidence.schema_notes import SharedType
from roadproof.runtime.records import dataclass


@dataclass(frozen=True, kw_only=True)
class PreventionData:
    """The restriction of a question to states that a driver model prevents, or cannot prevent."""

    side: Literal["preventable", "unpreventable"]
    driver: Annotated[str, Rule(least=1), Doc("The driver model.")]
    of: Annotated[
        Literal["scenarios", "drives"],
        Doc("What begins so: scenarios, or, for coverage, drives between two vehicles."),
    ]
    scenarios: Annotated[tuple[Number, ...], Doc("The scenarios that begin so; all others are as they are.")]
    drives_by: Annotated[
        Literal["formula", "model"],
        Doc(
            "Which drives count: by the formula of a state those that begin so; by the model those in which "
            "it, in place of SV, ends so."
        ),
    ]


PreventionField: TypeAlias = Annotated[
    PreventionData,
    Doc(
        "Of a question that is asked only of what a driver model prevents, or cannot prevent; left out in "
        "all others."
    ),
    SharedType("prevention"),
]


@dataclass(frozen=True, kw_only=True)
class PreventionHeading:
    """The field that the heading of each answer has where a driver model restricts its question."""

    prevention: Annotated[PreventionField | None, LEFT_OUT] = None
