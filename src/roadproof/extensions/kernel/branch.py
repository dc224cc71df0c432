"""What the search for a tableau knows: the goal, branches with their facts, and what a step would do to one.

A branch holds facts, each true or false at a moment; the constraints on moments are in ``Linear``, added and
taken back as the search goes.
"""

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import field
from fractions import Fraction
from typing import TypeAlias

from roadproof.evidence.atoms import Atoms
from roadproof.evidence.sites import Site
from roadproof.evidence.times import Moment, read_moment
from roadproof.extensions.kernel.linear import GOAL, Linear, Witness
from roadproof.extensions.kernel.tableau import Argument, Node
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.reasons import Reason
from roadproof.runtime.records import dataclass


class NotFoundError(Exception):
    """No tableau was found, for this reason."""

    def __init__(self, reason: Reason) -> None:
        super().__init__(reason)
        self.reason = reason


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
class Step:
    """A rule of the tableau, with facts and constraints by their numbers in the search.

    ``new``: a moment that it names; ``added``: numbers of facts and of constraints that each child has.
    """

    rule: str
    arguments: tuple["int | str | Moment | Witness", ...]
    children: tuple["Step", ...] = ()
    added: tuple[tuple[tuple[int, ...], tuple[int, ...]], ...] = ()
    new: str = ""


@dataclass(frozen=True)
class At:
    """``formula`` is true, or false, at ``moment``."""

    sign: bool
    moment: Moment
    formula: Formula


@dataclass(frozen=True)
class TrueInterval:
    """``formula`` is true from ``low`` on and before ``high``."""

    low: Moment
    high: Moment
    formula: Formula
    site: Site


@dataclass(frozen=True)
class Belongs:
    """The element called ``name`` is, or is not, in ``domain``."""

    sign: bool
    domain: f.Domain
    name: str


Fact: TypeAlias = At | TrueInterval | Belongs
# What one child of a rule is given: facts, and constraints, strict where True.
Given: TypeAlias = tuple[Sequence[Fact], Sequence[tuple[bool, Moment]]]
# A proof of a branch: its step, and the facts and constraints that it uses.
Proof: TypeAlias = tuple[Step, frozenset[int]]
Guards: TypeAlias = tuple[Witness, Witness]


@dataclass(frozen=True)
class Move:
    """A rule that is to be applied: what it is told, what it rests on, and what each child is given.

    ``new``: a moment that it names; it is known in the last child.
    """

    rule: str
    arguments: tuple[int | str | Moment | Witness, ...]
    premises: Collection[int]
    sides: Sequence[Given]
    new: str = ""


@dataclass
class Universal:
    """What may be instantiated: a fact, or a lemma by its place, and what it is still to be tried with."""

    kind: str  # all, until, road, lemma
    number: int
    site: Site | None
    left: list[Moment | str]

    def copy(self) -> "Universal":
        return Universal(self.kind, self.number, self.site, list(self.left))


@dataclass
class Branch:
    """``agenda``: facts that are to be read; ``choices``: disjunctions that are to be divided."""

    facts: dict[int, Fact] = field(default_factory=dict)
    known: dict[Formula, list[tuple[bool, Moment, int]]] = field(default_factory=dict)
    agenda: list[int] = field(default_factory=list)
    choices: list[int] = field(default_factory=list)
    universals: list[Universal] = field(default_factory=list)
    times: set[str] = field(default_factory=set)
    elements: set[str] = field(default_factory=set)
    decided: dict[tuple[int, Moment], Guards] = field(default_factory=dict)

    def copy(self) -> "Branch":
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

    def at(self, number: int) -> At:
        """A fact that says what is at a moment."""
        fact = self.facts[number]
        assert isinstance(fact, At)
        return fact

    def waiting(self, *kinds: str) -> Iterator[tuple[Universal, Moment]]:
        """Moments that have names here and that universals of these kinds are still to be tried with."""
        for universal in self.universals:
            if universal.kind in kinds:
                for moment in list(universal.left):
                    if isinstance(moment, Moment) and {name for name, _ in moment.parts} <= self.times:
                        yield universal, moment


@dataclass
class Means:
    """What all branches share: the goal, the constraints that stand now, and names and numbers."""

    goal: Goal
    linear: Linear = field(default_factory=Linear)
    count: int = 0
    unnamed: int = 0

    def number(self) -> int:
        self.count += 1
        return self.count

    def named(self, site: Site, prefix: str) -> str:
        if site in self.goal.names:
            return self.goal.names[site]
        self.unnamed += 1
        return f"{prefix}_{self.unnamed}"

    def listed(self, site: Site, read: Callable[[str], Moment | str] = read_moment) -> list[Moment | str]:
        """What the certificate lists for a universal."""
        return [read(x) for x in self.goal.instances.get(site, ())]

    def equal(self, one: Moment, other: Moment) -> Guards | None:
        """Multipliers that show two moments to be one."""
        if one == other:
            trivial: Witness = ((GOAL, Fraction(1)),)
            return trivial, trivial
        least = self.linear.entails(one - other)
        if least is None:
            return None
        most = self.linear.entails(other - one)
        return None if most is None else (least, most)


def used(*witnesses: Witness) -> frozenset[int]:
    """The constraints that multipliers speak of, but for what was asked."""
    return frozenset(number for witness in witnesses for number, _ in witness if number != GOAL)


def two(formula: f.And | f.Or) -> tuple[Formula, ...]:
    """A first part and the rest, as Coq has them: p and (q and r)."""
    first, *rest = formula.parts
    if not rest:
        return (first,)
    return first, rest[0] if len(rest) == 1 else type(formula)(tuple(rest))


# --- the same numbered as Tableau.v numbers them ----------------------------------------------------


def numbered(step: Step, root: int, bounds: Sequence[int], parameters: Sequence[str]) -> Iterator[Node]:
    """The nodes of a tableau: facts, constraints and moments are numbered as a branch comes to have them.

    ``root`` is the fact that it begins with; ``bounds``: the constraints on parameters, in their order.
    """
    # Tableau.v counts from the end of a list, and has bounds in their order.
    constraints = {number: place for place, number in enumerate(reversed(bounds))}
    times = {name: place for place, name in enumerate(parameters, 1)}
    yield from _nodes(step, {root: 0}, 1, constraints, len(constraints), times, len(times) + 1)


def _nodes(
    step: Step,
    facts: Mapping[int, int],
    facts_count: int,
    constraints: Mapping[int, int],
    constraints_count: int,
    times: Mapping[str, int],
    next_time: int,
) -> Iterator[Node]:
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
    yield Node(step.rule, tuple(arguments))
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
