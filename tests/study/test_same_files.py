"""Two runs of one question write the same files, computed or recalled, with one process or two."""

import os
from collections.abc import Mapping
from pathlib import Path

import pytest

from roadproof.frontends.cli.main import main

QUESTIONS: Mapping[str, tuple[str, ...]] = {
    "prove": ("prove", "P4"),
    "prove refuted": ("prove", "danger(SV,POV) -> F[0, 1 s] not danger(SV,POV)"),
    "witness": ("witness", "4"),
    "witness none": ("witness", "scenario_1(SV,POV,L) and scenario_4(SV,POV,L)"),
    "overlap": ("overlap", "--among", "3,4,8"),
    "order": ("order", "--among", "3,4", "--set", "base"),
    "redundancy": ("redundancy", "--among", "7"),
    "classify": ("classify", "--among", "4"),
    "compare": ("compare", "danger(SV,POV)", "danger(POV,SV)"),
    "explore": ("explore", "4", "--vary", "minSafe=0:2", "--steps", "3", "--precision", "1"),
}


def files(folder: Path) -> dict[str, bytes]:
    """Everything below a folder by its relative path."""
    return {x.relative_to(folder).as_posix(): x.read_bytes() for x in folder.rglob("*") if x.is_file()}


@pytest.mark.parametrize("question", QUESTIONS)
def test_two_runs_write_the_same_files(
    question: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(os.environ, "ROADPROOF_KNOWN", "on")
    monkeypatch.setitem(os.environ, "XDG_CACHE_HOME", str(tmp_path / "cache"))
    codes = []
    for name, more in (("computed", ("--fresh",)), ("again", ("--fresh", "--jobs", "2")), ("recalled", ())):
        options = [x for x in more if question not in UNKNOWN_TO or x != "--fresh"]
        codes.append(main([*QUESTIONS[question], *options, "--quiet", "--out", str(tmp_path / name)]))
        capsys.readouterr()
    computed = files(tmp_path / "computed")
    assert len(set(codes)) == 1
    assert codes[0] in (0, 10)
    assert computed, "nothing was written"
    assert files(tmp_path / "again") == computed
    assert files(tmp_path / "recalled") == computed


UNKNOWN_TO = ("prove", "prove refuted", "compare")
"""Questions without ``--fresh``: their answers are not recalled from elsewhere."""
