"""Verdicts to exit codes, excerpts of mistakes, and files that come along."""

import re
from pathlib import Path

import pytest

from roadproof.errors import Position, TextError
from roadproof.runtime import package_data
from roadproof.verdict import ExitCode, Verdict, exit_code

PROVED, REFUTED, UNKNOWN = Verdict.PROVED, Verdict.REFUTED, Verdict.UNKNOWN


@pytest.mark.parametrize(
    ("outcomes", "code"),
    [
        ([], 0),
        ([(PROVED, PROVED)], 0),
        ([(REFUTED, REFUTED), (PROVED, PROVED)], 0),
        ([(REFUTED, PROVED)], 10),
        ([(PROVED, REFUTED)], 10),
        ([(Verdict.PROVED_BOUNDED, PROVED)], 10),
        ([(Verdict.VACUOUS, PROVED)], 10),
        ([(PROVED, PROVED), (UNKNOWN, PROVED), (REFUTED, PROVED)], 20),
        ([(UNKNOWN, UNKNOWN)], 20),
        ([(UNKNOWN, PROVED), (Verdict.CROSSCHECK_FAILED, PROVED)], 30),
        ([(Verdict.CROSSCHECK_FAILED, Verdict.CROSSCHECK_FAILED)], 30),
    ],
)
def test_the_gravest_outcome_gives_the_exit_code(outcomes: list[tuple[Verdict, Verdict]], code: int) -> None:
    assert exit_code(outcomes) is ExitCode(code)
    assert exit_code(reversed(outcomes)) is ExitCode(code)


def test_every_verdict_and_exit_code_is_explained() -> None:
    page = (Path(__file__).parents[1] / "docs/explanation/meaning.md").read_text("utf-8")
    assert {str(verdict) for verdict in Verdict} <= set(re.findall(r"`([A-Z-]+)`", page))
    codes = (Path(__file__).parents[1] / "docs/reference/exit-codes.md").read_text("utf-8")
    assert sorted(map(int, re.findall(r"^\| (\d+) \|", codes, re.MULTILINE))) == sorted(ExitCode)


def test_a_long_line_is_cut_around_the_mistake() -> None:
    line = "a" * 5_000 + "!" + "b" * 5_000
    shown = str(TextError("here", Position(1, 5_001)).locate("f.spec", line)).splitlines()
    assert shown[0] == "f.spec, line 1, column 5001: here"
    assert len(shown[1]) <= 102
    assert shown[1][shown[2].index("^")] == "!"


def test_the_nearest_reader_says_where() -> None:
    error = TextError("here", Position(1, 1)).locate("inner.spec", "x").locate("outer", "y")
    assert str(error).startswith("inner.spec, line 1, column 1: here\n  x\n  ^")


def test_shipped_folders_are_found_in_a_checkout_and_in_a_wheel(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert (package_data.shipped_folder("models") / "roads" / "main-2.toml").is_file()
    package = tmp_path / "site-packages" / "roadproof"
    (package / "models").mkdir(parents=True)
    monkeypatch.setattr(package_data, "__file__", str(package / "runtime" / "package_data.py"))
    assert package_data.shipped_folder("models") == package / "models"
    with pytest.raises(FileNotFoundError, match="without its folder 'proofs'"):
        package_data.shipped_folder("proofs")
