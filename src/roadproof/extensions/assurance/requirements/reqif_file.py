"""Requirements in ReqIF 1.2 (OMG), as requirements tools exchange them.

A requirement is a SPEC-OBJECT with a text; its names for id, title and text are those of the ReqIF
implementation guide (``ReqIF.ForeignID``, ``ReqIF.Name``, ``ReqIF.Text``). Links to evidence are string
attributes called ``roadproof.claims``, ``claims`` and so on, one target a line.
"""

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from roadproof.errors import InputError
from roadproof.extensions.assurance.answers.trace import Position
from roadproof.extensions.assurance.requirements.requirement import Requirement, Requirements, split_links
from roadproof.runtime.xml_reader import Element, read_xml

_IDS = ("reqif.foreignid", "id", "uid", "identifier")
_TITLES = ("reqif.name", "title", "name", "summary")
_TEXTS = ("reqif.text", "text", "statement", "description", "requirement")
_DERIVED = ("deriv", "satisf", "refine", "parent", "trace")
"""Words in the names of relations whose target is a parent of their source."""
_OBJECT = re.compile(r"<(?:\w+:)?SPEC-OBJECT\s[^>]*?IDENTIFIER\s*=\s*[\"']([^\"']*)[\"']")
_BREAKS = ("br", "p", "div", "li", "tr")


@dataclass(frozen=True)
class _Object:
    """A SPEC-OBJECT: its identifier, and values by the name of their attribute in small letters."""

    identifier: str
    values: Mapping[str, str]

    def first(self, names: tuple[str, ...], otherwise: str = "") -> str:
        """The value of the first of some attributes that is there."""
        return next((x for name in names if (x := self.values.get(name, "").strip())), otherwise)


def read_reqif(path: Path) -> Requirements:
    """The requirements of a .reqif file; headings and other objects without a text are left out.

    Raises ``InputError``, also for a file with a document type or entities.
    """
    root = read_xml(path, "REQ-IF")
    content = root.find("CORE-CONTENT/REQ-IF-CONTENT")
    if content is None:
        raise InputError(f"{path}: there is no CORE-CONTENT/REQ-IF-CONTENT in it; export it again")
    names = {x.get("IDENTIFIER", ""): x.get("LONG-NAME", "") for x in content.iter() if x.get("IDENTIFIER")}
    objects = [_object(x, names) for x in content.findall("SPEC-OBJECTS/SPEC-OBJECT")]
    ids = {x.identifier: x.first(_IDS, x.identifier) for x in objects if x.first(_TEXTS)}
    parents = _parents(content, names, ids)
    lines = _lines(path)
    found = [
        Requirement(
            ids[x.identifier],
            x.first(_TEXTS),
            Position(file=str(path), line=lines.get(x.identifier, 1)),
            x.first(_TITLES),
            tuple(dict.fromkeys(ids[y] for y in parents.get(x.identifier, ()))),
            split_links(x.values),
            x.identifier,
        )
        for x in objects
        if x.identifier in ids
    ]
    left = len(objects) - len(found)
    notes = (f"{path}: {left} objects have no text, such as headings, and are left out",) if left else ()
    return Requirements(path, tuple(found), notes=notes)


def _object(node: Element, names: Mapping[str, str]) -> _Object:
    values: dict[str, str] = {}
    for value in node.findall("VALUES/*"):
        reference = value.find("DEFINITION/*")
        name = names.get("" if reference is None else (reference.text or "").strip(), "")
        if name:
            values[name.lower()] = _value(value, names)
    titled = {"reqif.name": node.get("LONG-NAME", "")} if node.get("LONG-NAME") else {}
    described = {"description": node.get("DESC", "")} if node.get("DESC") else {}
    return _Object(node.get("IDENTIFIER", ""), titled | described | values)


def _value(value: Element, names: Mapping[str, str]) -> str:
    """A value as text: what it says itself, formatted text, or the names of enumeration values."""
    if value.get("THE-VALUE") is not None:
        return value.get("THE-VALUE", "")
    formatted = value.find("THE-VALUE")
    if formatted is not None:
        lines = "".join(_plain(formatted)).split("\n")
        return "\n".join(" ".join(x.split()) for x in lines).strip()
    return "; ".join(names.get((x.text or "").strip(), "") for x in value.findall("VALUES/ENUM-VALUE-REF"))


def _plain(node: Element) -> Iterator[str]:
    """The text of XHTML, with a line for each block."""
    yield " ".join((node.text or "").split("\n"))
    for child in node:
        yield from _plain(child)
        if child.tag in _BREAKS:
            yield "\n"
        yield " ".join((child.tail or "").split("\n"))


def _parents(content: Element, names: Mapping[str, str], ids: Mapping[str, str]) -> dict[str, list[str]]:
    """The parents of each requirement, by identifiers: those above it, and targets of its relations."""
    found: dict[str, list[str]] = {}
    for node in content.findall("SPECIFICATIONS/SPECIFICATION"):
        for below, above in _hierarchy(node, ""):
            if below in ids and above in ids:
                found.setdefault(below, []).append(above)
    for node in content.findall("SPEC-RELATIONS/SPEC-RELATION"):
        kind = names.get(_reference(node, "TYPE"), "").lower()
        below, above = _reference(node, "SOURCE"), _reference(node, "TARGET")
        if below in ids and above in ids and any(word in kind for word in _DERIVED):
            found.setdefault(below, []).append(above)
    return found


def _hierarchy(node: Element, above: str) -> Iterator[tuple[str, str]]:
    """Pairs of an object and the one above it."""
    for child in node.findall("CHILDREN/SPEC-HIERARCHY"):
        here = _reference(child, "OBJECT")
        if above:
            yield here, above
        yield from _hierarchy(child, here)


def _reference(node: Element, name: str) -> str:
    """The identifier that a reference names."""
    found = node.find(f"{name}/*")
    return "" if found is None else (found.text or "").strip()


def _lines(path: Path) -> dict[str, int]:
    """The line on which each object begins."""
    text = path.read_text("utf-8", "replace")
    found: dict[str, int] = {}
    line, at = 1, 0
    for match in _OBJECT.finditer(text):
        line += text.count("\n", at, match.start())
        at = match.start()
        found[match[1]] = line
    return found
