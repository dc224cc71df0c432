"""Places the elements of an argument as a tree, without overlapping boxes and without lines that cross boxes.

Each element has a box, with its contexts to the left and its assumptions and justifications to the right. Its
supporting elements stand below it: in a row, or in narrow pictures in a column at the right of a line. No two
subtrees share a part of the frames around them. An element that supports several others is drawn below the
first of them; below the others a box refers to it.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import accumulate
from math import hypot
from typing import TypeAlias

from roadproof.extensions.assurance.argument.measured_text import LEADING, TextBlock, width_of, wrap
from roadproof.extensions.assurance.case.case import CaseElement, ElementKind

SIDE, BELOW, BETWEEN, STACKED = 30.0, 38.0, 24.0, 14.0
"""Distances in px: to contexts, to supporting elements, between neighbours, between stacked boxes."""
PAD, SLANT, DIAMOND, TRUNK = 9.0, 14.0, 18.0, 18.0
SHEETS = {"landscape": (1510.0, 850.0), "portrait": (1047.0, 1300.0)}
"""The width and height of a sheet of A3 in px, less margins and a heading with open points."""
_WIDTHS: Mapping[ElementKind, tuple[float, float, float]] = {
    ElementKind.GOAL: (150.0, 200.0, 3.0),
    ElementKind.STRATEGY: (140.0, 190.0, 3.5),
    ElementKind.SOLUTION: (80.0, 150.0, 1.5),
    ElementKind.CONTEXT: (110.0, 170.0, 2.5),
    ElementKind.ASSUMPTION: (110.0, 190.0, 2.2),
    ElementKind.JUSTIFICATION: (110.0, 190.0, 2.2),
}
"""The least and the greatest text width in px, and the ratio of width to height of texts between the two."""
_OVAL = 1.3  # of an ellipse to the width of its text
Point: TypeAlias = tuple[float, float]


@dataclass(frozen=True)
class Rectangle:
    """The left, top, right and bottom edge in px; y grows downwards."""

    x0: float
    y0: float
    x1: float
    y1: float

    @property
    def width(self) -> float:
        return self.x1 - self.x0

    def moved(self, dx: float, dy: float) -> "Rectangle":
        return Rectangle(self.x0 + dx, self.y0 + dy, self.x1 + dx, self.y1 + dy)

    def touches(self, other: "Rectangle") -> bool:
        """Return whether the two rectangles have an inner point in common."""
        return self.x0 < other.x1 and other.x0 < self.x1 and self.y0 < other.y1 and other.y0 < self.y1


@dataclass(frozen=True)
class Node:
    """An element with its text and its box; ``is_reference``: the box refers to an element that is drawn
    elsewhere.
    """

    element: CaseElement
    text: TextBlock
    box: Rectangle
    is_reference: bool = False

    def moved(self, dx: float, dy: float) -> "Node":
        return replace(self, box=self.box.moved(dx, dy))


@dataclass(frozen=True)
class Connector:
    """A line from an element (``begin``) to one that supports it or is its context (``end``, where the arrow
    head is).
    """

    begin: str
    end: str
    points: tuple[Point, ...]
    supports: bool

    def moved(self, dx: float, dy: float) -> "Connector":
        return replace(self, points=tuple((x + dx, y + dy) for x, y in self.points))


@dataclass(frozen=True)
class ArgumentLayout:
    """Placed nodes and connectors; ``nodes`` begin with the one that supports all others."""

    nodes: tuple[Node, ...]
    links: tuple[Connector, ...] = ()

    def moved(self, dx: float, dy: float) -> "ArgumentLayout":
        nodes = tuple(x.moved(dx, dy) for x in self.nodes)
        return ArgumentLayout(nodes, tuple(x.moved(dx, dy) for x in self.links))

    @cached_property
    def frame(self) -> Rectangle:
        """The smallest rectangle around all boxes and lines."""
        points = [y for x in self.nodes for y in ((x.box.x0, x.box.y0), (x.box.x1, x.box.y1))]
        xs, ys = zip(*points, *(y for x in self.links for y in x.points), strict=True)
        return Rectangle(min(xs), min(ys), max(xs), max(ys))

    def joined(self, nodes: Iterable[Node], links: Iterable[Connector]) -> "ArgumentLayout":
        return ArgumentLayout((*self.nodes, *nodes), (*self.links, *links))


@dataclass(frozen=True)
class Labels:
    """The texts of boxes in addition to those of the elements: the first line of each and notes
    below, by id.
    """

    heads: Mapping[str, str]
    notes: Mapping[str, str] = field(default_factory=dict)


def lay_out(elements: Sequence[CaseElement], top: str, labels: Labels) -> ArgumentLayout:
    """Return the layout that is largest on a sheet of A3.

    The candidates put supporting elements in rows down to some depth, and in columns below it.
    """
    by_id = {x.id: x for x in elements}
    layouts = (_Tree(by_id, labels, rows).whole(top) for rows in range(1, 10))
    return max(layouts, key=lambda x: max(scale_on(x.frame, sheet) for sheet in SHEETS))


def scale_on(frame: Rectangle, sheet: str) -> float:
    """Return the factor by which a picture shrinks on a sheet of A3; 1 where it fits."""
    width, height = SHEETS[sheet]
    return min(1.0, width / (frame.x1 - frame.x0), height / (frame.y1 - frame.y0))


class _Tree:
    """Builds layouts bottom-up; elements deeper than ``rows`` have their support in columns."""

    def __init__(self, elements: Mapping[str, CaseElement], labels: Labels, rows: int) -> None:
        self._elements, self._labels, self._rows = elements, labels, rows
        self._drawn: set[str] = set()

    def whole(self, top: str) -> ArgumentLayout:
        """Return the layout of the whole argument, with its top left corner at the origin."""
        layout = self._subtree(top, 0)
        return layout.moved(-layout.frame.x0, -layout.frame.y0)

    def _subtree(self, name: str, depth: int) -> ArgumentLayout:
        """Return an element and all below it, with the middle of its box at x=0."""
        is_reference, element = name in self._drawn, self._elements[name]
        self._drawn.add(name)
        layout = self._block(element, is_reference, depth > self._rows)
        if is_reference or not element.supported_by:
            return layout
        below = [self._subtree(x, depth + 1) for x in element.supported_by]
        place = _column if depth >= self._rows else _row
        box = layout.nodes[0].box
        for one, points in place(box, layout.frame.y1, below):
            link = Connector(name, one.nodes[0].element.id, points, supports=True)
            layout = layout.joined(one.nodes, (*one.links, link))
        return layout

    def _block(self, element: CaseElement, is_reference: bool, right: bool) -> ArgumentLayout:
        """Return an element with its contexts in columns beside it; ``right``: all at its right."""
        main = self._node(element, is_reference)
        others = [] if is_reference else [self._elements[x] for x in element.in_context_of]
        left = [] if right else [x for x in others if x.kind is ElementKind.CONTEXT]
        layout, middle = ArgumentLayout((main,)), main.box.y1 / 2
        for side, group in ((-1, left), (1, [x for x in others if x not in left])):
            nodes = [self._node(x, x.id in self._drawn) for x in group]
            self._drawn |= {x.id for x in group}
            edge = main.box.x1 if side > 0 else main.box.x0
            y = middle - (sum(x.box.y1 + STACKED for x in nodes) - STACKED) / 2
            for node in nodes:
                placed = node.moved(edge + side * (SIDE + node.box.x1), y)
                end, half = (edge + side * SIDE, y + node.box.y1 / 2), edge + side * SIDE / 2
                points = ((edge, middle), (half, middle), (half, end[1]), end)
                link = Connector(element.id, node.element.id, points, supports=False)
                layout, y = layout.joined([placed], [link]), y + node.box.y1 + STACKED
        return layout

    def _node(self, element: CaseElement, is_reference: bool) -> Node:
        """Return an element with its box, whose middle is at x=0 and whose top is at y=0."""
        content = f"see the other box {element.id}" if is_reference else element.text
        notes = self._labels.notes.get(element.id, "")
        least, greatest, ratio = _WIDTHS[element.kind]
        most = max(least, min(greatest, (ratio * LEADING * width_of(f"{content} {notes}")) ** 0.5))
        lines = [*wrap(content, most), *wrap(notes, most)]
        text = TextBlock(self._labels.heads.get(element.id, element.id), lines)
        width, height = _size(element, text)
        return Node(element, text, Rectangle(-width / 2, 0, width / 2, height), is_reference)


def _size(element: CaseElement, text: TextBlock) -> Point:
    """Return width and height of the box of an element."""
    width, height = text.width + 2 * PAD, text.height + 2 * PAD
    if element.kind is ElementKind.STRATEGY:
        width += 2 * SLANT
    if element.kind is ElementKind.SOLUTION:
        width = height = hypot(text.width, text.height) + PAD
    if element.kind in (ElementKind.ASSUMPTION, ElementKind.JUSTIFICATION):
        share = (1 - 1 / _OVAL**2) ** 0.5
        width, height = text.width * _OVAL + PAD, (text.height + LEADING / 2) / share
    return width, height + (DIAMOND if element.undeveloped else 0)


Placed: TypeAlias = Iterator[tuple[ArgumentLayout, tuple[Point, ...]]]
"""Subtrees at their places, each with the points of the line to it."""


def _row(box: Rectangle, bottom: float, below: Sequence[ArgumentLayout]) -> Placed:
    """Place subtrees side by side below a box, with the middle of their boxes under its middle."""
    lefts = accumulate((x.frame.width + BETWEEN for x in below[:-1]), initial=0.0)
    middles = [left - x.frame.x0 for left, x in zip(lefts, below, strict=True)]
    shift, bus = -(middles[0] + middles[-1]) / 2, bottom + BELOW / 2
    for middle, subtree in zip(middles, below, strict=True):
        one, x = subtree.moved(middle + shift, bottom + BELOW - subtree.frame.y0), middle + shift
        yield one, ((0.0, box.y1), (0.0, bus), (x, bus), (x, one.nodes[0].box.y0))


def _column(box: Rectangle, bottom: float, below: Sequence[ArgumentLayout]) -> Placed:
    """Place subtrees one below the other, at the right of a line from the left side of a box."""
    trunk, y = box.x0 + TRUNK, bottom + BELOW * 0.6
    for subtree in below:
        one = subtree.moved(trunk + TRUNK + PAD - subtree.frame.x0, y - subtree.frame.y0)
        node, y = one.nodes[0], one.frame.y1 + STACKED
        middle = (node.box.y0 + node.box.y1) / 2
        yield one, ((trunk, box.y1), (trunk, middle), (node.box.x0 + _inset(node), middle))


def _inset(node: Node) -> float:
    """Return the distance of a shape's left edge from the left edge of its box, at half its height."""
    return SLANT / 2 if node.element.kind is ElementKind.STRATEGY else 0.0
