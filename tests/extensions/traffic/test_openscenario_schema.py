"""Every element and attribute of OpenSCENARIO XML 1.0 to 1.3: it is read, named as left out, or refused.

``openscenario_schema.json`` has the names and types of the published schemas. Each is put into a scenario
that runs, together with whatever the schema requires beside and inside it.
"""

import json
import xml.etree.ElementTree as ElementTree
from collections import Counter, deque
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from extensions.traffic.board import at_time, event, to_speed, when
from extensions.traffic.storyboards import EGO, OTHER, group, write
from roadproof.errors import InputError
from roadproof.extensions.exchange.openscenario import read_scenario
from roadproof.extensions.exchange.storyboard import document as documents
from roadproof.extensions.exchange.storyboard import run
from roadproof.extensions.exchange.storyboard.harmless import HARMLESS

Node = ElementTree.Element
ROOT = "OpenScenario"
_SCHEMA = json.loads(Path(__file__).with_name("openscenario_schema.json").read_text("utf-8"))
TYPES: dict[str, Any] = _SCHEMA["types"]
_ELSEWHERE = {("Act", "StartTrigger"), ("Act", "StopTrigger"), ("Storyboard", "StopTrigger")}
"""Triggers in which conditions are not tried, but in that of an event."""
VALUES = {
    "entityRef": "Other",
    "masterEntityRef": "Other",
    "roadId": "7",
    "laneId": "-2",
    "laneWidth": "3.5",
    "s": "150",
    "t": "-6",
    "filepath": "map.xodr",
    "stepWidth": "1",
}


def value_of(name: str, kind: str) -> str:
    kind = kind.rstrip("!")
    if name in VALUES:
        return VALUES[name]
    if kind in _SCHEMA["enums"]:
        return str(_SCHEMA["enums"][kind][0])
    return {"Boolean": "false", "String": "n", "DateTime": "2026-01-01T00:00:00"}.get(kind, "1")


def made(tag: str, kind: str, way: list[tuple[str, str]], attribute: str | None, depth: int = 0) -> Node:
    """An element with all that is required in it, and the elements of ``way`` inside each other."""
    node = Node(tag)
    attributes, children = TYPES.get(kind, ({}, []))
    for name, of in attributes.items():
        if of.endswith("!") or (not way and name == attribute):
            node.set(name, value_of(name, of))
    step = way[0] if way else None
    chosen: set[str] = {choice for name, of, _, choice in children if step == (name, of) and choice}
    for name, of, required, choice in children:
        if step == (name, of):
            node.append(made(name, of, way[1:], attribute, depth + 1))
        elif required and choice not in chosen and depth < 12:
            chosen |= {choice} - {""}
            node.append(made(name, of, [], None, depth + 1))
    return node


@cache
def way_to(kind: str) -> tuple[tuple[str, str], ...] | None:
    """The shortest way from the root to an element of a type, by Init if needed; None where there is none."""
    return _way_to(kind, {ROOT, "Private"}) or _way_to(kind, {ROOT})


def _way_to(kind: str, seen: set[str]) -> tuple[tuple[str, str], ...] | None:
    queue: deque[tuple[str, tuple[tuple[str, str], ...]]] = deque([(ROOT, ())])
    while queue:
        of, way = queue.popleft()
        if of == kind:
            return way
        for name, below, _, _ in TYPES.get(of, ({}, []))[1]:
            if below not in seen and (of, name) not in _ELSEWHERE:
                seen.add(below)
                queue.append((below, (*way, (name, below))))
    return None


def put(root: Node, way: list[tuple[str, str]], attribute: str | None) -> Node:
    """Put an element at the end of a way into a scenario; elements that exclude it make room. Return it."""
    node, kind = root, ROOT
    while way:
        tag, below = way[0]
        there = node.find(tag)
        if there is None:
            choice = {name: x for name, _, _, x in TYPES[kind][1]}
            for child in [x for x in node if choice[tag] and choice.get(x.tag) == choice[tag]]:
                node.remove(child)
            new = made(tag, below, way[1:], attribute)
            node.append(new)
            for step, _ in way[1:]:
                new = next(x for x in new if x.tag == step)
            return new
        node, kind, way = there, below, way[1:]
    if attribute is not None and attribute not in node.attrib:
        node.set(attribute, value_of(attribute, TYPES[kind][0][attribute]))
    return node


def base(folder: Path) -> Path:
    go = group("Ego", event("go", to_speed(14, "linear", "time", 1), when(at_time(0.2))))
    path = write(folder, {"Ego": EGO, "Other": OTHER}, (go,), "straight")
    text = path.read_text("utf-8")
    end = when(at_time(11), tag="StopTrigger")
    assert end in text
    path.write_text(text.replace(end, when(at_time(1), tag="StopTrigger")), "utf-8")
    return path


def outcome(path: Path, part: str, way: list[tuple[str, str]]) -> str:
    """What becomes of a part of a file: refused, left out (with what is around it), harmless, or read."""
    try:
        scenario = read_scenario(path)
    except InputError:
        return "refused"
    told = " ".join(scenario.notes)
    around = {tag for tag, _ in way}
    if any(f"{x}, " in told for x in (part, *around)) or "more kinds" in told:
        return "left out"
    tag, _, name = part.partition("@")
    return "harmless" if {*around, tag, part, f"@{name}"} & {*HARMLESS} else "read"


def targets(kind: str) -> Iterator[tuple[list[tuple[str, str]], str | None]]:
    """The way to each attribute and each element in an element of a type."""
    way = way_to(kind)
    if way is None:
        return
    for attribute in TYPES[kind][0]:
        yield [*way], attribute
    for name, below, _, _ in TYPES[kind][1]:
        yield [*way, (name, below)], None


def read_parts(monkeypatch: pytest.MonkeyPatch) -> list[Node]:
    """The roots of the files that are read from now on."""
    roots: list[Node] = []
    made = documents.read_xml

    def noted(path: Path, tag: str) -> Any:
        root = made(path, tag)
        roots.append(root)
        return root

    monkeypatch.setattr(documents, "read_xml", noted)
    return roots


@pytest.mark.parametrize("kind", sorted(TYPES))
def test_each_part_is_read_or_named_or_refused(
    kind: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    roots = read_parts(monkeypatch)
    monkeypatch.setattr(run, "LONGEST", 2)
    path = base(tmp_path)
    text = path.read_text("utf-8")
    for way, attribute in targets(kind):
        root = ElementTree.fromstring(text)
        node = put(root, way, attribute)
        part = node.tag if attribute is None else f"{node.tag}@{attribute}"
        path.write_text(ElementTree.tostring(root, "unicode"), "utf-8")
        roots.clear()
        if outcome(path, part, way) == "read":
            found = [
                x
                for x in roots[0].iter()  # which reads none of them, as iter(tag) does
                if x.tag == node.tag and (attribute is None or attribute in x.attrib)
            ]
            assert all(is_read(roots[0], x, attribute) for x in found), part


def is_read(root: Any, node: Any, attribute: str | None) -> bool:
    """Whether the element, an attribute of it, or an element around it as a whole, was read."""
    above = {child: parent for parent in root.iter() for child in parent}
    around = node
    while around is not None:
        if around.has_read("*") or around.tag in HARMLESS:
            return True
        around = above.get(around)
    return bool(
        node.has_read(attribute) if attribute else node.is_read or any(x.is_read for x in node.iter())
    )


def test_a_reader_that_names_nothing_is_noticed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The negative control: without the list of unread parts, the check above fails."""
    monkeypatch.setattr(documents, "parts_not_read", lambda root, harmless: ())
    with pytest.raises(AssertionError):
        test_each_part_is_read_or_named_or_refused("ScenarioObject", tmp_path, monkeypatch)


@pytest.mark.parametrize("part", sorted(x for x in HARMLESS if "@" in x and not x.startswith("@")))
def test_harmless_attributes_change_no_motion(part: str, tmp_path: Path) -> None:
    """With another value, or without the attribute, every vehicle moves alike."""
    tag, name = part.split("@")
    path = base(tmp_path)
    before = read_scenario(path).table
    root = ElementTree.fromstring(path.read_text("utf-8"))
    for node in root.iter(tag):
        node.set(name, "17")
    path.write_text(ElementTree.tostring(root, "unicode"), "utf-8")
    after = read_scenario(path).table
    assert all(np.array_equal(before[x], after[x]) for x in before.columns)


def test_all_outcomes_occur(tmp_path: Path) -> None:
    path = base(tmp_path)
    text = path.read_text("utf-8")
    counts: Counter[str] = Counter()
    for kind in ("Vehicle", "PrivateAction", "ScenarioObject", "ByValueCondition", "LanePosition"):
        for way, attribute in targets(kind):
            root = ElementTree.fromstring(text)
            node = put(root, way, attribute)
            path.write_text(ElementTree.tostring(root, "unicode"), "utf-8")
            part = node.tag if attribute is None else f"{node.tag}@{attribute}"
            counts[outcome(path, part, way)] += 1
    assert {*counts} == {"read", "left out", "harmless", "refused"}, counts
