"""Which scenarios can hold while no other one does."""

from collections.abc import Mapping
from functools import cached_property
from typing import ClassVar

from roadproof.extensions.surveys.survey import Survey
from roadproof.library.compose import both, negation
from roadproof.library.scenarios import Scenario, apply_scenario, name_of
from roadproof.library.specification import Query
from roadproof.runtime.records import dataclass


@dataclass(frozen=True)
class Alone(Survey):
    """For each scenario of two vehicles: can it hold while no other of them does?"""

    kind: ClassVar[str] = "alone"

    @cached_property
    def scenarios(self) -> dict[str, Query]:
        """The scenarios of two vehicles, by name."""
        home = self.basis.specification
        every = {name_of(n): apply_scenario(home, Scenario(n, home.set_name)) for n in self.settings.numbers}
        return {name: x for name, x in every.items() if len(x.vehicles) == 2}

    @cached_property
    def queries(self) -> Mapping[str, Query]:
        """Each scenario without all others."""
        return {
            name: both(query, *(negation(x) for other, x in self.scenarios.items() if other != name))
            for name, query in self.scenarios.items()
        }
