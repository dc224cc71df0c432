"""Exit codes of ended commands, words of the progress, and files in XML of which a part is wrong."""

import subprocess
import sys
from pathlib import Path

import pytest

from roadproof.errors import InputError, LostError, MissingSolverError, SharedError, TextError, UsageError
from roadproof.frontends.cli import main as command_line
from roadproof.runtime.budget import BudgetExceeded
from roadproof.runtime.progress import Cancelled, Stage, about, begin, is_heard, listening
from roadproof.runtime.xml_reader import DEEPEST, by_id, number_in, read_xml

ROADPROOF = Path(sys.executable).parent / "roadproof"


def test_whose_fault_an_error_is() -> None:
    codes = {
        UsageError: 2,
        InputError: 3,
        TextError: 3,
        MissingSolverError: 4,
        LostError: 20,
        BudgetExceeded: 20,
        SharedError: 0,
        Cancelled: 130,
    }
    assert {kind: kind.exit_code for kind in codes} == codes


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no /dev/full")
def test_an_answer_that_cannot_be_written_is_no_answer() -> None:
    with Path("/dev/full").open("w") as full:
        done = subprocess.run([ROADPROOF, "list"], stdout=full, stderr=subprocess.PIPE, text=True)
    assert done.returncode == 3
    assert done.stderr == (
        "roadproof: cannot write the answer: no space left on device; make room there, or write elsewhere\n"
    )


def test_an_answer_that_nobody_reads_is_not_delivered() -> None:
    command = [sys.executable, "-c", "import sys, time; time.sleep(0.2); sys.exit(0)"]
    reader = subprocess.Popen(command, stdin=subprocess.PIPE)
    assert reader.stdin is not None
    reader.wait()
    done = subprocess.run(
        [ROADPROOF, "list", "--json", "-"], stdout=reader.stdin, stderr=subprocess.PIPE, text=True
    )
    reader.stdin.close()
    assert (done.returncode, done.stderr) == (141, "")


@pytest.mark.parametrize(
    ("error", "code"),
    [
        (OSError("a library gave up"), 70),
        (OSError(2, "No such file", "a.json"), 3),
        (PermissionError(13, "denied", "a.json"), 3),
        (ValueError("x"), 70),
        (KeyboardInterrupt(), 130),
        (LostError("left out"), 20),
        (SharedError("done"), 0),
    ],
)
def test_the_exit_code_of_what_ends_a_command(
    error: BaseException, code: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(_: object) -> int:
        raise error

    monkeypatch.delenv(command_line.TRACEBACK, raising=False)
    monkeypatch.setattr(command_line, "_run", fail)
    assert command_line.main(["list"]) == code


# --- progress ----------------------------------------------------------------------------------------


def test_stages_are_heard_inside_only_and_say_of_what_they_are() -> None:
    heard: list[Stage] = []
    with listening(heard.append):
        with about("claim 1"), about("its proof"):
            begin("prove", "lane 1")
        begin("search")
        with listening(None):
            assert is_heard()
            begin("judge")
    assert not is_heard()
    begin("explain")
    assert [(x.name, x.told, x.of) for x in heard] == [
        ("prove", "lane 1", "claim 1"),
        ("search", "", ""),
        ("judge", "", ""),
    ]
    assert str(heard[0]).startswith("claim 1: prove, lane 1 (after ")


# --- XML ---------------------------------------------------------------------------------------------


def xml(folder: Path, text: str) -> Path:
    path = folder / "map.xml"
    path.write_text(text)
    return path


@pytest.mark.parametrize("depth", [DEEPEST - 1, DEEPEST, DEEPEST + 1])
def test_elements_are_so_deep_and_no_deeper(depth: int, tmp_path: Path) -> None:
    """Beside each other there may be any number of them."""
    beside = "<a/>" * (2 * DEEPEST)
    path = xml(tmp_path, f"{'<a>' * depth}{beside if depth < DEEPEST else ''}{'</a>' * depth}")
    if depth <= DEEPEST:
        assert read_xml(path, "a").tag == "a"
        return
    with pytest.raises(InputError, match=f"inside {DEEPEST} others"):
        read_xml(path, "a")


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("<!DOCTYPE a><a/>", "document type"),
        ("<b/>", "the root is b, but a is needed"),
        ("<a>", "no well-formed XML"),
        ("<html><a/></html>", "page of HTML"),
        ("\x1f\x8b", "compressed by gzip|no well-formed XML"),
    ],
)
def test_what_is_no_file_of_the_format_is_named(text: str, told: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=told):
        read_xml(xml(tmp_path, text), "a")
    assert read_xml(xml(tmp_path, '<n:a xmlns:n="x"><n:c/></n:a>'), "a")[0].tag == "c"


@pytest.mark.parametrize("text", ["", "x", "nan", "inf", "-inf", "1e999", None])
def test_what_is_no_finite_number_is_refused(text: str | None, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="a finite number is needed"):
        number_in(tmp_path, text, "width")
    assert number_in(tmp_path, " -1.5e2 ", "width") == -150.0


@pytest.mark.parametrize(
    ("text", "told"), [("<r><a/></r>", "has no id"), ('<r><a id=""/></r>', "has no id"),
                       ('<r><a id="1"/><a id="2"/><a id="1"/></r>', "a 1 occurs twice")]
)  # fmt: skip
def test_ids_are_there_and_differ(text: str, told: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=told):
        by_id(tmp_path, list(read_xml(xml(tmp_path, text), "r")))
    assert [*by_id(tmp_path, list(read_xml(xml(tmp_path, '<r><a id="1"/><a id="2"/></r>'), "r")))] == [
        "1",
        "2",
    ]
