"""Plates to look at: which initial values a driver prevents a collision from, in every form."""

from collections.abc import Sequence
from fractions import Fraction
from functools import partial
from itertools import product
from math import ceil
from textwrap import wrap
from typing import Any, TypeAlias

from roadproof.extensions.drivers.lines import PlateLine, SpanEnd
from roadproof.extensions.drivers.manoeuvres import InitialQuantity
from roadproof.extensions.drivers.models import driver_model, parts_of
from roadproof.extensions.drivers.preventable.question import PreventableQuestion
from roadproof.extensions.drivers.preventable.view import LemmaResult, PlateResult, Shown
from roadproof.extensions.drivers.words import legend
from roadproof.frontends.report.figures import make_page
from roadproof.frontends.report.sheet import Column, Sheet
from roadproof.world.units import UNITS

_STEPPED = "Single lines: places looked at, stepped at 10 Hz; nothing is claimed between them"
_LEGEND = 1.9, 0.2  # inches for the name of a model
_LETTERS = 21  # of a line below the plates, an inch
_TOLD = 5  # lines of a plate, and spans of a line, that the terminal shows


def measured(quantity: InitialQuantity, value: Fraction) -> str:
    """A value in its quantity's unit: ``60 km/h``."""
    return f"{float(value / UNITS[quantity.unit][0]):g} {quantity.unit}"


def fixed_text(question: PreventableQuestion, plate: PlateResult) -> str:
    """Return the initial values that are fixed on a plate, as text."""
    known = question.manoeuvre.quantities
    return ", ".join(f"{name} = {measured(known[name], value)}" for name, value in plate.fixed.items())


def shown_symbols(question: PreventableQuestion) -> tuple[InitialQuantity, ...]:
    """The initial values that plates are about, in the order of the manoeuvre."""
    names = {question.manoeuvre.line, question.manoeuvre.across, *question.sheet, *question.fixed}
    return tuple(x for name, x in question.manoeuvre.quantities.items() if name in names)


def share_of(question: PreventableQuestion, plate: PlateResult) -> float:
    """Return which part of the plane is unpreventable: the mean over its lines."""
    low, high = question.along
    total = sum(b.near - a.near for x in plate.lines for a, b in x.spans)
    return total / (float(high - low) * len(plate.lines)) if plate.lines else 0.0


def as_text(
    question: PreventableQuestion, plates: Sequence[PlateResult], lemmas: Sequence[LemmaResult]
) -> str:
    """Return text for the terminal: each plate with some of its lines and its drives, and the lemmas."""
    known = question.manoeuvre.quantities
    along, across = known[question.manoeuvre.line], known[question.manoeuvre.across]
    lines: list[str] = []
    for plate in plates:
        fixed = fixed_text(question, plate)
        title = driver_model(plate.model).title
        lines.append(f"{plate.verdict:<11} {question.manoeuvre.name}, {title}{fixed and f'; {fixed}'}")
        if plate.reason:
            lines.append(f"  {plate.reason}")
        if plate.lines:
            percent = 100 * share_of(question, plate)
            what = f"{percent:.1f} % of the plane"
            if plate.stepped:
                what = "what follows"
                lines.append(f"  {plate.stepped};")
                lines.append("  the drives follow the controller, which their formula does not say")
            if plate.motion:
                lines.append(f"  {plate.motion};")
            lines.append(f"  unpreventable on {what}; {along.doc} [{along.unit}]:")
        for line in _some(plate.lines):
            shown = " and ".join(f"{a.near:.6g} to {b.near:.6g}" for a, b in line.spans[:_TOLD]) or "nowhere"
            if len(line.spans) > _TOLD:
                shown += f" and {len(line.spans) - _TOLD} more"
            lines.append(f"    {across.name} = {measured(across, line.at):<14} {shown}")
        for x in plate.shown:
            result: str = x.reason
            if x.drive is not None:
                values = ", ".join(
                    f"{name} = {measured(known[name], x.values[name])}" for name in (across.name, along.name)
                )
                result = f"a drive at {values}{_scenario_text(question, x)}"
            lines.append(f"  {x.side}: {result}")
    lines += [legend(shown_symbols(question))] if plates else []
    for proved in lemmas:
        lines.append(f"{proved.verdict:<11} {proved.lemma.name}: {proved.lemma.title}")
        if proved.reason:
            lines.append(f"  {proved.reason}")
    if question.readings:
        lines.append(f"with {', '.join(question.readings)}")
    lines += [f"{idle}: no boundary that is asked for depends on it" for idle in question.idle]
    return "\n".join(lines)


def _scenario_text(question: PreventableQuestion, shown: Shown) -> str:
    """Return the scenario of the drive, where the question names one."""
    if question.scenario is None:
        return ""
    whole, happening = parts_of(question.scenario, question.manoeuvre.vehicles)
    if shown.scenario == whole:
        return f", of scenario {question.scenario}"
    if shown.scenario == happening:
        return f"; what happens in scenario {question.scenario}, but no start that was tried is safe"
    return f"; no drive that was tried is of scenario {question.scenario}"


def _some(lines: Sequence[PlateLine]) -> Sequence[PlateLine]:
    """A few lines, first and last with them."""
    if len(lines) <= _TOLD:
        return lines
    return [lines[round(k * (len(lines) - 1) / (_TOLD - 1))] for k in range(_TOLD)]


Entry: TypeAlias = tuple[PlateResult, PlateLine, tuple[SpanEnd, SpanEnd]]
"""A span of a line of a plate."""


def sheet_of(question: PreventableQuestion, plates: Sequence[PlateResult]) -> Sheet[Entry]:
    """An entry for each span of each line: SI units, ends as numbers and in CSV also exactly."""
    fixed = dict.fromkeys(name for plate in plates for name in plate.fixed)
    along, across = question.manoeuvre.line, question.manoeuvre.across
    columns: tuple[Column[Entry], ...] = (
        Column("model", lambda x: x[0].model),
        *(Column(name, partial(_fixed, name)) for name in fixed),
        Column(across, lambda x: x[1].at),
        Column(f"{along}_from", lambda x: x[2][0].near),
        Column(f"{along}_to", lambda x: x[2][1].near),
        Column(f"{along}_from_exact", lambda x: "" if x[0].stepped else x[2][0].exact, "csv"),
        Column(f"{along}_to_exact", lambda x: "" if x[0].stepped else x[2][1].exact, "csv"),
        Column("note", lambda x: x[0].stepped or x[0].motion, "csv"),
    )
    every = [(plate, line, span) for plate in plates for line in plate.lines for span in line.spans]
    return Sheet(columns, every)


def _fixed(name: str, entry: Entry) -> Fraction:
    return entry[0].fixed[name]


def draw_sheet(question: PreventableQuestion, plates: Sequence[PlateResult]) -> Any:
    """All plates of a sheet: rows are the second of what is fixed, columns all else; colours are models."""
    names = list(question.sheet)
    beside = [name for name in names if name not in names[1:2]]
    columns = list(product(*(question.sheet[name] for name in beside)))
    rows = list(product(*(question.sheet[name] for name in names[1:2])))
    width = 1.1 + 2.5 * len(columns)
    top = 0.55 + _LEGEND[1] * ceil(len(question.models) / _models_a_row(width))
    height = top + 0.3 + 0.12 * len(_below(question, width)) + 2.2 * len(rows)
    figure = make_page(width, height)
    for i, row in enumerate(rows):
        for j, column in enumerate(columns):
            box = [
                (0.75 + 2.5 * j) / width,
                1 - (top + 2.2 * (i + 1) - 0.42) / height,
                2.0 / width,
                1.6 / height,
            ]
            axes = figure.add_axes(box)
            chosen = dict(zip((*beside, *names[1:2]), (*column, *row), strict=True))
            here = [p for p in plates if all(p.fixed.get(name) == value for name, value in chosen.items())]
            _draw_plate(axes, question, here)
            labels = [f"{n} {measured(question.manoeuvre.quantities[n], v)}" for n, v in chosen.items()]
            axes.set_title(", ".join(labels), fontsize=7, loc="left", pad=3)
            if j == 0:
                axes.set_ylabel(_label(question, question.manoeuvre.across), fontsize=7)
            if i == len(rows) - 1:
                axes.set_xlabel(_label(question, question.manoeuvre.line), fontsize=7)
    _head(figure, question, width, height)
    return figure


def _below(question: PreventableQuestion, width: float) -> list[str]:
    """Lines below the plates, the lowest first: symbols, readings, and what single lines are."""
    lines = [_STEPPED] if any(model.is_stepped for model in question.models) else []
    lines += wrap(legend(shown_symbols(question)), int(width * _LETTERS))[::-1]
    return lines + ([f"With {', '.join(question.readings)}"] if question.readings else [])


def _head(figure: Any, question: PreventableQuestion, width: float, height: float) -> None:
    what = "in what is shaded"
    if all(model.is_stepped for model in question.models):
        what = "at places on lines"
    known = question.manoeuvre.quantities
    fixed = "".join(f", {name} {measured(known[name], value)}" for name, value in question.fixed.items())
    title = f"{question.manoeuvre.name}{fixed}: a collision is unpreventable {what}"
    figure.text(0.2 / width, 1 - 0.22 / height, title, fontsize=9, va="center")
    for k, text in enumerate(_below(question, width)):
        figure.text(0.2 / width, (0.1 + 0.12 * k) / height, text, fontsize=5.5, va="center")
    for k, model in enumerate(question.models):
        row, column = divmod(k, _models_a_row(width))
        x, y = (0.2 + _LEGEND[0] * column) / width, 1 - (0.45 + _LEGEND[1] * row) / height
        label = f"─ {model.title}, stepped" if model.is_stepped else f"━ {model.title}"
        figure.text(x, y, label, fontsize=7, color=model.colour[0], va="center")


def _models_a_row(width: float) -> int:
    """Return how many names of models stand beside each other on a page so wide (inches)."""
    return max(1, int((width - 0.2) / _LEGEND[0]))


def _label(question: PreventableQuestion, name: str) -> str:
    return f"{name} [{question.manoeuvre.quantities[name].unit}]"


def _draw_plate(axes: Any, question: PreventableQuestion, plates: Sequence[PlateResult]) -> None:
    known = question.manoeuvre.quantities
    unit = float(UNITS[known[question.manoeuvre.across].unit][0])
    scale = float(UNITS[known[question.manoeuvre.line].unit][0])
    for plate in plates:
        colour = driver_model(plate.model).colour[0]
        if plate.stepped:
            _draw_places(axes, plate, colour, scale, unit)
        else:
            _draw_area(axes, plate, colour, scale, unit, [float(x) / scale for x in question.along])
        for x in plate.shown:
            if x.drive is not None:
                place = float(x.values[question.manoeuvre.line]) / scale
                row = float(x.values[question.manoeuvre.across]) / unit
                filled = colour if x.side == "unpreventable" else "white"
                axes.plot(place, row, "o", markersize=2.6, color=colour, markerfacecolor=filled, zorder=4)
    axes.set_xlim(*(float(x) / scale for x in question.along))
    rows = [float(line.at) / unit for plate in plates for line in plate.lines]
    axes.set_ylim(min(rows, default=0), max(rows, default=1))
    axes.tick_params(labelsize=6)


def _draw_places(axes: Any, plate: PlateResult, colour: str, scale: float, unit: float) -> None:
    """Draw each span of each line by itself: no claim is made between lines and places."""
    for line in plate.lines:
        for a, b in line.spans:
            ends, at = [a.near / scale, b.near / scale], [float(line.at) / unit] * 2
            axes.plot(ends, at, "|-", color=colour, linewidth=0.6, markersize=1.5, alpha=0.8)


def _draw_area(
    axes: Any, plate: PlateResult, colour: str, scale: float, unit: float, edges: Sequence[float]
) -> None:
    """Draw the area between the first and the last end of each line."""
    at = [float(line.at) / unit for line in plate.lines]
    low = [line.spans[0][0].near / scale if line.spans else 0.0 for line in plate.lines]
    high = [line.spans[-1][1].near / scale if line.spans else 0.0 for line in plate.lines]
    some = [bool(line.spans) for line in plate.lines]
    axes.fill_betweenx(at, low, high, where=some, color=colour, alpha=0.14, linewidth=0)
    for ends in (low, high):
        curve = [x if there and x not in edges else float("nan") for x, there in zip(ends, some, strict=True)]
        axes.plot(curve, at, color=colour, linewidth=1.1)
