"""Scenarios that differ in their road sectors only."""

from roadproof.library.scenarios import Scenario, applied, numbers_of, without_sectors
from roadproof.library.specification import Specification
from roadproof.logic.formula import Formula


def like_of(specification: Specification, number: int) -> int:
    """The first scenario that differs from this one in its road sector only; itself where it is the first.

    Elaborates no scenario between the two.
    """
    wanted = _anywhere(specification, number)
    return next(x for x in numbers_of(specification) if _anywhere(specification, x) == wanted)


def likes_of(specification: Specification) -> dict[int, int]:
    """``like_of`` every scenario."""
    return {number: like_of(specification, number) for number in numbers_of(specification)}


def _anywhere(specification: Specification, number: int) -> Formula:
    """A scenario without its road sector."""
    key = "anywhere", number, specification.set_name
    known: Formula | None = specification.worked_out.get(key)
    if known is None:
        query = applied(specification, Scenario(number, specification.set_name))
        known = specification.worked_out[key] = without_sectors(query.formula)
    return known
