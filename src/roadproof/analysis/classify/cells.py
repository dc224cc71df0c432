"""A partition out of formulas that overlap: for each choice of them that can hold together, exactly these.

Rows are formulas of one trace; a cell is where some rows hold and the others do not. Rows that are proved
to exclude each other need not be denied, and a cell that is proved to be empty is left out, so that few
cells with short texts remain. What could not be proved is taken as possible: the cells that remain are a
partition of the union of the rows, whether or not every one of them can be had.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from roadproof.analysis.basis import Basis
from roadproof.library.compose import both, equivalence, implication, negation
from roadproof.library.specification import Query

REFINING = 2.0  # units of work for one proof


@dataclass(frozen=True)
class Axis:
    """What is divided: ``rows`` by number, where all of ``context`` holds.

    ``parts`` of a row are formulas that follow from it, and may stand for it where the rest says as much.
    """

    context: tuple[Query, ...]
    rows: Mapping[int, Query]
    parts: Mapping[int, tuple[Query, ...]]


@dataclass(frozen=True)
class Cell:
    """Exactly the rows ``holds`` hold. That is said by the rows ``said`` and by ``denied``, formulas."""

    holds: tuple[int, ...]
    said: tuple[int, ...]
    denied: tuple[Query, ...]


@dataclass(frozen=True)
class Outline:
    """The rows of each cell, with those that are denied in it; ``empty``: what is proved never to hold."""

    cells: tuple[tuple[tuple[int, ...], tuple[int, ...]], ...]
    empty: tuple[Query, ...]


def whole_cell(axis: Axis, holds: Sequence[int], others: Sequence[int]) -> Cell:
    """The cell where ``holds`` hold and ``others`` do not, with all of that said."""
    return Cell(tuple(holds), tuple(holds), tuple(axis.rows[number] for number in others))


def query_of(axis: Axis, cell: Cell) -> Query:
    """The formula of a cell, context included."""
    return both(*axis.context, *(axis.rows[number] for number in cell.said), *map(negation, cell.denied))


def outline(axis: Axis, basis: Basis) -> Outline:
    """The cells of an axis but for those that are proved empty, each with ``basis.proof`` units of work.

    Raises ``BudgetExceeded``: a proof that the clock cut off would make other classes.
    """
    empty: list[Query] = []

    def never(holds: Sequence[int], others: Sequence[int] = ()) -> bool:
        query = query_of(axis, whole_cell(axis, holds, others))
        if not basis.proof_of(negation(query)).holds:
            return False
        if len(holds) != 2 or others:  # that two rows exclude each other is said by their cells
            empty.append(query)
        return True

    level: list[tuple[int, ...]] = [(number,) for number in sorted(axis.rows) if not never((number,))]
    possible = set(level)
    while level:
        level = [choice for choice in _larger(level, possible) if not never(choice)]
        possible |= set(level)
    cells = []
    for holds in sorted(possible, key=lambda choice: (choice[0], len(choice), choice)):
        others = tuple(n for n in axis.rows if n not in holds and tuple(sorted((*holds, n))) in possible)
        if not others or not never(holds, others):
            cells.append((holds, others))
    return Outline(tuple(cells), tuple(empty))


def _larger(level: Sequence[tuple[int, ...]], possible: set[tuple[int, ...]]) -> Iterator[tuple[int, ...]]:
    """Choices of one row more, all of whose smaller ones are possible."""
    numbers = sorted({number for choice in possible for number in choice})
    for choice in level:
        for number in numbers:
            larger = (*choice, number)
            if number > choice[-1] and all(
                larger[:k] + larger[k + 1 :] in possible for k in range(len(choice))
            ):
                yield larger


def refine(axis: Axis, basis: Basis, holds: Sequence[int], others: Sequence[int]) -> Cell:
    """The cell where ``holds`` hold and ``others`` do not, without what is proved to follow from the rest.

    A part of a row stands in its place where the two are proved to be the same there.
    Raises ``BudgetExceeded``.
    """

    def follows(said: Sequence[int], denied: Iterable[Query], conclusion: Query) -> bool:
        premise = query_of(axis, Cell((), tuple(said), tuple(denied)))
        return basis.proof_of(implication(premise, conclusion), REFINING).holds

    rows = axis.rows
    said, denied = list(holds), {n: rows[n] for n in others}
    for number in reversed(holds):
        rest = [n for n in said if n != number]
        if rest and follows(rest, denied.values(), rows[number]):
            said = rest
    for number in others:
        rest_denied = {n: part for n, part in denied.items() if n != number}
        if follows(said, rest_denied.values(), negation(rows[number])):
            denied = rest_denied
    for number in tuple(denied):
        around = [part for n, part in denied.items() if n != number]
        for part in axis.parts.get(number, ()):
            if follows(said, around, equivalence(part, rows[number])):
                denied[number] = part
                break
    return Cell(tuple(holds), tuple(said), tuple(denied.values()))
