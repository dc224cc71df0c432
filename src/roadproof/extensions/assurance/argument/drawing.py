"""Draws an argument in Goal Structuring Notation as SVG.

Goals are rectangles, strategies parallelograms, solutions circles, and contexts rounded rectangles.
Assumptions and justifications are ellipses with a letter. SupportedBy lines have a solid head, InContextOf
lines a hollow one. Undeveloped elements have a diamond. The state of an element appears as a word, in its
outline and as a colour.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import assert_never
from xml.etree import ElementTree
from xml.etree.ElementTree import Element as XmlElement

from roadproof.extensions.assurance.argument.layout import (
    DIAMOND,
    SLANT,
    Connector,
    Labels,
    Node,
    Point,
    lay_out,
)
from roadproof.extensions.assurance.argument.measured_text import FONT, LEADING
from roadproof.extensions.assurance.case.case import CaseElement, ElementKind
from roadproof.extensions.assurance.case.states import ElementState
from roadproof.extensions.maps.xml_writer import document, element
from roadproof.extensions.pages.viewer_page import design

MARGIN, HEAD = 14.0, 9.0
SIGNS: Mapping[ElementState, str] = {
    ElementState.HOLDS: "✓",
    ElementState.BROKEN: "✗",
    ElementState.UNDECIDED: "?",
    ElementState.UNDEVELOPED: "◇",
}
_LETTERS: Mapping[ElementKind, str] = {  # partial: GSN marks only these with a letter
    ElementKind.ASSUMPTION: "A",
    ElementKind.JUSTIFICATION: "J",
}
STYLE = """\
.gsn text { font-family: var(--text); font-size: 12px; fill: var(--ink); text-anchor: middle; }
.gsn .head { font-weight: 700; }
.gsn .shape, .gsn .diamond { fill: var(--paper); stroke: var(--faint); stroke-width: 1.2; }
.gsn .context .shape, .gsn .assumption .shape, .gsn .justification .shape { fill: var(--ground); }
.gsn .holds .shape { stroke: var(--yes); stroke-width: 1.6; }
.gsn .holds .head { fill: var(--yes); }
.gsn .broken .shape { stroke: var(--no); stroke-width: 3.5; }
.gsn .broken .head { fill: var(--no); }
.gsn .undecided .shape { stroke: var(--open); stroke-width: 2.2; stroke-dasharray: 8 4; }
.gsn .undecided .head { fill: var(--open); }
.gsn .undeveloped .shape, .gsn .undeveloped .diamond { stroke-dasharray: 2 3; stroke-width: 1.6; }
.gsn .refers .shape { stroke-width: 0.8; }
.gsn .line { fill: none; stroke: var(--faint); stroke-width: 1.2; }
.gsn .tip { fill: var(--faint); stroke: var(--faint); stroke-width: 1; }
.gsn .hollow .tip { fill: var(--paper); }
.gsn .breaks .line { stroke: var(--no); stroke-width: 3; }
.gsn .breaks .tip { fill: var(--no); stroke: var(--no); }
"""


def draw_argument(
    title: str,
    elements: Sequence[CaseElement],
    top: str,
    states: Mapping[str, ElementState],
    notes: Mapping[str, str],
) -> XmlElement:
    """Return the picture of an argument as an SVG element without styles; ``notes`` are texts below those of
    the elements, by id.
    """
    heads = {x.id: _head(x, states) for x in elements}
    layout = lay_out(elements, top, Labels(heads, notes))
    frame = layout.frame
    width, height = frame.x1 + 2 * MARGIN, frame.y1 + 2 * MARGIN
    links = [_draw_connector(x, states) for x in layout.links]
    links.sort(key=lambda x: "breaks" in x.get("class", ""))
    drawn = [*links, *(_draw_node(x, states) for x in layout.nodes)]
    place = f"translate({MARGIN:g} {MARGIN:g})"
    return element(
        "svg",
        element("title", text=title),
        element("g", *drawn, transform=place),
        xmlns="http://www.w3.org/2000/svg",
        viewBox=f"0 0 {width:.0f} {height:.0f}",
        width=f"{width:.0f}",
        height=f"{height:.0f}",
        role="img",
        **{"class": "gsn"},
    )


def as_file(picture: XmlElement) -> bytes:
    """Return a picture as an SVG file with its own colours; light or dark follows the system."""
    light, dark = (_style_for_theme(theme) for theme in (0, 1))
    text = f"{light}@media screen and (prefers-color-scheme: dark) {{\n{dark}}}\n"
    copy = ElementTree.fromstring(ElementTree.tostring(picture))
    paper = element("rect", width="100%", height="100%", **{"class": "paper"})
    ElementTree.register_namespace("", "http://www.w3.org/2000/svg")
    copy.insert(1, element("style", text=text))
    copy.insert(2, paper)
    return document(copy)


def as_markup(picture: XmlElement) -> str:
    """Return a picture as markup for a page that has ``STYLE``."""
    text: str = ElementTree.tostring(picture, encoding="unicode")
    return text


def _style_for_theme(theme: int) -> str:
    """Return the style with the colours of a theme (0: light, 1: dark) filled in, for programs without CSS
    variables.
    """
    colours: dict[str, str] = dict(re.findall(r"--([\w-]+): light-dark\(([^)]*)\);", design()))
    fonts: dict[str, str] = dict(re.findall(r"--([\w-]+): ([^;]*);", design()))
    style = f".paper {{ fill: var(--paper); }}\n{STYLE}"

    def value(name: re.Match[str]) -> str:
        return colours[name[1]].split(", ")[theme] if name[1] in colours else fonts[name[1]]

    return re.sub(r"var\(--([\w-]+)\)", value, style)


def _head(case_element: CaseElement, states: Mapping[str, ElementState]) -> str:
    state = states.get(case_element.id)
    return case_element.id if state is None else f"{case_element.id} {SIGNS[state]} {state}"


def _draw_node(node: Node, states: Mapping[str, ElementState]) -> XmlElement:
    case_element, box = node.element, node.box
    bottom = box.y1 - (DIAMOND if case_element.undeveloped else 0)
    classes = [
        str(case_element.kind),
        str(states.get(case_element.id, "")),
        "refers" if node.is_reference else "",
    ]
    middle = (box.x0 + box.x1) / 2
    y = (box.y0 + bottom) / 2 - node.text.height / 2 + FONT - 1
    texts = [
        element(
            "text", text=line, x=_px(middle), y=_px(y + k * LEADING), **({"class": "head"} if k == 0 else {})
        )
        for k, line in enumerate([node.text.head, *node.text.lines])
    ]
    parts = [
        element("title", text=f"{case_element.kind} {case_element.id}: {case_element.text}"),
        _draw_shape(node, bottom),
        *texts,
    ]
    if case_element.kind in _LETTERS:
        parts.append(element("text", text=_LETTERS[case_element.kind], x=_px(box.x1 - 8), y=_px(bottom - 2)))
    if case_element.undeveloped:
        half = DIAMOND / 2
        sides = (middle + half, bottom + half), (middle - half, bottom + half)
        parts.append(_polygon("diamond", [(middle, bottom), sides[0], (middle, bottom + DIAMOND), sides[1]]))
    return element("g", *parts, **{"class": " ".join(filter(None, classes))})


def _draw_shape(node: Node, bottom: float) -> XmlElement:
    box, kind = node.box, node.element.kind
    width, height = box.x1 - box.x0, bottom - box.y0
    match kind:
        case ElementKind.STRATEGY:
            corners = [(box.x0 + SLANT, box.y0), (box.x1, box.y0), (box.x1 - SLANT, bottom), (box.x0, bottom)]
            return _polygon("shape", corners)
        case ElementKind.SOLUTION | ElementKind.ASSUMPTION | ElementKind.JUSTIFICATION:
            middle = {"cx": _px((box.x0 + box.x1) / 2), "cy": _px((box.y0 + bottom) / 2)}
            radii = {"rx": _px(width / 2), "ry": _px(height / 2)}
            return element("ellipse", **middle, **radii, **{"class": "shape"})
        case ElementKind.GOAL | ElementKind.CONTEXT:
            size = {"x": _px(box.x0), "y": _px(box.y0), "width": _px(width), "height": _px(height)}
            rounded = {"rx": _px(min(height / 2, 18.0))} if kind is ElementKind.CONTEXT else {}
            return element("rect", **size, **rounded, **{"class": "shape"})
        case _:
            assert_never(kind)


def _draw_connector(connector: Connector, states: Mapping[str, ElementState]) -> XmlElement:
    breaks = (
        connector.supports
        and ElementState.BROKEN is states.get(connector.begin)
        and ElementState.BROKEN is states.get(connector.end)
    )
    classes = ["solid" if connector.supports else "hollow", "breaks" if breaks else ""]
    points = list(_without_repeats(connector.points))
    (x0, y0), (x, y) = points[-2], points[-1]
    dx, dy = _sign(x - x0), _sign(y - y0)
    back = (x - dx * HEAD, y - dy * HEAD)
    half = HEAD / 2
    tip = [(x, y), (back[0] + dy * half, back[1] + dx * half), (back[0] - dy * half, back[1] - dx * half)]
    path = " ".join(f"{'ML'[k > 0]}{_px(a)} {_px(b)}" for k, (a, b) in enumerate([*points[:-1], back]))
    line = element("path", d=path, **{"class": "line"})
    return element("g", line, _polygon("tip", tip), **{"class": " ".join(filter(None, classes))})


def _without_repeats(points: Sequence[Point]) -> Iterator[Point]:
    for k, point in enumerate(points):
        if k == 0 or point != points[k - 1]:
            yield point


def _sign(value: float) -> int:
    return (value > 1e-9) - (value < -1e-9)


def _polygon(name: str, points: Sequence[Point]) -> XmlElement:
    return element("polygon", points=" ".join(f"{_px(x)},{_px(y)}" for x, y in points), **{"class": name})


def _px(value: float) -> str:
    return f"{value:.1f}"
