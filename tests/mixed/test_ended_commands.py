"""What --junit and --sarif say where a command ends without an answer, or asks in a way that has no cases."""

from pathlib import Path
from typing import Any

import pytest

from extensions.assurance.test_build_results import agree
from roadproof.errors import InputError, LostWorkError, MissingSolverError, SharedError, UsageError
from roadproof.frontends.cli.help import command_parser, written_files
from roadproof.frontends.cli.main import COMMANDS, main
from roadproof.verdict import ExitCode

WITH_FILES = [x for x in COMMANDS if {"junit", "sarif"} <= {*written_files(command_parser(x))}]
ENDINGS = [
    *(x("it is so") for x in (InputError, UsageError, MissingSolverError, LostWorkError, SharedError)),
    ValueError("it is so"),
    OSError(28, "it is so"),
    KeyboardInterrupt(),
]
ARGUMENTS = {
    "prove": ["P1"],
    "witness": ["1"],
    "check": ["x.json"],
    "coverage": [],
    "catalogue": ["."],
    "preventable": ["cut-in"],
    "evaluate": ["."],
    "trace": ["r.toml"],
    "falsify": ["x.py:X"],
    "resimulate": ["x.py:X", "."],
}


def test_the_commands_with_files_of_build_results_are_those() -> None:
    assert {*WITH_FILES} == {*ARGUMENTS}


@pytest.mark.parametrize("command", WITH_FILES)
@pytest.mark.parametrize("ending", ENDINGS, ids=lambda x: type(x).__name__)
def test_a_command_that_ends_without_an_answer_says_so(
    command: str, ending: BaseException, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The files of an earlier run, in which all passed, do not stand for it."""
    monkeypatch.chdir(tmp_path)
    for name in ("j.xml", "s.sarif"):
        Path(name).write_text("all passed", "utf-8")

    def run(parsed: Any) -> int:
        raise ending

    monkeypatch.setattr(f"{COMMANDS[command].module}.run", run)
    code = main([command, *ARGUMENTS[command], "--junit", "j.xml", "--sarif", "s.sarif"])
    junit, sarif = (Path(x).read_text("utf-8") for x in ("j.xml", "s.sarif"))
    agree(junit, sarif, ExitCode(code))
    assert (code == 0) is isinstance(ending, SharedError)
    for asked in ("--junit", "--sarif"):
        Path("only").unlink(missing_ok=True)
        assert main([command, *ARGUMENTS[command], asked, "only"]) == code
        assert Path("only").read_text("utf-8") == (junit if asked == "--junit" else sarif)


@pytest.mark.parametrize("option", ["--junit", "--sarif"])
@pytest.mark.parametrize(
    "words", [["trace", "--baseline", "a", "b"], ["check", "x", "--kernel", "coq", "--write", "d"]]
)
def test_ways_to_ask_that_have_no_cases_refuse_the_files(
    words: list[str],
    option: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main([*words, option, "file"]) == 2
    assert "omit" in capsys.readouterr().err
