"""What this program has judged with these bytes is taken over; only ``check`` judges it again."""

import json
import shutil
from pathlib import Path
from typing import Any

import pytest

import roadproof as rp
from roadproof.evidence.finding import Acceptance
from roadproof.extensions.catalogue import concrete_claims
from roadproof.frontends.api import checking
from roadproof.frontends.api.checking import take_over

EXAMPLE = Path(__file__).parents[3] / "examples" / "catalogue" / "tests"


@pytest.fixture
def judged(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> list[str]:
    """The ids of tests that are judged, in a cache of its own that keeps answers."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setenv("ROADPROOF_KNOWN", "on")
    monkeypatch.delenv("ROADPROOF_CACHE", raising=False)
    ids: list[str] = []
    judge = concrete_claims.judge_test

    def counted(entry: Any, *rest: Any) -> Any:
        ids.append(entry.id)
        return judge(entry, *rest)

    monkeypatch.setattr(concrete_claims, "judge_test", counted)
    return ids


@pytest.fixture
def report(tmp_path: Path) -> Path:
    """An answer about two drives and samples, asked for by another process: nothing is known here."""
    tests = tmp_path / "tests"
    tests.mkdir()
    shutil.copy(EXAMPLE / "drives" / "braking.json", tests)
    shutil.copy(EXAMPLE / "drives" / "from-behind.json", tests)
    shutil.copy(EXAMPLE / "samples" / "braking.csv", tests / "samples.csv")
    shutil.copy(EXAMPLE / "samples" / "braking_road.toml", tests / "samples_road.toml")
    folder = tmp_path / "report"
    rp.catalogue(tests, among="3-4", classes=False, drivers=["careful"], out=folder, jobs=1)
    return folder


IDS = ["braking", "from-behind", "samples"]


def test_a_fresh_answer_is_taken_over(judged: list[str], report: Path) -> None:
    assert sorted(judged) == IDS
    judged.clear()
    assert take_over(report, jobs=1).accepted
    assert judged == []
    assert rp.check(report, jobs=1).accepted
    assert sorted(judged) == IDS


def test_what_was_never_judged_here_is_judged_once(
    report: Path, judged: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    for expected in (IDS, []):
        judged.clear()
        assert take_over(report, jobs=1).accepted
        assert sorted(judged) == expected
    monkeypatch.setenv("ROADPROOF_KNOWN", "off")
    assert take_over(report, jobs=1).accepted
    assert sorted(judged) == IDS


@pytest.mark.parametrize("change", ["shown", "test"])
def test_other_bytes_are_judged_and_rejected(judged: list[str], report: Path, change: str) -> None:
    """Negative control: a forged answer, and an answer about a test that has changed since."""
    assert take_over(report, jobs=1).accepted
    judged.clear()
    [path] = report.glob("judged-test-braking-*.json")
    if change == "shown":
        content = json.loads(path.read_text("utf-8"))
        content["shows"]["shown"].pop()
        path.write_text(json.dumps(content), "utf-8")
    else:
        drive = report.parent / "tests" / "braking.json"
        drive.write_text(drive.read_text("utf-8") + " ", "utf-8")
    found = take_over(report, jobs=1)
    rejected = {Path(x.where).name for x in found.findings if x.outcome is Acceptance.REJECTED}
    assert path.name in rejected


def test_a_folder_is_read_once_for_a_page(
    judged: list[str], report: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    def refuse(*_: object) -> None:
        raise AssertionError("the folder is read a second time")

    monkeypatch.setattr(checking, "read_folder", refuse)
    assert rp.page(report, out=tmp_path / "page.html", jobs=1).checked.accepted
