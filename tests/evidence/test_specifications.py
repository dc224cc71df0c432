"""Specification files beside evidence: what they may do, and where they may lie."""

import os
from pathlib import Path

import pytest

from roadproof.errors import InputError
from roadproof.evidence.specifications import read_beside
from roadproof.evidence.strict import Fields
from roadproof.library.loading import bundled_library

MORE = "def slower(a, b: vehicle) := v_lon(a) < v_lon(b)\n"
OTHER = "def danger(a, b: vehicle) := true\n"


def named(*names: str) -> Fields:
    return Fields({"specs": list(names)}, "index.json")


def test_a_file_that_adds_a_definition_is_read(tmp_path: Path) -> None:
    (tmp_path / "more.spec").write_text(MORE, "utf-8")
    library, paths = read_beside(named("more.spec"), tmp_path, ())
    assert "slower" in library.select().definitions
    assert paths == (tmp_path / "more.spec",)
    library, _ = read_beside(named("more.spec"), tmp_path, paths)  # given on the command line too
    assert "slower" in library.select().definitions


def test_without_files_there_is_the_library_alone(tmp_path: Path) -> None:
    for data in (None, Fields({}, "index.json"), named()):
        library, paths = read_beside(data, tmp_path, ())
        assert library.select().definitions.keys() == bundled_library().select().definitions.keys()
        assert paths == ()


def test_a_file_that_changes_a_definition_is_refused(tmp_path: Path) -> None:
    (tmp_path / "other.spec").write_text(OTHER, "utf-8")
    with pytest.raises(InputError, match="changes 'danger' of the library"):
        read_beside(named("other.spec"), tmp_path, ())


@pytest.mark.parametrize(
    "name", ["../more.spec", "below/more.spec", "below\\more.spec", ".", "..", "", "none", "link"]
)
def test_files_elsewhere_are_refused(name: str, tmp_path: Path) -> None:
    folder = tmp_path / "folder"
    for place in (tmp_path, folder / "below"):
        place.mkdir(parents=True, exist_ok=True)
        (place / "more.spec").write_text(MORE, "utf-8")
    (folder / "below\\more.spec").write_text(MORE, "utf-8")
    os.symlink(tmp_path / "more.spec", folder / "link")
    with pytest.raises(InputError, match=r"specs: (.* is no file in the folder|there is no file)"):
        read_beside(named(name), folder, ())
