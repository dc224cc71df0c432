"""The basis of analyses: definitions, values of parameters, and how hard is searched."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import field
from fractions import Fraction
from typing import TYPE_CHECKING, TypedDict

from roadproof.evidence.claim import Claim, Exists, claim_of
from roadproof.library.bind import values_with
from roadproof.runtime.budget import Effort, Work
from roadproof.runtime.records import dataclass

if TYPE_CHECKING:
    from roadproof.engines.setting import Search
    from roadproof.evidence.claim import Objective
    from roadproof.library.specification import Library, Query, Specification
    from roadproof.world.road import Road
    from roadproof.world.vehicle import Vehicle


class CommonFields(TypedDict):
    """The fields that the data of all views have, as keywords."""

    options: Mapping[str, str]
    parameters: Mapping[str, str]
    specs: tuple[str, ...]


@dataclass(frozen=True)
class Basis:
    """``specification`` has the definitions of the first of ``sets``, in which names without @ are read.

    ``values``: parameters with another value than the declared one (SI); ``horizon``: seconds of driving
    that are searched; ``effort`` for one drive; ``proof``: units of work for a proof before a drive is
    looked for; ``objective``: what drives should be like; ``vehicles``: models by name, "" for all others,
    where another than a car is wanted.
    """

    specification: Specification
    sets: tuple[str, ...] = ()
    values: Mapping[str, Fraction] = field(default_factory=dict)
    horizon: Fraction = Fraction(6)
    effort: Effort = field(default_factory=Effort)
    proof: float = 3.0
    objective: Objective = "smooth"
    vehicles: Mapping[str, Vehicle] = field(default_factory=dict)

    @property
    def library(self) -> Library:
        return self.specification.library

    @property
    def set_names(self) -> tuple[str, ...]:
        """The spec sets that are spoken of; that of the specification where no others are."""
        return self.sets or (self.specification.set_name,)

    @property
    def work(self) -> Work:
        """The work that is allowed for a claim."""
        return Work(self.effort, self.proof)

    def all_values(self) -> dict[str, Fraction]:
        """The value of every parameter. Raises ``InputError``."""
        return values_with(self.library, self.values)

    def common_data(self, without: Collection[str] = ()) -> CommonFields:
        """Return the data that all views have: options, values of parameters, specification files.

        ``without``: parameters that are left out.
        """
        from roadproof.evidence.specifications import specification_names  # here: for data alone

        values = sorted((name, str(value)) for name, value in self.all_values().items())
        files = tuple(specification_names(self.library))
        parameters = {name: value for name, value in values if name not in without}
        return {"options": dict(self.specification.options), "parameters": parameters, "specs": files}

    def claim(self, query: Query) -> Claim:
        """The claim that there is a drive on which ``query`` holds, within the limits of this basis."""
        vehicles = {name: x for name, x in self.vehicles.items() if not name or name in query.vehicles}
        mode = Exists(vehicles=vehicles, horizon=self.horizon, objective=self.objective)
        return claim_of(self.specification, query, mode, self.values)

    def search(
        self, query: Query, road: Road | None = None, effort: Effort | None = None, explain: bool = False
    ) -> Search:
        """A search for a drive on which ``query`` holds."""
        from roadproof.engines.setting import Search, SearchOptions, Setting

        vehicles = {name: x for name, x in self.vehicles.items() if not name or name in query.vehicles}
        setting = Setting(road=road, vehicles=vehicles, values=self.values, horizon=self.horizon)
        search_options = SearchOptions(self.objective, effort=effort or self.effort, explain=explain)
        return Search(self.specification, query, setting, search_options)
