"""A small moving picture of a drive inside a page: SVG that the style sheet of the page colours and plays.

Changes are keyframes of CSS, not SMIL: so a page plays a picture on hover or focus, and readers who prefer
reduced motion see it at rest, at the beginning of danger.
"""

from collections.abc import Iterator, Sequence
from xml.etree.ElementTree import Element, tostring

from roadproof.evidence.drive_file import DriveFile
from roadproof.frontends.report.scene import DASH, Scene
from roadproof.library.specification import Library
from roadproof.recordings.export.xml import element

WIDTH, MARGIN, LANE_PIXELS, LEAST = 320.0, 12.0, 5.0, 8.0  # pixels; of a vehicle along, at least ``LEAST``
NEAR_ENOUGH = 0.4  # pixels between a picture and the motion that it shows
_CLASSES = ("sv", "pov", "pov2", "pov3")


def small_scene(file: DriveFile, library: Library) -> Scene:
    """A drive in the size of a small picture."""
    return Scene(file, library, WIDTH, 0.0, MARGIN, LANE_PIXELS)


def miniature(scene: Scene, name: str, told: str) -> str:
    """The picture of a ``small_scene`` as SVG. ``name`` is unique on the page, and begins the names of its
    keyframes; ``told`` describes the picture in words.
    """
    drawn = _Drawing(scene, name)
    height = 2 * MARGIN + (scene.across[1] - scene.across[0]) * scene.scale[1]
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
                    line.attrib["stroke-dasharray"] = " ".join(_n(x * scene.scale[0]) for x in DASH)
                pieces.append(line)
        moved = [f"translate({_n(-x * scene.scale[0])}px)" for x in scene.travel]
        return self._moving(pieces, moved, [(-x * scene.scale[0],) for x in scene.travel], "road")

    def envelopes(self) -> Iterator[Element]:
        """The area within RSS distances of the subject, for each other vehicle; red while that is in it."""
        for k, x in enumerate(self.scene.envelopes):
            moved = [f"translate({_n(a)}px,{_n(b)}px) scale({_n(c)},{_n(d)})" for a, b, c, d in x.boxes]
            area = _shape("rect", "envelope", width=1.0, height=1.0)
            yield self._moving([self._switched(area, x.near, f"e{k}")], moved, x.boxes, f"a{k}")

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
            group = self._moving([box, label], moved, [x[:2] for x in boxes], f"v{k}")
            group.attrib["class"] += f" {_CLASSES[min(k, len(_CLASSES) - 1)]}"
            yield group

    def _moving(
        self, shapes: Sequence[Element], moved: Sequence[str], places: Sequence[Sequence[float]], part: str
    ) -> Element:
        """Shapes that move: by ``moved`` at each instant, which are ``places`` as numbers."""
        kept = sorted(_kept(places, 0, len(places) - 1))
        frames = [f"{self._percent(k)}{{transform:{moved[k]}}}" for k in kept]
        return self._played(element("g", *shapes), [*frames, f"to{{transform:{moved[-1]}}}"], part)

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
        shape.attrib["class"] = f"{shape.attrib.get('class', '')} plays".strip()
        shape.attrib["style"] = f"--a:{self.name}{part}"
        return shape

    def _percent(self, k: int) -> str:
        return f"{100 * float(self.scene.times[k] / self.scene.lasts):.3g}%"


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
    made.attrib["class"] = kind
    return made


def _n(value: float) -> str:
    return f"{value:.1f}".removesuffix(".0")
