"""Loading of specification texts into a library: parse files, collect statements, gather all errors."""

import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from functools import cache, lru_cache
from pathlib import Path
from typing import TypeAlias, assert_never

from roadproof.errors import Position, TextError, raise_all
from roadproof.library.specification import (
    BUILT_IN,
    NOT_A_COLUMN,
    ROLE,
    Library,
    Source,
    key_of,
    on_request,
    read_specification,
    satisfies_bound,
    unknown_name,
)
from roadproof.logic import syntax
from roadproof.logic.grammar import version
from roadproof.logic.parse import ParseResult, parse_bundled, parse_library
from roadproof.runtime.cache import cached
from roadproof.runtime.records import dataclass

Parse: TypeAlias = Callable[[str, str], tuple[syntax.Statement, ...]]


@cache
def bundled_library() -> Library:
    """Return the library that comes with roadproof (``library/sets/*.spec``), from the cache on disk."""
    files = sorted((Path(__file__).parent / "sets").glob("*.spec"))
    sources = [Source(f.name, f.read_text("utf-8")) for f in files]
    code = (Path(__file__).with_name(name).read_text("utf-8") for name in ("loading.py", "specification.py"))
    made_of = "\0".join((version(), *code, *(text for x in sources for text in (x.name, x.text))))
    return cached("library", made_of.encode(), lambda: build_library(sources, parse=parse_library))


def load_library(files: Iterable[Path | Source] = ()) -> Library:
    """Return the bundled library with the users' files or texts on top: their definitions replace or add."""
    extra = tuple(sources_of(files))
    return _library_with(extra) if extra else bundled_library()


@lru_cache(maxsize=8)
def _library_with(extra: tuple[Source, ...]) -> Library:
    """Return the bundled library with texts on top; cached, as a check needs the same texts many times."""
    return replace(build_library(extra, bundled_library()), files=extra)


def sources_of(files: Iterable[Path | Source]) -> list[Source]:
    """Return texts as they are, and files as texts. Raises ``InputError``."""
    return [file if isinstance(file, Source) else read_specification(file) for file in files]


@cache
def _texts_on_request() -> dict[str, str]:
    """Return the names of the shipped files that are read when they are named, by text."""
    return {file.read_text("utf-8"): file.name for file in on_request().values()}


def _statements(text: str, name: str) -> tuple[syntax.Statement, ...]:
    """Return the statements of a text, from the cache for roadproof's own files. Raises ``TextError``."""
    shipped = _texts_on_request().get(text)
    return parse_library(text, name) if shipped is None else parse_bundled(text, shipped)


def build_library(
    sources: Iterable[Source], below: Library | None = None, parse: Parse = _statements
) -> Library:
    """Return the library of some texts, on top of ``below``; ``parse`` parses a text.

    Raises ``TextError`` for syntax errors and for names that are declared twice or unknown; ``TextErrors``
    for several mistakes.
    """
    gathered = gather({source: _parse(source, parse) for source in sources}, below)
    raise_all(gathered.errors)
    return gathered.library


def _parse(source: Source, parse: Parse = _statements) -> ParseResult:
    """Parse a text as a whole, which is quicker, and in pieces only if it has a mistake."""
    try:
        return ParseResult(parse(source.text, source.name))
    except TextError as error:
        from roadproof.logic.recover import parse_pieces  # here: for texts with mistakes alone

        pieces = parse_pieces(source.text, source.name)
        return pieces if pieces.errors else replace(pieces, errors=(error,))


@dataclass(frozen=True)
class GatheredLibrary:
    """The library of all statements that could be read, all errors in order, and patterns of lost names."""

    library: Library
    errors: tuple[TextError, ...] = ()
    lost: tuple[re.Pattern[str], ...] = ()


def gather(readings: Mapping[Source, ParseResult], below: Library | None = None) -> GatheredLibrary:
    """Collect the parsed statements of texts in a library."""
    building, errors, lost = _Builder(below or Library()), list[TextError](), list[re.Pattern[str]]()
    for source, parsed in readings.items():
        errors += sorted([*parsed.errors, *building.add(parsed.statements, source)], key=place_of)
        lost += parsed.lost
    lost += (re.compile(re.escape(name)) for name in building.refused)
    return GatheredLibrary(building.library(), tuple(errors), tuple(lost))


def gather_files(files: Iterable[Path | Source]) -> GatheredLibrary:
    """Return ``load_library`` together with all errors. Raises ``InputError`` if a file is no text."""
    extra = sources_of(files)
    if not extra:
        return GatheredLibrary(bundled_library())
    gathered = gather({source: _parse(source) for source in extra}, bundled_library())
    return replace(gathered, library=replace(gathered.library, files=tuple(extra)))


def place_of(error: TextError) -> tuple[int, int]:
    """Return line and column of an error, as a key to sort by."""
    return (0, 0) if error.position is None else (error.position.line, error.position.column)


class _Builder:
    def __init__(self, below: Library) -> None:
        self.parameters, self.options, self.sets = {**below.parameters}, {**below.options}, {**below.sets}
        self.definitions, self.variants = {**below.definitions}, {**below.variants}
        self.sources, self.signals = {**below.sources}, {**below.signals}
        self.lanes, self.titles = {**below.lanes}, {**below.titles}
        self.refused: list[str] = []

    def library(self) -> Library:
        return Library(**{name: table for name, table in vars(self).items() if name != "refused"})

    def add(self, statements: Iterable[syntax.Statement], source: Source) -> list[TextError]:
        """Add the statements of a text, and return the errors of those that cannot be added."""
        fresh: set[tuple[str, str]] = set()
        blocks: list[syntax.SetBlock | syntax.WhenBlock] = []
        errors: list[TextError] = []
        for statement in statements:
            if isinstance(statement, syntax.SetBlock | syntax.WhenBlock):
                blocks.append(statement)
                continue
            try:
                self._add(statement, fresh, source)
            except TextError as error:
                errors.append(error.locate(source.name, source.text))
                self.refused += _declared_names(statement)
        for block in blocks:
            try:
                self._override(block, fresh, source, errors)
            except TextError as error:
                errors.append(error.locate(source.name, source.text))
        return errors

    def _add(self, statement: syntax.Statement, fresh: set[tuple[str, str]], source: Source) -> None:
        match statement:
            case syntax.ParameterDeclaration():
                _refuse_repetition(fresh, "parameter", statement.name, statement.at)
                if not satisfies_bound(statement.bound, statement.value):
                    raise TextError(
                        f"{statement.name}={statement.value} {statement.unit}: it is declared with "
                        f"{statement.name} {statement.bound} 0",
                        statement.at,
                        "Give a value within the bound, or another bound.",
                    )
                if statement.name in self.signals:
                    raise TextError(f"'{statement.name}' is a signal already", statement.at)
                self.parameters[statement.name] = statement
                self.sources[key_of(statement)] = source
            case syntax.OptionDeclaration():
                _refuse_repetition(fresh, "option", statement.name, statement.at)
                self.options[statement.name] = statement
            case syntax.Definition():
                self._define(statement, fresh, source)
            case syntax.SignalDeclaration():
                self._declare(statement, fresh, source)
            case syntax.EachBlock():
                from roadproof.logic.instances import expand_each  # here: few texts have such blocks

                for definition in expand_each(statement):
                    self._define(definition, fresh, source)
            case syntax.SetBlock() | syntax.WhenBlock():
                raise AssertionError("blocks are added last")
            case syntax.LaneDeclaration():
                for number in statement.scenarios:
                    _refuse_repetition(fresh, "lane of scenario", str(number), statement.at)
                    self.lanes[number] = statement
            case syntax.TitleDeclaration():
                for number in statement.scenarios:
                    _refuse_repetition(fresh, "title of scenario", str(number), statement.at)
                    self.titles[number] = (statement, source)
            case _:
                assert_never(statement)

    def _define(self, definition: syntax.Definition, fresh: set[tuple[str, str]], source: Source) -> None:
        _refuse_repetition(fresh, "definition", definition.name, definition.at)
        if definition.name in BUILT_IN:
            raise TextError(f"'{definition.name}' is built in and cannot be defined", definition.at)
        if definition.name in self.signals:
            raise TextError(
                f"'{definition.name}' is a signal",
                definition.at,
                "Say what it is with signal … derived by ….",
            )
        self.definitions[definition.name] = definition
        self.sources[key_of(definition)] = source

    def _declare(self, signal: syntax.SignalDeclaration, fresh: set[tuple[str, str]], source: Source) -> None:
        """Add a custom signal; a derived one is also a definition, whose body must have its unit."""
        name, at = signal.name, signal.at
        _refuse_repetition(fresh, "signal", name, at)
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
        self.sources[key_of(signal)] = source
        if signal.body is not None:
            bindings = (syntax.Binding(signal.vehicle, "vehicle", at),) if signal.vehicle else ()
            self.definitions[name] = syntax.Definition(name, bindings, signal.doc, signal.body, at)

    def _override(
        self,
        block: syntax.SetBlock | syntax.WhenBlock,
        fresh: set[tuple[str, str]],
        source: Source,
        errors: list[TextError],
    ) -> None:
        inside: set[tuple[str, str]] = set()
        for definition in block.definitions:
            try:
                _refuse_repetition(inside, "definition", definition.name, definition.at)
                if definition.name not in self.definitions:
                    message = unknown_name("definition", definition.name, self.definitions)
                    raise TextError(f"an override needs something to replace: {message}", definition.at)
                self.sources[key_of(definition)] = source
            except TextError as error:
                errors.append(error.locate(source.name, source.text))
                self.refused += _declared_names(definition)
        if isinstance(block, syntax.SetBlock):
            _refuse_repetition(fresh, "set", block.name, block.at)
            if block.parent and block.parent not in self.sets:
                raise TextError(unknown_name("spec set", block.parent, self.sets), block.at)
            self.sets[block.name] = block
        else:
            if block.option not in self.options:
                raise TextError(unknown_name("option", block.option, self.options), block.at)
            if block.value not in self.options[block.option].values:
                message = unknown_name(
                    f"value of option {block.option}", block.value, self.options[block.option].values
                )
                raise TextError(message, block.at)
            key = (block.option, block.value)
            self.variants[key] = (*self.variants.get(key, ()), *block.definitions)


def _declared_names(statement: syntax.Statement) -> list[str]:
    declares = syntax.Definition | syntax.ParameterDeclaration | syntax.SignalDeclaration
    return [statement.name] if isinstance(statement, declares) else []


def _refuse_repetition(fresh: set[tuple[str, str]], kind: str, name: str, at: Position) -> None:
    if (kind, name) in fresh:
        raise TextError(f"{kind} '{name}' is given twice", at, "Remove or rename one of the two.")
    fresh.add((kind, name))
