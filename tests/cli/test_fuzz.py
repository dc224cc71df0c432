"""Command lines at random, made from what each sub-command says of its options: none is our fault.

Long work is cut short where its jobs begin, so that what is tried is how command lines and files are
read. By hand, with more seeds and the jobs done: ``python tests/cli/test_fuzz.py FIRST LAST``.
"""

import argparse
import contextlib
import io
import os
import random
import re
import sys
import tempfile
import traceback
from collections.abc import Iterator, Sequence
from pathlib import Path

import pytest

from roadproof.errors import RoadproofError
from roadproof.extensions.catalogue import completing
from roadproof.extensions.pages.studio.server import serve
from roadproof.frontends.cli.help import command_parser
from roadproof.frontends.cli.main import COMMANDS, answer
from roadproof.runtime import pool
from roadproof.runtime.package_data import shipped_folder
from roadproof.verdict import ExitCode
from tables import read_table

SEEDS = range(4)
LINES = 8  # command lines a seed and sub-command
FORMULAS = (*read_table(__file__, "formulas"), "\udcff")
TEXTS = (*read_table(__file__, "texts"), "\udcff")
NUMBERS = tuple(read_table(__file__, "numbers"))
WORDS = read_table(__file__, "words") | {
    "FORMULA": FORMULAS,
    "CLAIM": (*FORMULAS, "P1", "P4", "P99", "N1"),
    "N|FORMULA": (*FORMULAS, "1", "4", "24", "25", "-1", "٣"),
    "WHAT": (*FORMULAS, "4", "danger", "25", "rho"),
    "F1": (*FORMULAS[:4], "4", "25"),
    "F2": (*FORMULAS[:4], "4", "25"),
}


class BegunError(RoadproofError):
    """In place of long work."""

    exit_code = ExitCode.UNKNOWN


def begin(*_: object, **__: object) -> Iterator[tuple[int, object]]:
    raise BegunError("the work begins here")
    yield


def make_files(folder: Path) -> tuple[str, ...]:
    """Files of many kinds, and paths where there is none."""
    contents = {
        "good.spec": b"def mine(a: vehicle) := v_lon(a) > 3 m/s\n",
        "bad.spec": b"def mine(a: vehicle) := && true\n",
        "latin.spec": b'def p(a: vehicle) "gr\xf6sser" := true\n',
        "claims.txt": b"danger(SV,POV)\n\nF danger(SV, POV)\n",
        "empty.txt": b"",
        "zeros.json": b"\0\0\0",
        "list.json": b"[1, 2]",
        "deep.json": b"[" * 100_000,
        "number.json": b'{"schema": ' + b"9" * 5000 + b"}",
        "drive.json": b'{"schema": "roadproof/drive/1"}',
        "certificate.json": b'{"schema": "roadproof/certificate/1"}',
        "road.toml": b"name = 3\n",
        "samples.csv": b"time,vehicle,s,d,v_lon,v_lat,a_lon,a_lat,length,width\n0,SV,0,3,20,0,0,0,4,2\n",
        "bad.csv": b"time,vehicle\n0\n",
        "01_tracks.csv": b"frame,id\n",
        "01_tracksMeta.csv": b"id\n",
        "01_recordingMeta.csv": b"id,frameRate\n1,nan\n",
    }
    for name, content in contents.items():
        (folder / name).write_bytes(content)
    (folder / "inside").mkdir()
    good = folder / "good.json"
    good.write_bytes((shipped_folder("proofs") / "C1-base.json").read_bytes())
    paths = [str(folder / name) for name in contents] + [str(folder / "inside"), str(folder), str(good)]
    return (*paths, "nowhere", "nowhere/file.json", str(folder / "01_tracks.csv:1,2"), "-", "")


def value_of(option: argparse.Action, files: Sequence[str], chance: random.Random) -> str:
    if chance.random() < 0.08:
        return chance.choice(TEXTS)
    if option.choices is not None:
        return str(chance.choice([*option.choices]))
    metavar = str(option.metavar)
    if option.type in (int, float):
        return chance.choice(NUMBERS)
    if option.type is Path or metavar in ("FILE", "DIR", "PATH", "TRACE", "FILE|DIR"):
        return chance.choice(files)
    return chance.choice(WORDS.get(metavar, TEXTS))


def command_line(name: str, files: Sequence[str], chance: random.Random) -> list[str]:
    """A sub-command with some of its options and arguments."""
    line: list[str] = []
    positional: list[str] = []
    for option in command_parser(name)._actions:
        if {"--help", "--help-all"} & {*option.option_strings}:
            continue
        if not option.option_strings:
            few = 1 if option.nargs is None else chance.choice((0, 1, 1, 1, 2))
            positional += [value_of(option, files, chance) for _ in range(few)]
        elif option.required or chance.random() < 0.2:
            times = 2 if chance.random() < 0.1 else 1
            for _ in range(times):
                value = [] if option.nargs == 0 else [value_of(option, files, chance)]
                line += [chance.choice(option.option_strings), *value]
    return [name, *line, *(["--"] if chance.random() < 0.1 else []), *positional]


def try_one(line: list[str]) -> str:
    """What is wrong with the answer to a command line, or nothing."""
    out, complaints = io.TextIOWrapper(io.BytesIO(), "utf-8"), io.TextIOWrapper(io.BytesIO(), "utf-8")
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(complaints):
        try:
            code = answer(line)
        except SystemExit as exit:
            code = int(exit.code or 0)
        except Exception:  # let through for its trace, see TRACEBACK
            return traceback.format_exc()
    complaints.flush()
    said = complaints.buffer.getvalue().decode("utf-8")  # type: ignore[attr-defined]
    if code not in (0, 2, 3, 4, 10, 20):
        return f"exit code {code}: {said}"
    if code in (2, 4) and not said.startswith("roadproof: "):
        return f"exit code {code} without a word: {said}"
    known = {text for option in command_parser(line[0])._actions for text in option.option_strings}
    hints = set(re.findall(r"(?<![\w-])--[a-z][a-z-]*", said)) if code in (2, 3, 4) else set()
    return f"hints at what is not there: {hints - known}: {said}" if hints - known else ""


def replace_everywhere(monkeypatch: pytest.MonkeyPatch, function: object, other: object) -> None:
    """In every module that has the function, under whatever name."""
    for module in [x for name, x in sys.modules.items() if name.partition(".")[0] == "roadproof"]:
        for name in [name for name, value in vars(module).items() if value is function]:
            monkeypatch.setattr(module, name, other)


@pytest.mark.parametrize("name", COMMANDS)
def test_no_command_line_is_our_fault(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROADPROOF_TRACEBACK", "1")
    replace_everywhere(monkeypatch, pool.work, begin)
    replace_everywhere(monkeypatch, completing.search_drive_or_unknown, begin_at_once)
    replace_everywhere(monkeypatch, serve, begin_at_once)
    files = make_files(tmp_path)
    monkeypatch.chdir(tmp_path / "inside")
    for seed in SEEDS:
        chance = random.Random(f"{name} {seed}")
        for _ in range(LINES if name in ("list", "show", "check", "monitor") else LINES // 2):
            line = command_line(name, files, chance)
            wrong = try_one(line)
            assert not wrong, f"{line}: {wrong}"


def begin_at_once(*_: object, **__: object) -> object:
    raise BegunError("the work begins here")


def run_long(first: int, last: int) -> None:
    """Many seeds; jobs are done, in a process each, as far as a minute goes."""
    import signal

    os.environ["ROADPROOF_TRACEBACK"] = "1"
    tried = cut = wrong = 0
    seen: set[str] = set()
    for seed in range(first, last):
        with tempfile.TemporaryDirectory() as folder:
            files = make_files(Path(folder))
            os.chdir(Path(folder) / "inside")
            for name in COMMANDS:
                chance = random.Random(f"{name} {seed}")
                for _ in range(LINES):
                    line = command_line(name, files, chance)
                    tried += 1
                    child = os.fork()
                    if child == 0:
                        os.setpgid(0, 0)
                        signal.alarm(int(os.environ.get("FUZZ_SECONDS", "20")))
                        fault = try_one(line)
                        key = fault.strip().splitlines()[-1] if fault else ""
                        if fault:
                            Path(folder, "fault").write_text(f"{key}\n{line}\n{fault}", errors="replace")
                        os._exit(1 if fault else 0)
                    _, status = os.waitpid(child, 0)
                    with contextlib.suppress(ProcessLookupError):
                        os.killpg(child, signal.SIGKILL)
                    if os.WIFSIGNALED(status):
                        cut += 1
                        if os.WTERMSIG(status) != signal.SIGALRM:
                            print("DIED", os.WTERMSIG(status), line, flush=True)
                    elif status:
                        wrong += 1
                        text = Path(folder, "fault").read_text()
                        if text.splitlines()[0] not in seen:
                            seen.add(text.splitlines()[0])
                            print(text, flush=True)
            os.chdir("/")
        print(f"seed {seed}: {tried} tried, {cut} cut off, {wrong} wrong, {len(seen)} kinds", flush=True)


if __name__ == "__main__":
    run_long(int(sys.argv[1]), int(sys.argv[2]))
