"""Which reader an index and a journal have, by their schema."""

from collections.abc import Callable, Iterator, Mapping

from roadproof.errors import InputError
from roadproof.evidence.answers import classify, coverage, explore, order, overlap, proofs, redundancy
from roadproof.evidence.answers.entry import Common, Entry, common_of
from roadproof.evidence.answers.proofs import FindLabel
from roadproof.evidence.strict import Fields
from roadproof.spec.library import Library

_FIELDS: Mapping[str, tuple[str, ...]] = {
    proofs.SCHEMA: proofs.FIELDS,
    overlap.SCHEMA: overlap.FIELDS,
    redundancy.SCHEMA: redundancy.FIELDS,
    order.SCHEMA: order.FIELDS,
    coverage.SCHEMA: coverage.FIELDS,
    classify.SCHEMA: (*classify.FIELDS, *classify.FIELDS_MORE),
    explore.SCHEMA: explore.FIELDS,
}
_RECORDS: Mapping[str, tuple[str, ...]] = {
    overlap.SCHEMA: ("verdict",),
    redundancy.SCHEMA: ("scenario", "verdicts"),
    order.SCHEMA: ("family", "proved", "drives", "doubts"),
    coverage.SCHEMA: ("group", "classes"),
}


def index_fields(content: object, where: str) -> Fields:
    """An index, of any kind. Raises ``InputError`` for another schema, and for a field that it has not."""
    schema = Fields(content, where).text("schema")
    if schema not in _FIELDS:
        raise InputError(f"{where}: schema='{schema[:60]}' is none of an index: {', '.join(_FIELDS)}")
    return Fields(content, where, _FIELDS[schema])


def read_index(data: Fields, library: Library, find_label: FindLabel) -> list[Entry]:
    """What an index says. Raises ``InputError``."""
    at_set = _common(data, library)
    match data.text("schema"):
        case proofs.SCHEMA:
            return [*proofs.read(data, at_set, find_label)]
        case overlap.SCHEMA:
            return [*overlap.read(data, at_set(first_set(data)), data.items("verdicts"))]
        case redundancy.SCHEMA:
            return [*redundancy.read(data, at_set(data.text("set")), data.items("verdicts"))]
        case order.SCHEMA:
            return [*order.read(data, at_set(first_set(data)), data.items("proved"), data.items("drives"))]
        case coverage.SCHEMA:
            common = at_set(data.text("set"))
            classes = coverage.read_classes(common, data.items("classes"))
            gaps = coverage.read_gaps(common, data.items("gaps"), data.where)
            return [*coverage.read_rest(data, common), *classes, *gaps]
        case classify.SCHEMA:
            return [*classify.read(data, at_set(classify.CLASSES))]
        case _:
            return [*explore.read(data, at_set)]


def faults_of(data: Fields, library: Library, formulas: Mapping[str, str]) -> Iterator[str]:
    """What an index says as a whole and its entries do not show; ``formulas``: of its drives, by file."""
    schema, at_set = data.text("schema"), _common(data, library)
    if schema == order.SCHEMA:
        yield from order.faults(data, at_set(first_set(data)), formulas)
    elif schema == coverage.SCHEMA:
        yield from coverage.faults(data, at_set(data.text("set")))


def read_record(head: Fields, record: Fields, library: Library) -> list[Entry]:
    """What one line of a journal says, whose first line is ``head``. Raises ``InputError``."""
    said = said_of(head)
    at_set = _common(said, library, record.where)
    match head.text("of"):
        case overlap.SCHEMA:
            return [*overlap.read(said, at_set(first_set(said)), [record.get("verdict")])]
        case redundancy.SCHEMA:
            return [*redundancy.read(said, at_set(said.text("set")), record.items("verdicts"))]
        case order.SCHEMA:
            common = at_set(first_set(said))
            return [*order.read(said, common, record.items("proved"), record.items("drives"))]
        case _:
            return [*coverage.read_classes(at_set(said.text("set")), record.items("classes"))]


def record_fields(schema: str, where: str) -> tuple[str, ...]:
    """The fields of a line of a journal. Raises ``InputError`` where there are no such journals."""
    if schema not in _RECORDS:
        raise InputError(f"{where}: of='{schema[:60]}': there are journals of {', '.join(_RECORDS)}")
    return _RECORDS[schema]


def said_of(head: Fields) -> Fields:
    """What a journal says once for all its lines."""
    known = {overlap.SCHEMA: overlap.SAID, redundancy.SCHEMA: redundancy.SAID, order.SCHEMA: order.SAID}
    return Fields(head.mapping("said"), head.where, known.get(head.text("of"), coverage.SAID))


def first_set(data: Fields) -> str:
    """The set that names without @ are read in."""
    sets = data.texts("sets") if data.has("sets") else tuple(data.text("set").split(","))
    if not sets:
        raise InputError(f"{data.where}: it names no set")
    return sets[0]


def _common(data: Fields, library: Library, where: str = "") -> Callable[[str], Common]:
    """What an index says once, about a set; made once for each set."""
    made: dict[str, Common] = {}

    def at(set_name: str) -> Common:
        if set_name not in made:
            made[set_name] = common_of(data, library, set_name, where)
        return made[set_name]

    return at
