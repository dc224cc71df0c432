"""Sector twins: scenarios that differ in their road sectors only."""

from roadproof.library.scenarios import Scenario, apply_scenario, numbers_of, without_sectors
from roadproof.library.specification import Specification
from roadproof.logic.formula import Formula


def sector_twin(specification: Specification, number: int) -> int:
    """Return the first scenario that equals this one up to its road sector; perhaps the scenario itself.

    Elaborates no scenario between the two.
    """
    sector_free = _without_sector(specification, number)
    return next(x for x in numbers_of(specification) if _without_sector(specification, x) == sector_free)


def sector_twins(specification: Specification) -> dict[int, int]:
    """Return the ``sector_twin`` of every scenario."""
    return {number: sector_twin(specification, number) for number in numbers_of(specification)}


def _without_sector(specification: Specification, number: int) -> Formula:
    """Return a scenario without its road sector."""
    key = "anywhere", number, specification.set_name
    known: Formula | None = specification.memo.get(key)
    if known is None:
        query = apply_scenario(specification, Scenario(number, specification.set_name))
        known = specification.memo[key] = without_sectors(query.formula)
    return known
