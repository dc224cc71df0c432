"""A partition made of formulas that overlap.

Rows are formulas of one trace. A cell is a choice of rows that hold while the others do not. A cell that is
proved empty is left out, and rows that are proved to exclude each other need no denial. So few cells with
short texts remain. A cell counts as possible unless it is proved empty. So the cells are a partition of the
union of the rows, even if some of them never occur.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from roadproof.evidence.assuming import valid_under
from roadproof.extensions.surveys.extremes.points import ClaimGenerator
from roadproof.library.compose import both, equivalence, implication, negation
from roadproof.library.specification import Query, Specification
from roadproof.reasons import NO_REASON, Reason


@dataclass(frozen=True)
class Axis:
    """An axis of the division: formulas ``rows`` by number, under the premises ``context``.

    ``parts``: for each row, formulas that follow from it and may replace it in the text of a cell.
    """

    context: tuple[Query, ...]
    rows: Mapping[int, Query]
    parts: Mapping[int, tuple[Query, ...]]


@dataclass(frozen=True)
class Cell:
    """A cell in which exactly the rows ``holds`` hold; its formula requires some rows and denies formulas."""

    holds: tuple[int, ...]
    required: tuple[int, ...]
    denied: tuple[Query, ...]


@dataclass(frozen=True)
class Outline:
    """The rows that hold and those that are denied in each cell; ``empty``: formulas proved never to hold."""

    cells: tuple[tuple[tuple[int, ...], tuple[int, ...]], ...]
    empty: tuple[Query, ...]


@dataclass(frozen=True)
class OutlineFailure:
    """The reason why an axis has no outline."""

    reason: Reason


class _LateProof(Exception):
    """A proof that was lost, or cut off by the clock."""

    def __init__(self, reason: Reason) -> None:
        self.reason = reason


def _is_proved(home: Specification, name: str, query: Query) -> ClaimGenerator[bool]:
    """Ask whether ``query`` holds on all traces, and return whether that is proved. Raises ``_LateProof``."""
    answer = yield name, valid_under(home, query)
    if answer.reason.is_late:
        raise _LateProof(answer.reason)
    return answer.certificate is not None


def _joined(numbers: Iterable[int]) -> str:
    return "_".join(map(str, numbers))


def whole_cell(axis: Axis, holds: Sequence[int], others: Sequence[int]) -> Cell:
    """Return the cell where ``holds`` hold and ``others`` do not, without a shorter text."""
    return Cell(tuple(holds), tuple(holds), tuple(axis.rows[number] for number in others))


def query_of(axis: Axis, cell: Cell) -> Query:
    """Return the formula of a cell, premises included."""
    return both(*axis.context, *(axis.rows[number] for number in cell.required), *map(negation, cell.denied))


def outline(axis: Axis, home: Specification, name: str) -> ClaimGenerator[Outline | OutlineFailure]:
    """Ask which choices of rows never hold, and return the cells of an axis that are not proved empty.

    ``name``: the beginning of the names of its claims. A lost or interrupted proof would change the cells. So
    the outline fails then.
    """
    try:
        return (yield from _outline(axis, home, name))
    except _LateProof as late:
        return OutlineFailure(late.reason)


def _outline(axis: Axis, home: Specification, name: str) -> ClaimGenerator[Outline]:
    empty: list[Query] = []

    def is_never(holds: Sequence[int], others: Sequence[int] = ()) -> ClaimGenerator[bool]:
        query = query_of(axis, whole_cell(axis, holds, others))
        word = "only" if others else "any"
        proved = yield from _is_proved(home, f"{name}-{word}-{_joined(holds)}", negation(query))
        if proved and (len(holds) != 2 or others):  # that two rows exclude each other is said by their cells
            empty.append(query)
        return proved

    def possible_of(choices: Iterable[tuple[int, ...]]) -> ClaimGenerator[list[tuple[int, ...]]]:
        possible_choices = []
        for choice in choices:
            if not (yield from is_never(choice)):
                possible_choices.append(choice)
        return possible_choices

    level = yield from possible_of((number,) for number in sorted(axis.rows))
    possible = set(level)
    while level:
        level = yield from possible_of([*_larger(level, possible)])
        possible |= set(level)
    cells = []
    for holds in sorted(possible, key=lambda choice: (choice[0], len(choice), choice)):
        others = tuple(n for n in axis.rows if n not in holds and tuple(sorted((*holds, n))) in possible)
        if not others or not (yield from is_never(holds, others)):
            cells.append((holds, others))
    return Outline(tuple(cells), tuple(empty))


def _larger(level: Sequence[tuple[int, ...]], possible: set[tuple[int, ...]]) -> Iterator[tuple[int, ...]]:
    """Yield choices with one more row, of which every smaller choice is possible."""
    numbers = sorted({number for choice in possible for number in choice})
    for choice in level:
        for number in numbers:
            larger = (*choice, number)
            if number > choice[-1] and all(
                larger[:k] + larger[k + 1 :] in possible for k in range(len(choice))
            ):
                yield larger


def refine(
    axis: Axis, home: Specification, name: str, holds: Sequence[int], others: Sequence[int]
) -> ClaimGenerator[tuple[Cell, Reason]]:
    """Return the cell where ``holds`` hold and ``others`` do not, with the shortest text that proofs allow.

    Rows that follow from the rest are dropped. A part replaces its row where the two are proved equivalent.
    After a lost or interrupted proof the cell has its full text, and the reason is returned. ``name``: the
    beginning of the names of its claims.
    """
    try:
        return (yield from _refine(axis, home, name, holds, others)), NO_REASON
    except _LateProof as late:
        return whole_cell(axis, holds, others), late.reason


def _refine(
    axis: Axis, home: Specification, name: str, holds: Sequence[int], others: Sequence[int]
) -> ClaimGenerator[Cell]:
    def follows(
        word: str, required: Sequence[int], denied: Iterable[Query], conclusion: Query
    ) -> ClaimGenerator[bool]:
        premise = query_of(axis, Cell((), tuple(required), tuple(denied)))
        return _is_proved(home, f"{name}-{word}", implication(premise, conclusion))

    rows = axis.rows
    required, denied = list(holds), {n: rows[n] for n in others}
    for number in reversed(holds):
        rest = [n for n in required if n != number]
        if rest and (yield from follows(f"holds-{number}", rest, denied.values(), rows[number])):
            required = rest
    for number in others:
        rest_denied = {n: part for n, part in denied.items() if n != number}
        denial = negation(rows[number])
        if (yield from follows(f"denies-{number}", required, rest_denied.values(), denial)):
            denied = rest_denied
    for number in tuple(denied):
        around = [part for n, part in denied.items() if n != number]
        for place, part in enumerate(axis.parts.get(number, ()), 1):
            same = equivalence(part, rows[number])
            if (yield from follows(f"part-{number}-{place}", required, around, same)):
                denied[number] = part
                break
    return Cell(tuple(holds), tuple(required), tuple(denied.values()))
