"""Tables, text and figures of an evaluation: the numbers are those of the totals, the paper's are marked."""

import re
from collections import Counter
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest

from report.edges import cut_off
from roadproof.errors import InputError
from roadproof.frontends.report.answers import answer_questions
from roadproof.frontends.report.paper import MARK
from roadproof.frontends.report.tables import Table
from roadproof.frontends.report.traffic import Share, comparison_table, decimal, percent, results_tables
from roadproof.frontends.report.traffic_figures import compose_figures, draw_figures
from roadproof.frontends.report.write_traffic import write_report
from roadproof.library.scenarios import COMPARISON
from roadproof.recordings.evaluate.questions import Settings, default_settings
from roadproof.recordings.evaluate.totals import Totals, begin_totals


def settings(**changes: object) -> Settings:
    return replace(default_settings(), detectors=COMPARISON, **changes)  # type: ignore[arg-type]


def the_table(totals: Totals, *failed: dict[str, str]) -> Table:
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
    made = dict(draw_figures(totals))
    assert list(made) == ["recall", "scenarios", "overlaps"]
    for formats in made.values():
        assert formats["png"].startswith(b"\x89PNG")
        assert b"<svg" in formats["svg"]
    again = dict(draw_figures(totals))
    assert again == made


def test_figures_name_scenarios_and_count_in_whole_numbers(totals: Totals) -> None:
    for row in totals.rows:
        row.scenarios = Counter({1: 1, 4: 2})
    figures = dict(compose_figures(totals))
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
