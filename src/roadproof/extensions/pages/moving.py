"""Draws a drive as one animated SVG file, which a browser plays without scripts."""

from collections.abc import Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import assert_never

from roadproof.evidence.drive_file import DriveFile
from roadproof.extensions.maps.xml_writer import Element, element
from roadproof.extensions.pages.bent_scene import scene_of
from roadproof.extensions.pages.drive_data import GRAIN
from roadproof.extensions.pages.plane import Points
from roadproof.extensions.pages.scene import PAUSE, WIDTH, AnimationScene, Pavement
from roadproof.extensions.pages.scene_rows import headings, timeline_rows
from roadproof.extensions.pages.shapes import (
    BOX,
    ENDS,
    LineShape,
    PolygonShape,
    RectangleShape,
    Shape,
    StrokesShape,
    TextShape,
    attributes,
    element_at,
    points_text,
    px,
    svg_of,
)
from roadproof.frontends.report.colours import DANGER
from roadproof.library.specification import Library

NO_JUMPS: Mapping[int, Sequence[float]] = MappingProxyType({})


def draw_moving(file: DriveFile, library: Library) -> bytes:
    """Return the animated SVG of a drive; its heading is the scenario in words, or the formula."""
    scene = scene_of(file, library)
    shapes = (*scene.vehicles(), *timeline_rows(scene))
    drawn = [
        *(_element_of(scene, x) for x in headings(scene)),
        *_road(scene, scene.pavement()),
        *(_element_of(scene, x) for x in shapes),
    ]
    return svg_of(drawn, WIDTH, scene.height)


def _road(scene: AnimationScene, lanes: Pavement) -> Iterator[Element]:
    """Yield the lanes and RSS areas, both clipped to the window."""
    cut = element("rect", **attributes(BOX, lanes.window))
    yield element("clipPath", cut, id="window")
    drawn = [_element_of(scene, x) for x in lanes.shapes]
    here, still = [x.x for x in lanes.shifts], lanes.shifts[scene.still]
    if lanes.pivot is None:
        moving = _transform_animation(scene, "translate", _loop_values(here))
        moved = element("g", *drawn, moving, transform=f"translate({px(still.x)} 0)")
    else:
        places = _joined([f"{px(x.x)} {px(x.y)}" for x in lanes.shifts])
        pivot = " ".join(map(px, lanes.pivot))
        turns = _joined([f"{x.turned:.2f} {pivot}" for x in lanes.shifts])
        moving = _transform_animation(scene, "translate", places)
        inner = element("g", *drawn, moving, transform=f"translate({px(still.x)} {px(still.y)})")
        turning = _transform_animation(scene, "rotate", turns)
        moved = element("g", inner, turning, transform=f"rotate({still.turned:.2f} {pivot})")
    yield element(
        "g", moved, *(_element_of(scene, x) for x in scene.areas()), **{"clip-path": "url(#window)"}
    )


def _element_of(scene: AnimationScene, shape: Shape) -> Element:
    """Return the element of a shape at the instant of a still picture, with its animations."""
    made = element_at(shape, scene.still)
    made.extend(_animations(scene, shape))
    return made


# --- changes ------------------------------------------------------------------------------------


def _animations(scene: AnimationScene, shape: Shape) -> Iterator[Element]:
    """Yield an animation for each attribute of a shape that changes, and for its fill."""
    match shape:
        case RectangleShape():
            yield from _attribute_animations(scene, BOX, shape.boxes)
        case PolygonShape():
            if len(shape.outlines) > 1:
                yield _outline_animation(scene, shape.outlines)
        case LineShape():
            yield from _attribute_animations(scene, ENDS, shape.ends)
        case TextShape():
            yield from _attribute_animations(scene, ("x", "y"), shape.places, shape.before)
        case StrokesShape():
            pass
        case _:
            assert_never(shape)
    if isinstance(shape, RectangleShape | PolygonShape) and shape.red:
        yield _fill_animation(scene, shape.red, DANGER, shape.fill)


def _attribute_animations(
    scene: AnimationScene,
    names: Sequence[str],
    values: Sequence[Sequence[float]],
    before: Mapping[int, Sequence[float]] = NO_JUMPS,
) -> Iterator[Element]:
    """Yield an animation for each attribute that changes.

    ``values``: of all attributes at each instant; ``before``: their values up to an instant of a jump.
    """
    for which, name in enumerate(names):
        numbers = [x[which] for x in values]
        jumps = {k: px(x[which]) for k, x in before.items()}
        if len({*map(px, numbers), *jumps.values()}) > 1:
            loop, timing = _loop([*map(px, numbers)], jumps), _loop_timing(scene)
            yield element("animate", attributeName=name, **loop, **timing)


def _transform_animation(scene: AnimationScene, kind: str, values: str) -> Element:
    clock = _loop_timing(scene)
    return element("animateTransform", attributeName="transform", type=kind, values=values, **clock)


def _outline_animation(scene: AnimationScene, outlines: Sequence[Points]) -> Element:
    values = _joined([points_text(x) for x in outlines])
    return element("animate", attributeName="points", values=values, **_loop_timing(scene))


def _loop(values: Sequence[str], before: Mapping[int, str]) -> dict[str, str]:
    """Return the values of one loop; those up to a jump, and those from it, have the same time."""
    if not before:
        return {"values": _joined(values)}
    paused = [*enumerate(values), *((len(values) + k, values[-1]) for k in range(int(PAUSE / GRAIN)))]
    timed = [y for k, x in paused for y in ([(k, before[k])] if k in before else []) + [(k, x)]]
    last = paused[-1][0]
    times = ";".join(f"{k / last:.5f}".rstrip("0").rstrip(".") for k, _ in timed)
    return {"values": ";".join(x for _, x in timed), "keyTimes": times}


def _loop_values(numbers: Sequence[float]) -> str:
    """Return the numbers of one loop."""
    return _joined([*map(px, numbers)])


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
