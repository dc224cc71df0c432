"""Explorations as text and pictures."""

from dataclasses import replace
from fractions import Fraction as F
from typing import Any

from roadproof.analysis.explore.answer import Boundary, Explorable, ExplorationResult, Extreme, PointFinding
from roadproof.analysis.explore.knobs import Variable
from roadproof.analysis.explore.measure import read_measure
from roadproof.engines.search.ask import Search
from roadproof.frontends.report.explore import as_text, draw_exploration, show
from roadproof.library.loading import bundled_library
from roadproof.library.scenario_references import read_query
from roadproof.verdict import Verdict

BASE = bundled_library().select("base")
QUERY = read_query(BASE, "4")[1]
KNOB = Variable("minSafe", "s", F(0), F(3))
ASKED = Explorable(Search(BASE, QUERY, scenario=4), (KNOB,), 4)
MEASURE = read_measure(BASE, "least", "v_lon(SV)")


def finding(at: str, verdict: Verdict, reason: str = "", number: int | None = None) -> PointFinding:
    return PointFinding(tuple(map(F, at.split())), verdict, QUERY, reason, number=number)


def exploration(**changed: Any) -> ExplorationResult:
    values = (
        finding("0", Verdict.WITNESSED, number=1),
        finding("1", Verdict.WITNESSED, number=1),
        finding("2", Verdict.UNKNOWN, "no time"),
        finding("3", Verdict.NONE_WITHIN, "no drive on main-2"),
    )
    bracket = Boundary(finding("3/2", Verdict.WITNESSED), values[2], values[3])
    return replace(ExplorationResult(values, (bracket,), (), 5, 1, 1.5), **changed)


def test_a_strip_and_both_sides_of_its_boundary() -> None:
    assert as_text(ASKED, exploration()).splitlines() == [
        "scenario 4: deceleration ahead, lane keep, main road, set base",
        "  minSafe  0 ##?- 3 s",
        "  # WITNESSED: a drive, judged at this value, at 2 of 4 values",
        "  - NONE-WITHIN: no drive within the printed limits, at 1 of 4 values [1]",
        "  ? UNKNOWN: not decided, at 1 of 4 values [2]",
        "  least minSafe with a drive: 0 s, the end of the range",
        "  greatest minSafe with a drive: 1.5 s; at 2 s UNKNOWN [2], at 3 s NONE-WITHIN [1]",
        "  [1] no drive on main-2",
        "  [2] no time",
        "  4 values, 5 searches, 1 drives in 1.5 s",
    ]


def test_a_gap_inside_is_said() -> None:
    held, missed = Verdict.WITNESSED, finding("1", Verdict.UNKNOWN, "r")
    values = (finding("0", held), missed, finding("2", held))
    boundaries = tuple(Boundary(x, missed, None) for x in (values[0], values[2]))
    text = as_text(ASKED, exploration(findings=values, boundaries=boundaries))
    assert "a gap beside 0 s; at 1 s UNKNOWN [1]" in text
    assert "a gap beside 2 s; at 1 s UNKNOWN [1]" in text


def test_of_many_reasons_only_some_are_printed() -> None:
    values = tuple(finding(str(k), Verdict.UNKNOWN, f"reason {k}") for k in range(5))
    text = as_text(ASKED, exploration(findings=values, boundaries=()))
    assert "at 5 of 5 values [1] [2] and 3 more" in text
    assert "reason 2" not in text


def test_a_map_has_the_first_knob_across() -> None:
    knobs = tuple(Variable(name, "s", F(0), F(1)) for name in ("a", "b"))
    verdicts = {"0 0": "WITNESSED", "0 1": "UNKNOWN", "1 0": "IMPOSSIBLE", "1 1": "NONE-WITHIN"}
    values = tuple(finding(at, Verdict(verdict), verdict) for at, verdict in verdicts.items())
    asked, explored = replace(ASKED, knobs=knobs, steps=2), exploration(findings=values, boundaries=())
    lines = as_text(asked, explored).splitlines()
    assert lines[1:5] == ["  b (s)", "  1 | ? -", "  0 | # .", "      0 … 1  a (s)"]
    assert draw_exploration(asked, explored)["png"].startswith(b"\x89PNG")


def test_extremes_name_both_sides() -> None:
    best, missed = finding("41/1000", Verdict.WITNESSED), finding("0", Verdict.IMPOSSIBLE, "proved")
    extreme = Extreme(MEASURE, (), best, missed, missed, 3)

    def told(extreme: Extreme) -> str:
        return as_text(replace(ASKED, knobs=()), ExplorationResult(extremes=(extreme,)))

    text = "  least v_lon(SV) at the start: 0.041 m/s on a judged drive; at 0 m/s IMPOSSIBLE [1]"
    assert text in told(extreme)
    nothing = replace(extreme, best=None, missed=replace(missed, at=()))
    assert "  least v_lon(SV) at the start: no drive: IMPOSSIBLE [1]" in told(nothing)
    endless = replace(extreme, endless=True, missed=None, surely=None)
    assert "no end; the judged drive goes past 0.041 m/s" in told(endless)


def test_pictures_of_strips_with_and_without_measures() -> None:
    best, missed = finding("2", Verdict.WITNESSED), finding("1", Verdict.UNKNOWN, "r")
    extremes = tuple(Extreme(MEASURE, (F(at),), best, missed, None, 1) for at in (0, 1))
    for explored in (exploration(), exploration(extremes=extremes)):
        made = draw_exploration(ASKED, explored)
        assert made["png"].startswith(b"\x89PNG")
        assert b"<svg" in made["svg"]


def test_values_are_shown_in_decimals() -> None:
    assert [show(F(x)) for x in ("3/5", "1/3", "2")] == ["0.6", "0.333333", "2"]
