"""Colours and widths are for terminals: in a pipe every byte is as it was."""

import fcntl
import os
import pty
import re
import struct
import subprocess
import sys
import termios
from pathlib import Path

import pytest

from roadproof.frontends.cli.terminal import _COLOURS, fit, paint
from roadproof.verdict import Verdict

ROADPROOF = str(Path(sys.executable).parent / "roadproof")
PROVE = ("prove", "danger(SV,POV) -> danger(SV,POV)")
COLOUR = re.compile(r"\033\[\d+m")
SECONDS = re.compile(r"\d+\.\d+ s\b")
GREEN = "\033[32mPROVED\033[0m"


def environment(**more: str) -> dict[str, str]:
    names = ("NO_COLOR", "FORCE_COLOR", "COLUMNS", "TERM")
    plain = {name: value for name, value in os.environ.items() if name not in names}
    return {**plain, "TERM": "xterm", **more}


def in_pipe(*words: str, **more: str) -> str:
    done = subprocess.run([ROADPROOF, *words], capture_output=True, env=environment(**more))
    return SECONDS.sub("…", done.stdout.decode())


def on_terminal(*words: str, columns: int = 80, **more: str) -> str:
    """What a command writes on a terminal of that width."""
    ours, its = pty.openpty()
    fcntl.ioctl(its, termios.TIOCSWINSZ, struct.pack("HHHH", 40, columns, 0, 0))
    command = subprocess.Popen(
        [ROADPROOF, *words], stdin=its, stdout=its, stderr=subprocess.DEVNULL, env=environment(**more)
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
    assert on_terminal(*PROVE, columns=300).startswith(GREEN)
    assert COLOUR.sub("", on_terminal(*PROVE, columns=300)) == plain
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
