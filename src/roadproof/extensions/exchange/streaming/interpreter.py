"""Evaluates a plan sample by sample in Python, with the memory and the operations of the monitor in C.

A table is a whole number with a bit for each row. The memory of other nodes is a whole number, too: its
lowest bit is the newest value.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from typing import Self, assert_never

from roadproof.extensions.exchange.streaming.plan import (
    BoundedUntil,
    Constant,
    Forever,
    Junction,
    LeafValue,
    Negation,
    Operand,
    Past,
    Plan,
    PlanNode,
    Widening,
    WindowOperation,
)


@dataclass
class PlanState:
    """The memory of a plan after ``count`` samples, those after the end of the trace included.

    By number of node: ``bits`` are earlier values, ``tables`` earlier tables, the newest first. ``left``: for
    how many samples a window goes on to hold (eventually) or to fail (always). ``waiting``, ``met``: at how
    many of the last samples an until is open, and a bit for each sample of its window, set where it holds.
    ``open``: for how many samples a since goes on to hold if its left side does; 1 where it has no end.
    ``first``: the table of the whole formula at the first sample.
    """

    plan: Plan
    count: int = 0
    first: int = 0
    bits: dict[int, int] = field(default_factory=dict)
    tables: dict[int, tuple[int, ...]] = field(default_factory=dict)
    left: dict[int, int] = field(default_factory=dict)
    waiting: dict[int, int] = field(default_factory=dict)
    met: dict[int, int] = field(default_factory=dict)
    open: dict[int, int] = field(default_factory=dict)

    def copy(self) -> Self:
        """Return a state that changes no more with this one."""
        return replace(
            self,
            bits={**self.bits},
            tables={**self.tables},
            left={**self.left},
            waiting={**self.waiting},
            met={**self.met},
            open={**self.open},
        )

    def advance(self, seen: Sequence[bool], ended: int = 0, pad: bool = False) -> bool:
        """Take one sample more, and return the newest value.

        ``seen``: the truth of the leaves of the plan. ``ended``: which sample after the end of the trace this
        is, 0 inside; ``pad``: what counts there. The value is that of the sample ``delay`` before, or of the
        first one if the plan is about that; what is to come then counts as ``pad``.
        """
        self.count += 1
        step = _PlanStep(self, seen, ended, pad)
        for k, node in enumerate(self.plan.nodes):
            step.evaluate(k, node)
        newest = step.values[-1]
        if not self.plan.at_start:
            return bool(newest)
        if self.count == self.plan.delay + 1:
            self.first = newest
        elif self.count > self.plan.delay + 1:
            self.first = step.rewrite(self.first)
        return self.at_first(pad)

    def at_first(self, weak: bool) -> bool:
        """Return the value at the first sample if all that is to come counts for the formula, or against."""
        return bool(self.first >> (self.plan.weak if weak else self.plan.strong) & 1)


class _PlanStep:
    """The values of all nodes at one sample, written into the state as they are found."""

    def __init__(self, state: PlanState, seen: Sequence[bool], ended: int, pad: bool) -> None:
        self.state, self.seen, self.ended, self.pad = state, seen, ended, pad
        self.plan = state.plan
        self.full = (1 << self.plan.rows) - 1
        self.values: list[int] = []
        # The value of each operator without a bound at this sample, as a table over those at the next one.
        self.next = [_variable_table(i, self.plan.rows) for i in range(self.plan.variables)]
        # For each row of a table over values at the next sample, the row of one over values at this sample.
        self.rows: list[int] | None = None

    def evaluate(self, k: int, node: PlanNode) -> None:
        """Find the value of node ``k``, and remember it for as long as it is read."""
        value = self._value(k, node)
        self.values.append(value)
        if node.kept and node.table:
            earlier = self.state.tables.get(k, (0,) * node.kept)
            self.state.tables[k] = (value, *map(self.rewrite, earlier[: node.kept]))
        elif node.kept:
            self.state.bits[k] = (self.state.bits.get(k, 0) << 1 | value) & ((2 << node.kept) - 1)

    def rewrite(self, table: int) -> int:
        """Return a table over values at this sample as one over values at the next sample."""
        if table in (0, self.full):
            return table
        if self.rows is None:
            bits = [(x, i) for i, x in enumerate(self.next)]
            self.rows = [sum((x >> row & 1) << i for x, i in bits) for row in range(self.plan.rows)]
        return sum((table >> now & 1) << row for row, now in enumerate(self.rows))

    def _value(self, k: int, node: PlanNode) -> int:
        match node.operation:
            case LeafValue(leaf):
                return int(self.seen[leaf])
            case Constant(value):
                return int(value)
            case Negation(operand):
                return self._top(node) ^ self._read(operand, node)
            case Junction(universal, parts):
                read = [self._read(x, node) for x in parts]
                return _all(read) if universal else _any(read)
            case Widening(operand):
                return self._read(operand, node)
            case WindowOperation(universal, operand, width) if node.table:
                window = self._window(operand, width, node)
                return _all(window) if universal else _any(window)
            case WindowOperation(universal, operand, width):
                return self._bounded(k, universal, self._padded(operand, node), width)
            case BoundedUntil(left, right, width) if node.table:
                until = 0
                lefts, rights = self._window(left, width, node), self._window(right, width, node)
                for over, (now, met) in enumerate(zip(lefts, rights, strict=True)):
                    until = self._end(node) if over < self._over(node) else met | (now & until)
                return until
            case BoundedUntil(left, right, width):
                return self._until(k, self._padded(left, node), self._padded(right, node), width)
            case Forever():
                return self._forever(node.operation, node)
            case Past():
                return self._past(k, node.operation, node)
            case _:
                assert_never(node.operation)

    def _bounded(self, k: int, universal: bool, operand: int, width: int) -> int:
        """Always or eventually over the last ``width`` + 1 values."""
        left = self.state.left
        if bool(operand) != universal:
            left[k] = width + 1
        remaining = left.get(k, 0)
        left[k] = max(0, remaining - 1)
        return int((remaining == 0) == universal)

    def _until(self, k: int, left: int, met: int, width: int) -> int:
        """Until over the last ``width`` + 1 values."""
        bits = self.state.met.get(k, 0) << 1 & ((2 << width) - 1)
        waiting = min(self.state.waiting.get(k, 0), width) + 1
        if met:
            bits |= (1 << waiting) - 1
        self.state.met[k] = bits
        self.state.waiting[k] = waiting if left and not met else 0
        return bits >> width & 1

    def _past(self, k: int, operation: Past, node: PlanNode) -> int:
        """Since; before the first sample nothing is true."""
        remaining = self.state.open.get(k, 0)
        if self.state.count > node.ready:
            if self._read(operation.right, node):
                remaining = 1 if operation.width is None else operation.width + 1
            elif not self._read(operation.left, node):
                remaining = 0
            elif operation.width is not None:
                remaining = max(0, remaining - 1)
        self.state.open[k] = remaining
        return int(remaining > 0)

    def _forever(self, operation: Forever, node: PlanNode) -> int:
        later = self.next[operation.variable]
        if self.state.count <= node.ready:
            return later
        right = self._padded(operation.right, node)
        if operation.left is not None:
            value = right | (self._padded(operation.left, node) & later)
        else:
            value = right & later if operation.universal else right | later
        self.next[operation.variable], self.rows = value, None
        return value

    def _read(self, operand: Operand, node: PlanNode) -> int:
        """Return the value of an operand, as a table where ``node`` is one."""
        source = self.plan.nodes[operand.node]
        if source.table:
            return self.values[operand.node]
        value = self.values[operand.node]
        if operand.lag and not isinstance(source.operation, Constant):
            value = self.state.bits[operand.node] >> operand.lag & 1
        return value * self._top(node)

    def _padded(self, operand: Operand, node: PlanNode) -> int:
        """Return the value of an operand, or what counts after the end of the trace."""
        return self._end(node) if self.ended > node.ready else self._read(operand, node)

    def _window(self, operand: Operand, width: int, node: PlanNode) -> list[int]:
        """Return the last ``width`` + 1 tables of an operand, the newest first."""
        if not width:
            return [self._padded(operand, node)]
        over, past = self._over(node), self.state.tables[operand.node]
        return [self._end(node) if i < over else past[i] for i in range(width + 1)]

    def _over(self, node: PlanNode) -> int:
        """Return how many of the newest values lie after the end of the trace."""
        return max(0, self.ended - node.ready)

    def _end(self, node: PlanNode) -> int:
        """Return what counts after the end of the trace."""
        return self._top(node) if self.pad != node.opposite else 0

    def _top(self, node: PlanNode) -> int:
        """Return the value of a true node."""
        return self.full if node.table else 1


@cache
def _variable_table(variable: int, rows: int) -> int:
    """Return the table of a variable: in each row it has the bit of the row's number."""
    return sum((row >> variable & 1) << row for row in range(rows))


def _all(values: Sequence[int]) -> int:
    result = values[0]
    for x in values[1:]:
        result &= x
    return result


def _any(values: Sequence[int]) -> int:
    result = values[0]
    for x in values[1:]:
        result |= x
    return result
