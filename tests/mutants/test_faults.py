"""The tool that makes small faults: what it makes, that a fault keeps its name, which tests it would run."""

import ast
from pathlib import Path

import pytest

from mutants import __main__ as program
from mutants import journal
from mutants.__main__ import ROOT, within
from mutants.by_hand import Fault, conditions, listed, plant, planted, read_results, write_results
from mutants.choose import FOLDERS, choose, faults_of, noticing_tests, targets
from mutants.edits import edits_of, is_fault
from mutants.places import places_of
from mutants.selection import Records
from mutants.spec_edits import spec_edits_of

PACKAGE = Path(__file__).parents[2] / "src/roadproof"
SMALL = '''
"""Not this: 1 < 2."""

def least(a: int, b: int, seen: list[int]) -> bool:
    """Nor this."""
    if a < b and not seen:
        return min(a, b) == seen[1:][0] - 1
    for x in seen:
        if x:
            continue
    raise ValueError(f"{a + 1}")
'''


def made(text: str = SMALL) -> set[tuple[str, str, str]]:
    return {(x.operator, x.before, x.after) for x in edits_of("small.py", text) if is_fault(x, text)}


@pytest.mark.parametrize(
    "fault",
    [
        ("strictness", "a < b", "(a <= b)"),
        ("direction", "a < b", "(a > b)"),
        ("and, or", "a < b and not seen", "(a < b or not seen)"),
        ("operand left out", "a < b and not seen", "(a < b)"),
        ("not dropped", "not seen", "(seen)"),
        ("condition constant", "a < b and not seen", "(True)"),
        ("return constant", "min(a, b) == seen[1:][0] - 1", "(False)"),
        ("opposite", "min(a, b) == seen[1:][0] - 1", "(min(a, b) != seen[1:][0] - 1)"),
        ("min, max, any, all", "min", "max"),
        ("slice end", "seen[1:]", "(seen[:])"),
        ("slice end", "seen[1:]", "(seen[1 + 1:])"),
        ("arithmetic", "seen[1:][0] - 1", "(seen[1:][0] + 1)"),
        ("constant", "0", "1"),
        ("constant", "1", "2"),
        ("continue to break", "continue", "break"),
    ],
)
def test_faults_of_python(fault: tuple[str, str, str]) -> None:
    assert fault in made()


def test_words_are_left_alone() -> None:
    assert not any("a + 1" in before or "1 < 2" in before for _, before, _ in made())


def test_a_verdict_becomes_another() -> None:
    assert ("verdict", "Verdict.PROVED", "Verdict.UNKNOWN") in made("x = Verdict.PROVED\n")
    assert ("constant", "'unsat'", "'unknown'") in made("x = 'unsat'\n")


def test_faults_of_definitions() -> None:
    text = 'def near(a, b: vehicle) "a < b" := s(a) <= s(b) and not F[0, minSafe] ahead(a, b) # a < b\n'
    faults = {(x.operator, x.before, x.after) for x in spec_edits_of("small.spec", text)}
    assert faults >= {
        ("sign", "<=", "<"),
        ("sign", "<=", ">="),
        ("word", "and", "or"),
        ("word", "not", ""),
        ("word", "F", "G"),
        ("word", "minSafe", "minDanger"),
        ("number", "0", "1"),
        ("window left out", "F[0, minSafe]", "F"),
        ("arguments swapped", "ahead(a, b)", "ahead(b, a)"),
    }
    assert not any(before == "<" for _, before, _ in faults)


def test_a_fault_keeps_its_name_when_the_file_grows() -> None:
    before = {x.key for x in edits_of("small.py", SMALL)}
    grown = "import this\n\ndef other():\n    return 7\n" + SMALL
    after = {x.key for x in edits_of("small.py", grown)}
    assert len(before) == len(edits_of("small.py", SMALL))
    assert before < after


def test_every_fault_of_a_file_has_a_name_of_its_own() -> None:
    for file in ("semantics/exact/truth.py", "engines/solve/bounds.py", "library/sets/iso34502.spec"):
        faults = faults_of(PACKAGE, Path(file))
        assert len({x.key for x in faults}) == len(faults) > 50


def test_the_choice_follows_from_the_seed() -> None:
    few = [x.key for x in choose(PACKAGE, 60, 1, "semantics/exact/")]
    assert (
        few
        == [x.key for x in choose(PACKAGE, 60, 1, "semantics/exact/")]
        != [x.key for x in choose(PACKAGE, 60, 2, "semantics/exact/")]
    )
    folders = {noticing_tests(str(file)) or str(file.parent) for file in targets(PACKAGE)}
    assert folders == {*FOLDERS.values(), "library/sets"}


def test_folders_are_chosen_alone_or_together() -> None:
    one, other, both = (
        {x.key for x in choose(PACKAGE, 60, 1, y)}
        for y in ("semantics/exact/", "engines/encode/", "semantics/exact/,engines/encode/")
    )
    assert one
    assert other
    assert both == one | other


_FILES = ("kernel/test_a.py", "judge/test_b.py", "traffic/test_c.py")


def test_test_files_are_recorded_alone_or_together() -> None:
    paths = [ROOT / f"tests/{x}" for x in _FILES]
    assert within(paths, "tests/kernel/,tests/traffic/test_c") == [paths[0], paths[2]]
    assert within(paths, "") == paths


def test_tests_of_a_line_are_the_near_ones_and_then_the_fastest() -> None:
    text = (PACKAGE / "semantics/exact/truth.py").read_text("utf-8")
    fault = next(x for x in edits_of("semantics/exact/truth.py", text) if x.context.startswith("complement|"))
    place = ("semantics/exact/truth.py", places_of(ast.parse(text), text)[fault.lines[0]])
    near, far, slow, other = (f"tests/{x}.py::t" for x in ("judge/a", "prove/b", "judge/slow", "judge/other"))
    records = Records({near: 9.0, far: 0.1, slow: 99.0, other: 0.1})
    records.by_place[place] = {near, far, slow}
    records.by_function[place[0], "complement"] = {near, far, slow, other}
    assert records.tests_for(fault, PACKAGE) == [near, far]
    del records.by_place[place]
    assert records.tests_for(fault, PACKAGE) == [other, near, far]


def test_faults_by_hand_fit_the_code_and_name_their_tests() -> None:
    """Each text is there once, and its room has tests; a change of the code has to keep its faults."""
    faults = [*listed(), *(x for each in conditions() for x in each.faults if x.equivalent)]
    assert len(faults) == len({(x.file, x.before, x.after) for x in faults}) >= 600
    for fault in faults:
        _, wrong = planted(fault, PACKAGE)
        if fault.file.endswith(".py"):
            ast.parse(wrong)
        assert [x for x in fault.tests if (ROOT / x).exists()], fault


def test_every_condition_has_faults() -> None:
    for each in conditions():
        assert each.given, each
        assert each.when, each
        assert any(not x.equivalent for x in each.faults), each


@pytest.mark.parametrize("before", ["never there", "import"])
def test_a_fault_that_does_not_fit_is_refused_before_any_is_planted(before: str, tmp_path: Path) -> None:
    wrong = Fault("room", "verdict.py", before, "", ("tests/test_verdict.py",))
    with pytest.raises(ValueError, match=r"verdict\.py has .* times, not once"):
        next(plant([listed()[0], wrong], ROOT, tmp_path / "copy"))
    assert not (tmp_path / "copy").exists()


def line(file: str, function: str, body: str, key: str = "0" * 12) -> journal.Line:
    digest = journal._digest(ast.unparse(ast.parse(body)))
    return journal.Line(
        key, file, 1, "constant", f"{function}|x", "1", "2", "caught", "a test", 1, 1.0, digest, "tests"
    )


def test_a_fault_by_hand_that_was_caught_is_not_planted_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    caught, survived, untried = faults = [Fault("room", "some.py", x, f"not {x}", ()) for x in "abc"]
    path, planted_now = tmp_path / "results.jsonl", []

    def plant_all(left: list[Fault], *_: object) -> list[tuple[Fault, str]]:
        planted_now.extend(left)
        return [(x, "hung") for x in left]

    write_results(
        {caught.key: "caught", survived.key: "survived", ("gone.py", "x", "y"): "caught"}.items(), path
    )
    monkeypatch.setattr(program, "listed", lambda: faults)
    monkeypatch.setattr(program, "read_results", lambda: read_results(path))
    monkeypatch.setattr(program, "write_results", lambda results: write_results(results, path))
    monkeypatch.setattr(program, "plant", plant_all)
    program.by_hand("")
    assert planted_now == [survived, untried]
    assert read_results(path) == {caught.key: "caught", survived.key: "hung", untried.key: "hung"}


def test_only_results_about_the_present_source_count(tmp_path: Path) -> None:
    body = "def one():\n    return 1\n"
    (tmp_path / "some.py").write_text(f"# moved down\n\n{body}", "utf-8")
    tried = line("some.py", "one", body)
    other = [
        line("some.py", "one", body.replace("1", "3")),
        line("some.py", "two", body),
        line("none.py", "one", body),
        line("some.py", "", body),
    ]
    assert journal.of_present_source([tried, *other], tmp_path) == [tried]
    [made, *_] = edits_of("some.py", (tmp_path / "some.py").read_text("utf-8"))
    outside = line("some.py", "", body, made.key)
    assert journal.of_present_source([outside], tmp_path) == [outside]


def test_an_argument_stands_for_an_equivalent_fault_whatever_its_function(tmp_path: Path) -> None:
    key = next(iter(journal.equivalents()))
    assert len(journal.of_present_source([line("none.py", "one", "x", key)], tmp_path)) == 1
