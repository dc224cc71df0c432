"""Completion on Tab, asked of each shell that is installed with the script that roadproof prints."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from roadproof.frontends.cli.completion import _VALUES
from roadproof.frontends.cli.help import COMMANDS, command_parser

BASH = """
eval "$(roadproof completion bash)"
COMP_LINE=$1; COMP_POINT=${#COMP_LINE}; COMP_TYPE=9
_python_argcomplete roadproof
printf '%s\\n' "${COMPREPLY[@]}"
"""
ZSH = """
autoload -Uz compinit; compinit -u -D
eval "$(roadproof completion zsh)"
_describe() { print -l -- "${(@P)2}" }
BUFFER=$1; CURSOR=${#1}; words=(${(z)1})
_python_argcomplete
"""
FISH = """
roadproof completion fish | source
complete -C $argv[1]
"""
SHELLS = {"bash": ("bash", "--norc"), "zsh": ("zsh", "-f"), "fish": ("fish", "--no-config")}
SCRIPTS = {"bash": BASH, "zsh": ZSH, "fish": FISH}
BETWEEN = {"bash": "\t", "zsh": ":", "fish": "\t"}
"""What separates a word from its description."""


def completed(shell: str, line: str, folder: Path) -> list[str]:
    if shutil.which(shell) is None:
        pytest.skip(f"{shell} is not installed")
    script = folder / f"script.{shell}"
    script.write_text(SCRIPTS[shell], "utf-8")
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    done = subprocess.run(
        [*SHELLS[shell], str(script), line],
        cwd=folder,
        env={**os.environ, "PATH": path, "TERM": "dumb"},
        capture_output=True,
        text=True,
        timeout=60,
    )
    return [x.split(BETWEEN[shell])[0].rstrip() for x in done.stdout.splitlines() if x.strip()]


@pytest.mark.parametrize("shell", SHELLS)
@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("roadproof wit", ["witness"]),
        ("roadproof witness 4 --unprev", ["--unpreventable"]),
        ("roadproof witness 4 --set b", ["base"]),
        ("roadproof witness 2", ["2", "20", "21", "22", "23", "24"]),
        ("roadproof overlap --among 1,2", ["1,2", "1,20", "1,21", "1,22", "1,23", "1,24"]),
        ("roadproof prove --spec dri", ["driver", "drives/"]),
        ("roadproof witness 4 --param minD", ["minDanger="]),
        ("roadproof export drives --to highd,a", ["highd,animation"]),
    ],
)
def test_a_shell_completes(shell: str, line: str, words: list[str], tmp_path: Path) -> None:
    (tmp_path / "drives").mkdir()
    assert sorted(completed(shell, line, tmp_path)) == words


@pytest.mark.parametrize("shell", SHELLS)
def test_a_shell_completes_names_of_scenarios(shell: str, tmp_path: Path) -> None:
    found = [x.replace("\\", "") for x in completed(shell, "roadproof show cut-i", tmp_path)]
    sectors = ("main road", "merge zone", "departure zone")
    names = {f"cut-in, lane {x}, {sector}" for x in ("keep", "change") for sector in sectors}
    assert {*found} == {"cut-in", *names}


def test_completed_names_are_accepted(tmp_path: Path) -> None:
    from roadproof.frontends.cli.completion import _scenarios
    from roadproof.library.loading import bundled_library
    from roadproof.library.scenario_references import numbers_called

    names = _scenarios("c")
    assert len(names) > 24
    assert all(numbers_called(bundled_library().select(), name) for name in names)


def test_every_list_of_values_belongs_to_an_option_or_argument() -> None:
    actions = [x for name in COMMANDS for x in command_parser(name)._actions]
    assert {*_VALUES} <= {word for x in actions for word in (*x.option_strings, x.metavar)}
