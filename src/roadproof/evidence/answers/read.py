"""Which reader an index and a kept answer have, by their schema.

A reader is the ``READER`` of a module in this folder; modules of no other folder are looked at.
"""

from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from importlib import import_module
from pkgutil import iter_modules

from roadproof.errors import InputError
from roadproof.evidence import answers
from roadproof.evidence.answers.entry import Entry
from roadproof.evidence.answers.reader import Background, FindLabel, Reader, without_labels
from roadproof.evidence.heading import HEADING, library_of
from roadproof.evidence.strict import Fields
from roadproof.library.specification import Library
from roadproof.runtime.version import VERSION


@cache
def readers() -> Mapping[str, Reader]:
    """The readers by schema."""
    names = sorted(module.name for module in iter_modules(answers.__path__))
    modules = [import_module(f"{answers.__name__}.{name}") for name in names]
    found = [x.READER for x in modules if isinstance(getattr(x, "READER", None), Reader)]
    assert len({reader.schema for reader in found}) == len(found), "two readers of one schema"
    return {reader.schema: reader for reader in found}


def index_fields(content: object, where: str) -> Fields:
    """An index, of any kind. Raises ``InputError`` for what begins or goes on as none does."""
    schema = Fields(content, where).text("schema")
    if schema not in readers():
        raise InputError(f"{where}: schema='{schema[:60]}' is none of an index: {', '.join(readers())}")
    reader = readers()[schema]
    data = Fields(content, where, (*HEADING, *reader.said, *reader.index))
    library_of(data)
    if "view" in data.content and data.text("view") != "dense":
        raise InputError(f"{where}: view='{data.text('view')[:40]}', but these answers are about dense time")
    return data


def read_index(data: Fields, library: Library, find_label: FindLabel) -> list[Entry]:
    """What an index says. Raises ``InputError``."""
    background = Background(data, library, data.where, find_label)
    return list(readers()[data.text("schema")].read_index(data, background))


def faults_of(data: Fields, library: Library, formulas: Mapping[str, str]) -> Iterator[str]:
    """What an index says as a whole and its entries do not show; ``formulas``: of its drives, by file."""
    from roadproof.drivers import restriction

    background = Background(data, library, data.where)
    told = dict(data.mapping("signals")) if data.has("signals") else {}
    if library_of(data) == library.fingerprint and told != library.freedom:
        yield f"{data.where}: what it says of own signals is not what they are declared"
    options = data.named_texts("options") if "options" in data.content else {}
    begins = {name: x for name, x in data.content.items() if name == "prevention"}
    if begins and begins != restriction.told(options, data.text("schema")):
        yield f"{data.where}: what it says of a driver that prevents is not what its options say"
    yield from readers()[data.text("schema")].faults(data, background, formulas)


def unchecked_fields(data: Fields, has_drives: bool) -> tuple[str, ...]:
    """The fields of an index that nothing is compared with, of those that it has; lists have ``[]``.

    ``has_drives``: whether there are drives among its evidence.
    """
    there = {path for path, _ in leaves_of(data.content)}
    every = readers()[data.text("schema")].unchecked
    if data.content.get("roadproof") != VERSION:
        every = ("roadproof", *every)  # made by another version, whichever it is
    if not has_drives:
        every = (*every, "parameters")  # proofs are about all values
    return tuple(x for x in every if any(path == x or path.startswith((f"{x}.", f"{x}[")) for path in there))


def unchecked_of_kept(head: Fields, in_index: bool, has_drives: bool) -> tuple[str, ...]:
    """The fields of kept answers, and of their question, that nothing is compared with.

    ``in_index``: an index beside them says all of them, so that their objects are compared with it.
    """
    reader = reader_of(head)
    if in_index:
        beside = (x for x in reader.unchecked_kept if x in reader.record and x not in reader.index)
        return (*beside, "question")
    values = ("said.parameters",) if "parameters" in reader.said and not has_drives else ()
    return (*reader.unchecked_kept, "question", *values)


def faults_of_head(head: Fields, index: Fields) -> Iterator[str]:
    """What the question of kept answers says otherwise than the index beside them."""
    if head.text("of") != index.text("schema"):
        yield f"{head.where}: of='{head.text('of')[:60]}', but the index beside it is {index.text('schema')}"
    said = said_of(head).content
    for name in reader_of(head).said:
        if said.get(name) != index.content.get(name):
            yield f"{head.where}: {name} is not that of the index beside it"


def faults_of_record(
    head: Fields, record: Fields, name: str, entries: Sequence[Entry], library: Library, in_index: bool
) -> Iterator[str]:
    """What a kept answer says otherwise than the ``name`` of its file, and its entries.

    ``in_index``: what an index says in the same words is looked at there.
    """
    reader = reader_of(head)
    told = reader.file_name(record)
    if told is not None and told != name:
        yield f"{record.where}: it is kept as '{name}', but says that it is '{told[:60]}'"
    files = {x.file for x in entries if x.file is not None}
    if {*record.texts("evidence")} != files:
        yield f"{record.where}: the files that it lists are not those that its answer names"
    if not in_index:
        yield from reader.record_faults(record, Background(said_of(head), library, record.where))


def leaves_of(content: object, path: str = "") -> Iterator[tuple[str, object]]:
    """Every value of plain data that holds no others, with its path; entries of lists have one path."""
    match content:
        case dict():
            for name, value in content.items():
                yield from leaves_of(value, f"{path}.{name}" if path else str(name))
        case list():
            for value in content:
                yield from leaves_of(value, f"{path}[]")
        case _:
            yield path, content


def read_record(
    head: Fields, record: Fields, library: Library, find_label: FindLabel = without_labels
) -> list[Entry]:
    """What a kept answer says, one of those under ``head``. Raises ``InputError``."""
    reader = reader_of(head)
    return list(reader.read_record(record, Background(said_of(head), library, record.where, find_label)))


def record_fields(schema: str, where: str) -> tuple[str, ...]:
    """The fields of a kept answer. Raises ``InputError`` where none are kept for that schema."""
    return _keeping(schema, where).record


def said_of(head: Fields) -> Fields:
    """What is said once for all kept answers. Raises ``InputError``."""
    return Fields(head.mapping("said"), head.where, reader_of(head).said)


def reader_of(head: Fields) -> Reader:
    """The reader of the kept answers under ``head``. Raises ``InputError``."""
    return _keeping(head.text("of"), head.where)


def _keeping(schema: str, where: str) -> Reader:
    keeping = {name: reader for name, reader in readers().items() if reader.record}
    if schema not in keeping:
        raise InputError(f"{where}: of='{schema[:60]}': there are journals of {', '.join(keeping)}")
    return keeping[schema]
