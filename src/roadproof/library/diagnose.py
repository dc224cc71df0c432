"""Diagnosis of specification texts and formulas: all syntax errors and all errors of meaning at once.

An error in a definition that others use is reported once. Names whose declarations do not parse cause no
further errors.
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
from roadproof.library.elaborate import claim_errors_in
from roadproof.library.elaboration import Elaborator
from roadproof.library.loading import gather, gather_files, load_library, place_of, sources_of
from roadproof.library.notes import ElaborationCache, UnreadableNameError
from roadproof.library.quantity import Quantity, dimension_of
from roadproof.library.scopes import Value, Vehicles
from roadproof.library.specification import Library, Source, Specification, source_of
from roadproof.logic import syntax
from roadproof.logic import terms as t
from roadproof.logic.parse import parse_claim
from roadproof.logic.syntax import Definition, ParameterDeclaration
from roadproof.runtime.records import dataclass

Severity: TypeAlias = Literal["error", "info"]
Lost: TypeAlias = tuple[re.Pattern[str], ...]
_WORD = re.compile(r"[A-Za-z_]\w*(@\w+)?|\d+(\.\d+)?([eE][+-]?\d+)?|:=|<->|->|[<>!]=|\S")
MOST_VEHICLES = 3


@dataclass(frozen=True)
class Diagnostic:
    """A message about a text from ``line`` and ``column`` up to, but without, the end; all count from 1."""

    line: int
    column: int
    end_line: int
    end_column: int
    message: str
    hint: str = ""
    severity: Severity = "error"


@dataclass(frozen=True)
class Diagnosis:
    """The diagnostics of a text, in its order, and the ``library`` of the statements that could be read.

    ``lost``: patterns of names whose declarations could not be read; pass them to ``claim_errors``.
    """

    diagnostics: tuple[Diagnostic, ...]
    library: Library
    lost: Lost = ()


@dataclass
class Proofreader:
    """A checker of successive versions of texts on top of the library ``below``, for editors.

    It caches the definitions of ``below`` that a text does not affect, and the parsed statements of texts, so
    that a change of one statement takes about the time of that statement. If a text declares a spec set, all
    versions must extend the same parent.
    """

    below: Library
    known: dict[str, ElaborationCache] = field(default_factory=dict)

    @cached_property
    def mentions(self) -> dict[str, set[str]]:
        """The definitions that use a name directly, in any set, by that name."""
        users: dict[str, set[str]] = {}
        variants = (x for block in self.below.variants.values() for x in block)
        blocks = (x for block in self.below.sets.values() for x in block.definitions)
        for definition in (*self.below.definitions.values(), *blocks, *variants):
            for part in syntax.walk(definition.body):
                if isinstance(part, syntax.Call | syntax.Name):
                    users.setdefault(part.name.partition("@")[0], set()).add(definition.name)
        return users

    def read(self, text: str, name: str = "text") -> Diagnosis:
        """Return the diagnosis of a specification text. Never raises for its content."""
        source = Source(name, text)
        errors, library, lost = self.errors_in(source)
        diagnostics = [as_diagnostic(error, text) for error in errors if error.source == name]
        replaced = [x for x in library.definitions.values() if source_of(library, x) == source]
        diagnostics += [_replaces(x, text) for x in replaced if x.name in self.below.definitions]
        return Diagnosis(tuple(sorted(diagnostics, key=lambda x: (x.line, x.column))), library, lost)

    def errors_in(self, *sources: Source) -> tuple[list[TextError], Library, Lost]:
        """Return the errors in texts that belong together, the library of what was read, and lost names."""
        from roadproof.logic.recover import parse_pieces  # here: for texts with mistakes alone

        parsed = {source: parse_pieces(source.text, source.name) for source in sources}
        gathered = gather(parsed, self.below)
        library = replace(gathered.library, files=(*self.below.files, *sources))
        statements = (x for result in parsed.values() for x in result.statements)
        declared = {x.name for x in statements if isinstance(x, Definition | ParameterDeclaration)}
        homes = _in_force(library, sources)
        changed = self._affected_by(declared | {x.name for _, definitions in homes for x in definitions})
        errors = list(gathered.errors)
        for specification, definitions in homes:
            key = repr((specification.set_name, sorted(specification.options.items())))
            cached = self.known.setdefault(key, {})
            untouched = {x: entry for x, entry in cached.items() if x[0] not in changed}
            walk = Elaborator(specification, known=untouched, lost=gathered.lost)
            errors += _errors_in_all(walk, definitions)
            if not (gathered.errors or errors):
                cached |= {x: entry for x, entry in walk.known.items() if x[0] not in changed}
        return once_each(errors), library, gathered.lost

    def _affected_by(self, changed: set[str]) -> set[str]:
        """Return the names whose meaning depends on ``changed`` ones."""
        reached, waiting = set(changed), list(changed)
        while waiting:
            more = self.mentions.get(waiting.pop(), set()) - reached
            reached |= more
            waiting += more
        return reached


def diagnose(text: str, below: Library, name: str = "text") -> Diagnosis:
    """Return the diagnosis of a specification text on top of a library. Never raises for its content."""
    return Proofreader(below).read(text, name)


def diagnose_claim(text: str, specification: Specification) -> tuple[Diagnostic, ...]:
    """Return the diagnostics of a formula in a specification. Never raises for its content."""
    return tuple(as_diagnostic(error, text) for error in claim_errors(specification, text))


def claim_errors(
    specification: Specification, text: str, source: str = "claim", lost: Lost = ()
) -> list[TextError]:
    """Return all errors in a formula, in its order."""
    try:
        claim = parse_claim(text, source)
    except TextError as error:
        return [error]
    return claim_errors_in(specification, claim, source, text, lost)


def checked_library(files: Iterable[Path | Source] = ()) -> Library:
    """Return the bundled library with the users' files on top, after elaborating every definition in them.

    Raises ``TextError``, ``TextErrors`` for several mistakes, ``InputError`` if a file cannot be read.
    """
    return _checked(tuple(sources_of(files)))


# The studio and scripts use the same texts for many questions.
@lru_cache(maxsize=16)
def _checked(sources: tuple[Source, ...]) -> Library:
    gathered = gather_files(sources)
    library = gathered.library
    order = [source.name for source in library.files]
    errors = once_each([*gathered.errors, *definition_errors(library, library.files, gathered.lost)])
    raise_all(sorted(errors, key=lambda x: (x.source in order and order.index(x.source), place_of(x))))
    return load_library(sources)


def definition_errors(library: Library, sources: Sequence[Source], lost: Lost = ()) -> list[TextError]:
    """Return the errors in the definitions of some texts, each elaborated in its own spec set or option."""
    walks = ((Elaborator(x, lost=lost), definitions) for x, definitions in _in_force(library, sources))
    return [error for walk, definitions in walks for error in _errors_in_all(walk, definitions)]


def _errors_in_all(walk: Elaborator, definitions: Iterable[Definition]) -> list[TextError]:
    return [error for definition in definitions for error in _errors_in(walk, definition)]


def _in_force(library: Library, sources: Sequence[Source]) -> list[tuple[Specification, list[Definition]]]:
    """Return the definitions of texts, each list with a specification in which it is in force."""

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
    """Return the errors in one definition, for the best of 1 to ``MOST_VEHICLES`` vehicles in a group.

    Errors that depend on the numbers of its arguments are left out.
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
    attempts = [_errors_with(walk, definition, 1)]
    while grouped and attempts[-1] and len(attempts) < MOST_VEHICLES:
        attempts.append(_errors_with(walk, definition, len(attempts) + 1))
    fewest = min(attempts, key=len)
    if all(binding.sort in scopes.SORTS for binding in definition.parameters):
        return fewest
    return [error for error in fewest if not isinstance(error, ValueOfTermError)]


def _errors_with(walk: Elaborator, definition: Definition, size: int) -> list[TextError]:
    scope: dict[str, Value] = {}
    for binding in definition.parameters:
        names = (binding.name,) if size == 1 else tuple(f"{binding.name}{k + 1}" for k in range(size))
        if binding.sort in scopes.SORTS:
            scope[binding.name] = Vehicles(names) if binding.sort == "vehicles" else scopes.value_of(binding)
        else:
            dimension = dimension_of(binding.sort)
            scope[binding.name] = Quantity(t.number(1, dimension), dimension)
    errors: list[TextError] = []
    inner = replace(walk.for_next_claim(), errors=errors, lost=walk.lost)
    try:
        inner.body_of(definition.name, scope)
    except TextError as error:
        errors += [] if isinstance(error, UnreadableNameError) else [error]
    return errors


def as_diagnostic(error: TextError, text: str) -> Diagnostic:
    """Return an error as a diagnostic of the text; without an end, it covers the word at its position."""
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
    diagnostic = as_diagnostic(TextError(message, definition.at), text)
    return replace(diagnostic, severity="info")
