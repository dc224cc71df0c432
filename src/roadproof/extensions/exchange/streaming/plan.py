"""The plan by which a formula is evaluated sample by sample: nodes in order, each with a fixed memory.

The value of a node at sample k is known ``delay`` samples later. A formula that looks ahead for a bounded
time has a value at every sample. Under an operator without a bound, values depend on samples to come: they
are *tables*, truth tables over the values that these operators have at the next sample. A table has 2^n
bits for n such operators, and each sample rewrites it (``next``); so the value at the first sample is kept in
one word, however long the trace is.

A formula under an odd number of ``not`` is ``opposite``: what lies after the end of the trace counts there as
the opposite (``semantics.sampled.lattice``), so such nodes have a memory of their own.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import TypeAlias, assert_never

from roadproof.errors import InputError
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.semantics.sampled.compiled import compile
from roadproof.semantics.sampled.lattice import interval_steps

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
class LeafValue:
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
class WindowOperation:
    """Always (``universal``) or eventually, over the last ``width`` + 1 values."""

    universal: bool
    operand: Operand
    width: int


@dataclass(frozen=True)
class BoundedUntil:
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


@dataclass(frozen=True)
class Past:
    """Since; ``width``: how far it looks back beyond the lag of its operands, None for no end."""

    left: Operand
    right: Operand
    width: int | None


Operation: TypeAlias = (
    LeafValue | Constant | Negation | Junction | Widening | WindowOperation | BoundedUntil | Forever | Past
)


@dataclass(frozen=True)
class PlanNode:
    """One step of a plan. ``kept``: how many earlier values are remembered.

    ``ready``: the delay with which operands are read; temporal operators add to it.
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

    ``strong``: the row of a table where all that is to come counts against the formula. ``told``: nodes that
    are definitions, with their names.
    """

    formula: Formula
    leaves: tuple[Formula, ...]
    nodes: tuple[PlanNode, ...]
    variables: int
    strong: int
    told: Mapping[int, str] = field(default_factory=dict)

    @property
    def delay(self) -> int:
        """The delay of the whole formula, in samples."""
        return self.nodes[-1].delay

    @property
    def at_start(self) -> bool:
        """Return whether verdicts are about the first sample, not about each."""
        return self.nodes[-1].table

    @property
    def rows(self) -> int:
        """The number of rows of a table."""
        return 1 << self.variables

    @property
    def weak(self) -> int:
        """The row of a table where all that is to come counts for the formula."""
        return self.rows - 1 - self.strong

    @property
    def look_ups(self) -> int:
        """Return how many bits of tables a sample looks up: those that are remembered, and that of the
        start.
        """
        tables = sum(node.kept for node in self.nodes if node.table)
        return self.rows * (tables + 1) if self.at_start else 0


def plan_of(formula: Formula, dt: Fraction, names: Mapping[Formula, str]) -> Plan:
    """The plan of a formula without names, whose parameters have values, for samples every ``dt`` seconds.

    ``names``: what sub-formulas were called. Quantifiers over lanes and ``occ`` are leaves. Raises
    ``InputError`` for bounds that are no multiple of ``dt``, for more than MOST_OPERATORS operators without a
    bound, and for more than MOST_DELAY samples.
    """
    planner = _Planner(dt)
    planner.place(formula, False)
    if planner.variables > MOST_OPERATORS:
        raise InputError(
            f"{planner.variables} temporal operators of the formula have no upper bound, counted with each "
            f"sign in which they occur; a streaming monitor takes at most {MOST_OPERATORS}: give some of "
            "them a bound, or compile the parts one by one"
        )
    nodes = planner.nodes
    if nodes[-1].delay > MOST_DELAY:
        raise InputError(
            f"the formula looks {nodes[-1].delay} samples ahead at a step of {float(dt):g} s; a streaming "
            f"monitor looks ahead by at most {MOST_DELAY}: shorten the intervals or take a longer --dt"
        )
    strong = sum(1 << x.operation.variable for x in nodes if isinstance(x.operation, Forever) and x.opposite)
    history = _history_lengths(nodes)
    planned_nodes = tuple(replace(node, kept=history.get(k, 0)) for k, node in enumerate(nodes))
    definitions = {k: names[x] for (x, _, _), k in planner.known.items() if x in names}
    return Plan(formula, tuple(planner.leaves), planned_nodes, planner.variables, strong, definitions)


def plans_of(formulas: Mapping[str, Formula], dt: Fraction) -> dict[str, Plan]:
    """Return the plans of formulas by name, whose parameters have values. Raises as ``plan_of``."""
    compiled = compile(formulas)
    names = {plain: f"{x.name}({', '.join(x.arguments)})" for x, plain in compiled.named.items()}
    return {name: plan_of(plain, dt, names) for name, plain in compiled.plain.items()}


def operands(operation: Operation) -> tuple[Operand, ...]:
    """The values that an operation reads."""
    match operation:
        case LeafValue() | Constant():
            return ()
        case Negation(operand) | Widening(operand) | WindowOperation(_, operand, _):
            return (operand,)
        case Junction(_, parts):
            return parts
        case BoundedUntil(left, right, _) | Past(left, right, _):
            return (left, right)
        case Forever(_, left, right, _):
            return (right,) if left is None else (left, right)
        case _:
            assert_never(operation)


def _history_lengths(nodes: list[PlanNode]) -> Mapping[int, int]:
    """Return how many earlier values of each node are read later."""
    lengths = dict[int, int]()
    for node in nodes:
        operation = node.operation
        wide = operation.width if isinstance(operation, WindowOperation | BoundedUntil) and node.table else 0
        for operand in operands(operation):
            if not isinstance(nodes[operand.node].operation, Constant):
                lengths[operand.node] = max(lengths.get(operand.node, 0), operand.lag + wide)
    return lengths


class _Planner:
    """Places nodes. Tables are never delayed, as each sample would have to rewrite those that wait: where one
    is read with others that take longer, its operators without a bound run that much later instead."""

    def __init__(self, dt: Fraction) -> None:
        self.dt = dt
        self.nodes: list[PlanNode] = []
        self.leaves: dict[Formula, int] = {}
        self.variables = 0
        self.known: dict[tuple[Formula, bool, int], int] = {}
        self.looks: dict[Formula, tuple[int, bool]] = {}

    def look(self, formula: Formula) -> tuple[int, bool]:
        """The least delay of a formula, and whether its values are tables."""
        if formula not in self.looks:
            below = [self.look(x) for x in self._read(formula)]
            ahead, table = max((delay for delay, _ in below), default=0), any(x for _, x in below)
            for interval in () if isinstance(formula, f.Since) else f.intervals(formula):
                low, high = interval_steps(interval, self.dt)
                ahead, table = ahead + (low if high is None else high), table or high is None
            self.looks[formula] = ahead, table
        return self.looks[formula]

    def _read(self, formula: Formula) -> tuple[Formula, ...]:
        """The sub-formulas that matter: before an interval of one sample nothing is asked for."""
        match formula:
            case f.Some() | f.Every():
                return ()
            case f.Until(left, interval, right):
                low, high = interval_steps(interval, self.dt)
                return (right,) if low == high else (left, right)
            case f.Truth() | f.Compare() | f.Occupies() | f.Not() | f.And() | f.Or() | f.Application():
                return f.children(formula)
            case f.Eventually() | f.Always() | f.Since():
                return f.children(formula)

    def place(self, formula: Formula, opposite: bool, least: int = 0) -> int:
        """The node of ``formula``, whose delay is at least ``least`` where it is a table.

        State formulas have the same node in both signs.
        """
        delay, table = self.look(formula)
        key = formula, opposite and not f.is_state(formula), max(delay, least) if table else delay
        if key not in self.known:
            self.known[key] = self._place(*key)
        return self.known[key]

    def _place(self, formula: Formula, opposite: bool, delay: int) -> int:
        table = self.look(formula)[1]
        match formula:
            case f.Truth(value):
                return self._add(PlanNode(Constant(value), 0, 0))
            case f.Compare() | f.Occupies() | f.Some() | f.Every():
                return self._add(PlanNode(LeafValue(self.leaves.setdefault(formula, len(self.leaves))), 0, 0))
            case f.Application(_, _, body):
                return self.place(body, opposite, delay)
            case f.Not(body):
                below = Operand(self.place(body, not opposite, delay), 0)
                return self._add(PlanNode(Negation(below), delay, delay, table=table))
            case f.And(parts) | f.Or(parts):
                each = [self.place(part, opposite, delay) for part in parts]
                return self._join(isinstance(formula, f.And), list(dict.fromkeys(each)), delay)
            case f.Eventually(interval, _) | f.Always(interval, _) | f.Until(_, interval, _):
                return self._temporal(formula, interval, opposite, delay)
            case f.Since(left, interval, right):
                return self._since(left, interval, right, opposite, delay)
            case _:
                assert_never(formula)

    def _add(self, node: PlanNode) -> int:
        self.nodes.append(node)
        return len(self.nodes) - 1

    def _join(self, universal: bool, parts: list[int], delay: int) -> int:
        """And or or of nodes; those of one delay first, so that only their result is remembered."""
        by_delay: dict[int, list[int]] = {}
        for part in parts:
            by_delay.setdefault(self.nodes[part].delay, []).append(part)
        if len(by_delay) > 1:
            parts = [self._junction(universal, group, at) for at, group in by_delay.items()]
        return self._junction(universal, parts, delay)

    def _junction(self, universal: bool, parts: list[int], delay: int) -> int:
        if len(parts) == 1:
            return parts[0]
        table = any(self.nodes[k].table for k in parts)
        read = tuple(self._at(k, delay) for k in parts)
        return self._add(PlanNode(Junction(universal, read), delay, delay, table=table))

    def _at(self, node: int, delay: int) -> Operand:
        """Return where a node is read so that it has ``delay``."""
        return Operand(node, delay - self.nodes[node].delay)

    def _temporal(
        self, formula: f.Eventually | f.Always | f.Until, interval: f.Interval, opposite: bool, delay: int
    ) -> int:
        low, high = interval_steps(interval, self.dt)
        ready = delay - (low if high is None else high)
        universal, table = isinstance(formula, f.Always), self.look(formula)[1]
        parts = [self.place(x, opposite, ready) for x in self._read(formula)]
        if high is not None and table:
            parts = [k if self.nodes[k].table else self._widening(k, ready) for k in parts]
        *left, right = (self._at(k, ready) for k in parts)
        if high is None:
            variable, self.variables = self.variables, self.variables + 1
            forever = Forever(universal, left[0] if left else None, right, variable)
            return self._add(PlanNode(forever, ready, delay, opposite, table=True))
        width = high - low
        operation = BoundedUntil(left[0], right, width) if left else WindowOperation(universal, right, width)
        return self._add(PlanNode(operation, ready, delay, opposite, table))

    def _since(self, left: Formula, interval: f.Interval, right: Formula, opposite: bool, delay: int) -> int:
        """The node of a since, whose operands lie back by the low bound of its interval."""
        if self.look(left)[1] or self.look(right)[1]:
            raise InputError(
                "the formula looks back (O, H, S) at a part with F, G or U without an upper bound, which a "
                "streaming monitor cannot remember: give that part a bound"
            )
        low, high = interval_steps(interval, self.dt)
        farthest = max(low, high or 0)
        if farthest > MOST_DELAY:
            raise InputError(
                f"the formula looks back {farthest} samples at a step of {float(self.dt):g} s; a streaming "
                f"monitor looks back by at most {MOST_DELAY}: shorten the intervals or take a longer --dt"
            )
        one, other = (self._at(self.place(x, opposite, delay), delay + low) for x in (left, right))
        width = None if high is None else high - low
        return self._add(PlanNode(Past(one, other, width), delay + low, delay))

    def _widening(self, below: int, delay: int) -> int:
        return self._add(PlanNode(Widening(self._at(below, delay)), delay, delay, table=True))
