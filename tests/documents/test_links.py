"""Relative links of documents lead to files, headings, or pages in the navigation of the site."""

import re
from collections.abc import Iterator, Mapping
from pathlib import Path

ROOT = Path(__file__).parents[2]
LINK = re.compile(r"\]\(([^)\s]+)\)")
PAGE = re.compile(r"[\w/-]+\.md")
TOP = ("README.md", "CONTRIBUTING.md", "CHANGELOG.md")


def prose(text: str) -> str:
    """A text without its blocks of code."""
    return re.sub(r"^```.*?^```", "", text, flags=re.DOTALL | re.MULTILINE)


def headings(text: str) -> set[str]:
    """The anchors of a text."""
    named = re.findall(r"^#+ (.*)$", prose(text), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", x).strip().lower().replace(" ", "-") for x in named}


def dead(texts: Mapping[Path, str], generated: frozenset[Path]) -> Iterator[tuple[Path, str]]:
    for path, text in texts.items():
        for link in LINK.findall(prose(text)):
            if re.match(r"[a-z]+:", link):
                continue
            name, _, anchor = link.partition("#")
            target = (path.parent / name).resolve() if name else path
            if target in generated:
                continue
            if not target.exists():
                yield path, link
            elif anchor and target.suffix == ".md":
                there = headings(texts.get(target) or target.read_text("utf-8"))
                yield from [(path, link)] * (anchor not in there)


def test_every_relative_link_leads_somewhere() -> None:
    paths = [ROOT / x for x in TOP] + [x for y in ("docs", "examples") for x in (ROOT / y).rglob("*.md")]
    navigation = (ROOT / "mkdocs.yml").read_text("utf-8").partition("\nnav:")[2]
    generated = frozenset((ROOT / "docs" / x).resolve() for x in PAGE.findall(navigation))
    texts = {x.resolve(): x.read_text("utf-8") for x in paths}
    assert sum(len(LINK.findall(x)) for x in texts.values()) > 100
    assert [*dead(texts, generated)] == []
    readme = (ROOT / "README.md").resolve()
    wrong = {readme: "[a](docs/nowhere.md) [b](CONTRIBUTING.md#no-such-heading) [c](#none)\n"}
    assert len([*dead(wrong, generated)]) == 3
