"""Roads of a map as a picture in the plane: lanes coloured by zone, with where s is how much."""

import math
from collections.abc import Iterable, Sequence
from textwrap import wrap
from typing import Any

from roadproof.extensions.maps.overview import MapStretch
from roadproof.frontends.report.colours import SHADES, ZONES
from roadproof.frontends.report.figures import as_bytes, make_page
from roadproof.world.reference_line import ReferenceLine
from roadproof.world.road import Zone

_STEP = 5.0
_TICKS = 12
_LETTERS = 95
MOST_NUMBERED = 4
"""The most stretches that have numbers beside them."""
_INCHES = 9.0


def draw_stretches(title: str, stretches: Sequence[MapStretch]) -> dict[str, bytes]:
    """PNG and SVG by kind. Raises ``MissingSolverError`` where matplotlib is not installed."""
    lines = wrap(title, _LETTERS)
    figure = make_page(_INCHES, _INCHES * 0.75)
    axes = figure.add_axes((0.08, 0.12, 0.9, 0.85 - 0.03 * len(lines)))
    drawn = [x for x in stretches if x.line is not None]
    numbered = len(drawn) <= MOST_NUMBERED
    for stretch in drawn:
        _draw(axes, stretch, numbered)
    _legend(figure, dict.fromkeys(x.zone for stretch in drawn for x in stretch.lanelets), numbered)
    axes.set_aspect("equal", adjustable="datalim")
    axes.margins(0.05)
    axes.set_xlabel("x in m", fontsize=8)
    axes.set_ylabel("y in m", fontsize=8)
    axes.tick_params(labelsize=7)
    axes.set_title("\n".join(lines), fontsize=10, loc="left")
    return as_bytes(figure)


def _legend(figure: Any, zones: Iterable[Zone], numbered: bool) -> None:
    """Draw the meaning of each colour below the axes, and of the numbers beside roads."""
    x = 0.08
    for zone in zones:
        _sample(figure, x, SHADES[zone])
        figure.text(x + 0.03, 0.03, ZONES[zone], fontsize=8, va="center")
        x += 0.17
    if numbered:
        figure.text(x, 0.03, "numbers beside a road: s in m", fontsize=8, va="center")


def _sample(figure: Any, x: float, colour: str) -> None:
    """Draw a small area of a colour with an edge; ``x``: its left in shares of the figure."""
    axes = figure.add_axes((x, 0.02, 0.025, 0.022))
    axes.set_axis_off()
    axes.fill((0, 1, 1, 0), (0, 0, 1, 1), facecolor=colour, edgecolor="#8a8a8a", lw=0.5)


def _draw(axes: Any, stretch: MapStretch, numbered: bool) -> None:
    assert stretch.line is not None
    for x in stretch.lanelets:
        (low, high), (right, left) = x.s, x.d
        if low is None or high is None:
            continue
        places = _places(float(low), float(high))
        edge = [stretch.line.place(s, float(left)) for s in places]
        edge += [stretch.line.place(s, float(right)) for s in reversed(places)]
        axes.fill(*zip(*edge, strict=True), facecolor=SHADES[x.zone], edgecolor="#8a8a8a", lw=0.25)
    ends = [float(x) for lanelet in stretch.lanelets for x in lanelet.s if x is not None]
    if numbered:
        _number(axes, stretch.line, min(ends), max(ends), float(max(x.d[1] for x in stretch.lanelets)))


def _places(low: float, high: float) -> list[float]:
    count = max(math.ceil((high - low) / _STEP), 1)
    return [low + (high - low) * k / count for k in range(count + 1)]


def _number(axes: Any, line: ReferenceLine, low: float, high: float, beside: float) -> None:
    """Write s at some places beside the road."""
    step = _round_step((high - low) / _TICKS)
    for k in range(math.ceil(low / step), math.floor(high / step) + 1):
        x, y = line.place(k * step, beside + (high - low) * 0.028)
        axes.text(x, y, f"{k * step:g}", fontsize=6, ha="center", va="center", color="#444444")


def _round_step(least: float) -> float:
    """1, 2 or 5 times a power of ten that is at least that."""
    power = 10.0 ** math.floor(math.log10(max(least, 1e-3)))
    return next(x * power for x in (1, 2, 5, 10) if x * power >= least)
