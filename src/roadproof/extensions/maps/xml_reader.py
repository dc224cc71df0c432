"""The only reader of XML: files of other programs, which may be broken or malicious."""

import math
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from xml.parsers import expat

from roadproof.errors import InputError
from roadproof.extensions.maps.xml_element import Element, PartNotRead, parse, parts_not_read, summary_of
from roadproof.runtime.file_kind import other_format, other_text

__all__ = ["Element", "PartNotRead", "by_id", "number_in", "parts_not_read", "read_xml", "summary_of"]
DEEPEST = 100
"""The largest depth of nested elements; the formats that are read have about ten."""


def read_xml(path: Path, root_tag: str) -> Element:
    """Return the root of a file, whose tag must be ``root_tag``.

    A document type is refused before anything else is parsed, so no entities are expanded or fetched. Raises
    ``InputError`` that names the file.
    """
    try:
        content = path.read_bytes()
    except OSError as error:
        raise InputError(f"{path}: the file cannot be read ({error.strerror}); check the path") from None
    other = other_format(content)
    if other is not None:
        raise InputError(f"{path}: the file {other}")
    try:
        _refuse_tricks(path, content)
        root = parse(content)
    except (ElementTree.ParseError, expat.ExpatError, ValueError, LookupError) as error:
        other = other_text(content)
        if other is not None:
            raise InputError(f"{path}: the file {other}") from None
        raise InputError(
            f"{path}: no well-formed XML ({error}); get the file again from its source"
        ) from None
    if root.tag.endswith(f"}}{root_tag}"):  # in a namespace
        for element in root.iter():
            element.tag = element.tag.rpartition("}")[2]
    if root.tag != root_tag:
        raise InputError(f"{path}: the root is {root.tag}, but {root_tag} is needed")
    return root


def _refuse_tricks(path: Path, content: bytes) -> None:
    """Raise ``InputError`` for a document type, and for elements that are nested too deep."""
    parser = expat.ParserCreate()
    depth = 0

    def refuse_type(*_: object) -> None:
        raise InputError(f"{path}: the file has a document type, which no file of its format has; remove it")

    def begin(name: str, _: object) -> None:
        """Count the depth at the beginning of an element."""
        nonlocal depth
        depth += 1
        if depth > DEEPEST:
            raise InputError(f"{path}: element {name} is inside {DEEPEST} others; no file of its format is")

    def end(_: str) -> None:
        nonlocal depth
        depth -= 1

    parser.StartDoctypeDeclHandler = refuse_type
    parser.StartElementHandler = begin
    parser.EndElementHandler = end
    parser.Parse(content, True)


def number_in(path: Path, text: str | None, what: str) -> float:
    """Return ``text`` as a finite number. Raises ``InputError`` that calls it ``what``."""
    try:
        value = float(text or "")
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise InputError(f"{path}: {what} is {text!r}; a finite number is needed")
    return value


def by_id(path: Path, nodes: list[Element]) -> dict[str, Element]:
    """Return elements by their id. Raises ``InputError`` for a missing or repeated id."""
    elements: dict[str, Element] = {}
    for node in nodes:
        name = node.get("id")
        if not name:
            raise InputError(f"{path}: a {node.tag} has no id")
        if name in elements:
            raise InputError(f"{path}: {node.tag} {name} occurs twice; ids must differ")
        elements[name] = node
    return elements
