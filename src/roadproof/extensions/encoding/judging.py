"""Checks values of columns against a problem, and judges the drive that they are."""

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction

import numpy as np

from roadproof.engines.encode.problem import All, Circuit, ColumnInequality, evaluate
from roadproof.engines.modifier import find_modifier
from roadproof.engines.search.drive_search import as_judged_drive
from roadproof.engines.search.question import FoundDrive
from roadproof.engines.search.search import complaint_about
from roadproof.engines.search.shape import round_drive
from roadproof.engines.solve.big_m import EncodedProgram
from roadproof.errors import InputError
from roadproof.evidence.judged import JudgedDrive
from roadproof.extensions.encoding.naming import Naming, QuestionPart, named
from roadproof.extensions.encoding.posed import PosedSearch
from roadproof.extensions.encoding.row_table import RowDescriber
from roadproof.extensions.encoding.solutions import Solution
from roadproof.world.drive import Drive

TOLERANCE = Fraction(1, 10**5)
"""How far a value may be outside of a bound of its column, or of a row, for each unit of its size."""
SHOWN = 3  # columns that a message lists


class NoWitnessError(InputError):
    """A solution of the problem on the grid is no witness, as the judge says."""


def columns_of(naming: Naming, solution: Solution) -> tuple[Fraction, ...]:
    """Return the values of the unknowns in a solution, which satisfies the problem.

    The choices of the program may be left out. Raises ``InputError`` with the row that a solution breaks,
    and for columns that are missing or that the problem does not have.
    """
    source = solution.source
    unknowns, entries = naming.unknowns, solution.values
    if not {*unknowns} & {*entries}:
        raise InputError(f"{source}: it has no column of this problem, such as {unknowns[0]}")
    lacks_zeros = solution.format.leaves_out_zeros
    missing = [x for x in unknowns if x not in entries]
    if missing and not lacks_zeros:
        raise InputError(f"{source}: {_listed(missing)} missing: {_where(naming, missing[0])}")
    values = tuple(entries.get(x, Fraction(0)) for x in unknowns)
    others = {*entries} - {*unknowns}
    if others or lacks_zeros:
        _check_program(naming, entries, others, source)
    _check_problem(naming, values, source)
    return values


def _listed(names: Sequence[str]) -> str:
    """Return names of columns with their verb."""
    shown = ", ".join(names[:SHOWN]) + (f" and {len(names) - SHOWN} more" if len(names) > SHOWN else "")
    return f"column {shown} is" if len(names) == 1 else f"columns {shown} are"


def _where(naming: Naming, column: str) -> str:
    """Return the first row that needs a column, in words."""
    place = naming.unknowns.index(column)
    for row in naming.posed.problem.rows:
        if place in row.terms and row.origin is not None:
            part = naming.part(row.origin)
            return RowDescriber(naming.posed).sentence(named(part), part)
    return "no row needs it"


def _check_program(
    naming: Naming,
    entries: Mapping[str, Fraction],
    others: set[str],
    source: str,
) -> None:
    """Raises ``InputError`` where a solution of the program breaks one of its rows."""
    encoded, columns = naming.posed.program, naming.columns
    unknown = sorted(others - {*columns})
    if unknown:
        raise InputError(
            f"{source}: {_listed(unknown)} not of this problem; it was made of another formula, road, "
            "horizon or step, or of another version of roadproof"
        )
    numbers = np.array([float(entries.get(x, 0)) for x in columns])
    for name, part, value, low, high in _broken(encoded, numbers, naming.rows):
        sentence = RowDescriber(naming.posed).sentence(name, part)
        raise InputError(f"{source}: {sentence}; it is {value:.6g}, not in [{low:.6g}, {high:.6g}]")


def _broken(
    encoded: EncodedProgram, x: "np.typing.NDArray[np.float64]", rows: Sequence[tuple[str, QuestionPart]]
) -> Iterator[tuple[str, QuestionPart, float, float, float]]:
    """Yield each row that values break, with its value and its bounds."""
    program = encoded.program
    terms = program.values * x[program.columns]
    sums = np.bincount(program.rows, weights=terms, minlength=len(program.low))
    size = 1 + np.bincount(program.rows, weights=np.abs(terms), minlength=len(program.low))
    slack = float(TOLERANCE) * size
    for k in np.flatnonzero((sums < program.low - slack) | (sums > program.high + slack)):
        yield *rows[int(k)], float(sums[k]), float(program.low[k]), float(program.high[k])


def _check_problem(naming: Naming, values: Sequence[Fraction], source: str) -> None:
    """Raises ``InputError`` where values break a bound, a row, or a condition of the exact problem."""
    posed = naming.posed
    problem, describer = posed.problem, RowDescriber(posed)
    for column, value in zip(problem.columns, values, strict=True):
        slack = TOLERANCE * (1 + abs(value))
        if not column.low - slack <= value <= column.high + slack:
            low, high = float(column.low), float(column.high)
            raise InputError(f"{source}: {column.of} is {float(value):.6g}, not in [{low:.6g}, {high:.6g}]")
    for row in problem.rows:
        parts = [factor * values[k] for k, factor in row.terms.items()]
        value, slack = sum(parts, Fraction(0)), TOLERANCE * (1 + sum(map(abs, parts), Fraction(0)))
        is_low = row.low is not None and value < row.low - slack
        if is_low or (row.high is not None and value > row.high + slack):
            part = QuestionPart((), 0) if row.origin is None else naming.part(row.origin)
            raise InputError(f"{source}: {describer.sentence(named(part), part)}; it is {float(value):.6g}")
    false = _false_part(naming, values)
    if false is not None:
        raise InputError(f"{source}: {describer.sentence(named(false), false)}; it is false")


def _false_part(naming: Naming, values: Sequence[Fraction]) -> QuestionPart | None:
    """Return the part of the first condition of the circuit that is false, or None."""

    def holds(inequality: ColumnInequality) -> bool:
        parts = [
            factor * _product(values, monomial) for monomial, factor in inequality.polynomial.terms.items()
        ]
        return sum(parts, Fraction(0)) >= -TOLERANCE * (1 + sum(map(abs, parts), Fraction(0)))

    circuit: Circuit[ColumnInequality] = naming.posed.problem.circuit
    for conjunct in circuit.parts if isinstance(circuit, All) else (circuit,):
        if not evaluate(conjunct, holds):
            return naming.parts(conjunct)[id(conjunct)]
    return None


def _product(values: Sequence[Fraction], monomial: Sequence[int]) -> Fraction:
    total = Fraction(1)
    for column in monomial:
        total *= values[column]
    return total


def judged(posed: PosedSearch, values: Sequence[Fraction | float], source: str) -> JudgedDrive:
    """Return the drive that values of the unknowns are, rounded to 1 mm/s, where the judge confirms it.

    Values that are no witness when they are rounded are tried as they are. Raises ``NoWitnessError`` with
    the reason of the judge.
    """
    complaints = []
    for drive in _drives(posed, values):
        complaint = complaint_about(
            posed.question, posed.formula, drive, posed.question.grid, posed.assumptions
        )
        if complaint is None:
            candidate = FoundDrive(drive, posed.lanes, posed.formula, posed.question.grid, posed.assumptions)
            _refuse_objection(posed, candidate, source)
            return as_judged_drive(posed.search, posed.question, candidate)
        complaints.append(complaint)
    raise NoWitnessError(
        f"{source}: its drive is no witness: {complaints[0]}; solve the problem for half the step (--dt)"
    )


def _refuse_objection(posed: PosedSearch, drive: FoundDrive, source: str) -> None:
    """Raises ``NoWitnessError`` where a modifier of the question objects to a drive."""
    modifier = find_modifier(posed.search.specification.options)
    objector = None if modifier is None else modifier.objector(posed.search, posed.question)
    if objector is not None and (objection := objector(drive)):
        raise NoWitnessError(f"{source}: its drive is no witness: {objection}")


def _drives(posed: PosedSearch, values: Sequence[Fraction | float]) -> Iterator[Drive]:
    vehicles, exact = posed.question.vehicles, [Fraction(x) for x in values]
    yield round_drive(posed.layout, vehicles, exact)
    yield round_drive(posed.layout, vehicles, exact, None)
