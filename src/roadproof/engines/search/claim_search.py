"""Sets up the search for drives that a claim specifies."""

from roadproof.engines.search.limits import SearchLimits
from roadproof.engines.search.question import pose
from roadproof.engines.setting import Search, SearchOptions, Setting
from roadproof.evidence.claim import Claim, Exists, Valid
from roadproof.library.scenarios import Scenario, apply_scenario, numbers_of, scenario_number
from roadproof.runtime.budget import Work


def drive_mode(claim: Claim) -> Exists:
    """Return how drives are looked for. Raises ``ValueError`` for a claim about no drive."""
    match claim.mode:
        case Exists():
            return claim.mode
        case Valid(within=Exists() as within):
            return within
        case other:
            raise ValueError(f"a {type(other).__name__} claim asks for no drive")


def search_for_claim(claim: Claim, work: Work, explain: bool | None = None) -> Search:
    """Return the search that a claim asks for; ``explain`` None: as the claim says.

    Raises ``ValueError`` for a claim about no drive.
    """
    mode = drive_mode(claim)
    setting = Setting(
        road=mode.road,
        lanes=mode.lanes,
        vehicles=mode.vehicles,
        limits=mode.limits,
        values={x.name: x.value for x in claim.parameters},
        horizon=mode.horizon,
        dt=mode.dt,
        reach=mode.reach,
        collisions=mode.collisions,
        natural=mode.natural,
    )
    wants = mode.explain if explain is None else explain
    options = SearchOptions(
        mode.objective, mode.engine, mode.solver, work.effort, mode.refinements, explain=wants
    )
    return Search(claim.home, claim.query, setting, options, mode.unlike, _number_of(claim))


def _number_of(claim: Claim) -> int | None:
    """Return the number of the scenario that a claim is about, as a whole."""
    number = scenario_number(claim.query)
    if number is None or number not in numbers_of(claim.home):
        return None
    whole = apply_scenario(claim.home, Scenario(number, claim.home.set_name))
    return number if whole.formula == claim.formula else None


def limits_for_claim(claim: Claim) -> SearchLimits:
    """Return within what a search for a drive looks. Raises as ``pose``."""
    search = search_for_claim(claim, Work())
    return pose(claim.home.library, claim.query, search.setting).limits()
