"""One table in four looks, each read back."""

import csv
import io

import pytest

from roadproof.frontends.report.tables import LOOKS, Table, as_csv, as_latex, as_markdown, as_text

TABLE = Table(
    "Counts & shares_of A",
    ("name", "count", "share"),
    (("a|b", "7", "50.0%"), ("long name", "1234", "-")),
    ("A note with 100% of it.",),
)


def test_text_is_aligned() -> None:
    lines = as_text(TABLE).splitlines()
    assert lines[0] == "Counts & shares_of A"
    assert lines[2:6] == [
        "name       count  share",
        "---------  -----  -----",
        "a|b            7  50.0%",
        "long name   1234      -",
    ]
    assert lines[-1] == "A note with 100% of it."


def test_markdown_keeps_columns() -> None:
    lines = as_markdown(TABLE).splitlines()
    assert lines[0] == "## Counts & shares_of A"
    assert lines[3] == "|---|---:|---:|"
    assert lines[4] == r"| a\|b | 7 | 50.0% |"
    assert lines[-1] == "A note with 100% of it."


def test_csv_is_read_back() -> None:
    assert [tuple(row) for row in csv.reader(io.StringIO(as_csv(TABLE)))] == [TABLE.columns, *TABLE.rows]


def test_latex_escapes() -> None:
    text = as_latex(TABLE)
    assert r"\begin{tabular}{lrr}" in text
    assert r"a\textbar{}b & 7 & 50.0\% \\" in text
    assert r"\caption{Counts \& shares\_of A. A note with 100\% of it.}" in text
    assert text.count("\\\\\n") == 3


def test_a_row_of_another_width_is_refused() -> None:
    with pytest.raises(ValueError, match="a row of 1 cells"):
        Table("t", ("a", "b"), (("1",),))


@pytest.mark.parametrize("ending", list(LOOKS))
def test_empty_tables(ending: str) -> None:
    assert "name" in LOOKS[ending](Table("t", ("name",), ()))
