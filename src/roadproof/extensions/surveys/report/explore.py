"""Texts, a table and pictures of an exploration: strip or map, boundaries and extremes."""

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from functools import partial
from itertools import pairwise
from textwrap import wrap
from typing import Any, TypeAlias

from roadproof.extensions.surveys.explore.explorable import Explorable, SweepVariable
from roadproof.extensions.surveys.explore.values import ExplorationResult
from roadproof.extensions.surveys.extremes.extreme import Extreme
from roadproof.extensions.surveys.extremes.points import PointFinding
from roadproof.extensions.surveys.report.cells import draw_cell, name_cells
from roadproof.extensions.surveys.report.overlap_picture import COLOURS
from roadproof.frontends.report.figures import legend_beside, make_figure
from roadproof.frontends.report.numbers import took
from roadproof.frontends.report.overlap import SIGNS
from roadproof.frontends.report.picture import Picture, drive_pictures, picture
from roadproof.frontends.report.sheet import Cell, Column, Sheet
from roadproof.library.words import words_of
from roadproof.verdict import Verdict
from roadproof.world.units import unit_text

_PALE, _NARROWEST, _TITLE = 0.3, 7.5, 11
"""The opacity between decided values; the least width of a map, in inches; letters of a title, an inch."""
MOST_NOTES = 2  # for one verdict on a map or strip; JSON has them all
# Reasons, each with its number.
Notes: TypeAlias = dict[str, int]
_MEANING: Mapping[Verdict, str] = {  # partial: a search has no other verdicts
    Verdict.WITNESSED: "a drive, judged at this value",
    Verdict.IMPOSSIBLE: "no drive exists: proved for all values",
    Verdict.NONE_WITHIN: "no drive within the printed limits",
    Verdict.UNKNOWN: "not decided",
}

_THERE = "proved that there is none, with the parameters at their values here"


def _meaning(verdict: Verdict, findings: Sequence[PointFinding]) -> str:
    there = any(x.assuming for x in findings if x.verdict is verdict)
    return _THERE if there else _MEANING[verdict]


def as_text(explorable: Explorable, explored: ExplorationResult, seconds: float | None = 0.0) -> str:
    """Return one explored formula as text: its map, boundaries and extremes, with reasons as notes.

    ``seconds``: the time that it took.
    """
    notes: Notes = {}
    lines = [_title(explorable)]
    if explorable.variables:
        lines += (
            _strip(explorable, explored) if len(explorable.variables) == 1 else _map(explorable, explored)
        )
        lines += _legend(explored.findings, notes)
    if len(explorable.variables) == 1:
        lines += _ends(explorable.variables[0], explored, notes)
    for extreme in explored.extremes:
        lines += _extreme(explorable, extreme, notes)
    for reason, number in notes.items():
        lines += wrap(reason, 108, initial_indent=f"  [{number}] ", subsequent_indent="      ")
    counts = [f"{explored.searches} searches"]
    if explored.findings:
        counts = [f"{len(explored.findings)} values", *counts, f"{explored.drives} drives"]
    return "\n".join([*lines, f"  {', '.join(counts)}{took(seconds)}"])


def _title(explorable: Explorable) -> str:
    search = explorable.search
    name = search.query.text
    if search.scenario is not None:
        name = str(words_of(search.specification, search.scenario))
    return f"{name}, set {search.specification.set_name}"


def _note(finding: PointFinding, notes: Notes) -> str:
    """Return the verdict with the number of the note that explains it."""
    return f"{finding.verdict} {_number(finding, notes)}"


def _number(finding: PointFinding, notes: Notes) -> str:
    return f"[{notes.setdefault(finding.reason, len(notes) + 1)}]"


def _strip(explorable: Explorable, explored: ExplorationResult) -> list[str]:
    [variable] = explorable.variables
    signs = "".join(SIGNS[x.verdict] for x in explored.findings)
    return [f"  {variable.name}  {show(variable.low)} {signs} {show(variable.high)} {_unit(variable.unit)}"]


def _map(explorable: Explorable, explored: ExplorationResult) -> list[str]:
    """Return the map as text: rows are values of the second variable, columns those of the first."""
    across, up = explorable.variables
    columns, rows = (variable.values(explorable.steps) for variable in explorable.variables)
    signs = {x.at: SIGNS[x.verdict] for x in explored.findings}
    width = max(len(show(row)) for row in rows)
    lines = [f"  {up.name} ({_unit(up.unit)})"]
    for row in reversed(rows):
        lines.append(f"  {show(row):>{width}} |" + "".join(f" {signs[column, row]}" for column in columns))
    lines.append(" " * (width + 4) + f" {show(columns[0])} … {show(columns[-1])}  ")
    lines[-1] += f"{across.name} ({_unit(across.unit)})"
    return lines


def _legend(findings: Sequence[PointFinding], notes: Notes) -> list[str]:
    lines: list[str] = []
    for verdict, sign in SIGNS.items():
        here = [x for x in findings if x.verdict is verdict]
        if here:
            unlike = list({x.reason: x for x in here if x.reason}.values())
            why = [_number(x, notes) for x in unlike[:MOST_NOTES]]
            why += [f"and {len(unlike) - MOST_NOTES} more"] if len(unlike) > MOST_NOTES else []
            line = (
                f"  {sign} {verdict}: {_meaning(verdict, findings)}, at {len(here)} of {len(findings)} values"
            )
            lines.append(" ".join([line, *why]))
    return lines


def _ends(variable: SweepVariable, explored: ExplorationResult, notes: Notes) -> list[str]:
    """Return lines on the least and greatest value with a drive, on values beyond, and on gaps between."""
    reached = [x.at[0] for x in explored.findings if x.has_drive]
    reached += [x.inside.at[0] for x in explored.boundaries]
    if not reached:
        return []
    places = sorted(set(reached))
    lines: list[str] = []
    for word, place, end in (("least", places[0], variable.low), ("greatest", places[-1], variable.high)):
        line = f"  {word} {variable.name} with a drive: {_value(place, variable.unit)}"
        if place == end:
            lines.append(f"{line}, the end of the range")
        else:
            boundary = next(x for x in explored.boundaries if x.inside.at[0] == place)
            lines.append(f"{line}; {_beyond(boundary.outside, boundary.excluded, variable.unit, notes)}")
    for boundary in explored.boundaries:
        if places[0] < boundary.outside.at[0] < places[-1]:
            beside = _value(boundary.inside.at[0], variable.unit)
            beyond = _beyond(boundary.outside, boundary.excluded, variable.unit, notes)
            lines.append(f"  a gap beside {beside}; {beyond}")
    return lines


def _beyond(outside: PointFinding, excluded: PointFinding | None, unit: str, notes: Notes) -> str:
    """Return the text about the other side of a bracket."""
    text = f"at {_value(outside.at[0], unit)} {_note(outside, notes)}"
    if excluded is not None and excluded.at != outside.at:
        text += f", at {_value(excluded.at[0], unit)} {_note(excluded, notes)}"
    return text


def _extreme(explorable: Explorable, extreme: Extreme, notes: Notes) -> list[str]:
    """Return the line on an extreme: the best value reached, and the values beyond."""
    measure, unit = extreme.measure, unit_text(extreme.measure.dimension)
    when = f"when {measure.when}" if measure.when else "at the start"
    head = f"  {measure.sense} {measure.text} {when}"
    if extreme.point:
        head += f", {explorable.variables[0].name} = {show(extreme.point[0])}"
    best, outside = extreme.best, extreme.outside
    if best is None:
        return [f"{head}: no drive" + ("" if outside is None else f": {_note(outside, notes)}")]
    if extreme.endless:
        return [f"{head}: no end; the judged drive goes past {_value(best.at[0], unit)}"]
    line = f"{head}: {_value(best.at[0], unit)} on a judged drive"
    return [line if outside is None else f"{line}; {_beyond(outside, extreme.excluded, unit, notes)}"]


Entry: TypeAlias = tuple[str, str, PointFinding, tuple[str, ...]]
"""The name of a formula, the kind of a value, what was found, and the names of the values that it is at."""


def entries_of(named: Mapping[str, Explorable], explored: Mapping[str, ExplorationResult]) -> Iterator[Entry]:
    """Yield an entry for each value, and for both sides of each boundary and extreme."""
    for name, result in explored.items():
        variables = tuple(variable.name for variable in named[name].variables)
        yield from ((name, "value", x, variables) for x in result.findings)
        for boundary in result.boundaries:
            yield name, "boundary, held", boundary.inside, variables
            yield name, "boundary, missed", boundary.outside, variables
        for extreme in result.extremes:
            sense = f"{extreme.measure.sense} {extreme.measure.text}"
            for side, x in (("best", extreme.best), ("missed", extreme.outside)):
                if x is not None:
                    yield name, f"{sense}, {side}", x, tuple(f"at {k}" for k, _ in enumerate(x.at, 1))


def sheet_of(entries: Sequence[Entry]) -> Sheet[Entry]:
    """Return a sheet with an entry for each value, boundary and extreme, in SI units."""
    names = dict.fromkeys(name for *_, at in entries for name in at)
    values: tuple[Column[Entry], ...] = tuple(Column(name, partial(_value_of, name)) for name in names)
    return Sheet(
        (
            Column("formula", lambda x: x[0]),
            Column("kind", lambda x: x[1]),
            *values,
            Column("verdict", lambda x: x[2].verdict, look="verdict"),
            Column("reason", lambda x: x[2].reason),
        ),
        entries,
    )


def _value_of(name: str, entry: Entry) -> Cell:
    return dict(zip(entry[3], entry[2].at, strict=True)).get(name)


def draw_all(name: str, explorable: Explorable, explored: ExplorationResult) -> Iterator[tuple[str, Picture]]:
    """Yield pictures of an exploration, and of drives at boundaries and extremes, with file names."""
    if explored.findings:
        yield name, picture(draw_exploration(explorable, explored))
    drives = ((file, finding.drive) for file, finding in _ends_of(name, explored))
    yield from drive_pictures(drives, explorable.search.specification.library)


def _ends_of(name: str, explored: ExplorationResult) -> Iterator[tuple[str, PointFinding]]:
    """Yield the findings at boundaries and extremes, each with the name of its picture."""
    for k, boundary in enumerate(explored.boundaries, 1):
        yield f"{name}-boundary-{k}-held", boundary.inside
    for k, x in enumerate(explored.extremes, 1):
        if x.best is not None:
            yield f"{name}-{x.measure.sense}-{k}-best", x.best


def draw_exploration(explorable: Explorable, explored: ExplorationResult) -> Any:
    """Draw the strip or map of an exploration, with measures above the strip."""
    return (_draw_strip if len(explorable.variables) == 1 else _draw_map)(explorable, explored)


def _draw_strip(explorable: Explorable, explored: ExplorationResult) -> Any:
    [variable] = explorable.variables
    measured = [x for x in explored.extremes if x.best is not None and x.point]
    keys = _keys_height(explored)
    figure, made = make_figure([2.6, 0.7, keys] if measured else [0.7, keys], width=8.0)
    *above, axes, below = made
    places = [x.at[0] for x in explored.findings]
    for low, high, verdict in _stretches(explored):
        axes.fill((low, high, high, low), (0, 0, 1, 1), color=COLOURS[verdict], alpha=_PALE, lw=0)
    for x in _decided(explored):
        axes.plot([float(x.at[0])] * 2, (0, 1), color=COLOURS[x.verdict], lw=3, solid_capstyle="butt")
    for boundary in explored.boundaries:
        inside, outside = float(boundary.inside.at[0]), float(boundary.outside.at[0])
        axes.plot((inside, inside), (0, 1), color="#222222", lw=1.4)
        axes.plot((outside, outside), (0, 1), color="#222222", ls=":", lw=1.4)
        axes.text(inside, 1.05, f"{inside:g}", fontsize=7, ha="center")
    axes.set_yticks([])
    axes.set_ylim(0, 1)
    axes.set_xlabel(_axis(variable), fontsize=8)
    for one in (*above, axes):
        one.set_xlim(float(places[0]), float(places[-1]))
        one.tick_params(labelsize=7)
    if measured:
        _draw_measures(above[0], measured)
    _finish(figure, below, explorable, explored)
    return figure


def _decided(explored: ExplorationResult) -> list[PointFinding]:
    """Return the values that were decided, in order: those of the grid, and both sides of boundaries."""
    beside = [y for x in explored.boundaries for y in (x.inside, x.outside, x.excluded) if y is not None]
    return sorted((*explored.findings, *beside), key=lambda x: x.at[0])


def _stretches(explored: ExplorationResult) -> Iterator[tuple[float, float, Verdict]]:
    """Yield the stretches between decided values beside each other with the same verdict."""
    for low, high in pairwise(_decided(explored)):
        if low.verdict == high.verdict:
            yield float(low.at[0]), float(high.at[0]), low.verdict


def _draw_measures(axes: Any, measured: Sequence[Extreme]) -> None:
    """Draw each measure over the variable: values of judged drives, and the nearest values without one."""
    for sense, colour in (("least", "#1f5fbf"), ("greatest", "#c8641e")):
        here = [x for x in measured if x.measure.sense == sense and not x.endless]
        if not here:
            continue
        reached = [(float(x.point[0]), float(x.best.at[0])) for x in here if x.best is not None]
        axes.plot(
            *zip(*reached, strict=True),
            color=colour,
            marker="o",
            ms=3,
            lw=1,
            label=f"{sense}, on judged drives",
        )
        beyond = [(float(x.point[0]), float(x.outside.at[0])) for x in here if x.outside is not None]
        axes.plot(*zip(*beyond, strict=True), color=colour, marker="x", ms=4, lw=0, label="not found")
    measure = measured[0].measure
    axes.set_ylabel(f"{measure.text}, {unit_text(measure.dimension)}", fontsize=7)
    legend_beside(axes)


def _draw_map(explorable: Explorable, explored: ExplorationResult) -> Any:
    across, up = explorable.variables
    columns, rows = (variable.values(explorable.steps) for variable in explorable.variables)
    findings = {x.at: x for x in explored.findings}
    width = max(_NARROWEST, 0.42 * len(columns) + 2.5)
    figure, [axes, below] = make_figure([0.42 * len(rows) + 1.0, _keys_height(explored)], width)
    for y, row in enumerate(rows):
        for x, column in enumerate(columns):
            cell = findings[column, row]
            draw_cell(axes, x, y, COLOURS[cell.verdict], cell.number, "white")
            if x and cell.has_drive != findings[columns[x - 1], row].has_drive:
                axes.plot((x, x), (y, y + 1), color="#222222", lw=1.6)
            if y and cell.has_drive != findings[column, rows[y - 1]].has_drive:
                axes.plot((x, x + 1), (y, y), color="#222222", lw=1.6)
    axes.set_xlim(0, len(columns))
    axes.set_ylim(0, len(rows))
    name_cells(axes, [*map(show, columns)], [*map(show, rows)], 7)
    axes.set_xlabel(f"{_axis(across)}; numbers in cells tell drives apart", fontsize=8)
    axes.set_ylabel(_axis(up), fontsize=8)
    _finish(figure, below, explorable, explored)
    return figure


def _finish(figure: Any, below: Any, explorable: Explorable, explored: ExplorationResult) -> None:
    """Add the title and the meaning of colours."""
    present = {x.verdict for x in explored.findings}
    for verdict in (v for v in SIGNS if v in present):
        below.fill([], [], color=COLOURS[verdict], label=f"{verdict}: {_meaning(verdict, explored.findings)}")
    if len(explorable.variables) == 1:
        pale = {"color": "#888888", "alpha": _PALE, "lw": 0}
        below.fill([], [], label="pale: between decided values with the same verdict", **pale)
        if explored.boundaries:
            below.plot([], [], color="#222222", lw=1.4, label="the last value with a drive")
            below.plot([], [], color="#222222", lw=1.4, ls=":", label="the nearest value without one")
    elif len({x.has_drive for x in explored.findings}) > 1:
        below.plot([], [], color="#222222", lw=1.6, label="between values with and without a drive")
    below.legend(fontsize=7, loc="upper left", frameon=False)
    below.axis("off")
    width = figure.get_size_inches()[0]
    figure.suptitle("\n".join(wrap(_title(explorable), int(width * _TITLE))), fontsize=9)


def _keys_height(explored: ExplorationResult) -> float:
    """Return the inches of the legend: an entry for each verdict, and at most three more."""
    return 0.17 * (len({x.verdict for x in explored.findings}) + 3) + 0.1


def _axis(variable: SweepVariable) -> str:
    """Return the name of an axis with its unit."""
    return f"{variable.name} [{_unit(variable.unit) or 'no unit'}]"


def _value(value: Fraction, unit: str) -> str:
    return f"{show(value)} {_unit(unit)}".rstrip()


def _unit(unit: str) -> str:
    return "" if unit == "unitless" else unit


def show(value: Fraction) -> str:
    """Return a value in decimals, to six digits."""
    return f"{float(value):.6g}"
