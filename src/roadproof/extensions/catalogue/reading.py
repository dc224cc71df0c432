"""Reader of folders of tests: files that are tests by themselves, and ``catalogue.toml`` files."""

from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass, replace
from itertools import count
from pathlib import Path

from roadproof.core_record import DRIVES
from roadproof.errors import InputError
from roadproof.evidence.strict import LARGEST_INDEX, read_json
from roadproof.extensions.catalogue.catalogue_file import FILE_NAME, read_catalogue_file
from roadproof.extensions.catalogue.entries import AbstractTest, CatalogueTests, ConcreteTest, Entry, Request
from roadproof.extensions.drivers.restriction import restated_in
from roadproof.extensions.exchange.storyboard.distributions import scenarios_of, split
from roadproof.extensions.traffic.evaluate.one_trace import is_pair
from roadproof.extensions.traffic.formats.samples import HEADER
from roadproof.extensions.traffic.formats.source import TRACK_FILES, first_line
from roadproof.library.specification import Specification
from roadproof.runtime.files import refuse_name
from roadproof.world.not_read import road_not_read_note

_BEGINNING = 400  # bytes of a file by which its format is recognised


QUESTION = "question.json"


@dataclass(frozen=True)
class _NamedEntry:
    """An entry with the file that names it; ``is_whole``: the entry stands for the whole file."""

    entry: Entry
    source: str
    is_whole: bool = False


def read_catalogue(
    paths: Iterable[Path | str], specification: Specification, strict: bool = False
) -> CatalogueTests:
    """Return the tests of folders and files in order; one that cannot be read is a test with a fault.

    The tests of a folder are those of each ``catalogue.toml`` in it. Other drive files, files of samples and
    scenarios of CommonRoad and OpenSCENARIO are tests too. Drives of answers about catalogues in the folder
    are none. ``strict``: nothing of the files of tests may be left out. Raises ``InputError``
    where there is no test, or where no file of tests can be read.
    """
    named_entries: list[_NamedEntry] = []
    notes: list[str] = []
    for path in paths:
        if is_pair(str(path)):
            named_entries.append(_NamedEntry(ConcreteTest(str(path), str(path)), str(path)))
        elif Path(path).is_dir():
            named_entries += _folder(Path(path), specification, {x.entry.id for x in named_entries}, notes)
        else:
            named_entries += _file(Path(path), specification)
    if not named_entries:
        places = ", ".join(map(str, paths))
        raise InputError(
            f"{places}: no test in it; tests are drive files (.json), samples (.csv, .parquet), scenarios of "
            f"CommonRoad (.xml) and OpenSCENARIO (.xosc), and what a {FILE_NAME} names"
        )
    if all(x.is_whole for x in named_entries):
        raise InputError("\n".join(x.entry.fault for x in named_entries if isinstance(x.entry, ConcreteTest)))
    entries = tuple(_with_own_ids(named_entries))
    sources = {entry.id: x.source for entry, x in zip(entries, named_entries, strict=True)}
    if strict:
        entries = tuple(_strictly(x, sources[x.id]) for x in entries)
    return CatalogueTests(entries, tuple(notes), sources)


def _strictly(entry: Entry, source: str) -> Entry:
    """Return a test of which nothing may be left out; it has a fault where parts of its map are."""
    if isinstance(entry, ConcreteTest):
        return replace(entry, strict=True)
    try:
        road_not_read_note(entry.road, strict=True)
    except InputError as error:
        return ConcreteTest(entry.id, source, entry.title, entry.claims, fault=str(error))
    return entry


def _with_own_ids(named: Iterable[_NamedEntry]) -> Iterator[Entry]:
    """Yield the entries; of two with one id, the second becomes a test with a fault and another id."""
    first: dict[str, str] = {}
    taken = {x.entry.id for x in named}
    for x in named:
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
        if isinstance(x.entry, ConcreteTest):
            place, fault = x.entry.place, x.entry.fault or fault
        yield ConcreteTest(other, place, x.entry.title, fault=fault)


def _file(path: Path, specification: Specification) -> list[_NamedEntry]:
    """Return the tests of a file. Raises ``InputError`` where it does not exist."""
    if not path.exists() and split(path) is None:
        raise InputError(f"{path} does not exist")
    refuse_name(path)
    if path.suffix == ".toml":
        return _catalogue_file(path, specification)
    return [_NamedEntry(ConcreteTest(x.stem, str(x)), str(path)) for x in scenarios_of(path)]


def _catalogue_file(path: Path, specification: Specification) -> list[_NamedEntry]:
    """Return the tests of a ``catalogue.toml``; one with a fault where it cannot be read at all."""
    try:
        return [_NamedEntry(entry, str(path)) for entry in read_catalogue_file(path, specification)]
    except InputError as error:
        return [_NamedEntry(ConcreteTest(str(path), str(path), fault=str(error)), str(path), is_whole=True)]


def _folder(
    folder: Path, specification: Specification, taken: Collection[str], notes: list[str]
) -> list[_NamedEntry]:
    """Return the tests of a folder. The id of a file that no entry names is its path in the folder.

    If that id is ``taken``, it is the whole path. Adds a note on files that are no tests.
    """
    entries: list[_NamedEntry] = []
    answers = {x.parent for x in folder.rglob(QUESTION) if is_answer(x)}
    for path in sorted(folder.rglob(FILE_NAME)):
        entries += _catalogue_file(path, specification)
    places = [x.entry.place for x in entries if isinstance(x.entry, ConcreteTest)]
    named = {Path(x) for x in places} | {Path(x.rpartition(":")[0] or x) for x in places}
    others = 0
    for path in sorted(x for x in folder.rglob("*") if x.is_file() and x not in named):
        if answers & {*path.parents}:
            continue
        if is_test(path):
            refuse_name(path)
            for one in scenarios_of(path):
                name = one.relative_to(folder).with_suffix("").as_posix()
                known = {*taken, *(x.entry.id for x in entries)}
                own_id = one.as_posix() if name in known else name
                entries.append(_NamedEntry(ConcreteTest(own_id, str(one)), str(path)))
        elif path.suffix in (".json", ".csv", ".parquet", ".xml", ".xosc"):
            others += 1
    if others:
        text = "more files of data are no tests, such as indices, certificates and recordings"
        notes.append(f"{folder}: {others} {text}")
    return entries


def is_answer(path: Path) -> bool:
    """Return whether a ``question.json`` is one of ``catalogue``, whose drives are no tests."""
    try:
        content = read_json(path, LARGEST_INDEX)
    except InputError:
        return False
    return isinstance(content, dict) and content.get("question") == "catalogue"


def is_test(path: Path) -> bool:
    """Return whether a file that nobody names is a test: by its ending, and by how it begins.

    Samples beside a drive file of the same name are those of the drive, and no test of their own.
    """
    match path.suffix:
        case ".json":
            beginning = _beginning(path)
            return any(f'"{schema}"' in beginning for schema in DRIVES)
        case ".csv":
            header = {x.strip() for x in first_line(path).split(",")}
            return header >= {*HEADER} and not TRACK_FILES.fullmatch(path.name) and _is_alone(path)
        case ".parquet":
            return _is_alone(path)
        case ".xosc":
            return "<OpenSCENARIO" in _beginning(path)
        case ".xml":
            return "<commonRoad" in _beginning(path)
        case _:  # open: names of files
            return False


def _is_alone(path: Path) -> bool:
    return not path.with_suffix(".json").is_file()


def _beginning(path: Path) -> str:
    try:
        with path.open("rb") as file:
            return file.read(_BEGINNING).decode("utf-8", "replace")
    except OSError:
        return ""


def read_tests(request: Request, plain: Specification, restricted: Specification) -> CatalogueTests:
    """Return the tests with formulas of ``plain``, in the definitions of ``restricted``."""
    tests = read_catalogue(request.paths, plain, request.strict)
    if plain is restricted:
        return tests
    entries = tuple(
        replace(x, query=restated_in(x.query, plain, restricted)) if isinstance(x, AbstractTest) else x
        for x in tests.entries
    )
    return replace(tests, entries=entries)
