"""Pictures of a traffic evaluation, and all else that it writes beside its rows: tables, a short text."""

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from pathlib import Path
from textwrap import wrap
from typing import Any

from roadproof.extensions.traffic.evaluate.results import decimal, scenario_words
from roadproof.extensions.traffic.evaluate.totals import ResultsRow, Totals
from roadproof.extensions.traffic.report.research_questions import answer_questions
from roadproof.extensions.traffic.report.tables import LOOKS
from roadproof.extensions.traffic.report.traffic import (
    MARK,
    comparison_table,
    drivers_table,
    ending_of,
    is_bounded,
    paper_row,
    results_tables,
)
from roadproof.frontends.report.figures import as_bytes, count_axis, hide_frame, legend_beside, make_figure
from roadproof.library.words import ScenarioWords
from roadproof.runtime.files import cannot_write, write_atomic

COLOURS = ("#9db8d9", "#4f7fb8", "#1f4a80", "#e0b990", "#c8783c", "#8a4a1c", "#8fb884", "#4b8b3b", "#2b5a20")
BAR, GREY, BOUNDS = "#9db8d9", "#555555", "#c8783c"


def draw_figures(totals: Totals) -> Iterator[tuple[str, Any]]:
    """The figures of each sector, by name. Raises ``MissingSolverError`` without matplotlib."""
    shown, words = totals.shown, scenario_words(totals.settings)
    for sector, rows in shown.items():
        end, where = ending_of(totals, sector), f" ({sector})" if len(shown) > 1 else ""
        yield f"recall{end}", _recall(rows, where)
        yield f"scenarios{end}", _scenarios(rows, where, words)
        yield f"overlaps{end}", _overlaps(rows, totals.settings.min_danger[0], where, words)


def _label(row: ResultsRow) -> str:
    return f"{row.set_name}, minDanger {decimal(row.min_danger)}"


def _recall(rows: Sequence[ResultsRow], where: str) -> Any:
    """A bar for each row of a results table; a mark where the paper's recall is."""
    figure, (axes,) = make_figure([0.5 + 0.4 * len(rows)], width=8.5)
    for place, row in enumerate(rows):
        axes.barh(place, 100 * (row.recall or 0.0), color=BAR, height=0.7)
        text = f"{100 * (row.recall or 0.0):.1f} % of {row.traces}" if row.traces else "no traces"
        axes.text(1, place, text, va="center", fontsize=7)
        if is_bounded(row):
            axes.plot([100 * x / row.traces for x in row.bounds], [place, place], color=BOUNDS, lw=3)
        known = paper_row(row)
        if known is not None:
            theirs = 100 * known.matching / known.traces
            axes.plot([theirs, theirs], [place - 0.4, place + 0.4], color=GREY, lw=2)
    axes.set_yticks(range(len(rows)), [_label(row) for row in rows], fontsize=7)
    axes.set_ylim(len(rows) - 0.4, -0.6)
    axes.set_xlim(0, 100)
    axes.set_xlabel("recall, %", fontsize=8)
    axes.tick_params(axis="x", labelsize=7)
    axes.fill([], [], color=BAR, label="these recordings")
    if any(map(is_bounded, rows)):
        axes.plot([], [], color=BOUNDS, lw=3, label="within errors\nof places")
    if any(paper_row(row) is not None for row in rows):
        axes.plot([], [], color=GREY, lw=2, label="\n".join(wrap(MARK, 20)))
    legend_beside(axes)
    axes.set_title(f"Recall by spec set{where}", fontsize=8)
    return figure


def _scenarios(rows: Sequence[ResultsRow], where: str, words: ScenarioWords) -> Any:
    """Return a chart with a group of bars for each scenario, one bar a row of the results table."""
    scenarios = rows[0].sector.scenarios
    figure, (axes,) = make_figure([3.4], width=max(6.0, 2.2 + 0.9 * len(scenarios)))
    share = 0.8 / len(rows)
    for k, row in enumerate(rows):
        places = [x - 0.4 + (k + 0.5) * share for x in range(len(scenarios))]
        heights = [row.scenarios[i] for i in scenarios]
        axes.bar(places, heights, width=share, color=COLOURS[k % len(COLOURS)], label=_label(row))
    names = ["\n".join([f"s{i}", *wrap(words[i].title, 14)]) for i in scenarios]
    axes.set_xticks(range(len(scenarios)), names, fontsize=7)
    axes.set_ylabel("matching traces", fontsize=8)
    count_axis(axes.yaxis)
    axes.tick_params(axis="y", labelsize=7)
    legend_beside(axes)
    axes.set_title(f"Disturbance traces that match each scenario{where}", fontsize=8)
    return figure


def _overlaps(rows: Sequence[ResultsRow], min_danger: Fraction, where: str, words: ScenarioWords) -> Any:
    """Return a chart of how many traces match two scenarios at once, for each set, under one minDanger."""
    chosen = [row for row in rows if row.min_danger == min_danger]
    scenarios = rows[0].sector.scenarios
    figure, axes = make_figure([0.7 + 0.34 * len(scenarios)] * len(chosen), width=7.0)
    for one, row in zip(axes, chosen, strict=True):
        shades = _draw_matrix(one, row, scenarios, words)
        one.set_title(f"{_label(row)}{where}: traces that match both", fontsize=8)
        for share in (0, 25, 50, 75, 100):
            one.fill([], [], color=shades.cmap(share / 100), label=f"{share} % of the rarer one")
        legend_beside(one)
    return figure


def _draw_matrix(axes: Any, row: ResultsRow, scenarios: Sequence[int], words: ScenarioWords) -> Any:
    """Counts of pairs below the diagonal, of single scenarios on it; shaded by share of the rarer one."""
    nothing = float("nan")

    def count(i: int, j: int) -> int:
        return row.scenarios[i] if i == j else row.together[min(i, j), max(i, j)]

    def share(i: int, j: int) -> float:
        rarer = min(row.scenarios[i], row.scenarios[j])
        return count(i, j) / rarer if rarer and i != j else 0.0

    cells = [
        [share(i, j) if x <= y else nothing for x, j in enumerate(scenarios)] for y, i in enumerate(scenarios)
    ]
    shades = axes.imshow(cells, cmap="Blues", vmin=0, vmax=1)
    for y, i in enumerate(scenarios):
        for x, j in enumerate(scenarios[: y + 1]):
            colour = "white" if share(i, j) > 0.6 else "black"
            axes.text(x, y, str(count(i, j)), ha="center", va="center", fontsize=7, color=colour)
    names = [
        "\n".join(wrap(f"s{i}  {words[i].title}", 34, drop_whitespace=False)).rstrip() for i in scenarios
    ]
    axes.set_xticks(range(len(scenarios)), [f"s{i}" for i in scenarios], fontsize=7)
    axes.set_yticks(range(len(scenarios)), names, fontsize=7)
    axes.tick_params(length=0)
    hide_frame(axes)
    return shades


def write_report(folder: Path, totals: Totals, failed: Mapping[str, str], pictures: bool = True) -> None:
    """``results`` of each sector and of drivers, ``comparison``, ``answers.md`` and ``figures/``.

    Tables have four looks, and all files are whole. ``failed`` are the recordings that are left out, and
    why; tables and text say so. Without ``pictures`` matplotlib is not needed. Raises
    ``InputError`` where a file cannot be written.
    """
    tables = {**results_tables(totals, failed), "comparison": comparison_table(totals, failed)}
    tables |= {"results-drivers": drivers_table(totals)} if totals.settings.drivers else {}
    for name, table in tables.items():
        for ending, look in LOOKS.items():
            if table is None:  # an earlier run may have had one
                (folder / f"{name}.{ending}").unlink(missing_ok=True)
            else:
                write_atomic(folder / f"{name}.{ending}", look(table).encode())
    write_atomic(folder / "answers.md", answer_questions(totals, failed).encode())
    if pictures:
        for name, figure in draw_figures(totals):
            for ending, content in as_bytes(figure).items():
                write_atomic(folder / "figures" / f"{name}.{ending}", content)


def remove_report(folder: Path) -> None:
    """Remove the tables of an earlier run, so that those of other recordings never outlive a run that fails.

    What was found in single recordings stays.
    """
    names = ["matches.csv", "pairs.csv", "results.json", "answers.md"]
    names += [f"{name}.{ending}" for name in ("results", "comparison") for ending in LOOKS]
    try:
        for path in (
            *(folder / name for name in names),
            *(path for ending in LOOKS for path in folder.glob(f"results-*.{ending}")),
            *folder.glob("figures/*.png"),
            *folder.glob("figures/*.svg"),
        ):
            path.unlink(missing_ok=True)
    except OSError as error:
        raise cannot_write(folder, error) from None
