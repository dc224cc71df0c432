"""A command loads the modules that its answer needs, and few others.

A module that is imported by name, at its first use, costs nothing before. These tests fail where a checker, a
codec or a page is imported at the top of a module that all commands load.
"""

import os
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

import pytest

MOST_MODULES: Mapping[str, int] = {
    "--help": 22,
    "witness 1": 139,
    "overlap --among 4,5,8": 152,
    "prove P4": 157,
    "simulate --seconds 10 --jobs 1 --quiet --out OUT": 61,
}
"""By command with known answers: the most modules of roadproof that are there at its end.

Each extension is a module, and its options of a command another one.
"""
MOST_FILES = 151
"""The most files of roadproof of which ``overlap --among 4,5,8 --no-pictures`` runs any line."""

_NOTE_MODULES = """
import atexit, os, sys

def note():
    names = sorted(x for x in sys.modules if x.partition(".")[0] == "roadproof")
    with open(os.path.join(os.environ["NOTES"], str(os.getpid())), "w") as file:
        file.write("\\n".join(names))

atexit.register(note)
from roadproof.frontends.cli.entry import main
sys.exit(main())
"""
_COUNT_FILES = """
import sys

files = set()
note = lambda frame, event, value: files.add(frame.f_code.co_filename) if event == "call" else None
sys.setprofile(note)
from roadproof.frontends.cli.main import answer
code = answer(sys.argv[1:])
sys.setprofile(None)
print(code, sum("/src/roadproof/" in x for x in files), file=sys.stderr)
"""


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the home of a user who has the shipped answers, and has parsed the library once."""
    folder = tmp_path_factory.mktemp("home")
    run(folder, "-m", "roadproof", "list")
    return folder


def run(home: Path, *command: str, **more: str) -> subprocess.CompletedProcess[str]:
    kept = {name: value for name, value in os.environ.items() if not name.startswith("ROADPROOF")}
    env = kept | {"HOME": str(home), "XDG_CACHE_HOME": str(home / "cache"), **more}
    return subprocess.run([sys.executable, *command], env=env, capture_output=True, text=True, check=True)


def modules_loaded(home: Path, command: str, notes: Path) -> list[str]:
    """Return the modules that a command has loaded; its second run, as the first one fills caches."""
    for place in (notes / "first", notes / "second"):
        place.mkdir()
        words = command.replace("OUT", str(place / "out")).split()
        run(home, "-c", _NOTE_MODULES, *words, NOTES=str(place))
    every = [file.read_text().splitlines() for file in place.iterdir() if file.is_file()]
    return max(every, key=len)  # the process that watches the command has fewer


@pytest.mark.parametrize("command", MOST_MODULES)
def test_a_command_loads_few_modules(command: str, home: Path, tmp_path: Path) -> None:
    names = modules_loaded(home, command, tmp_path)
    assert len(names) <= MOST_MODULES[command], "\n".join(names)


def test_a_recalled_answer_enters_few_files(home: Path) -> None:
    command = ("-c", _COUNT_FILES, "overlap", "--among", "4,5,8", "--no-pictures")
    run(home, *command)
    code, count = map(int, run(home, *command).stderr.splitlines()[-1].split())
    assert code == 0
    assert count <= MOST_FILES
