"""A catalogue asked again: only tests that are new or have changed are judged and searched again."""

import json
import multiprocessing
import shutil
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
from roadproof.analysis.catalogue.formula_facts import FormulaFacts
from roadproof.analysis.catalogue.meaning import Meanings, Piece
from roadproof.analysis.study import known, pool

import roadproof as rp
from roadproof.analysis.catalogue import examination, meaning
from roadproof.analysis.catalogue.candidates import candidates
from roadproof.analysis.catalogue.entries import Abstract, Concrete
from roadproof.analysis.catalogue.fact import Fact
from roadproof.analysis.catalogue.showing import ConcreteAnswer
from roadproof.evidence.codec import read, write
from roadproof.frontends.api.cataloguing import CatalogueAnswer
from roadproof.runtime.archives import SWITCH

pytestmark = pytest.mark.usefixtures("searched_once")

EXAMPLE = Path(__file__).parents[2] / "examples" / "catalogue" / "tests"
DRIVES = ("braking", "from-behind", "torn")
TOML = """\
[[test]]
id = "AHEAD"
formula = "scenario_4(SV,POV,L)"
at_start = { "v_lon(SV)" = "20 m/s .. 30 m/s" }

[[test]]
id = "NEVER"
formula = "scenario_1(SV,POV,L) and scenario_4(SV,POV,L)"
"""


class Work:
    """The tests that were judged, and the pieces that were settled, since it was last ``taken``."""

    def __init__(self) -> None:
        self.done: list[str] = []

    def taken(self) -> list[str]:
        found, self.done = sorted(self.done), []
        return found


@pytest.fixture
def work(monkeypatch: pytest.MonkeyPatch) -> Work:
    """Watches all work, done here."""
    watched = Work()
    show, settle = examination.show, Meanings.settle

    def watched_show(entry: Concrete, *rest: Any) -> ConcreteAnswer:
        watched.done.append(entry.id)
        return show(entry, *rest)

    def watched_settle(study: Meanings, piece: Piece) -> dict[str, meaning.Kept]:
        match piece:
            case Abstract(name):
                watched.done.append(name)
            case meaning.Pair(one, other):
                watched.done.append(f"{one.id} {other.id}")
            case _:
                watched.done.append(type(piece).__name__)
        return settle(study, piece)

    monkeypatch.setattr(examination, "show", watched_show)
    monkeypatch.setattr(Meanings, "settle", watched_settle)
    monkeypatch.setattr(pool, "work", lambda f, jobs, *_, **__: (x for x in enumerate(map(f, jobs))))
    return watched


@pytest.fixture
def tests(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """Three drives and two formulas; a cache of our own, and nothing that is shipped."""
    monkeypatch.setenv(SWITCH, "on")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setattr(known, "shipped", lambda _: tmp_path / "shipped")
    candidates.cache_clear()
    folder = tmp_path / "tests"
    folder.mkdir()
    for name in DRIVES:
        shutil.copy(EXAMPLE / "drives" / f"{name}.json", folder)
    (folder / "catalogue.toml").write_text(TOML, "utf-8")
    yield folder
    known._read.cache_clear()
    candidates.cache_clear()


def asked(tests: Path, **more: Any) -> CatalogueAnswer:
    return rp.catalogue(tests, using=rp.load(), among="1-4", classes=False, drivers=(), jobs=1, **more)


def timeless(answer: CatalogueAnswer) -> Any:
    return {name: x for name, x in answer.as_data().items() if name != "seconds"}


ALL = sorted([*DRIVES, "AHEAD", "NEVER", "AHEAD NEVER"])


def test_the_second_run_judges_nothing_and_says_the_same(tests: Path, work: Work) -> None:
    said: list[str] = []
    first = asked(tests)
    assert work.taken() == ALL
    second = asked(tests, say=said.append)
    assert work.taken() == []
    assert said == [
        "3 of 3 tests were judged in earlier runs; --fresh judges them again",
        "3 of 3 answers were known: 3 of earlier runs; --fresh computes them again",
    ]
    assert timeless(first) == timeless(second)
    assert first.files(pictures=False) == second.files(pictures=False)
    third = asked(tests, fresh=True)
    assert work.taken() == ALL
    assert timeless(third) == timeless(first)


def test_one_changed_test_is_the_only_one_to_be_judged_again(tests: Path, work: Work) -> None:
    asked(tests)
    work.taken()
    drive = tests / "braking.json"
    drive.write_text(drive.read_text("utf-8") + "\n", "utf-8")
    asked(tests)
    assert work.taken() == ["braking"], "other bytes are another drive, whatever they say"
    toml = tests / "catalogue.toml"
    toml.write_text(TOML.replace("30 m/s", "31 m/s"), "utf-8")
    changed = asked(tests)
    assert work.taken() == ["AHEAD", "AHEAD NEVER"]
    assert timeless(changed) == timeless(asked(tests, fresh=True))


def test_whatever_an_answer_depends_on_makes_it_unknown(tests: Path, work: Work) -> None:
    asked(tests)
    work.taken()
    drives = sorted(DRIVES)
    for more in ({"lanes": "any"}, {"roles": "any"}, {"start": "any"}):
        asked(tests, **more)
        assert work.taken() == drives, "formulas are asked whatever drives are looked at"
    asked(tests, effort=50)
    assert work.taken() == ["AHEAD", "AHEAD NEVER", "NEVER"], "the judge has no limits"
    slower = rp.load(params={"rho": 0.7})
    rp.catalogue(tests, using=slower, among="1-4", classes=False, drivers=(), jobs=1)
    assert work.taken() == ALL
    rp.catalogue(tests, using=rp.load(), among="1-3", classes=False, drivers=(), jobs=1)
    assert work.taken() == ALL


def test_what_a_clock_may_cut_off_is_not_kept(tests: Path, work: Work) -> None:
    asked(tests, timeout=500)
    work.taken()
    asked(tests, timeout=500)
    assert work.taken() == ["AHEAD", "AHEAD NEVER", "NEVER"]


@pytest.mark.parametrize(
    ("other", "exhausted", "is_kept"),
    [("scenario_8", True, True), ("scenario_8", False, False), ("", True, False)],
)
def test_doubts_that_the_same_work_leaves_are_kept(
    tests: Path, work: Work, monkeypatch: pytest.MonkeyPatch, other: str, exhausted: bool, is_kept: bool
) -> None:
    def left_open(facts: FormulaFacts) -> tuple[Fact, ...]:
        entry = facts.entry
        conclusion = entry.query if other else None
        return (
            Fact(entry.id, other, "open", entry.query, conclusion, "none was found", exhausted=exhausted),
        )

    monkeypatch.setattr(FormulaFacts, "all", left_open)
    first = asked(tests)
    work.taken()
    assert timeless(asked(tests)) == timeless(first)
    assert work.taken() == ([] if is_kept else ["AHEAD", "NEVER"])


def test_check_takes_no_answer_from_earlier_runs(tests: Path, work: Work, tmp_path: Path) -> None:
    asked(tests, out=tmp_path / "out")
    work.taken()
    rp.check(tmp_path / "out")
    assert {*DRIVES} <= {*work.taken()}


def test_an_answer_that_was_changed_on_disk_is_computed_again(
    tests: Path, work: Work, tmp_path: Path
) -> None:
    asked(tests)
    work.taken()
    for path in (tmp_path / "cache/roadproof/answers").iterdir():
        path.write_bytes(path.read_bytes()[:-1] + b"\0")
    asked(tests)
    assert work.taken() == ALL


def test_nothing_is_kept_where_known_answers_are_off(
    tests: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(SWITCH, "off")
    asked(tests)
    assert not [*tmp_path.joinpath("cache").rglob("answers/*")]
    monkeypatch.setenv(SWITCH, "on")  # the control
    asked(tests)
    assert [*tmp_path.joinpath("cache").rglob("answers/*")]


def test_answers_are_kept_as_they_are(tests: Path) -> None:
    folders = EXAMPLE / "drives", EXAMPLE / "samples"
    for answer in rp.catalogue(*folders, among="1-4", classes=False, jobs=1).examination.concrete:
        assert read(ConcreteAnswer, json.loads(json.dumps(write(answer))), "") == answer


@pytest.mark.parametrize(("modules", "method"), [({"polars": ModuleType("polars")}, "spawn"), ({}, "fork")])
def test_workers_start_afresh_where_polars_has_threads(
    monkeypatch: pytest.MonkeyPatch, modules: dict[str, ModuleType], method: str
) -> None:
    """A copy of a process whose threads hold locks waits for ever."""
    real, asked_for = multiprocessing.get_context, []
    monkeypatch.delitem(sys.modules, "polars", raising=False)
    for name, module in modules.items():
        monkeypatch.setitem(sys.modules, name, module)
    monkeypatch.setattr(multiprocessing, "get_context", lambda x: asked_for.append(x) or real(x))
    monkeypatch.setattr(examination, "BATCH", 16)
    rp.catalogue(EXAMPLE / "drives", among="1", classes=False, drivers=(), jobs=2)
    assert {*asked_for} == {method}
