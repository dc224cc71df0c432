"""Manual pages have every command and option, and programs that read manual pages accept them."""

import argparse
import shutil
import subprocess
from pathlib import Path

import pytest

from documents.man import pages, write
from documents.reference import spellings
from roadproof.frontends.cli.help import command_parser
from roadproof.frontends.cli.overview import COMMANDS


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made: Path = tmp_path_factory.mktemp("man") / "man1"
    write(made)
    return made


def shown(*command: str) -> str:
    if shutil.which(command[0]) is None:
        pytest.skip(f"{command[0]} is not installed")
    done = subprocess.run(command, capture_output=True, text=True, timeout=60)
    assert (done.returncode, done.stderr) == (0, "")
    return done.stdout


def test_every_command_has_a_page_with_all_its_options() -> None:
    made = pages()
    assert {*made} == {"roadproof.1", *(f"roadproof-{name}.1" for name in COMMANDS)}
    for name in COMMANDS:
        text = made[f"roadproof-{name}.1"].replace("\\-", "-").replace("\\[u2026]", "…")
        assert f".B roadproof {name}\n" in text
        actions: list[argparse.Action] = command_parser(name)._actions
        assert all(f"\\fB{', '.join(spellings(x))}\\fR\n" in text for x in actions)
        assert f".BR roadproof-{name} (1)\n" in made["roadproof.1"].replace("\\-", "-")


def test_groff_sets_all_pages_without_a_warning(folder: Path) -> None:
    for path in folder.iterdir():
        assert "roadproof" in shown("groff", "-man", "-Tutf8", "-ww", str(path))


def test_man_shows_a_page(folder: Path) -> None:
    text = shown("man", "--nh", "--nj", "-P", "cat", "-l", str(folder / "roadproof-witness.1"))
    assert "roadproof-witness - find a drive on which a scenario or a formula holds" in text
    assert "--objective KIND" in text


def test_mandoc_finds_no_error(folder: Path) -> None:
    assert shown("mandoc", "-T", "lint", "-W", "error", *map(str, sorted(folder.iterdir()))) == ""
