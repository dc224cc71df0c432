"""What ``check`` asks of evidence about gaps, made of the specification alone: no finder has a part in it."""

from collections.abc import Sequence

from roadproof.evidence.answers.entry import Common
from roadproof.library import scenarios as s
from roadproof.library.compose import both, either, eventually, implication, in_some_lane, negation
from roadproof.library.specification import Query, Specification
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import without_names


def fault_of_gap(common: Common, numbers: Sequence[int], formula: str) -> str:
    """Why a formula does not say that the scenarios miss two vehicles that come into danger, or nothing."""
    said, home = common.formula(formula), common.specification
    conjuncts = {*said.parts} if isinstance(said, f.And) else {said}
    scenarios = (x for numbers in _sectors(home, numbers).values() for x in _in_either_role(home, numbers))
    asked = [*_starts(home), *(negation(in_some_lane(x, s.LANE)) for x in scenarios)]
    missing = next((x for x in asked if x.formula not in conjuncts), None)
    return "" if missing is None else f"of a gap its formula has to say {missing.text}: {formula[:120]}"


def claims_of(specification: Specification, numbers: Sequence[int] = ()) -> list[Formula]:
    """Where SV is in L, one of the scenarios of its sector holds; and vehicles in zones are in a sector.

    ``numbers``: of these scenarios alone.
    """
    sectors = _sectors(specification, numbers or s.numbers_of(specification)).values()
    claims: list[Formula] = []
    for those in sectors:
        premise = both(
            s.sector(specification, those[0], s.PAIR),
            s.in_lane(specification, s.SUBJECT),
            *_starts(specification),
        )
        claims.append(implication(premise, either(*_in_either_role(specification, those))).formula)
    somewhere = both(*(s.in_some_zone(specification, vehicle) for vehicle in s.PAIR))
    some_sector = either(*(s.sector(specification, those[0], s.PAIR) for those in sectors))
    return [*claims, implication(somewhere, some_sector).formula]


def _sectors(specification: Specification, numbers: Sequence[int]) -> dict[Formula, list[int]]:
    """The scenarios of two vehicles by road sector."""
    sectors: dict[Formula, list[int]] = {}
    for number in numbers:
        if len(s.vehicles_of(specification, s.Scenario(number, specification.set_name))) == len(s.PAIR):
            meaning = without_names(s.sector(specification, number, s.PAIR).formula)
            sectors.setdefault(meaning, []).append(number)
    return sectors


def _starts(specification: Specification) -> tuple[Query, ...]:
    """Safety, danger later, and what else drives are asked to begin with."""
    later = eventually(s.danger(specification, *s.PAIR))
    return s.safe(specification, *s.PAIR), later, *s.asked_between(specification, *s.PAIR)


def _in_either_role(specification: Specification, numbers: Sequence[int]) -> list[Query]:
    """The scenarios for L, with the two vehicles in either role."""
    scenarios = [s.Scenario(number, specification.set_name) for number in numbers]
    return [s.applied(specification, x, roles) for roles in (s.PAIR, s.PAIR[::-1]) for x in scenarios]
