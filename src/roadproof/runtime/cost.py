"""What an answer cost when it was computed."""

from collections.abc import Mapping, Sequence
from dataclasses import field

from roadproof.runtime.records import dataclass


@dataclass(frozen=True)
class Cost:
    """Seconds of the clock, in all and by stage; sizes of the last problem that was solved, units of work."""

    seconds: float = 0.0
    stages: Mapping[str, float] = field(default_factory=dict)
    sizes: Mapping[str, int] = field(default_factory=dict)
    work: float | None = None


NO_COST = Cost()
"""Of an answer that was known."""


def sum_of(costs: Sequence[Cost]) -> Cost:
    """Return what several answers cost; the sizes are those of the first."""
    stages: dict[str, float] = {}
    for cost in costs:
        for name, seconds in cost.stages.items():
            stages[name] = stages.get(name, 0.0) + seconds
    sizes = next((x.sizes for x in costs if x.sizes), {})
    return Cost(sum(x.seconds for x in costs), stages, sizes)
