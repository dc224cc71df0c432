"""Pages of the documentation: what they show of Python is typed in, and prints what they say."""

from pathlib import Path
from typing import Any

import pytest

from console import agree
from pages import Example, examples_of, rewritten, run

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "docs/reference/python.md", ROOT / "docs/how-to/jupyter.md", ROOT / "README.md"]


@pytest.mark.parametrize("path", PAGES, ids=lambda x: x.stem)
def test_page(path: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {}
    found = [*examples_of(path.read_text("utf-8"))]
    assert found
    for example in found:
        printed = run(example, names)
        told = f"{path.name}:{example.line}: {example.source}" + "\n".join(printed)
        assert agree(printed, example.expected), told


def test_a_difference_is_noticed() -> None:
    page = "```pycon\n>>> x = [\n...     1]\n>>> x\n[2]\n>>> 1 / 0\nZeroDivisionError: …\n```\n"
    first, second, third = examples_of(page)
    assert first == Example("x = [\n    1]\n", (), 2)
    names: dict[str, Any] = {}
    assert run(first, names) == []
    assert not agree(run(second, names), second.expected)
    assert agree(run(third, names), third.expected)
    assert rewritten(page) == page.replace("[2]", "[1]").replace("…", "division by zero")
