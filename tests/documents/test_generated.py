"""Files that are made from the source are those of the checkout, and the check names one that is not."""

from pathlib import Path

import pytest

from documents import generated
from documents.generated import GENERATORS, ROOT, Generator, main, run

PAGE = ROOT / "docs/reference/exit-codes.md"


@pytest.mark.parametrize("generator", [x for x in GENERATORS if not x.program], ids=lambda x: x.title)
def test_the_files_are_those_of_the_checkout(generator: Generator) -> None:
    assert run([generator], write=False) == [], "run: make generated"


def test_the_check_names_a_planted_difference_and_writes_nothing(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    content = PAGE.read_bytes()
    changed = Generator("a changed page", lambda: {PAGE: content + b"changed", ROOT / "LICENSE": licence})
    licence = (ROOT / "LICENSE").read_bytes()
    monkeypatch.setattr(generated, "GENERATORS", (changed,))
    assert main(["--check"]) == 1
    assert capsys.readouterr().out == "docs/reference/exit-codes.md differs; run: make generated\n"
    assert PAGE.read_bytes() == content


def test_only_files_that_differ_are_written(tmp_path: Path) -> None:
    old, new, missing = (tmp_path / name for name in ("old", "new", "missing"))
    old.write_text("old")
    new.write_text("new")
    before = new.stat().st_mtime_ns
    maker = Generator("three files", lambda: dict.fromkeys((old, new, missing), b"new"))
    assert run([maker], write=True) == [old, missing]
    assert [x.read_text() for x in (old, new, missing)] == ["new"] * 3
    assert new.stat().st_mtime_ns == before
    assert run([maker], write=False) == []


def test_files_stay_as_they_are_without_their_program(capsys: pytest.CaptureFixture[str]) -> None:
    absent = Generator("a program", lambda: pytest.fail("it is made"), program="no-such-program")
    assert run([absent], write=True) == []
    assert capsys.readouterr().err == "a program: left as they are, no-such-program is not installed\n"
