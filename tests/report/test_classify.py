"""The table and the picture of classes, on made-up answers."""

from typing import Any

import pytest

from roadproof.report.classify import as_table, draw_classes


def one(
    happens: list[int], where: str | None, situations: int | None, verdict: str = "WITNESSED"
) -> dict[str, Any]:
    name = "_".join(map(str, happens))
    shown = {"name": f"class_{name}", "vehicles": ["SV", "POV"], "happens": happens, "where": where}
    return {**shown, "description": f"what {name} is", "verdict": verdict, "situations": situations}


SHARES = {"source": "roads", "situations": {"2": 10}, "traces": 20, "covered": 8}


def test_places_are_added_up() -> None:
    classes = [one([4], "main", 5), one([4], "merge", 1, "UNKNOWN"), one([4, 8], "main", 4)]
    assert as_table({"classes": classes, "shares": SHARES}).splitlines() == [
        "class      drives  situations     what happens",
        "class_4    1 of 2      6  60.0 %  what 4 is",
        "class_4_8  1 of 1      4  40.0 %  4 and 8 together",
        "",
        "where  drives  situations",
        "main   2 of 2      9  90.0 %",
        "merge  0 of 1      1  10.0 %",
    ]


def test_without_shares_there_are_none() -> None:
    table = as_table({"classes": [one([4], None, None)], "shares": None})
    assert table.splitlines() == ["class    drives  what happens", "class_4  1 of 1  what 4 is"]


@pytest.mark.parametrize("shares", [SHARES, None])
def test_the_picture(shares: dict[str, Any] | None) -> None:
    pytest.importorskip("matplotlib")
    drawn = draw_classes({"classes": [one([4], None, 6), one([4, 8], None, 4)], "shares": shares}, "Classes")
    assert drawn["png"].startswith(b"\x89PNG")
    assert b"scenario 8" in drawn["svg"] or drawn["svg"].count(b"<text") == 0
