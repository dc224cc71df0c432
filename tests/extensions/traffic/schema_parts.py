"""Parts of published XML schemas, each put into a small file together with whatever is required in it."""

import json
import xml.etree.ElementTree as ElementTree
from collections import deque
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from roadproof.extensions.maps.xml_element import Element

Node = ElementTree.Element
Way = tuple[tuple[str, str], ...]
"""Tags and types of elements inside each other, below the root."""
_FILE = Path(__file__).with_name("published_schemas.json")


@dataclass(frozen=True)
class Schema:
    """Types of a format: attributes by name, and children with type, whether required, and their choice.

    ``values`` of attributes and texts by name, where a file needs one that fits.
    """

    root: str
    types: Mapping[str, Any]
    enums: Mapping[str, Any]
    values: Mapping[str, str]

    def value(self, name: str, kind: str) -> str:
        kind = kind.rstrip("!")
        if name in self.values:
            return self.values[name]
        if kind in self.enums:
            return str(self.enums[kind][0])
        return {"boolean": "false", "string": "n", "date": "2026-01-01"}.get(kind, "1")

    def made(self, tag: str, kind: str, attribute: str | None = None, depth: int = 0) -> Node:
        """An element with all that is required in it, and an attribute."""
        node = Node(tag)
        if kind not in self.types:
            node.text = self.value(tag, kind)
            return node
        attributes, children = self.types[kind]
        for name, of in attributes.items():
            if of.endswith("!") or name == attribute:
                node.set(name, self.value(name, of))
        chosen: set[str] = set()
        for name, of, required, choice in children:
            if required and choice not in chosen and depth < 12:
                chosen |= {choice} - {""}
                node.append(self.made(name, of, None, depth + 1))
        return node

    def put(self, root: Node, way: Way, attribute: str | None) -> Node:
        """Put an element at the end of a way into a file; elements that exclude it make room. Return it."""
        node, kind = root, self.root
        for k, (tag, below) in enumerate(way):
            there = node.find(tag)
            if there is None:
                children = self.types[kind][1]
                choice = {name: x for name, _, _, x in children}
                for child in [x for x in node if choice[tag] and choice.get(x.tag) == choice[tag]]:
                    node.remove(child)
                there = self.made(tag, below, attribute if k == len(way) - 1 else None)
                order = [name for name, *_ in children]
                after = [x for x in node if order.index(x.tag) > order.index(tag)]
                node.insert([*node].index(after[0]) if after else len(node), there)
            node, kind = there, below
        if attribute is not None and attribute not in node.attrib:
            node.set(attribute, self.value(attribute, self.types[kind][0][attribute]))
        return node

    def way_to(self, kind: str) -> Way | None:
        """The shortest way from the root to an element of a type."""
        queue: deque[tuple[str, Way]] = deque([(self.root, ())])
        seen = {self.root}
        while queue:
            of, way = queue.popleft()
            if of == kind:
                return way
            for name, below, _, _ in self.types.get(of, ({}, []))[1]:
                if below not in seen:
                    seen.add(below)
                    queue.append((below, (*way, (name, below))))
        return None

    def parts(self, kind: str) -> Iterator[tuple[Way, str | None]]:
        """The way to each attribute and each element in an element of a type."""
        way = self.way_to(kind)
        if way is None:
            return
        for attribute in self.types[kind][0]:
            yield way, attribute
        for name, below, _, _ in self.types[kind][1]:
            yield (*way, (name, below)), None


@cache
def schema(root: str) -> Schema:
    """The schema of CommonRoad 2020a (``commonRoad``) or of OpenDRIVE 1.4 to 1.8 (``OpenDRIVE``)."""
    found = json.loads(_FILE.read_text("utf-8"))[root]
    values = {"ref": "1", "rule": "RHT", "s": "0", "sOffset": "0", "time": "1"} if root == "OpenDRIVE" else {}
    return Schema(root, found["types"], found["enums"], values or {"ref": "1", "laneletType": "highway"})


def is_read(root: Element, node: Element, attribute: str | None, harmless: Mapping[str, str]) -> bool:
    """Whether the element, an attribute of it, or an element around it as a whole, was read."""
    above = {child: parent for parent in root.iter() for child in parent}
    around: Element | None = node
    while around is not None:
        if around.has_read("*") or around.tag in harmless:
            return True
        around = above.get(around)
    if attribute is not None:
        return node.has_read(attribute) or {f"{node.tag}@{attribute}", f"@{attribute}"} <= {*harmless}
    return node.is_read or any(x.is_read for x in node.iter())
