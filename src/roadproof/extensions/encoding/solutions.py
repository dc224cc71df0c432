"""Readers of solutions that other solvers write: HiGHS, SCIP, CBC, Gurobi, and models of SMT solvers."""

import math
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from enum import StrEnum, unique
from fractions import Fraction
from pathlib import Path

from roadproof.engines.solve.smt import SExpression, parse_sexpression, read_value
from roadproof.errors import InputError
from roadproof.runtime.files import read_text
from roadproof.runtime.records import dataclass

MOST_BYTES = 64_000_000


@unique
class SolutionFormat(StrEnum):
    """The formats of solutions."""

    HIGHS = "HiGHS"
    SCIP = "SCIP"
    CBC = "CBC"
    GUROBI = "Gurobi"
    SMT = "SMT-LIB model"

    @property
    def leaves_out_zeros(self) -> bool:
        """Return whether a column that is not in the file has the value 0."""
        return self in (SolutionFormat.SCIP, SolutionFormat.CBC)


@dataclass(frozen=True)
class Solution:
    """The values of columns by name, as a file has them."""

    source: str
    format: SolutionFormat
    values: Mapping[str, Fraction]


def read_solution(path: Path) -> Solution:
    """Read a solution; the first lines tell its format. Raises ``InputError``."""
    return parse_solution(read_text(path, MOST_BYTES, "a solution has a line for each column"), str(path))


def parse_solution(content: str, source: str) -> Solution:
    """Return the solution in a text. Raises ``InputError`` with file and line."""
    form = _format_of(content, source)
    values: dict[str, Fraction] = {}
    for line, name, value in _READERS[form](content, source):
        if name in values:
            raise InputError(f"{source}, line {line}: column {name} has a value already; keep one")
        values[name] = value
    return Solution(source, form, values)


def _format_of(content: str, source: str) -> SolutionFormat:
    lines = [x.strip() for x in content.splitlines() if x.strip()]
    first = lines[0] if lines else ""
    if first == "Model status":
        return SolutionFormat.HIGHS
    if first.startswith(("solution status:", "objective value:")):
        return SolutionFormat.SCIP
    if first in ("sat", "unsat", "unknown") or first.startswith("("):
        return SolutionFormat.SMT
    if re.match(r"(Optimal|Infeasible|Integer infeasible|Stopped on|Unbounded)\b", first):
        return SolutionFormat.CBC
    if first.startswith("#"):
        return SolutionFormat.GUROBI
    raise InputError(
        f"{source}, line 1: '{first[:60]}' begins no solution: they are those of HiGHS, SCIP, CBC, Gurobi "
        "(.sol) and models of SMT solvers"
    )


_PRIMAL = "# Primal solution values"
Entries = Iterator[tuple[int, str, Fraction]]


def _highs(content: str, source: str) -> Entries:
    """Yield the entries of the section of columns; it begins with their number."""
    lines = [x.rstrip() for x in content.splitlines()]
    primal = lines.index(_PRIMAL) + 1 if _PRIMAL in lines else len(lines)
    starts = [k for k, x in enumerate(lines) if x.startswith("# Columns") and k > primal]
    if lines[primal : primal + 1] != ["Feasible"] or not starts:
        raise _no_solution(source, next((x for x in lines[1:] if x), ""))
    start = starts[0]
    count = _whole(lines[start].removeprefix("# Columns"), f"{source}, line {start + 1}")
    entries = lines[start + 1 : start + 1 + count]
    if len(entries) < count:
        raise InputError(f"{source}: it ends after {len(entries)} of {count} columns; write it again")
    yield from _pairs(enumerate(entries, start + 2), source)


def _scip(content: str, source: str) -> Entries:
    """Yield entries, each with its cost in parentheses; columns that are 0 are left out."""
    heads = ("solution status:", "objective value:")
    lines = [*enumerate(content.splitlines(), 1)]
    status = next((x for _, x in lines if x.startswith(heads[0])), "").removeprefix(heads[0]).strip()
    entries = [(k, x) for k, x in lines if x.strip() and not x.startswith(heads)]
    if not entries or any(x.startswith("no solution") for _, x in entries):
        raise _no_solution(source, status)
    yield from _pairs(((k, re.sub(r"\(obj:[^)]*\)\s*$", "", x)) for k, x in entries), source)


def _cbc(content: str, source: str) -> Entries:
    """Yield entries after the line of the status: number, name, value, reduced cost."""
    status, *lines = content.splitlines()
    if status.startswith(("Infeasible", "Integer infeasible", "Unbounded")):
        raise _no_solution(source, status)
    for k, line in enumerate(lines, 2):
        words = line.removeprefix("**").split()
        if len(words) != 4:
            raise _no_entry(source, k, line)
        yield k, words[1], _number(words[2], source, k)


def _gurobi(content: str, source: str) -> Entries:
    lines = enumerate(content.splitlines(), 1)
    yield from _pairs(((k, x) for k, x in lines if not x.startswith("#")), source)


def _smt(content: str, source: str) -> Entries:
    """Yield the constants of a model; functions and other sorts are left out, as solvers define helpers."""
    status = content.split(maxsplit=1)[0]
    if status in ("unsat", "unknown"):
        raise _no_solution(source, status)
    body = content[content.index("(") :] if "(" in content else ""
    for entry in parse_sexpression(body):
        match entry:
            case ["define-fun", str(name), [] | "", "Real", value]:
                yield 0, name.strip("|"), _rational(value, name, source)
            case [str(name), value] if name != "define-fun":  # of get-value
                yield 0, name.strip("|"), _rational(value, name, source)
            case _:  # open: whatever else a solver lists
                continue


def _rational(value: SExpression, name: str, source: str) -> Fraction:
    read = read_value(value)
    if read is None:
        raise InputError(f"{source}: {name} has an irrational value; ask the solver for decimals")
    return Fraction(read)


_READERS: Mapping[SolutionFormat, Callable[[str, str], Entries]] = {
    SolutionFormat.HIGHS: _highs,
    SolutionFormat.SCIP: _scip,
    SolutionFormat.CBC: _cbc,
    SolutionFormat.GUROBI: _gurobi,
    SolutionFormat.SMT: _smt,
}


def _pairs(lines: Iterable[tuple[int, str]], source: str) -> Entries:
    for k, line in lines:
        words = line.split()
        if not words:
            continue
        if len(words) != 2:
            raise _no_entry(source, k, line)
        yield k, words[0], _number(words[1], source, k)


def _number(word: str, source: str, line: int) -> Fraction:
    try:
        value = float(word)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise InputError(f"{source}, line {line}: '{word[:40]}' is no finite number")
    return Fraction(word) if re.fullmatch(r"-?\d+(\.\d+)?([eE][-+]?\d{1,3})?", word) else Fraction(value)


def _whole(text: str, where: str) -> int:
    if not text.strip().isdecimal():
        raise InputError(f"{where}: '{text.strip()[:40]}' is no number of columns")
    return int(text)


def _no_entry(source: str, line: int, text: str) -> InputError:
    return InputError(f"{source}, line {line}: '{text.strip()[:60]}' is no name with a value")


def _no_solution(source: str, status: str) -> InputError:
    return InputError(f"{source}: it has no solution: the solver's status is '{status.strip()[:60]}'")
