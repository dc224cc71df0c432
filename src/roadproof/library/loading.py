"""Specification texts to a library: files read, statements put into their mappings, mistakes gathered."""

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
    is_within,
    key_of,
    on_request,
    read_specification,
    unknown,
)
from roadproof.logic import syntax
from roadproof.logic.grammar import version
from roadproof.logic.instances import instances
from roadproof.logic.parse import parse_bundled, parse_library
from roadproof.logic.recover import ParseResult, parse_pieces
from roadproof.runtime.cache import remembered
from roadproof.runtime.records import dataclass

Parse: TypeAlias = Callable[[str, str], tuple[syntax.Statement, ...]]


@cache
def bundled_library() -> Library:
    """The library that comes with roadproof (``library/sets/*.spec``), remembered from run to run."""
    files = sorted((Path(__file__).parent / "sets").glob("*.spec"))
    sources = [Source(f.name, f.read_text("utf-8")) for f in files]
    code = (Path(__file__).with_name(name).read_text("utf-8") for name in ("loading.py", "specification.py"))
    made_of = "\0".join((version(), *code, *(text for x in sources for text in (x.name, x.text))))
    return remembered("library", made_of.encode(), lambda: build_library(sources, parse=parse_library))


def load_library(files: Iterable[Path | Source] = ()) -> Library:
    """The bundled library, with the users' files or texts on top: their definitions replace or add."""
    extra = tuple(sources_of(files))
    return _library_with(extra) if extra else bundled_library()


@lru_cache(maxsize=8)
def _library_with(extra: tuple[Source, ...]) -> Library:
    """The bundled library with texts on top; kept, because a check asks for the same texts many times."""
    return replace(build_library(extra, bundled_library()), files=extra)


def sources_of(files: Iterable[Path | Source]) -> list[Source]:
    """Texts, read from files where they are none yet. Raises ``InputError``."""
    return [file if isinstance(file, Source) else read_specification(file) for file in files]


@cache
def _texts_on_request() -> dict[str, str]:
    """The names of the files that come with roadproof and are read where they are named, by text."""
    return {file.read_text("utf-8"): file.name for file in on_request().values()}


def _statements(text: str, name: str) -> tuple[syntax.Statement, ...]:
    """The statements of a text, those of roadproof's own files from the cache. Raises ``TextError``."""
    shipped = _texts_on_request().get(text)
    return parse_library(text, name) if shipped is None else parse_bundled(text, shipped)


def build_library(
    sources: Iterable[Source], below: Library | None = None, parse: Parse = _statements
) -> Library:
    """Put statements into their mappings, as ``parse`` reads them.

    Raises ``TextError`` for all that does not parse, is there twice, or names what does not exist.
    """
    gathered = gather({source: _parsed(source, parse) for source in sources}, below)
    raise_all(gathered.errors)
    return gathered.library


def _parsed(source: Source, parse: Parse = _statements) -> ParseResult:
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
    building, errors, lost = _Builder(below or Library()), list[TextError](), list[re.Pattern[str]]()
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
    def __init__(self, below: Library) -> None:
        self.parameters, self.options, self.sets = {**below.parameters}, {**below.options}, {**below.sets}
        self.definitions, self.variants = {**below.definitions}, {**below.variants}
        self.sources, self.signals = {**below.sources}, {**below.signals}
        self.lanes, self.titles = {**below.lanes}, {**below.titles}
        self.refused: list[str] = []

    def library(self) -> Library:
        return Library(**{name: table for name, table in vars(self).items() if name != "refused"})

    def add(self, statements: Iterable[syntax.Statement], source: Source) -> list[TextError]:
        """Add what a text says, and tell what of it cannot be added."""
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
                self.refused += _declares(statement)
        for block in blocks:
            try:
                self._override(block, fresh, source, errors)
            except TextError as error:
                errors.append(error.locate(source.name, source.text))
        return errors

    def _add(self, statement: syntax.Statement, fresh: set[tuple[str, str]], source: Source) -> None:
        match statement:
            case syntax.ParameterDeclaration():
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
                self.sources[key_of(statement)] = source
            case syntax.OptionDeclaration():
                _once(fresh, "option", statement.name, statement.at)
                self.options[statement.name] = statement
            case syntax.Definition():
                self._define(statement, fresh, source)
            case syntax.SignalDeclaration():
                self._declare(statement, fresh, source)
            case syntax.EachBlock():
                for definition in instances(statement):
                    self._define(definition, fresh, source)
            case syntax.SetBlock() | syntax.WhenBlock():
                raise AssertionError("blocks are added last")
            case syntax.LaneDeclaration():
                for number in statement.scenarios:
                    _once(fresh, "lane of scenario", str(number), statement.at)
                    self.lanes[number] = statement
            case syntax.TitleDeclaration():
                for number in statement.scenarios:
                    _once(fresh, "title of scenario", str(number), statement.at)
                    self.titles[number] = (statement, source)
            case _:
                assert_never(statement)

    def _define(self, definition: syntax.Definition, fresh: set[tuple[str, str]], source: Source) -> None:
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
        self.sources[key_of(definition)] = source

    def _declare(self, signal: syntax.SignalDeclaration, fresh: set[tuple[str, str]], source: Source) -> None:
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
                _once(inside, "definition", definition.name, definition.at)
                if definition.name not in self.definitions:
                    message = unknown("definition", definition.name, self.definitions)
                    raise TextError(f"an override needs something to replace: {message}", definition.at)
                self.sources[key_of(definition)] = source
            except TextError as error:
                errors.append(error.locate(source.name, source.text))
                self.refused += _declares(definition)
        if isinstance(block, syntax.SetBlock):
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


def _declares(statement: syntax.Statement) -> list[str]:
    declares = syntax.Definition | syntax.ParameterDeclaration | syntax.SignalDeclaration
    return [statement.name] if isinstance(statement, declares) else []


def _once(fresh: set[tuple[str, str]], kind: str, name: str, at: Position) -> None:
    if (kind, name) in fresh:
        raise TextError(f"{kind} '{name}' is given twice", at, "Remove or rename one of the two.")
    fresh.add((kind, name))
