"""The heat map of the overlap of scenarios, with the cores of those that exclude each other."""

from collections.abc import Mapping, Sequence
from itertools import groupby
from textwrap import wrap
from typing import Any

from roadproof.extensions.surveys.report.cells import draw_cell, name_cells
from roadproof.frontends.api.relations import Overlaps
from roadproof.frontends.report.figures import hide_frame, legend_beside, make_figure
from roadproof.frontends.report.overlap import MEANING, SIGNS, axes_of, cells_of
from roadproof.frontends.report.picture import Picture, picture
from roadproof.library.words import ScenarioWords, Words
from roadproof.questions.overlap import PairVerdict
from roadproof.verdict import Verdict

_CELL, _NAMES, _LETTER = 0.32, 4.0, 0.06  # inches: a cell, the names beside, a letter of the cores
COLOURS: Mapping[Verdict, str] = {  # partial: a pair has no other verdicts
    Verdict.WITNESSED: "#3f7d4e",
    Verdict.IMPOSSIBLE: "#e4e0d6",
    Verdict.NONE_WITHIN: "#d9a441",
    Verdict.UNKNOWN: "#b5473c",
}


def draw_answer(answer: Overlaps) -> Picture:
    """Return the heat map of an answer."""
    meeting, sets = answer.view.meeting, ",".join(answer.question.basis.set_names)
    how = f"lanes {meeting.lanes}, roles {meeting.roles}, start {meeting.start}"
    title = f"Which scenarios hold together: set {sets}; {how}"
    return picture(draw_overlap(answer.pairs, title, answer.across, answer.words))


def draw_overlap(verdicts: Sequence[PairVerdict], title: str, across: bool, words: ScenarioWords) -> Any:
    """The heat map: one triangle, or all cells where ``across`` two sets; sectors are groups.

    Numbers in the cells lead to the cores below.
    """
    rows, columns = axes_of(verdicts, across)
    rows, columns = (rows, columns) if across else (rows[1:], columns[:-1])
    cells = cells_of(verdicts, across)
    captions, numbers = _captions(verdicts)
    width = max(8.0, _CELL * len(columns) + _NAMES)
    letters = int((width - 0.4) / _LETTER)
    wrapped = (wrap(f"{k:>3}  {x}", letters, subsequent_indent="     ") for k, x in enumerate(captions, 1))
    lines = [line for each in wrapped for line in each]
    figure, (axes, below) = make_figure([_CELL * len(rows) + 0.7, 0.3 + 0.15 * len(lines)], width)
    for y, row in enumerate(rows):
        for x, column in enumerate(columns):
            if across or column < row:
                pair = (row, column) if across else (column, row)
                if (verdict := cells.get((row, column))) is not None:
                    draw_cell(axes, x, y, COLOURS[verdict], numbers.get(pair))
    beside = -(8 * 0.56 * max(len(_named(words[row])) for row in rows) + 16)
    _draw_axes(axes, rows, columns, words, across, beside)
    if across:
        axes.set_ylabel(f"set {verdicts[0].a.set_name}", fontsize=8)
        axes.set_xlabel(f"set {verdicts[0].b.set_name}", fontsize=8)
    present = [v for v in SIGNS if v in cells.values()]
    for verdict in present:
        axes.fill([], [], color=COLOURS[verdict], label=f"{verdict}: {MEANING[verdict]}")
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
    axes: Any, rows: Sequence[int], columns: Sequence[int], words: ScenarioWords, across: bool, beside: float
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


def sectors_among(numbers: Sequence[int], words: ScenarioWords) -> list[tuple[int, int, str]]:
    """Neighbours of one road sector: where they begin and end, and its name; those without are left out."""
    spans = []
    for sector, group in groupby(enumerate(numbers), key=lambda item: words[item[1]].sector):
        places = [place for place, _ in group]
        spans += [(places[0], places[-1] + 1, sector)] if sector else []
    return spans


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
