"""The next move of the tableau search when no fact is left to read: an instance, or a split of the branch.

A split with a side that is already refuted comes first. If the constraints decide no guard of an instance,
the branch is split by the guard.
"""

from collections.abc import Iterator
from typing import TypeAlias

from roadproof.evidence.atoms import up_to_variables
from roadproof.evidence.sites import Site
from roadproof.evidence.times import ZERO, Moment, moment_of, named_moment
from roadproof.extensions.kernel.branch import (
    Belongs,
    Branch,
    ChildFacts,
    Fact,
    Guards,
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
from roadproof.extensions.kernel.linear import GOAL, Witness
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import rename
from roadproof.reasons import ReasonKind

# How many sides are open, and what divides: a disjunction by its number, or an instance.
_Choice: TypeAlias = tuple[int, int | tuple[PendingUniversal, Moment | str]]


def next_move(shared: SharedState, branch: Branch) -> Move | Proof:
    """Return a move, or the proof that closes the branch. Raises ``NotFoundError`` if no move is left."""
    return _instance(shared, branch) or _meeting(shared, branch) or _divide(shared, branch)


# --- instances that do not divide ----------------------------------------------------------------


def _instance(shared: SharedState, branch: Branch) -> Move | None:
    for universal, moment in branch.waiting("all", "lemma"):
        if universal.kind == "lemma":
            universal.left.remove(moment)
            lemma = TruthAt(True, moment, shared.goal.lemmas[universal.number][0])
            return Move("Fact", (universal.number, moment), (), [([lemma], [])])
        guards = _decided(shared, branch, universal.number, moment)
        if guards is None:
            continue
        universal.left.remove(moment)
        fact = branch.facts[universal.number]
        if isinstance(fact, TruthAt):
            body = TruthAt(fact.sign, moment, f.children(fact.formula)[0])
        else:
            assert isinstance(fact, TrueInterval)
            body = TruthAt(True, moment, fact.formula)
        premises = {universal.number, *constraints_in(*guards)}
        return Move("Inst", (universal.number, moment, *guards), premises, [([body], [])])
    return None


def _guards(fact: Fact, moment: Moment) -> list[tuple[bool, Moment]]:
    """Return the terms that must be at least 0, or above 0 (True), for an instance at ``moment``."""
    if isinstance(fact, TrueInterval):
        return [(False, moment - fact.low), (True, fact.high - moment)]
    assert isinstance(fact, TruthAt)
    (interval,) = f.intervals(fact.formula)
    guards = [(False, moment - (fact.moment + moment_of(interval.low)))]
    if interval.high is not None:
        guards.append((False, fact.moment + moment_of(interval.high) - moment))
    return guards


def _decided(shared: SharedState, branch: Branch, number: int, moment: Moment) -> Guards | None:
    key = (number, moment)
    if key not in branch.decided:
        witnesses: list[Witness] = []
        for strict, guard in _guards(branch.facts[number], moment):
            witness = shared.linear.entails(guard, strict)
            if witness is None:
                return None
            witnesses.append(witness)
        branch.decided[key] = (witnesses[0], witnesses[1] if len(witnesses) > 1 else ())
    return branch.decided[key]


# --- what constraints close ----------------------------------------------------------------------


def _meeting(shared: SharedState, branch: Branch) -> Proof | None:
    """Close the branch if a formula is true and false at two moments that new constraints make equal."""
    for entries in branch.known.values():
        for sign, there, true in entries:
            for other, here, false in entries:
                if sign and not other and (equal := shared.equal(there, here)) is not None:
                    return TableauStep("Close", (true, false, *equal)), frozenset(
                        {true, false}
                    ) | constraints_in(*equal)
    return None


# --- what divides --------------------------------------------------------------------------------


def _divide(shared: SharedState, branch: Branch) -> Move:
    best = _best_choice(shared, branch)
    if best is None or best[0] > 1:
        for choice in _dividing(shared, branch):
            if best is None or choice[0] < best[0]:
                best = choice
    best = best or _with_any_lane(branch)
    if best is None:
        cut = _open_guard(shared, branch) or _open_equality(shared, branch)
        if cut is None:
            raise NotFoundError(ReasonKind.INSTANCES_USED())
        return Move("Cut", (cut,), (), [([], [(False, cut)]), ([], [(True, ZERO - cut)])])
    chosen = best[1]
    if isinstance(chosen, int):
        branch.choices.remove(chosen)
        fact = branch.at(chosen)
        assert isinstance(fact.formula, f.And | f.Or)
        halves = [TruthAt(fact.sign, fact.moment, x) for x in first_and_rest(fact.formula)]
        return Move("Beta", (chosen,), (chosen,), [([x], []) for x in halves])
    universal, where = chosen
    universal.left.remove(where)
    if isinstance(where, Moment):
        return _until_fails(shared, branch, universal, where)
    return _on_road(shared, branch, universal, where)


def _best_choice(shared: SharedState, branch: Branch) -> _Choice | None:
    """Return the disjunction with the fewest open parts; disjunctions that hold already are dropped."""
    best: _Choice | None = None
    for number in list(branch.choices):
        fact = branch.at(number)
        parts = f.children(fact.formula)
        if any(_holds(shared, branch, fact.sign, fact.moment, x) for x in parts):
            branch.choices.remove(number)
            continue
        left = sum(not _refuted(shared, branch, fact.sign, fact.moment, x) for x in parts)
        if best is None or left < best[0]:
            best = (left, number)
            if left <= 1:
                break
    return best


def _dividing(shared: SharedState, branch: Branch) -> Iterator[_Choice]:
    """Yield instances that split the branch, with the number of open sides."""
    for universal in branch.universals:
        if universal.kind == "until":
            formula = branch.at(universal.number).formula
            assert isinstance(formula, f.Until)
            for where in list(universal.left):
                known = isinstance(where, Moment) and {name for name, _ in where.parts} <= branch.times
                if isinstance(where, Moment) and known and _decided(shared, branch, universal.number, where):
                    yield 2 - _refuted(shared, branch, False, where, formula.right), (universal, where)
        elif universal.kind == "road":
            yield from ((2, (universal, x)) for x in list(universal.left) if x in branch.elements)


def _with_any_lane(branch: Branch) -> _Choice | None:
    """Return an instance at an arbitrary new element: every road has a lane."""
    for universal in branch.universals:
        fact = branch.facts.get(universal.number) if universal.kind == "road" else None
        if not isinstance(fact, TruthAt) or not isinstance(fact.formula, f.Some | f.Every):
            continue
        if fact.formula.domain.kind == "lanes":
            for name in universal.left:
                if isinstance(name, str) and name not in branch.elements:
                    branch.elements.add(name)
                    return 2, (universal, name)
    return None


def _until_fails(shared: SharedState, branch: Branch, universal: PendingUniversal, moment: Moment) -> Move:
    fact = branch.at(universal.number)
    guards = _decided(shared, branch, universal.number, moment)
    assert isinstance(fact.formula, f.Until)
    assert guards is not None
    assert universal.site is not None
    name = shared.name_for(Site(universal.site.formula, False, universal.site.moment, str(moment)), "u")
    low = fact.moment + moment_of(fact.formula.interval.low)
    before = [(False, named_moment(name) - low), (True, moment - named_moment(name))]
    return Move(
        "InstUntil",
        (universal.number, moment, *guards),
        (universal.number, *constraints_in(*guards)),
        [
            ([TruthAt(False, moment, fact.formula.right)], []),
            ([TruthAt(False, named_moment(name), fact.formula.left)], before),
        ],
        name,
    )


def _on_road(shared: SharedState, branch: Branch, universal: PendingUniversal, name: str) -> Move:
    fact = branch.at(universal.number)
    formula = fact.formula
    assert isinstance(formula, f.Some | f.Every)
    inside = shared.goal.atoms.abstract(rename(formula.body, formula.variable, name))
    outside: list[Fact] = [Belongs(False, formula.domain, name)]
    sides: list[ChildFacts] = [(outside, []), ([TruthAt(fact.sign, fact.moment, inside)], [])]
    return Move("InstRoad", (universal.number, name), (universal.number,), sides)


def _open_guard(shared: SharedState, branch: Branch) -> Moment | None:
    """Return a guard of an instance that the constraints leave open; excluded instances are dropped."""
    for universal, moment in branch.waiting("all", "until"):
        guards = _guards(branch.facts[universal.number], moment)
        with shared.linear.taken_back():
            if any(shared.linear.add(GOAL, strict, x) is not None for strict, x in guards):
                universal.left.remove(moment)
                continue
        for strict, guard in guards:
            if shared.linear.entails(guard, strict) is None:
                return ZERO - guard if strict else guard
    return None


def _open_equality(shared: SharedState, branch: Branch) -> Moment | None:
    """Return the difference of two moments that may be equal, at which a formula is true and false."""
    linear = shared.linear
    for entries in branch.known.values():
        for true, there, _ in entries:
            for false, here, _ in entries:
                if not true or false or there == here:
                    continue
                for apart in (there - here, here - there):
                    if linear.entails(apart) is None and linear.entails(ZERO - apart, True) is None:
                        return apart
    return None


def _holds(shared: SharedState, branch: Branch, sign: bool, moment: Moment, formula: Formula) -> bool:
    known = branch.known.get(up_to_variables(formula), ())
    return any(other_sign == sign and other_moment == moment for other_sign, other_moment, _ in known)


def _refuted(shared: SharedState, branch: Branch, sign: bool, moment: Moment, formula: Formula) -> bool:
    """Return whether the formula with this sign would close the branch at once."""
    if isinstance(formula, f.Truth):
        return formula.value != sign
    for known, where, _ in branch.known.get(up_to_variables(formula), ()):
        if known != sign and (where == moment or shared.equal(where, moment) is not None):
            return True
    match formula:
        case f.Not(body):
            return _refuted(shared, branch, not sign, moment, body)
        case f.And(parts) | f.Or(parts):
            combine = any if isinstance(formula, f.And) == sign else all
            return combine(_refuted(shared, branch, sign, moment, x) for x in parts)
        case f.Compare() | f.Occupies() | f.Some() | f.Every() | f.Application():
            return False
        case f.Until() | f.Since() | f.Eventually() | f.Always():
            return False
