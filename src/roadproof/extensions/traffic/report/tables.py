"""A table as text, Markdown, CSV and LaTeX: one content, four looks."""

from collections.abc import Callable, Mapping

from roadproof.frontends.report.csv_table import csv_text
from roadproof.frontends.report.sheet import aligned
from roadproof.runtime.records import dataclass

_LATEX = str.maketrans(
    {
        "\\": r"\textbackslash{}",
        "&": r"\&",
        "%": r"\%",
        "_": r"\_",
        "#": r"\#",
        "$": r"\$",
        "{": r"\{",
        "}": r"\}",
        "<": r"\textless{}",
        ">": r"\textgreater{}",
        "~": r"\textasciitilde{}",
        "^": r"\textasciicircum{}",
        "|": r"\textbar{}",
    }
)


@dataclass(frozen=True)
class ReportTable:
    """Cells as they are to be read; ``notes`` stand below. Every row has as many cells as ``columns``."""

    title: str
    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        wrong = [row for row in self.rows if len(row) != len(self.columns)]
        if wrong:
            raise ValueError(f"a row of {len(wrong[0])} cells in a table of {len(self.columns)} columns")


def as_text(table: ReportTable) -> str:
    """Columns aligned by spaces: texts to the left, numbers to the right."""
    rule = ["-" * max(map(len, column)) for column in zip(table.columns, *table.rows, strict=True)]
    body = aligned([table.columns, rule, *table.rows], _numeric(table))
    return "\n".join([table.title, "", *body, *_below(table)]) + "\n"


def as_markdown(table: ReportTable) -> str:
    """A table of GitHub's Markdown with the title as heading."""

    def line(cells: tuple[str, ...]) -> str:
        return "| " + " | ".join(cell.replace("|", r"\|") for cell in cells) + " |"

    rule = "|" + "|".join("---:" if right else "---" for right in _numeric(table)) + "|"
    body = [line(table.columns), rule, *map(line, table.rows)]
    return "\n".join([f"## {table.title}", "", *body, *_below(table)]) + "\n"


def as_csv(table: ReportTable) -> str:
    """Header and rows; title and notes are left out, so that programs can read it."""
    return csv_text(table.columns, table.rows)


def as_latex(table: ReportTable) -> str:
    """A ``table*`` with booktabs rules, notes in the caption."""

    def line(cells: tuple[str, ...]) -> str:
        return "    " + " & ".join(map(_escape, cells)) + r" \\"

    places = "".join("r" if right else "l" for right in _numeric(table))
    caption = _escape(" ".join([table.title.rstrip(".") + ".", *table.notes]))
    return "\n".join(
        [
            r"\begin{table*}",
            rf"  \caption{{{caption}}}",
            rf"  \begin{{tabular}}{{{places}}}",
            r"    \toprule",
            line(table.columns),
            r"    \midrule",
            *map(line, table.rows),
            r"    \bottomrule",
            r"  \end{tabular}",
            r"\end{table*}",
            "",
        ]
    )


LOOKS: Mapping[str, Callable[[ReportTable], str]] = {
    "txt": as_text,
    "md": as_markdown,
    "csv": as_csv,
    "tex": as_latex,
}
"""How to write a table, by the ending of the file."""


def _numeric(table: ReportTable) -> list[bool]:
    """Return which columns hold nothing but numbers, percentages and gaps."""
    columns = list(zip(*table.rows, strict=True)) or [()] * len(table.columns)
    return [bool(cells) and all(_is_number(cell) for cell in cells) for cells in columns]


def _is_number(cell: str) -> bool:
    return cell in ("", "-") or cell.removesuffix("%").strip().replace(".", "", 1).isdecimal()


def _below(table: ReportTable) -> list[str]:
    return ["", *table.notes] if table.notes else []


def _escape(text: str) -> str:
    return text.translate(_LATEX)
