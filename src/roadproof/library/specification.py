"""Definitions, spec sets and options: what a specification file says, before anybody meets anybody.

A set is a chain of overrides of named definitions; an option value is one more override. The
definitions in force for a choice of set and options are a ``Specification``.
"""

import hashlib
import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, fields, replace
from difflib import get_close_matches
from fractions import Fraction
from functools import cache, cached_property
from importlib import resources
from pathlib import Path
from typing import Any, TypeAlias, assert_never

from roadproof.errors import InputError, Position, TextError, raise_all
from roadproof.logic.custom_names import freedom_of, own_signal
from roadproof.logic.each import instances
from roadproof.logic.parse import parse_bundled, parse_library
from roadproof.logic.recover import ParseResult, parse_pieces
from roadproof.logic.syntax import (
    Binding,
    Definition,
    EachBlock,
    LaneDeclaration,
    OptionDeclaration,
    ParameterDeclaration,
    SetBlock,
    SignalDeclaration,
    Statement,
    TitleDeclaration,
    WhenBlock,
)
from roadproof.runtime.files import read_limited
from roadproof.world.signals import FIXED, SIGNALS

LARGEST_FILE = 1_000_000
_MENTION = re.compile(r"\[(\w+)\]")


@dataclass(frozen=True)
class Source:
    """A specification text and where it came from, for error messages."""

    name: str
    text: str


@dataclass(frozen=True)
class Library:
    """Everything that specification files declare; names are unique in each mapping.

    ``lanes``: by scenario, whose lane L is where that is not SV's (semantics §5). ``titles``: by scenario,
    what it is called, and where that is said; no reading depends on that. ``files``: the users' texts, in
    order. ``signals``: own signals; one that is derived is a definition, too.
    """

    parameters: Mapping[str, ParameterDeclaration]
    options: Mapping[str, OptionDeclaration]
    definitions: Mapping[str, Definition]
    sets: Mapping[str, SetBlock]
    variants: Mapping[tuple[str, str], tuple[Definition, ...]]
    sources: Mapping[str, Source]
    lanes: Mapping[int, LaneDeclaration]
    titles: Mapping[int, tuple[TitleDeclaration, Source]] = field(default_factory=dict)
    files: tuple[Source, ...] = ()
    signals: Mapping[str, SignalDeclaration] = field(default_factory=dict)

    @property
    def bounds(self) -> dict[str, str]:
        """The declared bound of every parameter against 0: ``>``, ``>=`` or none ('')."""
        return {name: parameter.bound for name, parameter in self.parameters.items()}

    @cached_property
    def freedom(self) -> dict[str, str]:
        """What an answer supposes of each own signal that is not derived: ``unconstrained: …``."""
        return {x.name: freedom_of(own_signal(x, "")) for x in self.signals.values() if x.body is None}

    @cached_property
    def fingerprint(self) -> str:
        """A short text that changes with all that is declared; with places and titles it does not."""
        left_out = (
            ("sources", "titles", "files") if self.signals else ("sources", "titles", "files", "signals")
        )
        parts = [x.name for x in fields(self) if x.name not in left_out]
        declared = [repr(sorted(getattr(self, part).items())) for part in parts]
        return hashlib.sha256("\0".join(declared).encode()).hexdigest()[:16]

    @cached_property
    def _selected(self) -> dict[tuple[str, tuple[tuple[str, str], ...]], "Specification"]:
        """The specifications that were selected, by set and options."""
        return {}

    def select(self, set_name: str = "base", options: Mapping[str, str] | None = None) -> "Specification":
        """The definitions in force for a spec set and option values (defaults where not given).

        The same choice gives the same object. Raises ``InputError`` for a set, option or value that does not
        exist.
        """
        chosen = {name: declared.values[0] for name, declared in self.options.items()}
        for name, value in (options or {}).items():
            if name not in self.options:
                raise InputError(f"option {name}={value}: {unknown('option', name, self.options)}")
            if value not in self.options[name].values:
                allowed = " or ".join(self.options[name].values)
                raise InputError(f"option {name}={value}: the value must be {allowed}")
            chosen[name] = value
        key = (set_name, tuple(chosen.items()))
        if key not in self._selected:
            self._selected[key] = self._made(set_name, chosen)
        return self._selected[key]

    def _made(self, set_name: str, chosen: Mapping[str, str]) -> "Specification":
        definitions = dict(self.definitions)
        for block in self._chain(set_name):
            definitions |= {d.name: d for d in block.definitions}
        for choice in chosen.items():
            definitions |= {d.name: d for d in self.variants.get(choice, ())}
        return Specification(self, set_name, chosen, definitions)

    def _chain(self, set_name: str) -> list[SetBlock]:
        """From the outermost ancestor to ``set_name``."""
        if set_name not in self.sets:
            raise InputError(f"set={set_name}: {unknown('spec set', set_name, self.sets)}")
        chain: list[SetBlock] = []
        name = set_name
        while name:
            chain.append(self.sets[name])
            name = self.sets[name].parent
        return chain[::-1]


@dataclass(frozen=True)
class Specification:
    """One spec set under one choice of options."""

    library: Library
    set_name: str
    options: Mapping[str, str]
    definitions: Mapping[str, Definition]

    @cached_property
    def worked_out(self) -> dict[tuple[object, ...], Any]:
        """What was worked out of these definitions, which do not change, by what was asked."""
        return {}

    def in_set(self, set_name: str) -> "Specification":
        """The same options under another set."""
        return self if set_name == self.set_name else self.library.select(set_name, self.options)

    def describe(self, definition: Definition, depth: int = 4) -> str:
        """Its description, with each ``[name]`` in it replaced by the description of that definition."""

        def look_up(found: re.Match[str]) -> str:
            other = self.definitions.get(found[1])
            return found[0] if other is None or depth == 0 else self.describe(other, depth - 1)

        return _MENTION.sub(look_up, definition.doc)


def unknown(what: str, name: str, known: Iterable[str]) -> str:
    """A message for a name that does not exist, with the nearest that does."""
    names = sorted(known)
    near = get_close_matches(name, names, n=1, cutoff=0.6)
    if near:
        return f"there is no {what} '{name}'; did you mean '{near[0]}'?"
    listed = ", ".join(names[:8]) + (", …" if len(names) > 8 else "")
    return f"there is no {what} '{name}'" + (f"; there are {listed}" if names else "")


def on_request() -> dict[str, Path]:
    """The specification files that come with roadproof and are read where they are named, by name."""
    folder = Path(__file__).parent / "sets" / "on_request"
    return {file.stem: file for file in sorted(folder.glob("*.spec"))}


def read_specification(path: Path) -> Source:
    """The text of a user's file, or of one that is read ``on_request`` and is named without its ending.

    Raises ``InputError`` where it cannot be read as UTF-8 text.
    """
    path = on_request().get(str(path), path)
    data = read_limited(path, LARGEST_FILE, "split it, or name another file")
    try:
        return Source(str(path), data.decode("utf-8"))
    except UnicodeDecodeError as error:
        raise InputError(
            f"{path} is not UTF-8 text: byte {error.start} is 0x{data[error.start]:02x}; save it as UTF-8"
        ) from None


Parse: TypeAlias = Callable[[str, str], tuple[Statement, ...]]


@cache
def bundled_library() -> Library:
    """The library that comes with roadproof: ``library/sets/*.spec``."""
    folder = resources.files("roadproof.library").joinpath("sets")
    files = sorted((f for f in folder.iterdir() if f.name.endswith(".spec")), key=lambda f: f.name)
    sources = [Source(f.name, f.read_text("utf-8")) for f in files]
    return build_library(sources, parse=parse_bundled)


def load_library(files: Iterable[Path | Source] = ()) -> Library:
    """The bundled library, with the users' files or texts on top: their definitions replace or add."""
    extra = sources_of(files)
    return (
        replace(build_library(extra, bundled_library()), files=tuple(extra)) if extra else bundled_library()
    )


def sources_of(files: Iterable[Path | Source]) -> list[Source]:
    """Texts, read from files where they are none yet. Raises ``InputError``."""
    return [file if isinstance(file, Source) else read_specification(file) for file in files]


def build_library(
    sources: Iterable[Source], below: Library | None = None, parse: Parse = parse_library
) -> Library:
    """Put statements into their mappings, as ``parse`` reads them.

    Raises ``TextError`` for all that does not parse, is there twice, or names what does not exist.
    """
    gathered = gather({source: _parsed(source, parse) for source in sources}, below)
    raise_all(gathered.errors)
    return gathered.library


def _parsed(source: Source, parse: Parse = parse_library) -> ParseResult:
    """What is read of a text; the whole at once, which is quicker where it has no mistake."""
    try:
        return ParseResult(parse(source.text, source.name))
    except TextError as error:
        pieces = parse_pieces(source.text, source.name)
        return pieces if pieces.errors else replace(pieces, errors=(error,))


@dataclass(frozen=True)
class ReadOutcome:
    """What could be read of texts, all that could not, in their order, and how names look that are lost."""

    library: Library
    errors: tuple[TextError, ...] = ()
    lost: tuple[re.Pattern[str], ...] = ()


def gather(readings: Mapping[Source, ParseResult], below: Library | None = None) -> ReadOutcome:
    """What was read of texts, put into its mappings."""
    building, errors, lost = _Builder(below), list[TextError](), list[re.Pattern[str]]()
    for source, parsed in readings.items():
        errors += sorted([*parsed.errors, *building.add(parsed.statements, source)], key=place_of)
        lost += parsed.lost
    lost += (re.compile(re.escape(name)) for name in building.refused)
    return ReadOutcome(building.library(), tuple(errors), tuple(lost))


def gather_files(files: Iterable[Path | Source]) -> ReadOutcome:
    """As ``load_library``, with all that is wrong. Raises ``InputError`` where a file is no text."""
    extra = sources_of(files)
    if not extra:
        return ReadOutcome(bundled_library())
    gathered = gather({source: _parsed(source) for source in extra}, bundled_library())
    return replace(gathered, library=replace(gathered.library, files=tuple(extra)))


def place_of(error: TextError) -> tuple[int, int]:
    """Line and column of an error, to sort by."""
    return (0, 0) if error.position is None else (error.position.line, error.position.column)


class _Builder:
    def __init__(self, below: Library | None) -> None:
        self.parameters = dict(below.parameters) if below else {}
        self.options = dict(below.options) if below else {}
        self.definitions = dict(below.definitions) if below else {}
        self.sets = dict(below.sets) if below else {}
        self.variants = dict(below.variants) if below else {}
        self.sources = dict(below.sources) if below else {}
        self.lanes = dict(below.lanes) if below else {}
        self.titles = dict(below.titles) if below else {}
        self.signals = dict(below.signals) if below else {}
        self.refused: list[str] = []

    def library(self) -> Library:
        return Library(
            self.parameters,
            self.options,
            self.definitions,
            self.sets,
            self.variants,
            self.sources,
            self.lanes,
            self.titles,
            signals=self.signals,
        )

    def add(self, statements: Iterable[Statement], source: Source) -> list[TextError]:
        """Add what a text says, and tell what of it cannot be added."""
        fresh: set[tuple[str, str]] = set()
        blocks: list[SetBlock | WhenBlock] = []
        errors: list[TextError] = []
        for statement in statements:
            if isinstance(statement, SetBlock | WhenBlock):
                blocks.append(statement)
                continue
            try:
                self._add(statement, fresh, source)
            except TextError as error:
                errors.append(error.locate(source.name, source.text))
                self.refused += _declares(statement)
        for block in blocks:
            try:
                self._override(block, fresh, source, errors)
            except TextError as error:
                errors.append(error.locate(source.name, source.text))
        return errors

    def _add(self, statement: Statement, fresh: set[tuple[str, str]], source: Source) -> None:
        match statement:
            case ParameterDeclaration():
                _once(fresh, "parameter", statement.name, statement.at)
                if not is_within(statement.bound, statement.value):
                    raise TextError(
                        f"{statement.name}={statement.value} {statement.unit}: it is declared with "
                        f"{statement.name} {statement.bound} 0",
                        statement.at,
                        "Give a value within the bound, or another bound.",
                    )
                if statement.name in self.signals:
                    raise TextError(f"'{statement.name}' is a signal already", statement.at)
                self.parameters[statement.name] = statement
                self.sources[_key(statement)] = source
            case OptionDeclaration():
                _once(fresh, "option", statement.name, statement.at)
                self.options[statement.name] = statement
            case Definition():
                self._define(statement, fresh, source)
            case SignalDeclaration():
                self._declare(statement, fresh, source)
            case EachBlock():
                for definition in instances(statement):
                    self._define(definition, fresh, source)
            case SetBlock() | WhenBlock():
                raise AssertionError("blocks are added last")
            case LaneDeclaration():
                for number in statement.scenarios:
                    _once(fresh, "lane of scenario", str(number), statement.at)
                    self.lanes[number] = statement
            case TitleDeclaration():
                for number in statement.scenarios:
                    _once(fresh, "title of scenario", str(number), statement.at)
                    self.titles[number] = (statement, source)
            case _:
                assert_never(statement)

    def _define(self, definition: Definition, fresh: set[tuple[str, str]], source: Source) -> None:
        _once(fresh, "definition", definition.name, definition.at)
        if definition.name in BUILT_IN:
            raise TextError(f"'{definition.name}' is built in and cannot be defined", definition.at)
        if definition.name in self.signals:
            raise TextError(
                f"'{definition.name}' is a signal",
                definition.at,
                "Say what it is with signal … derived by ….",
            )
        self.definitions[definition.name] = definition
        self.sources[_key(definition)] = source

    def _declare(self, signal: SignalDeclaration, fresh: set[tuple[str, str]], source: Source) -> None:
        """An own signal; one that is derived is a definition whose body has to be of its unit."""
        name, at = signal.name, signal.at
        _once(fresh, "signal", name, at)
        if name in BUILT_IN:
            raise TextError(f"'{name}' is built in and cannot be declared", at)
        if ROLE.fullmatch(name) or name in NOT_A_COLUMN:
            raise TextError(f"'{name}' means something else already", at, "Give the signal another name.")
        known = self.definitions.keys() - self.signals.keys()
        for what, others in (("definition", known), ("parameter", self.parameters)):
            if name in others:
                raise TextError(f"'{name}' is a {what} already", at, "Give the signal another name.")
        self.definitions.pop(name, None)
        self.signals[name] = signal
        self.sources[_key(signal)] = source
        if signal.body is not None:
            bindings = (Binding(signal.vehicle, "vehicle", at),) if signal.vehicle else ()
            self.definitions[name] = Definition(name, bindings, signal.doc, signal.body, at)

    def _override(
        self,
        block: SetBlock | WhenBlock,
        fresh: set[tuple[str, str]],
        source: Source,
        errors: list[TextError],
    ) -> None:
        inside: set[tuple[str, str]] = set()
        for definition in block.definitions:
            try:
                _once(inside, "definition", definition.name, definition.at)
                if definition.name not in self.definitions:
                    message = unknown("definition", definition.name, self.definitions)
                    raise TextError(f"an override needs something to replace: {message}", definition.at)
                self.sources[_key(definition)] = source
            except TextError as error:
                errors.append(error.locate(source.name, source.text))
                self.refused += _declares(definition)
        if isinstance(block, SetBlock):
            _once(fresh, "set", block.name, block.at)
            if block.parent and block.parent not in self.sets:
                raise TextError(unknown("spec set", block.parent, self.sets), block.at)
            self.sets[block.name] = block
        else:
            if block.option not in self.options:
                raise TextError(unknown("option", block.option, self.options), block.at)
            if block.value not in self.options[block.option].values:
                message = unknown(
                    f"value of option {block.option}", block.value, self.options[block.option].values
                )
                raise TextError(message, block.at)
            key = (block.option, block.value)
            self.variants[key] = (*self.variants.get(key, ()), *block.definitions)


def _declares(statement: Statement) -> list[str]:
    declares = Definition | ParameterDeclaration | SignalDeclaration
    return [statement.name] if isinstance(statement, declares) else []


# Names that mean something without a definition; spec.elaborate gives their meaning.
BUILT_IN = frozenset(
    {*SIGNALS, *FIXED, "occ"} | {"max", "min", "abs", "inverse", "lanes", "lanelets", "zone", "adjacentLanes"}
)
# Names of vehicles and lanes that need no declaration, and columns that recordings have beside signals.
ROLE = re.compile(r"SV|POV[0-9]?|L[0-9]?")
NOT_A_COLUMN = frozenset({"time", "vehicle"})


def is_within(bound: str, value: Fraction) -> bool:
    """Whether a value keeps a declared bound: ``>``, ``>=`` (both against 0) or none."""
    return value > 0 if bound == ">" else value >= 0 if bound == ">=" else True


def _key(declared: Definition | ParameterDeclaration | SignalDeclaration) -> str:
    return f"{declared.name}:{declared.at.line}:{declared.at.column}"


def source_of(library: Library, declared: Definition | ParameterDeclaration | SignalDeclaration) -> Source:
    """Where a definition or a parameter was written."""
    return library.sources.get(_key(declared), Source("", ""))


def _once(fresh: set[tuple[str, str]], kind: str, name: str, at: Position) -> None:
    if (kind, name) in fresh:
        raise TextError(f"{kind} '{name}' is given twice", at, "Remove or rename one of the two.")
    fresh.add((kind, name))
