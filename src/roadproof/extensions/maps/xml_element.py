"""XML elements that record which parts were read, so that a reader can report the parts that it skipped.

``get`` reads an attribute, ``text`` or ``findtext`` a text. An element counts as read if a reader finds it by
tag (``find``, ``findall``, ``iter``) or reads one of its attributes; ``find`` reads only the first one.
Iterating over children reads none of them. ``parts_not_read`` lists the rest, apart from parts that a table
of the format declares harmless.
"""

import xml.etree.ElementTree as ElementTree
from collections import Counter
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, TypeVar, overload

from roadproof.runtime.records import dataclass

_Plain = ElementTree.Element
_TEXT_OF: Any = _Plain.__dict__["text"]
"""The descriptor of the text in an element of the standard library."""
_ITSELF, _TEXT, _ALL = ".", "text()", "*"
_NAMES = ("name", "id", "entityRef")
"""Attributes that identify an element in messages."""
_T = TypeVar("_T")
SHOWN = 12
"""The largest number of kinds of skipped parts that are listed one by one."""


def parse(content: bytes) -> "Element":
    """Return the root of a document, with nothing read yet. Raises ``ParseError``."""
    parser = ElementTree.XMLParser(target=ElementTree.TreeBuilder(element_factory=Element))
    parser.feed(content)
    root: Element = parser.close()  # type: ignore[assignment]
    for node in root.iter():
        if node.is_read:  # the parser itself has read its text
            del node._read
    return root


class Element(_Plain):
    """An element that records the attributes, texts and children that are read."""

    __slots__ = ("_read",)
    _read: set[str]

    def note(self, name: str = _ITSELF) -> None:
        """Record that an attribute, the text, or the element itself was read."""
        try:
            self._read.add(name)
        except AttributeError:
            self._read = {name}

    def read_all(self) -> None:
        """Record that the element was read with everything below it."""
        self.note(_ALL)

    def has_read(self, name: str) -> bool:
        """Return whether an attribute or the text was read."""
        return name in getattr(self, "_read", ())

    @property
    def is_read(self) -> bool:
        """Return whether anything of the element was read."""
        return hasattr(self, "_read")

    if TYPE_CHECKING:

        def __iter__(self) -> "Iterator[Element]": ...

        def __getitem__(self, index: int) -> "Element": ...  # type: ignore[override]

    @overload
    def get(self, key: str, default: None = None) -> str | None: ...

    @overload
    def get(self, key: str, default: _T) -> str | _T: ...

    def get(self, key: str, default: Any = None) -> Any:
        self.note(key)
        return _Plain.get(self, key, default)

    def peek(self, key: str) -> str | None:
        """Return an attribute without recording it."""
        return _Plain.get(self, key)

    @property
    def text(self) -> str | None:
        self.note(_TEXT)
        return text_of(self)

    @text.setter
    def text(self, value: str | None) -> None:
        _TEXT_OF.__set__(self, value)

    def find(self, path: str, namespaces: Any = None) -> "Element | None":
        """Return the first element at a path of tags, and record it and those on the path."""
        tag, _, below = path.partition("/")
        for node in self if tag == _ALL else _Plain.findall(self, tag):
            result = node if not below else node.find(below)
            if result is not None:
                if tag != _ALL:
                    node.note()  # type: ignore[attr-defined]
                return result  # type: ignore[return-value]
        return None

    def findall(self, path: str, namespaces: Any = None) -> "list[Element]":  # type: ignore[override]
        """Return the elements at a path of tags joined by ``/``; they are recorded, apart from steps of
        ``*``.
        """
        nodes: list[Element] = [self]
        for tag in path.split("/"):
            if tag == _ALL:
                nodes = [child for node in nodes for child in node]
                continue
            nodes = [child for node in nodes for child in _Plain.findall(node, tag)]  # type: ignore[misc]
            for node in nodes:
                node.note()
        return nodes

    def findtext(self, path: str, default: Any = None, namespaces: Any = None) -> str | None:  # type: ignore[override]
        """Return the text of the first element at a path, which is recorded; ``default`` if there is none."""
        node = self.find(path)
        return default if node is None else node.text or ""

    def iter(self, tag: str | None = None) -> "Iterator[Element]":  # type: ignore[override]
        """Yield the element and all below it; with ``tag``, those of this tag, which are recorded."""
        for node in _Plain.iter(self, tag):
            if tag is not None:
                node.note()  # type: ignore[attr-defined]
            yield node  # type: ignore[misc]


def text_of(node: _Plain) -> str | None:
    """Return the text of an element without recording it."""
    text: str | None = _TEXT_OF.__get__(node)
    return text


@dataclass(frozen=True)
class PartNotRead:
    """A part of a file that a reader skipped.

    ``part``: ``Tag`` of an element, ``Tag[key=value]`` if an attribute says what it is, ``Tag@attribute`` or
    ``Tag/text()``. ``where``: the path of the element.
    """

    part: str
    where: str

    def __str__(self) -> str:
        return f"{self.part} at {self.where}"


def parts_not_read(
    root: Element, harmless: Mapping[str, str], keys: Mapping[str, str] | None = None
) -> tuple[PartNotRead, ...]:
    """Return the parts of a file that were not read and are not declared harmless, in the order of the file.

    ``harmless``: reasons by ``Tag``, ``Tag[key=value]``, ``Tag@attribute``, ``@attribute`` of any element, or
    ``Tag/text()``. ``keys``: by tag the attribute that says what an element is, as ``k`` of a ``tag`` in OSM.
    Nothing below a skipped element is listed.
    """
    return tuple(_parts_not_read(root, harmless, keys or {}, ""))


def _parts_not_read(
    node: Element, harmless: Mapping[str, str], keys: Mapping[str, str], above: str
) -> Iterator[PartNotRead]:
    name_of_node = _called(node, keys)
    if node.tag in harmless or name_of_node in harmless or node.has_read(_ALL):
        return
    where = f"{above}/{_label(node)}" if above else _label(node)
    if not node.is_read and above and not any(x.is_read for x in _below(node)):
        yield PartNotRead(name_of_node, where)
        return
    for name in node.keys():  # noqa: SIM118
        part = f"{node.tag}@{name}"
        if not (node.has_read(name) or part in harmless or f"@{name}" in harmless):
            yield PartNotRead(part, where)
    part = f"{node.tag}/{_TEXT}"
    if (text_of(node) or "").strip() and not node.has_read(_TEXT) and part not in harmless:
        yield PartNotRead(part, where)
    for child in node:
        yield from _parts_not_read(child, harmless, keys, where)


def _called(node: Element, keys: Mapping[str, str]) -> str:
    """Return the tag of an element, with the attribute that says what it is."""
    key = keys.get(str(node.tag))
    return str(node.tag) if key is None else f"{node.tag}[{key}={node.peek(key)}]"


def _below(node: Element) -> Iterator[Element]:
    """Yield all elements below one."""
    yield from (x for x in node.iter() if x is not node)


def _label(node: Element) -> str:
    """Return the tag of an element, with its name if it has one."""
    name = next((x for x in map(node.peek, _NAMES) if x), "")
    return f"{node.tag} {name}" if name else str(node.tag)


def summary_of(parts: tuple[PartNotRead, ...]) -> tuple[str, ...]:
    """Return a line for each kind of skipped part: how often it occurs, and where first."""
    counts = Counter(x.part for x in parts)
    first = {x.part: x.where for x in reversed(parts)}
    lines = [
        f"{part}, {f'{count} times, first ' if count > 1 else ''}at {first[part]}"
        for part, count in counts.items()
    ]
    more = len(lines) - SHOWN
    return (*lines[:SHOWN], f"{more} more kinds") if more > 0 else tuple(lines)
