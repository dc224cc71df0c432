"""The overlap of scenarios to look at: a matrix as text, a table as CSV, a heat map with the cores."""

import csv
import io
from collections.abc import Mapping, Sequence
from textwrap import wrap
from typing import Any

from roadproof.report.figures import as_bytes, make_figure

SIGNS = {"WITNESSED": "#", "IMPOSSIBLE": ".", "NONE-WITHIN": "-", "UNKNOWN": "?"}
COLOURS = {"WITNESSED": "#3f7d4e", "IMPOSSIBLE": "#e4e0d6", "NONE-WITHIN": "#d9a441", "UNKNOWN": "#b5473c"}
_MEANING = {
    "WITNESSED": "they hold together on a judged drive",
    "IMPOSSIBLE": "proved for all time that they never do",
    "NONE-WITHIN": "no drive within the limits",
    "UNKNOWN": "not decided",
}


def as_matrix(verdicts: Sequence[Mapping[str, Any]], across: bool) -> str:
    """One sign a pair, rows ``a`` and columns ``b``; symmetric unless ``across`` two sets."""
    rows, columns = _axes(verdicts, across)
    signs = _cells(verdicts, across)
    lines = ["    " + "".join(f"{column:>3}" for column in columns)]
    for row in rows:
        cells = (SIGNS.get(signs.get((row, column), ""), " ") for column in columns)
        lines.append(f"{row:>4}" + "".join(f"  {cell}" for cell in cells))
    present = [v for v in SIGNS if any(x["verdict"] == v for x in verdicts)]
    return "\n".join([*lines, *(f"  {SIGNS[v]} {v}: {_MEANING[v]}" for v in present)])


def as_csv(verdicts: Sequence[Mapping[str, Any]]) -> str:
    """A line for each pair; parts of a core are separated by semicolons."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(["a", "b", "set_a", "set_b", "verdict", "formula", "core", "reason", "evidence"])
    for x in verdicts:
        evidence = x.get("certificate") or x.get("drive") or ""
        shown = evidence if isinstance(evidence, str) and "\n" not in evidence else "inline"
        core = "; ".join(x.get("core", []))
        writer.writerow(
            [x["a"], x["b"], x["set_a"], x["set_b"], x["verdict"], x["formula"], core, x["reason"], shown]
        )
    return out.getvalue()


def draw_overlap(verdicts: Sequence[Mapping[str, Any]], title: str, across: bool) -> dict[str, bytes]:
    """The heat map as ``{"png": …, "svg": …}``; numbers in the cells lead to the cores below."""
    rows, columns = _axes(verdicts, across)
    found = _cells(verdicts, across)
    captions, numbers = _captions(verdicts)
    lines = [line for k, caption in enumerate(captions, 1) for line in _caption(k, caption)]
    figure, (axes, below) = make_figure([0.31 * len(rows) + 1.0, 0.3 + 0.14 * len(lines)], width=8.0)
    for y, row in enumerate(rows):
        for x, column in enumerate(columns):
            verdict = found.get((row, column))
            if verdict is None:
                continue
            axes.fill((x, x + 1, x + 1, x), (y, y, y + 1, y + 1), color=COLOURS[verdict], ec="white", lw=0.8)
            number = numbers.get((row, column)) or (None if across else numbers.get((column, row)))
            if number is not None:
                axes.text(x + 0.5, y + 0.5, str(number), fontsize=6, ha="center", va="center")
    axes.set_xlim(0, len(columns))
    axes.set_ylim(len(rows), 0)
    axes.set_xticks([k + 0.5 for k in range(len(columns))], [str(c) for c in columns], fontsize=7)
    axes.set_yticks([k + 0.5 for k in range(len(rows))], [str(r) for r in rows], fontsize=7)
    axes.xaxis.tick_top()
    axes.set_aspect("equal")
    present = [v for v in SIGNS if v in found.values()]
    for verdict in present:
        axes.fill([], [], color=COLOURS[verdict], label=f"{verdict}: {_MEANING[verdict]}")
    axes.legend(fontsize=6, loc="lower left", bbox_to_anchor=(0, 1.04), ncols=2, frameon=False)
    below.axis("off")
    below.text(0, 1, "\n".join(lines), fontsize=6, va="top", family="monospace", transform=below.transAxes)
    figure.suptitle(title, fontsize=9)
    return as_bytes(figure)


def _axes(verdicts: Sequence[Mapping[str, Any]], across: bool) -> tuple[list[int], list[int]]:
    rows, columns = {x["a"] for x in verdicts}, {x["b"] for x in verdicts}
    return (sorted(rows), sorted(columns)) if across else (sorted(rows | columns),) * 2


def _cells(verdicts: Sequence[Mapping[str, Any]], across: bool) -> dict[tuple[int, int], str]:
    cells = {(x["a"], x["b"]): str(x["verdict"]) for x in verdicts}
    return cells if across else cells | {(b, a): verdict for (a, b), verdict in cells.items()}


def _captions(
    verdicts: Sequence[Mapping[str, Any]],
) -> tuple[list[str], dict[tuple[int, int], int]]:
    """The different cores, and for each pair the number of its own from 1."""
    captions: list[str] = []
    numbers: dict[tuple[int, int], int] = {}
    for x in verdicts:
        cores = dict.fromkeys("  ×  ".join(core["parts"]) for core in x.get("cores", ()))
        if not cores:
            continue
        caption = ";   ".join(cores)
        if caption not in captions:
            captions.append(caption)
        numbers[x["a"], x["b"]] = captions.index(caption) + 1
    return captions, numbers


def _caption(number: int, caption: str) -> list[str]:
    """One caption on lines; what clashes is joined by a cross, one clash for each way to meet."""
    return wrap(f"{number:>3}  {caption}", 115, subsequent_indent="     ")
