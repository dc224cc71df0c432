"""Plates as pictures: areas, boundaries and judged drives of models, with a legend, all within the sheet."""

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from itertools import product
from math import ceil
from textwrap import wrap
from typing import Any, NamedTuple

from roadproof.extensions.drivers.models import driver_model
from roadproof.extensions.drivers.preventable import areas
from roadproof.extensions.drivers.preventable.own_tests import PlacedTest
from roadproof.extensions.drivers.preventable.question import PreventableQuestion
from roadproof.extensions.drivers.preventable.report import measured, shown_symbols
from roadproof.extensions.drivers.preventable.view import PlateResult
from roadproof.extensions.drivers.words import legend
from roadproof.frontends.report.figures import make_page
from roadproof.world.units import UNITS

_STEPPED = "Single lines: places looked at, stepped at 10 Hz; nothing is claimed between them"
_LEFT, _WIDE, _HIGH = 0.75, 2.0, 1.6
"""Inches left of a plate, and of the plate itself."""
_COLUMN, _BELOW, _NAME, _LINE = 2.95, 0.62, 0.14, 0.17
"""Inches from plate to plate, below a plate, of a line of its name, and of a line of words."""
_TITLE, _WORDS, _SMALL, _NAMED = 12.5, 14, 17, 16
"""Letters an inch: of the title, of the legend, of lines below the plates, and of names of plates."""
_GREY, _EDGE = "#555555", 0.2


class _Cell(NamedTuple):
    """The plates of one choice of fixed values, and the tests that are nearest to it."""

    name: Sequence[str]
    plates: Sequence[PlateResult]
    tests: Sequence[PlacedTest]


class _Key(NamedTuple):
    """An entry of the legend: words beside a sample, which ``draw`` puts into axes of a unit height."""

    words: str
    sample: Mapping[str, Any]
    is_area: bool = False


def draw_sheet(question: PreventableQuestion, plates: Sequence[PlateResult]) -> Any:
    """All plates of a sheet: rows are the second of what is fixed, columns all else; colours are models."""
    cells, columns = _cells(question, plates)
    width = _LEFT + _COLUMN * columns
    names = max(len(x.name) for x in cells)
    row = names * _NAME + _HIGH + _BELOW
    title = wrap(_title(question), int((width - 2 * _EDGE) * _TITLE))
    keys = [*_keys(question, plates)]
    beside = max(1, int((width - _EDGE) / _key_width(keys)))
    head = 0.15 + _LINE * (len(title) + ceil(len(keys) / beside)) + 0.1
    below = _below(question, plates, width)
    height = head + row * ceil(len(cells) / columns) + _LINE * len(below) + 0.1
    figure = make_page(width, height)
    for k, cell in enumerate(cells):
        i, j = divmod(k, columns)
        top = head + row * i + names * _NAME
        box = (_LEFT + _COLUMN * j, height - top - _HIGH, _WIDE, _HIGH)
        axes = figure.add_axes([box[0] / width, box[1] / height, box[2] / width, box[3] / height])
        _draw_plate(axes, question, cell.plates)
        _draw_tests(axes, question, cell.tests)
        axes.set_title("\n".join(cell.name), fontsize=7, loc="left", pad=3)
        axes.set_ylabel(_label(question, question.manoeuvre.across), fontsize=7)
        axes.set_xlabel(_label(question, question.manoeuvre.line), fontsize=7)
    for k, text in enumerate(title):
        figure.text(_EDGE / width, 1 - (0.2 + _LINE * k) / height, text, fontsize=9, va="center")
    _draw_keys(figure, keys, beside, (width, height), 0.2 + _LINE * len(title))
    for k, text in enumerate(reversed(below)):
        figure.text(_EDGE / width, (0.12 + _LINE * k) / height, text, fontsize=6.5, va="center")
    return figure


def _cells(question: PreventableQuestion, plates: Sequence[PlateResult]) -> tuple[list[_Cell], int]:
    """Return the cells of the sheet, row by row, and how many are beside each other."""
    names = list(question.sheet)
    beside = [name for name in names if name not in names[1:2]]
    columns = list(product(*(question.sheet[name] for name in beside)))
    rows = list(product(*(question.sheet[name] for name in names[1:2])))
    cells = []
    for row, column in product(rows, columns):
        chosen = dict(zip((*beside, *names[1:2]), (*column, *row), strict=True))
        here = [p for p in plates if all(p.fixed.get(name) == value for name, value in chosen.items())]
        which = question.choices.index(chosen)
        tests = [x for x in question.placed_tests if x.plate == which]
        cells.append(_Cell(wrap(_values_text(question, chosen), int(_COLUMN * _NAMED)), here, tests))
    return cells, len(columns)


def _values_text(question: PreventableQuestion, values: Mapping[str, Fraction]) -> str:
    known = question.manoeuvre.quantities
    return ", ".join(f"{name} {measured(known[name], value)}" for name, value in values.items())


def _title(question: PreventableQuestion) -> str:
    fixed = _values_text(question, question.fixed)
    name = f"{question.manoeuvre.name}, {fixed}" if fixed else question.manoeuvre.name
    return f"{name}: where a collision is unpreventable"


def _below(question: PreventableQuestion, plates: Sequence[PlateResult], width: float) -> list[str]:
    """Lines below the plates: readings, symbols, and what single lines are."""
    words = [f"With {', '.join(question.readings)}"] if question.readings else []
    words.append(legend(shown_symbols(question)))
    words += [_STEPPED] if any(x.stepped for x in plates) else []
    return [line for text in words for line in wrap(text, int((width - 2 * _EDGE) * _SMALL))]


# --- the legend -----------------------------------------------------------------------------------


def _keys(question: PreventableQuestion, plates: Sequence[PlateResult]) -> Iterator[_Key]:
    """Yield the legend: each colour and each mark has words."""
    scale = _scale_of(question)
    passing = [line for x in plates if _tells_passed(question, x) for line in x.lines]
    for model in question.models:
        words = f"{model.title}, at single places" if model.is_stepped else model.title
        yield _Key(words, {"color": model.colour[0], "lw": 0.8 if model.is_stepped else 1.4})
    if not all(x.is_stepped for x in question.models):
        yield _Key("shaded: unpreventable", {"color": _GREY, "alpha": 0.25, "lw": 0}, is_area=True)
        yield _Key("white: preventable", {"fc": "white", "ec": _GREY, "lw": 0.5}, is_area=True)
    if any(x.spans and x.spans[0][0].near > scale.range[0] for x in passing):
        yield _Key("dotted: SV has passed POV", {**_DOTTED, "lw": 0.5}, is_area=True)
    mark = {"marker": "o", "ms": 3, "color": _GREY, "lw": 0}
    sides = {x.side for plate in plates for x in plate.shown if x.drive is not None}
    if "unpreventable" in sides:
        yield _Key("judged drive that collides", mark)
    if "preventable" in sides:
        yield _Key("judged drive that does not", {**mark, "markerfacecolor": "white"})
    if any(x.has_values for x in question.placed_tests):
        yield _Key("your test", _TEST)
    if any(not x.has_values for x in question.placed_tests):
        yield _Key("your test, other values", _OTHER)


_TEST: Mapping[str, Any] = {"marker": "D", "ms": 3, "color": "black", "mew": 0.7, "lw": 0}
_OTHER: Mapping[str, Any] = {**_TEST, "markerfacecolor": "white"}
_DOTTED: Mapping[str, Any] = {"fc": "none", "ec": "#999999", "hatch": "...."}


def _key_width(keys: Sequence[_Key]) -> float:
    """Return the inches of the longest entry of the legend."""
    return 0.5 + max(len(x.words) for x in keys) / _WORDS


def _draw_keys(figure: Any, keys: Sequence[_Key], beside: int, size: tuple[float, float], top: float) -> None:
    """Draw the legend in rows of ``beside`` entries, ``top`` inches below the upper edge."""
    width, height = size
    for k, key in enumerate(keys):
        row, column = divmod(k, beside)
        x, y = _EDGE + _key_width(keys) * column, top + _LINE * row
        axes = figure.add_axes([x / width, 1 - (y + 0.06) / height, 0.24 / width, 0.12 / height])
        axes.set_axis_off()
        axes.set_xlim(-0.1, 2.1)
        axes.set_ylim(-0.1, 1.1)
        if key.is_area:
            axes.fill((0, 2, 2, 0), (0, 0, 1, 1), **key.sample)
        else:
            is_mark = "marker" in key.sample
            axes.plot((1,) if is_mark else (0, 2), (0.5,) if is_mark else (0.5, 0.5), **key.sample)
        figure.text((x + 0.3) / width, 1 - y / height, key.words, fontsize=7, va="center")


# --- a plate --------------------------------------------------------------------------------------


def _label(question: PreventableQuestion, name: str) -> str:
    return f"{name} [{question.manoeuvre.quantities[name].unit}]"


def _tells_passed(question: PreventableQuestion, plate: PlateResult) -> bool:
    home = question.basis.specification
    return areas.tells_passed(question.manoeuvre.name, bool(plate.stepped), home.options)


class _Scale(NamedTuple):
    """The units of a plate: SI values of one unit along and across, and the range along (SI)."""

    along: float
    across: float
    range: areas.Range

    def shown(self, points: areas.Outline) -> tuple[list[float], list[float]]:
        """Return points in the units of the axes, as x and y."""
        return [x / self.along for x, _ in points], [y / self.across for _, y in points]


def _scale_of(question: PreventableQuestion) -> _Scale:
    known, kind = question.manoeuvre.quantities, question.manoeuvre
    along, across = (float(UNITS[known[name].unit][0]) for name in (kind.line, kind.across))
    low, high = map(float, question.along)
    return _Scale(along, across, (low, high))


def _draw_plate(axes: Any, question: PreventableQuestion, plates: Sequence[PlateResult]) -> None:
    scale, kind = _scale_of(question), question.manoeuvre
    rows = [float(line.at) / scale.across for plate in plates for line in plate.lines]
    axes.set_xlim(*(x / scale.along for x in scale.range))
    axes.set_ylim(min(rows, default=0), max(rows, default=1))
    axes.tick_params(labelsize=6)
    _draw_passed(axes, question, plates, scale)
    for plate in plates:
        colour = driver_model(plate.model).colour[0]
        if plate.stepped:
            _draw_places(axes, plate, colour, scale)
        else:
            _draw_areas(axes, plate, colour, scale)
        for x in plate.shown:
            if x.drive is not None:
                place, row = (float(x.values[name]) for name in (kind.line, kind.across))
                filled = colour if x.side == "unpreventable" else "white"
                spot = (place / scale.along, row / scale.across)
                axes.plot(*spot, "o", ms=3, color=colour, markerfacecolor=filled, zorder=4, clip_on=False)
    _draw_notes(axes, plates, scale)


def _draw_passed(
    axes: Any, question: PreventableQuestion, plates: Sequence[PlateResult], scale: _Scale
) -> None:
    """Draw where SV has passed in all models, which brake at different times."""
    known = [x.lines for x in plates if x.lines and _tells_passed(question, x)]
    for outline in areas.passed_areas(known, scale.range):
        if len(outline) > 2:
            axes.fill(*scale.shown(outline), lw=0, zorder=0, **_DOTTED)


def _draw_places(axes: Any, plate: PlateResult, colour: str, scale: _Scale) -> None:
    """Draw each span of each line by itself: no claim is made between lines and places."""
    for line in plate.lines:
        for a, b in line.spans:
            ends = scale.shown([(a.near, float(line.at)), (b.near, float(line.at))])
            axes.plot(*ends, "|-", color=colour, linewidth=0.6, markersize=1.5, alpha=0.8)


def _draw_areas(axes: Any, plate: PlateResult, colour: str, scale: _Scale) -> None:
    """Draw areas between lines, single spans as lines, and the boundaries."""
    for outline in areas.unpreventable_areas(plate.lines):
        if len(outline) > 2:
            axes.fill(*scale.shown(outline), color=colour, alpha=0.14, lw=0)
        else:
            axes.plot(*scale.shown(outline), color=colour, alpha=0.3, lw=0.8)
    for points in areas.boundaries(plate.lines, scale.range):
        axes.plot(*scale.shown(points), color=colour, lw=1.1)


def _draw_tests(axes: Any, question: PreventableQuestion, tests: Sequence[PlacedTest]) -> None:
    """Draw tests of the reader; hollow ones have other fixed values than the plate."""
    scale, kind = _scale_of(question), question.manoeuvre
    others, own = ([x for x in tests if x.has_values is there] for there in (False, True))
    for look, those in ((_OTHER, others), (_TEST, own)):
        if those:
            points = [(float(x.test.values[kind.line]), float(x.test.values[kind.across])) for x in those]
            axes.plot(*scale.shown(points), zorder=5, clip_on=False, **look)


def _draw_notes(axes: Any, plates: Sequence[PlateResult], scale: _Scale) -> None:
    """Write on a plate which models have the same answer on all of it: no line is left to show it."""
    notes = []
    for plate in plates:
        where = "at all places looked at" if plate.stepped else "on all lines"
        if side := areas.side_of_all(plate.lines, scale.range):
            notes += [driver_model(plate.model).title + ":", f"{side} {where}"]
        elif not plate.lines:
            notes += [driver_model(plate.model).title + ":", "not decided"]
    if notes:
        axes.text(
            0.5, 0.5, "\n".join(notes), fontsize=6.5, ha="center", va="center", transform=axes.transAxes
        )
