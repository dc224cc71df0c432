"""A problem as an SMT query: exact polynomials, exact rationals, nothing approximated."""

from collections.abc import Iterator
from fractions import Fraction
from typing import assert_never

from roadproof.engines.encode.problem import All, AnyOf, ColumnInequality, Leaf, Problem, Row, Solution, nodes
from roadproof.engines.solve.smt import Satisfiability, Session
from roadproof.runtime.budget import Budget, Effort
from roadproof.world.polynomial import Polynomial

UNIT = 600_000  # of what z3 counts: from 0.05 s in preprocessing to 1.5 s on polynomial arithmetic
FIRST_TURN = 1.0


def solve_exactly(problem: Problem, meter: Budget | None = None) -> Solution:
    """Ask z3 for a solution within what ``meter`` has left; ``infeasible`` is an exact no.

    A solution with an irrational value is ``unknown``.

    How long z3 takes depends on luck, so it starts again with another seed and twice the work.
    Raises ``BudgetExceeded``.
    """
    meter = meter or Effort().meter()
    session = Session(UNIT)
    session.tell("\n".join(script(problem)))
    answer: Satisfiability = "unknown"
    seed, turn = 0, FIRST_TURN
    while answer == "unknown" and not meter.is_out():
        answer = session.check_plainly(meter.part(turn), seed)
        seed, turn = seed + 1, turn * 2
    if answer != "sat":
        return Solution("infeasible" if answer == "unsat" else "unknown")
    values = [v for v in session.values([f"c{k}" for k in range(len(problem.columns))]) if v is not None]
    if len(values) < len(problem.columns):
        return Solution("unknown")
    return Solution("found", tuple(Fraction(v) for v in values))


def script(problem: Problem) -> Iterator[str]:
    """The problem as SMT-LIB 2 commands, column k being the constant ``ck``."""
    for k, column in enumerate(problem.columns):
        yield f"(declare-const c{k} Real) ; {column.of}"
        yield f"(assert (<= {_number(column.low)} c{k} {_number(column.high)}))"
    for row in problem.rows:
        yield from _row(row)
    names: dict[int, str] = {}
    for node in nodes(problem.circuit):
        name = f"n{len(names)}"
        names[id(node)] = name
        match node:
            case Leaf(inequality):
                body = _inequality(inequality)
            case All(parts):
                body = f"(and true {' '.join(names[id(p)] for p in parts)})"
            case AnyOf(parts):
                body = f"(or false {' '.join(names[id(p)] for p in parts)})"
            case _:
                assert_never(node)
        yield f"(define-fun {name} () Bool {body})"
    yield f"(assert {names[id(problem.circuit)]})"


def _row(row: Row) -> Iterator[str]:
    total = _polynomial(Polynomial({(column,): factor for column, factor in row.terms.items()}))
    if row.low is not None and row.low == row.high:
        yield f"(assert (= {total} {_number(row.low)}))"
        return
    if row.low is not None:
        yield f"(assert (>= {total} {_number(row.low)}))"
    if row.high is not None:
        yield f"(assert (<= {total} {_number(row.high)}))"


def _inequality(inequality: ColumnInequality) -> str:
    return f"({'>' if inequality.strict else '>='} {_polynomial(inequality.polynomial)} 0.0)"


def _polynomial(polynomial: Polynomial[int]) -> str:
    summands = []
    for monomial, factor in polynomial.terms.items():
        variables = [f"c{column}" for column in monomial]
        summands.append(f"(* {_number(factor)} {' '.join(variables)})" if variables else _number(factor))
    return "0.0" if not summands else summands[0] if len(summands) == 1 else f"(+ {' '.join(summands)})"


def _number(value: Fraction) -> str:
    text = f"{abs(value.numerator)}.0"
    if value.denominator != 1:
        text = f"(/ {text} {value.denominator}.0)"
    return f"(- {text})" if value < 0 else text
