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

import roadproof as rp
from roadproof.engines.search.batches import Engines
from roadproof.evidence.claim import Claim, On
from roadproof.evidence.codec import read, write
from roadproof.extensions.catalogue import concrete_claims
from roadproof.extensions.catalogue.candidates import candidates
from roadproof.extensions.catalogue.cataloguing import CatalogueAnswer
from roadproof.extensions.catalogue.concrete_answer import ConcreteAnswer
from roadproof.extensions.catalogue.entries import ConcreteTest
from roadproof.runtime import archives, pool
from roadproof.runtime.archives import SWITCH

pytestmark = pytest.mark.usefixtures("searched_once")

EXAMPLE = Path(__file__).parents[3] / "examples" / "catalogue" / "tests"
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
    """The tests that were judged, and the formulas that were searched, since it was last ``taken``."""

    def __init__(self) -> None:
        self.judged: list[str] = []
        self.asked: set[str] = set()

    def taken(self) -> tuple[list[str], set[str]]:
        found, self.judged, self.asked = (sorted(self.judged), self.asked), [], set()
        return found


@pytest.fixture
def work(monkeypatch: pytest.MonkeyPatch) -> Work:
    """Watches all work, done here."""
    watched = Work()
    judge_test, settle = concrete_claims.judge_test, Engines.answer_claim

    def watched_judge(entry: ConcreteTest, *rest: Any) -> ConcreteAnswer:
        watched.judged.append(entry.id)
        return judge_test(entry, *rest)

    def watched_settle(engines: Engines, claim: Claim, proposed: Any = ()) -> Any:
        if not isinstance(claim.mode, On):
            watched.asked.add("NEVER" if "scenario_1" in claim.query.text.partition(")")[0] else "AHEAD")
        return settle(engines, claim, proposed)

    monkeypatch.setattr(concrete_claims, "judge_test", watched_judge)
    monkeypatch.setattr(Engines, "answer_claim", watched_settle)
    monkeypatch.setattr(pool, "work", lambda f, jobs, *_, **__: (x for x in enumerate(map(f, jobs))))
    return watched


@pytest.fixture
def tests(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """Three drives and two formulas; a cache of our own, and nothing that is shipped."""
    monkeypatch.setenv(SWITCH, "on")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setattr(archives, "shipped_folder", lambda _: tmp_path / "shipped")
    archives.shipped_answers.cache_clear()
    candidates.cache_clear()
    folder = tmp_path / "tests"
    folder.mkdir()
    for name in DRIVES:
        shutil.copy(EXAMPLE / "drives" / f"{name}.json", folder)
    (folder / "catalogue.toml").write_text(TOML, "utf-8")
    yield folder
    archives.shipped_answers.cache_clear()
    candidates.cache_clear()


def asked(tests: Path, **more: Any) -> CatalogueAnswer:
    return rp.catalogue(tests, using=rp.load(), among="1-4", classes=False, drivers=(), jobs=1, **more)


def timeless(answer: CatalogueAnswer) -> Any:
    return {name: x for name, x in answer.as_data().items() if name != "seconds"}


JUDGED, NONE = sorted(DRIVES), ([], set[str]())
ALL = (JUDGED, {"AHEAD", "NEVER"})


def test_the_second_run_judges_nothing_and_says_the_same(tests: Path, work: Work) -> None:
    said: list[str] = []
    first = asked(tests)
    assert work.taken() == ALL
    second = asked(tests, say=said.append)
    assert work.taken() == NONE
    count = len(first.found.answers)
    told = f"{count} of {count} answers were known: {count} of earlier runs; --fresh computes them again"
    assert said == [told]
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
    assert work.taken() == (["braking"], set()), "other bytes are another drive, whatever they say"
    toml = tests / "catalogue.toml"
    toml.write_text(TOML.replace("30 m/s", "31 m/s"), "utf-8")
    changed = asked(tests)
    assert work.taken() == ([], {"AHEAD"})
    assert timeless(changed) == timeless(asked(tests, fresh=True))


def test_whatever_an_answer_depends_on_makes_it_unknown(tests: Path, work: Work) -> None:
    asked(tests)
    work.taken()
    for more in ({"lanes": "any"}, {"roles": "any"}, {"start": "any"}):
        asked(tests, **more)
        assert work.taken() == (JUDGED, set()), "formulas are asked whatever drives are looked at"
    rp.catalogue(tests, using=rp.load(params={"rho": 0.7}), among="1-4", classes=False, drivers=(), jobs=1)
    assert work.taken()[0] == JUDGED
    rp.catalogue(tests, using=rp.load(), among="1-3", classes=False, drivers=(), jobs=1)
    assert work.taken() == (JUDGED, set()), "claims about a test and a scenario are not about others"


def test_check_takes_no_answer_from_earlier_runs(tests: Path, work: Work, tmp_path: Path) -> None:
    asked(tests, out=tmp_path / "out")
    work.taken()
    rp.check(tmp_path / "out")
    assert {*DRIVES} <= {*work.taken()[0]}


def test_an_answer_that_was_changed_on_disk_is_computed_again(
    tests: Path, work: Work, tmp_path: Path
) -> None:
    asked(tests)
    work.taken()
    kept = [*(tmp_path / "cache/roadproof/answers").iterdir()]
    assert kept
    for path in kept:
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
    for answer in rp.catalogue(*folders, among="1-4", classes=False, jobs=1).concrete:
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
    monkeypatch.setattr("roadproof.extensions.catalogue.question.TESTS_IN_A_BATCH", 16)
    rp.catalogue(EXAMPLE / "drives", among="1", classes=False, drivers=(), jobs=2)
    assert {*asked_for} == {method}
