"""Decides a problem exactly with z3: polynomials and rationals as SMT-LIB text, no approximation."""

from collections.abc import Iterator, Sequence
from fractions import Fraction
from typing import assert_never

from roadproof.engines.encode.problem import (
    All,
    AnyOf,
    Circuit,
    ColumnInequality,
    ColumnValues,
    Leaf,
    Problem,
    RealColumn,
    Row,
    nodes,
)
from roadproof.engines.solve.smt import Satisfiability, Session
from roadproof.runtime.budget import Budget, Effort
from roadproof.world.polynomial import Polynomial

UNIT = 600_000  # of what z3 counts: from 0.05 s in preprocessing to 1.5 s on polynomial arithmetic
FIRST_TURN = 1.0


def solve_exactly(problem: Problem, meter: Budget | None = None) -> ColumnValues:
    """Solve a problem with z3 within what ``meter`` has left; ``infeasible`` is an exact answer.

    A solution with an irrational value is ``unknown``. How long z3 takes depends on luck, so it starts again
    with another seed and twice the work. Raises ``BudgetExceeded``.
    """
    meter = meter or Effort().meter()
    session = Session(UNIT)
    session.tell("\n".join(script(problem)))
    answer: Satisfiability = "unknown"
    seed, turn = 0, FIRST_TURN
    while answer == "unknown" and not meter.is_exhausted():
        answer = session.check_plainly(meter.part(turn), seed)
        seed, turn = seed + 1, turn * 2
    if answer != "sat":
        return ColumnValues("infeasible" if answer == "unsat" else "unknown")
    values = [v for v in session.values([f"c{k}" for k in range(len(problem.columns))]) if v is not None]
    if len(values) < len(problem.columns):
        return ColumnValues("unknown")
    return ColumnValues("found", tuple(Fraction(v) for v in values))


def script(problem: Problem) -> Iterator[str]:
    """Yield the problem as SMT-LIB 2 commands; column k is the constant ``ck``."""
    columns = [f"c{k}" for k in range(len(problem.columns))]
    for name, column in zip(columns, problem.columns, strict=True):
        yield f"(declare-const {name} Real) ; {column.of}"
        yield f"(assert {column_condition(name, column)})"
    for row in problem.rows:
        for condition in row_conditions(row, columns):
            yield f"(assert {condition})"
    whole = ""
    for _, name, definition in node_definitions(problem.circuit, columns):
        yield definition
        whole = name
    yield f"(assert {whole})"


def column_condition(name: str, column: RealColumn) -> str:
    """Return the bounds of a column as a condition."""
    return f"(<= {_number(column.low)} {name} {_number(column.high)})"


def row_conditions(row: Row, columns: Sequence[str]) -> Iterator[str]:
    """Yield a row as conditions on named columns: an equation, or one for each bound."""
    total = _polynomial(Polynomial({(column,): factor for column, factor in row.terms.items()}), columns)
    if row.low is not None and row.low == row.high:
        yield f"(= {total} {_number(row.low)})"
        return
    if row.low is not None:
        yield f"(>= {total} {_number(row.low)})"
    if row.high is not None:
        yield f"(<= {total} {_number(row.high)})"


def node_definitions(
    circuit: Circuit[ColumnInequality], columns: Sequence[str]
) -> Iterator[tuple[Circuit[ColumnInequality], str, str]]:
    """Yield each node of a circuit, the name of its truth, and the command that defines it; the last is all.

    Nodes are named ``n0``, ``n1``, …, parts before wholes.
    """
    names: dict[int, str] = {}
    for node in nodes(circuit):
        name = names[id(node)] = f"n{len(names)}"
        match node:
            case Leaf(inequality):
                relation = ">" if inequality.strict else ">="
                body = f"({relation} {_polynomial(inequality.polynomial, columns)} 0.0)"
            case All(parts):
                body = f"(and true {' '.join(names[id(p)] for p in parts)})"
            case AnyOf(parts):
                body = f"(or false {' '.join(names[id(p)] for p in parts)})"
            case _:
                assert_never(node)
        yield node, name, f"(define-fun {name} () Bool {body})"


def _polynomial(polynomial: Polynomial[int], columns: Sequence[str]) -> str:
    summands = []
    for monomial, factor in polynomial.terms.items():
        variables = [columns[column] for column in monomial]
        summands.append(f"(* {_number(factor)} {' '.join(variables)})" if variables else _number(factor))
    return "0.0" if not summands else summands[0] if len(summands) == 1 else f"(+ {' '.join(summands)})"


def _number(value: Fraction) -> str:
    text = f"{abs(value.numerator)}.0"
    if value.denominator != 1:
        text = f"(/ {text} {value.denominator}.0)"
    return f"(- {text})" if value < 0 else text
