"""The immediate consequences of a fact: a closed branch, a step with one child, or an entry for later."""

from collections.abc import Sequence

from roadproof.errors import InputError
from roadproof.evidence.atoms import is_rigid, up_to_variables
from roadproof.evidence.road_axioms import ZONES
from roadproof.evidence.sites import Site, prefix_form
from roadproof.evidence.times import ZERO, Moment, compared_times, moment_of, named_moment
from roadproof.extensions.kernel.branch import (
    Belongs,
    Branch,
    Fact,
    Move,
    NotFoundError,
    PendingUniversal,
    Proof,
    SharedState,
    TableauStep,
    TrueInterval,
    TruthAt,
    constraints_in,
    first_and_rest,
)
from roadproof.logic import formula as f
from roadproof.logic.rewrite import rename
from roadproof.reasons import ReasonKind


def read(shared: SharedState, branch: Branch, number: int) -> Proof | Move | None:
    """Return the step for a new fact of a branch; None if it is only stored."""
    fact = branch.facts[number]
    match fact:
        case Belongs():
            return _no_road(branch, number, fact)
        case TrueInterval(site=site):
            branch.universals.append(PendingUniversal("all", number, site, shared.listed(site)))
            return None
        case TruthAt():
            return _read(shared, branch, number, fact)


def _read(shared: SharedState, branch: Branch, number: int, fact: TruthAt) -> Proof | Move | None:
    sign, moment, formula = fact.sign, fact.moment, fact.formula
    if isinstance(formula, f.Truth):
        if formula.value != sign:
            return TableauStep("CloseTruth", (number,)), frozenset({number})
        return None
    closed = _close(shared, branch, number, fact)
    if closed is not None:
        return closed
    known = branch.known.setdefault(up_to_variables(formula), [])
    if any(other_sign == sign and other_moment == moment for other_sign, other_moment, _ in known):
        return None
    known.append((sign, moment, number))
    return _expand(shared, branch, number, fact)


def _close(shared: SharedState, branch: Branch, number: int, fact: TruthAt) -> Proof | None:
    for sign, moment, other in branch.known.get(up_to_variables(fact.formula), ()):
        if sign == fact.sign:
            continue
        true, false = (number, other) if fact.sign else (other, number)
        if f.is_state(fact.formula) and is_rigid(fact.formula):
            return TableauStep("Close", (true, false, (), ())), frozenset({true, false})
        there, here = (fact.moment, moment) if fact.sign else (moment, fact.moment)
        equal = shared.equal(there, here)
        if equal is not None:
            return TableauStep("Close", (true, false, *equal)), frozenset({true, false}) | constraints_in(
                *equal
            )
    return None


def _expand(shared: SharedState, branch: Branch, number: int, fact: TruthAt) -> Move | None:
    sign, moment, formula = fact.sign, fact.moment, fact.formula
    match formula:
        case f.Application(_, _, meaning):
            times = compared_times(meaning, shared.goal.parameters)
            if times is not None and isinstance(meaning, f.Compare):
                return _timing(number, sign, times)
            return None
        case f.Not(body):
            return _one("Alpha", number, [TruthAt(not sign, moment, body)])
        case f.And(parts) | f.Or(parts):
            if isinstance(formula, f.And) == sign:
                return _one("Alpha", number, [TruthAt(sign, moment, x) for x in first_and_rest(formula)])
            if parts:
                branch.choices.append(number)
            return None
        case f.Eventually(interval, body) | f.Always(interval, body):
            site = Site(prefix_form(formula), sign, str(moment))
            if isinstance(formula, f.Eventually) == sign:
                name = shared.name_for(site, "u")
                return _exists(
                    branch, number, name, moment, interval, [TruthAt(sign, named_moment(name), body)]
                )
            branch.universals.append(PendingUniversal("all", number, site, shared.listed(site)))
            return None
        case f.Since():
            raise InputError(f.NO_PAST)
        case f.Until(left, interval, right):
            site = Site(prefix_form(formula), sign, str(moment))
            if sign:
                name = shared.name_for(site, "u")
                low = moment + moment_of(interval.low)
                facts: list[Fact] = [
                    TruthAt(True, named_moment(name), right),
                    TrueInterval(low, named_moment(name), left, site),
                ]
                return _exists(branch, number, name, moment, interval, facts)
            branch.universals.append(PendingUniversal("until", number, site, shared.listed(site)))
            return None
        case f.Some(variable, domain, body) | f.Every(variable, domain, body):
            site = Site(prefix_form(formula), sign, str(moment))
            if isinstance(formula, f.Some) == sign:
                name = shared.name_for(site, "M")
                if name in branch.elements:
                    raise NotFoundError(ReasonKind.TWO_ELEMENTS(name))
                branch.elements.add(name)
                inside = shared.goal.atoms.abstract(rename(body, variable, name))
                facts_of_element: list[Fact] = [Belongs(True, domain, name), TruthAt(sign, moment, inside)]
                return Move("NewRoad", (number, name), (number,), [(facts_of_element, [])])
            branch.universals.append(PendingUniversal("road", number, site, shared.listed(site, str)))
            return None
        case f.Truth() | f.Compare() | f.Occupies():
            raise NotFoundError(ReasonKind.NO_RULE(type(formula).__name__))


def _one(rule: str, number: int, facts: Sequence[Fact]) -> Move:
    return Move(rule, (number,), (number,), [(facts, [])])


def _timing(number: int, sign: bool, times: tuple[Moment, f.Comparison, Moment]) -> Move:
    left, op, right = times
    greater = right - left if op in ("<", "<=") else left - right
    strict = op in ("<", ">")
    constraint = (strict, greater) if sign else (not strict, ZERO - greater)
    return Move("Timing", (number,), (number,), [([], [constraint])])


def _exists(
    branch: Branch, number: int, name: str, moment: Moment, interval: f.Interval, facts: Sequence[Fact]
) -> Move:
    branch.times.add(name)
    window = [(False, named_moment(name) - (moment + moment_of(interval.low)))]
    if interval.high is not None:
        window.append((False, moment + moment_of(interval.high) - named_moment(name)))
    return Move("New", (number,), (number,), [(facts, window)], name)


# --- roads ---------------------------------------------------------------------------------------


def _no_road(branch: Branch, number: int, fact: Belongs) -> Proof | None:
    """Close the branch if its facts about memberships hold on no road."""
    kind, of, name = fact.domain.kind, fact.domain.of, fact.name
    is_always_member = (kind == "lanes" or (kind == "lanelets" and of == name)) if not fact.sign else False
    if is_always_member or (fact.sign and kind == "adjacent" and of == name):
        return TableauStep("CloseRoad", (number,)), frozenset({number})
    outside = {}
    for other, known in branch.facts.items():
        if not isinstance(known, Belongs):
            continue
        if not known.sign and known.domain.kind == "zone" and known.name == name:
            outside[known.domain.of] = other
        for (i, one), (j, another) in (((number, fact), (other, known)), ((other, known), (number, fact))):
            if _never_both(one, another):
                return TableauStep("CloseRoads", (i, j)), frozenset({i, j})
    if set(outside) == set(ZONES):
        three = tuple(outside[zone] for zone in ZONES)
        return TableauStep("CloseZones", three), frozenset(three)
    return None


def _never_both(one: Belongs, other: Belongs) -> bool:
    """Return ``no_roads`` of Tableau.v for two facts, in this order."""
    if one.sign and not other.sign and one.name == other.name and one.domain == other.domain:
        return True
    kinds = (one.domain.kind, other.domain.kind)
    if kinds == ("adjacent", "adjacent") and one.sign and not other.sign:
        return one.domain.of == other.name and other.domain.of == one.name
    if kinds == ("zone", "zone") and one.sign and other.sign:
        return one.name == other.name and one.domain.of != other.domain.of
    return False
