"""Tableaux: trees of rules that proofs/kernel/Tableau.v checks. Their lines are part of certificates.

A line is a node: the name of its rule, then its arguments; parents come before children. Facts, constraints
and moments are numbered in each branch in order of appearance. Nothing here is trusted: any lines become a
tree or an error, and Coq checks the tree.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import TypeAlias, get_args

from roadproof.errors import InputError
from roadproof.evidence.answers.certificate import TableauRule
from roadproof.extensions.kernel.names import q

# A linear expression: coefficients of 1 and of the numbered moments; multipliers: numbers of constraints.
Row: TypeAlias = tuple[Fraction, ...]
Multipliers: TypeAlias = tuple[tuple[int, Fraction], ...]
Argument: TypeAlias = int | str | Row | Multipliers

# What a rule is told, and how many children it has. i: a fact or a number; m: a moment; w: multipliers;
# c: the name of a lane or lanelet.
_RULES: Mapping[TableauRule, tuple[str, int]] = {
    "Close": ("iiww", 0),
    "CloseTruth": ("i", 0),
    "CloseLinear": ("w", 0),
    "CloseRoad": ("i", 0),
    "CloseRoads": ("ii", 0),
    "CloseZones": ("iii", 0),
    "Alpha": ("i", 1),
    "Beta": ("i", 2),
    "Timing": ("i", 1),
    "New": ("ii", 1),
    "Inst": ("imww", 1),
    "InstUntil": ("imwwi", 2),
    "NewRoad": ("ic", 1),
    "InstRoad": ("ic", 2),
    "Cut": ("m", 2),
    "Fact": ("im", 1),
}
RULES: Mapping[str, tuple[str, int]] = {str(name): shape for name, shape in _RULES.items()}
assert {*RULES} == {*get_args(TableauRule)}  # the rules that certificates may name
MOST_NODES = 50_000
WIDTH = 110  # of a line of Coq
_WHOLE = re.compile(r"0|[1-9][0-9]{0,4}", re.ASCII)
_RATIONAL = re.compile(r"-?[0-9]{1,40}(/[1-9][0-9]{0,40})?", re.ASCII)
_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]{0,99}", re.ASCII)


@dataclass(frozen=True)
class TableauNode:
    """A rule with its arguments; its children follow it."""

    rule: str
    arguments: tuple[Argument, ...]

    @property
    def arity(self) -> int:
        return RULES[self.rule][1]


# A tree, written parent first.
Tableau: TypeAlias = tuple[TableauNode, ...]


def lines(tableau: Tableau) -> tuple[str, ...]:
    """Return a tableau as lines, one for each node."""
    return tuple(_line(node) for node in tableau)


def read_lines(tableau_lines: Sequence[str]) -> Tableau:
    """Return the tableau of its lines, the inverse of ``lines``. Raises ``InputError`` for other lines."""
    if len(tableau_lines) > MOST_NODES:
        raise InputError(f"a tableau of {len(tableau_lines)} nodes; at most {MOST_NODES} are read")
    nodes: list[TableauNode] = []
    open_places = 1
    for number, line in enumerate(tableau_lines, 1):
        if open_places == 0:
            raise InputError(f"line {number} of the tableau comes after its end: {line[:60]!r}")
        node = _read(line, number)
        nodes.append(node)
        open_places += node.arity - 1
    if open_places:
        raise InputError(f"the tableau ends after {len(nodes)} nodes with {open_places} branches open")
    return tuple(nodes)


def _line(node: TableauNode) -> str:
    kinds = RULES[node.rule][0]
    return " ".join([node.rule, *(_text(k, x) for k, x in zip(kinds, node.arguments, strict=True))])


def _text(kind: str, argument: Argument) -> str:
    if isinstance(argument, tuple):
        parts = (f"{x[0]}*{x[1]}" if isinstance(x, tuple) else str(x) for x in argument)
        return ",".join(parts) or "-"
    return str(argument)


def _read(line: str, number: int) -> TableauNode:
    rule, *words = line.split(" ")
    if rule not in RULES or len(words) != len(RULES[rule][0]):
        raise InputError(f"line {number} of the tableau is no rule with what it is told: {line[:60]!r}")
    try:
        return TableauNode(
            rule, tuple(_argument(k, word) for k, word in zip(RULES[rule][0], words, strict=True))
        )
    except ValueError:
        raise InputError(f"line {number} of the tableau is not read: {line[:60]!r}") from None


def _argument(kind: str, word: str) -> Argument:
    """Return an argument of a rule. Raises ``ValueError``."""
    match kind:
        case "i":
            return int(_only(_WHOLE, word))
        case "c":
            return _only(_NAME, word)
        case "m":
            return tuple(map(_rational, _items(word)))
        case _:  # open: a character of _RULES, here w
            return tuple(map(_multiplier, _items(word)))


def _items(word: str) -> list[str]:
    return [] if word == "-" else word.split(",")


def _multiplier(word: str) -> tuple[int, Fraction]:
    constraint, _, factor = word.partition("*")
    return int(_only(_WHOLE, constraint)), _rational(factor)


def _rational(word: str) -> Fraction:
    return Fraction(_only(_RATIONAL, word))


def _only(pattern: re.Pattern[str], word: str) -> str:
    if not pattern.fullmatch(word):
        raise ValueError(word)
    return word


# --- for Coq -------------------------------------------------------------------------------------


def coq_tree(tableau: Tableau) -> Iterator[str]:
    """Yield the lines of a tableau as a term of Tableau.v."""
    line = ""
    waiting: list[int] = []  # children that the nodes above still lack
    for node in tableau:
        kinds = RULES[node.rule][0]
        words = [node.rule, *(_coq(k, x) for k, x in zip(kinds, node.arguments, strict=True))]
        text = f"({' '.join(words)}"
        waiting.append(node.arity)
        while waiting and waiting[-1] == 0:
            waiting.pop()
            text += ")"
            if waiting:
                waiting[-1] -= 1
        if len(line) + len(text) > WIDTH and line:
            yield line
            line = ""
        line += f" {text}" if line else text
    yield line


def _coq(kind: str, argument: Argument) -> str:
    if isinstance(argument, str):
        return f'"{argument}"'
    if isinstance(argument, int):
        return str(argument)
    parts = (f"by_ {x[0]} {q(x[1])}" if isinstance(x, tuple) else q(x) for x in argument)
    return f"[{'; '.join(parts)}]"
