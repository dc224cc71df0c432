"""Settings of a search: where, with whom and for how long drives are sought, and how."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field, replace
from fractions import Fraction
from typing import TYPE_CHECKING

from roadproof.evidence.claim import Claim, Engine, Exists, Objective, claim_of
from roadproof.library.specification import Query, Specification
from roadproof.runtime.budget import Effort
from roadproof.runtime.records import dataclass

if TYPE_CHECKING:
    from roadproof.world.drive import Drive
    from roadproof.world.road import Road
    from roadproof.world.vehicle import Vehicle


@dataclass(frozen=True)
class Setting:
    """The road, vehicles and limits of a search; a formula makes a ``SearchProblem`` of it.

    ``road`` None is the usual road of the formula; ``lanes`` are free lanes that stand for one lane.
    ``vehicles`` by name, "" for all others (where nothing is said a car, or of what kind the formula asks
    for), and ``limits`` other limits than theirs, such as ``{"POV": {"a_lon.min": -2}}``
    (``world.vehicle.with_limits``). ``values``: parameters with another value than the declared one (SI).
    ``horizon``, ``dt``: seconds; ``dt`` None is the coarsest
    that fits (``grid.fitting_grid``). ``reach``: how far apart
    vehicles may start (m). ``collisions``: boxes may overlap. ``natural``: whether natural drives are tried
    first.
    """

    road: Road | None = None
    lanes: Mapping[str, str] = field(default_factory=dict)
    vehicles: Mapping[str, Vehicle] = field(default_factory=dict)
    limits: Mapping[str, Mapping[str, Fraction]] = field(default_factory=dict)
    values: Mapping[str, Fraction] = field(default_factory=dict)
    horizon: Fraction = Fraction(6)
    dt: Fraction | None = None
    reach: Fraction = Fraction(80)
    collisions: bool = False
    natural: bool = True


@dataclass(frozen=True)
class SearchOptions:
    """The settings of a search: engine, solver, objective, work for one drive, finer grids to try.

    ``explain``: whether to show that there is none where none was found.
    """

    objective: Objective = "smooth"
    engine: Engine = "milp"
    solver: str = "highs"
    effort: Effort = field(default_factory=Effort)
    refinements: int = 2
    explain: bool = True


def exists_mode(setting: Setting, options: SearchOptions) -> Exists:
    """Return the mode of a claim: every field of both settings except parameter values and effort.

    A field that ``Exists`` lacks is an error, so none can be left out of the digest of a claim.
    """
    given = {**vars(setting), **vars(options)}
    return Exists(**{name: value for name, value in given.items() if name not in ("values", "effort")})


@dataclass(frozen=True)
class Search:
    """A search for a drive on which ``query`` holds, clearly different from those in ``unlike``.

    ``scenario``: the number of the scenario, if the query is one.
    """

    specification: Specification
    query: Query
    setting: Setting = field(default_factory=Setting)
    search_options: SearchOptions = field(default_factory=SearchOptions)
    unlike: tuple[Drive, ...] = ()
    scenario: int | None = None

    @property
    def claim(self) -> Claim:
        """The claim that there is such a drive, without the effort of looking for it."""
        mode = replace(exists_mode(self.setting, self.search_options), unlike=self.unlike)
        return claim_of(self.specification, self.query, mode, self.setting.values)
