"""The element that records what was read: everything else of a file is listed, whatever it is."""

import random
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest

from roadproof.extensions.maps.xml_element import Element, PartNotRead, parts_not_read, summary_of
from roadproof.extensions.maps.xml_reader import read_xml


def parsed(text: str, folder: Path) -> Element:
    path = folder / "file.xml"
    path.write_text(text, "utf-8")
    return read_xml(path, "r")


def parts(root: Element, **harmless: str) -> list[str]:
    return [x.part for x in parts_not_read(root, harmless)]


def test_all_of_a_file_is_unread_at_first(tmp_path: Path) -> None:
    root = parsed('<r a="1"><x b="2"/>text<y/></r>', tmp_path)
    assert parts(root) == ["r@a", "x", "y"]


def test_reading_a_part_removes_it_and_no_other(tmp_path: Path) -> None:
    root = parsed('<r><x b="2" c="3"><z d="4"/></x><x b="5"/></r>', tmp_path)
    assert root.findall("x")[0].get("b") == "2"
    assert parts(root) == ["x@c", "z", "x@b"]
    assert [x.where for x in parts_not_read(root, {})] == ["r/x", "r/x/z", "r/x"]
    assert root.findtext("x/z") == ""
    assert parts(root) == ["x@c", "z@d", "x@b"]


def test_iterating_reads_nothing(tmp_path: Path) -> None:
    root = parsed('<r><x b="2"/><y><z/></y></r>', tmp_path)
    assert [x.tag for x in root] == ["x", "y"]
    assert len(root) == 2
    assert {x.tag for x in root.iter()} == {"r", "x", "y", "z"}
    assert [x.tag for x in root.findall("*")] == ["x", "y"]
    assert parts(root) == ["x", "y"]


def test_an_element_that_is_read_inside_unread_ones_does_not_hide_them(tmp_path: Path) -> None:
    root = parsed('<r><x b="2"><y><z d="4"/></y></x></r>', tmp_path)
    assert next(root.iter("z")).get("d") == "4"
    assert parts(root) == ["x@b"]


def test_texts_count(tmp_path: Path) -> None:
    root = parsed("<r><x>one</x><y>two</y><z> </z></r>", tmp_path)
    assert root.findtext("x") == "one"
    assert [root.find(x) is not None for x in "yz"] == [True, True]
    assert parts(root) == ["y/text()"]
    assert root[1].text == "two"
    assert not parts(root)


@pytest.mark.parametrize(
    ("rule", "left"), [("x", ["y@b"]), ("x@b", ["y@b"]), ("@b", []), ("y@b", ["x@b"]), ("b", ["x@b", "y@b"])]
)
def test_rules_declare_parts_harmless(rule: str, left: list[str], tmp_path: Path) -> None:
    root = parsed('<r><x b="1"/><y b="2"/></r>', tmp_path)
    for tag in "xy":
        assert root.find(tag) is not None
    assert [x.part for x in parts_not_read(root, {rule: "a reason"})] == left


def test_read_all_reads_what_is_below(tmp_path: Path) -> None:
    root = parsed('<r><x b="1"><z>text</z></x><y/></r>', tmp_path)
    root[0].read_all()
    assert parts(root) == ["y"]


def test_the_elements_behave_as_those_of_the_standard_library(tmp_path: Path) -> None:
    """Random trees, random paths: the same elements, attributes and texts."""
    chance = random.Random(5)

    def grown(depth: int) -> str:
        tag = chance.choice("xyz")
        inside = "".join(grown(depth - 1) for _ in range(chance.randint(0, 3))) if depth else ""
        words = chance.choice(("", "t", " "))
        return f'<{tag} a="{chance.randint(0, 9)}">{words}{inside}</{tag}>'

    for _ in range(60):
        text = f"<r>{grown(4)}{grown(3)}</r>"
        mine, theirs = parsed(text, tmp_path), ElementTree.fromstring(text)
        for _ in range(20):
            path = "/".join(chance.choice("xyz*") for _ in range(chance.randint(1, 3)))
            found = [ElementTree.tostring(x) for x in mine.findall(path)]
            assert found == [ElementTree.tostring(x) for x in theirs.findall(path)]
            assert mine.findtext(path, "none") == theirs.findtext(path, "none")
        tag = chance.choice("xyz")
        assert [x.get("a") for x in mine.iter(tag)] == [x.get("a") for x in theirs.iter(tag)]
        assert [x.text for x in mine.iter()] == [x.text for x in theirs.iter()]
        assert ElementTree.tostring(mine) == ElementTree.tostring(theirs)


def test_every_part_of_a_random_file_is_read_or_listed(tmp_path: Path) -> None:
    """Read a random half: what is listed is the other half, part by part."""
    chance = random.Random(7)
    for _ in range(100):
        tags = [f"e{k}" for k in range(12)]
        text = "".join(f'<{x} a="1" b="2"/>' for x in tags)
        root = parsed(f"<r>{text}</r>", tmp_path)
        expected = []
        for tag, node in zip(tags, root, strict=True):
            read = [x for x in "ab" if chance.random() < 0.5]
            for name in read:
                node.get(name)
            expected += [f"{tag}@{x}" for x in "ab" if x not in read] if read else [tag]
        assert parts(root) == expected


def test_a_summary_counts_kinds_and_is_short() -> None:
    found = tuple(PartNotRead(f"T@{k}", f"place {j}") for k in range(20) for j in range(2))
    lines = summary_of(found)
    assert lines[0] == "T@0, 2 times, first at place 0"
    assert len(lines) == 13
    assert lines[-1] == "8 more kinds"
    assert summary_of(found[:1]) == ("T@0, at place 0",)
    assert summary_of(()) == ()
