"""Every file that is opened to read a test is one of the files whose bytes are part of its digest."""

import shutil
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from extensions.traffic.board import CAR, init, lane, put
from extensions.traffic.test_topology import urban
from roadproof.extensions.catalogue.entries import ConcreteTest
from roadproof.extensions.catalogue.traces import digest_of, files_of, traces_of
from roadproof.extensions.traffic.formats.sources import find_source
from roadproof.library.scenarios import PAIR, TRIPLE

SAMPLES = Path(__file__).parents[3] / "examples" / "catalogue" / "tests" / "samples"
ZONES = '[[lanelet]]\nid = 1007\nattribute = "departure"\n'
_OPENED: list[list[str]] = []


def _note(event: str, arguments: tuple[object, ...]) -> None:
    if event == "open" and _OPENED and isinstance(arguments[0], str | bytes):
        _OPENED[-1].append(str(arguments[0]))


sys.addaudithook(_note)


@contextmanager
def opened(folder: Path) -> Iterator[set[Path]]:
    """The files in a folder that are opened inside."""
    found = set[Path]()
    _OPENED.append([])
    try:
        yield found
    finally:
        found |= {Path(x) for x in _OPENED.pop() if Path(x).is_relative_to(folder) and Path(x).is_file()}


def storyboard(folder: Path) -> Path:
    """A scenario on a map, with a vehicle of a catalogue."""
    (folder / "cars").mkdir()
    catalogue = f'<OpenSCENARIO><FileHeader/><Catalog name="cars">{CAR}</Catalog></OpenSCENARIO>'
    (folder / "cars/any.xosc").write_text(catalogue, "utf-8")
    more = '<CatalogLocations><VehicleCatalog><Directory path="cars"/></VehicleCatalog></CatalogLocations>'
    entity = '<CatalogReference catalogName="cars" entryName="car"/>'
    begin = {name: init(name, lane(-2, s), "25") for name, s in (("SV", 100), ("POV", 130))}
    return put(folder, begin, more=more, entity=entity)


def commonroad(folder: Path) -> Path:
    return urban(folder, ZONES)


def samples(folder: Path) -> Path:
    for name in ("braking.csv", "braking_road.toml"):
        shutil.copy(SAMPLES / name, folder)
    return folder / "braking.csv"


@pytest.mark.parametrize("make", [storyboard, commonroad, samples])
def test_every_file_that_is_read_counts(make: Callable[[Path], Path], tmp_path: Path) -> None:
    place = make(tmp_path)
    with opened(tmp_path) as found:
        for _ in traces_of(ConcreteTest("a", str(place), ""), {*PAIR, *TRIPLE}):
            pass
    assert found
    assert found <= {*files_of(str(place))}
    before = digest_of(str(place))
    for file in found:
        content = file.read_bytes()
        file.write_bytes(content + b"\n")
        assert digest_of(str(place)) != before
        file.write_bytes(content)
    assert digest_of(str(place)) == before


def test_a_file_that_comes_beside_a_test_counts(tmp_path: Path) -> None:
    place = urban(tmp_path)
    before = digest_of(str(place))
    (tmp_path / "a_zones.toml").write_text(ZONES)
    assert digest_of(str(place)) != before


def test_a_recording_of_a_pair_counts_what_is_beside_it(tmp_path: Path) -> None:
    place = urban(tmp_path)
    before = digest_of(f"{place}:2,3")
    (tmp_path / "a_zones.toml").write_text(ZONES)
    assert digest_of(f"{place}:2,3") != before
    assert len(find_source(place).digests()) == 2
