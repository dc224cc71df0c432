"""A small moving picture of a drive inside a page: SVG that the style sheet of the page colours and plays.

Changes are keyframes of CSS, not SMIL: so a page plays a picture on hover or focus, and readers who prefer
reduced motion see it at rest, at the beginning of danger.
"""

import math
from collections.abc import Iterator, Sequence
from xml.etree.ElementTree import Element, tostring

from roadproof.evidence.drive_file import DriveFile
from roadproof.extensions.pages.bent_scene import BentScene, scene_of
from roadproof.extensions.pages.scene import DASH, Polygon, Scene, Strokes
from roadproof.frontends.report.plane import Points
from roadproof.frontends.report.xml import element
from roadproof.library.specification import Library

WIDTH, MARGIN, LANE_PIXELS, LEAST = 320.0, 12.0, 5.0, 8.0  # pixels; of a vehicle along, at least ``LEAST``
NEAR_ENOUGH = 0.4  # pixels between a picture and the motion that it shows
_CLASSES = ("sv", "pov", "pov2", "pov3")


def small_scene(file: DriveFile, library: Library) -> Scene:
    """A drive in the size of a small picture."""
    return scene_of(file, library, WIDTH, 0.0, MARGIN, LANE_PIXELS)


def miniature(scene: Scene, name: str, told: str) -> str:
    """The picture of a ``small_scene`` as SVG. ``name`` is unique on the page, and begins the names of its
    keyframes; ``told`` describes the picture in words.
    """
    drawn = _BentDrawing(scene, name) if isinstance(scene, BentScene) else _Drawing(scene, name)
    height = 2 * MARGIN + scene.road_height
    shapes = [drawn.road(), *drawn.envelopes(), *drawn.vehicles()]
    style = element("style", text="".join(drawn.keyframes))
    root = element("svg", element("title", text=told), style, *shapes, viewBox=f"0 0 {WIDTH:g} {_n(height)}")
    seconds = float(scene.lasts)
    root.attrib |= {
        "class": "mini",
        "role": "img",
        "aria-label": told,
        "style": f"--d:{seconds:g}s;--s:-{float(scene.times[scene.still]):g}s",
    }
    return tostring(root, encoding="unicode")


class _Drawing:
    """Shapes of a scene; ``keyframes``: their changes, as CSS."""

    def __init__(self, scene: Scene, name: str) -> None:
        self.scene, self.name = scene, name
        self.keyframes: list[str] = []

    def road(self) -> Element:
        """The lanes, which move to the left as the subject goes on."""
        scene, pieces = self.scene, list[Element]()
        low, high = (scene.pixels((0.0, 0.0, x, x))[1] for x in reversed(scene.across))
        for zone, along, (right, left) in scene.road.pieces:
            x, y, width, height = scene.pixels((*along, right, left))
            pieces.append(_shape("rect", zone, x=x, y=y, width=width, height=height))
            for edge in (y, y + height):
                inner = low + 1 < edge < high - 1
                line = _shape("line", "lane" if inner else "edge", x1=x, x2=x + width, y1=edge, y2=edge)
                if inner:
                    line.set("stroke-dasharray", " ".join(_n(x * scene.scale[0]) for x in DASH))
                pieces.append(line)
        moved = [f"translate({_n(-x * scene.scale[0])}px)" for x in scene.travel]
        return self._moving(pieces, moved, [(-x * scene.scale[0],) for x in scene.travel], "road")

    def envelopes(self) -> Iterator[Element]:
        """The area within RSS distances of the subject, for each other vehicle; red while that is in it."""
        for k, x in enumerate(self.scene.envelopes):
            boxes = [*map(self.scene.pixels, x.boxes)]
            moved = [f"translate({_n(a)}px,{_n(b)}px) scale({_n(c)},{_n(d)})" for a, b, c, d in boxes]
            area = _shape("rect", "envelope", width=1.0, height=1.0)
            yield self._moving([self._switched(area, x.near, f"e{k}")], moved, boxes, f"a{k}")

    def vehicles(self) -> Iterator[Element]:
        """The boxes, each with its name above."""
        for k, name in enumerate(self.scene.states):
            boxes = [self.scene.pixels(self.scene.box(name, i)) for i in range(len(self.scene.times))]
            _, _, width, height = boxes[0]
            wide = max(LEAST, width)
            box = _shape("rect", "car", x=width - wide, width=wide, height=height, rx=2.0)
            label = _shape("text", "label", x=width - wide / 2, y=-2.0)
            label.text = name
            moved = [f"translate({_n(x)}px,{_n(y)}px)" for x, y, _, _ in boxes]
            yield self._named(self._moving([box, label], moved, [x[:2] for x in boxes], f"v{k}"), k)

    def _named(self, vehicle: Element, k: int) -> Element:
        """A group of a vehicle with the colour of its place among all."""
        vehicle.attrib["class"] += f" {_CLASSES[min(k, len(_CLASSES) - 1)]}"
        return vehicle

    def _moving(
        self, shapes: Sequence[Element], moved: Sequence[str], places: Sequence[Sequence[float]], part: str
    ) -> Element:
        """Shapes that move: by ``moved`` at each instant, which are ``places`` as numbers."""
        return self._changing(element("g", *shapes), "transform", moved, places, part)

    def _changing(
        self, shape: Element, name: str, values: Sequence[str], numbers: Sequence[Sequence[float]], part: str
    ) -> Element:
        """A shape with a property that has ``values`` at each instant, which are ``numbers`` in pixels."""
        kept = sorted(_kept(numbers, 0, len(numbers) - 1))
        frames = [f"{self._percent(k)}{{{name}:{values[k]}}}" for k in kept]
        return self._played(shape, [*frames, f"to{{{name}:{values[-1]}}}"], part)

    def _switched(self, shape: Element, flags: Sequence[bool], part: str) -> Element:
        """A shape that is red at instants where a flag is set."""
        changes = [k for k, flag in enumerate(flags) if k and flag != flags[k - 1]]
        ends = [(k - 1, k) for k in changes]
        told = [(0, flags[0]), *((i, flags[i]) for pair in ends for i in pair), (len(flags) - 1, flags[-1])]
        frames = [f"{self._percent(k)}{{fill:var(--{'no' if x else 'faint'})}}" for k, x in told]
        last = f"to{{fill:var(--{'no' if flags[-1] else 'faint'})}}"
        return self._played(shape, [*frames, last], part)

    def _played(self, shape: Element, frames: Sequence[str], part: str) -> Element:
        self.keyframes.append(f"@keyframes {self.name}{part}{{{''.join(dict.fromkeys(frames))}}}")
        shape.set("class", f"{shape.attrib.get('class', '')} plays".strip())
        shape.set("style", f"--a:{self.name}{part}")
        return shape

    def _percent(self, k: int) -> str:
        return f"{100 * float(self.scene.times[k] / self.scene.lasts):.3g}%"


class _BentDrawing(_Drawing):
    """The same on a road with bends: lanes and vehicles turn, and distances follow the road."""

    scene: BentScene

    def road(self) -> Element:
        lanes, pieces = self.scene.pavement(), list[Element]()
        assert lanes.pivot is not None
        x, y = lanes.pivot
        zones = iter(self.scene.road.pieces)
        for shape in lanes.shapes:
            if isinstance(shape, Polygon):
                pieces.append(_way(next(zones)[0], shape.outlines, "Z"))
            elif isinstance(shape, Strokes):
                pieces.append(_way("lane" if len(shape.lines) > 1 else "edge", shape.lines, ""))
        moved = [
            f"translate({_n(x)}px,{_n(y)}px) rotate({a.turned:.2f}deg) "
            f"translate({_n(a.x - x)}px,{_n(a.y - y)}px)"
            for a in lanes.shifts
        ]
        reach = math.radians(WIDTH / 2)
        return self._moving(pieces, moved, [(a.x, a.y, a.turned * reach) for a in lanes.shifts], "road")

    def envelopes(self) -> Iterator[Element]:
        for k, (x, shape) in enumerate(zip(self.scene.envelopes, self.scene.areas(), strict=True)):
            assert isinstance(shape, Polygon)
            area = _way("envelope", [shape.outlines[self.scene.still]], "Z")
            ways = [f"path('{_line(outline)}Z')" for outline in shape.outlines]
            numbers = [[value for point in outline for value in point] for outline in shape.outlines]
            area = self._changing(area, "d", ways, numbers, f"a{k}")
            yield self._switched(element("g", area), x.near, f"e{k}")

    def vehicles(self) -> Iterator[Element]:
        pixels = self.scene.scale[0]
        for k, name in enumerate(self.scene.states):
            motion = self.scene.file.drive.vehicles[name]
            wide, high = max(LEAST, float(motion.length) * pixels), float(motion.width) * pixels
            seen = [(view, self.scene.box(name, i)) for i, view in enumerate(self.scene.views)]
            turned = [-math.degrees(view.turned((box[0] + box[1]) / 2)) for view, box in seen]
            box = _shape("rect", "car", x=-wide / 2, y=-high / 2, width=wide, height=high, rx=2.0)
            turns = [f"rotate({x:.2f}deg)" for x in turned]
            box = self._changing(
                box, "transform", turns, [(math.radians(x) * wide,) for x in turned], f"t{k}"
            )
            label = _shape("text", "label", x=0.0, y=-high / 2 - 2.0)
            label.text = name
            centres = [view.at((a + b) / 2, (c + d) / 2) for view, (a, b, c, d) in seen]
            places = self.scene.places(centres)
            moved = [f"translate({_n(x)}px,{_n(y)}px)" for x, y in places]
            yield self._named(self._moving([box, label], moved, places, f"v{k}"), k)


def _way(kind: str, lines: Sequence[Points], end: str) -> Element:
    look = {} if end else {"fill": "none"}
    made = element("path", d=" ".join(_line(x) + end for x in lines), **look)
    made.set("class", kind)
    return made


def _line(points: Points) -> str:
    return "M" + " ".join(f"{_n(x)},{_n(y)}" for x, y in points)


def _kept(places: Sequence[Sequence[float]], first: int, last: int) -> set[int]:
    """The instants that suffice to draw a motion, straight between them (Douglas and Peucker)."""
    found, waiting = {first, last}, [(first, last)]
    while waiting:
        begin, end = waiting.pop()
        far = [(_distance(places, begin, k, end), k) for k in range(begin + 1, end)]
        worst, k = max(far, default=(0.0, 0))
        if worst > NEAR_ENOUGH:
            found.add(k)
            waiting += [(begin, k), (k, end)]
    return found


def _distance(places: Sequence[Sequence[float]], begin: int, k: int, end: int) -> float:
    share = (k - begin) / (end - begin)
    ends = zip(places[begin], places[k], places[end], strict=True)
    return max(abs(b - a - share * (c - a)) for a, b, c in ends)


def _shape(tag: str, kind: str, **numbers: float) -> Element:
    made = element(tag, **{name: _n(value) for name, value in numbers.items()})
    made.set("class", kind)
    return made


def _n(value: float) -> str:
    return f"{value:.1f}".removesuffix(".0")
