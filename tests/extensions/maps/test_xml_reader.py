"""Files in XML of which a part is wrong."""

from pathlib import Path

import pytest

from roadproof.errors import InputError
from roadproof.extensions.maps.xml_reader import DEEPEST, by_id, number_in, read_xml


def xml(folder: Path, text: str) -> Path:
    path = folder / "map.xml"
    path.write_text(text)
    return path


@pytest.mark.parametrize("depth", [DEEPEST - 1, DEEPEST, DEEPEST + 1])
def test_elements_are_so_deep_and_no_deeper(depth: int, tmp_path: Path) -> None:
    """Beside each other there may be any number of them."""
    beside = "<a/>" * (2 * DEEPEST)
    path = xml(tmp_path, f"{'<a>' * depth}{beside if depth < DEEPEST else ''}{'</a>' * depth}")
    if depth <= DEEPEST:
        assert read_xml(path, "a").tag == "a"
        return
    with pytest.raises(InputError, match=f"inside {DEEPEST} others"):
        read_xml(path, "a")


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("<!DOCTYPE a><a/>", "document type"),
        ("<b/>", "the root is b, but a is needed"),
        ("<a>", "no well-formed XML"),
        ("<html><a/></html>", "page of HTML"),
        ("\x1f\x8b", "compressed by gzip|no well-formed XML"),
    ],
)
def test_what_is_no_file_of_the_format_is_named(text: str, told: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=told):
        read_xml(xml(tmp_path, text), "a")
    assert read_xml(xml(tmp_path, '<n:a xmlns:n="x"><n:c/></n:a>'), "a")[0].tag == "c"


@pytest.mark.parametrize("text", ["", "x", "nan", "inf", "-inf", "1e999", None])
def test_what_is_no_finite_number_is_refused(text: str | None, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="a finite number is needed"):
        number_in(tmp_path, text, "width")
    assert number_in(tmp_path, " -1.5e2 ", "width") == -150.0


@pytest.mark.parametrize(
    ("text", "told"), [("<r><a/></r>", "has no id"), ('<r><a id=""/></r>', "has no id"),
                       ('<r><a id="1"/><a id="2"/><a id="1"/></r>', "a 1 occurs twice")]
)  # fmt: skip
def test_ids_are_there_and_differ(text: str, told: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=told):
        by_id(tmp_path, list(read_xml(xml(tmp_path, text), "r")))
    assert [*by_id(tmp_path, list(read_xml(xml(tmp_path, '<r><a id="1"/><a id="2"/></r>'), "r")))] == [
        "1",
        "2",
    ]
