"""Pages are grouped by audience, then by kind; an extension's pages name it, its label and its audience."""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import yaml

from roadproof.extension import AUDIENCES, Audience, Extension, installed_extensions

ROOT = Path(__file__).parents[2]
DOORS: dict[Audience, tuple[str, str]] = {
    "testers": ("I test vehicles", "testers.md"),
    "safety cases": ("I sign a safety case", "safety-cases.md"),
    "researchers": ("I work on logics", "researchers.md"),
}
KINDS = {
    "Tutorials": {"tutorials"},
    "How-to guides": {"how-to"},
    "Reference": {"reference", "schema"},
    "Explanation": {"explanation"},
}
_LABEL = re.compile(r"^\*For ([^.*]+)\. Extension `(\w+)`: ([^*]+)\.\*$", re.MULTILINE)
_LINK = re.compile(r"\]\(([^)\s#]+)")
OWN = {name: x.record for name, x in installed_extensions().items() if x.record.page}


def sections() -> dict[str, list[Any]]:
    """Return the entries of each section of the navigation, by its title."""
    text = ROOT.joinpath("mkdocs.yml").read_text("utf-8")
    navigation = yaml.safe_load(text[text.index("nav:") :])["nav"]
    return {title: x for entry in navigation if isinstance(entry, dict) for title, x in entry.items()}


def pages_of(entries: list[Any]) -> Iterator[tuple[str, str]]:
    """Yield the kind and the path of each page of a section; the first page has no kind."""
    for entry in entries:
        if isinstance(entry, str):
            yield "", entry
        else:
            yield from ((kind, page) for kind, pages in entry.items() for page in pages)


def label_of(record: Extension) -> str:
    """Return the label of an extension, with the parts that may be removed."""
    parts = ", ".join(record.incubating)
    return f"{record.label}; incubating: {parts}" if parts else record.label


def test_the_navigation_has_a_section_for_each_audience() -> None:
    assert {*DOORS} == {*AUDIENCES}
    assert [*sections()] == [*(title for title, _ in DOORS.values()), "Everyone", "Developers"]
    for title, entries in sections().items():
        if title != "Developers":
            kinds = [next(iter(x)) for x in entries if isinstance(x, dict)]
            assert kinds == [x for x in KINDS if x in kinds], title
            assert all(Path(x).parts[0] in KINDS[kind] for kind, x in pages_of(entries) if kind), title


def test_each_door_is_the_first_page_of_its_section_and_links_to_all_others() -> None:
    for title, door in [*DOORS.values(), ("Everyone", "everyone.md")]:
        first, *others = (page for _, page in pages_of(sections()[title]))
        assert first == door
        linked = {*_LINK.findall((ROOT / "docs" / door).read_text("utf-8"))}
        if door == "everyone.md":  # the index of the reference names the others
            others = [x for x in others if not x.startswith(("reference/", "schema/"))]
        assert {x for x in others if x not in linked} == set(), title


def test_the_readme_and_the_first_page_begin_with_the_three_doors() -> None:
    for page, folder in (("README.md", "docs/"), ("docs/index.md", "")):
        section = (ROOT / page).read_text("utf-8").partition("\n## Three doors\n")[2].partition("\n## ")[0]
        found = re.findall(r"^- \[([^\]]+)\]\(([^)]+)\)", section, re.MULTILINE)
        assert found == [(title, folder + door) for title, door in DOORS.values()]


def test_the_page_of_an_extension_says_its_label() -> None:
    assert len(OWN) >= 9
    for name, record in OWN.items():
        lines = _LABEL.findall((ROOT / record.page).read_text("utf-8"))
        assert lines == [(record.audience, name, label_of(record))]


def test_a_page_that_names_an_extension_is_in_the_section_of_its_audience() -> None:
    named: set[str] = set()
    for title, entries in sections().items():
        for _, page in pages_of(entries):
            path = ROOT / "docs" / page
            for audiences, name, label in _LABEL.findall(path.read_text("utf-8")) if path.exists() else ():
                record = OWN[name]
                assert record.audience in audiences, page
                assert label in (record.label, label_of(record)), page
                assert title in {DOORS[x][0] for x in AUDIENCES if x in audiences}, page
                named.add(name)
    assert named == {*OWN}


def test_every_guide_and_tutorial_says_for_whom_it_is() -> None:
    paths = [x for kind in ("how-to", "tutorials") for x in (ROOT / "docs" / kind).glob("*.md")]
    assert len(paths) > 20
    for path in paths:
        title, _, second = path.read_text("utf-8").split("\n")[:3]
        assert title.startswith("# "), path.name
        assert re.match(r"\*For (?:everyone|[a-z ]+)\.", second), path.name
