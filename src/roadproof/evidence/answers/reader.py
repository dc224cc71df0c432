"""What the reader of an index is: fields that there may be, and how entries are read from them."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import field, is_dataclass
from types import NoneType
from typing import Annotated, TypeAlias, TypeVar, get_args, get_origin

from roadproof.errors import InputError
from roadproof.evidence.answers import shared
from roadproof.evidence.answers.entry import Common, Entry, common_of
from roadproof.evidence.codec import UNCHECKED, Doc, Rule, bare, fields_of, read
from roadproof.evidence.heading import HEADING
from roadproof.evidence.strict import Fields
from roadproof.library.specification import Library
from roadproof.runtime.records import dataclass

T = TypeVar("T")
W = TypeVar("W")
R = TypeVar("R")

# Property, part and scenario of a claim in a set, where it is a template property.
FindLabel: TypeAlias = Callable[[str, str], "tuple[str, str, int | None] | None"]


def without_labels(claim: str, set_name: str) -> tuple[str, str, int | None] | None:
    """A ``FindLabel`` for answers that are not about template properties."""
    return None


@dataclass(frozen=True)
class Background:
    """Against what entries are read; ``said`` is what an index says once, or the head of kept answers.

    ``where``: what the entries are read from.
    """

    said: Fields
    library: Library
    where: str
    find_label: FindLabel = without_labels
    made: dict[str, Common] = field(default_factory=dict, repr=False, compare=False)

    def at(self, set_name: str) -> Common:
        """What is said once, about a set; made once for each. Raises ``InputError``."""
        if set_name not in self.made:
            self.made[set_name] = common_of(self.said, self.library, set_name, self.where)
        return self.made[set_name]

    @property
    def home(self) -> Common:
        """As ``at``, about the set that names without @ are read in."""
        return self.at(first_set(self.said))

    def once(self, kind: type[T]) -> T:
        """The fields that are said once for all entries, as ``kind`` defines them. Raises ``InputError``."""
        keys = {x.key for x in fields_of(bare(kind))}
        return read(kind, {k: x for k, x in self.said.content.items() if k in keys}, self.said.where)


def first_set(data: Fields) -> str:
    """The set that names without @ are read in. Raises ``InputError``."""
    sets = data.texts("sets") if data.has("sets") else tuple(data.text("set").split(","))
    if not sets:
        raise InputError(f"{data.where}: it names no set")
    return sets[0]


@dataclass(frozen=True, kw_only=True)
class KeptFile:
    """What a file of a kept answer says beside the answer."""

    evidence: Annotated[tuple[shared.KeptFile, ...], Doc("All files that the answer rests on.")]
    seal: Annotated[
        str,
        Rule(pattern="^[0-9a-f]{64}$"),
        Doc("SHA-256 over question, answer and the bytes of its evidence."),
    ]


def read_kept(kind: type[T], record: Fields) -> T:
    """A kept answer, as it is defined. Raises ``InputError``."""
    content = {key: x for key, x in record.content.items() if key not in ("evidence", "seal")}
    return read(kind, content, record.where)


Read: TypeAlias = Callable[[Fields, Background], Iterable[Entry]]


def _lines(record: Fields) -> Iterator[object]:
    """The objects of a kept answer; texts and numbers beside them are in no index."""
    for value in record.content.values():
        if isinstance(value, dict):
            yield value
        elif isinstance(value, list):
            yield from (x for x in value if not isinstance(x, str))


def unchecked(kind: object) -> tuple[str, ...]:
    """The paths of the fields that ``check`` compares with nothing, such as ``verdicts[].seconds``."""
    kind = bare(kind)
    if not (is_dataclass(kind) and isinstance(kind, type)):
        return ()
    every = ((x.key, [""] if x.has(UNCHECKED) else _below(x.type)) for x in fields_of(kind))
    return tuple(f"{key}{path}" for key, paths in every for path in paths)


def _below(kind: object) -> list[str]:
    """Paths below a field, with what joins them to it."""
    kind = bare(kind)
    if is_dataclass(kind):
        return [f".{path}" for path in unchecked(kind)]
    listed = "[]" if get_origin(kind) is tuple else ""
    inside = (x for x in get_args(kind) if x is not NoneType and x is not Ellipsis)
    return [f"{listed}{path}" for x in inside for path in _below(x)]


@dataclass(frozen=True)
class Reader:
    """How an index of one ``schema`` is read, and each of the answers that are kept before it is written.

    ``said`` are the fields of what is said once for all entries, ``index`` the further ones of an index,
    ``record`` those of a kept answer. ``alone``: files that no answer names may lie beside them, and stand
    for themselves. ``faults``: what an index says as a whole and its entries do not show, given the formulas
    of its accepted drives by file. All raise ``InputError``.

    ``unchecked`` are the fields of the index that nothing is compared with, as paths such as
    ``verdicts[].seconds``, ``unchecked_kept`` those of a kept answer without an index, and of its question;
    ``check`` lists them. A test changes every other field and expects a rejection.

    ``file_name``: under which name a kept answer says that it is kept; ``lines``: its objects as an index
    holds them; ``record_faults``: what it says and its entries do not show.
    """

    schema: str
    said: tuple[str, ...]
    index: tuple[str, ...]
    record: tuple[str, ...]
    read_index: Read
    read_record: Read
    faults: Callable[[Fields, Background, Mapping[str, str]], Iterable[str]]
    file_name: Callable[[Fields], str | None]
    record_faults: Callable[[Fields, Background], Iterable[str]]
    unchecked: tuple[str, ...]
    unchecked_kept: tuple[str, ...]
    alone: bool = False
    lines: Callable[[Fields], Iterable[object]] = _lines

    @staticmethod
    def of(
        index: type[W],
        said: type,
        record: type[R],
        entries: Callable[[W | R, Background], Iterable[Entry]],
        *,
        faults: Callable[[W, Background, Mapping[str, str]], Iterable[str]] | None = None,
        file_name: Callable[[R], str | None] | None = None,
        record_faults: Callable[[R, Background], Iterable[str]] | None = None,
        schema: str = "",
    ) -> "Reader":
        """The reader of an index that is defined as ``index``, and whose kept answers are ``record``.

        ``entries`` are those of either; the other functions get what was read, too. ``schema``: where there
        is no index.
        """
        every = {x.key: x for x in fields_of(bare(index))}
        once = tuple(x.key for x in fields_of(said))

        def read_index(data: Fields) -> W:
            return read(index, data.content, data.where)

        return Reader(
            schema or get_args(every["schema"].type)[0],
            once,
            tuple(x for x in every if x not in (*HEADING, *once)),
            tuple(x.key for x in fields_of(bare(record))),
            lambda data, background: entries(read_index(data), background),
            lambda kept, background: entries(read_kept(record, kept), background),
            lambda data, background, formulas: (
                faults(read_index(data), background, formulas) if faults else ()
            ),
            lambda kept: file_name(read_kept(record, kept)) if file_name else None,
            lambda kept, background: (
                record_faults(read_kept(record, kept), background) if record_faults else ()
            ),
            tuple(sorted(unchecked(index), key=lambda path: (path.count("[]"), path != "seconds"))),
            tuple(sorted(unchecked(record), key=lambda path: path.count("[]"))),
        )
