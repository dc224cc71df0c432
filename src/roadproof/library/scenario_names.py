"""A scenario by number and set, and the names of its vehicles and lane; no definitions are read."""

from roadproof.runtime.records import dataclass

SUBJECT, LANE = "SV", "L"
PAIR, TRIPLE = (SUBJECT, "POV"), (SUBJECT, "POV1", "POV2")
"""The names of vehicles in scenarios of two and of three."""


@dataclass(frozen=True)
class Scenario:
    """A scenario by number, in a spec set."""

    number: int
    set_name: str

    def __str__(self) -> str:
        return f"{self.number}@{self.set_name}"
