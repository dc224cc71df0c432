"""What to do where no fact is left to be read: an instance, or what divides a branch.

Of what divides, that is chosen of which a side is refuted already. Where a guard of an instance is not
decided by the constraints, they are divided by it.
"""

from collections.abc import Iterator
from typing import TypeAlias

from roadproof.evidence.atoms import up_to_variables
from roadproof.evidence.sites import Site
from roadproof.evidence.times import ZERO, Moment, at, moment_of
from roadproof.extensions.kernel import branch as b
from roadproof.extensions.kernel.linear import GOAL, Witness
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import rename
from roadproof.reasons import Why

# How many sides are open, and what divides: a disjunction by its number, or an instance.
_Choice: TypeAlias = tuple[int, int | tuple[b.Universal, Moment | str]]


def next_move(means: b.Means, branch: b.Branch) -> b.Move | b.Proof:
    """A step, or the end of a branch. Raises ``NotFoundError`` where nothing is left to be done."""
    return _instance(means, branch) or _meeting(means, branch) or _divide(means, branch)


# --- instances that do not divide ----------------------------------------------------------------


def _instance(means: b.Means, branch: b.Branch) -> b.Move | None:
    for universal, moment in branch.waiting("all", "lemma"):
        if universal.kind == "lemma":
            universal.left.remove(moment)
            lemma = b.At(True, moment, means.goal.lemmas[universal.number][0])
            return b.Move("Fact", (universal.number, moment), (), [([lemma], [])])
        guards = _decided(means, branch, universal.number, moment)
        if guards is None:
            continue
        universal.left.remove(moment)
        fact = branch.facts[universal.number]
        if isinstance(fact, b.At):
            body = b.At(fact.sign, moment, f.children(fact.formula)[0])
        else:
            assert isinstance(fact, b.TrueInterval)
            body = b.At(True, moment, fact.formula)
        premises = {universal.number, *b.used(*guards)}
        return b.Move("Inst", (universal.number, moment, *guards), premises, [([body], [])])
    return None


def _guards(fact: b.Fact, moment: Moment) -> list[tuple[bool, Moment]]:
    """What has to be at least 0, or above it where True, for an instance at ``moment``."""
    if isinstance(fact, b.TrueInterval):
        return [(False, moment - fact.low), (True, fact.high - moment)]
    assert isinstance(fact, b.At)
    (interval,) = f.intervals(fact.formula)
    guards = [(False, moment - (fact.moment + moment_of(interval.low)))]
    if interval.high is not None:
        guards.append((False, fact.moment + moment_of(interval.high) - moment))
    return guards


def _decided(means: b.Means, branch: b.Branch, number: int, moment: Moment) -> b.Guards | None:
    key = (number, moment)
    if key not in branch.decided:
        found: list[Witness] = []
        for strict, guard in _guards(branch.facts[number], moment):
            witness = means.linear.entails(guard, strict)
            if witness is None:
                return None
            found.append(witness)
        branch.decided[key] = (found[0], found[1] if len(found) > 1 else ())
    return branch.decided[key]


# --- what constraints close ----------------------------------------------------------------------


def _meeting(means: b.Means, branch: b.Branch) -> b.Proof | None:
    """Something is true and false at two moments that constraints added since have made one."""
    for entries in branch.known.values():
        for sign, there, true in entries:
            for other, here, false in entries:
                if sign and not other and (equal := means.equal(there, here)) is not None:
                    return b.Step("Close", (true, false, *equal)), frozenset({true, false}) | b.used(*equal)
    return None


# --- what divides --------------------------------------------------------------------------------


def _divide(means: b.Means, branch: b.Branch) -> b.Move:
    best = _best_choice(means, branch)
    if best is None or best[0] > 1:
        for choice in _dividing(means, branch):
            if best is None or choice[0] < best[0]:
                best = choice
    best = best or _with_any_lane(branch)
    if best is None:
        cut = _open_guard(means, branch) or _open_equality(means, branch)
        if cut is None:
            raise b.NotFoundError(Why.INSTANCES_USED())
        return b.Move("Cut", (cut,), (), [([], [(False, cut)]), ([], [(True, ZERO - cut)])])
    chosen = best[1]
    if isinstance(chosen, int):
        branch.choices.remove(chosen)
        fact = branch.at(chosen)
        assert isinstance(fact.formula, f.And | f.Or)
        halves = [b.At(fact.sign, fact.moment, x) for x in b.two(fact.formula)]
        return b.Move("Beta", (chosen,), (chosen,), [([x], []) for x in halves])
    universal, where = chosen
    universal.left.remove(where)
    if isinstance(where, Moment):
        return _until_fails(means, branch, universal, where)
    return _on_road(means, branch, universal, where)


def _best_choice(means: b.Means, branch: b.Branch) -> _Choice | None:
    """A disjunction, by how many of its parts are open; those that hold already are dropped."""
    best: _Choice | None = None
    for number in list(branch.choices):
        fact = branch.at(number)
        parts = f.children(fact.formula)
        if any(_holds(means, branch, fact.sign, fact.moment, x) for x in parts):
            branch.choices.remove(number)
            continue
        left = sum(not _refuted(means, branch, fact.sign, fact.moment, x) for x in parts)
        if best is None or left < best[0]:
            best = (left, number)
            if left <= 1:
                break
    return best


def _dividing(means: b.Means, branch: b.Branch) -> Iterator[_Choice]:
    """Instances that divide, with how many sides are open."""
    for universal in branch.universals:
        if universal.kind == "until":
            formula = branch.at(universal.number).formula
            assert isinstance(formula, f.Until)
            for where in list(universal.left):
                known = isinstance(where, Moment) and {name for name, _ in where.parts} <= branch.times
                if isinstance(where, Moment) and known and _decided(means, branch, universal.number, where):
                    yield 2 - _refuted(means, branch, False, where, formula.right), (universal, where)
        elif universal.kind == "road":
            yield from ((2, (universal, x)) for x in list(universal.left) if x in branch.elements)


def _with_any_lane(branch: b.Branch) -> _Choice | None:
    """An instance at an element that nothing is known of, called so from now on: a road has a lane."""
    for universal in branch.universals:
        fact = branch.facts.get(universal.number) if universal.kind == "road" else None
        if not isinstance(fact, b.At) or not isinstance(fact.formula, f.Some | f.Every):
            continue
        if fact.formula.domain.kind == "lanes":
            for name in universal.left:
                if isinstance(name, str) and name not in branch.elements:
                    branch.elements.add(name)
                    return 2, (universal, name)
    return None


def _until_fails(means: b.Means, branch: b.Branch, universal: b.Universal, moment: Moment) -> b.Move:
    fact = branch.at(universal.number)
    guards = _decided(means, branch, universal.number, moment)
    assert isinstance(fact.formula, f.Until)
    assert guards is not None
    assert universal.site is not None
    name = means.named(Site(universal.site.formula, False, universal.site.moment, str(moment)), "u")
    low = fact.moment + moment_of(fact.formula.interval.low)
    before = [(False, at(name) - low), (True, moment - at(name))]
    return b.Move(
        "InstUntil",
        (universal.number, moment, *guards),
        (universal.number, *b.used(*guards)),
        [
            ([b.At(False, moment, fact.formula.right)], []),
            ([b.At(False, at(name), fact.formula.left)], before),
        ],
        name,
    )


def _on_road(means: b.Means, branch: b.Branch, universal: b.Universal, name: str) -> b.Move:
    fact = branch.at(universal.number)
    formula = fact.formula
    assert isinstance(formula, f.Some | f.Every)
    inside = means.goal.atoms.abstract(rename(formula.body, formula.variable, name))
    outside: list[b.Fact] = [b.Belongs(False, formula.domain, name)]
    sides: list[b.Given] = [(outside, []), ([b.At(fact.sign, fact.moment, inside)], [])]
    return b.Move("InstRoad", (universal.number, name), (universal.number,), sides)


def _open_guard(means: b.Means, branch: b.Branch) -> Moment | None:
    """A guard of an instance that the constraints leave open; instances that they exclude are dropped."""
    for universal, moment in branch.waiting("all", "until"):
        guards = _guards(branch.facts[universal.number], moment)
        with means.linear.taken_back():
            if any(means.linear.add(GOAL, strict, x) is not None for strict, x in guards):
                universal.left.remove(moment)
                continue
        for strict, guard in guards:
            if means.linear.entails(guard, strict) is None:
                return ZERO - guard if strict else guard
    return None


def _open_equality(means: b.Means, branch: b.Branch) -> Moment | None:
    """Two moments that may be one, at which something is true and false."""
    linear = means.linear
    for entries in branch.known.values():
        for true, there, _ in entries:
            for false, here, _ in entries:
                if not true or false or there == here:
                    continue
                for apart in (there - here, here - there):
                    if linear.entails(apart) is None and linear.entails(ZERO - apart, True) is None:
                        return apart
    return None


def _holds(means: b.Means, branch: b.Branch, sign: bool, moment: Moment, formula: Formula) -> bool:
    known = branch.known.get(up_to_variables(formula), ())
    return any(s == sign and m == moment for s, m, _ in known)


def _refuted(means: b.Means, branch: b.Branch, sign: bool, moment: Moment, formula: Formula) -> bool:
    """Whether ``formula`` with this sign would close a branch at once."""
    if isinstance(formula, f.Truth):
        return formula.value != sign
    for known, where, _ in branch.known.get(up_to_variables(formula), ()):
        if known != sign and (where == moment or means.equal(where, moment) is not None):
            return True
    match formula:
        case f.Not(body):
            return _refuted(means, branch, not sign, moment, body)
        case f.And(parts) | f.Or(parts):
            enough = any if isinstance(formula, f.And) == sign else all
            return enough(_refuted(means, branch, sign, moment, x) for x in parts)
        case _:
            return False
