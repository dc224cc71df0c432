"""Pictures of arguments: boxes apart, lines beside boxes, texts inside of shapes, all elements drawn."""

from itertools import combinations, pairwise
from math import hypot
from xml.etree import ElementTree

import pytest

from extensions.assurance.cases import random_case
from roadproof.extensions.assurance.argument import layout as layouts
from roadproof.extensions.assurance.argument.drawing import as_file, draw_argument
from roadproof.extensions.assurance.argument.layout import ArgumentLayout, Labels, Node, Rectangle
from roadproof.extensions.assurance.argument.measured_text import width_of, wrap
from roadproof.extensions.assurance.case.case import ElementKind
from roadproof.extensions.assurance.case.states import ElementState, propagate

SEEDS = range(25)
TEXT = "A competent and careful driver prevents-the-preventable-collisions-of-all-disturbances %s"


def made(seed: int, rows: int) -> ArgumentLayout:
    """The layout of a random case with columns below some depth."""
    case = random_case(seed, most=25)
    return layouts._Tree(case.elements, Labels({}), rows).whole(case.top)


@pytest.mark.parametrize("rows", [1, 2, 9])
@pytest.mark.parametrize("seed", SEEDS)
def test_boxes_are_apart_and_lines_cross_none(seed: int, rows: int) -> None:
    found = made(seed, rows)
    for one, other in combinations(found.nodes, 2):
        assert not one.box.touches(other.box), (one.element.id, other.element.id)
    for link in found.links:
        for (x0, y0), (x1, y1) in pairwise(link.points):
            line = Rectangle(min(x0, x1), min(y0, y1), max(x0, x1), max(y0, y1))
            crossed = {x.element.id for x in found.nodes if shrunk(x.box).touches(line)}
            assert crossed <= {link.begin, link.end}, (link, crossed)


def shrunk(box: Rectangle) -> Rectangle:
    """A box without its edges, where lines begin and end."""
    return Rectangle(box.x0 + 1, box.y0 + 1, box.x1 - 1, box.y1 - 1)


@pytest.mark.parametrize("seed", SEEDS)
def test_every_element_is_drawn_once_and_every_relation_has_a_line(seed: int) -> None:
    case = random_case(seed, most=25)
    found = layouts.lay_out(tuple(case.elements.values()), case.top, Labels({}))
    assert sorted(x.element.id for x in found.nodes if not x.is_reference) == sorted(case.elements)
    relations = [(x.id, y) for x in case.elements.values() for y in (*x.supported_by, *x.in_context_of)]
    assert sorted((x.begin, x.end) for x in found.links) == sorted(relations)


@pytest.mark.parametrize("seed", SEEDS)
def test_texts_are_inside_of_their_shapes(seed: int) -> None:
    for node in made(seed, 2).nodes:
        half_width, half_height = node.text.width / 2, node.text.height / 2
        assert fits(node, half_width, half_height), node


def fits(node: Node, x: float, y: float) -> bool:
    """Whether the corner of a text around the middle of a shape is inside of it."""
    a, b = (node.box.x1 - node.box.x0) / 2, (node.box.y1 - node.box.y0) / 2
    if node.element.kind is ElementKind.SOLUTION:
        return hypot(x, y) <= a
    if node.element.kind in (ElementKind.ASSUMPTION, ElementKind.JUSTIFICATION):
        return (x / a) ** 2 + (y / b) ** 2 <= 1
    return x <= a and y <= b


def test_lines_are_wrapped_and_nothing_is_lost() -> None:
    for most in (40.0, 90.0, 200.0):
        lines = wrap(TEXT, most)
        assert all(width_of(x) <= most for x in lines)
        assert "".join(lines).replace(" ", "") == TEXT.replace(" ", "")


def test_a_broken_branch_is_marked_up_to_the_top() -> None:
    case = random_case(3)
    broken = case.solutions[0]
    states = propagate(
        case, {x.id: ElementState.HOLDS for x in case.solutions} | {broken.id: ElementState.BROKEN}
    )
    picture = draw_argument("Trial", tuple(case.elements.values()), case.top, states, {})
    groups = [x for x in picture.iter("g") if "broken" in x.get("class", "").split()]
    heads = {text.text for x in groups for text in x.iter("text") if text.get("class") == "head"}
    assert heads == {f"{x} ✗ broken" for x, state in states.items() if state is ElementState.BROKEN}
    assert len([x for x in picture.iter("g") if "breaks" in x.get("class", "")]) >= len(heads) - 1 > 0


def test_a_file_has_no_variables_and_both_themes() -> None:
    case = random_case(3)
    states = propagate(case, {x.id: ElementState.HOLDS for x in case.solutions})
    text = as_file(draw_argument("a < b", tuple(case.elements.values()), case.top, states, {})).decode()
    assert "var(" not in text
    assert "prefers-color-scheme: dark" in text
    assert ElementTree.fromstring(text)[0].text == "a < b"
