"""Definitions as they are being written: a draft becomes a spec set on top of another one.

What a draft defines replaces definitions of the set below; what is new to the library is declared for all
sets, since a set can only replace. All mistakes are told, each with its place in the draft.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache

from roadproof.api.definitions import Definitions, values_of
from roadproof.errors import Position, RoadproofError, TextError
from roadproof.logic.parse import parse_library
from roadproof.spec.elaborate import signature
from roadproof.spec.library import Library, Source, Specification, load_library
from roadproof.spec.scenarios import read_query
from roadproof.spec.values import Number

EDIT, BEFORE = "edit", "before"
DRAFT, QUESTION, PARAMETERS = "definitions", "formula", "parameters"
_WORDS = re.compile(r'"[^"\n]*"|#[^\n]*|[{}]|(?<![\w@])(def|param|option|each|set|when|lane|title)\s+(\w+)')


@dataclass(frozen=True)
class Draft:
    """``text`` on top of the spec set ``base``; ``before`` is an earlier text, for a comparison."""

    base: str = "base"
    text: str = ""
    before: str | None = None
    options: Mapping[str, str] = field(default_factory=dict)
    params: Mapping[str, Number] = field(default_factory=dict)

    @property
    def edited(self) -> str:
        """The set that the draft makes: ``edit``, or the one below where it says nothing."""
        return EDIT if _statements(self.text) else self.base

    def definitions(self, *sets: str) -> Definitions:
        """What questions are asked of; the set is ``edited`` where none is named, and where it is ``edit``.

        Raises ``TextError`` for the first mistake, ``InputError``.
        """
        library = _library(self.base, self.text, self.before)
        chosen = tuple(self.edited if name == EDIT else name for name in sets or (EDIT,))
        for name in chosen:
            library.select(name, self.options)
        values = values_of(library, self.params)
        return Definitions(library.select(chosen[0], self.options), chosen, values)

    def file(self) -> str:
        """The draft as one specification file, which declares its sets. Raises ``TextError``."""
        sources = sources_of(self.base, self.text, self.before)
        return "\n".join(_without_blank_lines(x.text) for x in sources if x.text.strip())


@dataclass(frozen=True)
class Mistake:
    """Something wrong: ``where`` is "definitions", "parameters", or the name of a formula that is asked."""

    where: str
    message: str
    position: Position | None = None
    hint: str = ""


def mistakes(draft: Draft, formulas: Mapping[str, str]) -> list[Mistake]:
    """All mistakes of a draft that can be told apart, then those of formulas, by the name of each.

    A statement that cannot be read hides only itself: the others are read without it.
    """
    found: list[Mistake] = []
    kept: list[tuple[int, int]] = []
    for begin, end in _statements(draft.text):
        try:
            parse_library(_only(draft.text[:end].rstrip(), [(begin, end)]), DRAFT)
            kept.append((begin, end))
        except TextError as error:
            found.append(_mistake(error, DRAFT))
    readable = _only(draft.text, kept)
    try:
        home = Draft(draft.base, readable, draft.before, draft.options).definitions()
    except RoadproofError as error:
        return [*found, _mistake(error, DRAFT)]
    try:
        values_of(home.library, draft.params)
    except RoadproofError as error:
        found.append(Mistake(PARAMETERS, str(error)))
    found += _in_definitions(home.specification, readable)
    for name, formula in formulas.items():
        try:
            read_query(home.specification, formula, QUESTION)
        except RoadproofError as error:
            told = _mistake(error, name)
            if told.where == name or not found:
                found.append(told)
    return found


def _in_definitions(home: Specification, text: str) -> Iterator[Mistake]:
    told: set[tuple[str, Position | None]] = set()
    for name in _defined(text):
        if name not in home.definitions:
            continue
        try:
            signature(home, name)
        except TextError as error:
            mistake = _mistake(error, DRAFT)
            if (mistake.message, mistake.position) not in told:
                told.add((mistake.message, mistake.position))
                yield mistake


def _mistake(error: RoadproofError, where: str) -> Mistake:
    """What an error is told as; its place counts in the draft, whichever part of it was read."""
    if not isinstance(error, TextError):
        return Mistake(where, str(error))
    if error.source in _HEADED and error.position is not None:
        position = Position(max(1, error.position.line - 1), error.position.column)
        return Mistake(DRAFT, error.message, position, error.hint)
    if error.source == DRAFT:
        return Mistake(DRAFT, error.message, error.position, error.hint)
    if error.source in (QUESTION, ""):
        return Mistake(where, error.message, error.position, error.hint)
    return Mistake(where, str(error))


def place_in(source: str, at: tuple[int, int]) -> tuple[str, tuple[int, int]] | None:
    """A place in a text as the user sees it: in "definitions" or "formula"; None in the library's texts."""
    if source == _source_name(EDIT):
        return DRAFT, (at[0] - 1, at[1])
    return (source, at) if source in (DRAFT, QUESTION) else None


# --- a draft as specification files -------------------------------------------------------------


def _source_name(set_name: str) -> str:
    return f"{DRAFT}, set {set_name}"


_HEADED = (_source_name(EDIT), _source_name(BEFORE))


@lru_cache(maxsize=16)
def _library(base: str, text: str, before: str | None) -> Library:
    return load_library(sources_of(base, text, before))


def sources_of(base: str, text: str, before: str | None) -> list[Source]:
    """The specification files that a draft stands for; ``edit`` is a set on top of ``base``.

    A set begins on a line of its own above the text, so lines in it are one further down.
    """
    known = load_library().definitions
    sources: list[Source] = []
    shared: set[str] = set()
    for name, written in ((EDIT, text), (BEFORE, before)):
        if written is None:
            continue
        declared = [
            span
            for span in _statements(written)
            if (defined := _defined_in(written, span)) is None
            or (defined not in known and defined not in shared)
        ]
        if name == BEFORE:
            declared = [span for span in declared if _defined_in(written, span) is not None]
        shared |= {x for span in declared if (x := _defined_in(written, span)) is not None}
        sources.append(Source(DRAFT, _only(written, declared)))
        inside = [span for span in _statements(written) if _defined_in(written, span) is not None]
        head = f"set {name} extends {base} {{\n"
        sources.append(Source(_source_name(name), f"{head}{_only(written, inside)}\n}}\n"))
    return sources


def _statements(text: str) -> list[tuple[int, int]]:
    """Where each statement begins and ends; what stands before the first one belongs to it.

    A definition that is not closed ends where the next statement begins.
    """
    begins: list[int] = []
    is_block, depth = False, 0
    for found in _WORDS.finditer(text):
        if found[0] in ("{", "}"):
            depth = max(0, depth + (1 if found[0] == "{" else -1))
        elif found[1] is not None and _begins(found) and not (is_block and depth):
            begins.append(found.start())
            is_block, depth = found[1] in ("each", "set", "when"), 0
    if not begins:
        return [(0, len(text))] if _says_something(text) else []
    return list(zip([0, *begins[1:]], [*begins[1:], len(text)], strict=True))


def _begins(found: re.Match[str]) -> bool:
    return found[1] not in ("lane", "title") or found[2] == "of"


def _says_something(text: str) -> bool:
    """Whether there is more than space and comments."""
    return any(line.partition("#")[0].strip() for line in text.splitlines())


def _defined_in(text: str, span: tuple[int, int]) -> str | None:
    """The name that a statement defines, None where it is another one."""
    for found in _WORDS.finditer(text, *span):
        if found[1] is not None:
            return found[2] if found[1] == "def" else None
    return None


def _defined(text: str) -> list[str]:
    return [name for span in _statements(text) if (name := _defined_in(text, span)) is not None]


def _only(text: str, spans: Sequence[tuple[int, int]]) -> str:
    """``text`` with spaces in place of all that is in none of ``spans``, so that places stay."""
    inside = [False] * len(text)
    for begin, end in spans:
        inside[begin:end] = [True] * (min(end, len(text)) - begin)
    return "".join(x if keep or x == "\n" else " " for x, keep in zip(text, inside, strict=True))


def _without_blank_lines(text: str) -> str:
    return "\n".join(line.rstrip() for line in text.splitlines() if line.strip())
