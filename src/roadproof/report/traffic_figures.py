"""Pictures of a traffic evaluation: recall by set, scenario counts, and how scenarios overlap."""

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from typing import Any

from roadproof.evaluation.results import Row, Totals
from roadproof.report.figures import as_bytes, make_figure
from roadproof.report.paper import MARK
from roadproof.report.traffic import decimal, ending_of, paper_row

COLOURS = ("#9db8d9", "#4f7fb8", "#1f4a80", "#e0b990", "#c8783c", "#8a4a1c", "#8fb884", "#4b8b3b", "#2b5a20")
GREY = "#555555"


def draw_figures(totals: Totals) -> Iterator[tuple[str, Mapping[str, bytes]]]:
    """Name and bytes by format of the figures of each sector. Raises ``InputError`` without matplotlib."""
    shown = totals.shown
    for sector, rows in shown.items():
        end, where = ending_of(totals, sector), f" ({sector})" if len(shown) > 1 else ""
        yield f"recall{end}", _draw_recall(rows, where)
        yield f"scenarios{end}", _draw_scenarios(rows, where)
        yield f"overlaps{end}", _draw_overlaps(rows, totals.settings.min_danger[0], where)


def _label(row: Row) -> str:
    return f"{row.set_name}, minDanger {decimal(row.min_danger)}"


def _draw_recall(rows: Sequence[Row], where: str) -> Mapping[str, bytes]:
    """A bar for each row of a results table; a mark where the paper's recall is."""
    figure, (axes,) = make_figure([0.5 + 0.4 * len(rows)], width=7.0)
    for place, row in enumerate(rows):
        recall = 100 * (row.recall or 0.0)
        axes.barh(place, recall, color=COLOURS[place % 3], height=0.7)
        said = f"{recall:.1f} % of {row.traces}" if row.traces else "no traces"
        axes.text(1, place, said, va="center", fontsize=7, color="white" if place % 3 == 2 else "black")
        known = paper_row(row)
        if known is not None:
            theirs = 100 * known.matching / known.traces
            axes.plot([theirs, theirs], [place - 0.4, place + 0.4], color=GREY, lw=2)
    axes.set_yticks(range(len(rows)), [_label(row) for row in rows], fontsize=7)
    axes.set_ylim(len(rows) - 0.4, -0.6)
    axes.set_xlim(0, 100)
    axes.set_xlabel("recall, %", fontsize=8)
    marked = f"; grey marks are {MARK}" if any(paper_row(row) is not None for row in rows) else ""
    axes.set_title(f"Recall by spec set{where}{marked}", fontsize=8)
    return as_bytes(figure)


def _draw_scenarios(rows: Sequence[Row], where: str) -> Mapping[str, bytes]:
    """For each scenario a group of bars, one a row of the results table."""
    scenarios = rows[0].sector.scenarios
    figure, (axes,) = make_figure([3.2], width=8.0)
    share = 0.8 / len(rows)
    for k, row in enumerate(rows):
        places = [x - 0.4 + (k + 0.5) * share for x in range(len(scenarios))]
        heights = [row.scenarios[i] for i in scenarios]
        axes.bar(places, heights, width=share, color=COLOURS[k % len(COLOURS)], label=_label(row))
    axes.set_xticks(range(len(scenarios)), [f"s{i}" for i in scenarios], fontsize=8)
    axes.set_ylabel("matching traces", fontsize=8)
    axes.legend(fontsize=6)
    axes.set_title(f"Disturbance traces that match each scenario{where}", fontsize=8)
    return as_bytes(figure)


def _draw_overlaps(rows: Sequence[Row], min_danger: Fraction, where: str) -> Mapping[str, bytes]:
    """For each set, under one minDanger, how many traces match two scenarios at once."""
    chosen = [row for row in rows if row.min_danger == min_danger]
    scenarios = rows[0].sector.scenarios
    figure, axes = make_figure([0.6 + 0.34 * len(scenarios)] * len(chosen), width=5.0)
    for one, row in zip(axes, chosen, strict=True):
        _draw_matrix(one, row, scenarios, where)
    return as_bytes(figure)


def _draw_matrix(axes: Any, row: Row, scenarios: Sequence[int], where: str) -> None:
    """Counts of pairs off the diagonal, of single scenarios on it; shaded by share of the rarer one."""

    def count(i: int, j: int) -> int:
        return row.scenarios[i] if i == j else row.together[min(i, j), max(i, j)]

    def share(i: int, j: int) -> float:
        rarer = min(row.scenarios[i], row.scenarios[j])
        return count(i, j) / rarer if rarer and i != j else 0.0

    axes.imshow([[share(i, j) for j in scenarios] for i in scenarios], cmap="Blues", vmin=0, vmax=1)
    for y, i in enumerate(scenarios):
        for x, j in enumerate(scenarios):
            colour = "white" if share(i, j) > 0.6 else "black"
            axes.text(x, y, str(count(i, j)), ha="center", va="center", fontsize=6, color=colour)
    names = [f"s{i}" for i in scenarios]
    axes.set_xticks(range(len(scenarios)), names, fontsize=7)
    axes.set_yticks(range(len(scenarios)), names, fontsize=7)
    axes.set_title(f"{_label(row)}{where}: traces that match both; shade: share of the rarer one", fontsize=7)
