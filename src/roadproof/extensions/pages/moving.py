"""A moving picture of a drive as one SVG file, which a browser plays without scripts."""

from collections.abc import Iterator, Mapping, Sequence
from xml.etree.ElementTree import Element

from roadproof.evidence.drive_file import DriveFile
from roadproof.extensions.pages.bent_scene import scene_of
from roadproof.extensions.pages.scene import (
    PAUSE,
    WIDTH,
    Line,
    Pavement,
    Polygon,
    Rectangle,
    Scene,
    Shape,
    Strokes,
    headings,
    rows,
)
from roadproof.frontends.report.drive import DANGER
from roadproof.frontends.report.drive_data import GRAIN
from roadproof.frontends.report.plane import Points
from roadproof.frontends.report.xml import document, element
from roadproof.library.specification import Library

_BOX, _ENDS = ("x", "y", "width", "height"), ("x1", "x2", "y1", "y2")


def draw_moving(file: DriveFile, library: Library) -> bytes:
    """The moving picture of a drive as SVG; the title is its scenario in words, or its formula."""
    scene = scene_of(file, library)
    root = element(
        "svg",
        element("rect", width="100%", height="100%", fill="white"),
        *(_drawn(scene, x) for x in headings(scene)),
        *_road(scene, scene.pavement()),
        *(_drawn(scene, x) for x in (*scene.vehicles(), *rows(scene))),
        xmlns="http://www.w3.org/2000/svg",
        viewBox=f"0 0 {WIDTH:g} {scene.height:g}",
        width=f"{WIDTH:g}",
        height=f"{scene.height:g}",
        **{"font-family": "Helvetica, Arial, sans-serif"},
    )
    return document(root)


def _road(scene: Scene, lanes: Pavement) -> Iterator[Element]:
    """The lanes and RSS distances; both end at the window."""
    cut = element("rect", **_named(_BOX, lanes.window))
    yield element("clipPath", cut, id="window")
    drawn = [_drawn(scene, x) for x in lanes.shapes]
    here, still = [x.x for x in lanes.shifts], lanes.shifts[scene.still]
    if lanes.pivot is None:
        moving = _moved(scene, "translate", _played(here))
        moved = element("g", *drawn, moving, transform=f"translate({_n(still.x)} 0)")
    else:
        places = _joined([f"{_n(x.x)} {_n(x.y)}" for x in lanes.shifts])
        pivot = " ".join(map(_n, lanes.pivot))
        turns = _joined([f"{x.turned:.2f} {pivot}" for x in lanes.shifts])
        moving = _moved(scene, "translate", places)
        inner = element("g", *drawn, moving, transform=f"translate({_n(still.x)} {_n(still.y)})")
        turning = _moved(scene, "rotate", turns)
        moved = element("g", inner, turning, transform=f"rotate({still.turned:.2f} {pivot})")
    yield element("g", moved, *(_drawn(scene, x) for x in scene.areas()), **{"clip-path": "url(#window)"})


def _drawn(scene: Scene, shape: Shape) -> Element:
    """A shape as it is at the instant of a still picture, with its changes."""
    if isinstance(shape, Rectangle):
        still, changes = _at_instants(scene, _BOX, shape.boxes)
        opacity = {} if shape.opacity == 1 else {"fill-opacity": f"{shape.opacity:g}"}
        made = element("rect", **still, fill=shape.fill, **opacity)
        if shape.red:
            changes.append(_switched(scene, shape.red, DANGER, shape.fill))
    elif isinstance(shape, Polygon):
        opacity = {} if shape.opacity == 1 else {"fill-opacity": f"{shape.opacity:g}"}
        here = shape.outlines[scene.still if len(shape.outlines) > 1 else 0]
        seam = {} if opacity else {"stroke": shape.fill, "stroke-width": "0.6"}
        made = element("polygon", points=_points(here), fill=shape.fill, **opacity, **seam)
        changes = [_reshaped(scene, shape.outlines)] if len(shape.outlines) > 1 else []
        if shape.red:
            changes.append(_switched(scene, shape.red, DANGER, shape.fill))
    elif isinstance(shape, Strokes):
        way = " ".join(f"M{_points(x)}" for x in shape.lines)
        made, changes = element("path", d=way, fill="none", stroke=shape.stroke), []
    elif isinstance(shape, Line):
        still, changes = _at_instants(scene, _ENDS, shape.ends)
        dash = {} if shape.dash is None else {"stroke-dasharray": " ".join(map(_n, shape.dash))}
        made = element("line", **still, stroke=shape.stroke, **dash)
    else:
        still, changes = _at_instants(scene, ("x", "y"), shape.places)
        anchor = {"text-anchor": "middle"} if shape.middle else {}
        look = {"fill": shape.fill, "font-size": str(shape.size)}
        made = element("text", text=shape.text, **still, **look, **anchor)
    made.extend(changes)
    return made


# --- changes ------------------------------------------------------------------------------------


def _n(value: float) -> str:
    return f"{value:.1f}".removesuffix(".0")


def _named(names: Sequence[str], values: Sequence[float]) -> dict[str, str]:
    return dict(zip(names, map(_n, values), strict=True))


def _at_instants(
    scene: Scene, names: Sequence[str], values: Sequence[Sequence[float]]
) -> tuple[dict[str, str], list[Element]]:
    """Attributes at the instant of a still picture, and the changes of those that change."""
    still = values[scene.still if len(values) > 1 else 0]
    each = dict(zip(names, zip(*values, strict=True), strict=True))
    return _named(names, still), [*_animated(scene, each)]


def _animated(scene: Scene, values: Mapping[str, Sequence[float]]) -> Iterator[Element]:
    """The changes of attributes that change, as the instants have them."""
    for name, numbers in values.items():
        if len({_n(x) for x in numbers}) > 1:
            yield element("animate", attributeName=name, values=_played(numbers), **_clock(scene))


def _moved(scene: Scene, kind: str, values: str) -> Element:
    clock = _clock(scene)
    return element("animateTransform", attributeName="transform", type=kind, values=values, **clock)


def _reshaped(scene: Scene, outlines: Sequence[Points]) -> Element:
    values = _joined([_points(x) for x in outlines])
    return element("animate", attributeName="points", values=values, **_clock(scene))


def _points(points: Points) -> str:
    return " ".join(f"{_n(x)},{_n(y)}" for x, y in points)


def _played(numbers: Sequence[float]) -> str:
    """The values of a round."""
    return _joined([*map(_n, numbers)])


def _joined(values: Sequence[str]) -> str:
    """The values of a round: the last stands for the pause."""
    return ";".join([*values, *[values[-1]] * int(PAUSE / GRAIN)])


def _switched(scene: Scene, flags: Sequence[bool], within: str, outside: str) -> Element:
    """The fill of a shape: one colour at instants where a flag is set, another elsewhere."""
    changes = [k for k, flag in enumerate(flags) if k == 0 or flag != flags[k - 1]]
    return element(
        "animate",
        attributeName="fill",
        calcMode="discrete",
        keyTimes=";".join(f"{float(scene.times[k] / scene.lasts):.4f}" for k in changes),
        values=";".join(within if flags[k] else outside for k in changes),
        **_clock(scene),
    )


def _clock(scene: Scene) -> dict[str, str]:
    return {"dur": f"{float(scene.lasts):g}s", "repeatCount": "indefinite"}
