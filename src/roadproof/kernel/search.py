"""The search for a tableau, along the instances that a certificate lists. Not trusted: Coq checks it.

A branch holds facts, each true or false at a moment, and constraints on moments. What gives one branch is
done at once; of what divides, that is chosen of which a side is refuted already. Where a guard of an instance
is not decided by the constraints, they are divided by it. Steps of which nothing is used are left out.
"""

import sys
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from fractions import Fraction
from typing import TypeAlias

from roadproof.evidence.atoms import ZONES, Atoms, is_rigid, up_to_variables
from roadproof.evidence.derivation import Site, prefix_form
from roadproof.evidence.times import ZERO, Moment, at, compared_times, moment_of, read_moment
from roadproof.kernel.linear import GOAL, Linear, Witness
from roadproof.kernel.steps import Step, numbered
from roadproof.kernel.tableau import Tableau
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import rename

MOST_STEPS = 20_000
_DEEPEST = 200_000


class NotFoundError(Exception):
    """No tableau was found; the message says why."""


@dataclass(frozen=True)
class Goal:
    """What is to be proved, abstracted, and what may be used.

    ``lemmas``: facts about one instant, with the moments at which they are used. ``strict`` says of each
    bounded parameter whether it is above 0, or at least 0.
    """

    claim: Formula
    atoms: Atoms
    strict: Mapping[str, bool]
    parameters: tuple[str, ...]
    lanes: tuple[str, ...]
    instances: Mapping[Site, Sequence[str]]
    names: Mapping[Site, str]
    lemmas: Sequence[tuple[Formula, Sequence[str]]]


@dataclass(frozen=True)
class _At:
    sign: bool
    moment: Moment
    formula: Formula


@dataclass(frozen=True)
class _Throughout:
    low: Moment
    high: Moment
    formula: Formula
    site: Site


@dataclass(frozen=True)
class _Belongs:
    sign: bool
    domain: f.Domain
    name: str


_Fact: TypeAlias = _At | _Throughout | _Belongs
# What one child of a rule is given.
_Given: TypeAlias = tuple[Sequence[_Fact], Sequence[tuple[bool, Moment]]]


# A proof of a branch: its step, and the facts and constraints that it uses.
_Proof: TypeAlias = tuple[Step, frozenset[int]]
_Guards: TypeAlias = tuple[Witness, Witness]


@dataclass
class _Universal:
    """What may be instantiated: a fact, or a lemma by its place, and what it is still to be tried with."""

    kind: str  # all, until, road, lemma
    number: int
    site: Site | None
    left: list[Moment | str]

    def copy(self) -> "_Universal":
        return _Universal(self.kind, self.number, self.site, list(self.left))


@dataclass
class _Branch:
    facts: dict[int, _Fact] = field(default_factory=dict)
    known: dict[Formula, list[tuple[bool, Moment, int]]] = field(default_factory=dict)
    agenda: list[int] = field(default_factory=list)
    choices: list[int] = field(default_factory=list)
    universals: list[_Universal] = field(default_factory=list)
    times: set[str] = field(default_factory=set)
    elements: set[str] = field(default_factory=set)
    decided: dict[tuple[int, Moment], _Guards] = field(default_factory=dict)

    def copy(self) -> "_Branch":
        return _Branch(
            dict(self.facts),
            {k: list(v) for k, v in self.known.items()},
            list(self.agenda),
            list(self.choices),
            [x.copy() for x in self.universals],
            set(self.times),
            set(self.elements),
            dict(self.decided),
        )


def find(goal: Goal, most_steps: int = MOST_STEPS) -> Tableau:
    """A closed tableau for ``goal``. Raises ``NotFoundError``, and ``InputError`` for what is not read."""
    search = _Search(goal, most_steps)
    with _deep():
        step, _ = search.run()
        return tuple(numbered(step, search.root, search.bounds, goal.parameters))


@contextmanager
def _deep() -> Iterator[None]:
    before = sys.getrecursionlimit()
    sys.setrecursionlimit(max(before, _DEEPEST))
    try:
        yield
    finally:
        sys.setrecursionlimit(before)


class _Search:
    def __init__(self, goal: Goal, most_steps: int) -> None:
        self.goal = goal
        self.left = most_steps
        self.linear = Linear()
        self.count = 0
        self.unnamed = 0
        self.keys: dict[Formula, Formula] = {}
        self.bounds: list[int] = []
        self.bounded = [name for name in goal.parameters if name in goal.strict]
        self.root = 0

    def run(self) -> _Proof:
        branch = _Branch(times=set(self.goal.parameters), elements=set(self.goal.lanes))
        for name in self.bounded:
            self.bounds.append(self._number())
            self.linear.add(self.bounds[-1], self.goal.strict[name], at(name))
        self.root = self._number()
        self._add(branch, self.root, _At(False, ZERO, self.goal.claim))
        for place, (_, moments) in enumerate(self.goal.lemmas):
            branch.universals.append(_Universal("lemma", place, None, [read_moment(x) for x in moments]))
        return self._prove(branch)

    def _number(self) -> int:
        self.count += 1
        return self.count

    def _key(self, formula: Formula) -> Formula:
        if formula not in self.keys:
            self.keys[formula] = up_to_variables(formula)
        return self.keys[formula]

    def _add(self, branch: _Branch, number: int, fact: _Fact) -> None:
        branch.facts[number] = fact
        branch.agenda.append(number)

    # --- what gives one branch ---------------------------------------------------------------------

    def _prove(self, branch: _Branch) -> _Proof:
        self.left -= 1
        if self.left < 0:
            raise NotFoundError("the search for a tableau came to its limit")
        while branch.agenda:
            number = branch.agenda.pop(0)
            fact = branch.facts[number]
            found: _Proof | None
            match fact:
                case _Belongs():
                    found = self._no_road(branch, number, fact)
                case _Throughout(site=site):
                    branch.universals.append(_Universal("all", number, site, self._listed(site)))
                    found = None
                case _At():
                    found = self._read(branch, number, fact)
            if found is not None:
                return found
        return self._instance(branch) or self._divide(branch)

    def _listed(self, site: Site) -> list[Moment | str]:
        return [read_moment(x) for x in self.goal.instances.get(site, ())]

    def _read(self, branch: _Branch, number: int, fact: _At) -> _Proof | None:
        sign, moment, formula = fact.sign, fact.moment, fact.formula
        if isinstance(formula, f.Truth):
            if formula.value != sign:
                return Step("CloseTruth", (number,)), frozenset({number})
            return None
        closed = self._close(branch, number, fact)
        if closed is not None:
            return closed
        known = branch.known.setdefault(self._key(formula), [])
        if any(s == sign and m == moment for s, m, _ in known):
            return None
        known.append((sign, moment, number))
        return self._expand(branch, number, fact)

    def _close(self, branch: _Branch, number: int, fact: _At) -> _Proof | None:
        for sign, moment, other in branch.known.get(self._key(fact.formula), ()):
            if sign == fact.sign:
                continue
            true, false = (number, other) if fact.sign else (other, number)
            if f.is_state(fact.formula) and is_rigid(fact.formula):
                return Step("Close", (true, false, (), ())), frozenset({true, false})
            there, here = (fact.moment, moment) if fact.sign else (moment, fact.moment)
            equal = self._equal(there, here)
            if equal is not None:
                return Step("Close", (true, false, *equal)), frozenset({true, false}) | _used(*equal)
        return None

    def _equal(self, one: Moment, other: Moment) -> tuple[Witness, Witness] | None:
        if one == other:
            trivial: Witness = ((GOAL, Fraction(1)),)
            return trivial, trivial
        least = self.linear.entails(one - other)
        if least is None:
            return None
        most = self.linear.entails(other - one)
        return None if most is None else (least, most)

    def _expand(self, branch: _Branch, number: int, fact: _At) -> _Proof | None:
        sign, moment, formula = fact.sign, fact.moment, fact.formula
        match formula:
            case f.Named(_, _, meaning):
                times = compared_times(meaning, self.goal.parameters)
                if times is not None and isinstance(meaning, f.Compare):
                    return self._timing(branch, number, sign, times)
                return None
            case f.Not(body):
                return self._one(branch, "Alpha", (number,), [number], [_At(not sign, moment, body)])
            case f.And(parts) | f.Or(parts):
                if isinstance(formula, f.And) == sign:
                    both = [_At(sign, moment, x) for x in _two(formula)]
                    return self._one(branch, "Alpha", (number,), [number], both)
                if parts:
                    branch.choices.append(number)
                return None
            case f.Eventually(interval, body) | f.Always(interval, body):
                site = Site(prefix_form(formula), sign, str(moment))
                if isinstance(formula, f.Eventually) == sign:
                    name = self._named(site, "u")
                    return self._exists(branch, number, name, moment, interval, [_At(sign, at(name), body)])
                branch.universals.append(_Universal("all", number, site, self._listed(site)))
                return None
            case f.Until(left, interval, right):
                site = Site(prefix_form(formula), sign, str(moment))
                if sign:
                    name = self._named(site, "u")
                    low = moment + moment_of(interval.low)
                    given: list[_Fact] = [_At(True, at(name), right), _Throughout(low, at(name), left, site)]
                    return self._exists(branch, number, name, moment, interval, given)
                branch.universals.append(_Universal("until", number, site, self._listed(site)))
                return None
            case f.Some(variable, domain, body) | f.Every(variable, domain, body):
                site = Site(prefix_form(formula), sign, str(moment))
                if isinstance(formula, f.Some) == sign:
                    name = self._named(site, "M")
                    branch.elements.add(name)
                    inside = self.goal.atoms.abstract(rename(body, variable, name))
                    met: list[_Fact] = [_Belongs(True, domain, name), _At(sign, moment, inside)]
                    return self._one(branch, "NewRoad", (number, name), [number], met)
                listed = list(self.goal.instances.get(site, ()))
                branch.universals.append(_Universal("road", number, site, [*listed]))
                return None
            case _:
                raise NotFoundError(f"no rule is for {type(formula).__name__}")

    def _timing(
        self, branch: _Branch, number: int, sign: bool, times: tuple[Moment, f.Comparison, Moment]
    ) -> _Proof:
        left, op, right = times
        greater = right - left if op in ("<", "<=") else left - right
        strict = op in ("<", ">")
        constraint = (strict, greater) if sign else (not strict, ZERO - greater)
        return self._apply(branch, "Timing", (number,), [number], [], [constraint])

    def _exists(
        self,
        branch: _Branch,
        number: int,
        name: str,
        moment: Moment,
        interval: f.Interval,
        facts: Sequence[_Fact],
    ) -> _Proof:
        branch.times.add(name)
        window = [(False, at(name) - (moment + moment_of(interval.low)))]
        if interval.high is not None:
            window.append((False, moment + moment_of(interval.high) - at(name)))
        return self._apply(branch, "New", (number,), [number], facts, window, name)

    def _named(self, site: Site, prefix: str) -> str:
        if site in self.goal.names:
            return self.goal.names[site]
        self.unnamed += 1
        return f"{prefix}_{self.unnamed}"

    def _no_road(self, branch: _Branch, number: int, fact: _Belongs) -> _Proof | None:
        """What no road has closes a branch."""
        kind, of, name = fact.domain.kind, fact.domain.of, fact.name
        alone = (kind == "lanes" or (kind == "lanelets" and of == name)) if not fact.sign else False
        if alone or (fact.sign and kind == "adjacent" and of == name):
            return Step("CloseRoad", (number,)), frozenset({number})
        outside = {}
        for other, known in branch.facts.items():
            if not isinstance(known, _Belongs):
                continue
            if not known.sign and known.domain.kind == "zone" and known.name == name:
                outside[known.domain.of] = other
            for (i, one), (j, two) in (((number, fact), (other, known)), ((other, known), (number, fact))):
                if _never_both(one, two):
                    return Step("CloseRoads", (i, j)), frozenset({i, j})
        if set(outside) == set(ZONES):
            three = tuple(outside[zone] for zone in ZONES)
            return Step("CloseZones", three), frozenset(three)
        return None

    def _one(
        self,
        branch: _Branch,
        rule: str,
        arguments: tuple[int | str | Moment | Witness, ...],
        premises: Collection[int],
        facts: Sequence[_Fact],
    ) -> _Proof:
        return self._apply(branch, rule, arguments, premises, facts, [])

    def _apply(
        self,
        branch: _Branch,
        rule: str,
        arguments: tuple[int | str | Moment | Witness, ...],
        premises: Collection[int],
        facts: Sequence[_Fact],
        constraints: Sequence[tuple[bool, Moment]],
        new: str = "",
    ) -> _Proof:
        """A rule with one child, left out where the child uses nothing that it gives."""
        with self.linear.taken_back():
            added, conflict = self._extend(branch, facts, constraints)
            step, used = conflict or self._prove(branch)
        if not used & {*added[0], *added[1]}:
            return step, used
        made = Step(rule, arguments, (step,), (added,), new)
        return made, (used - {*added[0], *added[1]}) | frozenset(premises)

    def _extend(
        self, branch: _Branch, facts: Sequence[_Fact], constraints: Sequence[tuple[bool, Moment]]
    ) -> tuple[tuple[tuple[int, ...], tuple[int, ...]], _Proof | None]:
        conflict: _Proof | None = None
        numbers: list[int] = []
        for strict, moment in constraints:
            numbers.append(self._number())
            witness = None if conflict else self.linear.add(numbers[-1], strict, moment)
            if witness is not None:
                conflict = Step("CloseLinear", (witness,)), _used(witness)
        places = [self._number() for _ in facts]
        for place, fact in zip(places, facts, strict=True):
            self._add(branch, place, fact)
        return (tuple(places), tuple(numbers)), conflict

    # --- instances that do not divide --------------------------------------------------------------

    def _instance(self, branch: _Branch) -> _Proof | None:
        for universal in branch.universals:
            if universal.kind not in ("all", "lemma"):
                continue
            for moment in list(universal.left):
                assert isinstance(moment, Moment)
                if not _names(moment) <= branch.times:
                    continue
                if universal.kind == "lemma":
                    universal.left.remove(moment)
                    lemma = self.goal.lemmas[universal.number][0]
                    return self._one(
                        branch, "Fact", (universal.number, moment), [], [_At(True, moment, lemma)]
                    )
                guards = self._decided(branch, universal.number, moment)
                if guards is None:
                    continue
                universal.left.remove(moment)
                fact = branch.facts[universal.number]
                if isinstance(fact, _At):
                    body = _At(fact.sign, moment, f.children(fact.formula)[0])
                else:
                    assert isinstance(fact, _Throughout)
                    body = _At(True, moment, fact.formula)
                premises = {universal.number, *_used(*guards)}
                return self._one(branch, "Inst", (universal.number, moment, *guards), premises, [body])
        return None

    def _guards(self, fact: _Fact, moment: Moment) -> list[tuple[bool, Moment]]:
        """What has to be at least 0, or above it where True, for an instance at ``moment``."""
        if isinstance(fact, _Throughout):
            return [(False, moment - fact.low), (True, fact.high - moment)]
        assert isinstance(fact, _At)
        (interval,) = f.intervals(fact.formula)
        guards = [(False, moment - (fact.moment + moment_of(interval.low)))]
        if interval.high is not None:
            guards.append((False, fact.moment + moment_of(interval.high) - moment))
        return guards

    def _decided(self, branch: _Branch, number: int, moment: Moment) -> _Guards | None:
        key = (number, moment)
        if key not in branch.decided:
            found: list[Witness] = []
            for strict, guard in self._guards(branch.facts[number], moment):
                witness = self.linear.entails(guard, strict)
                if witness is None:
                    return None
                found.append(witness)
            branch.decided[key] = (found[0], found[1] if len(found) > 1 else ())
        return branch.decided[key]

    # --- what divides ------------------------------------------------------------------------------

    def _divide(self, branch: _Branch) -> _Proof:
        best: tuple[int, int | _Universal, Moment | str | None] | None = self._best_choice(branch)
        if best is None or best[0] > 1:
            for rank, universal, moment in self._dividing(branch):
                if best is None or rank < best[0]:
                    best = (rank, universal, moment)
        if best is None:
            cut = self._open_guard(branch) or self._open_equality(branch)
            if cut is None:
                raise NotFoundError("the instances of the certificate are used up")
            sides: list[_Given] = [([], [(False, cut)]), ([], [(True, ZERO - cut)])]
            return self._branches(branch, "Cut", (cut,), (), sides)
        _, chosen, where = best
        if isinstance(chosen, int):
            branch.choices.remove(chosen)
            fact = branch.facts[chosen]
            assert isinstance(fact, _At)
            assert isinstance(fact.formula, f.And | f.Or)
            halves = [_At(fact.sign, fact.moment, x) for x in _two(fact.formula)]
            if len(halves) == 1:
                return self._one(branch, "Beta", (chosen,), [chosen], halves)
            return self._branches(branch, "Beta", (chosen,), (chosen,), [([x], []) for x in halves])
        assert where is not None
        chosen.left.remove(where)
        if isinstance(where, Moment):
            return self._until_fails(branch, chosen, where)
        return self._on_road(branch, chosen, where)

    def _best_choice(self, branch: _Branch) -> tuple[int, int, None] | None:
        """A disjunction, by how many of its parts are open; those that hold already are dropped."""
        best: tuple[int, int, None] | None = None
        for number in list(branch.choices):
            fact = branch.facts[number]
            assert isinstance(fact, _At)
            parts = f.children(fact.formula)
            if any(self._holds(branch, fact.sign, fact.moment, x) for x in parts):
                branch.choices.remove(number)
                continue
            left = sum(not self._refuted(branch, fact.sign, fact.moment, x) for x in parts)
            if best is None or left < best[0]:
                best = (left, number, None)
                if left <= 1:
                    break
        return best

    def _dividing(self, branch: _Branch) -> Iterator[tuple[int, _Universal, Moment | str]]:
        """Instances that divide, with how many sides are open."""
        for universal in branch.universals:
            for where in list(universal.left):
                if universal.kind == "until" and isinstance(where, Moment):
                    fact = branch.facts[universal.number]
                    assert isinstance(fact, _At)
                    assert isinstance(fact.formula, f.Until)
                    if _names(where) <= branch.times and self._decided(branch, universal.number, where):
                        refuted = self._refuted(branch, False, where, fact.formula.right)
                        yield (1 if refuted else 2), universal, where
                elif universal.kind == "road" and where in branch.elements:
                    yield 2, universal, where

    def _until_fails(self, branch: _Branch, universal: _Universal, moment: Moment) -> _Proof:
        fact = branch.facts[universal.number]
        guards = self._decided(branch, universal.number, moment)
        assert isinstance(fact, _At)
        assert isinstance(fact.formula, f.Until)
        assert guards is not None
        assert universal.site is not None
        site = Site(universal.site.formula, False, universal.site.moment, str(moment))
        name = self._named(site, "u")
        low = fact.moment + moment_of(fact.formula.interval.low)
        sides: list[_Given] = [
            ([_At(False, moment, fact.formula.right)], []),
            (
                [_At(False, at(name), fact.formula.left)],
                [(False, at(name) - low), (True, moment - at(name))],
            ),
        ]
        premises = (universal.number, *_used(*guards))
        return self._branches(branch, "InstUntil", (universal.number, moment, *guards), premises, sides, name)

    def _on_road(self, branch: _Branch, universal: _Universal, name: str) -> _Proof:
        fact = branch.facts[universal.number]
        assert isinstance(fact, _At)
        assert isinstance(fact.formula, f.Some | f.Every)
        formula = fact.formula
        inside = self.goal.atoms.abstract(rename(formula.body, formula.variable, name))
        sides: list[_Given] = [
            ([_Belongs(False, formula.domain, name)], []),
            ([_At(fact.sign, fact.moment, inside)], []),
        ]
        return self._branches(branch, "InstRoad", (universal.number, name), (universal.number,), sides)

    def _open_guard(self, branch: _Branch) -> Moment | None:
        """A guard of an instance that the constraints leave open; instances that they exclude are dropped."""
        for universal in branch.universals:
            if universal.kind not in ("all", "until"):
                continue
            for moment in list(universal.left):
                assert isinstance(moment, Moment)
                if not _names(moment) <= branch.times:
                    continue
                guards = self._guards(branch.facts[universal.number], moment)
                with self.linear.taken_back():
                    if any(self.linear.add(GOAL, strict, x) is not None for strict, x in guards):
                        universal.left.remove(moment)
                        continue
                for strict, guard in guards:
                    if self.linear.entails(guard, strict) is None:
                        return ZERO - guard if strict else guard
        return None

    def _open_equality(self, branch: _Branch) -> Moment | None:
        """Two moments that may be one, at which something is true and false."""
        for entries in branch.known.values():
            for true, there, _ in entries:
                for false, here, _ in entries:
                    if not true or false or there == here:
                        continue
                    for apart in (there - here, here - there):
                        if (
                            self.linear.entails(apart) is None
                            and self.linear.entails(ZERO - apart, True) is None
                        ):
                            return apart
        return None

    def _holds(self, branch: _Branch, sign: bool, moment: Moment, formula: Formula) -> bool:
        known = branch.known.get(self._key(formula), ())
        return any(s == sign and m == moment for s, m, _ in known)

    def _refuted(self, branch: _Branch, sign: bool, moment: Moment, formula: Formula) -> bool:
        """Whether ``formula`` with this sign would close a branch at once."""
        if isinstance(formula, f.Truth):
            return formula.value != sign
        for known, where, _ in branch.known.get(self._key(formula), ()):
            if known != sign and (where == moment or self._equal(where, moment) is not None):
                return True
        match formula:
            case f.Not(body):
                return self._refuted(branch, not sign, moment, body)
            case f.And(parts) | f.Or(parts):
                enough = any if isinstance(formula, f.And) == sign else all
                return enough(self._refuted(branch, sign, moment, x) for x in parts)
            case _:
                return False

    def _branches(
        self,
        branch: _Branch,
        rule: str,
        arguments: tuple[int | str | Moment | Witness, ...],
        premises: Collection[int],
        sides: Sequence[_Given],
        name: str = "",
    ) -> _Proof:
        """A rule with two children; where one of them uses nothing that it is given, it stands alone."""
        steps: list[Step] = []
        given: list[tuple[tuple[int, ...], tuple[int, ...]]] = []
        needed = frozenset(premises)
        for place, (facts, constraints) in enumerate(sides):
            side = branch.copy() if place == 0 else branch
            if name and place == 1:
                side.times.add(name)
            with self.linear.taken_back():
                added, conflict = self._extend(side, facts, constraints)
                step, used = conflict or self._prove(side)
            own = {*added[0], *added[1]}
            if not used & own:
                return step, used
            steps.append(step)
            given.append(added)
            needed |= used - own
        return Step(rule, arguments, tuple(steps), tuple(given), name), needed


def _two(formula: f.And | f.Or) -> tuple[Formula, ...]:
    """A first part and the rest, as Coq has them: p and (q and r)."""
    first, *rest = formula.parts
    if not rest:
        return (first,)
    return first, rest[0] if len(rest) == 1 else type(formula)(tuple(rest))


def _names(moment: Moment) -> set[str]:
    return {name for name, _ in moment.parts}


def _used(*witnesses: Witness) -> frozenset[int]:
    return frozenset(number for witness in witnesses for number, _ in witness if number != GOAL)


def _never_both(one: _Belongs, two: _Belongs) -> bool:
    """As ``no_roads`` of Tableau.v, in this order."""
    if one.sign and not two.sign and one.name == two.name and one.domain == two.domain:
        return True
    kinds = (one.domain.kind, two.domain.kind)
    if kinds == ("adjacent", "adjacent") and one.sign and not two.sign:
        return one.domain.of == two.name and two.domain.of == one.name
    if kinds == ("zone", "zone") and one.sign and two.sign:
        return one.name == two.name and one.domain.of != two.domain.of
    return False
