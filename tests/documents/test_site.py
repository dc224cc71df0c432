"""The documentation site builds without a warning, and all its links resolve."""

import os
import re
import subprocess
import sys
from html.parser import HTMLParser
from importlib.util import find_spec
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest

from documents.reference import EXIT_CODES, PAGES
from roadproof.frontends.cli.help import command_parser
from roadproof.frontends.cli.main import COMMANDS
from roadproof.library.loading import bundled_library
from roadproof.verdict import ExitCode

ROOT = Path(__file__).parents[2]
LINK = re.compile(r"\]\(([^)\s#]+)(?:#[^)]*)?\)")
needs_mkdocs = pytest.mark.skipif(
    not all(map(find_spec, ("mkdocs", "material", "mkdocstrings"))),
    reason="mkdocs, mkdocs-material or mkdocstrings is not installed (pip install -e '.[docs]')",
)


class Document(HTMLParser):
    """The anchors of a page, and everything that it refers to."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.anchors: set[str] = set()
        self.targets: set[str] = set()
        self.feed(page)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        for name, value in attrs:
            if name in ("id", "name"):
                self.anchors.add(value or "")
            elif name in ("href", "src") and value:
                self.targets.add(value)


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("site")
    done = subprocess.run(
        [sys.executable, "-m", "mkdocs", "build", "--strict", "--site-dir", str(folder)],
        cwd=ROOT,
        env={**os.environ, "NO_MKDOCS_2_WARNING": "1", "PYTHONPATH": str(ROOT / "src")},
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert done.returncode == 0, done.stderr
    assert "WARNING" not in done.stderr
    return folder


@needs_mkdocs
def test_all_links_and_anchors_of_the_site_resolve(site: Path) -> None:
    pages = {path: Document(path.read_text("utf-8")) for path in site.rglob("*.html")}
    assert len(pages) > 50
    broken = []
    for path, page in pages.items():
        if path.name == "404.html":  # a server's page; its links are absolute
            continue
        for target in page.targets:
            parts = urlsplit(target)
            if parts.scheme or parts.netloc:
                continue
            file = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            missing = not file.exists() or (
                parts.fragment and file in pages and unquote(parts.fragment) not in pages[file].anchors
            )
            if missing and parts.fragment != "__skip":
                broken.append(f"{path.relative_to(site)}: {target}")
    assert broken == []


@needs_mkdocs
def test_the_site_loads_nothing_from_a_network(site: Path) -> None:
    loads = re.compile(
        r"<(?:script|img|iframe)\b[^>]*\bsrc=\"?(https?:[^\s\">]+)|<link\b[^>]*\bhref=\"?(https?:[^\s\">]+)"
    )
    found = {path.name: loads.findall(path.read_text("utf-8")) for path in site.rglob("*.html")}
    assert {name: loaded for name, loaded in found.items() if loaded} == {}


@needs_mkdocs
def test_the_search_finds_the_pages(site: Path) -> None:
    index = (site / "search" / "search_index.js").read_text("utf-8")
    for word in ("NONE-WITHIN", "dRSS_lon", "--complete", "OpenSCENARIO", "signal"):
        assert word in index


def test_the_index_of_the_reference_names_each_page() -> None:
    index = (ROOT / "docs" / "reference" / "index.md").read_text("utf-8")
    titles = {write().partition("\n")[0].removeprefix("# ") for write in PAGES.values()}
    assert {*re.findall(r"^## (.+)$", index, re.MULTILINE)} == titles
    pages = {x.name for x in (ROOT / "docs" / "reference").glob("*.md")}
    assert {*re.findall(r"^- \[[^\]]+\]\(([\w-]+\.md)\)", index, re.MULTILINE)} == pages - {"index.md"}


def test_the_generated_pages_hold_all_that_the_program_has() -> None:
    pages = {name: write() for name, write in PAGES.items()}
    assert all(f"\n## {name}\n" in pages["reference/commands.md"] for name in COMMANDS)
    assert all(
        f"def {name}" in pages["reference/library.md"] for name in bundled_library().select().definitions
    )
    assert set(EXIT_CODES) == set(ExitCode)
    assert "::: roadproof.prove\n" in pages["reference/api.md"]
    assert "roadproof/witness/1" in pages["reference/json.md"]


@needs_mkdocs
def test_examples_in_docstrings_become_blocks() -> None:
    from documents.doctests import fenced

    assert fenced("Add.\n\n>>> 1 + 1\n2\n\nMore.") == "Add.\n\n```pycon\n>>> 1 + 1\n2\n```\n\nMore."


def test_every_option_is_in_the_reference() -> None:
    page = PAGES["reference/commands.md"]()
    for name in COMMANDS:
        parser = command_parser(name)
        section = page.partition(f"\n## {name}\n")[2].partition("\n## ")[0]
        for action in parser._actions:
            assert all(f"`{option}" in section for option in action.option_strings), (name, action)


@needs_mkdocs
def test_data_becomes_a_table(tmp_path: Path) -> None:
    from documents.hooks import table

    path = tmp_path / "times.csv"
    path.write_text('question,s\n"`overlap`, all",4.5\n', "utf-8")
    assert table("Times", path) == "**Times**\n\n| question | s |\n| --- | ---: |\n| `overlap`, all | 4.5 |"


@needs_mkdocs
def test_every_table_of_data_is_on_a_page(site: Path) -> None:
    pages = "".join(path.read_text("utf-8") for path in site.glob("*/*.html"))
    for path in ROOT.glob("docs/data/**/*.csv"):
        assert f"/{path.name})" in "".join(x.read_text("utf-8") for x in ROOT.glob("docs/*/*.md")), path
    assert "perception by distance" in pages


def test_every_question_is_in_the_reference() -> None:
    page = PAGES["reference/api.md"]().partition("\n## Functions\n")[0]
    for name in {"prove", "witness", "catalogue", "evaluate"}:
        assert f"| [{name}](#roadproof.{name}) | " in page
    assert "(#roadproof.F)" not in page
