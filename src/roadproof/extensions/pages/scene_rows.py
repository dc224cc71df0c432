"""The words and rows of an animation: its title, and below the road the times at which parts are true."""

from collections.abc import Iterator

from roadproof.extensions.pages.letters import fitted, width_of
from roadproof.extensions.pages.scene import EDGE, HEADING, LINE, NAMES, ROW, WIDTH, AnimationScene
from roadproof.extensions.pages.shapes import (
    LineShape,
    RectangleShape,
    Shape,
    StrokesShape,
    TextShape,
)
from roadproof.frontends.report.colours import DANGER, TRUE
from roadproof.world.length_error import length_error_of

STEPS, MOST_TICKS = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000), 12  # whole seconds between ticks
SMALL = 10
_GREY = "#555555"


def headings(scene: AnimationScene) -> Iterator[Shape]:
    """Yield the title, which is the scenario in words or the formula, a legend, and the driving direction."""
    y = EDGE + HEADING - 8
    for text in scene.title:
        yield TextShape(text, [(EDGE, y)], size=HEADING)
        y += LINE
    right = WIDTH - EDGE
    yield TextShape("driving direction", [(right - 36, y)], _GREY, 11, "end")
    yield StrokesShape(
        [[(right - 30, y - 4), (right, y - 4)], [(right - 6, y - 7), (right, y - 4), (right - 6, y - 1)]],
        _GREY,
    )
    for text in scene.notes:
        yield TextShape(text, [(EDGE, y)], _GREY)
        y += LINE
    error = length_error_of(scene.file.road)
    if error is not None:
        note = f"lengths differ by up to {float(100 * error.share):.2g} %, {float(error.metres):.2g} m"
        place = (EDGE, scene.rows_begin - 13)
        yield TextShape(fitted(note, NAMES - 45, SMALL), [place], _GREY, SMALL)


def timeline_rows(scene: AnimationScene) -> Iterator[Shape]:
    """Yield a row for each part and for danger, an axis of time, and a line at the present instant."""
    entries = [(x.depth, x.name, x.spans, TRUE) for x in scene.strips]
    for other, spans in scene.dangers.items():
        entries.append((0, f"danger between {scene.subject} and {other}", spans, DANGER))
    top = scene.rows_begin
    bottom = top + ROW * len(entries)
    begin, end = EDGE + NAMES, WIDTH - EDGE
    pixels = (end - begin) / float(scene.file.horizon)
    for row, (depth, name, spans, colour) in enumerate(entries):
        y, left = top + ROW * row, EDGE + 6 * depth
        shown = fitted(name, begin - left - 6, 11)
        yield TextShape(shown, [(left, y + 12)], "#333333", size=11)
        yield LineShape([(begin, end, y + 8, y + 8)], "#dddddd")
        for since, until in spans:
            x, width = begin + since * pixels, max(1.5, (until - since) * pixels)
            yield RectangleShape([(x, y + 3, width, 10)], colour)
    step = next((x for x in STEPS if scene.file.horizon <= MOST_TICKS * x), STEPS[-1])
    for second in range(0, int(scene.file.horizon) + 1, step):
        text = f"{second} s"
        place = (_inside(begin + second * pixels, text, SMALL), bottom + 14)
        yield TextShape(text, [place], _GREY, size=SMALL, anchor="middle")
    if scene.begins is not None:
        x, text = begin + scene.begins * pixels, "danger begins"
        yield LineShape([(x, x, top - 8, bottom)], DANGER, (4, 2))
        yield TextShape(text, [(_inside(x, text, 11), top - 11)], DANGER, size=11, anchor="middle")
    places = [begin + float(time) * pixels for time in scene.times]
    yield LineShape([(x, x, top - 4, bottom) for x in places], "#222222")


def _inside(x: float, text: str, size: int) -> float:
    """Return the middle of a text near ``x`` at which the whole text is in the picture."""
    return min(x, WIDTH - width_of(text, size) / 2 - 2)
