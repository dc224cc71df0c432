"""Everything that a traffic evaluation writes beside its rows: tables, pictures, a short text."""

from collections.abc import Mapping
from pathlib import Path

from roadproof.frontends.report.answers import answer_questions
from roadproof.frontends.report.figures import as_bytes
from roadproof.frontends.report.tables import LOOKS
from roadproof.frontends.report.traffic import comparison_table, drivers_table, results_tables
from roadproof.frontends.report.traffic_figures import draw_figures
from roadproof.recordings.evaluate.totals import Totals
from roadproof.runtime.files import cannot_write, write_whole


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
                write_whole(folder / f"{name}.{ending}", look(table).encode())
    write_whole(folder / "answers.md", answer_questions(totals, failed).encode())
    if pictures:
        for name, figure in draw_figures(totals):
            for ending, content in as_bytes(figure).items():
                write_whole(folder / "figures" / f"{name}.{ending}", content)


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
