"""The state of the search for a tableau: the goal, branches with their facts, and steps that extend a branch.

A branch holds facts, each true or false at a moment. The constraints on moments are in ``LinearConstraints``;
the search adds and retracts them.
"""

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import field
from fractions import Fraction
from typing import TypeAlias

from roadproof.evidence.atoms import Atoms
from roadproof.evidence.sites import Site
from roadproof.evidence.times import Moment, read_moment
from roadproof.extensions.kernel.linear import GOAL, LinearConstraints, Witness
from roadproof.extensions.kernel.tableau import Argument, TableauNode
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.reasons import Reason
from roadproof.runtime.records import dataclass


class NotFoundError(Exception):
    """The search found no tableau, for this reason."""

    def __init__(self, reason: Reason) -> None:
        super().__init__(reason)
        self.reason = reason


@dataclass(frozen=True)
class Goal:
    """The abstracted claim to prove, and the facts that the proof may use.

    ``lemmas``: facts about one instant, with the moments of their use. ``strict``: for each bounded
    parameter, whether it is above 0 or at least 0.
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
class TableauStep:
    """A rule of the tableau; facts and constraints have their numbers in the search.

    ``new``: a moment that the rule names. ``added``: the numbers of facts and constraints of each child.
    """

    rule: str
    arguments: tuple["int | str | Moment | Witness", ...]
    children: tuple["TableauStep", ...] = ()
    added: tuple[tuple[tuple[int, ...], tuple[int, ...]], ...] = ()
    new: str = ""


@dataclass(frozen=True)
class TruthAt:
    """The fact that ``formula`` is true (``sign``) or false at ``moment``."""

    sign: bool
    moment: Moment
    formula: Formula


@dataclass(frozen=True)
class TrueInterval:
    """The fact that ``formula`` is true from ``low`` on and before ``high``."""

    low: Moment
    high: Moment
    formula: Formula
    site: Site


@dataclass(frozen=True)
class Belongs:
    """The fact that the element ``name`` is, or is not, in ``domain``."""

    sign: bool
    domain: f.Domain
    name: str


Fact: TypeAlias = TruthAt | TrueInterval | Belongs
# What one child of a rule is given: facts, and constraints, strict where True.
ChildFacts: TypeAlias = tuple[Sequence[Fact], Sequence[tuple[bool, Moment]]]
# A proof of a branch: its step, and the facts and constraints that it uses.
Proof: TypeAlias = tuple[TableauStep, frozenset[int]]
Guards: TypeAlias = tuple[Witness, Witness]


@dataclass(frozen=True)
class Move:
    """A rule to apply: its arguments, its premises, and the facts and constraints of each child.

    ``new``: a moment that the rule names; it is known in the last child.
    """

    rule: str
    arguments: tuple[int | str | Moment | Witness, ...]
    premises: Collection[int]
    sides: Sequence[ChildFacts]
    new: str = ""


@dataclass
class PendingUniversal:
    """A fact or lemma that can be instantiated, and the moments or elements that are still to be tried."""

    kind: str  # all, until, road, lemma
    number: int
    site: Site | None
    left: list[Moment | str]

    def copy(self) -> "PendingUniversal":
        """Return a copy that can be changed independently."""
        return PendingUniversal(self.kind, self.number, self.site, list(self.left))


@dataclass
class Branch:
    """A branch of the tableau; ``agenda``: facts to read, ``choices``: disjunctions to split."""

    facts: dict[int, Fact] = field(default_factory=dict)
    known: dict[Formula, list[tuple[bool, Moment, int]]] = field(default_factory=dict)
    agenda: list[int] = field(default_factory=list)
    choices: list[int] = field(default_factory=list)
    universals: list[PendingUniversal] = field(default_factory=list)
    times: set[str] = field(default_factory=set)
    elements: set[str] = field(default_factory=set)
    decided: dict[tuple[int, Moment], Guards] = field(default_factory=dict)

    def copy(self) -> "Branch":
        """Return a copy that can be changed independently."""
        return Branch(
            dict(self.facts),
            {k: list(v) for k, v in self.known.items()},
            list(self.agenda),
            list(self.choices),
            [x.copy() for x in self.universals],
            set(self.times),
            set(self.elements),
            dict(self.decided),
        )

    def add(self, number: int, fact: Fact) -> None:
        self.facts[number] = fact
        self.agenda.append(number)

    def at(self, number: int) -> TruthAt:
        """Return a fact about a moment."""
        fact = self.facts[number]
        assert isinstance(fact, TruthAt)
        return fact

    def waiting(self, *kinds: str) -> Iterator[tuple[PendingUniversal, Moment]]:
        """Yield the known moments with which universals of these kinds are still to be instantiated."""
        for universal in self.universals:
            if universal.kind in kinds:
                for moment in list(universal.left):
                    if isinstance(moment, Moment) and {name for name, _ in moment.parts} <= self.times:
                        yield universal, moment


@dataclass
class SharedState:
    """The state that all branches share: goal, current constraints, and counters of names and numbers."""

    goal: Goal
    linear: LinearConstraints = field(default_factory=LinearConstraints)
    count: int = 0
    unnamed: int = 0

    def number(self) -> int:
        self.count += 1
        return self.count

    def name_for(self, site: Site, prefix: str) -> str:
        """Return the certificate's name for a quantified time or element, or a new name."""
        if site in self.goal.names:
            return self.goal.names[site]
        self.unnamed += 1
        return f"{prefix}_{self.unnamed}"

    def listed(self, site: Site, read: Callable[[str], Moment | str] = read_moment) -> list[Moment | str]:
        """Return the instances that the certificate lists for a universal."""
        return [read(x) for x in self.goal.instances.get(site, ())]

    def equal(self, one: Moment, other: Moment) -> Guards | None:
        """Return multipliers that prove two moments equal; None if they may differ."""
        if one == other:
            trivial: Witness = ((GOAL, Fraction(1)),)
            return trivial, trivial
        least = self.linear.entails(one - other)
        if least is None:
            return None
        most = self.linear.entails(other - one)
        return None if most is None else (least, most)


def constraints_in(*witnesses: Witness) -> frozenset[int]:
    """Return the constraints in multipliers, without the goal."""
    return frozenset(number for witness in witnesses for number, _ in witness if number != GOAL)


def first_and_rest(formula: f.And | f.Or) -> tuple[Formula, ...]:
    """Return the first part and the rest, in Coq's form: p and (q and r)."""
    first, *rest = formula.parts
    if not rest:
        return (first,)
    return first, rest[0] if len(rest) == 1 else type(formula)(tuple(rest))


# --- the same numbered as Tableau.v numbers them ----------------------------------------------------


def number_nodes(
    step: TableauStep, root: int, bounds: Sequence[int], parameters: Sequence[str]
) -> Iterator[TableauNode]:
    """Yield the nodes of a tableau, with facts, constraints and moments numbered in the order of each branch.

    ``root``: the first fact. ``bounds``: the constraints on parameters, in their order.
    """
    # Tableau.v counts from the end of a list, and has bounds in their order.
    constraints = {number: place for place, number in enumerate(reversed(bounds))}
    times = {name: place for place, name in enumerate(parameters, 1)}
    yield from _nodes(step, {root: 0}, 1, constraints, len(constraints), times, len(times) + 1)


def _nodes(
    step: TableauStep,
    facts: Mapping[int, int],
    facts_count: int,
    constraints: Mapping[int, int],
    constraints_count: int,
    times: Mapping[str, int],
    next_time: int,
) -> Iterator[TableauNode]:
    known = dict(times)
    for argument in step.arguments:
        if isinstance(argument, Moment):
            for name, _ in argument.parts:
                if name not in known:  # a moment whose origin was not needed: any time will do
                    known[name] = next_time
                    next_time += 1
    arguments: list[Argument] = []
    for place, argument in enumerate(step.arguments):
        if isinstance(argument, Moment):
            arguments.append(_row(argument, known))
        elif isinstance(argument, tuple):
            arguments.append(
                tuple((constraints_count if i == GOAL else constraints[i], q) for i, q in argument)
            )
        elif isinstance(argument, int) and not (step.rule == "Fact" and place == 0):
            arguments.append(facts[argument])
        else:
            arguments.append(argument)
    inside = dict(known)
    if step.new:
        arguments.append(next_time)
        inside[step.new] = next_time
    yield TableauNode(step.rule, tuple(arguments))
    for place, (child, (new_facts, new_constraints)) in enumerate(
        zip(step.children, step.added, strict=True)
    ):
        names_it = bool(step.new) and (step.rule == "New" or place == 1)
        yield from _nodes(
            child,
            {**facts, **{number: facts_count + k for k, number in enumerate(new_facts)}},
            facts_count + len(new_facts),
            {
                **constraints,
                **{number: constraints_count + k for k, number in enumerate(new_constraints)},
            },
            constraints_count + len(new_constraints),
            inside if names_it else known,
            next_time + names_it,
        )


def _row(moment: Moment, times: Mapping[str, int]) -> tuple[Fraction, ...]:
    if not moment.parts and not moment.constant:
        return ()
    row = [moment.constant] + [Fraction(0)] * max((times[name] for name, _ in moment.parts), default=0)
    for name, factor in moment.parts:
        row[times[name]] = factor
    return tuple(row)
