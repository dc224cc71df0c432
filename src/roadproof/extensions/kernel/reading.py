"""What a fact gives at once: a branch that closes, a step with one child, or something to come back to."""

from collections.abc import Sequence

from roadproof.evidence.atoms import is_rigid, up_to_variables
from roadproof.evidence.road_axioms import ZONES
from roadproof.evidence.sites import Site, prefix_form
from roadproof.evidence.times import ZERO, Moment, at, compared_times, moment_of
from roadproof.extensions.kernel import branch as b
from roadproof.logic import formula as f
from roadproof.logic.rewrite import rename
from roadproof.reasons import Why


def read(means: b.Means, branch: b.Branch, number: int) -> b.Proof | b.Move | None:
    """What to do about a fact that is new on a branch; None where it is only remembered."""
    fact = branch.facts[number]
    match fact:
        case b.Belongs():
            return _no_road(branch, number, fact)
        case b.TrueInterval(site=site):
            branch.universals.append(b.Universal("all", number, site, means.listed(site)))
            return None
        case b.At():
            return _read(means, branch, number, fact)


def _read(means: b.Means, branch: b.Branch, number: int, fact: b.At) -> b.Proof | b.Move | None:
    sign, moment, formula = fact.sign, fact.moment, fact.formula
    if isinstance(formula, f.Truth):
        if formula.value != sign:
            return b.Step("CloseTruth", (number,)), frozenset({number})
        return None
    closed = _close(means, branch, number, fact)
    if closed is not None:
        return closed
    known = branch.known.setdefault(up_to_variables(formula), [])
    if any(s == sign and m == moment for s, m, _ in known):
        return None
    known.append((sign, moment, number))
    return _expand(means, branch, number, fact)


def _close(means: b.Means, branch: b.Branch, number: int, fact: b.At) -> b.Proof | None:
    for sign, moment, other in branch.known.get(up_to_variables(fact.formula), ()):
        if sign == fact.sign:
            continue
        true, false = (number, other) if fact.sign else (other, number)
        if f.is_state(fact.formula) and is_rigid(fact.formula):
            return b.Step("Close", (true, false, (), ())), frozenset({true, false})
        there, here = (fact.moment, moment) if fact.sign else (moment, fact.moment)
        equal = means.equal(there, here)
        if equal is not None:
            return b.Step("Close", (true, false, *equal)), frozenset({true, false}) | b.used(*equal)
    return None


def _expand(means: b.Means, branch: b.Branch, number: int, fact: b.At) -> b.Move | None:
    sign, moment, formula = fact.sign, fact.moment, fact.formula
    match formula:
        case f.Application(_, _, meaning):
            times = compared_times(meaning, means.goal.parameters)
            if times is not None and isinstance(meaning, f.Compare):
                return _timing(number, sign, times)
            return None
        case f.Not(body):
            return _one("Alpha", number, [b.At(not sign, moment, body)])
        case f.And(parts) | f.Or(parts):
            if isinstance(formula, f.And) == sign:
                return _one("Alpha", number, [b.At(sign, moment, x) for x in b.two(formula)])
            if parts:
                branch.choices.append(number)
            return None
        case f.Eventually(interval, body) | f.Always(interval, body):
            site = Site(prefix_form(formula), sign, str(moment))
            if isinstance(formula, f.Eventually) == sign:
                name = means.named(site, "u")
                return _exists(branch, number, name, moment, interval, [b.At(sign, at(name), body)])
            branch.universals.append(b.Universal("all", number, site, means.listed(site)))
            return None
        case f.Until(left, interval, right):
            site = Site(prefix_form(formula), sign, str(moment))
            if sign:
                name = means.named(site, "u")
                low = moment + moment_of(interval.low)
                given: list[b.Fact] = [b.At(True, at(name), right), b.TrueInterval(low, at(name), left, site)]
                return _exists(branch, number, name, moment, interval, given)
            branch.universals.append(b.Universal("until", number, site, means.listed(site)))
            return None
        case f.Some(variable, domain, body) | f.Every(variable, domain, body):
            site = Site(prefix_form(formula), sign, str(moment))
            if isinstance(formula, f.Some) == sign:
                name = means.named(site, "M")
                if name in branch.elements:
                    raise b.NotFoundError(Why.TWO_ELEMENTS(name))
                branch.elements.add(name)
                inside = means.goal.atoms.abstract(rename(body, variable, name))
                met: list[b.Fact] = [b.Belongs(True, domain, name), b.At(sign, moment, inside)]
                return b.Move("NewRoad", (number, name), (number,), [(met, [])])
            branch.universals.append(b.Universal("road", number, site, means.listed(site, str)))
            return None
        case _:
            raise b.NotFoundError(Why.NO_RULE(type(formula).__name__))


def _one(rule: str, number: int, facts: Sequence[b.Fact]) -> b.Move:
    return b.Move(rule, (number,), (number,), [(facts, [])])


def _timing(number: int, sign: bool, times: tuple[Moment, f.Comparison, Moment]) -> b.Move:
    left, op, right = times
    greater = right - left if op in ("<", "<=") else left - right
    strict = op in ("<", ">")
    constraint = (strict, greater) if sign else (not strict, ZERO - greater)
    return b.Move("Timing", (number,), (number,), [([], [constraint])])


def _exists(
    branch: b.Branch, number: int, name: str, moment: Moment, interval: f.Interval, facts: Sequence[b.Fact]
) -> b.Move:
    branch.times.add(name)
    window = [(False, at(name) - (moment + moment_of(interval.low)))]
    if interval.high is not None:
        window.append((False, moment + moment_of(interval.high) - at(name)))
    return b.Move("New", (number,), (number,), [(facts, window)], name)


# --- roads ---------------------------------------------------------------------------------------


def _no_road(branch: b.Branch, number: int, fact: b.Belongs) -> b.Proof | None:
    """What no road has closes a branch."""
    kind, of, name = fact.domain.kind, fact.domain.of, fact.name
    alone = (kind == "lanes" or (kind == "lanelets" and of == name)) if not fact.sign else False
    if alone or (fact.sign and kind == "adjacent" and of == name):
        return b.Step("CloseRoad", (number,)), frozenset({number})
    outside = {}
    for other, known in branch.facts.items():
        if not isinstance(known, b.Belongs):
            continue
        if not known.sign and known.domain.kind == "zone" and known.name == name:
            outside[known.domain.of] = other
        for (i, one), (j, another) in (((number, fact), (other, known)), ((other, known), (number, fact))):
            if _never_both(one, another):
                return b.Step("CloseRoads", (i, j)), frozenset({i, j})
    if set(outside) == set(ZONES):
        three = tuple(outside[zone] for zone in ZONES)
        return b.Step("CloseZones", three), frozenset(three)
    return None


def _never_both(one: b.Belongs, two: b.Belongs) -> bool:
    """As ``no_roads`` of Tableau.v, in this order."""
    if one.sign and not two.sign and one.name == two.name and one.domain == two.domain:
        return True
    kinds = (one.domain.kind, two.domain.kind)
    if kinds == ("adjacent", "adjacent") and one.sign and not two.sign:
        return one.domain.of == two.name and two.domain.of == one.name
    if kinds == ("zone", "zone") and one.sign and two.sign:
        return one.name == two.name and one.domain.of != two.domain.of
    return False
