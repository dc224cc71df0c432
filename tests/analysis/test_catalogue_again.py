"""Answers about catalogues, judged again: a field that is changed is rejected, and so are stale tests."""

import json
import shutil
from collections.abc import Iterator
from copy import deepcopy
from pathlib import Path

import pytest

import roadproof as rp
from evidence.folders import read, write
from evidence.test_every_field import another, leaves, path_of
from roadproof.analysis.catalogue import examination
from roadproof.engines.prove.properties import find_label
from roadproof.evidence.finding import Acceptance
from roadproof.evidence.folder import survey
from roadproof.frontends.api import judging_again
from roadproof.frontends.cli.main import main
from roadproof.frontends.report.page.catalogues import as_settings
from roadproof.frontends.settings.flags import command_line
from roadproof.verdict import ExitCode

EXAMPLE = Path(__file__).parents[2] / "examples" / "catalogue" / "tests"
TOML = """\
[[test]]
id = "wide"
formula = "scenario_4(SV,POV,L)"
claims = [4]

[[test]]
id = "LEAD"
file = "braking.json"
"""
UNCHECKED = ("seconds", "facts[].reason")
EQUIVALENT = {"request.near": "tests that say the same begin alike here, however near that is"}


@pytest.fixture(scope="module")
def kept(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A drive, samples and a formula, with their answer in a folder of its own."""
    home = tmp_path_factory.mktemp("kept")
    tests = home / "tests"
    tests.mkdir()
    shutil.copy(EXAMPLE / "drives" / "braking.json", tests)
    shutil.copy(EXAMPLE / "samples" / "braking.csv", tests / "samples.csv")
    shutil.copy(EXAMPLE / "samples" / "braking_road.toml", tests / "samples_road.toml")
    shutil.copy(EXAMPLE / "drives" / "from-behind.json", tests)
    (tests / "catalogue.toml").write_text(TOML, "utf-8")
    models = ["careful", "rss"]
    found = rp.catalogue(tests, among="1,3,4", classes=False, drivers=models, out=home / "report", jobs=1)
    found.add_files(False)
    return home


@pytest.fixture
def home(kept: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """The same folder, put right again after each test."""
    saved = kept.with_name(f"{kept.name}-saved")
    shutil.copytree(kept, saved)
    yield kept
    shutil.rmtree(kept)
    shutil.move(saved, kept)


def reasons(folder: Path) -> list[str]:
    return [x.reason for x in rp.check(folder, jobs=1).findings if x.outcome is not Acceptance.ACCEPTED]


def test_the_answer_is_accepted_and_says_what_was_judged(home: Path) -> None:
    checked = rp.check(home / "report", jobs=1)
    assert checked.exit_code is ExitCode.AS_EXPECTED
    told = str(checked)
    assert "JUDGED    test LEAD  shows endangered, scenario_4  [judged again in dense time" in told
    assert "DERIVED   what is tested  scenarios 2 of 3 (set base)" in told
    [left] = checked.not_checked.values()
    assert left == (*UNCHECKED, "question")


def test_no_field_is_changed_in_silence(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = home / "report"
    shutil.rmtree(folder / "answers")  # kept answers would tell that the index was changed
    (folder / "question.json").unlink()
    whole = read(folder / "index.json")
    known: dict[object, examination.Examination] = {}
    examine = examination.examine

    def once(request, basis, numbers, *more):  # type: ignore[no-untyped-def]
        """The same tests are judged once: of the fields only those that are asked change what is."""
        key = repr((request, numbers, basis.specification.options, basis.values))
        if key not in known:
            known[key] = examine(request, basis, numbers, *more)
        return known[key]

    monkeypatch.setattr(judging_again, "examine", once)
    accepted: list[str] = []
    tried: set[str] = set()
    for at in leaves(whole):
        path = path_of(at)
        if path.startswith(UNCHECKED) or path in tried or (at[0] == "parameters" and "parameters" in tried):
            continue
        tried |= {path, str(at[0])}
        changed = deepcopy(whole)
        place = changed
        for key in at[:-1]:
            place = place[key]
        place[at[-1]] = another(place[at[-1]])
        write(folder / "index.json", changed)
        found = judging_again.compare(survey([folder], (), find_label).told[0])
        whole_again = found is not None and all(x.outcome is Acceptance.ACCEPTED for x in found.findings)
        if whole_again and (checked := rp.check(folder, jobs=1)).accepted:
            listed = {x for those in checked.not_checked.values() for x in those}
            accepted += [path] if path not in listed else []
    assert len(tried) > 60
    assert [x for x in accepted if x not in EQUIVALENT] == []


@pytest.mark.parametrize(
    "field", ["not_tested", "faults", "doubts", "targets", "figures", "decisions", "facts"]
)
def test_an_entry_that_is_left_out_or_added_is_rejected(home: Path, field: str) -> None:
    whole = read(home / "report" / "index.json")
    for changed in (whole[field][:-1], [*whole[field], *whole[field][-1:]]):
        if changed != whole[field]:
            write(home / "report" / "index.json", {**whole, field: changed})
            assert reasons(home / "report")


def test_no_fact_can_be_left_out(home: Path) -> None:
    """Not even one from which nothing follows, such as that a test excludes a scenario."""
    whole = read(home / "report" / "index.json")
    for k in range(len(whole["facts"])):
        left = [*whole["facts"][:k], *whole["facts"][k + 1 :]]
        write(home / "report" / "index.json", {**whole, "facts": left})
        found = judging_again.compare(survey([home / "report"], (), find_label).told[0])
        assert found is not None
        assert any(x.outcome is Acceptance.REJECTED for x in found.findings)


@pytest.mark.parametrize("name", ["matrix.csv", "figures.csv", "drivers.csv", "junit.xml"])
def test_tables_are_compared(home: Path, name: str) -> None:
    path = home / "report" / name
    path.write_text(path.read_text("utf-8") + "\n", "utf-8")
    assert reasons(home / "report") == ["it is not the table of these tests"]


def test_stale_tests_are_named(home: Path, capsys: pytest.CaptureFixture[str]) -> None:
    drive = home / "tests" / "braking.json"
    drive.write_bytes((home / "tests" / "from-behind.json").read_bytes())
    assert main(["check", str(home / "report"), "--jobs", "1"]) == ExitCode.UNEXPECTED
    told = capsys.readouterr().out
    assert (
        f"rejected  LEAD  {home / 'report' / 'index.json'}: {drive} has changed since it was judged" in told
    )


def test_tests_that_are_gone_or_new_are_named(home: Path) -> None:
    (home / "tests" / "samples.csv").unlink()
    shutil.copy(EXAMPLE / "drives" / "seven.json", home / "tests")
    told = reasons(home / "report")
    assert "there is no such test now: the answer is stale; ask again" in told
    assert "the answer does not know this test: it is stale; ask again" in told


def test_a_formula_that_was_changed_is_no_longer_that_of_its_facts(home: Path) -> None:
    toml = home / "tests" / "catalogue.toml"
    toml.write_text(TOML.replace("scenario_4(", "scenario_3(").replace("[4]", "[3]"), "utf-8")
    assert "its premise is not the formula of wide" in reasons(home / "report")


def test_without_its_tests_nothing_is_accepted_in_silence(home: Path) -> None:
    shutil.rmtree(home / "tests")
    checked = rp.check(home / "report", jobs=1)
    assert checked.exit_code is ExitCode.UNKNOWN
    assert any("cannot be judged again" in x.reason for x in checked.findings)


def test_answers_among_the_tests_are_no_tests(home: Path) -> None:
    """A catalogue that is asked for again would else count the drives of its own evidence as tests."""
    inside = home / "tests" / "report"
    first = rp.catalogue(home / "tests", among="1,3,4", classes=False, out=inside, jobs=1)
    again = rp.catalogue(home / "tests", among="1,3,4", classes=False, out=inside, jobs=1)
    assert again.tests == first.tests
    assert rp.check(inside, jobs=1).accepted
    (inside / "index.json").unlink()  # a run that was broken off
    assert rp.catalogue(home / "tests", among="1,3,4", classes=False, jobs=1).tests == first.tests


def test_the_page_says_that_an_answer_is_rejected(home: Path) -> None:
    index = home / "report" / "index.json"
    whole = read(index)
    write(index, {**whole, "not_tested": []})
    made = rp.page(home / "report", out=home / "page.html", jobs=1)
    assert made.exit_code is ExitCode.UNEXPECTED
    assert "check rejects this answer" in made.text
    write(index, whole)
    assert "check rejects this answer" not in rp.page(home / "report", out=home / "page.html", jobs=1).text


def test_the_command_asks_the_same(home: Path) -> None:
    told = json.loads((home / "report" / "index.json").read_text("utf-8"))["request"]
    assert told["paths"] == [str(home / "tests")]
    request = judging_again.read_request(told, "request")
    command = command_line("catalogue", request.paths, as_settings(request.kept))
    assert command == f"roadproof catalogue {home / 'tests'} --no-classes --drivers careful,rss"
