"""Relative links of documents lead to files and headings of the checkout."""

import re
from collections.abc import Iterator, Mapping
from pathlib import Path

ROOT = Path(__file__).parents[2]
LINK = re.compile(r"\]\(([^)\s]+)\)")
FOLDERS = ("docs", "examples", "models", "proofs", "tests")


def prose(text: str) -> str:
    """A text without its blocks of code."""
    return re.sub(r"^```.*?^```", "", text, flags=re.DOTALL | re.MULTILINE)


def headings(text: str) -> set[str]:
    """The anchors of a text."""
    named = re.findall(r"^#+ (.*)$", prose(text), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", x).strip().lower().replace(" ", "-") for x in named}


def dead(texts: Mapping[Path, str]) -> Iterator[tuple[Path, str]]:
    for path, text in texts.items():
        for link in LINK.findall(prose(text)):
            if re.match(r"[a-z]+:", link):
                continue
            name, _, anchor = link.partition("#")
            target = (path.parent / name).resolve() if name else path
            if not target.exists():
                yield path, link
            elif anchor and target.suffix == ".md":
                there = headings(texts.get(target) or target.read_text("utf-8"))
                yield from [(path, link)] * (anchor not in there)


def test_every_relative_link_leads_somewhere() -> None:
    paths = [*ROOT.glob("*.md"), *(x for y in FOLDERS for x in (ROOT / y).rglob("*.md"))]
    texts = {x.resolve(): x.read_text("utf-8") for x in paths}
    assert sum(len(LINK.findall(x)) for x in texts.values()) > 100
    assert [*dead(texts)] == []
    readme = (ROOT / "README.md").resolve()
    wrong = {readme: "[a](docs/nowhere.md) [b](README.md#no-heading) [c](#none) [d](docs/reference/api.md)"}
    assert len([*dead(wrong)]) == 4


def test_pages_that_the_source_names_are_there() -> None:
    named = re.compile(r"\bdocs/[\w/-]+\.md\b")
    files = [x for x in (ROOT / "src").rglob("*") if x.suffix in (".py", ".html", ".js", ".toml", ".sh")]
    found = {page for x in files for page in named.findall(x.read_text("utf-8"))}
    assert len(found) > 5
    assert [x for x in sorted(found) if not (ROOT / x).is_file()] == []
