"""The overlap of scenarios to look at: a matrix as text, a table as CSV, a heat map with the cores."""

import csv
import io
from collections.abc import Sequence
from textwrap import wrap

from roadproof.analysis.overlap import PairVerdict, name_of
from roadproof.report.figures import as_bytes, make_figure
from roadproof.verdict import Verdict

SIGNS = {Verdict.WITNESSED: "#", Verdict.IMPOSSIBLE: ".", Verdict.NONE_WITHIN: "-", Verdict.UNKNOWN: "?"}
COLOURS = {
    Verdict.WITNESSED: "#3f7d4e",
    Verdict.IMPOSSIBLE: "#e4e0d6",
    Verdict.NONE_WITHIN: "#d9a441",
    Verdict.UNKNOWN: "#b5473c",
}
_MEANING = {
    Verdict.WITNESSED: "they hold together on a judged drive",
    Verdict.IMPOSSIBLE: "proved for all time that they never do",
    Verdict.NONE_WITHIN: "no drive within the limits",
    Verdict.UNKNOWN: "not decided",
}
FEW = 30
"""So many pairs are listed by number."""


def as_text(verdicts: Sequence[PairVerdict], across: bool) -> str:
    """The matrix, and below it which pairs have which verdict, and why."""
    lines = [as_matrix(verdicts, across)]
    for verdict in Verdict:
        found = [x for x in verdicts if x.verdict is verdict]
        if found:
            few = ", ".join(f"{x.a.number}-{x.b.number}" for x in found) if len(found) <= FEW else ""
            lines.append(f"{len(found):>4} {verdict}" + (f": {few}" if few else ""))
            lines += [f"       {reason}" for reason in dict.fromkeys(x.reason for x in found if x.reason)]
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


def as_csv(verdicts: Sequence[PairVerdict]) -> str:
    """A line for each pair; parts of a core are separated by semicolons."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(["a", "b", "set_a", "set_b", "verdict", "formula", "core", "reason", "evidence"])
    for x in verdicts:
        name = name_of(x.a, x.b)
        evidence = f"impossible-{name}.json" if x.certificate else f"drive-{name}.json" if x.drive else ""
        formula = "" if x.query is None else x.query.text
        who = (x.a.number, x.b.number, x.a.set_name, x.b.set_name)
        core = "; ".join(dict.fromkeys(part for one in x.cores for part in one.told))
        writer.writerow([*who, x.verdict, formula, core, x.reason, evidence])
    return out.getvalue()


def draw_overlap(verdicts: Sequence[PairVerdict], title: str, across: bool) -> dict[str, bytes]:
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
    axes.legend(
        fontsize=6, loc="lower left", bbox_to_anchor=(0, 1), borderaxespad=3.5, ncols=2, frameon=False
    )
    below.axis("off")
    below.text(0, 1, "\n".join(lines), fontsize=6, va="top", family="monospace", transform=below.transAxes)
    figure.suptitle(title, fontsize=9)
    return as_bytes(figure)


def _axes(verdicts: Sequence[PairVerdict], across: bool) -> tuple[list[int], list[int]]:
    rows, columns = {x.a.number for x in verdicts}, {x.b.number for x in verdicts}
    return (sorted(rows), sorted(columns)) if across else (sorted(rows | columns),) * 2


def _cells(verdicts: Sequence[PairVerdict], across: bool) -> dict[tuple[int, int], Verdict]:
    cells = {(x.a.number, x.b.number): x.verdict for x in verdicts}
    return cells if across else cells | {(b, a): verdict for (a, b), verdict in cells.items()}


def _captions(
    verdicts: Sequence[PairVerdict],
) -> tuple[list[str], dict[tuple[int, int], int]]:
    """The different cores, and for each pair the number of its own from 1."""
    captions: list[str] = []
    numbers: dict[tuple[int, int], int] = {}
    for x in verdicts:
        cores = dict.fromkeys("  ×  ".join(core.told) for core in x.cores)
        if not cores:
            continue
        caption = ";   ".join(cores)
        if caption not in captions:
            captions.append(caption)
        numbers[x.a.number, x.b.number] = captions.index(caption) + 1
    return captions, numbers


def _caption(number: int, caption: str) -> list[str]:
    """One caption on lines; what clashes is joined by a cross, one clash for each way to meet."""
    return wrap(f"{number:>3}  {caption}", 115, subsequent_indent="     ")
