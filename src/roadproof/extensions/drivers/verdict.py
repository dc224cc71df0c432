"""The verdict on a driver model in a test, as answers store it."""

from collections.abc import Mapping
from typing import Annotated, TypeAlias

from roadproof.evidence.codec import Doc, Rule
from roadproof.evidence.subject import TestedSide
from roadproof.runtime.records import dataclass

Time: TypeAlias = Annotated[float, Rule(minimum=0)]


@dataclass(frozen=True, kw_only=True)
class DriverVerdict:
    """The outcome of a scenario of a test in which a driver model drives SV."""

    scenario: Annotated[str, Rule(least=1), Doc("The definition of a scenario.")]
    vehicles: Annotated[tuple[str, ...], Doc("In the order of the roles.")]
    driver: Annotated[str, Rule(least=1), Doc("The driver model.")]
    side: TestedSide
    at: Annotated[Time | None, Doc("When the manoeuvre begins, in s; null where it never does.")]
    gap: Annotated[float | None, Doc("The least gap that SV leaves, in m; null where it touches POV.")]
    instant: Annotated[Time | None, Doc("When SV touches POV, in s.")]
    speed: Annotated[float | None, Doc("How much faster SV then is, in m/s.")]
    start: Annotated[
        Mapping[str, float],
        Doc("The state when the manoeuvre begins, as the sheets of UN R157 name it (SI)."),
    ]
    reason: Annotated[str, Doc("Why it is not covered or undecided, and what is to be known of the start.")]
