"""Pictures as a whole: nothing is cut off at their edges, and the same picture is the same file."""

import csv
import io
import random
import re
from collections import Counter
from dataclasses import replace
from fractions import Fraction
from fractions import Fraction as F
from pathlib import Path
from typing import Any

import pytest
from matplotlib.text import Text

from extensions.pages.report.edges import cut_off
from roadproof.engines.setting import Search
from roadproof.errors import InputError
from roadproof.extensions.surveys.classify.cells import Cell
from roadproof.extensions.surveys.classify.classes import Class
from roadproof.extensions.surveys.classify.data import UndecidedPart
from roadproof.extensions.surveys.classify.drives import ClassExample
from roadproof.extensions.surveys.classify.question import ClassesView
from roadproof.extensions.surveys.classify.traffic_shares import Shares
from roadproof.extensions.surveys.explore.explorable import Explorable, SweepVariable
from roadproof.extensions.surveys.explore.values import ExplorationResult, SweepBoundary
from roadproof.extensions.surveys.extremes.extreme import Extreme
from roadproof.extensions.surveys.extremes.measure import read_measure
from roadproof.extensions.surveys.extremes.points import PointFinding
from roadproof.extensions.surveys.report.classify import as_table, draw_classes, summary
from roadproof.extensions.surveys.report.explore import as_text, draw_exploration, show
from roadproof.extensions.traffic.evaluate.questions import EvaluationSettings, default_settings
from roadproof.extensions.traffic.evaluate.totals import Totals, begin_totals
from roadproof.extensions.traffic.report.figures import draw_figures, write_report
from roadproof.extensions.traffic.report.research_questions import answer_questions
from roadproof.extensions.traffic.report.tables import LOOKS, ReportTable, as_csv, as_latex, as_markdown
from roadproof.extensions.traffic.report.tables import as_text as table_text
from roadproof.extensions.traffic.report.traffic import (
    COMPARISON,
    MARK,
    RESULTS,
    VIOLATING_PAIRS,
    Share,
    comparison_table,
    decimal,
    percent,
    results_tables,
)
from roadproof.extensions.traffic.scenario_parts import COMPARISON as DETECTORS
from roadproof.frontends.report.figures import (
    as_bytes,
    count_axis,
    fix_layout,
    legend_beside,
    make_figure,
    name_rows,
)
from roadproof.library.loading import bundled_library
from roadproof.library.scenario_references import read_query
from roadproof.library.words import Words
from roadproof.verdict import Verdict


def an_example() -> Any:
    figure, axes = make_figure([2.0, 1.0], 6.0)
    axes[0].plot([0, 1], [0, 3], label="a line with a long name")
    legend_beside(axes[0])
    count_axis(axes[0].yaxis)
    name_rows(axes[1], ["first", "  a name that is moved in and rather long"])
    figure.suptitle("a title\non two lines")
    return figure


def test_nothing_is_cut_off() -> None:
    assert cut_off(an_example()) == []


def test_what_is_cut_off_is_noticed() -> None:
    figure = an_example()
    fix_layout(figure)
    figure.axes[0].text(0.9, 1, "far too long for what is left " * 3)
    assert cut_off(figure) == ["far too long for what is left " * 3]


def test_counts_have_whole_ticks() -> None:
    [axes, _] = an_example().axes
    assert [*axes.get_yticks()] == [int(x) for x in axes.get_yticks()]


def test_the_same_picture_is_the_same_file() -> None:
    assert as_bytes(an_example()) == as_bytes(an_example())


# --- The table and the picture of classes, on made-up answers ---------------------------------------

WORDS = {4: Words(4, "slow ahead", "main road"), 8: Words(8, "slow ahead, leaving", "main road")}


def one(happens: tuple[int, ...], place: str | None, verdict: Verdict = Verdict.WITNESSED) -> ClassExample:
    what = "_".join(map(str, happens))
    name = f"class_{what}" if place is None else f"class_{what}_{place}"
    cell = Cell(happens, happens, ())
    reason = "" if verdict is Verdict.WITNESSED else "none was found"
    return ClassExample(
        Class(name, ("SV", "POV"), happens, cell, None, place, f"what {what} is"),
        verdict=verdict,
        reason=reason,
    )


def shares_of(**situations: int) -> Shares:
    return Shares(["01"], 20, 8, Counter(situations), classified=Counter({2: 10}), source="roads")


def test_places_are_added_up() -> None:
    examples = [one((4,), "main"), one((4,), "merge", Verdict.UNKNOWN), one((4, 8), "main")]
    shares = shares_of(class_4_main=5, class_4_merge=1, class_4_8_main=4)
    assert as_table(examples, shares, WORDS).splitlines() == [
        "class      drives  situations     what happens",
        "class_4    1 of 2      6  60.0 %  slow ahead: what 4 is",
        "class_4_8  1 of 1      4  40.0 %  4 and 8 together",
        "  8: slow ahead, leaving",
        "",
        "where  drives  situations",
        "main   2 of 2      9  90.0 %",
        "merge  0 of 1      1  10.0 %",
    ]


def test_without_shares_there_are_none() -> None:
    table = as_table([one((4,), None)], None, WORDS)
    assert table.splitlines() == ["class    drives  what happens", "class_4  1 of 1  slow ahead: what 4 is"]


def test_doubts_are_told_and_traces_that_are_shown_twice() -> None:
    shares = shares_of(class_4=10)
    shares.repeated = 5
    doubts = (UndecidedPart(about="what there is", reason="lost"),)
    found = ClassesView((one((4,), None, Verdict.UNKNOWN),), (), doubts=doubts)
    assert [*summary(found, shares)] == [
        "1 class: 1 UNKNOWN",
        "  UNKNOWN: what there is: lost",
        "  UNKNOWN: class_4: none was found",
        "on roads: 20 traces, 12 (60.0 %) in none of these scenarios",
        "5 of 25 traces are shown by an earlier recording too, so they are left out",
        "10 situations with a scenario, each in exactly one class, which names its scenarios",
    ]


@pytest.mark.parametrize("doubt", [Verdict.WITNESSED, Verdict.UNKNOWN])
@pytest.mark.parametrize("shares", [shares_of(class_4=1, class_4_8=2), None])
def test_the_picture_names_scenarios_and_colours_and_counts_in_whole_numbers(
    shares: Shares | None, doubt: Verdict
) -> None:
    pytest.importorskip("matplotlib")
    figure = draw_classes([one((4,), None), one((4, 8), None, doubt)], shares, "Classes", WORDS)
    assert cut_off(figure) == []
    *bars, dots = figure.axes
    assert [x.get_text() for x in dots.get_yticklabels()] == ["4 slow ahead", "8 slow ahead, leaving"]
    legend = [x.get_text() for x in dots.get_legend().get_texts()]
    doubtful = ["the same, no drive found"] * (doubt is Verdict.UNKNOWN)
    assert legend == ["holds in the class", *doubtful, "does not hold"]
    assert all(tick == int(tick) for one in bars for tick in one.get_yticks())
    assert len(bars) == (shares is not None)


# --- Explorations as text and pictures --------------------------------------------------------------

BASE = bundled_library().select("base")
QUERY = read_query(BASE, "4")[1]
KNOB = SweepVariable("minSafe", "s", F(0), F(3))
ASKED = Explorable(Search(BASE, QUERY, scenario=4), (KNOB,), 4)
MEASURE = read_measure(BASE, "least", "v_lon(SV)")


def finding(at: str, verdict: Verdict, reason: str = "", number: int | None = None) -> PointFinding:
    return PointFinding(tuple(map(F, at.split())), QUERY, verdict=verdict, reason=reason, number=number)


def exploration(**changed: Any) -> ExplorationResult:
    values = (
        finding("0", Verdict.WITNESSED, number=1),
        finding("1", Verdict.WITNESSED, number=1),
        finding("2", Verdict.UNKNOWN, "no time"),
        finding("3", Verdict.NONE_WITHIN, "no drive on main-2"),
    )
    bracket = SweepBoundary(finding("3/2", Verdict.WITNESSED), values[2], values[3])
    return replace(ExplorationResult(values, (bracket,), (), 5, 1), **changed)


def test_a_strip_and_both_sides_of_its_boundary() -> None:
    assert as_text(ASKED, exploration(), 1.5).splitlines() == [
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
    boundaries = tuple(SweepBoundary(x, missed, None) for x in (values[0], values[2]))
    text = as_text(ASKED, exploration(findings=values, boundaries=boundaries))
    assert "a gap beside 0 s; at 1 s UNKNOWN [1]" in text
    assert "a gap beside 2 s; at 1 s UNKNOWN [1]" in text


def test_of_many_reasons_only_some_are_printed() -> None:
    values = tuple(finding(str(k), Verdict.UNKNOWN, f"reason {k}") for k in range(5))
    text = as_text(ASKED, exploration(findings=values, boundaries=()))
    assert "at 5 of 5 values [1] [2] and 3 more" in text
    assert "reason 2" not in text


def test_a_map_has_the_first_variable_across() -> None:
    variables = tuple(SweepVariable(name, "s", F(0), F(1)) for name in ("a", "b"))
    verdicts = {"0 0": "WITNESSED", "0 1": "UNKNOWN", "1 0": "IMPOSSIBLE", "1 1": "NONE-WITHIN"}
    values = tuple(finding(at, Verdict(verdict), verdict) for at, verdict in verdicts.items())
    asked, explored = (
        replace(ASKED, variables=variables, steps=2),
        exploration(findings=values, boundaries=()),
    )
    lines = as_text(asked, explored).splitlines()
    assert lines[1:5] == ["  b (s)", "  1 | ? -", "  0 | # .", "      0 … 1  a (s)"]
    assert as_bytes(draw_exploration(asked, explored))["png"].startswith(b"\x89PNG")


def test_extremes_name_both_sides() -> None:
    best, missed = finding("41/1000", Verdict.WITNESSED), finding("0", Verdict.IMPOSSIBLE, "proved")
    extreme = Extreme(MEASURE, (), best, missed, missed, 3)

    def told(extreme: Extreme) -> str:
        return as_text(replace(ASKED, variables=()), ExplorationResult(extremes=(extreme,)))

    text = "  least v_lon(SV) at the start: 0.041 m/s on a judged drive; at 0 m/s IMPOSSIBLE [1]"
    assert text in told(extreme)
    nothing = replace(extreme, best=None, outside=replace(missed, at=()))
    assert "  least v_lon(SV) at the start: no drive: IMPOSSIBLE [1]" in told(nothing)
    endless = replace(extreme, endless=True, outside=None, excluded=None)
    assert "no end; the judged drive goes past 0.041 m/s" in told(endless)


def test_pictures_of_strips_with_and_without_measures() -> None:
    best, missed = finding("2", Verdict.WITNESSED), finding("1", Verdict.UNKNOWN, "r")
    extremes = tuple(Extreme(MEASURE, (F(at),), best, missed, None, 1) for at in (0, 1))
    for explored in (exploration(), exploration(extremes=extremes)):
        made = as_bytes(draw_exploration(ASKED, explored))
        assert made["png"].startswith(b"\x89PNG")
        assert b"<svg" in made["svg"]


def drawn_words(figure: Any) -> list[str]:
    """The words of a figure; none is cut off."""
    figure.draw_without_rendering()
    shown = [x for x in figure.findobj(Text) if x.get_visible() and x.get_text().strip()]
    for x in shown:
        box = x.get_window_extent()
        if x.axes is None or x.axes.axison or "legend" in type(x.axes).__name__.lower():
            assert box.x0 >= -1, x
            assert box.x1 <= figure.bbox.width + 1, x
    for axes in figure.axes:
        if (legend := axes.get_legend()) is not None:
            assert legend.get_window_extent().x1 <= figure.bbox.width
            assert legend.get_window_extent().y0 >= 0
    return [x.get_text() for x in shown]


def test_nothing_is_shaded_between_values_with_different_verdicts() -> None:
    rng = random.Random(4)
    verdicts = (Verdict.WITNESSED, Verdict.UNKNOWN, Verdict.NONE_WITHIN)
    for _ in range(20):
        values = tuple(finding(str(k), rng.choice(verdicts), "r") for k in range(6))
        explored = exploration(findings=values, boundaries=())
        figure = draw_exploration(ASKED, explored)
        strip = next(x for x in figure.axes if x.get_xlabel())
        spans = [(min(x.get_xy()[:, 0]), max(x.get_xy()[:, 0])) for x in strip.patches if x.get_alpha()]
        same = [k for k in range(5) if values[k].verdict is values[k + 1].verdict]
        assert sorted(spans) == [(k, k + 1) for k in same]
        words = drawn_words(figure)
        assert "pale: between decided values with the same verdict" in words
        for verdict in {x.verdict for x in values}:
            assert any(x.startswith(f"{verdict}: ") for x in words)


def test_titles_and_legends_of_maps_are_whole_and_axes_have_units() -> None:
    variables = tuple(SweepVariable(name, unit, F(0), F(1)) for name, unit in (("a", "s"), ("b", "unitless")))
    for verdict in (Verdict.WITNESSED, Verdict.IMPOSSIBLE):
        values = tuple(finding(f"{x} {y}", verdict, "r") for x in range(2) for y in range(2))
        asked = replace(ASKED, variables=variables, steps=2)
        words = drawn_words(draw_exploration(asked, exploration(findings=values, boundaries=())))
        assert "b [no unit]" in words
        assert any(x.startswith("a [s]") for x in words)
        assert any(x.startswith(f"{verdict}: ") for x in words)


def test_values_are_shown_in_decimals() -> None:
    assert [show(F(x)) for x in ("3/5", "1/3", "2")] == ["0.6", "0.333333", "2"]


# --- One table in four looks, each read back --------------------------------------------------------

TABLE = ReportTable(
    "Counts & shares_of A",
    ("name", "count", "share"),
    (("a|b", "7", "50.0%"), ("long name", "1234", "-")),
    ("A note with 100% of it.",),
)


def test_text_is_aligned() -> None:
    lines = table_text(TABLE).splitlines()
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
        ReportTable("t", ("a", "b"), (("1",),))


@pytest.mark.parametrize("ending", list(LOOKS))
def test_empty_tables(ending: str) -> None:
    assert "name" in LOOKS[ending](ReportTable("t", ("name",), ()))


# --- The paper's figures are consistent in themselves and with the facts that must hold (semantics §6)


def test_recall_is_matching_by_traces() -> None:
    for row in RESULTS.values():
        assert percent(row.matching, row.traces) == row.recall


def test_sets_grow_and_three_equals_four_in_base() -> None:
    for danger in (Fraction(0), Fraction(3, 5)):
        base, middle, ext = (RESULTS[danger, name] for name in ("base", "extA", "ext"))
        assert base.scenarios[3] == base.scenarios[4]
        for i in base.scenarios:
            assert base.scenarios[i] <= middle.scenarios[i] <= ext.scenarios[i]
        assert base.matching < middle.matching < ext.matching


def test_comparison_repeats_the_results() -> None:
    ext = RESULTS[Fraction(0), "ext"]
    assert COMPARISON["cut-in"]["RSS"] == ext.scenarios[1] == 9364
    assert COMPARISON["deceleration"]["RSS"] == ext.scenarios[4] == 26008


def test_recall_without_the_filter_is_a_quarter() -> None:
    assert percent(RESULTS[Fraction(0), "base"].matching, VIOLATING_PAIRS) == "24.1%"


# --- Tables, text and figures of an evaluation: the numbers are those of the totals, the paper's are marked


def settings(**changes: object) -> EvaluationSettings:
    return replace(default_settings(), detectors=DETECTORS, **changes)  # type: ignore[arg-type]


def the_table(totals: Totals, *failed: dict[str, str]) -> ReportTable:
    """The only one."""
    (table,) = results_tables(totals, *failed).values()
    return table


@pytest.fixture
def totals() -> Totals:
    made = begin_totals(settings())
    made.recordings, made.vehicles, made.samples, made.violating = 2, 300, 9000, 80
    made.traces = Counter({0: 60, 1: 50})
    made.asked, made.undecided, made.differing = 600, 12, 3
    for k, row in enumerate(made.rows):
        row.traces, row.matching, row.matching_with_three, row.several = 40, 10 + k, 12 + k, 4
        row.scenarios = Counter({1: 5 + k, 3: 6, 4: 6, 2: 2})
        row.together = Counter({(3, 4): 6, (1, 3): 1})
        danger = made.settings.min_danger.index(row.min_danger)
        made.matching[danger, row.set_name] = 20 + k
        made.matching_violating[danger, row.set_name] = 8 + k
    made.detected = Counter({"cutIn_ttc": 11, "cutIn_thw": 22, "cutIn_free": 33, "decel_thw": 44})
    return made


def test_results_table_has_ours_and_the_papers(totals: Totals) -> None:
    table = the_table(totals)
    assert len(table.rows) == 12
    ours, paper = table.rows[4], table.rows[5]
    assert ours[:6] == ("0", "ext", "here", "40", "12", "30.0%")
    assert dict(zip(table.columns, ours, strict=True))["s1"] == "7"
    assert paper[:6] == ("0", "ext", "paper*", "32398", "31139", "96.1%")
    assert dict(zip(table.columns, paper, strict=True))["s2"] == "-"
    assert any(MARK in note for note in table.notes)
    assert any("12 of 600 answers undecided, 3 would be" in note for note in table.notes)


def test_other_parameters_have_no_row_of_the_paper() -> None:
    table = the_table(begin_totals(settings(min_danger=(Fraction(1),), sets=("base",))))
    assert [row[:6] for row in table.rows] == [("1", "base", "here", "0", "0", "-")]


def test_comparison_table(totals: Totals) -> None:
    table = comparison_table(totals)
    assert table is not None
    assert table.rows == (
        ("cut-in", "here", "11", "22", "33", "7"),
        ("cut-in", "paper*", "144", "7219", "1017", "9364"),
        ("deceleration", "here", "0", "44", "0", "6"),
        ("deceleration", "paper*", "22", "112", "26846", "26008"),
    )
    assert any("hardBraking = 3" in note for note in table.notes)


@pytest.mark.parametrize("changes", [{"detectors": ()}, {"sets": ("base",)}, {"scenarios": (1, 3)}])
def test_no_comparison_without_its_parts(changes: dict[str, object]) -> None:
    assert comparison_table(begin_totals(replace(settings(), **changes))) is None  # type: ignore[arg-type]


def test_left_out_recordings_are_a_warning(totals: Totals) -> None:
    failed = {"07": "broken"}
    table = comparison_table(totals, failed)
    assert table is not None
    for notes in (the_table(totals, failed).notes, table.notes):
        assert "WARNING: 1 recordings could not be used and are left out: 07." in notes
    assert "WARNING: 1 recordings" in answer_questions(totals, failed)
    assert "WARNING" not in answer_questions(totals)


def test_answers_come_from_the_numbers(totals: Totals) -> None:
    text = answer_questions(totals)
    assert "ext 30.0% [96.1%] (12 of 40 traces on the main road)" in text
    assert "28 of 40 traces on the main road match no scenario of ext with two vehicles." in text
    assert "4 of 14 traces that match a scenario of the main road match several; 3-4 6, 1-3 1." in text
    assert (
        "minDanger 0, base: 10.0% [24.1%; around 25%] (8 of 80 violating pairs in all road sectors) " in text
    )
    shares = ("0: 25.0% (10 of 40 traces on the main road)", "0.6: 32.5% (13 of 40 traces on the main road)")
    assert f"base: {', '.join(shares)}; 7.5 points between them." in text
    assert (
        "cut-in: TTC 11 [144], THW 22 [7219], none 33 [1017]; scenario 1 of ext (cut-in, lane keep) 7" in text
    )
    assert "Scenarios: 1 cut-in, lane keep; 2 cut-out, lane keep; 3 " in text
    assert "no violation" in text


def test_violations_and_unequal_pairs_are_listed(totals: Totals) -> None:
    totals.broken.append("recording 01, minDanger 0, base: (1, 5) matches but is no disturbance")
    totals.unequal_3_4 += [("01", 3, 9, "0"), ("01", 3, 9, "3/5")]
    text = answer_questions(totals)
    assert "1 violations: CROSSCHECK-FAILED" in text
    assert "(1, 5) matches but is no disturbance" in text
    assert "1 matches lie outside the disturbance traces, which must not be" in text
    assert "1 pairs match only one of scenarios 3 and 4" in text
    assert "recording 01, vehicles 3 and 9, minDanger 0.6" in text


def test_nothing_found_is_said() -> None:
    text = answer_questions(begin_totals(settings()))
    assert "these recordings cannot tell" in text
    assert "Too few traces to tell." in text


def test_figures(totals: Totals) -> None:
    made = {name: as_bytes(figure) for name, figure in draw_figures(totals)}
    assert list(made) == ["recall", "scenarios", "overlaps"]
    for formats in made.values():
        assert formats["png"].startswith(b"\x89PNG")
        assert b"<svg" in formats["svg"]
    again = {name: as_bytes(figure) for name, figure in draw_figures(totals)}
    assert again == made


def test_figures_name_scenarios_and_count_in_whole_numbers(totals: Totals) -> None:
    for row in totals.rows:
        row.scenarios = Counter({1: 1, 4: 2})
    figures = dict(draw_figures(totals))
    [bars] = figures["scenarios"].axes
    assert bars.get_xticklabels()[3].get_text() == "s4\ndeceleration\nahead, lane\nkeep"
    assert all(tick == int(tick) for tick in bars.get_yticks())
    assert len(bars.get_legend().get_texts()) == len(totals.rows)
    [recall] = figures["recall"].axes
    assert recall.get_legend().get_texts()[0].get_text() == "these recordings"
    assert [cut_off(figure) for figure in figures.values()] == [[], [], []]
    matrices = figures["overlaps"].axes
    assert [x.get_text() for x in matrices[0].get_yticklabels()][3] == "s4  deceleration ahead, lane keep"
    assert len(matrices[0].texts) == 8 * 9 / 2
    assert matrices[0].get_legend().get_texts()[-1].get_text() == "100 % of the rarer one"


def test_columns_of_the_results_table_are_named(totals: Totals) -> None:
    notes = the_table(totals).notes
    assert notes[0] == "s1 cut-in, lane keep; s2 cut-out, lane keep; s3 acceleration behind, lane keep"
    assert sum(note.count("; s") + 1 for note in notes if re.match(r"s\d", note)) == 8


def test_report_files(totals: Totals, tmp_path: Path) -> None:
    write_report(tmp_path, totals, {})
    names = {str(p.relative_to(tmp_path)) for p in tmp_path.rglob("*") if p.is_file()}
    tables = {f"{x}.{e}" for x in ("results", "comparison") for e in ("txt", "md", "csv", "tex")}
    figures = {f"figures/{x}.{e}" for x in ("recall", "scenarios", "overlaps") for e in ("png", "svg")}
    assert names == tables | figures | {"answers.md"}
    totals.settings = replace(totals.settings, detectors=())
    write_report(tmp_path, totals, {}, pictures=False)
    assert not (tmp_path / "comparison.txt").exists()


def test_unwritable(totals: Totals, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="cannot write"):
        write_report(tmp_path / "file", totals, {})


def test_half_a_file_is_never_seen(totals: Totals, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def fails(source: str, target: Path) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("roadproof.runtime.files.os.replace", fails)
    with pytest.raises(KeyboardInterrupt):
        write_report(tmp_path, totals, {})
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("part", "whole", "population"), [(1, 2, ""), (1, 2, " "), (3, 2, "x"), (-1, 2, "x")]
)
def test_a_share_names_a_population_and_is_a_part_of_it(part: int, whole: int, population: str) -> None:
    with pytest.raises(ValueError, match=r"population|is no part of"):
        Share(part, whole, population)


def test_numbers_as_text() -> None:
    assert [decimal(Fraction(x)) for x in ("0", "3/5", "1/3")] == ["0", "0.6", "1/3"]
    assert percent(0, 0) == "-"
