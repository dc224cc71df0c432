"""Dispatch, exit codes, and how long it takes to start."""

import fcntl
import json
import os
import pty
import re
import shutil
import struct
import subprocess
import sys
import termios
from pathlib import Path

import pytest

import fresh
from roadproof.errors import MissingSolverError
from roadproof.frontends.cli import main as command_line
from roadproof.frontends.cli.main import COMMANDS, TRACEBACK, main
from roadproof.frontends.cli.terminal import _COLOURS, fit, paint
from roadproof.library.loading import bundled_library
from roadproof.verdict import Verdict

ROADPROOF = Path(sys.executable).parent / "roadproof"


def run_as(monkeypatch: pytest.MonkeyPatch, error: BaseException) -> int:
    """The exit code of a sub-command that fails with ``error``."""

    def fail(*_: object) -> int:
        raise error

    monkeypatch.setattr(command_line, "_run", fail)
    return main(["list"])


def test_errors_become_exit_codes(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.delenv(TRACEBACK, raising=False)
    assert run_as(monkeypatch, MissingSolverError("solver=x is missing")) == 4
    assert capsys.readouterr().err == "roadproof: solver=x is missing\n"
    assert run_as(monkeypatch, KeyboardInterrupt()) == 130
    assert capsys.readouterr().err == "roadproof: interrupted\n"
    assert run_as(monkeypatch, ZeroDivisionError("division by zero")) == 70
    said = capsys.readouterr().err
    assert "our fault: ZeroDivisionError: division by zero" in said
    assert "Traceback" not in said
    assert TRACEBACK in said


def test_a_traceback_is_there_for_the_asking(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(TRACEBACK, "1")
    with pytest.raises(ZeroDivisionError):
        run_as(monkeypatch, ZeroDivisionError())


def test_results_go_to_stdout_and_complaints_to_stderr(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["show", "fasterThan"]) == 0
    good = capsys.readouterr()
    assert good.out.startswith("def fasterThan")
    assert good.err == ""
    assert main(["show", "fasterTan"]) == 3
    bad = capsys.readouterr()
    assert bad.out == ""
    assert bad.err.startswith("roadproof: there is no definition 'fasterTan'; did you mean 'fasterThan'?")


def test_every_subcommand_keeps_the_contract() -> None:
    from importlib import import_module

    for command in COMMANDS.values():
        module = import_module(command.module)
        assert command.summary == module.SUMMARY
        assert "examples:" in module.EXAMPLES
        assert callable(module.run)


def test_every_subcommand_helps_by_example(capsys: pytest.CaptureFixture[str]) -> None:
    for name in ["", *COMMANDS]:
        with pytest.raises(SystemExit) as raised:
            main([name, "--help"] if name else ["--help"])
        assert raised.value.code == 0
        shown = capsys.readouterr().out
        assert "examples:" in shown
        assert f"roadproof {name}".strip() in shown.split("examples:")[1]


def test_list_as_json(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    assert main(["list", "--set", "ext", "--json", "-"]) == 0
    listed = json.loads(capsys.readouterr().out)
    assert listed["schema"] == "roadproof/list/1"
    assert listed["set"] == "ext"
    assert [s["name"] for s in listed["scenarios"]] == [f"scenario_{i}" for i in range(1, 25)]
    assert listed["scenarios"][1]["arguments"] == ["SV", "POV1", "POV2", "L"]
    assert {
        "name": "rho",
        "value": "3/5",
        "unit": "s",
        "bound": ">=",
        "doc": "response time of the rear vehicle",
    } in (listed["parameters"])
    assert main(["list", "--set", "ext", "--json", str(tmp_path / "list.json")]) == 0
    assert json.loads((tmp_path / "list.json").read_text("utf-8")) == listed


@pytest.mark.parametrize(("arguments", "seconds"), [(["--help"], 0.4), (["list"], 1.0), (["show", "4"], 1.0)])
def test_starts_quickly(arguments: list[str], seconds: float) -> None:
    """Processor time, which does not depend on what else the machine is doing; the best of three."""
    best = min(_processor_seconds(arguments) for _ in range(3))
    assert best < seconds


def _processor_seconds(arguments: list[str]) -> float:
    import resource

    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([str(ROADPROOF), *arguments], check=True, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


PROOF = Path(__file__).parents[2] / "proofs" / "P4-scenario-03-base.json"
_SOLVERS = ("z3", "cvc5", "cvxpy", "highspy", "clarabel")
_DRAWING = (
    "matplotlib",
    "PIL",
    "sympy",
    "polars",
    "roadproof.extensions.exchange.export",
    "roadproof.extensions.maps.selection",
)
_OTHERS = (
    "roadproof.extensions.catalogue.question",
    "roadproof.extensions.traffic.formats",
    "roadproof.extensions.kernel.accept",
)
_SEARCHER = ("scipy", "roadproof.semantics.sampled", "roadproof.engines.solve.refuting")
_PROVER = ("z3", "roadproof.engines.prove.prover", "roadproof.engines.prove.countermodel")


@pytest.mark.parametrize(
    ("arguments", "left_out"),
    [
        ("--help", ["argparse", "dataclasses", "pathlib", "roadproof.errors"]),
        (
            "list",
            [
                *_SOLVERS,
                *_DRAWING,
                *_OTHERS,
                "numpy",
                "lark",
                "roadproof.extensions.drivers.models",
                "roadproof.evidence",
            ],
        ),
        (
            "prove true --jobs 1",
            [*_DRAWING, *_OTHERS, "numpy", "cvc5", "cvxpy", "roadproof.semantics.sampled"],
        ),
        ("witness 4 --jobs 1", [*_DRAWING, *_OTHERS, *_PROVER, *_SEARCHER]),
        (f"check {PROOF} --jobs 1", [*_DRAWING, *_OTHERS, "numpy", "cvxpy"]),
    ],
)
def test_a_command_imports_what_it_needs(arguments: str, left_out: list[str]) -> None:
    bundled_library.__wrapped__()  # the first run of all parses it, and keeps it
    code = (
        "import sys\nfrom roadproof.frontends.cli import entry\n"
        "if sys.argv[1] == '--help':\n    entry.main()\n"
        "else:\n    from roadproof.frontends.cli.main import answer\n    assert not answer(sys.argv[1:])\n"
        f"print([x for x in {left_out!r} if x in sys.modules], file=sys.stderr)"
    )
    command = [sys.executable, "-c", code, *arguments.split()]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert done.stderr.splitlines()[-1] == "[]"


def test_a_closed_pipe_is_quiet_and_no_success() -> None:
    process = subprocess.Popen([str(ROADPROOF), "list"], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    assert process.stdout is not None
    assert process.stderr is not None
    process.stdout.close()
    assert process.wait(30) == 141
    assert process.stderr.read() == b""
    process.stderr.close()


@pytest.mark.parametrize(
    ("asked", "last"),
    [
        (["prove", "danger(SV,POV) -> danger(SV,POV)"], "claim-*.json"),
        (["witness", "4"], "scenario-04-base.svg"),
    ],
)
def test_evidence_is_kept_whole_when_the_reader_goes(asked: list[str], last: str, tmp_path: Path) -> None:
    """As with ``| head -1``."""
    words = [str(ROADPROOF), *asked, "--out", str(tmp_path / "mine")]
    with subprocess.Popen(words, stdout=subprocess.PIPE) as process:
        assert process.stdout is not None
        process.stdout.close()
        assert process.wait(60) == 0
    assert [*(tmp_path / "mine").glob(last)]
    done = subprocess.run([str(ROADPROOF), "check", str(tmp_path / "mine")], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout


def test_an_interrupt_ends_quietly() -> None:
    import signal

    code = (
        "import time\nfrom roadproof.frontends.cli import main as m\n"
        "def wait(_):\n    print('ready', flush=True)\n    time.sleep(60)\n"
        "m._run = wait\nraise SystemExit(m.main(['list']))"
    )
    process = subprocess.Popen(
        [sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert process.stdout is not None
    assert process.stdout.readline() == "ready\n"
    process.send_signal(signal.SIGINT)
    _, said = process.communicate()
    assert process.returncode == 130
    assert said == "roadproof: interrupted\n"


IGNORING = ("bash", "-c", "trap '' INT; exec \"$@\"", "bash")
"""Runs a command as ``nohup COMMAND &`` does: Ctrl-C is ignored, and so by all that it starts."""


@pytest.mark.skipif(shutil.which("bash") is None, reason="bash is not installed")
def test_the_tests_hear_an_interrupt_where_the_shell_ignores_it() -> None:
    test = f"{__file__}::test_an_interrupt_ends_quietly"
    command = [*IGNORING, sys.executable, "-m", "pytest", "-q", "-p", "no:xdist", "-p", "no:cacheprovider"]
    environment = {k: v for k, v in os.environ.items() if not k.startswith("PYTEST_")}
    done = subprocess.run([*command, test], capture_output=True, text=True, env=environment)
    assert "1 passed" in done.stdout, done.stdout
    assert done.returncode == 0


@pytest.mark.skipif(shutil.which("bash") is None, reason="bash is not installed")
def test_a_command_goes_on_where_the_shell_ignores_interrupts() -> None:
    """As all programs in the background of a shell do."""
    import signal

    code = (
        "import sys\nfrom roadproof.frontends.cli import main as m\n"
        "def wait(_):\n    print('ready', flush=True)\n    sys.stdin.readline()\n    return 0\n"
        "m._run = wait\nsys.argv[1:] = ['list']\nraise SystemExit(m.main())"
    )
    pipe = subprocess.PIPE
    process = subprocess.Popen([*IGNORING, sys.executable, "-c", code], stdin=pipe, stdout=pipe, text=True)
    assert process.stdout is not None
    assert process.stdout.readline() == "ready\n"
    process.send_signal(signal.SIGINT)
    process.communicate("\n", timeout=60)
    assert process.returncode == 0


# --- Colours and widths are for terminals: in a pipe every byte is as it was ------------------------

PROGRAM = str(Path(sys.executable).parent / "roadproof")
PROVE = ("prove", "danger(SV,POV) -> danger(SV,POV)")
COLOUR = re.compile(r"\033\[\d+m")
SECONDS = re.compile(r"\d+\.\d+ s\b")
GREEN = "\033[32mPROVED\033[0m"


def environment(**more: str) -> dict[str, str]:
    names = ("NO_COLOR", "FORCE_COLOR", "COLUMNS", "TERM")
    plain = {name: value for name, value in os.environ.items() if name not in names}
    return {**plain, "TERM": "xterm", **more}


def in_pipe(*words: str, **more: str) -> str:
    done = subprocess.run([PROGRAM, *words], capture_output=True, env=environment(**more))
    return SECONDS.sub("…", done.stdout.decode())


def on_terminal(*words: str, columns: int = 80, **more: str) -> str:
    """What a command writes on a terminal of that width."""
    ours, its = pty.openpty()
    fcntl.ioctl(its, termios.TIOCSWINSZ, struct.pack("HHHH", 40, columns, 0, 0))
    command = subprocess.Popen(
        [PROGRAM, *words], stdin=its, stdout=its, stderr=subprocess.DEVNULL, env=environment(**more)
    )
    os.close(its)
    parts = []
    while True:
        try:
            part = os.read(ours, 65536)
        except OSError:  # Linux says so when the other side is closed
            part = b""
        if not part:
            break
        parts.append(part)
    os.close(ours)
    assert command.wait() == 0
    return SECONDS.sub("…", b"".join(parts).decode().replace("\r\n", "\n"))


def test_every_verdict_has_a_colour() -> None:
    assert {*_COLOURS} == {*Verdict}
    for verdict in Verdict:
        assert COLOUR.sub("", paint(f"{verdict}  a claim")) == f"{verdict}  a claim"
        assert paint(f"({verdict})").startswith("(\033[")
        assert paint(f"X{verdict} {verdict}-{verdict.lower()}x") == f"X{verdict} {verdict}-{verdict.lower()}x"
    assert paint("rejected  P4") == "\033[31mrejected\033[0m  P4"
    assert paint("unknown what it is") == "unknown what it is"


def test_verdicts_are_coloured_on_terminals_only() -> None:
    plain = in_pipe(*PROVE)
    assert plain.startswith("PROVED")
    coloured = on_terminal(*PROVE, columns=300)
    assert coloured.startswith(GREEN)
    assert COLOUR.sub("", coloured) == plain
    assert in_pipe(*PROVE, FORCE_COLOR="1").startswith(GREEN)
    for more in ({"NO_COLOR": "1"}, {"TERM": "dumb"}, {"NO_COLOR": "1", "FORCE_COLOR": "1"}):
        assert on_terminal(*PROVE, columns=300, **more) == plain


def test_json_is_never_coloured() -> None:
    shown = on_terminal(*PROVE, "--json", "-", columns=40, FORCE_COLOR="1")
    assert '"verdict": "PROVED"' in shown
    assert "\033" not in shown


def test_lines_fit_the_terminal() -> None:
    plain, narrow = in_pipe("list"), on_terminal("list", columns=70)
    assert max(map(len, narrow.splitlines())) <= 70 < max(map(len, plain.splitlines()))
    assert narrow.split() == plain.split()
    assert on_terminal("list", COLUMNS="300") == plain
    assert on_terminal("show", "4", "--format", "latex", columns=40) == in_pipe(
        "show", "4", "--format", "latex"
    )


def test_definitions_on_a_narrow_terminal_can_be_read_back() -> None:
    narrow = on_terminal("show", "4", columns=60)
    assert max(map(len, (x for x in narrow.splitlines() if '"' not in x))) <= 60
    assert all(x.startswith("# ") for x in narrow.split("\n\n")[0].splitlines())


@pytest.mark.parametrize(
    ("line", "fitted"),
    [
        ("short", "short"),
        ("  name  a text that is too long", "  name  a text that\n        is too long"),
        ("a text without columns is wrapped", "a text without\n  columns is wrapped"),
        ("# a comment stays a comment", "# a comment stays a\n# comment"),
        ("1  2  3  4  5  6  7  8  9", "1  2  3  4  5  6  7…"),
        ("word " + "x" * 30, "word\n  " + "x" * 30),
    ],
)
def test_long_lines(line: str, fitted: str) -> None:
    assert fit(line, 20) == fitted


# --- The README as a new user types it (tests/fresh.py); the whole of it with ROADPROOF_FRESH=1 -----

PAGE = """Text.

```sh
make demo                # installs
.venv/bin/tool 1  # a first answer
```

Run `source it` once, and `tool` suffices.

```console
$ echo one
one
$ pwd; false
…
[exit 1]
```
"""


def test_commands_are_typed_in_order_with_what_they_print() -> None:
    assert list(fresh.typed(PAGE)) == [
        ("make demo", None),
        (".venv/bin/tool 1", None),
        ("source it", None),
        ("echo one", ("one",)),
        ("pwd; false", ("…", "[exit 1]")),
    ]


def test_a_difference_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    tmp_path.chmod(0o755)
    monkeypatch.setattr(fresh, "clone", lambda folder: folder)
    monkeypatch.setattr(fresh, "NOBODY", ())
    page = "```sh\nmissing-command\n```\n```console\n$ echo two\none\n$ echo $HOME; false\n…\n[exit 1]\n```\n"
    missing, two = fresh.type_all(page, tmp_path)
    assert missing.startswith("$ missing-command\n")
    assert missing.endswith("[exit 127]")
    assert two == "$ echo two\ntwo\n[exit 0]"


@pytest.mark.skipif(
    "ROADPROOF_FRESH" not in os.environ, reason="installs roadproof anew: set ROADPROOF_FRESH=1"
)
def test_a_new_user_types_the_readme() -> None:
    assert fresh.main() == 0
