"""Folders of tests: files that are tests as they are, and ``catalogue.toml``, which says more of them."""

from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass, replace
from itertools import count
from pathlib import Path

from roadproof.errors import InputError
from roadproof.evidence.drive_file import SCHEMAS_READ
from roadproof.evidence.strict import LARGEST_INDEX, read_json
from roadproof.extensions.catalogue.entries import Abstract, Catalogue, Concrete, Entry, Request
from roadproof.extensions.catalogue.listing import FILE_NAME, listed
from roadproof.extensions.drivers.restriction import said_in
from roadproof.extensions.exchange.storyboard.distributions import scenarios_of, split
from roadproof.extensions.traffic.evaluate.one_trace import is_pair
from roadproof.extensions.traffic.formats.samples import HEADER
from roadproof.extensions.traffic.formats.source import TRACK_FILES, first_line
from roadproof.library.specification import Specification
from roadproof.runtime.files import refuse_name
from roadproof.world.unread import unread_of_road

_LOOK = 400  # bytes of a file that tell what it is


QUESTION = "question.json"


@dataclass(frozen=True)
class _Found:
    """An entry, and the file that names it; ``is_whole``: it stands for the whole of that file."""

    entry: Entry
    source: str
    is_whole: bool = False


def read_catalogue(
    paths: Iterable[Path | str], specification: Specification, strict: bool = False
) -> Catalogue:
    """The tests of folders and files, in order; one that cannot be read is a test with a fault.

    A folder's tests are those of each ``catalogue.toml`` in it, and every drive file, file of samples and
    scenario of CommonRoad or OpenSCENARIO that none of these names; but not the drives of answers about
    catalogues, which may lie in it. ``strict``: nothing of the files of tests may be left out. Raises
    ``InputError`` where there is no test, or nothing but files of tests that cannot be read at all.
    """
    found: list[_Found] = []
    notes: list[str] = []
    for path in paths:
        if is_pair(str(path)):
            found.append(_Found(Concrete(str(path), str(path)), str(path)))
        elif Path(path).is_dir():
            found += _folder(Path(path), specification, {x.entry.id for x in found}, notes)
        else:
            found += _file(Path(path), specification)
    if not found:
        told = ", ".join(map(str, paths))
        raise InputError(
            f"{told}: no test in it; tests are drive files (.json), samples (.csv, .parquet), scenarios of "
            f"CommonRoad (.xml) and OpenSCENARIO (.xosc), and what a {FILE_NAME} names"
        )
    if all(x.is_whole for x in found):
        raise InputError("\n".join(x.entry.fault for x in found if isinstance(x.entry, Concrete)))
    entries = tuple(_with_own_ids(found))
    sources = {entry.id: x.source for entry, x in zip(entries, found, strict=True)}
    if strict:
        entries = tuple(_strictly(x, sources[x.id]) for x in entries)
    return Catalogue(entries, tuple(notes), sources)


def _strictly(entry: Entry, source: str) -> Entry:
    """A test of which nothing may be left out, with a fault where parts of the map of its road are."""
    if isinstance(entry, Concrete):
        return replace(entry, strict=True)
    try:
        unread_of_road(entry.road, strict=True)
    except InputError as error:
        return Concrete(entry.id, source, entry.title, entry.claims, fault=str(error))
    return entry


def _with_own_ids(found: Iterable[_Found]) -> Iterator[Entry]:
    """The entries; of two with one id the second is a test with a fault, and is called otherwise."""
    first: dict[str, str] = {}
    taken = {x.entry.id for x in found}
    for x in found:
        name = x.entry.id
        if name not in first:
            first[name] = x.source
            yield x.entry
            continue
        other = next(y for k in count(2) if (y := f"{name} ({k})") not in taken)
        taken.add(other)
        where = f"; the other one is in {first[name]}" if first[name] != x.source else ""
        fault = f"{x.source}: two tests are called {name}{where}; give each an id of its own"
        place = x.source
        if isinstance(x.entry, Concrete):
            place, fault = x.entry.place, x.entry.fault or fault
        yield Concrete(other, place, x.entry.title, fault=fault)


def _file(path: Path, specification: Specification) -> list[_Found]:
    if not path.exists() and split(path) is None:
        raise InputError(f"{path} does not exist")
    refuse_name(path)
    if path.suffix == ".toml":
        return _listed(path, specification)
    return [_Found(Concrete(x.stem, str(x)), str(path)) for x in scenarios_of(path)]


def _listed(path: Path, specification: Specification) -> list[_Found]:
    try:
        return [_Found(entry, str(path)) for entry in listed(path, specification)]
    except InputError as error:
        return [_Found(Concrete(str(path), str(path), fault=str(error)), str(path), is_whole=True)]


def _folder(
    folder: Path, specification: Specification, taken: Collection[str], notes: list[str]
) -> list[_Found]:
    """The tests of a folder; files that nobody names are called as in it, or by path if that is taken."""
    found: list[_Found] = []
    answers = {x.parent for x in folder.rglob(QUESTION) if is_answer(x)}
    for path in sorted(folder.rglob(FILE_NAME)):
        found += _listed(path, specification)
    places = [x.entry.place for x in found if isinstance(x.entry, Concrete)]
    named = {Path(x) for x in places} | {Path(x.rpartition(":")[0] or x) for x in places}
    others = 0
    for path in sorted(x for x in folder.rglob("*") if x.is_file() and x not in named):
        if answers & {*path.parents}:
            continue
        if is_test(path):
            refuse_name(path)
            for one in scenarios_of(path):
                name = one.relative_to(folder).with_suffix("").as_posix()
                known = {*taken, *(x.entry.id for x in found)}
                own_id = one.as_posix() if name in known else name
                found.append(_Found(Concrete(own_id, str(one)), str(path)))
        elif path.suffix in (".json", ".csv", ".parquet", ".xml", ".xosc"):
            others += 1
    if others:
        told = "more files of data are no tests, such as indices, certificates and recordings"
        notes.append(f"{folder}: {others} {told}")
    return found


def is_answer(path: Path) -> bool:
    """Whether a ``question.json`` is one of ``catalogue``, whose drives are no tests."""
    try:
        content = read_json(path, LARGEST_INDEX)
    except InputError:
        return False
    return isinstance(content, dict) and content.get("question") == "catalogue"


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


def read_tests(request: Request, plain: Specification, asked: Specification) -> Catalogue:
    """Return the tests as the library says them, whatever the scenarios are that are ``asked`` about."""
    tests = read_catalogue(request.paths, plain, request.strict)
    if plain is asked:
        return tests
    entries = tuple(
        replace(x, query=said_in(x.query, plain, asked)) if isinstance(x, Abstract) else x
        for x in tests.entries
    )
    return replace(tests, entries=entries)
