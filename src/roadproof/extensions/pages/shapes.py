"""The shapes of drawings of drives, in px, and their SVG elements at one instant."""

from collections.abc import Mapping, Sequence
from dataclasses import field
from typing import Literal, TypeAlias, TypeVar, assert_never

from roadproof.extensions.maps.xml_writer import Element, document, element
from roadproof.extensions.pages.drive_data import Box, Span
from roadproof.extensions.pages.plane import Points
from roadproof.runtime.records import dataclass

Anchor: TypeAlias = Literal["start", "middle", "end"]
LETTER = 12
"""The size of letters in px."""
FONT = "Helvetica, Arial, sans-serif"
BOX, ENDS = ("x", "y", "width", "height"), ("x1", "x2", "y1", "y2")
"""The attributes of a rectangle and of a line."""
V = TypeVar("V")


@dataclass(frozen=True)
class RectangleShape:
    """A rectangle (left, top, width, height) at each instant, or once; ``red``: whether it is red, at each
    instant.
    """

    boxes: Sequence[Box]
    fill: str
    opacity: float = 1.0
    red: Sequence[bool] = ()


@dataclass(frozen=True)
class LineShape:
    """A line between two points (x, x, y, y) at each instant, or once; ``dash``: px of each dash and gap."""

    ends: Sequence[Box]
    stroke: str
    dash: Span | None = None


@dataclass(frozen=True)
class TextShape:
    """A text; ``places``: the point at each instant, or once, at which it begins, is centred or ends.

    ``before``: the place up to an instant at which the text jumps, by the number of the instant.
    """

    text: str
    places: Sequence[Span]
    fill: str = "#111111"
    size: int = LETTER
    anchor: Anchor = "start"
    before: Mapping[int, Span] = field(default_factory=dict)


@dataclass(frozen=True)
class PolygonShape:
    """A polygon with its corners in px at each instant, or once; ``red``: whether it is red, at
    each instant.
    """

    outlines: Sequence[Points]
    fill: str
    opacity: float = 1.0
    red: Sequence[bool] = ()


@dataclass(frozen=True)
class StrokesShape:
    """Lines through points in px, the same at all instants; ``dash``: px of each dash and gap."""

    lines: Sequence[Points]
    stroke: str
    width: float = 1.0
    dash: Span | None = None


Shape: TypeAlias = RectangleShape | LineShape | TextShape | PolygonShape | StrokesShape


def value_at(values: Sequence[V], k: int) -> V:
    """Return the value at instant ``k``, or the only value of a shape that does not move."""
    return values[k] if len(values) > 1 else values[0]


def element_at(shape: Shape, k: int = 0) -> Element:
    """Return the SVG element of a shape at instant ``k``."""
    match shape:
        case RectangleShape():
            look = _opacity(shape.opacity)
            return element("rect", **attributes(BOX, value_at(shape.boxes, k)), fill=shape.fill, **look)
        case PolygonShape():
            look = _opacity(shape.opacity) or {"stroke": shape.fill, "stroke-width": "0.6"}
            return element(
                "polygon", points=points_text(value_at(shape.outlines, k)), fill=shape.fill, **look
            )
        case StrokesShape():
            way = " ".join(f"M{points_text(x)}" for x in shape.lines)
            look = {} if shape.width == 1 else {"stroke-width": f"{shape.width:g}"}
            return element("path", d=way, fill="none", stroke=shape.stroke, **look, **_dash(shape.dash))
        case LineShape():
            ends = attributes(ENDS, value_at(shape.ends, k))
            return element("line", **ends, stroke=shape.stroke, **_dash(shape.dash))
        case TextShape():
            anchor = {} if shape.anchor == "start" else {"text-anchor": shape.anchor}
            place = attributes(("x", "y"), value_at(shape.places, k))
            look = {"fill": shape.fill, "font-size": str(shape.size)}
            return element("text", text=shape.text, **place, **look, **anchor)
        case _:
            assert_never(shape)


def svg_of(elements: Sequence[Element], width: float, height: float) -> bytes:
    """Return an SVG file with elements on a white ground."""
    root = element(
        "svg",
        element("rect", width="100%", height="100%", fill="white"),
        *elements,
        xmlns="http://www.w3.org/2000/svg",
        viewBox=f"0 0 {width:g} {height:g}",
        width=f"{width:g}",
        height=f"{height:g}",
        **{"font-family": FONT},
    )
    return document(root)


def px(value: float) -> str:
    """Return pixels as text, with at most one decimal."""
    return f"{value:.1f}".removesuffix(".0")


def points_text(points: Points) -> str:
    """Return points as text, as SVG has them."""
    return " ".join(f"{px(x)},{px(y)}" for x, y in points)


def attributes(names: Sequence[str], values: Sequence[float]) -> dict[str, str]:
    """Return attributes with their pixels."""
    return dict(zip(names, map(px, values), strict=True))


def _opacity(opacity: float) -> Mapping[str, str]:
    return {} if opacity == 1 else {"fill-opacity": f"{opacity:g}"}


def _dash(dash: Span | None) -> Mapping[str, str]:
    return {} if dash is None else {"stroke-dasharray": " ".join(map(px, dash))}
