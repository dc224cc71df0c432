"""Explorations as text and pictures, from plain data."""

from typing import Any

from roadproof.report.explore import as_text, draw_exploration, show


def finding(at: str, verdict: str, reason: str = "", number: int | None = None) -> dict[str, Any]:
    return {"at": at.split(), "verdict": verdict, "formula": "p", "reason": reason, "number": number}


def exploration(**changed: Any) -> dict[str, Any]:
    values = [
        finding("0", "WITNESSED", number=1),
        finding("1", "WITNESSED", number=1),
        finding("2", "UNKNOWN", "no time"),
        finding("3", "NONE-WITHIN", "no drive on main-2"),
    ]
    bracket = {"held": finding("3/2", "WITNESSED"), "missed": values[2], "surely": values[3]}
    data = {
        "scenario": 4,
        "set": "base",
        "formula": "p",
        "vary": [{"name": "minSafe", "unit": "s", "low": "0", "high": "3"}],
        "values": values,
        "boundaries": [bracket],
        "extremes": [],
        "searches": 5,
        "drives": 1,
        "seconds": 1.5,
    }
    return data | changed


def test_a_strip_and_both_sides_of_its_boundary() -> None:
    assert as_text(exploration()).splitlines() == [
        "scenario 4, set base",
        "  minSafe  0 ##?- 3 s",
        "  # WITNESSED: a drive, judged at this value, at 2 of 4 values",
        "  - NONE-WITHIN: none within the limits that are printed, at 1 of 4 values [1]",
        "  ? UNKNOWN: not decided, at 1 of 4 values [2]",
        "  least minSafe with a drive: 0 s, the end of the range",
        "  greatest minSafe with a drive: 1.5 s; at 2 s UNKNOWN [2], at 3 s NONE-WITHIN [1]",
        "  [1] no drive on main-2",
        "  [2] no time",
        "  4 values, 5 searches, 1 drives in 1.5 s",
    ]


def test_a_gap_inside_is_said() -> None:
    values = [finding(str(k), "UNKNOWN" if k == 1 else "WITNESSED", "r" if k == 1 else "") for k in range(3)]
    boundaries = [
        {"held": values[0], "missed": values[1], "surely": None},
        {"held": values[2], "missed": values[1], "surely": None},
    ]
    text = as_text(exploration(values=values, boundaries=boundaries))
    assert "a gap beside 0 s; at 1 s UNKNOWN [1]" in text
    assert "a gap beside 2 s; at 1 s UNKNOWN [1]" in text


def test_of_many_reasons_only_some_are_printed() -> None:
    values = [finding(str(k), "UNKNOWN", f"reason {k}") for k in range(5)]
    text = as_text(exploration(values=values, boundaries=[]))
    assert "at 5 of 5 values [1] [2] and 3 more" in text
    assert "reason 2" not in text


def test_a_map_has_the_first_knob_across() -> None:
    vary = [{"name": name, "unit": "s", "low": "0", "high": "1"} for name in ("a", "b")]
    signs = {"0 0": "WITNESSED", "0 1": "UNKNOWN", "1 0": "IMPOSSIBLE", "1 1": "NONE-WITHIN"}
    values = [finding(at, verdict, verdict) for at, verdict in signs.items()]
    data = exploration(vary=vary, values=values, boundaries=[])
    lines = as_text(data).splitlines()
    assert lines[1:5] == ["  b (s)", "  1 | ? -", "  0 | # .", "      0 … 1  a (s)"]
    assert draw_exploration(data)["png"].startswith(b"\x89PNG")


def test_extremes_name_both_sides() -> None:
    best, missed = finding("41/1000", "WITNESSED"), finding("0", "IMPOSSIBLE", "proved")
    extreme = {"sense": "least", "measure": "v", "when": "", "unit": "m/s", "point": []}
    extreme |= {"best": best, "missed": missed, "surely": missed, "endless": False, "searches": 3}
    plain = exploration(vary=[], values=[], boundaries=[], extremes=[extreme])
    assert "  least v at the start: 0.041 m/s on a judged drive; at 0 m/s IMPOSSIBLE [1]" in as_text(plain)
    nothing = exploration(vary=[], values=[], boundaries=[], extremes=[extreme | {"best": None}])
    assert "  least v at the start: no drive: IMPOSSIBLE [1]" in as_text(nothing)
    endless = [extreme | {"endless": True, "missed": None, "surely": None}]
    assert "no end; the judged drive goes past 0.041 m/s" in as_text(exploration(extremes=endless))


def test_pictures_of_strips_with_and_without_measures() -> None:
    best, missed = finding("2", "WITNESSED"), finding("1", "UNKNOWN", "r")
    extreme = {"sense": "least", "measure": "v", "when": "", "unit": "m/s", "best": best, "missed": missed}
    extremes = [extreme | {"point": [at], "surely": None, "endless": False} for at in ("0", "1")]
    for data in (exploration(), exploration(extremes=extremes)):
        made = draw_exploration(data)
        assert made["png"].startswith(b"\x89PNG")
        assert b"<svg" in made["svg"]


def test_values_are_shown_in_decimals() -> None:
    assert [show("3/5"), show("1/3"), show("2")] == ["0.6", "0.333333", "2"]
