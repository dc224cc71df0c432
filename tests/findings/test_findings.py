"""The documents say what comes out: their quick statements here, all of them in `make findings`."""

import json
from pathlib import Path

import pytest

from console import agree, cut_alike
from documents.drawings import DRAWINGS
from findings import checking
from findings import readings as r
from findings.checking import check_statement
from findings.figures import Difference, Figures, Outcome, Statement, commands_named, compare, covered
from findings.results import ROOT, Results
from findings.statements import PICTURES, STATEMENTS

QUICK = [statement for statement in STATEMENTS if statement.quick]
PAGES = ("docs/explanation/findings.md", "docs/data/findings/values.csv", "docs/explanation/us101.md")


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> Results:
    return Results(tmp_path_factory.mktemp("findings"))


@pytest.mark.parametrize("statement", QUICK, ids=lambda s: s.commands[-1])
def test_a_page_says_what_comes_out(statement: Statement, results: Results) -> None:
    assert [str(x) for x in check_statement(statement, results, update=False)] == []


@pytest.mark.parametrize("statement", STATEMENTS, ids=lambda s: f"{s.page}-{s.commands[-1]}")
def test_every_figure_is_on_its_page_once(statement: Statement) -> None:
    page = ROOT.joinpath(statement.page).read_text("utf-8")
    assert f"`{statement.named or statement.commands[-1]}`" in page
    if statement.data:
        assert f"/{Path(statement.data).name})" in page
        page = ROOT.joinpath(statement.data).read_text("utf-8")
    for figures in statement.figures:
        assert len(covered(figures, page)) == figures.said.count("{}"), figures.said
        assert compare_without_output(figures, page) == [], figures.said


def compare_without_output(figures: Figures, page: str) -> list[Difference]:
    quoted = Figures(figures.said, lambda _: ("?",) * figures.said.count("{}"))
    return [d for d in compare(quoted, page, Outcome("", 0, Path())) if not d.mendable]


@pytest.mark.parametrize("name", PAGES)
def test_every_command_of_a_page_is_run(name: str) -> None:
    run = {command for statement in STATEMENTS for command in statement.commands}
    named = commands_named(ROOT.joinpath(name).read_text("utf-8"))
    assert named
    assert [command for command in named if command not in run and "DIR" not in command] == []


BY_HAND = {"report.png", "studio.png", "studio-compare.png", "studio-explain.png", "trust.svg", *DRAWINGS}
"""Pictures of a browser's window, and drawings."""


def test_pictures_are_those_of_pages() -> None:
    pages = "".join(path.read_text("utf-8") for path in (ROOT / "README.md", *ROOT.glob("docs/**/*.md")))
    pictures = {path.name for kind in ("png", "svg") for path in ROOT.glob(f"docs/pictures/*.{kind}")}
    assert {Path(picture.file).name for picture in PICTURES} == pictures - BY_HAND
    assert all(f"pictures/{name})" in pages for name in pictures)


PAGE = "Of the 1,236 changes two are odd, others are not: 1-5, 3-6 and 4-8. `echo said` (exit 3)\n"


def differences(said: str, source: str, printed: str) -> list[tuple[str, str]]:
    return [(d.said, d.found) for d in compare(Figures(said, source), PAGE, Outcome(printed, 0, Path()))]


def test_a_figure_that_is_the_same_in_another_hand_agrees() -> None:
    assert differences("the {} changes {} are odd", "{} changes, {} odd", "1236 changes, 2 odd") == []
    assert differences("{} changes two", "{} changes", "- 1236 changes") == []
    assert differences("are not: {}. `echo", "left: {}\n", "left: 1-5, 3-6, 4-8\n") == []


def test_a_figure_that_differs_is_told_in_the_hand_of_the_page() -> None:
    found = differences("the {} changes {} are odd", "{} changes, {} odd", "1237 changes, 3 odd")
    assert found == [("1,236", "1,237"), ("two", "three")]


def test_what_the_page_or_the_output_does_not_have_differs() -> None:
    assert differences("of all {} things", "{} things", "3 things")
    assert differences("the {} changes", "{} things", "1236 changes")
    assert differences("the {} changes", "{} changes", "1236 changes, 1237 changes")
    assert differences("others are not", "others are not", "others are")
    assert differences("others are not", "others", "others are") == []


def test_a_page_is_put_right(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, results: Results) -> None:
    monkeypatch.setattr(checking, "ROOT", tmp_path)
    (tmp_path / "page.md").write_text(PAGE, "utf-8")
    statement = Statement("page.md", ("echo said",), (Figures("the {} changes", lambda _: 17),))
    wrong = check_statement(statement, results, update=True)
    assert [(x.line, x.said) for x in wrong] == [(1, "1,236"), (1, " (exit 3)")]
    assert (tmp_path / "page.md").read_text("utf-8") == PAGE.replace("1,236", "17").replace(" (exit 3)", "")
    assert check_statement(statement, results, update=False) == []


def test_a_run_that_was_broken_off_goes_on(tmp_path: Path) -> None:
    results, commands = Results(tmp_path), ("echo one >> log", "cat log; exit 5")
    folder = results.folder_of(commands)
    folder.mkdir(parents=True)
    folder.joinpath("work").mkdir()
    folder.joinpath("work/log").write_text("kept\n")
    folder.joinpath("1.json").write_text(json.dumps({"printed": "", "exit": 0}))
    assert not results.has(commands)
    assert (results.ask(commands).printed, results.ask(commands).exit) == ("kept\n", 5)
    assert results.has(commands)


def test_a_session_that_is_cut_says_so() -> None:
    assert agree(["a", "b", "c", "d"], ["a", "…", "d"])
    assert agree(["a", "d"], ["a", "…", "d"])
    assert agree(["took 3 s"], ["took …"])
    assert agree(["took 3 s, 4 found"], ["took … found"])
    assert not agree(["a", "b", "c"], ["a", "b"])
    assert not agree(["a", "b", "x"], ["a", "…", "c"])
    assert not agree(["a"], ["a", "…", "a"])


def test_a_session_that_is_put_right_stays_cut() -> None:
    printed = ["head", "1 new", "2", "3", "in 5 s"]
    assert cut_alike(printed, ["head", "1 old", "…", "in … s"]) == ["head", "1 new", "…", "in … s"]
    assert cut_alike(printed, ["…", "in … s"]) == ["…", "in … s"]
    assert cut_alike(["new"], ["old"]) == ["new"]


# --- Figures that are read from several lines of an output ------------------------------------------


def printed(text: str) -> Outcome:
    return Outcome(text, 0, Path())


MATRIX = """\
      1  3  9 11
   1     .  #  .
   3  .     .  #
   9  #  .     ?
  11  .  #  ?
  # WITNESSED: compatible: both hold on a judged drive
"""

CLASSES = """\
class        drives  situations     what happens
class_1      1 of 1     45  60.0 %  SV keeps its lane, POV cuts in
class_4_6_8  1 of 1     20  26.7 %  4, 6 and 8 together
class_1_5    1 of 1     10  13.3 %  1 and 5 together
class_5      1 of 1      0   0.0 %  SV changes lanes, POV cuts in
class_2      1 of 1      1 100.0 %  SV keeps its lane

5 classes: 5 WITNESSED
"""

EXPLORED = """\
scenario 1: cut-in, lane keep, main road, set base
  # WITNESSED: a drive, judged at this value, at 11 of 11 values
  greatest minSafe with a drive: 5.3 s; at 5.4 s UNKNOWN [2]
  11 values, 2 searches, 1 drive in 2.3 s
scenario 4: deceleration ahead, lane keep, main road, set base
  # WITNESSED: a drive, judged at this value, at 11 of 11 values
  greatest minSafe with a drive: 4.6 s; at 5.4 s UNKNOWN [2]
  11 values, 12 searches, 2 drives in 2.3 s
"""

MEASURED = """\
scenario 1: cut-in, lane keep, main road, set base
  least v_lon(SV) - v_lon(POV) at the start: -25 m/s on a judged drive; at -25.1 m/s NONE-WITHIN [1]
  greatest v_lon(SV) - v_lon(POV) at the start: 25 m/s on a judged drive; at 25.1 m/s NONE-WITHIN [1]
"""

ORDER = """\
1@base -> 1@ext
3@base -> 3@extA
9@base -> 9@ext
11@base -> 11@extA
one formula: 1@base, 1@extA
one formula: 6@base, 6@extA, 6@ext
one formula: 9@base, 9@extA
"""


def test_pairs_are_read_from_the_matrix() -> None:
    assert r.pairs_with(printed(MATRIX), "WITNESSED") == {(1, 9), (3, 11)}
    assert r.pairs_with(printed(MATRIX), "IMPOSSIBLE") == {(1, 3), (1, 11), (3, 9)}
    assert r.pairs_drives_proofs(printed(MATRIX)) == (5, 2, 3)


def test_classes_are_read_from_the_table() -> None:
    outcome = printed(CLASSES)
    assert r.happenings(outcome) == (4, "1, 5", "1 with 5, 4 with 6, 8")
    assert r.all_witnessed(outcome) == "5"
    doubtful = CLASSES.replace("5 WITNESSED", "4 WITNESSED, 1 UNKNOWN")
    assert r.all_witnessed(printed(doubtful)) == "5 classes: 4 WITNESSED, 1 UNKNOWN"


def test_a_set_is_read_from_its_answer() -> None:
    text = f"{CLASSES}10 situations with a scenario, each in exactly one\nOf 12 traces, 2 (17 %) in none\n"
    assert r.classes_of_set(printed(text)) == ("5", "10", "2")
    gaps = "of 52 classes 43 have a judged drive, 9 are proved empty, {} are undecided\n"
    gaps += "of 34 disturbances in traffic 20 are missed\n"
    assert r.gaps_of_set(printed(gaps.format(0))) == ("52", "43", "9", "20")
    with pytest.raises(AssertionError):
        r.gaps_of_set(printed(gaps.format(1)))


def test_boundaries_and_drives_are_those_of_each_scenario() -> None:
    assert r.boundaries(printed(EXPLORED)) == {1: "5.3", 4: "4.6"}
    assert r.drives_that_serve(printed(EXPLORED)) == (2, 11, "one or two")
    assert r.drives_that_serve(printed(EXPLORED.replace("at 11 of", "at 10 of", 1)))[1] == 0


def test_measures_are_those_of_each_scenario() -> None:
    assert r.measures(printed(MEASURED)) == {(1, "least"): "-25", (1, "greatest"): "25"}
    assert r.range_of_both(printed(MEASURED)) == ("25", "25")


def test_the_order_is_read_by_scenario() -> None:
    assert r.one_formula(printed(ORDER)) == ("1", "6")
    assert r.edges_of_a_sector(printed(ORDER)) == "2"


def test_evidence_is_accepted_where_all_of_it_is() -> None:
    assert r.accepted(printed("PROVED P1\n7 of 7 accepted by z3\n")) == "7"
    assert r.accepted(printed("6 of 7 accepted by z3\n")) == "6 of 7 accepted"
