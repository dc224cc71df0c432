"""A partition out of formulas that overlap: for each choice of them that can hold together, exactly these.

Rows are formulas of one trace; a cell is where some rows hold and the others do not. Rows that are proved
to exclude each other need not be denied, and a cell that is proved to be empty is left out, so that few
cells with short texts remain. What could not be proved is taken as possible: the cells that remain are a
partition of the union of the rows, whether or not every one of them can be had.
"""

from collections.abc import Generator, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeVar

from roadproof.evidence.answer import Answer
from roadproof.evidence.claim import Claim, valid_under
from roadproof.library.compose import both, equivalence, implication, negation
from roadproof.library.specification import Query, Specification
from roadproof.reasons import NO_REASON, Reason

T = TypeVar("T")
Asked = Generator[tuple[str, Claim], Answer, T]
"""Yields claims with their names, is sent the answers, and returns what they show."""


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


@dataclass(frozen=True)
class Undivided:
    """Why an axis has no outline."""

    reason: Reason


class _Late(Exception):
    """A proof that was lost, or cut off by the clock."""

    def __init__(self, reason: Reason) -> None:
        self.reason = reason


def _is_proved(home: Specification, name: str, query: Query) -> Asked[bool]:
    """Ask whether ``query`` holds on all traces, and return whether that is proved. Raises ``_Late``."""
    answer = yield name, valid_under(home, query)
    if answer.reason.is_late:
        raise _Late(answer.reason)
    return answer.certificate is not None


def _joined(numbers: Iterable[int]) -> str:
    return "_".join(map(str, numbers))


def whole_cell(axis: Axis, holds: Sequence[int], others: Sequence[int]) -> Cell:
    """The cell where ``holds`` hold and ``others`` do not, with all of that said."""
    return Cell(tuple(holds), tuple(holds), tuple(axis.rows[number] for number in others))


def query_of(axis: Axis, cell: Cell) -> Query:
    """The formula of a cell, context included."""
    return both(*axis.context, *(axis.rows[number] for number in cell.said), *map(negation, cell.denied))


def outline(axis: Axis, home: Specification, name: str) -> Asked[Outline | Undivided]:
    """Ask which choices of rows never hold, and return the cells of an axis but for those proved empty.

    ``name``: how the names of its claims begin. A proof that was lost or cut off would make other classes,
    so there are none then.
    """
    try:
        return (yield from _outline(axis, home, name))
    except _Late as late:
        return Undivided(late.reason)


def _outline(axis: Axis, home: Specification, name: str) -> Asked[Outline]:
    empty: list[Query] = []

    def is_never(holds: Sequence[int], others: Sequence[int] = ()) -> Asked[bool]:
        query = query_of(axis, whole_cell(axis, holds, others))
        word = "only" if others else "any"
        proved = yield from _is_proved(home, f"{name}-{word}-{_joined(holds)}", negation(query))
        if proved and (len(holds) != 2 or others):  # that two rows exclude each other is said by their cells
            empty.append(query)
        return proved

    def possible_of(choices: Iterable[tuple[int, ...]]) -> Asked[list[tuple[int, ...]]]:
        found = []
        for choice in choices:
            if not (yield from is_never(choice)):
                found.append(choice)
        return found

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
    """Choices of one row more, all of whose smaller ones are possible."""
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
) -> Asked[tuple[Cell, Reason]]:
    """Ask what follows from the rest, and return the cell where ``holds`` hold and ``others`` do not without.

    A part of a row stands in its place where the two are proved to be the same there. Where a proof was lost
    or cut off, the cell is returned with all of that, and with the reason. ``name``: how the names of its
    claims begin.
    """
    try:
        return (yield from _refine(axis, home, name, holds, others)), NO_REASON
    except _Late as late:
        return whole_cell(axis, holds, others), late.reason


def _refine(
    axis: Axis, home: Specification, name: str, holds: Sequence[int], others: Sequence[int]
) -> Asked[Cell]:
    def follows(word: str, said: Sequence[int], denied: Iterable[Query], conclusion: Query) -> Asked[bool]:
        premise = query_of(axis, Cell((), tuple(said), tuple(denied)))
        return _is_proved(home, f"{name}-{word}", implication(premise, conclusion))

    rows = axis.rows
    said, denied = list(holds), {n: rows[n] for n in others}
    for number in reversed(holds):
        rest = [n for n in said if n != number]
        if rest and (yield from follows(f"holds-{number}", rest, denied.values(), rows[number])):
            said = rest
    for number in others:
        rest_denied = {n: part for n, part in denied.items() if n != number}
        denial = negation(rows[number])
        if (yield from follows(f"denies-{number}", said, rest_denied.values(), denial)):
            denied = rest_denied
    for number in tuple(denied):
        around = [part for n, part in denied.items() if n != number]
        for place, part in enumerate(axis.parts.get(number, ()), 1):
            same = equivalence(part, rows[number])
            if (yield from follows(f"part-{number}-{place}", said, around, same)):
                denied[number] = part
                break
    return Cell(tuple(holds), tuple(said), tuple(denied.values()))
