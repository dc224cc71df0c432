"""Files of another kind than the one that is read: every reader names the cause."""

import gzip
import io
import re
import zipfile
from collections.abc import Callable, Mapping
from pathlib import Path

import pytest

from roadproof.errors import InputError
from roadproof.evidence.drive_file import load_drive
from roadproof.extensions.assurance.case.reading import read_case
from roadproof.extensions.assurance.requirements.sources import read_requirements
from roadproof.extensions.assurance.requirements.yaml_file import read_yaml
from roadproof.extensions.exchange.commonroad import read_commonroad
from roadproof.extensions.exchange.openscenario import read_scenario
from roadproof.extensions.exchange.osi import read_osi
from roadproof.extensions.maps.xml_reader import read_xml
from roadproof.extensions.traffic.evaluate.one_trace import read_samples
from roadproof.extensions.traffic.formats.samples import column_pieces, read_columns
from roadproof.extensions.traffic.formats.table import frame_of
from roadproof.library.specification import read_specification
from roadproof.runtime.files import read_text
from roadproof.world.models import load_road, load_vehicle

_TEXT = "frame,id,x\n1,1,1\n"
_PAGE = b"<!DOCTYPE html>\n<html><head><title>Log in</title></head></html>\n"


def zipped() -> bytes:
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr("a.csv", _TEXT)
    return file.getvalue()


def parquet() -> bytes:
    file = io.BytesIO()
    frame_of([{"a": 1}]).write_parquet(file)
    return file.getvalue()


CONTENTS: Mapping[str, tuple[Callable[[], bytes], str]] = {
    "UTF-16": (lambda: _TEXT.encode("utf-16"), "UTF-16"),
    "UTF-16, the greater first": (lambda: b"\xfe\xff" + _TEXT.encode("utf-16-be"), "UTF-16"),
    "gzip": (lambda: gzip.compress(_TEXT.encode()), "gzip"),
    "zip": (zipped, "ZIP archive"),
    "HTML": (lambda: _PAGE, "page of HTML"),
    "Parquet": (parquet, "Parquet file"),
    "PDF": (lambda: b"%PDF-1.7\n", "PDF file"),
    "Git LFS": (lambda: b"version https://git-lfs.github.com/spec/v1\noid sha256:0\n", "Git LFS"),
}
READERS: Mapping[str, Callable[[Path], object]] = {
    ".txt": lambda path: read_text(path, 10_000, "split it"),
    ".a": lambda path: read_xml(path, "a"),
    ".spec": read_specification,
    ".json": load_drive,
    ".road.toml": load_road,
    ".vehicle.toml": load_vehicle,
    ".case.toml": read_case,
    ".requirements.toml": read_requirements,
    ".sdoc": read_requirements,
    ".reqif": read_requirements,
    ".yml": read_yaml,
    ".xodr": load_road,
    ".osm": load_road,
    ".xml": load_road,
    ".traffic.xml": read_commonroad,
    ".xosc": read_scenario,
    ".samples.xosc": read_samples,
    ".csv": read_samples,
    ".whole.csv": read_columns,
    ".large.csv": lambda path: [*column_pieces(path)],
    ".parquet": read_samples,
    ".large.parquet": lambda path: [*column_pieces(path)],
    ".osi": lambda path: read_osi(path, road="a.xodr"),
}


@pytest.mark.parametrize("ending", sorted(READERS))
@pytest.mark.parametrize("content", sorted(CONTENTS))
def test_the_cause_is_named(tmp_path: Path, ending: str, content: str) -> None:
    make, cause = CONTENTS[content]
    if ending.endswith((".parquet", ".osi")) and content.startswith(("UTF", "Parquet")):
        pytest.skip("such files are no text")
    path = tmp_path / f"file{ending}"
    path.write_bytes(make())
    with pytest.raises(InputError, match=cause) as error:
        READERS[ending](path)
    assert path.name in str(error.value)


def test_xml_in_utf_16_is_read(tmp_path: Path) -> None:
    path = tmp_path / "file"
    path.write_bytes('<?xml version="1.0" encoding="UTF-16"?><a/>'.encode("utf-16"))
    assert read_xml(path, "a").tag == "a"


DECODES = re.compile(r"""read_text\(["']utf-8["']\)|\.decode\(["']utf-8["']\)|\.read_text\(\)""")
OWN = {
    *("runtime/files.py", "extensions/assurance/pins.py", "extensions/traffic/formats/content.py"),
    *(
        "library/loading.py",
        "logic/grammar.py",
        "extensions/drivers/lemmas.py",
        "engines/prove/properties.py",
    ),
    *("extensions/pages/page/templates.py", "extensions/pages/viewer_page.py"),
    *(
        "extensions/assurance/bundling.py",
        "extensions/catalogue/writing.py",
        "extensions/pages/atlas/atlas.py",
    ),
    *(
        "extensions/pages/studio/pages.py",
        "extensions/pages/studio/examples.py",
        "extensions/pages/studio/gallery.py",
        "extensions/traffic/evaluate/results.py",
    ),
}
"""Files that decode what is roadproof's own, and the one decoder."""


def test_there_is_one_decoder() -> None:
    source = Path(__file__).parents[3] / "src" / "roadproof"
    found = {
        path.relative_to(source).as_posix()
        for path in source.rglob("*.py")
        if DECODES.search(path.read_text("utf-8"))
    }
    assert found <= OWN, found - OWN
