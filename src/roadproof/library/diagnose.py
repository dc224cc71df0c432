"""All that is wrong with a text at once: what does not parse, and what means nothing in its definitions.

An error in a definition that others use is told once, and nothing follows from what could not be read.
"""

import re
from collections.abc import Iterable, Sequence
from dataclasses import field, replace
from functools import cached_property, lru_cache
from pathlib import Path
from typing import Literal, TypeAlias

from roadproof.errors import TextError, once_each, raise_all
from roadproof.library import scopes
from roadproof.library.arithmetic import ValueOfTermError
from roadproof.library.elaborate import mistakes_in
from roadproof.library.elaboration import Elaborator
from roadproof.library.loading import gather, gather_files, load_library, place_of, sources_of
from roadproof.library.notes import Known, LostError
from roadproof.library.quantity import Quantity
from roadproof.library.scopes import Value, Vehicles
from roadproof.library.specification import Library, Source, Specification, source_of
from roadproof.logic import syntax
from roadproof.logic import terms as t
from roadproof.logic.parse import parse_claim
from roadproof.logic.recover import parse_pieces
from roadproof.logic.syntax import Definition, ParameterDeclaration
from roadproof.runtime.records import dataclass
from roadproof.world.units import UNITS

Severity: TypeAlias = Literal["error", "info"]
Lost: TypeAlias = tuple[re.Pattern[str], ...]
_WORD = re.compile(r"[A-Za-z_]\w*(@\w+)?|\d+(\.\d+)?([eE][+-]?\d+)?|:=|<->|->|[<>!]=|\S")
MOST_VEHICLES = 3


@dataclass(frozen=True)
class Diagnostic:
    """A remark about a text from ``line`` and ``column`` up to, and without, the end; all count from 1."""

    line: int
    column: int
    end_line: int
    end_column: int
    message: str
    hint: str = ""
    severity: Severity = "error"


@dataclass(frozen=True)
class Diagnosis:
    """What is said of a text, in its order, and ``library``: what could be read of it on top of another.

    ``lost``: how names look that could not be read, of which ``claim_errors`` need not speak.
    """

    diagnostics: tuple[Diagnostic, ...]
    library: Library
    lost: Lost = ()


@dataclass
class Proofreader:
    """Says what is wrong with texts on top of the library ``below``, one after the other, as editors ask it.

    What definitions below mean that a text does not touch is kept from one text to the next, and so is what
    was read of the statements of a text: a change to one statement takes about the time of that statement.
    What a text calls a set of its own has to extend the same set in each of them.
    """

    below: Library
    known: dict[str, Known] = field(default_factory=dict)

    @cached_property
    def mentions(self) -> dict[str, set[str]]:
        """The names of the definitions that use a name themselves, in any set."""
        found: dict[str, set[str]] = {}
        variants = (x for block in self.below.variants.values() for x in block)
        blocks = (x for block in self.below.sets.values() for x in block.definitions)
        for definition in (*self.below.definitions.values(), *blocks, *variants):
            for part in syntax.walk(definition.body):
                if isinstance(part, syntax.Call | syntax.Name):
                    found.setdefault(part.name.partition("@")[0], set()).add(definition.name)
        return found

    def read(self, text: str, name: str = "text") -> Diagnosis:
        """What is wrong with a specification text. Never raises for what is in it."""
        source = Source(name, text)
        errors, library, lost = self.errors_in(source)
        found = [as_diagnostic(error, text) for error in errors if error.source == name]
        replaced = [x for x in library.definitions.values() if source_of(library, x) == source]
        found += [_replaces(x, text) for x in replaced if x.name in self.below.definitions]
        return Diagnosis(tuple(sorted(found, key=lambda x: (x.line, x.column))), library, lost)

    def errors_in(self, *sources: Source) -> tuple[list[TextError], Library, Lost]:
        """What is wrong with texts that belong together; what could be read of them, and what is lost."""
        parsed = {source: parse_pieces(source.text, source.name) for source in sources}
        gathered = gather(parsed, self.below)
        library = replace(gathered.library, files=(*self.below.files, *sources))
        said = (x for one in parsed.values() for x in one.statements)
        told = {x.name for x in said if isinstance(x, Definition | ParameterDeclaration)}
        homes = _homes(library, sources)
        changed = self._reached(told | {x.name for _, definitions in homes for x in definitions})
        errors = list(gathered.errors)
        for specification, definitions in homes:
            key = repr((specification.set_name, sorted(specification.options.items())))
            kept = self.known.setdefault(key, {})
            untouched = {x: made for x, made in kept.items() if x[0] not in changed}
            walk = Elaborator(specification, known=untouched, lost=gathered.lost)
            errors += _errors_in_all(walk, definitions)
            if not (gathered.errors or errors):
                kept |= {x: made for x, made in walk.known.items() if x[0] not in changed}
        return once_each(errors), library, gathered.lost

    def _reached(self, changed: set[str]) -> set[str]:
        """Names that mean something else where ``changed`` ones do."""
        reached, waiting = set(changed), list(changed)
        while waiting:
            more = self.mentions.get(waiting.pop(), set()) - reached
            reached |= more
            waiting += more
        return reached


def diagnose(text: str, below: Library, name: str = "text") -> Diagnosis:
    """What is wrong with a specification text on top of a library. Never raises for what is in the text."""
    return Proofreader(below).read(text, name)


def diagnose_claim(text: str, specification: Specification) -> tuple[Diagnostic, ...]:
    """What is wrong with a formula in the definitions of a specification. Never raises for what is in it."""
    return tuple(as_diagnostic(error, text) for error in claim_errors(specification, text))


def claim_errors(
    specification: Specification, text: str, source: str = "claim", lost: Lost = ()
) -> list[TextError]:
    """All that is wrong with a formula, in its order."""
    try:
        claim = parse_claim(text, source)
    except TextError as error:
        return [error]
    return mistakes_in(specification, claim, source, text, lost)


def checked_library(files: Iterable[Path | Source] = ()) -> Library:
    """The bundled library with the users' files on top, every definition in them read.

    Raises ``TextError`` for all mistakes at once, ``InputError`` where a file cannot be read.
    """
    return _checked(tuple(sources_of(files)))


# The studio and scripts ask many questions of the same texts.
@lru_cache(maxsize=16)
def _checked(sources: tuple[Source, ...]) -> Library:
    gathered = gather_files(sources)
    library = gathered.library
    order = [source.name for source in library.files]
    errors = once_each([*gathered.errors, *definition_errors(library, library.files, gathered.lost)])
    raise_all(sorted(errors, key=lambda x: (x.source in order and order.index(x.source), place_of(x))))
    return load_library(sources)


def definition_errors(library: Library, sources: Sequence[Source], lost: Lost = ()) -> list[TextError]:
    """What means nothing in the definitions of some texts, each read in the set or option that it is of."""
    walks = ((Elaborator(x, lost=lost), definitions) for x, definitions in _homes(library, sources))
    return [error for walk, definitions in walks for error in _errors_in_all(walk, definitions)]


def _errors_in_all(walk: Elaborator, definitions: Iterable[Definition]) -> list[TextError]:
    return [error for definition in definitions for error in _errors_in(walk, definition)]


def _homes(library: Library, sources: Sequence[Source]) -> list[tuple[Specification, list[Definition]]]:
    """The definitions that texts make, each beside a specification in which it is in force."""

    def own(definitions: Iterable[Definition]) -> list[Definition]:
        return [x for x in definitions if source_of(library, x) in sources]

    base, common = library.select(), own(library.definitions.values())
    homes = [(replace(base, definitions={**base.definitions, **{x.name: x for x in common}}), common)]
    for name, block in library.sets.items():
        mine = [x for x in own(block.definitions) if x.name in library.definitions]
        if mine:
            homes.append((library.select(name), mine))
    for (option, value), definitions in library.variants.items():
        mine = own(definitions)
        if mine:
            homes.append((library.select(options={option: value}), mine))
    return homes


def _errors_in(walk: Elaborator, definition: Definition) -> list[TextError]:
    """The mistakes in one definition; a group of vehicles may have to have more than one member.

    What depends on the numbers that it is applied to is no mistake of it.
    """
    source = source_of(walk.specification.library, definition)
    wrong: list[TextError] = []
    for binding in definition.parameters:
        try:
            scopes.check_sort(binding)
        except TextError as error:
            wrong.append(error.locate(source.name, source.text))
    if wrong:
        return wrong
    grouped = any(binding.sort == "vehicles" for binding in definition.parameters)
    tried = [_errors_with(walk, definition, 1)]
    while grouped and tried[-1] and len(tried) < MOST_VEHICLES:
        tried.append(_errors_with(walk, definition, len(tried) + 1))
    found = min(tried, key=len)
    if all(binding.sort in scopes.SORTS for binding in definition.parameters):
        return found
    return [error for error in found if not isinstance(error, ValueOfTermError)]


def _errors_with(walk: Elaborator, definition: Definition, size: int) -> list[TextError]:
    scope: dict[str, Value] = {}
    for binding in definition.parameters:
        names = (binding.name,) if size == 1 else tuple(f"{binding.name}{k + 1}" for k in range(size))
        if binding.sort in scopes.SORTS:
            scope[binding.name] = Vehicles(names) if binding.sort == "vehicles" else scopes.value_of(binding)
        else:
            dimension = UNITS[binding.sort][1]
            scope[binding.name] = Quantity(t.number(1, dimension), dimension)
    errors: list[TextError] = []
    inner = replace(walk.again(), errors=errors, lost=walk.lost)
    try:
        inner.body_of(definition.name, scope)
    except TextError as error:
        errors += [] if isinstance(error, LostError) else [error]
    return errors


def as_diagnostic(error: TextError, text: str) -> Diagnostic:
    """An error as a remark about the text that it is in; without an end it is about the word there."""
    lines = text.splitlines() or [""]
    line, column = (1, 1) if error.position is None else (error.position.line, error.position.column)
    line = min(line, len(lines))
    column = min(column, len(lines[line - 1]) + 1)
    at = error.position
    if at is not None and (at.line, at.column) < (at.end_line, at.end_column):
        return Diagnostic(line, column, at.end_line, at.end_column, error.message, error.hint)
    word = _WORD.match(lines[line - 1], column - 1)
    end = column + 1 if word is None else word.end() + 1
    return Diagnostic(line, column, line, end, error.message, error.hint)


def _replaces(definition: Definition, text: str) -> Diagnostic:
    message = f"it replaces the definition of '{definition.name}' below, wherever that is used"
    made = as_diagnostic(TextError(message, definition.at), text)
    return replace(made, severity="info")
