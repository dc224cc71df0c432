"""Draws a drive as one animated SVG file, which a browser plays without scripts."""

from collections.abc import Iterator, Mapping, Sequence
from xml.etree.ElementTree import Element

from roadproof.evidence.drive_file import DriveFile
from roadproof.extensions.maps.xml_writer import document, element
from roadproof.extensions.pages.bent_scene import scene_of
from roadproof.extensions.pages.scene import (
    PAUSE,
    WIDTH,
    AnimationScene,
    LineShape,
    Pavement,
    PolygonShape,
    RectangleShape,
    Shape,
    StrokesShape,
    headings,
    timeline_rows,
)
from roadproof.frontends.report.drive import DANGER
from roadproof.frontends.report.drive_data import GRAIN
from roadproof.frontends.report.plane import Points
from roadproof.library.specification import Library

_BOX, _ENDS = ("x", "y", "width", "height"), ("x1", "x2", "y1", "y2")


def draw_moving(file: DriveFile, library: Library) -> bytes:
    """Return the animated SVG of a drive; its heading is the scenario in words, or the formula."""
    scene = scene_of(file, library)
    root = element(
        "svg",
        element("rect", width="100%", height="100%", fill="white"),
        *(_element_of(scene, x) for x in headings(scene)),
        *_road(scene, scene.pavement()),
        *(_element_of(scene, x) for x in (*scene.vehicles(), *timeline_rows(scene))),
        xmlns="http://www.w3.org/2000/svg",
        viewBox=f"0 0 {WIDTH:g} {scene.height:g}",
        width=f"{WIDTH:g}",
        height=f"{scene.height:g}",
        **{"font-family": "Helvetica, Arial, sans-serif"},
    )
    return document(root)


def _road(scene: AnimationScene, lanes: Pavement) -> Iterator[Element]:
    """Yield the lanes and RSS areas, both clipped to the window."""
    cut = element("rect", **_attributes(_BOX, lanes.window))
    yield element("clipPath", cut, id="window")
    drawn = [_element_of(scene, x) for x in lanes.shapes]
    here, still = [x.x for x in lanes.shifts], lanes.shifts[scene.still]
    if lanes.pivot is None:
        moving = _transform_animation(scene, "translate", _loop_values(here))
        moved = element("g", *drawn, moving, transform=f"translate({_px(still.x)} 0)")
    else:
        places = _joined([f"{_px(x.x)} {_px(x.y)}" for x in lanes.shifts])
        pivot = " ".join(map(_px, lanes.pivot))
        turns = _joined([f"{x.turned:.2f} {pivot}" for x in lanes.shifts])
        moving = _transform_animation(scene, "translate", places)
        inner = element("g", *drawn, moving, transform=f"translate({_px(still.x)} {_px(still.y)})")
        turning = _transform_animation(scene, "rotate", turns)
        moved = element("g", inner, turning, transform=f"rotate({still.turned:.2f} {pivot})")
    yield element(
        "g", moved, *(_element_of(scene, x) for x in scene.areas()), **{"clip-path": "url(#window)"}
    )


def _element_of(scene: AnimationScene, shape: Shape) -> Element:
    """Return the element of a shape at the instant of a still picture, with its animations."""
    if isinstance(shape, RectangleShape):
        still, changes = _at_instants(scene, _BOX, shape.boxes)
        opacity = {} if shape.opacity == 1 else {"fill-opacity": f"{shape.opacity:g}"}
        made = element("rect", **still, fill=shape.fill, **opacity)
        if shape.red:
            changes.append(_fill_animation(scene, shape.red, DANGER, shape.fill))
    elif isinstance(shape, PolygonShape):
        opacity = {} if shape.opacity == 1 else {"fill-opacity": f"{shape.opacity:g}"}
        here = shape.outlines[scene.still if len(shape.outlines) > 1 else 0]
        seam = {} if opacity else {"stroke": shape.fill, "stroke-width": "0.6"}
        made = element("polygon", points=_points(here), fill=shape.fill, **opacity, **seam)
        changes = [_outline_animation(scene, shape.outlines)] if len(shape.outlines) > 1 else []
        if shape.red:
            changes.append(_fill_animation(scene, shape.red, DANGER, shape.fill))
    elif isinstance(shape, StrokesShape):
        way = " ".join(f"M{_points(x)}" for x in shape.lines)
        made, changes = element("path", d=way, fill="none", stroke=shape.stroke), []
    elif isinstance(shape, LineShape):
        still, changes = _at_instants(scene, _ENDS, shape.ends)
        dash = {} if shape.dash is None else {"stroke-dasharray": " ".join(map(_px, shape.dash))}
        made = element("line", **still, stroke=shape.stroke, **dash)
    else:
        still, changes = _at_instants(scene, ("x", "y"), shape.places)
        anchor = {"text-anchor": "middle"} if shape.middle else {}
        look = {"fill": shape.fill, "font-size": str(shape.size)}
        made = element("text", text=shape.text, **still, **look, **anchor)
    made.extend(changes)
    return made


# --- changes ------------------------------------------------------------------------------------


def _px(value: float) -> str:
    return f"{value:.1f}".removesuffix(".0")


def _attributes(names: Sequence[str], values: Sequence[float]) -> dict[str, str]:
    return dict(zip(names, map(_px, values), strict=True))


def _at_instants(
    scene: AnimationScene, names: Sequence[str], values: Sequence[Sequence[float]]
) -> tuple[dict[str, str], list[Element]]:
    """Return attributes at the instant of a still picture, and animations of those that change."""
    still = values[scene.still if len(values) > 1 else 0]
    each = dict(zip(names, zip(*values, strict=True), strict=True))
    return _attributes(names, still), [*_attribute_animations(scene, each)]


def _attribute_animations(scene: AnimationScene, values: Mapping[str, Sequence[float]]) -> Iterator[Element]:
    """Yield an animation for each attribute that changes; ``values``: by attribute, at each instant."""
    for name, numbers in values.items():
        if len({_px(x) for x in numbers}) > 1:
            yield element("animate", attributeName=name, values=_loop_values(numbers), **_loop_timing(scene))


def _transform_animation(scene: AnimationScene, kind: str, values: str) -> Element:
    clock = _loop_timing(scene)
    return element("animateTransform", attributeName="transform", type=kind, values=values, **clock)


def _outline_animation(scene: AnimationScene, outlines: Sequence[Points]) -> Element:
    values = _joined([_points(x) for x in outlines])
    return element("animate", attributeName="points", values=values, **_loop_timing(scene))


def _points(points: Points) -> str:
    return " ".join(f"{_px(x)},{_px(y)}" for x, y in points)


def _loop_values(numbers: Sequence[float]) -> str:
    """Return the numbers of one loop."""
    return _joined([*map(_px, numbers)])


def _joined(values: Sequence[str]) -> str:
    """Return the values of one loop; the last is repeated for the pause."""
    return ";".join([*values, *[values[-1]] * int(PAUSE / GRAIN)])


def _fill_animation(scene: AnimationScene, flags: Sequence[bool], within: str, outside: str) -> Element:
    """Return the animation of a fill: ``within`` at instants where a flag is set, else ``outside``."""
    changes = [k for k, flag in enumerate(flags) if k == 0 or flag != flags[k - 1]]
    return element(
        "animate",
        attributeName="fill",
        calcMode="discrete",
        keyTimes=";".join(f"{float(scene.times[k] / scene.duration):.4f}" for k in changes),
        values=";".join(within if flags[k] else outside for k in changes),
        **_loop_timing(scene),
    )


def _loop_timing(scene: AnimationScene) -> dict[str, str]:
    return {"dur": f"{float(scene.duration):g}s", "repeatCount": "indefinite"}
