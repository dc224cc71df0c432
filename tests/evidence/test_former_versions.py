"""Evidence that version 0.1.0 wrote at revision 10af311, 23 November 2026, is still taken (SECURITY.md)."""

import json
import tarfile
from pathlib import Path

import pytest

import roadproof as rp
from roadproof.evidence.finding import Acceptance
from roadproof.verdict import ExitCode

ARCHIVE = Path(__file__).parent / "former" / "10af311.tar.xz"
QUESTIONS = {"proofs": 3, "refuted": 1, "drives": 2, "overlap": 1, "classes": 2, "plates": 8}
"""Folders of ``--out`` with the number of claims in each."""


@pytest.fixture(scope="module")
def former(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("former")
    with tarfile.open(ARCHIVE) as archive:
        archive.extractall(folder, filter="data")
    return folder


@pytest.mark.parametrize(("question", "count"), QUESTIONS.items())
def test_evidence_is_accepted(former: Path, question: str, count: int) -> None:
    found = rp.check(former / question, jobs=1)
    assert {x.outcome for x in found.findings} == {Acceptance.ACCEPTED}, str(found)
    assert (found.exit_code, len(found.findings)) == (ExitCode.AS_EXPECTED, count)


def test_a_catalogue_without_its_request_is_undecided(former: Path) -> None:
    """Answers before 1.0 did not say what was asked, so their tests cannot be judged again."""
    found = rp.check(former / "catalogue", jobs=1)
    doubts = [x.reason for x in found.findings if x.outcome is not Acceptance.ACCEPTED]
    assert len(doubts) == 1
    assert "'request' is missing" in doubts[0]
    assert found.exit_code is ExitCode.UNKNOWN


def test_forged_evidence_of_a_former_version_is_rejected(former: Path) -> None:
    index = former / "overlap" / "index.json"
    said = json.loads(index.read_text("utf-8"))
    said["verdicts"][0]["b"] = 8
    index.write_text(json.dumps(said), "utf-8")
    assert rp.check(former / "overlap", jobs=1).exit_code in (ExitCode.UNEXPECTED, ExitCode.BAD_INPUT)
