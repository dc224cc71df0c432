"""A package of others that is broken, or takes a name that is taken, is refused by name."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
HEAD = "from roadproof.extension import Extension\nEXTENSION = Extension(title='mine', audience='testers', "
# The text of a package, the name of its entry point, a command, and what is said.
BAD = {
    "does not import": ("import nowhere", "mine", "list", "ModuleNotFoundError: No module named 'nowhere'"),
    "is no Python": ("x =", "mine", "list", "SyntaxError"),
    "raises": ("1 / 0", "mine", "--help", "ZeroDivisionError"),
    "has no record": ("x = 1", "mine", "list", "has no EXTENSION of the class Extension"),
    "has an unknown slot": (f"{HEAD}colour='x')", "mine", "list", "unexpected keyword argument 'colour'"),
    "has no such audience": (f"{HEAD[:-11]}'all')", "mine", "list", "audience='all' of theirs is none of"),
    "has no such label": (f"{HEAD}label='old')", "mine", "list", "label='old' of theirs is none of stable"),
    "needs what is not there": (f"{HEAD}needs=('absent',))", "mine", "list", "it needs absent"),
    "has the name of ours": (f"{HEAD})", "traffic", "list", "roadproof.extensions.traffic and theirs both"),
    "takes a question": (
        f"{HEAD}questions={{'coverage': 'a:b'}})",
        "mine",
        "list",
        "questions='coverage' is in",
    ),
    "takes a modifier": (
        f"{HEAD}modifiers={{'prevention': 'a:b'}})",
        "mine",
        "prove P4",
        "'prevention' is in",
    ),
    "takes evidence": (
        f"{HEAD}evidence={{'roadproof/boundary/1': 'a:b'}})",
        "mine",
        "prove P4",
        "is in 'drivers'",
    ),
    "names what is not there": (
        f"{HEAD}checked_files={{'.x': 'theirs.none:f'}})",
        "mine",
        "check file.x",
        "theirs.none:f is named, but not there",
    ),
}


def run(folder: Path, *command: str) -> subprocess.CompletedProcess[str]:
    paths = os.pathsep.join([str(ROOT / "src"), str(folder)])
    environment = {**os.environ, "PYTHONPATH": paths, "XDG_CACHE_HOME": str(folder / "cache")}
    return subprocess.run(
        [sys.executable, *command], cwd=folder, env=environment, capture_output=True, text=True
    )


def install(folder: Path, package: str, name: str, text: str) -> None:
    about = folder / f"{package}-1.0.dist-info"
    about.mkdir()
    (about / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {package}\nVersion: 1.0\n")
    (about / "entry_points.txt").write_text(f"[roadproof.extensions]\n{name} = {package}\n")
    (folder / package).mkdir()
    (folder / package / "__init__.py").write_text(text)


@pytest.mark.parametrize("kind", BAD)
def test_it_is_refused_by_name(kind: str, tmp_path: Path) -> None:
    text, name, command, said = BAD[kind]
    (tmp_path / "file.x").write_text("x")
    install(tmp_path, "theirs", name, text)
    told = run(tmp_path, "-m", "roadproof", *command.split())
    assert (told.returncode, told.stdout) == (3, ""), told
    assert told.stderr.startswith("roadproof: extension '")
    assert said in told.stderr
    assert len(told.stderr.splitlines()) == 1


def test_two_of_others_have_one_name(tmp_path: Path) -> None:
    install(tmp_path, "theirs", "mine", f"{HEAD})")
    install(tmp_path, "others", "mine", f"{HEAD})")
    told = run(tmp_path, "-m", "roadproof", "list")
    assert told.returncode == 3
    assert "extension 'mine': others and theirs both have this name" in told.stderr


def test_a_command_that_is_there_already(tmp_path: Path) -> None:
    install(tmp_path, "theirs", "mine", f"{HEAD})")
    (tmp_path / "theirs/commands").mkdir()
    (tmp_path / "theirs/commands/prove.py").write_text('SUMMARY = "prove otherwise"\n')
    told = run(tmp_path, "-m", "roadproof", "prove", "P4")
    assert (told.returncode, told.stdout) == (3, "")
    assert "the command prove is there already; uninstall theirs" in told.stderr


def test_a_function_of_python_that_is_there_already(tmp_path: Path) -> None:
    install(tmp_path, "theirs", "mine", f"{HEAD}functions={{'prove': 'theirs:f'}})")
    told = run(tmp_path, "-c", "import roadproof; roadproof.catalogue")
    assert "InputError: extension 'mine': functions='prove' is roadproof.frontends.api.proofs" in told.stderr


def test_a_question_of_the_core(tmp_path: Path) -> None:
    assert run(tmp_path, "-m", "roadproof", "prove", "P4", "--out", "p4", "--quiet").returncode == 0
    install(tmp_path, "theirs", "mine", f"{HEAD}questions={{'prove': 'a:b'}})")
    told = run(tmp_path, "-m", "roadproof", "check", "p4")
    assert told.returncode == 10
    assert "extension 'mine': questions='prove' is " in told.stdout + told.stderr
