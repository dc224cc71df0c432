"""Mistakes in a ``catalogue.toml``: the test that has one is a fault, and all others are judged."""

import json
import shutil
from pathlib import Path
from xml.etree import ElementTree as xml

import pytest

import roadproof as rp
from roadproof.analysis.catalogue.entries import Abstract, Concrete
from roadproof.analysis.catalogue.listing import _by_itself
from roadproof.analysis.catalogue.reading import read_catalogue
from roadproof.errors import InputError
from roadproof.frontends.cli.main import main

HOME = rp.load()
BRAKING = Path(__file__).parents[2] / "examples" / "catalogue" / "tests" / "drives" / "braking.json"
FIRST = "[[test]]\nid = 'FIRST'\nformula = 'scenario_4(SV,POV,L)'\n"
LAST = "[[test]]\nid = 'LAST'\nfile = 'braking.json'\nclaims = [4]\n"


def written(folder: Path, text: str, name: str = "catalogue.toml") -> Path:
    folder.mkdir(exist_ok=True)
    (folder / name).write_text(text, "utf-8")
    shutil.copy(BRAKING, folder)
    return folder


def faults_in(folder: Path) -> dict[str, str]:
    """The faults of the tests of a folder by id."""
    found = read_catalogue([folder], HOME.alone).entries
    return {x.id: x.fault for x in found if isinstance(x, Concrete) and x.fault}


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("id='x'", "test x: a test has either a file or a formula"),
        ("id='x'\nfile='a.json'\nformula='true'", "test x: a test has either a file or a formula"),
        ("id='x'\nfile='a.json'\nroad='main-2'", "test x: road is for tests with a formula"),
        ("id='x'\nformula='true'\nroles={SV='a'}", "test x: roles is for tests with a file"),
        ("id='x'\nfile='a.json'\nroles='a'", "test x: roles='a'; write a table"),
        ("id='x'\nfile='a.json'\nroles={SV=[]}", "test x, roles: SV = []; write the name of a vehicle"),
        ("id='x'\nfile='a.json'\nroles={SV='a',POV='a'}", "test x, roles: a is SV and POV; it can play one"),
        ("id='x'\nformula='true'\ncolour='red'", "test x: 'colour' is not known; a test has id, title"),
        ("id='x'\nformula='true'\ncliams=[4]", "test x: 'cliams' is not known; did you mean 'claims'?"),
        ("id=3\nformula='true'", "test 2: id=3; write a text"),
        ("formula='true'", "test 2: there is no id; write one"),
        ("id='x'\nfile=' '", "test x: file=' '; write a text"),
        ("id='x'\nformula='true'\nclaims=[99]", "test x: there is no scenario '99'"),
        ("id='x'\nformula='true'\nclaims=4", "test x, claims=4: write a list"),
        ("id='x'\nformula='true'\nclaims=['1-8']", "test x, claims: '1-8' names 8 scenarios"),
        ("id='x'\nformula='true'\nclaims=['a b']", "no number of a scenario and no name"),
        ("id='x'\nformula='v_lon(SV) >'", "test x, formula, line 1, column 12: the text ends too early\n"),
        ("id='x'\nformula='assuming motion: true'", "test x, formula: leave 'assuming motion:' out"),
        ("id='x'\nformula='true'\nat_start={'v_lon(SV)'='20 m/s'}", "test x, at_start: 'v_lon(SV)'"),
        ("id='x'\nformula='true'\nat_start={'v_lon(SV)'='20 m .. 30 m'}", "test x, at_start, line 1"),
        ("id='x'\nformula='true'\nalways={'w(SV)'='2 m .. 3 m'}", "test x, always, line 1"),
        ("id='x'\nformula='true'\nroad='moon'", "test x: there is no road 'moon'"),
        ("id='x'\nformula='true'\nvehicles={SV='tank'}", "test x: there is no vehicle 'tank'"),
        ("id='FIRST'\nformula='true'", "two tests are called FIRST; give each an id of its own"),
        ("id='x\nformula='true'", "test 2: from line 4 on this is no TOML: "),
        ("id='x'\nformula=true and", "test x: from line 4 on this is no TOML: "),
        ("id='x'\nid='y'\nformula='true'", "is no TOML: Cannot overwrite a value (at line 6, column 7)"),
        ("id='x'\nformula='true'\nat_start={'v_lon(SV)'='20 m/s'", "test x: from line 4 on"),
    ],
)
def test_one_mistake_is_one_fault(text: str, told: str, tmp_path: Path) -> None:
    """The message names the file and the test; those before and after it are as they were."""
    folder = written(tmp_path, f"{FIRST}[[test]]\n{text}\n{LAST}")
    first, wrong, last = read_catalogue([folder], HOME.alone).entries
    assert isinstance(first, Abstract)
    assert first.query.text == "scenario_4(SV, POV, L)"
    assert last == Concrete("LAST", str(folder / "braking.json"), claims=("scenario_4",))
    assert isinstance(wrong, Concrete)
    assert str(folder / "catalogue.toml") in wrong.fault
    assert told in wrong.fault


@pytest.mark.parametrize(
    ("text", "ids"),
    [
        (f"{FIRST}[[tset]]\nid = 'X'\n{LAST}", ["FIRST", "LAST", "X"]),
        (f"{FIRST}[test]\nid = 'X'\n{LAST}", ["FIRST", "X", "LAST"]),
        (f"{FIRST}[[test]\nid = 'X'\n{LAST}", ["FIRST", "X", "LAST"]),
        (f"name = 'mine'\n{FIRST}{LAST}", ["FIRST", "LAST", "catalogue.toml, test 3"]),
        (f"name 'mine'\n{FIRST}{LAST}", ["catalogue.toml, test 1", "FIRST", "LAST"]),
        (f"# mine\n{FIRST}[test.test]\nx = 1\n{LAST}", ["FIRST", "LAST"]),
    ],
)
def test_headings_that_are_wrong(text: str, ids: list[str], tmp_path: Path) -> None:
    found = read_catalogue([written(tmp_path, text)], HOME.alone).entries
    assert [x.id.replace(f"{tmp_path}/", "") for x in found] == ids
    assert len(faults_in(tmp_path)) == 1


@pytest.mark.parametrize(
    "text", ["", "other = 1", "[[tset]]\nid = 'x'", "[test]\nid = 'x'", "[[test]]\nid ="]
)
def test_a_file_without_tests_is_an_error_where_it_is_alone(text: str, tmp_path: Path) -> None:
    path = tmp_path / "catalogue.toml"
    path.write_text(text, "utf-8")
    with pytest.raises(InputError, match=r"catalogue\.toml"):
        read_catalogue([path], HOME.alone)
    shutil.copy(BRAKING, tmp_path)
    [(name, told)] = faults_in(tmp_path).items()
    assert name == str(path)
    assert told.startswith(name)


def test_a_text_over_several_lines_is_not_read_as_tests(tmp_path: Path) -> None:
    """A test inside of a text is none, even where the file is no TOML."""
    text = f'[[test]]\nid = \'X\ntitle = """\n{FIRST}"""\n'
    assert [*faults_in(written(tmp_path, text))] == [str(tmp_path / "catalogue.toml")]


@pytest.mark.parametrize("quotes", ['"""', "'''"])
def test_tests_inside_of_a_long_text_are_none(quotes: str, tmp_path: Path) -> None:
    text = f"[[test]]\nid = 'X\ntitle = {quotes}\n[[test]]\nid = 'inside'\nfile = 'x.json'\n{quotes}\n"
    path = tmp_path / "catalogue.toml"
    path.write_text(text, "utf-8")
    assert _by_itself(path) == ()
    path.write_text(text.replace(quotes, "''"), "utf-8")
    assert any(x.fields.get("id") == "inside" for x in _by_itself(path))


def test_a_file_that_a_faulty_test_names_is_no_test_by_itself(tmp_path: Path) -> None:
    for wrong in ("tilte = 'x'", "title = x"):
        text = f"[[test]]\nid = 'X'\nfile = 'braking.json'\n{wrong}\n{FIRST}"
        found = read_catalogue([written(tmp_path, text)], HOME.alone).entries
        assert [x.id for x in found] == ["X", "FIRST"]
        assert [*faults_in(tmp_path)] == ["X"]


def test_ids_are_unique_over_all_files(tmp_path: Path) -> None:
    """The first one is judged; the others are faults, and have ids by which reports tell them apart."""
    for name in ("a", "b"):
        written(tmp_path / name, LAST + LAST)
    found = read_catalogue([tmp_path], HOME.alone).entries
    assert [x.id for x in found] == ["LAST", "LAST (2)", "LAST (3)", "LAST (4)"]
    faults = faults_in(tmp_path)
    assert [*faults] == ["LAST (2)", "LAST (3)", "LAST (4)"]
    assert f"the other one is in {tmp_path / 'a' / 'catalogue.toml'}" in faults["LAST (3)"]
    assert "the other one" not in faults["LAST (2)"]
    twice = read_catalogue([BRAKING, BRAKING], HOME.alone).entries
    assert [x.id for x in twice] == ["braking", "braking (2)"]


def test_a_fault_is_told_everywhere_and_covers_nothing(tmp_path: Path) -> None:
    """In text, JSON, table and JUnit; the test that it is in shows nothing, and the exit code is 10."""
    wrong = "[[test]]\nid = 'WRONG'\nfile = 'braking.json'\nclaims = [3]\nroles = 3\n"
    folder = written(tmp_path / "tests", f"{wrong}[[test]]\nid = 'TEXT'\nformula = 'true and'\n")
    out = tmp_path / "out"
    arguments = ["--among", "4", "--no-classes", "--out", str(out), "--no-pictures", "--jobs", "1"]
    assert main(["catalogue", str(folder), *arguments]) == 10
    index = json.loads((out / "index.json").read_text("utf-8"))
    assert [(x["tests"], x["told"].partition(": ")[0]) for x in index["faults"]] == [
        (["WRONG"], "cannot be read"),
        (["TEXT"], "cannot be read"),
    ]
    assert [(x["id"], x["shown"], x["claims"], bool(x["fault"])) for x in index["tests"]] == [
        ("WRONG", [], [], True),
        ("TEXT", [], [], True),
    ]
    assert index["not_tested"] == ["scenario_4"]
    cases = xml.parse(out / "junit.xml").iter("testcase")
    failing = {x.get("name"): y.get("message") for x in cases if (y := x.find("failure")) is not None}
    assert "test WRONG: roles=3" in str(failing["WRONG"])
    assert "\n  true and\n" in str(failing["TEXT"])
    assert (out / "matrix.csv").read_text("utf-8").splitlines() == ["test,scenario_4", "WRONG,", "TEXT,"]
    assert main(["check", str(out), "--jobs", "1"]) == 0
    found = rp.catalogue(folder, among="4", classes=False, jobs=1)
    assert "  TEXT: cannot be read: " in str(found)
    assert "\n    true and\n" in str(found)
    assert found.exit_code == 10
