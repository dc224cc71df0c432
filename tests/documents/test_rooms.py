"""The table of rooms in the map is that of the source, but for a few lines."""

import re

from documents.rooms import MAP, rooms


def test_the_map_has_every_room_and_about_as_many_lines() -> None:
    text = MAP.read_text("utf-8")
    said = {x: int(n.replace(",", "")) for x, n in re.findall(r"\| `([\w/]+/)` \| ([\d,]+) \|", text)}
    found = {x.folder: x.lines for x in rooms()}
    assert {*said} == {*found}
    assert all(abs(said[x] - n) <= 50 + n // 20 for x, n in found.items()), "python -m documents.rooms"
    assert all(f"| {x.label} | {x.audience} |" in text for x in rooms())
