"""The table of folders in the map is that of the source, but for a few lines."""

from documents.rooms import TABLE, is_about, lines_in, rooms, table


def test_the_table_has_every_folder_and_about_as_many_lines() -> None:
    text = TABLE.read_text("utf-8")
    known = lines_in(text)
    assert known.keys() == {x.folder for x in rooms()}
    assert all(is_about(known[x.folder], x.lines) for x in rooms()), "run: make generated"
    assert table(known) == text, "run: make generated"


def test_only_numbers_that_are_wrong_change() -> None:
    known = lines_in(TABLE.read_text("utf-8"))
    lines = known["logic/"]
    assert lines_in(table({**known, "logic/": lines + 1}))["logic/"] == lines + 1
    assert is_about(lines_in(table({**known, "logic/": 2 * lines}))["logic/"], lines)
