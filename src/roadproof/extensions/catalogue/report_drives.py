"""Small pictures of all tests of a catalogue: each vehicle along and across the road over time."""

from collections.abc import Iterator, Mapping, Sequence
from textwrap import wrap
from typing import Any

from roadproof.extensions.catalogue.curves import DriveCurves
from roadproof.frontends.report.colours import COLOURS, DANGER
from roadproof.frontends.report.figures import make_page
from roadproof.runtime.records import dataclass

MOST_ON_A_PAGE = 40
_COLUMNS, _FEW = 5, 3
_CELL = (2.05, 1.75)  # inches, title and labels included
_HEADING = 0.32
_LETTERS = 56
"""Letters of a line of a reason below a picture."""
_ON_WHITE = {"facecolor": "white", "edgecolor": "none", "pad": 0.5}
_MARGIN = (0.35, 0.55)  # left of all cells, above them


@dataclass(frozen=True)
class DrivePicture:
    """A test to be drawn: its ``title``, the title of its ``group``, and its curves.

    ``wrong``: why it is not what it claims, else empty; ``fails``: when the nearest scenario fails (s).
    """

    title: str
    group: str
    curves: DriveCurves
    wrong: str = ""
    fails: float | None = None


def draw_tests(tests: Sequence[DrivePicture]) -> Iterator[Any]:
    """Yield pages of small pictures, groups in the order of their first test."""
    for k in range(0, len(tests), MOST_ON_A_PAGE):
        yield _page(tests[k : k + MOST_ON_A_PAGE])


def _page(tests: Sequence[DrivePicture]) -> Any:
    groups: dict[str, list[DrivePicture]] = {}
    for test in tests:
        groups.setdefault(test.group, []).append(test)
    columns = _COLUMNS if len(tests) > 2 * _FEW else _FEW
    rows = sum(-(-len(those) // columns) for those in groups.values())
    height = rows * _CELL[1] + len(groups) * _HEADING + _MARGIN[1]
    width = columns * _CELL[0] + _MARGIN[0]
    figure = make_page(width, height)
    names = dict.fromkeys(name for test in tests for name in test.curves.vehicles)
    colours = {name: COLOURS[k % len(COLOURS)] for k, name in enumerate(names)}
    _legend(figure, colours, height)
    top = height - _MARGIN[1]
    for group, those in groups.items():
        figure.text(0.1 / width, (top - 0.2) / height, group, fontsize=8, weight="bold", va="bottom")
        top -= _HEADING
        for k, test in enumerate(those):
            left, upper = _MARGIN[0] + k % columns * _CELL[0], top - k // columns * _CELL[1]
            _draw(figure, test, colours, (left, upper), (width, height))
        top -= -(-len(those) // columns) * _CELL[1]
    return figure


def _legend(figure: Any, colours: Mapping[str, str], height: float) -> None:
    """Draw the legend, with the colour of each vehicle."""
    text = "above: m ahead of the first vehicle, below: m across the road, both over seconds"
    figure.text(
        0.01,
        1 - 0.22 / height,
        f"Tests by scenario; {text}; red: not what it claims",
        fontsize=8,
        va="center",
    )
    for k, (name, colour) in enumerate(colours.items()):
        place = 0.01 + 0.09 * k
        figure.text(place, 1 - 0.42 / height, f"■ {name}", fontsize=8, va="center", color=colour)


def _draw(
    figure: Any,
    test: DrivePicture,
    colours: Mapping[str, str],
    corner: tuple[float, float],
    page: tuple[float, float],
) -> None:
    left, upper = corner
    width, height = _CELL[0] - 0.42, (_CELL[1] - 0.55) / 2

    def place(bottom: float) -> Any:
        return figure.add_axes((left / page[0], bottom / page[1], width / page[0], height / page[1]))

    above, below = place(upper - 0.2 - height), place(upper - 0.26 - 2 * height)
    colour = DANGER if test.wrong else "black"
    shorten(above.set_title(test.title, fontsize=6.5, pad=2, loc="left", color=colour), _CELL[0] - 0.1)
    if test.wrong:
        at = (left / page[0], (upper - 0.26 - 2 * height - 0.17) / page[1])
        lines = wrap(test.wrong, _LETTERS, max_lines=2, placeholder=" …")
        figure.text(*at, "\n".join(lines), fontsize=5, color=DANGER, va="top")
    curves = test.curves
    first = next(iter(curves.vehicles.values()))
    for name, curve in curves.vehicles.items():
        ahead = [x - y for x, y in zip(curve.along, first.along, strict=True)]
        above.plot(curves.times, ahead, color=colours[name], lw=1)
        below.fill_between(curves.times, curve.right, curve.left, color=colours[name], alpha=0.45, lw=0)
    if test.fails is not None:
        _draw_failure(above, below, test.fails)
    for marking in curves.markings:
        below.axhline(marking, color="#888888", lw=0.5)
    for axes in (above, below):
        axes.tick_params(labelsize=5, length=2, pad=1)
        axes.set_xlim(curves.times[0], curves.times[-1])
        axes.grid(color="#eeeeee", lw=0.4)
        axes.set_axisbelow(True)
    above.tick_params(labelbottom=False)


def _draw_failure(above: Any, below: Any, at: float) -> None:
    """Draw a line at the instant at which the nearest scenario fails, with its words."""
    for axes in (above, below):
        axes.axvline(at, color=DANGER, lw=0.8, ls=(0, (4, 2)))
    low, high = above.get_xlim()
    side = "right" if at > (low + high) / 2 else "left"
    place = (at + (-0.02 if side == "right" else 0.02) * (high - low), 0.5)
    look = {"fontsize": 5.5, "color": DANGER, "ha": side, "va": "center", "bbox": _ON_WHITE}
    above.text(*place, f"fails at {at:.3g} s", transform=above.get_xaxis_transform(), **look)


def shorten(text: Any, width: float) -> None:
    """Leave out the middle of a drawn text until it is no wider than that (inches)."""
    whole, limit = text.get_text(), width * text.figure.dpi
    share = limit / max(limit, text.get_window_extent().width)
    for length in range(int(len(whole) * share), 1, -1):
        if text.get_window_extent().width <= limit:
            return
        text.set_text(f"{whole[: length - length // 2]}…{whole[len(whole) - length // 2 :]}")
