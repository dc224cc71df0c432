"""Draws a small moving picture of a drive for a page: SVG that the style sheet of the page colours and plays.

Changes are CSS keyframes, not SMIL. So a page can play a picture on hover or focus, and readers who prefer
reduced motion see it at rest, at the beginning of danger.
"""

import math
from collections.abc import Iterator, Sequence
from xml.etree.ElementTree import Element, tostring

from roadproof.evidence.drive_file import DriveFile
from roadproof.extensions.maps.xml_writer import element
from roadproof.extensions.pages.bent_scene import BentScene, scene_of
from roadproof.extensions.pages.drive_data import Box
from roadproof.extensions.pages.labels import PlacedLabel
from roadproof.extensions.pages.plane import Points
from roadproof.extensions.pages.scene import DASH, AnimationScene
from roadproof.extensions.pages.shapes import PolygonShape, StrokesShape
from roadproof.library.specification import Library

WIDTH, MARGIN, LANE_PIXELS, LEAST = 320.0, 16.0, 5.0, 8.0  # pixels; of a vehicle along, at least ``LEAST``
NAME = 12  # pixels of the letters of names, as in the style sheet
NEAR_ENOUGH = 0.4  # pixels between a picture and the motion that it shows
JUST = 0.001  # per cent of a round: between two places of a jump
_CLASSES = ("sv", "pov", "pov2", "pov3")


def small_scene(file: DriveFile, library: Library) -> AnimationScene:
    """Return the scene of a drive in the size of a small picture."""
    return scene_of(file, library, WIDTH, 0.0, MARGIN, LANE_PIXELS)


def miniature(scene: AnimationScene, name: str, title: str) -> str:
    """Return the SVG picture of a ``small_scene``.

    ``name``: a prefix for keyframes, unique on the page; ``title``: a description of the picture.
    """
    drawn = _BentDrawing(scene, name) if isinstance(scene, BentScene) else _SceneDrawing(scene, name)
    height = 2 * MARGIN + scene.road_height
    shapes = [drawn.road(), *drawn.envelopes(), *drawn.vehicles(), *drawn.names()]
    style = element("style", text="".join(drawn.keyframes))
    root = element(
        "svg", element("title", text=title), style, *shapes, viewBox=f"0 0 {WIDTH:g} {_px(height)}"
    )
    seconds = float(scene.duration)
    root.attrib |= {
        "class": "mini",
        "role": "img",
        "aria-label": title,
        "style": f"--d:{seconds:g}s;--s:-{float(scene.times[scene.still]):g}s",
    }
    return tostring(root, encoding="unicode")


class _SceneDrawing:
    """Draws the shapes of a scene; ``keyframes``: their changes as CSS."""

    def __init__(self, scene: AnimationScene, name: str) -> None:
        self.scene, self.name = scene, name
        self.keyframes: list[str] = []

    def road(self) -> Element:
        """Return the lanes, which move to the left as the subject drives on."""
        scene, pieces = self.scene, list[Element]()
        low, high = (scene.pixels((0.0, 0.0, x, x))[1] for x in reversed(scene.across))
        for zone, along, (right, left) in scene.road.pieces:
            x, y, width, height = scene.pixels((*along, right, left))
            pieces.append(_shape("rect", zone, x=x, y=y, width=width, height=height))
            for edge in (y, y + height):
                inner = low + 1 < edge < high - 1
                line = _shape("line", "lane" if inner else "edge", x1=x, x2=x + width, y1=edge, y2=edge)
                if inner:
                    line.set("stroke-dasharray", " ".join(_px(x * scene.scale[0]) for x in DASH))
                pieces.append(line)
        moved = [f"translate({_px(-x * scene.scale[0])}px)" for x in scene.travel]
        return self._moving(pieces, moved, [(-x * scene.scale[0],) for x in scene.travel], "road")

    def envelopes(self) -> Iterator[Element]:
        """Yield the area within RSS distances of the subject, for each other vehicle; red while that is in
        it.
        """
        for k, x in enumerate(self.scene.envelopes):
            boxes = [*map(self.scene.pixels, x.boxes)]
            moved = [f"translate({_px(a)}px,{_px(b)}px) scale({_px(c)},{_px(d)})" for a, b, c, d in boxes]
            area = _shape("rect", "envelope", width=1.0, height=1.0)
            yield self._moving([self._switched(area, x.near, f"e{k}")], moved, boxes, f"a{k}")

    def vehicles(self) -> Iterator[Element]:
        """Yield the vehicles."""
        for k, name in enumerate(self.scene.states):
            boxes = [self.scene.pixels(self.scene.box(name, i)) for i in range(len(self.scene.times))]
            _, _, width, height = boxes[0]
            wide = max(LEAST, width)
            box = _shape("rect", "car", x=width - wide, width=wide, height=height, rx=2.0)
            moved = [_translate(x, y) for x, y, _, _ in boxes]
            yield self._named(self._moving([box], moved, [x[:2] for x in boxes], f"v{k}"), k)

    def names(self) -> Iterator[Element]:
        """Yield the names of the vehicles: on no other name, and within the picture at all times."""
        labels = self.scene.labels(NAME, LEAST, inside=False)
        for k, name in enumerate(self.scene.states):
            label = _shape("text", "label", x=0.0, y=0.0)
            label.text = name
            yield self._named(self._jumping(label, labels[name], f"n{k}"), k)

    def _jumping(self, shape: Element, label: PlacedLabel, part: str) -> Element:
        """Return a shape in a group that follows a label and jumps where that jumps."""
        places, frames, last = [_written(x) for x in label.boxes], list[str](), len(label.boxes) - 1
        begins = sorted({0, *label.before})
        for begin, end in zip(begins, [*begins[1:], last], strict=True):
            way = [*places[begin:end], _written(label.before[end]) if end in label.before else places[end]]
            for k in sorted(_douglas_peucker(way, 0, len(way) - 1)):
                time = 100 * float(self.scene.times[begin + k] / self.scene.duration)
                if begin and not k:
                    time += JUST  # after the place up to the jump
                frames.append(f"{time:.6g}%{{transform:{_translate(*way[k])}}}")
        frames.append(f"to{{transform:{_translate(*places[-1])}}}")
        return self._played(element("g", shape), frames, part)

    def _named(self, vehicle: Element, k: int) -> Element:
        """Set the colour of a vehicle's group by its index; return the group."""
        vehicle.set("class", f"{vehicle.get('class')} {_CLASSES[min(k, len(_CLASSES) - 1)]}")
        return vehicle

    def _moving(
        self, shapes: Sequence[Element], moved: Sequence[str], places: Sequence[Sequence[float]], part: str
    ) -> Element:
        """Return a group of moving shapes; ``moved``: CSS transforms at each instant; ``places``: the same as
        numbers.
        """
        return self._changing(element("g", *shapes), "transform", moved, places, part)

    def _changing(
        self, shape: Element, name: str, values: Sequence[str], numbers: Sequence[Sequence[float]], part: str
    ) -> Element:
        """Return a shape whose CSS property has ``values`` at each instant; ``numbers``: the same in px."""
        instants = sorted(_douglas_peucker(numbers, 0, len(numbers) - 1))
        frames = [f"{self._percent(k)}{{{name}:{values[k]}}}" for k in instants]
        return self._played(shape, [*frames, f"to{{{name}:{values[-1]}}}"], part)

    def _switched(self, shape: Element, flags: Sequence[bool], part: str) -> Element:
        """Return a shape that is red at instants where its flag is set."""
        changes = [k for k, flag in enumerate(flags) if k and flag != flags[k - 1]]
        ends = [(k - 1, k) for k in changes]
        states = [(0, flags[0]), *((i, flags[i]) for pair in ends for i in pair), (len(flags) - 1, flags[-1])]
        frames = [f"{self._percent(k)}{{fill:var(--{'no' if x else 'faint'})}}" for k, x in states]
        last = f"to{{fill:var(--{'no' if flags[-1] else 'faint'})}}"
        return self._played(shape, [*frames, last], part)

    def _played(self, shape: Element, frames: Sequence[str], part: str) -> Element:
        self.keyframes.append(f"@keyframes {self.name}{part}{{{''.join(dict.fromkeys(frames))}}}")
        shape.set("class", f"{shape.attrib.get('class', '')} plays".strip())
        shape.set("style", f"--a:{self.name}{part}")
        return shape

    def _percent(self, k: int) -> str:
        return f"{100 * float(self.scene.times[k] / self.scene.duration):.3g}%"


class _BentDrawing(_SceneDrawing):
    """Draws a scene on a road with bends: lanes and vehicles turn, and distances follow the road."""

    scene: BentScene

    def road(self) -> Element:
        lanes, pieces = self.scene.pavement(), list[Element]()
        assert lanes.pivot is not None
        x, y = lanes.pivot
        zones = iter(self.scene.road.pieces)
        for shape in lanes.shapes:
            if isinstance(shape, PolygonShape):
                pieces.append(_path(next(zones)[0], shape.outlines, "Z"))
            elif isinstance(shape, StrokesShape):
                pieces.append(_path("lane" if len(shape.lines) > 1 else "edge", shape.lines, ""))
        moved = [
            f"translate({_px(x)}px,{_px(y)}px) rotate({a.turned:.2f}deg) "
            f"translate({_px(a.x - x)}px,{_px(a.y - y)}px)"
            for a in lanes.shifts
        ]
        reach = math.radians(WIDTH / 2)
        return self._moving(pieces, moved, [(a.x, a.y, a.turned * reach) for a in lanes.shifts], "road")

    def envelopes(self) -> Iterator[Element]:
        for k, (x, shape) in enumerate(zip(self.scene.envelopes, self.scene.areas(), strict=True)):
            assert isinstance(shape, PolygonShape)
            area = _path("envelope", [shape.outlines[self.scene.still]], "Z")
            ways = [f"path('{_path_data(outline)}Z')" for outline in shape.outlines]
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
            centres = [view.at((a + b) / 2, (c + d) / 2) for view, (a, b, c, d) in seen]
            places = self.scene.places(centres)
            moved = [_translate(x, y) for x, y in places]
            yield self._named(self._moving([box], moved, places, f"v{k}"), k)


def _translate(x: float, y: float) -> str:
    return f"translate({_px(x)}px,{_px(y)}px)"


def _written(box: Box) -> tuple[float, float]:
    """Return where a name is written whose box is given: its middle, and the line of its letters."""
    return (box[0] + box[1]) / 2, box[3] - 3.0


def _path(kind: str, lines: Sequence[Points], end: str) -> Element:
    look = {} if end else {"fill": "none"}
    made = element("path", d=" ".join(_path_data(x) + end for x in lines), **look)
    made.set("class", kind)
    return made


def _path_data(points: Points) -> str:
    return "M" + " ".join(f"{_px(x)},{_px(y)}" for x, y in points)


def _douglas_peucker(places: Sequence[Sequence[float]], first: int, last: int) -> set[int]:
    """Return the instants between which a motion is straight up to ``NEAR_ENOUGH`` px (Douglas
    and Peucker).
    """
    retained, waiting = {first, last}, [(first, last)]
    while waiting:
        begin, end = waiting.pop()
        far = [(_distance(places, begin, k, end), k) for k in range(begin + 1, end)]
        worst, k = max(far, default=(0.0, 0))
        if worst > NEAR_ENOUGH:
            retained.add(k)
            waiting += [(begin, k), (k, end)]
    return retained


def _distance(places: Sequence[Sequence[float]], begin: int, k: int, end: int) -> float:
    share = (k - begin) / (end - begin)
    ends = zip(places[begin], places[k], places[end], strict=True)
    return max(abs(b - a - share * (c - a)) for a, b, c in ends)


def _shape(tag: str, kind: str, **numbers: float) -> Element:
    made = element(tag, **{name: _px(value) for name, value in numbers.items()})
    made.set("class", kind)
    return made


def _px(value: float) -> str:
    return f"{value:.1f}".removesuffix(".0")
