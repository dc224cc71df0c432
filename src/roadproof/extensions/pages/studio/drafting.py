"""Turns definitions that are being written into specification files: a draft becomes a spec set on top of
another.

Definitions of the draft replace those of the set below, one by one or in ``each`` blocks. New ones are
declared for all sets, because a set can only replace. Statements that would silently change other sets
(``when``, options and sets of the library) are errors. All errors are reported, each with its place in the
draft.
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import field
from functools import lru_cache

from roadproof.errors import Position, RoadproofError, TextError, UsageError, raise_all
from roadproof.frontends.api.definitions import Definitions, chosen_in, values_of
from roadproof.library.diagnose import Lost, Proofreader, as_diagnostic, claim_errors
from roadproof.library.loading import load_library
from roadproof.library.scenario_references import read_query
from roadproof.library.specification import Library, Source, Specification
from roadproof.logic.instances import expand_each
from roadproof.logic.parse import parse_library
from roadproof.logic.syntax import EachBlock, WhenBlock
from roadproof.runtime.records import dataclass

EDIT, BEFORE = "edit", "before"
DRAFT, QUESTION, PARAMETERS = "definitions", "formula", "parameters"
_COMMENT = re.compile(r"#[^\n]*")
_WORDS = re.compile(
    r'"[^"\n]*"|#[^\n]*|[{}]|(?<![\w@])(def|param|signal|option|each|set|when|lane|title)\s+(\w+)'
)


@dataclass(frozen=True)
class Draft:
    """A ``text`` on top of the spec set ``base``; ``before`` is an earlier text, for a comparison."""

    base: str = "base"
    text: str = ""
    before: str | None = None
    options: Mapping[str, str] = field(default_factory=dict)
    params: Mapping[str, str] = field(default_factory=dict)

    @property
    def edited(self) -> str:
        """The set that the draft makes: ``edit``, or ``base`` for an empty draft."""
        return EDIT if _statements(self.text) else self.base

    def definitions(self, *sets: str) -> Definitions:
        """Return the definitions of some sets, by default of ``edited``; ``edit`` stands for ``edited``.

        Raises ``TextError`` for the first error, ``InputError``.
        """
        library = _library(self.base, self.text, self.before)
        if BEFORE in sets and (names := sorted(_conflicting_declarations(self.text, self.before or ""))):
            raise UsageError(
                f"{', '.join(names)}: is declared for all sets, and not alike before and after the edit, so "
                "the two cannot be compared; keep the present text as before, or give it another name"
            )
        chosen = tuple(self.edited if name == EDIT else name for name in sets or (EDIT,))
        return chosen_in(library, chosen, self.options, self.params)

    def file(self) -> str:
        """Return the draft as one specification file, which declares its sets. Raises ``TextError``."""
        sources = sources_of(self.base, self.text, self.before)
        return "\n".join(_without_blank_lines(x.text) for x in sources if x.text.strip())


@dataclass(frozen=True)
class Mistake:
    """An error: ``where`` is "definitions", "parameters", or the name of a formula."""

    where: str
    message: str
    position: Position | None = None
    hint: str = ""


def mistakes(draft: Draft, formulas: Mapping[str, str]) -> list[Mistake]:
    """Return all errors of a draft, then those of formulas, by the name of each.

    Consequences of an unreadable statement are not reported.
    """
    sources = sources_of(draft.base, draft.text, draft.before)
    errors, library, lost = _proofreader(draft.base).errors_in(*sources)
    errors = [*forbidden_statements(draft.text), *errors]
    every = dict.fromkeys(_mistake(error, DRAFT) for error in errors)
    ordered = sorted(
        every, key=lambda x: (0, 0) if x.position is None else (x.position.line, x.position.column)
    )
    try:
        home = library.select(draft.edited, draft.options)
    except RoadproofError as error:
        mistake = _mistake(error, DRAFT)
        return ordered if any(x.message in mistake.message for x in ordered) else [*ordered, mistake]
    try:
        values_of(library, draft.params)
    except RoadproofError as error:
        ordered.append(Mistake(PARAMETERS, str(error)))
    for name, formula in formulas.items():
        for wrong in _in_formula(home, formula, lost):
            mistake = _mistake(wrong, name)
            if mistake.where == name or not ordered:
                ordered.append(mistake)
    return ordered


@lru_cache(maxsize=16)
def _proofreader(base: str) -> Proofreader:
    """Return a proofreader for the set below; it caches the meaning of definitions in ``edit``."""
    return Proofreader(load_library())


def _in_formula(home: Specification, formula: str, lost: Lost) -> Sequence[RoadproofError]:
    """Return the errors of a formula, or of the number of a scenario."""
    try:
        read_query(home, formula, QUESTION)
    except TextError:
        return claim_errors(home, formula, QUESTION, lost)
    except RoadproofError as error:
        return [error]
    return []


def _mistake(error: RoadproofError, where: str) -> Mistake:
    """Return an error with its place in the draft, whichever part of the draft was read."""
    if not isinstance(error, TextError):
        return Mistake(where, str(error))
    if error.source not in (*_HEADED, DRAFT, QUESTION, ""):
        return Mistake(where, str(error))
    if error.position is None:
        return Mistake(where, error.message, None, error.hint)
    at, above = as_diagnostic(error, error.text), int(error.source in _HEADED)
    begin = (max(1, at.line - above), at.column)
    position = Position(*begin, max(1, at.end_line - above), at.end_column)
    return Mistake(where if error.source in (QUESTION, "") else DRAFT, at.message, position, at.hint)


def place_in(source: str, at: tuple[int, int]) -> tuple[str, tuple[int, int]] | None:
    """Return a place in a text as the user sees it: in "definitions" or "formula"; None for the library's
    texts.
    """
    if source == _source_name(EDIT):
        return DRAFT, (at[0] - 1, at[1])
    return (source, at) if source in (DRAFT, QUESTION) else None


# --- a draft as specification files -------------------------------------------------------------


def _source_name(set_name: str) -> str:
    return f"{DRAFT}, set {set_name}"


_HEADED = (_source_name(EDIT), _source_name(BEFORE))


@lru_cache(maxsize=16)
def _library(base: str, text: str, before: str | None) -> Library:
    raise_all(forbidden_statements(text))
    return load_library(sources_of(base, text, before))


def sources_of(base: str, text: str, before: str | None) -> list[Source]:
    """Return the specification files for a draft; ``edit`` is a set on top of ``base``.

    A set begins on a line of its own above the text, so lines in it are one further down.
    """
    known = {*load_library().definitions}
    declared = {_head(text, span)[:2] for span in _statements(text)}
    sources: list[Source] = []
    for name, written in ((EDIT, text), (BEFORE, before)):
        if written is None:
            continue
        shared, inside = list[tuple[int, int]](), list[tuple[int, int]]()
        for span in _statements(written):
            names = _defined_in(written, span)
            if names is not None and names <= known:
                inside.append(span)
            elif name == EDIT or names is not None or _head(written, span)[:2] not in declared:
                shared.append(span)
        known |= {x for span in shared for x in _defined_in(written, span) or ()}
        sources.append(Source(DRAFT, _blanked_outside(written, shared)))
        head = f"set {name} extends {base} {{\n"
        sources.append(Source(_source_name(name), f"{head}{_blanked_outside(written, inside)}\n}}\n"))
    return sources


def forbidden_statements(text: str) -> list[TextError]:
    """Return errors for statements that would change other sets than ``edit``."""
    library = load_library()
    there = library.definitions.keys()
    errors: list[TextError] = []
    for span in _statements(text):
        word, name, start = _head(text, span)
        names = _defined_in(text, span) or set()
        inner = (_names_in(text[start : span[1]]) or set()) if word == "when" else set[str]()
        if word == "option" and name in library.options:
            message = f"option {name} is the library's: it would change every set"
            hint = "Choose its value below Parameters and readings."
        elif word == "set" and name in (*library.sets, EDIT, BEFORE):
            message = f"there is a set {name} already, and it would be another one"
            hint = "Give it another name."
        elif replaced := sorted(inner & there):
            message = (
                f"what an option says holds in all sets: {replaced[0]} would be replaced below {EDIT} too"
            )
            hint = "Replace it by a definition with a name of its own, and let the option replace that one."
        elif names & there and names - there:
            new, known = sorted(names - there), sorted(names & there)
            message = f"a block either replaces or adds: {known[0]} is in the library, {new[0]} is not"
            hint = "Write two blocks."
        else:
            continue
        line = text.count("\n", 0, start) + 1
        at = Position(line, start - text.rfind("\n", 0, start))
        errors.append(TextError(message, at, hint).locate(DRAFT, text))
    return errors


def _conflicting_declarations(text: str, before: str) -> list[str]:
    """Return the names that both texts declare for all sets, but differently, such as ``param near``."""

    def declared(written: str) -> dict[str, str]:
        heads = {span: _head(written, span) for span in _statements(written)}
        return {
            f"{word} {name}": " ".join(_COMMENT.sub("", written[start : span[1]]).split())
            for span, (word, name, start) in heads.items()
            if word not in ("", "def", "each")
        }

    now, was = declared(text), declared(before)
    return [name for name in now.keys() & was.keys() if now[name] != was[name]]


def _statements(text: str) -> list[tuple[int, int]]:
    """Return the start and end of each statement; text before the first one belongs to it.

    A definition that is not closed ends where the next statement begins.
    """
    begins: list[int] = []
    is_block, depth = False, 0
    for token in _WORDS.finditer(text):
        if token[0] in ("{", "}"):
            depth = max(0, depth + (1 if token[0] == "{" else -1))
        elif token[1] is not None and _begins_statement(token) and not (is_block and depth):
            begins.append(token.start())
            is_block, depth = token[1] in ("each", "set", "when"), 0
    if not begins:
        return [(0, len(text))] if _says_something(text) else []
    return list(zip([0, *begins[1:]], [*begins[1:], len(text)], strict=True))


def _begins_statement(token: re.Match[str]) -> bool:
    return token[1] not in ("lane", "title") or token[2] == "of"


def _says_something(text: str) -> bool:
    """Return whether a text has more than space and comments."""
    return any(line.partition("#")[0].strip() for line in text.splitlines())


def _defined_in(text: str, span: tuple[int, int]) -> set[str] | None:
    """Return the names that a statement defines, several for an ``each`` block; None for other statements."""
    for token in _WORDS.finditer(text, *span):
        if token[1] == "def":
            return {token[2]}
        if token[1] == "each":
            return _names_in(text[token.start() : span[1]])
        if token[1] is not None:
            return None
    return None


def _head(text: str, span: tuple[int, int]) -> tuple[str, str, int]:
    """Return the first word of a statement, the name after it, and its position."""
    token = next((x for x in _WORDS.finditer(text, *span) if x[1] is not None), None)
    return ("", "", span[0]) if token is None else (token[1], token[2], token.start())


def _names_in(block: str) -> set[str] | None:
    """Return the names that an ``each`` or ``when`` block defines; None for an unreadable block."""
    try:
        read = parse_library(block, DRAFT)
    except TextError:
        return None
    blocks = (x for x in read if isinstance(x, EachBlock | WhenBlock))
    several = (expand_each(x) if isinstance(x, EachBlock) else x.definitions for x in blocks)
    return {definition.name for some in several for definition in some}


def _blanked_outside(text: str, spans: Sequence[tuple[int, int]]) -> str:
    """Return ``text`` with spaces instead of everything outside ``spans``, so that positions stay."""
    inside = [False] * len(text)
    for begin, end in spans:
        inside[begin:end] = [True] * (min(end, len(text)) - begin)
    return "".join(x if keep or x == "\n" else " " for x, keep in zip(text, inside, strict=True))


def _without_blank_lines(text: str) -> str:
    return "\n".join(line.rstrip() for line in text.splitlines() if line.strip())
