"""Files that are neither text in UTF-8 nor XML: both readers name the cause."""

import gzip
from collections.abc import Callable
from pathlib import Path

import pytest

from roadproof.errors import InputError
from roadproof.runtime.files import read_text
from roadproof.runtime.xml_reader import read_xml

_TEXT = "frame,id,x\n1,1,1\n"
_READERS: tuple[Callable[[Path], object], ...] = (
    lambda path: read_xml(path, "a"),
    lambda path: read_text(path, 10_000, "split it"),
)


@pytest.mark.parametrize("read", _READERS)
@pytest.mark.parametrize(
    ("content", "cause"),
    [
        (_TEXT.encode("utf-16"), "UTF-16"),
        (b"\xfe\xff" + _TEXT.encode("utf-16-be"), "UTF-16"),
        (gzip.compress(_TEXT.encode()), "gzip"),
    ],
)
def test_the_cause_is_named(
    tmp_path: Path, read: Callable[[Path], object], content: bytes, cause: str
) -> None:
    path = tmp_path / "file"
    path.write_bytes(content)
    with pytest.raises(InputError, match=cause):
        read(path)


def test_xml_in_utf_16_is_read(tmp_path: Path) -> None:
    path = tmp_path / "file"
    path.write_bytes('<?xml version="1.0" encoding="UTF-16"?><a/>'.encode("utf-16"))
    assert read_xml(path, "a").tag == "a"
