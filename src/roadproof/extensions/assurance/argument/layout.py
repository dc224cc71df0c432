"""Places the elements of an argument as a tree: no two boxes overlap, and lines cross no box.

Each element has a box, with its contexts left of it and its assumptions and justifications right of it. What
supports an element stands below it: in a row under its middle, or, in narrow pictures, in a column at the
right of a line. Subtrees are moved together until their outlines touch, as Reingold and Tilford (1981) do
for trees of equal boxes. An element that supports several others is drawn below the first of them; below
the others a box refers to it.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import hypot
from typing import TypeAlias

from roadproof.extensions.assurance.argument.measured_text import LEADING, TextBlock, width_of, wrap
from roadproof.extensions.assurance.case.case import Element, Kind

SIDE, BELOW, BETWEEN, STACKED = 30.0, 38.0, 24.0, 14.0
"""Distances in px: to contexts, to supporting elements, between neighbours, between stacked boxes."""
PAD, SLANT, DIAMOND, TRUNK = 9.0, 14.0, 18.0, 18.0
SHEETS = {"landscape": (1510.0, 850.0), "portrait": (1047.0, 1300.0)}
"""Width and height of a sheet of A3 in px, less margins and a heading with open points."""
_WIDTHS = {
    Kind.GOAL: (150.0, 200.0, 3.0), Kind.STRATEGY: (140.0, 190.0, 3.5), Kind.SOLUTION: (80.0, 150.0, 1.5),
    Kind.CONTEXT: (110.0, 170.0, 2.5), Kind.ASSUMPTION: (110.0, 190.0, 2.2),
    Kind.JUSTIFICATION: (110.0, 190.0, 2.2),
}  # fmt: skip
"""Least and greatest width of texts in px, and how many times wider than high a text is between these."""
_OVAL = 1.3  # of an ellipse to the width of its text
Point: TypeAlias = tuple[float, float]


@dataclass(frozen=True)
class Rectangle:
    """Left, top, right and bottom in px; y grows downwards."""

    x0: float
    y0: float
    x1: float
    y1: float

    def moved(self, dx: float, dy: float) -> "Rectangle":
        return Rectangle(self.x0 + dx, self.y0 + dy, self.x1 + dx, self.y1 + dy)

    def touches(self, other: "Rectangle") -> bool:
        """Whether the two have an inner point in common."""
        return self.x0 < other.x1 and other.x0 < self.x1 and self.y0 < other.y1 and other.y0 < self.y1


@dataclass(frozen=True)
class Node:
    """An element with its text and its box; ``refers``: it stands for one that is drawn elsewhere."""

    element: Element
    text: TextBlock
    box: Rectangle
    refers: bool = False

    def moved(self, dx: float, dy: float) -> "Node":
        return replace(self, box=self.box.moved(dx, dy))


@dataclass(frozen=True)
class Link:
    """A line from an element to one that supports it or is its context; the head is at the end."""

    begin: str
    end: str
    points: tuple[Point, ...]
    supports: bool

    def moved(self, dx: float, dy: float) -> "Link":
        return replace(self, points=tuple((x + dx, y + dy) for x, y in self.points))


@dataclass(frozen=True)
class Layout:
    """Placed nodes and links; ``outline`` holds all boxes, and the room of the links between them."""

    nodes: tuple[Node, ...]
    links: tuple[Link, ...]
    outline: tuple[Rectangle, ...]

    def moved(self, dx: float, dy: float) -> "Layout":
        return Layout(
            tuple(x.moved(dx, dy) for x in self.nodes),
            tuple(x.moved(dx, dy) for x in self.links),
            tuple(x.moved(dx, dy) for x in self.outline),
        )

    @property
    def frame(self) -> Rectangle:
        """The smallest rectangle around everything."""
        xs0, ys0, xs1, ys1 = zip(*((r.x0, r.y0, r.x1, r.y1) for r in self.outline), strict=True)
        return Rectangle(min(xs0), min(ys0), max(xs1), max(ys1))

    def joined(self, other: "Layout") -> "Layout":
        return Layout(self.nodes + other.nodes, self.links + other.links, self.outline + other.outline)


@dataclass(frozen=True)
class Labels:
    """What stands in the boxes beside the texts: the head of each element by its id."""

    heads: Mapping[str, str]
    more: Mapping[str, str] = field(default_factory=dict)


def lay_out(elements: Sequence[Element], top: str, labels: Labels) -> Layout:
    """The layout that is largest on a sheet of A3, of those with rows above and columns below some depth."""
    by_id = {x.id: x for x in elements}
    layouts = (_Tree(by_id, labels, rows).whole(top) for rows in range(1, 10))
    return max(layouts, key=lambda x: max(scale_on(x.frame, sheet) for sheet in SHEETS))


def scale_on(frame: Rectangle, sheet: str) -> float:
    """By how much a picture shrinks on a sheet of A3; 1 where it is not larger."""
    width, height = SHEETS[sheet]
    return min(1.0, width / (frame.x1 - frame.x0), height / (frame.y1 - frame.y0))


class _Tree:
    """Builds layouts from below; elements deeper than ``rows`` have their support in columns."""

    def __init__(self, elements: Mapping[str, Element], labels: Labels, rows: int) -> None:
        self._elements, self._labels, self._rows = elements, labels, rows
        self._drawn: set[str] = set()

    def whole(self, top: str) -> Layout:
        """The layout of the whole argument, with its left top at the origin."""
        made = self._subtree(top, 0)
        return made.moved(-made.frame.x0, -made.frame.y0)

    def _subtree(self, name: str, depth: int) -> Layout:
        """An element and all below it; the middle of its box is at x=0, its top at y=0 or below."""
        refers = name in self._drawn
        self._drawn.add(name)
        element = self._elements[name]
        block = self._block(element, refers, depth > self._rows)
        if refers or not element.supported_by:
            return block
        below = [self._subtree(x, depth + 1) for x in element.supported_by]
        return _column(block, below) if depth >= self._rows else _row(block, below)

    def _block(self, element: Element, refers: bool, right: bool) -> Layout:
        """An element with its contexts beside it; ``right``: all of them at its right."""
        main = self._node(element, refers)
        others = [] if refers else [self._elements[x] for x in element.in_context_of]
        left = [] if right else [x for x in others if x.kind is Kind.CONTEXT]
        made = Layout((main,), (), (main.box,))
        for side, group in ((-1, left), (1, [x for x in others if x not in left])):
            made = made.joined(self._beside(main, group, side)) if group else made
        arriving = _room([(0.0, made.frame.y0), (0.0, main.box.y0)])
        return Layout(made.nodes, made.links, (*made.outline, arriving)).moved(0, -made.frame.y0)

    def _beside(self, main: Node, group: Sequence[Element], side: int) -> Layout:
        nodes = [self._node(x, x.id in self._drawn) for x in group]
        self._drawn |= {x.id for x in group}
        height = sum(x.box.y1 - x.box.y0 for x in nodes) + STACKED * (len(nodes) - 1)
        middle = (main.box.y0 + main.box.y1) / 2
        edge = main.box.x1 if side > 0 else main.box.x0
        y, placed, links = middle - height / 2, list[Node](), list[Link]()
        for node in nodes:
            width, tall = node.box.x1 - node.box.x0, node.box.y1 - node.box.y0
            put = node.moved(edge + side * (SIDE + width / 2), y - node.box.y0)
            end = edge + side * SIDE, y + tall / 2
            half = edge + side * SIDE / 2
            points = ((edge, middle), (half, middle), (half, end[1]), end)
            links.append(Link(main.element.id, node.element.id, points, supports=False))
            placed.append(put)
            y += tall + STACKED
        return Layout(tuple(placed), tuple(links), tuple(x.box for x in placed))

    def _node(self, element: Element, refers: bool) -> Node:
        """An element with its box, whose middle is at x=0 and whose top is at y=0."""
        told = f"see the other box {element.id}" if refers else element.text
        more = self._labels.more.get(element.id, "")
        least, greatest, ratio = _WIDTHS[element.kind]
        most = max(least, min(greatest, (ratio * LEADING * width_of(f"{told} {more}")) ** 0.5))
        lines = [*wrap(told, most), *wrap(more, most)]
        text = TextBlock(self._labels.heads.get(element.id, element.id), lines)
        width, height = _size(element, text)
        return Node(element, text, Rectangle(-width / 2, 0, width / 2, height), refers)


def _size(element: Element, text: TextBlock) -> Point:
    """Width and height of the box of an element."""
    width, height = text.width + 2 * PAD, text.height + 2 * PAD
    if element.kind is Kind.STRATEGY:
        width += 2 * SLANT
    if element.kind is Kind.SOLUTION:
        width = height = hypot(text.width, text.height) + PAD
    if element.kind in (Kind.ASSUMPTION, Kind.JUSTIFICATION):
        share = (1 - 1 / _OVAL**2) ** 0.5
        width, height = text.width * _OVAL + PAD, (text.height + LEADING / 2) / share
    return width, height + (DIAMOND if element.undeveloped else 0)


def _row(block: Layout, below: Sequence[Layout]) -> Layout:
    """Subtrees side by side under the middle of an element."""
    main = block.nodes[0]
    top = block.frame.y1 + BELOW
    placed: list[Layout] = []
    taken: list[Rectangle] = []
    for subtree in below:
        moved = subtree.moved(0, top)
        dx = max((x.x1 + BETWEEN - y.x0 for x, y in _beside_each_other(taken, moved.outline)), default=0.0)
        placed.append(moved.moved(dx, 0))
        taken += placed[-1].outline
    middles = [_middle(x.nodes[0].box) for x in placed]
    shift = -(middles[0] + middles[-1]) / 2
    bus = top - BELOW / 2
    made = block
    for subtree in placed:
        one = subtree.moved(shift, 0)
        box = one.nodes[0].box
        x = _middle(box)
        points = ((0.0, main.box.y1), (0.0, bus), (x, bus), (x, box.y0))
        link = Link(main.element.id, one.nodes[0].element.id, points, supports=True)
        made = made.joined(Layout(one.nodes, (*one.links, link), (*one.outline, _room(points))))
    return made


def _column(block: Layout, below: Sequence[Layout]) -> Layout:
    """Subtrees one below the other, at the right of a line that begins at the left of an element."""
    main = block.nodes[0]
    trunk = main.box.x0 + TRUNK
    y, made = block.frame.y1 + BELOW * 0.6, block
    for subtree in below:
        frame, box = subtree.frame, subtree.nodes[0].box
        one = subtree.moved(trunk + TRUNK + PAD - min(frame.x0, box.x0), y - frame.y0)
        box = one.nodes[0].box
        middle = (box.y0 + box.y1) / 2
        points = ((trunk, main.box.y1), (trunk, middle), (box.x0 + _inset(one.nodes[0]), middle))
        link = Link(main.element.id, one.nodes[0].element.id, points, supports=True)
        made = made.joined(Layout(one.nodes, (*one.links, link), (*one.outline, _room(points))))
        y = made.frame.y1 + STACKED
    return made


def _inset(node: Node) -> float:
    """How far the left edge of a shape is inside of its box at half its height."""
    return SLANT / 2 if node.element.kind is Kind.STRATEGY else 0.0


def _middle(box: Rectangle) -> float:
    return (box.x0 + box.x1) / 2


def _room(points: Sequence[Point]) -> Rectangle:
    """The room of a line."""
    xs, ys = zip(*points, strict=True)
    return Rectangle(min(xs) - 1, min(ys), max(xs) + 1, max(ys))


def _beside_each_other(
    taken: Sequence[Rectangle], new: Sequence[Rectangle]
) -> Iterator[tuple[Rectangle, Rectangle]]:
    """Pairs of rectangles that have a height in common, or nearly so."""
    for x in taken:
        for y in new:
            if x.y0 < y.y1 + STACKED and y.y0 < x.y1 + STACKED:
                yield x, y
