"""Questions of tests as text: the doors of the command line, without one."""

from roadproof.engines.prove import prover
from roadproof.engines.prove.prover import ProverResult
from roadproof.engines.search.question import SearchProblem, pose
from roadproof.engines.setting import Search, SearchOptions, Setting
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.library.scenario_references import read_query
from roadproof.library.specification import Specification
from roadproof.runtime.budget import Effort
from roadproof.world.models import load_road, load_vehicle


def prove(specification: Specification, claim: str, *options: object) -> ProverResult:
    """``prover.prove`` of a claim as text."""
    return prover.prove(specification, read_claim(specification, claim), *options)  # type: ignore[arg-type]


def search_for(
    what: str,
    set_name: str = "base",
    search_options: SearchOptions | None = None,
    road: str | None = None,
    vehicles: dict[str, str] | None = None,
    **setting: object,
) -> Search:
    """A search for a scenario by number, or a formula; ``setting`` as ``Setting``."""
    specification = bundled_library().select(set_name)
    scenario, query = read_query(specification, what)
    place = Setting(
        road=None if road is None else load_road(road),
        vehicles={name: load_vehicle(model) for name, model in (vehicles or {}).items()},
        **setting,  # type: ignore[arg-type]
    )
    return Search(
        specification, query, place, search_options or SearchOptions(effort=Effort(30)), scenario=scenario
    )


def search_problem(search: Search) -> SearchProblem:
    """The question of a search, with road, vehicles and grid in place."""
    return pose(search.specification.library, search.query, search.setting)
