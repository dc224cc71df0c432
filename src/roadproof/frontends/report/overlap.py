"""The overlap of scenarios to look at: a matrix as text, a sheet, a heat map with the cores."""

from collections.abc import Mapping, Sequence
from itertools import groupby
from textwrap import wrap
from typing import Any

from roadproof.frontends.report.figures import draw_cell, hide_frame, legend_beside, make_figure, name_cells
from roadproof.frontends.report.sheet import Column, Sheet
from roadproof.library.words import Called, Words, legend
from roadproof.questions.overlap import PairVerdict
from roadproof.verdict import Verdict

SIGNS = {Verdict.WITNESSED: "#", Verdict.IMPOSSIBLE: ".", Verdict.NONE_WITHIN: "-", Verdict.UNKNOWN: "?"}
COLOURS = {
    Verdict.WITNESSED: "#3f7d4e",
    Verdict.IMPOSSIBLE: "#e4e0d6",
    Verdict.NONE_WITHIN: "#d9a441",
    Verdict.UNKNOWN: "#b5473c",
}
_MEANING = {
    Verdict.WITNESSED: "compatible: both hold on a judged drive",
    Verdict.IMPOSSIBLE: "incompatible: proved for all time",
    Verdict.NONE_WITHIN: "no drive within the limits",
    Verdict.UNKNOWN: "not decided",
}
_CELL, _NAMES, _LETTER = 0.32, 4.0, 0.06  # inches: a cell, the names beside, a letter of the cores
FEW = 30
"""So many pairs are listed by number."""


def as_text(verdicts: Sequence[PairVerdict], across: bool, words: Called) -> str:
    """The matrix, below it which pairs have which verdict, and why, and what the scenarios are called."""
    lines = [as_matrix(verdicts, across)]
    for verdict in Verdict:
        found = [x for x in verdicts if x.verdict is verdict]
        if found:
            few = ", ".join(f"{x.a.number}-{x.b.number}" for x in found) if len(found) <= FEW else ""
            lines.append(f"{len(found):>4} {verdict}" + (f": {few}" if few else ""))
            lines += [f"       {reason}" for reason in dict.fromkeys(x.reason for x in found if x.reason)]
    lines += [f"  {line}" for line in legend(words)]
    return "\n".join(lines)


def as_matrix(verdicts: Sequence[PairVerdict], across: bool) -> str:
    """One sign a pair, rows ``a`` and columns ``b``; symmetric unless ``across`` two sets."""
    rows, columns = _axes(verdicts, across)
    signs = _cells(verdicts, across)
    lines = ["    " + "".join(f"{column:>3}" for column in columns)]
    for row in rows:
        cells = (SIGNS[signs[row, column]] if (row, column) in signs else " " for column in columns)
        lines.append(f"{row:>4}" + "".join(f"  {cell}" for cell in cells))
    present = [v for v in SIGNS if any(x.verdict is v for x in verdicts)]
    return "\n".join([*lines, *(f"  {SIGNS[v]} {v}: {_MEANING[v]}" for v in present)])


def sheet_of(verdicts: Sequence[PairVerdict], words: Called) -> Sheet[PairVerdict]:
    """An entry for each pair; parts of a core are separated by semicolons."""
    return Sheet(
        (
            Column("a", lambda x: x.a),
            Column("b", lambda x: x.b),
            Column("set_a", lambda x: x.a.set_name, "csv"),
            Column("set_b", lambda x: x.b.set_name, "csv"),
            Column("verdict", lambda x: x.verdict),
            Column("formula", lambda x: x.query.text, "csv"),
            Column("core", lambda x: "; ".join(x.told), "csv"),
            Column("reason", lambda x: x.reason),
            Column("evidence", _evidence, "csv"),
            Column("name_a", lambda x: words[x.a.number].name, "csv"),
            Column("name_b", lambda x: words[x.b.number].name, "csv"),
        ),
        verdicts,
    )


def _evidence(pair: PairVerdict) -> str:
    """The names of the files that show the verdict."""
    return "; ".join(f"{name}.json" for name in pair.evidence)


def draw_overlap(verdicts: Sequence[PairVerdict], title: str, across: bool, words: Called) -> Any:
    """The heat map: one triangle, or all cells where ``across`` two sets; sectors are groups.

    Numbers in the cells lead to the cores below.
    """
    rows, columns = _axes(verdicts, across)
    rows, columns = (rows, columns) if across else (rows[1:], columns[:-1])
    found = _cells(verdicts, across)
    captions, numbers = _captions(verdicts)
    width = max(8.0, _CELL * len(columns) + _NAMES)
    letters = int((width - 0.4) / _LETTER)
    told = (wrap(f"{k:>3}  {x}", letters, subsequent_indent="     ") for k, x in enumerate(captions, 1))
    lines = [line for each in told for line in each]
    figure, (axes, below) = make_figure([_CELL * len(rows) + 0.7, 0.3 + 0.15 * len(lines)], width)
    for y, row in enumerate(rows):
        for x, column in enumerate(columns):
            if across or column < row:
                pair = (row, column) if across else (column, row)
                if (verdict := found.get((row, column))) is not None:
                    draw_cell(axes, x, y, COLOURS[verdict], numbers.get(pair))
    beside = -(8 * 0.56 * max(len(_named(words[row])) for row in rows) + 16)
    _draw_axes(axes, rows, columns, words, across, beside)
    if across:
        axes.set_ylabel(f"set {verdicts[0].a.set_name}", fontsize=8)
        axes.set_xlabel(f"set {verdicts[0].b.set_name}", fontsize=8)
    present = [v for v in SIGNS if v in found.values()]
    for verdict in present:
        axes.fill([], [], color=COLOURS[verdict], label=f"{verdict}: {_MEANING[verdict]}")
    if captions:
        axes.plot([], [], marker="$1$", color="black", lw=0, ms=5, label="number: what clashes, told below")
    if across:
        legend_beside(axes)
    else:
        axes.legend(fontsize=8, loc="upper right", frameon=False)
    below.axis("off")
    style = {"textcoords": "offset points", "fontsize": 7, "va": "top", "family": "monospace"}
    shown = below.annotate("\n".join(lines), (0, 1), (beside, 0), "axes fraction", **style)
    shown.set_in_layout(False)
    figure.suptitle(title, fontsize=10)
    return figure


def _named(words: Words) -> str:
    return f"{words.number}  {words.title}".rstrip()


def _draw_axes(
    axes: Any, rows: Sequence[int], columns: Sequence[int], words: Called, across: bool, beside: float
) -> None:
    """Numbers below, names beside, and a line where another road sector begins, which is named too."""
    axes.set_xlim(0, len(columns))
    axes.set_ylim(len(rows), 0)
    name_cells(axes, [*map(str, columns)], [_named(words[row]) for row in rows], 8)
    axes.tick_params(length=0)
    axes.set_aspect("equal", anchor="NW")
    hide_frame(axes)
    style = {"textcoords": "offset points", "fontsize": 9, "ha": "center"}
    line = {"color": "#222222", "lw": 1.4}
    for begin, end, sector in sectors_among(rows, words):
        if begin:
            axes.plot((0, len(columns) if across else begin), (begin, begin), **line)
        at = (0, (begin + end) / 2)
        axes.annotate(sector, at, (beside, 0), ("axes fraction", "data"), rotation=90, va="center", **style)
    for begin, end, sector in sectors_among(columns, words):
        if begin:
            axes.plot((begin, begin), (0 if across else begin - 1, len(rows)), **line)
        axes.annotate(sector, ((begin + end) / 2, 0), (0, -24), ("data", "axes fraction"), va="top", **style)


def sectors_among(numbers: Sequence[int], words: Called) -> list[tuple[int, int, str]]:
    """Neighbours of one road sector: where they begin and end, and its name; those without are left out."""
    found = []
    for sector, group in groupby(enumerate(numbers), key=lambda item: words[item[1]].sector):
        places = [place for place, _ in group]
        found += [(places[0], places[-1] + 1, sector)] if sector else []
    return found


def _axes(verdicts: Sequence[PairVerdict], across: bool) -> tuple[list[int], list[int]]:
    rows, columns = {x.a.number for x in verdicts}, {x.b.number for x in verdicts}
    return (sorted(rows), sorted(columns)) if across else (sorted(rows | columns),) * 2


def _cells(verdicts: Sequence[PairVerdict], across: bool) -> Mapping[tuple[int, int], Verdict]:
    cells = {(x.a.number, x.b.number): x.verdict for x in verdicts}
    return cells if across else cells | {(b, a): verdict for (a, b), verdict in cells.items()}


def _captions(verdicts: Sequence[PairVerdict]) -> tuple[list[str], dict[tuple[int, int], int]]:
    """The different cores, and for each pair the number of its own from 1."""
    captions: list[str] = []
    numbers: dict[tuple[int, int], int] = {}
    for x in verdicts:
        cores = dict.fromkeys("  ×  ".join(core.parts) for core in x.cores)
        if not cores:
            continue
        caption = ";   ".join(cores)
        if caption not in captions:
            captions.append(caption)
        numbers[x.a.number, x.b.number] = captions.index(caption) + 1
    return captions, numbers
