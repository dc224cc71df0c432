"""The picture of an argument in Goal Structuring Notation as SVG.

Goals are rectangles, strategies parallelograms, solutions circles, contexts rounded, assumptions and
justifications ellipses with a letter; lines of SupportedBy have a solid head, those of InContextOf a hollow
one; undeveloped elements have a diamond. The state of an element is in words, in its outline and in colour.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from xml.etree import ElementTree
from xml.etree.ElementTree import Element as XmlElement

from roadproof.extensions.assurance.argument.layout import DIAMOND, SLANT, Labels, Link, Node, Point, lay_out
from roadproof.extensions.assurance.argument.measured_text import FONT, LEADING
from roadproof.extensions.assurance.case.case import Element, Kind
from roadproof.extensions.assurance.case.states import State
from roadproof.extensions.pages.viewer_page import design
from roadproof.frontends.report.xml import document, element

MARGIN, HEAD = 14.0, 9.0
SIGNS: Mapping[State, str] = {
    State.HOLDS: "✓",
    State.BROKEN: "✗",
    State.UNDECIDED: "?",
    State.UNDEVELOPED: "◇",
}
_LETTERS = {Kind.ASSUMPTION: "A", Kind.JUSTIFICATION: "J"}
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
    title: str, elements: Sequence[Element], top: str, states: Mapping[str, State], more: Mapping[str, str]
) -> XmlElement:
    """The picture of an argument, without a style; ``more``: what boxes say below the texts, by id."""
    heads = {x.id: _head(x, states) for x in elements}
    layout = lay_out(elements, top, Labels(heads, more))
    frame = layout.frame
    width, height = frame.x1 + 2 * MARGIN, frame.y1 + 2 * MARGIN
    links = [_link(x, states) for x in layout.links]
    links.sort(key=lambda x: "breaks" in x.get("class", ""))
    drawn = [*links, *(_node(x, states) for x in layout.nodes)]
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
    """A picture as an SVG file with its colours, light or dark as the system says."""
    light, dark = (_resolved(theme) for theme in (0, 1))
    text = f"{light}@media screen and (prefers-color-scheme: dark) {{\n{dark}}}\n"
    copy = ElementTree.fromstring(ElementTree.tostring(picture))
    paper = element("rect", width="100%", height="100%", **{"class": "paper"})
    ElementTree.register_namespace("", "http://www.w3.org/2000/svg")
    copy.insert(1, element("style", text=text))
    copy.insert(2, paper)
    return document(copy)


def as_markup(picture: XmlElement) -> str:
    """A picture as a part of a page that has ``STYLE``."""
    text: str = ElementTree.tostring(picture, encoding="unicode")
    return text


def _resolved(theme: int) -> str:
    """The style with the colours of the light or the dark theme, for programs that know no variables."""
    colours: dict[str, str] = dict(re.findall(r"--([\w-]+): light-dark\(([^)]*)\);", design()))
    fonts: dict[str, str] = dict(re.findall(r"--([\w-]+): ([^;]*);", design()))
    told = f".paper {{ fill: var(--paper); }}\n{STYLE}"

    def value(name: re.Match[str]) -> str:
        return colours[name[1]].split(", ")[theme] if name[1] in colours else fonts[name[1]]

    return re.sub(r"var\(--([\w-]+)\)", value, told)


def _head(said: Element, states: Mapping[str, State]) -> str:
    state = states.get(said.id)
    return said.id if state is None else f"{said.id} {SIGNS[state]} {state}"


def _node(node: Node, states: Mapping[str, State]) -> XmlElement:
    said, box = node.element, node.box
    bottom = box.y1 - (DIAMOND if said.undeveloped else 0)
    classes = [str(said.kind), str(states.get(said.id, "")), "refers" if node.refers else ""]
    middle = (box.x0 + box.x1) / 2
    y = (box.y0 + bottom) / 2 - node.text.height / 2 + FONT - 1
    texts = [
        element(
            "text", text=line, x=_n(middle), y=_n(y + k * LEADING), **({"class": "head"} if k == 0 else {})
        )
        for k, line in enumerate([node.text.head, *node.text.lines])
    ]
    parts = [element("title", text=f"{said.kind} {said.id}: {said.text}"), _shape(node, bottom), *texts]
    if said.kind in _LETTERS:
        parts.append(element("text", text=_LETTERS[said.kind], x=_n(box.x1 - 8), y=_n(bottom - 2)))
    if said.undeveloped:
        half = DIAMOND / 2
        sides = (middle + half, bottom + half), (middle - half, bottom + half)
        parts.append(_polygon("diamond", [(middle, bottom), sides[0], (middle, bottom + DIAMOND), sides[1]]))
    return element("g", *parts, **{"class": " ".join(filter(None, classes))})


def _shape(node: Node, bottom: float) -> XmlElement:
    box, kind = node.box, node.element.kind
    width, height = box.x1 - box.x0, bottom - box.y0
    if kind is Kind.STRATEGY:
        corners = [(box.x0 + SLANT, box.y0), (box.x1, box.y0), (box.x1 - SLANT, bottom), (box.x0, bottom)]
        return _polygon("shape", corners)
    if kind in (Kind.SOLUTION, Kind.ASSUMPTION, Kind.JUSTIFICATION):
        middle = {"cx": _n((box.x0 + box.x1) / 2), "cy": _n((box.y0 + bottom) / 2)}
        radii = {"rx": _n(width / 2), "ry": _n(height / 2)}
        return element("ellipse", **middle, **radii, **{"class": "shape"})
    size = {"x": _n(box.x0), "y": _n(box.y0), "width": _n(width), "height": _n(height)}
    rounded = {"rx": _n(min(height / 2, 18.0))} if kind is Kind.CONTEXT else {}
    return element("rect", **size, **rounded, **{"class": "shape"})


def _link(link: Link, states: Mapping[str, State]) -> XmlElement:
    breaks = link.supports and State.BROKEN is states.get(link.begin) and State.BROKEN is states.get(link.end)
    classes = ["solid" if link.supports else "hollow", "breaks" if breaks else ""]
    points = list(_without_repeats(link.points))
    (x0, y0), (x, y) = points[-2], points[-1]
    dx, dy = _sign(x - x0), _sign(y - y0)
    back = (x - dx * HEAD, y - dy * HEAD)
    half = HEAD / 2
    tip = [(x, y), (back[0] + dy * half, back[1] + dx * half), (back[0] - dy * half, back[1] - dx * half)]
    path = " ".join(f"{'ML'[k > 0]}{_n(a)} {_n(b)}" for k, (a, b) in enumerate([*points[:-1], back]))
    line = element("path", d=path, **{"class": "line"})
    return element("g", line, _polygon("tip", tip), **{"class": " ".join(filter(None, classes))})


def _without_repeats(points: Sequence[Point]) -> Iterator[Point]:
    for k, point in enumerate(points):
        if k == 0 or point != points[k - 1]:
            yield point


def _sign(value: float) -> int:
    return (value > 1e-9) - (value < -1e-9)


def _polygon(name: str, points: Sequence[Point]) -> XmlElement:
    return element("polygon", points=" ".join(f"{_n(x)},{_n(y)}" for x, y in points), **{"class": name})


def _n(value: float) -> str:
    return f"{value:.1f}"
