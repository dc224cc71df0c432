"""Folders of tests: files that are tests as they are, and ``catalogue.toml``, which says more of them.

Each ``[[test]]`` of a ``catalogue.toml`` has an ``id``, and either a ``file`` (a concrete test; beside the
TOML, or vehicles of a recording as ``01_tracks.csv:12,15``) or a ``formula`` (an abstract one). ``claims``
are numbers of scenarios and names of classes that the test is meant to show; ``copy_of`` is the id of a test
of which the file is the same drive in another format.
"""

import re
from collections.abc import Collection, Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from roadproof.analysis.catalogue.entries import Abstract, Catalogue, Concrete, Entry
from roadproof.errors import InputError
from roadproof.evaluation.one_trace import is_pair
from roadproof.evidence.answers.catalogue import SCHEMA
from roadproof.evidence.drive_file import SCHEMAS_READ
from roadproof.evidence.folder import INDEX
from roadproof.evidence.journal import HEAD
from roadproof.formats.samples import HEADER
from roadproof.formats.source import TRACK_FILES, first_line
from roadproof.spec.compose import always, both
from roadproof.spec.elaborate import read_claim
from roadproof.spec.library import Specification
from roadproof.spec.motion import split
from roadproof.spec.query import Query
from roadproof.spec.scenarios import claimed
from roadproof.world.models import load_road, load_vehicle, read_toml

FILE_NAME = "catalogue.toml"
_FIELDS = ("id", "title", "file", "copy_of", "formula", "claims", "road", "vehicles", "at_start", "always")
_OF_FORMULAS = ("road", "vehicles", "at_start", "always")
_LOOK = 400  # bytes of a file that tell what it is
_RANGE = re.compile(r"\s*(.+?)\s*\.\.\s*(.+?)\s*")


def read_catalogue(paths: Iterable[Path | str], specification: Specification) -> Catalogue:
    """The tests of folders and files, in order. Raises ``InputError``, ``TextError``.

    A folder's tests are those of each ``catalogue.toml`` in it, and every drive file, file of samples and
    scenario of CommonRoad or OpenSCENARIO that none of these names; but not the drives of answers about
    catalogues, which may lie in it.
    """
    entries: list[Entry] = []
    notes: list[str] = []
    for path in paths:
        if is_pair(str(path)):
            entries.append(Concrete(str(path), str(path)))
        elif Path(path).is_dir():
            found = _folder(Path(path), specification, {entry.id for entry in entries})
            entries += found.entries
            notes += found.notes
        else:
            entries += _file(Path(path), specification)
    _check_ids(entries)
    if not entries:
        told = ", ".join(map(str, paths))
        raise InputError(
            f"{told}: no test in it; tests are drive files (.json), samples (.csv, .parquet), scenarios of "
            f"CommonRoad (.xml) and OpenSCENARIO (.xosc), and what a {FILE_NAME} names"
        )
    return Catalogue(tuple(entries), tuple(notes))


def _check_ids(entries: Iterable[Entry]) -> None:
    first: dict[str, Entry] = {}
    for entry in entries:
        other = first.setdefault(entry.id, entry)
        if other is not entry:
            raise InputError(f"id={entry.id}: two tests are called so; give each an id of its own")


def _file(path: Path, specification: Specification) -> list[Entry]:
    if not path.exists():
        raise InputError(f"{path} does not exist")
    if path.suffix == ".toml":
        return list(_listed(path, specification))
    return [Concrete(path.stem, str(path))]


def _folder(folder: Path, specification: Specification, taken: Collection[str]) -> Catalogue:
    """The tests of a folder; files that nobody names are called as in it, or by path if that is taken."""
    entries: list[Entry] = []
    answers = {x.parent for name in (INDEX, HEAD) for x in folder.rglob(name) if is_answer(x)}
    for path in sorted(folder.rglob(FILE_NAME)):
        entries += _listed(path, specification)
    named = {Path(x.place.rpartition(":")[0] or x.place) for x in entries if isinstance(x, Concrete)}
    named |= {Path(x.place) for x in entries if isinstance(x, Concrete)}
    others = 0
    for path in sorted(x for x in folder.rglob("*") if x.is_file() and x not in named):
        if answers & {*path.parents}:
            continue
        if is_test(path):
            name = path.relative_to(folder).with_suffix("").as_posix()
            known = {*taken, *(x.id for x in entries)}
            entries.append(Concrete(path.as_posix() if name in known else name, str(path)))
        elif path.suffix in (".json", ".csv", ".parquet", ".xml", ".xosc"):
            others += 1
    told = f"{folder}: {others} more files of data are no tests, such as indices, certificates and recordings"
    return Catalogue(tuple(entries), (told,) if others else ())


def is_answer(path: Path) -> bool:
    """Whether an index, or the head of kept answers, is one of ``catalogue``, whose drives are no tests."""
    return f'"{SCHEMA}"' in _beginning(path)


def is_test(path: Path) -> bool:
    """Whether a file that nobody names is a test: by its ending, and by how it begins.

    Samples beside a drive file of the same name are those of the drive, and no test of their own.
    """
    match path.suffix:
        case ".json":
            begun = _beginning(path)
            return any(f'"{schema}"' in begun for schema in SCHEMAS_READ)
        case ".csv":
            header = {x.strip() for x in first_line(path).split(",")}
            return header >= {*HEADER} and not TRACK_FILES.fullmatch(path.name) and _is_alone(path)
        case ".parquet":
            return _is_alone(path)
        case ".xosc":
            return "<OpenSCENARIO" in _beginning(path)
        case ".xml":
            return "<commonRoad" in _beginning(path)
        case _:
            return False


def _is_alone(path: Path) -> bool:
    return not path.with_suffix(".json").is_file()


def _beginning(path: Path) -> str:
    try:
        with path.open("rb") as file:
            return file.read(_LOOK).decode("utf-8", "replace")
    except OSError:
        return ""


# --- catalogue.toml -----------------------------------------------------------------------------


def _listed(path: Path, specification: Specification) -> Iterator[Entry]:
    content = read_toml(path)
    unknown = sorted(set(content) - {"test"})
    tests = content.get("test", [])
    if unknown or not isinstance(tests, list) or not tests:
        told = f"'{unknown[0]}' is not known" if unknown else "there is no [[test]]"
        raise InputError(f"{path}: {told}; a catalogue is a list of [[test]]")
    for number, test in enumerate(tests, 1):
        where = f"{path}, test {number}"
        if not isinstance(test, Mapping):
            raise InputError(f"{where}: a test is a table, [[test]]")
        yield _entry(path, test, where, specification)


def _entry(path: Path, test: Mapping[str, Any], where: str, specification: Specification) -> Entry:
    for name in test:
        if name not in _FIELDS:
            raise InputError(f"{where}: '{name}' is not known; a test has {', '.join(_FIELDS)}")
    own_id = _text(test, "id", where)
    if ("file" in test) == ("formula" in test):
        raise InputError(f"{where}, id={own_id}: a test has either a file or a formula")
    title = _text(test, "title", where) if "title" in test else ""
    claims = tuple(_claims(test.get("claims", []), f"{where}, claims", specification))
    if "file" in test:
        for name in _OF_FORMULAS:
            if name in test:
                raise InputError(f"{where}, id={own_id}: {name} is for tests with a formula")
        original = _text(test, "copy_of", where) if "copy_of" in test else ""
        return Concrete(own_id, str(path.parent / _text(test, "file", where)), title, claims, original)
    if "copy_of" in test:
        raise InputError(f"{where}, id={own_id}: copy_of is for tests with a file")
    query = both(*_parts(test, where, specification))
    road = None if "road" not in test else load_road(_beside(path, _text(test, "road", where)))
    models = _table(test, "vehicles", where)
    vehicles = {name: load_vehicle(_beside(path, model)) for name, model in models.items()}
    return Abstract(own_id, query, title, claims, road, vehicles)


def _parts(test: Mapping[str, Any], where: str, specification: Specification) -> Iterator[Query]:
    """The formula, and each of its ranges as a formula."""
    said, claim = split(_text(test, "formula", where), f"{where}, formula")
    if said:
        told = f"assuming {', '.join(said)}"
        raise InputError(f"{where}, formula: leave '{told}:' out; the drives of a test are motions as it is")
    yield read_claim(specification, claim, f"{where}, formula")
    for field, put in (("at_start", both), ("always", always)):
        for term, told in _table(test, field, where).items():
            read = _RANGE.fullmatch(told)
            if read is None:
                raise InputError(f"{where}, {field}: '{term}' = {told!r}; write a range, as 20 m/s .. 30 m/s")
            low, high = read.groups()
            within = f"{low} <= {term} and {term} <= {high}"
            yield put(read_claim(specification, within, f"{where}, {field}"))


def _claims(said: object, where: str, specification: Specification) -> Iterator[str]:
    if not isinstance(said, list):
        raise InputError(f"{where}={said!r}: write a list, such as [4] or ['class_4_main']")
    for one in said:
        if isinstance(one, bool) or not isinstance(one, int | str):
            raise InputError(f"{where}: {one!r} is no number of a scenario and no name of a class")
        yield claimed(specification, one, where)


def _text(test: Mapping[str, Any], field: str, where: str) -> str:
    value = test.get(field)
    if not isinstance(value, str) or not value.strip():
        raise InputError(f"{where}: {field}={value!r}; write a text")
    return value.strip()


def _table(test: Mapping[str, Any], field: str, where: str) -> dict[str, str]:
    table = test.get(field, {})
    if not isinstance(table, Mapping) or not all(isinstance(x, str) for x in table.values()):
        raise InputError(f"{where}: {field}={table!r}; write a table of texts")
    return dict(table)


def _beside(path: Path, name: str) -> str:
    """A model by name, or the file of one beside the catalogue."""
    return str(path.parent / name) if Path(name).suffix else name
