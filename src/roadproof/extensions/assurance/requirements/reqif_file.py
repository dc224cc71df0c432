"""Reads requirements in ReqIF 1.2 (OMG), the exchange format of requirements tools.

A requirement is a SPEC-OBJECT with a text; its attributes for id, title and text have the names of the ReqIF
implementation guide (``ReqIF.ForeignID``, ``ReqIF.Name``, ``ReqIF.Text``). Links to evidence are string
attributes called ``roadproof.claims``, ``claims`` and so on, one target a line.
"""

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from roadproof.errors import InputError
from roadproof.extensions.assurance.answers.trace import RequirementPlace
from roadproof.extensions.assurance.requirements.requirement import Requirement, RequirementSet, with_fields
from roadproof.extensions.maps.xml_reader import Element, read_xml

_IDS = ("reqif.foreignid", "id", "uid", "identifier")
_TITLES = ("reqif.name", "title", "name", "summary")
_TEXTS = ("reqif.text", "text", "statement", "description", "requirement")
_DERIVED = ("deriv", "satisf", "refine", "parent", "trace")
"""Words in the names of relations whose target is a parent of their source."""
_OBJECT = re.compile(r"<(?:\w+:)?SPEC-OBJECT\s[^>]*?IDENTIFIER\s*=\s*[\"']([^\"']*)[\"']")
_BREAKS = ("br", "p", "div", "li", "tr")


@dataclass(frozen=True)
class _Object:
    """A SPEC-OBJECT: its identifier, and its values by lower-case attribute name."""

    identifier: str
    values: Mapping[str, str]

    def first(self, names: tuple[str, ...], otherwise: str = "") -> str:
        """Return the value of the first of some attributes that is not empty."""
        return next((x for name in names if (x := self.values.get(name, "").strip())), otherwise)


def read_reqif(path: Path) -> RequirementSet:
    """Return the requirements of a .reqif file; headings and other objects without a text are left out.

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
    requirements = [
        with_fields(
            Requirement(
                ids[x.identifier],
                x.first(_TEXTS),
                RequirementPlace(file=str(path), line=lines.get(x.identifier, 1)),
                x.first(_TITLES),
                tuple(dict.fromkeys(ids[y] for y in parents.get(x.identifier, ()))),
                identifier=x.identifier,
            ),
            x.values,
        )
        for x in objects
        if x.identifier in ids
    ]
    omitted = len(objects) - len(requirements)
    notes = (
        (f"{path}: {omitted} objects have no text, such as headings, and are left out",) if omitted else ()
    )
    return RequirementSet(path, tuple(requirements), notes=notes)


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
    """Return a value as text: its own text, formatted text, or the names of enumeration values."""
    if value.get("THE-VALUE") is not None:
        return value.get("THE-VALUE", "")
    formatted = value.find("THE-VALUE")
    if formatted is not None:
        lines = "".join(_plain(formatted)).split("\n")
        return "\n".join(" ".join(x.split()) for x in lines).strip()
    return "; ".join(names.get((x.text or "").strip(), "") for x in value.findall("VALUES/ENUM-VALUE-REF"))


def _plain(node: Element) -> Iterator[str]:
    """Yield the text of XHTML, with a line for each block."""
    yield " ".join((node.text or "").split("\n"))
    for child in node:
        yield from _plain(child)
        if child.tag in _BREAKS:
            yield "\n"
        yield " ".join((child.tail or "").split("\n"))


def _parents(content: Element, names: Mapping[str, str], ids: Mapping[str, str]) -> dict[str, list[str]]:
    """Return the parents of each requirement, by identifier: those above it and the targets of
    its relations.
    """
    parents: dict[str, list[str]] = {}
    for node in content.findall("SPECIFICATIONS/SPECIFICATION"):
        for below, above in _hierarchy(node, ""):
            if below in ids and above in ids:
                parents.setdefault(below, []).append(above)
    for node in content.findall("SPEC-RELATIONS/SPEC-RELATION"):
        kind = names.get(_reference(node, "TYPE"), "").lower()
        below, above = _reference(node, "SOURCE"), _reference(node, "TARGET")
        if below in ids and above in ids and any(word in kind for word in _DERIVED):
            parents.setdefault(below, []).append(above)
    return parents


def _hierarchy(node: Element, above: str) -> Iterator[tuple[str, str]]:
    """Yield pairs of an object and the one above it."""
    for child in node.findall("CHILDREN/SPEC-HIERARCHY"):
        here = _reference(child, "OBJECT")
        if above:
            yield here, above
        yield from _hierarchy(child, here)


def _reference(node: Element, name: str) -> str:
    """Return the identifier that a reference names."""
    target = node.find(f"{name}/*")
    return "" if target is None else (target.text or "").strip()


def _lines(path: Path) -> dict[str, int]:
    """Return the line on which each object begins, by identifier."""
    text = path.read_text("utf-8", "replace")
    lines: dict[str, int] = {}
    line, at = 1, 0
    for match in _OBJECT.finditer(text):
        line += text.count("\n", at, match.start())
        at = match.start()
        lines[match[1]] = line
    return lines
