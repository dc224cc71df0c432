"""Matrices of pages, whose cells lead to evidence."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from roadproof.runtime.records import dataclass


class Heading(NamedTuple):
    """A row or a column of a matrix, with what is said of it; ``key`` tells it apart."""

    key: object
    name: object
    told: str | None = None


class Linked(NamedTuple):
    """A verdict in words, and the part of the page with its evidence, if it has any."""

    verdict: str
    told: str
    target: str | None


@dataclass(frozen=True)
class Matrix:
    """A sheet of linked cells, each in a row and a column; places without a cell stay empty.

    ``groups``: names above columns, each with the number of columns below it.
    """

    rows: Sequence[Heading]
    columns: Sequence[Heading]
    cells: Mapping[tuple[object, object], Linked]
    groups: Sequence[tuple[str, int]] = ()
