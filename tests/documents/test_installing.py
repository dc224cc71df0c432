"""Roadproof is on no package index yet, so no text tells to install it from one."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
SUFFIXES = {".md", ".py", ".yml", ".yaml", ".toml", ".html", ".js", ".sh", ".csv"}
FOLDERS = ("docs", "examples", "src", "benchmarks", "tests")
FROM_INDEX = re.compile(
    r"\b(?:pip3?|pipx|uv)\b[^\n`]*?\b(?:install|add|run)\b[^\n`]*?[ \t'\"]roadproof(?=[\[\]=~<>\s'\"`,;)]|$)"
)
"""An install command whose package is called roadproof, with or without extras or a version."""


def texts() -> list[Path]:
    files = (x for name in FOLDERS for x in sorted((ROOT / name).rglob("*")))
    return [
        ROOT / "README.md",
        *(x for x in files if x.suffix in SUFFIXES and x != Path(__file__) and "node_modules" not in x.parts),
    ]


def test_no_text_installs_it_from_an_index() -> None:
    files = texts()
    assert len(files) > 1000
    found = {
        str(x.relative_to(ROOT)): m[0]
        for x in files
        if (m := FROM_INDEX.search(x.read_text("utf-8", "replace")))
    }
    assert found == {}


@pytest.mark.parametrize(
    "command",
    [
        "pip install roadproof",
        "python -m pip install --quiet 'roadproof[studio]'",
        'pip3 install -U "roadproof>=1"',
        "`pipx install roadproof`",
        "uv tool install roadproof",
        "uv pip install roadproof==1.0",
        "pip install numpy roadproof",
    ],
)
def test_such_a_command_is_noticed(command: str) -> None:
    assert FROM_INDEX.search(f"say {command}\n")


@pytest.mark.parametrize(
    "command",
    [
        "pip install ./roadproof",
        "pip install './roadproof[studio]'",
        "pip install '.[cluster]'",
        "pip install out/release/roadproof-1.0-py3-none-any.whl",
        "pip install cvc5",
    ],
)
def test_a_checkout_or_wheel_is_none(command: str) -> None:
    assert not FROM_INDEX.search(f"say {command}\n")


@pytest.mark.parametrize(
    "guide",
    [
        "README.md",
        "docs/how-to/ci.md",
        "docs/how-to/studio.md",
        "docs/how-to/machines.md",
        "docs/how-to/solvers.md",
    ],
)
def test_guides_name_the_checkout(guide: str) -> None:
    assert "checkout" in (ROOT / guide).read_text("utf-8")
