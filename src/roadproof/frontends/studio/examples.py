"""Questions to begin with: each is asked by a click, and answered in seconds."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, Literal

from roadproof.verdict import Verdict


@dataclass(frozen=True)
class Example:
    """A formula with the question to ask of it; ``verdict``: the answer in the set base without edits."""

    title: str
    job: Literal["find", "prove"]
    formula: str
    verdict: Verdict


EXAMPLES: Final[Sequence[Example]] = (
    Example(
        "Brake behind a slower vehicle at more than 100 km/h",
        "find",
        "scenario_4(SV,POV,L) and v_lon(SV) > 100 km/h",
        Verdict.WITNESSED,
    ),
    Example(
        "Two cut-ins at once: SV keeps its lane at first, and leaves it later",
        "find",
        "scenario_1(SV,POV,L) and scenario_5(SV,POV,L)",
        Verdict.WITNESSED,
    ),
    Example(
        "Cut-in and slower vehicle ahead: not on one drive",
        "find",
        "scenario_1(SV,POV,L) and scenario_4(SV,POV,L)",
        Verdict.IMPOSSIBLE,
    ),
    Example(
        "Less than 5 m along the road, and never in danger",
        "find",
        "G not danger(SV,POV) and F[0, 3 s] s(POV) - s(SV) < 5 m",
        Verdict.WITNESSED,
    ),
    Example(
        "A cut-in during which POV becomes slower than 30 km/h",
        "find",
        "scenario_1(SV,POV,L) and F v_lon(POV) < 30 km/h",
        Verdict.NONE_WITHIN,
    ),
    Example(
        "Scenario 8 always leads to danger",
        "prove",
        "scenario_8(SV,POV,L) -> F danger(SV,POV)",
        Verdict.PROVED,
    ),
    Example(
        "Scenarios 3 and 4 are the same, seen from the other vehicle",
        "prove",
        "scenario_3(SV,POV,L) <-> scenario_4(POV,SV,L)",
        Verdict.PROVED,
    ),
    Example(
        "Each violation of RSS distances is danger: a false claim",
        "prove",
        "rssViolation(SV,POV) -> danger(SV,POV)",
        Verdict.REFUTED,
    ),
)
