"""Renderers of sheets on terminals: an outline with headings."""

from roadproof.frontends.report.sheet import Column, Sheet, as_csv, as_outline

COLUMNS = (
    Column[tuple[str, str, str]]("place", lambda x: x[0], "outline", look="heading"),
    Column("part", lambda x: x[1], "outline", look="heading"),
    Column("what", lambda x: x[2], "outline", width=6),
    Column("length", lambda x: len(x[2]), "outline"),
    Column("name", lambda x: x[2]),
)
ENTRIES = [
    ("A", "front", "one"),
    ("A", "", "two"),
    ("A", "front", "three"),
    ("B", "front", ""),
    ("", "back", "x"),
]


def test_headings_stand_where_they_change_or_below_one_that_does():
    rows = [
        "A",
        "front",
        "  one    3",
        "  two    3",
        "  three  5",
        "B",
        "front",
        "         0",
        "back",
        "  x      1",
    ]
    assert as_outline(Sheet(COLUMNS, ENTRIES)) == rows


def test_an_outline_has_columns_of_its_own_alone():
    assert as_csv(Sheet(COLUMNS, ENTRIES)).splitlines()[:2] == ["name", "one"]
    assert as_outline(Sheet(COLUMNS[-1:], ENTRIES[:1])) == [""]
