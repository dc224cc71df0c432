"""The nodes of a plan as declarations and statements in C.

``n3`` is the newest value of node 3: 0 or 1, or a table. What is remembered of it is in the state:

- ``past_3``: earlier values, the newest first, a bit each or a word for each table;
- ``left_3``: for how many samples a window goes on to hold (eventually) or to fail (always);
- ``open_3``: for how many samples a since goes on to hold if its left side does; 1 where it has no end;
- ``waiting_3``, ``met_3``: an until in a window. At how many of the last samples it is open, and a bit for
  each sample of the window, set where it holds.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import assert_never

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

_WORD = 64
HELPERS: Mapping[str, str] = {
    "wide": """\
/* A truth value as a table whose rows are equal. */
static uint64_t wide(uint32_t bit)
{
    return 0 - (uint64_t)bit;
}""",
    "shift": """\
/* Moves the bits of some words up by one, and puts bit in. */
static void shift(uint64_t *words, uint32_t count, uint32_t bit)
{
    while (--count > 0) {
        words[count] = words[count] << 1 | words[count - 1] >> 63;
    }
    words[0] = words[0] << 1 | bit;
}""",
    "fill": """\
/* Sets the lowest bits of some words. */
static void fill(uint64_t *words, uint32_t bits)
{
    for (; bits > 63; bits -= 64) {
        *words++ = ~(uint64_t)0;
    }
    if (bits > 0) {
        *words |= ((uint64_t)1 << bits) - 1;
    }
}""",
    "rewrite": """\
/* A table over values at the next sample; row tells which of its rows each row becomes. */
static uint64_t rewrite(uint64_t table, const uint8_t *row, uint32_t rows)
{
    uint64_t made = 0;
    uint32_t k;
    for (k = 0; k < rows; ++k) {
        made |= (table >> row[k] & 1) << k;
    }
    return made;
}""",
    "find_rows": """\
/* For each row of a table over values at the next sample, the row of one over values at this sample. */
static void find_rows(uint8_t *row, uint32_t rows, const uint64_t *next, uint32_t variables)
{
    uint32_t i;
    uint32_t k;
    for (k = 0; k < rows; ++k) {
        row[k] = 0;
        for (i = 0; i < variables; ++i) {
            row[k] |= (uint8_t)((next[i] >> k & 1) << i);
        }
    }
}""",
    "push": """\
/* Rewrites the tables that are remembered, and puts a new one first. */
static void push(uint64_t *past, uint32_t kept, uint64_t table, const uint8_t *row, uint32_t rows)
{
    for (; kept > 0; --kept) {
        past[kept] = rewrite(past[kept - 1], row, rows);
    }
    past[0] = table;
}""",
    "meet": """\
/* Always over a window of tables; the first over of them lie after the end of the trace. */
static uint64_t meet(const uint64_t *past, uint32_t width, uint32_t over, uint64_t pad)
{
    uint64_t all = ~(uint64_t)0;
    uint32_t k;
    for (k = 0; k <= width; ++k) {
        all &= k < over ? pad : past[k];
    }
    return all;
}""",
    "join": """\
/* Eventually over a window of tables; the first over of them lie after the end of the trace. */
static uint64_t join(const uint64_t *past, uint32_t width, uint32_t over, uint64_t pad)
{
    uint64_t any = 0;
    uint32_t k;
    for (k = 0; k <= width; ++k) {
        any |= k < over ? pad : past[k];
    }
    return any;
}""",
    "reach": """\
/* Until over a window of tables; the first over of them lie after the end of the trace. */
static uint64_t reach(const uint64_t *held, const uint64_t *met, uint32_t width, uint32_t over, uint64_t pad)
{
    uint64_t found = 0;
    uint32_t k;
    for (k = 0; k <= width; ++k) {
        found = k < over ? pad : met[k] | (held[k] & found);
    }
    return found;
}""",
}
"""Functions in C that the statements may call, each after those that it calls."""


@dataclass(frozen=True)
class Member:
    """A member of the state: an array of so many words, or a number of 32 bits where ``words`` is None."""

    name: str
    words: int | None

    @property
    def declaration(self) -> str:
        return f"uint32_t {self.name};" if self.words is None else f"uint64_t {self.name}[{self.words}];"


def members_of(plan: Plan) -> list[Member]:
    """The state of a plan, the words first."""
    words = [Member("first", 1)] if plan.at_start else []
    numbers = [Member("count", None), Member("rejected", None)]
    for k, node in enumerate(plan.nodes):
        if node.kept:
            words.append(Member(f"past_{k}", node.kept + 1 if node.table else _words(node.kept)))
        if isinstance(node.operation, WindowOperation) and not node.table:
            numbers.append(Member(f"left_{k}", None))
        elif isinstance(node.operation, Past):
            numbers.append(Member(f"open_{k}", None))
        elif isinstance(node.operation, BoundedUntil) and not node.table:
            words.append(Member(f"met_{k}", _words(node.operation.width)))
            numbers.append(Member(f"waiting_{k}", None))
    return words + numbers


def bytes_of(plan: Plan) -> int:
    """The size of the state."""
    members = members_of(plan)
    words = sum(x.words for x in members if x.words is not None)
    numbers = sum(x.words is None for x in members)
    return 8 * words + 4 * (numbers + (numbers % 2 if words else 0))


def _words(highest: int) -> int:
    """Return how many words hold the bits from 0 to ``highest``."""
    return highest // _WORD + 1


def statements(plan: Plan) -> Iterator[str]:
    """Statements that compute all nodes for the next sample."""
    for k, node in enumerate(plan.nodes):
        if not isinstance(node.operation, Constant):
            yield from (f"/* {name} */" for name in [plan.told.get(k)] if name)
            yield from _NodeWriter(plan, k, node).lines()


@dataclass(frozen=True)
class _NodeWriter:
    plan: Plan
    k: int
    node: PlanNode

    def lines(self) -> Iterator[str]:
        k, node = self.k, self.node
        match node.operation:
            case LeafValue(leaf):
                yield self.set(f"seen[{leaf}]")
            case Constant():
                raise AssertionError("a constant is written where it is read")
            case Negation(operand):
                yield self.set(f"~{self.read(operand)}" if node.table else f"!{self.read(operand)}")
            case Junction(universal, parts):
                yield self.set((" & " if universal else " | ").join(map(self.read, parts)))
            case Widening(operand):
                yield self.set(self.read(operand))
            case WindowOperation(_, operand, 0) if node.table:
                yield self.set(self.padded(operand))
            case WindowOperation(universal, operand, width) if node.table:
                name = "meet" if universal else "join"
                yield self.set(f"{name}(state->past_{operand.node}, {width}, {self.over}, {self.pad})")
            case WindowOperation(universal, operand, width):
                yield from self.window(universal, operand, width)
            case BoundedUntil(left, right, width) if node.table:
                both = f"state->past_{left.node}, state->past_{right.node}"
                yield self.set(f"reach({both}, {width}, {self.over}, {self.pad})")
            case BoundedUntil(left, right, width):
                yield from self.within(left, right, width)
            case Forever():
                yield from self.forever(node.operation)
            case Past(left, right, width):
                yield from self.past(left, right, width)
            case _:
                assert_never(node.operation)
        if node.kept and node.table:
            yield f"find_rows(row, {self.plan.rows}, next, {self.plan.variables});"
            yield f"push(state->past_{k}, {node.kept}, n{k}, row, {self.plan.rows});"
        elif node.kept:
            yield f"shift(state->past_{k}, {_words(node.kept)}, n{k});"

    def set(self, value: str) -> str:
        return f"const {'uint64_t' if self.node.table else 'uint32_t'} n{self.k} = {value};"

    def window(self, universal: bool, operand: Operand, width: int) -> Iterator[str]:
        k, sign = self.k, "!" if universal else ""
        yield f"if ({sign}{self.padded(operand)}) {{"
        yield f"    state->left_{k} = {width + 1};"
        yield "}"
        yield self.set(f"state->left_{k} {'==' if universal else '>'} 0")
        yield f"state->left_{k} -= {sign}n{k};"

    def within(self, left: Operand, right: Operand, width: int) -> Iterator[str]:
        k = self.k
        yield f"shift(state->met_{k}, {_words(width)}, 0);"
        yield f"state->waiting_{k} += state->waiting_{k} <= {width};"
        yield f"if ({self.padded(right)}) {{"
        yield f"    fill(state->met_{k}, state->waiting_{k});"
        yield f"    state->waiting_{k} = 0;"
        yield f"}} else if (!{self.padded(left)}) {{"
        yield f"    state->waiting_{k} = 0;"
        yield "}"
        yield self.set(_bit(f"state->met_{k}", width))

    def forever(self, operation: Forever) -> Iterator[str]:
        k, later = self.k, f"next[{operation.variable}]"
        value = f"{self.padded(operation.right)} {'&' if operation.universal else '|'} {later}"
        if operation.left is not None:
            value = f"{self.padded(operation.right)} | ({self.padded(operation.left)} & {later})"
        yield f"const uint64_t n{k} = state->count > {self.node.ready} ? {value} : {later};"
        yield f"{later} = n{k};"

    def past(self, left: Operand, right: Operand, width: int | None) -> Iterator[str]:
        """Yield the statements of a since; before the first sample nothing is true."""
        k = self.k
        yield f"if (state->count > {self.node.ready}) {{"
        yield f"    if ({self.read(right)}) {{"
        yield f"        state->open_{k} = {1 if width is None else width + 1};"
        yield f"    }} else if (!{self.read(left)}) {{"
        yield f"        state->open_{k} = 0;"
        if width is not None:
            yield f"    }} else if (state->open_{k} > 0) {{"
            yield f"        --state->open_{k};"
        yield "    }"
        yield "}"
        yield self.set(f"state->open_{k} > 0")

    def read(self, operand: Operand) -> str:
        """The value of an operand, as a table where this node is one."""
        source = self.plan.nodes[operand.node]
        if isinstance(source.operation, Constant):
            value = str(int(source.operation.value))
        elif source.table:
            return f"n{operand.node}"
        else:
            value = _bit(f"state->past_{operand.node}", operand.lag) if operand.lag else f"n{operand.node}"
        return f"wide({value})" if self.node.table else value

    def padded(self, operand: Operand) -> str:
        """Return the expression that reads an operand, or the padding after the end of the trace."""
        return f"(ended > {self.node.ready} ? {self.pad} : {self.read(operand)})"

    @property
    def over(self) -> str:
        """Return how many of the newest values lie after the end of the trace."""
        return f"ended > {self.node.ready} ? ended - {self.node.ready} : 0"

    @property
    def pad(self) -> str:
        """The value after the end of the trace; ``pad`` is that of a formula without ``not``."""
        if self.node.table:
            return "~pad" if self.node.opposite else "pad"
        return "!pad" if self.node.opposite else "(uint32_t)(pad & 1)"


def _bit(words: str, number: int) -> str:
    return f"(uint32_t)({words}[{number // _WORD}] >> {number % _WORD} & 1)"
