"""Reads requirements of StrictDoc: nodes such as ``[REQUIREMENT]``, each with fields ``UID: LEAD-1``.

A field of several lines stands between ``>>>`` and ``<<<``. Links to evidence are fields of the user's own
grammar, called CLAIMS, SCENARIOS, TESTS, PLATES and EVIDENCE.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from roadproof.errors import InputError
from roadproof.extensions.assurance.answers.trace import RequirementPlace
from roadproof.extensions.assurance.requirements.requirement import (
    Requirement,
    RequirementSet,
    place_text,
    with_fields,
)
from roadproof.runtime.files import read_text

LARGEST = 20_000_000
"""The largest file size in bytes."""
_TAG = re.compile(r"\[\[?(/?)([A-Z][A-Z0-9_]*)\]\]?\s*")
_FIELD = re.compile(r"([A-Z][A-Z0-9_]*):(?:\s+(.*))?")
_INNER = re.compile(r"\s*(?:-\s+)?([A-Z][A-Z0-9_]*):\s*(.*)")
_OTHERS = ("DOCUMENT", "GRAMMAR", "SECTION", "TEXT", "FREETEXT", "DOCUMENT_FROM_FILE", "INCLUDE")
"""Tags of nodes that are no requirements."""
_RELATIONS = ("RELATIONS", "REFS")


@dataclass
class _Node:
    """A node: its line, its fields, and the UIDs of its parents."""

    tag: str
    place: RequirementPlace
    fields: dict[str, str] = field(default_factory=dict)
    parents: list[str] = field(default_factory=list)

    @property
    def is_requirement(self) -> bool:
        return self.tag not in _OTHERS and (self.tag == "REQUIREMENT" or "STATEMENT" in self.fields)


def read_strictdoc(path: Path) -> RequirementSet:
    """Return the requirements of a .sdoc file. Raises ``InputError`` with the line of the error."""
    lines = read_text(path, LARGEST, "divide the document").splitlines()
    requirements: list[Requirement] = []
    notes: list[str] = []
    for node in _nodes(lines, path):
        if not node.is_requirement:
            continue
        fields = node.fields
        uid = fields.get("UID")
        if not uid:
            notes.append(f"{place_text(node.place)}: the requirement has no UID and is left out")
            continue
        requirements.append(
            with_fields(
                Requirement(
                    uid,
                    fields.get("STATEMENT", ""),
                    node.place,
                    fields.get("TITLE", ""),
                    tuple(dict.fromkeys(node.parents)),
                ),
                fields,
            )
        )
    return RequirementSet(path, tuple(requirements), notes=tuple(notes))


def _nodes(lines: list[str], path: Path) -> Iterator[_Node]:
    node: _Node | None = None
    inside = ""  # the field whose lines are read, RELATIONS among them
    block: list[str] | None = None
    for number, line in enumerate(lines, 1):
        place = RequirementPlace(file=str(path), line=number)
        tag = None if block is not None else _TAG.fullmatch(line)
        if block is not None and node is not None:
            if line.strip() == "<<<":
                node.fields[inside] = "\n".join(block).strip()
                block = None
            else:
                block.append(line)
        elif tag is not None and (node is None or node.tag != "FREETEXT" or tag[1]):
            if node is not None:
                yield node
            node, inside = None if tag[1] else _Node(tag[2], place), ""
        elif node is not None and line.strip() and node.tag != "FREETEXT":
            inside, opens = _read_line(node, inside, line, place)
            block = [] if opens else None
    if block is not None and node is not None:
        raise InputError(f"{place_text(node.place)}: the field {inside} has no end; close it with <<<")
    if node is not None:
        yield node


def _read_line(node: _Node, inside: str, line: str, place: RequirementPlace) -> tuple[str, bool]:
    """Read a line of a node; return the name of its field, and whether it opens a block of lines."""
    field_line = _FIELD.fullmatch(line)
    if field_line is not None:
        name, value = field_line[1], (field_line[2] or "").strip()
        if value == ">>>":
            return name, True
        node.fields[name] = value
        return name, False
    if node.tag in _OTHERS:
        return "", False
    inner = _INNER.fullmatch(line)
    if inside in _RELATIONS and inner is not None:
        if inner[1] == "TYPE":
            node.fields |= {"-type": inner[2].strip()}
        elif inner[1] == "VALUE" and node.fields.get("-type") == "Parent":
            node.parents.append(inner[2].strip())
        return inside, False
    raise InputError(
        f"{place_text(place)}: {line.strip()[:60]!r} is no field of a node; write FIELD: value, or lines "
        "between >>> and <<<"
    )
