"""How a formula is evaluated sample by sample: nodes in order, each with a fixed memory.

The value of a node at sample k is known ``delay`` samples later. A formula that looks ahead for a bounded
time has a value at every sample. Under an operator without a bound, values depend on samples to come: they
are *tables*, truth tables over the values that these operators have at the next sample. A table has 2^n
bits for n such operators, and each sample rewrites it (``next``); so the value at the first sample is kept in
one word, however long the trace is.

A formula under an odd number of ``not`` is ``opposite``: what lies after the end of the trace counts there as
the opposite (``semantics.sampled.semantics``), so such nodes have a memory of their own.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import TypeAlias, assert_never

from roadproof.errors import InputError
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.semantics.sampled.semantics import interval_steps

MOST_OPERATORS = 6
"""Of operators without a bound: a table of 2^6 bits fills a word."""
MOST_DELAY = 1_000_000
"""Of samples that a formula looks ahead."""


@dataclass(frozen=True)
class Operand:
    """The value that a node had ``lag`` samples ago."""

    node: int
    lag: int


@dataclass(frozen=True)
class Seen:
    """The truth of a leaf at the newest sample."""

    leaf: int


@dataclass(frozen=True)
class Constant:
    value: bool


@dataclass(frozen=True)
class Negation:
    operand: Operand


@dataclass(frozen=True)
class Junction:
    """And (``universal``) or or."""

    universal: bool
    operands: tuple[Operand, ...]


@dataclass(frozen=True)
class Widening:
    """A truth value as a table whose rows are equal."""

    operand: Operand


@dataclass(frozen=True)
class Window:
    """Always (``universal``) or eventually, over the last ``width`` + 1 values."""

    universal: bool
    operand: Operand
    width: int


@dataclass(frozen=True)
class Within:
    """Until over the last ``width`` + 1 values."""

    left: Operand
    right: Operand
    width: int


@dataclass(frozen=True)
class Forever:
    """An operator without a bound, the ``variable``-th: always (``universal``), or until ``right``.

    ``left`` is None for always and eventually.
    """

    universal: bool
    left: Operand | None
    right: Operand
    variable: int


Operation: TypeAlias = Seen | Constant | Negation | Junction | Widening | Window | Within | Forever


@dataclass(frozen=True)
class Node:
    """One step of a plan. ``kept``: how many earlier values are remembered.

    ``ready``: the delay of the operands, all brought to the same; temporal operators add to it.
    """

    operation: Operation
    ready: int
    delay: int
    opposite: bool = False
    table: bool = False
    kept: int = 0


@dataclass(frozen=True)
class Plan:
    """``nodes`` in order, the last one that of the whole formula; ``leaves`` are its atoms.

    ``strong``: the row of a table where all that is to come counts against the formula.
    """

    formula: Formula
    leaves: tuple[Formula, ...]
    nodes: tuple[Node, ...]
    variables: int
    strong: int

    @property
    def delay(self) -> int:
        """Of the whole formula, in samples."""
        return self.nodes[-1].delay

    @property
    def at_start(self) -> bool:
        """Whether verdicts are about the first sample, not about each."""
        return self.nodes[-1].table

    @property
    def rows(self) -> int:
        """Of a table."""
        return 1 << self.variables

    @property
    def weak(self) -> int:
        """The row of a table where all that is to come counts for the formula."""
        return self.rows - 1 - self.strong

    @property
    def look_ups(self) -> int:
        """How many bits of tables a sample looks up."""
        tables = sum(node.kept + 1 for node in self.nodes if node.table and node.kept)
        return self.rows * (tables + 1) if self.at_start else 0


def plan_of(formula: Formula, dt: Fraction) -> Plan:
    """The plan of a formula without names, whose parameters have values, for samples every ``dt`` seconds.

    Quantifiers over lanes and ``occ`` are leaves. Raises ``InputError`` for bounds that are no multiple of
    ``dt``, for more than MOST_OPERATORS operators without a bound, and for more than MOST_DELAY samples.
    """
    planner = _Planner(dt)
    planner.place(formula, False)
    if planner.variables > MOST_OPERATORS:
        raise InputError(
            f"{planner.variables} temporal operators of the formula have no upper bound, counted with each "
            f"sign in which they occur; a monitor in C takes at most {MOST_OPERATORS}: give some of them a "
            "bound, or compile the parts one by one"
        )
    nodes = planner.nodes
    if nodes[-1].delay > MOST_DELAY:
        raise InputError(
            f"the formula looks {nodes[-1].delay} samples ahead at a step of {float(dt):g} s; a monitor in C "
            f"looks ahead by at most {MOST_DELAY}: shorten the intervals or take a longer --dt"
        )
    strong = sum(1 << x.operation.variable for x in nodes if isinstance(x.operation, Forever) and x.opposite)
    kept = _kept(nodes)
    made = tuple(replace(node, kept=kept.get(k, 0)) for k, node in enumerate(nodes))
    return Plan(formula, tuple(planner.leaves), made, planner.variables, strong)


def operands(operation: Operation) -> tuple[Operand, ...]:
    """The values that an operation reads."""
    match operation:
        case Seen() | Constant():
            return ()
        case Negation(operand) | Widening(operand) | Window(_, operand, _):
            return (operand,)
        case Junction(_, parts):
            return parts
        case Within(left, right, _):
            return (left, right)
        case Forever(_, left, right, _):
            return (right,) if left is None else (left, right)
        case _:
            assert_never(operation)


def _kept(nodes: list[Node]) -> Mapping[int, int]:
    """How many earlier values of each node are read later."""
    found = dict[int, int]()
    for node in nodes:
        operation = node.operation
        wide = operation.width if isinstance(operation, Window | Within) and node.table else 0
        for operand in operands(operation):
            if not isinstance(nodes[operand.node].operation, Constant):
                found[operand.node] = max(found.get(operand.node, 0), operand.lag + wide)
    return found


class _Planner:
    def __init__(self, dt: Fraction) -> None:
        self.dt = dt
        self.nodes: list[Node] = []
        self.leaves: dict[Formula, int] = {}
        self.variables = 0
        self.known: dict[tuple[Formula, bool], int] = {}

    def place(self, formula: Formula, opposite: bool) -> int:
        """The node of ``formula``; state formulas have the same in both signs."""
        key = (formula, opposite and not f.is_state(formula))
        if key not in self.known:
            self.known[key] = self._place(formula, key[1])
        return self.known[key]

    def _place(self, formula: Formula, opposite: bool) -> int:
        match formula:
            case f.Truth(value):
                return self._add(Node(Constant(value), 0, 0))
            case f.Compare() | f.Occupies() | f.Some() | f.Every():
                return self._add(Node(Seen(self.leaves.setdefault(formula, len(self.leaves))), 0, 0))
            case f.Application(_, _, body):
                return self.place(body, opposite)
            case f.Not(body):
                below = self.place(body, not opposite)
                node = self.nodes[below]
                return self._add(Node(Negation(Operand(below, 0)), 0, node.delay, table=node.table))
            case f.And(parts) | f.Or(parts):
                each = [self.place(part, opposite) for part in parts]
                return self._join(isinstance(formula, f.And), list(dict.fromkeys(each)))
            case f.Eventually(interval, body) | f.Always(interval, body):
                return self._temporal(isinstance(formula, f.Always), None, interval, body, opposite)
            case f.Until(left, interval, right):
                return self._temporal(False, left, interval, right, opposite)
            case _:
                assert_never(formula)

    def _add(self, node: Node) -> int:
        self.nodes.append(node)
        return len(self.nodes) - 1

    def _join(self, universal: bool, parts: list[int]) -> int:
        """And or or of nodes; those of one delay first, so that only their result is remembered."""
        by_delay: dict[int, list[int]] = {}
        for part in parts:
            by_delay.setdefault(self.nodes[part].delay, []).append(part)
        if len(by_delay) > 1:
            parts = [self._joined(universal, group) for group in by_delay.values()]
        return self._joined(universal, parts)

    def _joined(self, universal: bool, parts: list[int]) -> int:
        if len(parts) == 1:
            return parts[0]
        delay, read = self._aligned(parts)
        table = any(self.nodes[k].table for k in parts)
        return self._add(Node(Junction(universal, read), delay, delay, table=table))

    def _aligned(self, parts: list[int]) -> tuple[int, tuple[Operand, ...]]:
        """The delay after which all are known, and where each is read then."""
        delay = max(self.nodes[k].delay for k in parts)
        return delay, tuple(Operand(k, delay - self.nodes[k].delay) for k in parts)

    def _temporal(
        self, universal: bool, left: Formula | None, interval: f.Interval, right: Formula, opposite: bool
    ) -> int:
        low, high = interval_steps(interval, self.dt)
        if high == low:  # one sample, before which nothing is asked for
            left = None
        parts = [self.place(x, opposite) for x in (left, right) if x is not None]
        table = any(self.nodes[k].table for k in parts)
        if high is not None and table:
            parts = [k if self.nodes[k].table else self._widened(k) for k in parts]
        ready, read = self._aligned(parts)
        before = None if left is None else read[0]
        if high is None:
            variable, self.variables = self.variables, self.variables + 1
            forever = Forever(universal, before, read[-1], variable)
            return self._add(Node(forever, ready, ready + low, opposite, table=True))
        width = high - low
        if before is None:
            return self._add(Node(Window(universal, read[-1], width), ready, ready + high, opposite, table))
        return self._add(Node(Within(before, read[-1], width), ready, ready + high, opposite, table))

    def _widened(self, below: int) -> int:
        return self._add(Node(Widening(Operand(below, 0)), 0, self.nodes[below].delay, table=True))
