"""Text to syntax tree. User text reaches nothing but this grammar: no eval, no sympify."""

import io
import re
import sys
from functools import cache, lru_cache
from importlib import resources
from pathlib import Path
from typing import cast

import lark
from lark import Lark
from lark.exceptions import UnexpectedCharacters, UnexpectedEOF, UnexpectedInput, UnexpectedToken, VisitError

from roadproof.errors import Position, TextError
from roadproof.logic import syntax
from roadproof.logic.build_syntax import SyntaxBuilder, short_token
from roadproof.logic.syntax import Expression, Statement
from roadproof.runtime.cache import remembered
from roadproof.world.units import UNITS

_PAST = "Formulas speak of now and later: say what holds first, and what follows with F, G or U."
_SIGNS = {
    "<=>": "Write <->.",
    "<==>": "Write <->.",
    "<-->": "Write <->.",
    "==>": "Write ->.",
    "=>": "Write -> for what follows, >= for at least.",
    "-->": "Write ->.",
    "=<": "Write <=.",
    "==": "Write =.",
    "<>": "Write F for at some time, != for not equal.",
    "[]": "Write G.",
    "&&": "Write and.",
    "&": "Write and.",
    "/\\": "Write and.",
    "||": "Write or.",
    "|": "Write or.",
    "\\/": "Write or.",
    "!": "Write not.",
    "~": "Write not.",
    "∧": "Write and.",
    "∨": "Write or.",
    "¬": "Write not.",
    "⇒": "Write ->.",
    "→": "Write ->.",
    "⇔": "Write <->.",
    "↔": "Write <->.",
    "≤": "Write <=.",
    "≥": "Write >=.",
    "≠": "Write !=.",
    "□": "Write G.",
    "◇": "Write F.",
    "∀": "Write every x in D: p.",
    "∃": "Write some x in D: p.",
    "∞": "Write inf.",
    "·": "Write *.",
    "×": "Write *.",
    "**": "Write ^.",
}
_WORDS = {
    "AND": "Write and.",
    "OR": "Write or.",
    "NOT": "Write not.",
    "forall": "Write every x in D: p.",
    "all": "Write every x in D: p.",
    "exists": "Write some x in D: p.",
    "exist": "Write some x in D: p.",
    "always": "Write G.",
    "globally": "Write G.",
    "historically": _PAST,
    "H": _PAST,
    "eventually": "Write F.",
    "finally": "Write F.",
    "until": "Write U.",
    "once": _PAST,
    "previously": _PAST,
    "since": _PAST,
    "P": _PAST,
    "O": _PAST,
    "Y": _PAST,
    "S": _PAST,
    "X": "Time is dense and has no next instant: write F[a, b] with a time.",
    "next": "Time is dense and has no next instant: write F[a, b] with a time.",
    "W": "Write (p U q) or G p.",
    "R": "Write not (not p U not q).",
    "implies": "Write ->.",
    "iff": "Write <->.",
    "xor": "Write not (p <-> q).",
    "True": "Write true.",
    "TRUE": "Write true.",
    "False": "Write false.",
    "FALSE": "Write false.",
    "infinity": "Write inf.",
}
# F[] and != are meant as they stand, or nearly so.
_SIGN = re.compile(
    "|".join(
        ("(?<![FGU])" if sign == "[]" else "") + re.escape(sign) + ("(?!=)" if sign == "!" else "")
        for sign in sorted(_SIGNS, key=len, reverse=True)
    )
)
_WORD = re.compile(rf"(?<![A-Za-z0-9_@])(?:{'|'.join(_WORDS)})(?![A-Za-z0-9_@])")
_NEAR = 200  # characters around a mistake that are looked at


def find_foreign(text: str, mistake: int) -> tuple[int, str, str] | None:
    """What stands at or just before the character at which reading stopped, if other languages have it.

    Where it begins in ``text``, the sign or word, and what to write instead.
    """
    first = max(0, mistake - _NEAR)
    near = text[first : mistake + _NEAR]
    for found in _SIGN.finditer(near):
        if first + found.start() <= mistake < first + found.end():
            return first + found.start(), found[0], _SIGNS[found[0]]
    for found in _WORD.finditer(near):
        begin, end = first + found.start(), first + found.end()
        if begin <= mistake and not text[end:mistake].strip() and not _is_name(found[0], near):
            return begin, found[0], _WORDS[found[0]]
    return None


def _is_name(word: str, text: str) -> bool:
    """Whether a text uses a word as the name of something."""
    return re.search(rf"\b{word}\s*[:,)]|\b(some|every)\s+{word}\b", text) is not None


def instead_of(word: str) -> str:
    """What to write instead of a word that other languages have; empty where none has."""
    return _WORDS.get(word, "")


DEEPEST_NESTING = 100
LONGEST_CLAIM = 100_000
_PARENTHESES = re.compile(r'[()\[\]{}]|"[^"\n]*"|#[^\n]*')


def parse_library(text: str, source: str) -> tuple[Statement, ...]:
    """The statements of a specification file. Raises ``TextError``."""
    statements = cast(tuple[Statement, ...], _parse(text, source, "library"))
    for definition in _definitions(statements):
        _check_depth(definition.body, definition.at, source, text)
    return statements


def parse_bundled(text: str, source: str) -> tuple[Statement, ...]:
    """As ``parse_library``, for text that is parsed in every run: its tree is remembered from run to run."""
    made_of = "\0".join((source, text, _version())).encode()
    return remembered("tree", made_of, lambda: parse_library(text, source))


@lru_cache(maxsize=256)
def parse_claim(text: str, source: str = "claim") -> syntax.Claim:
    """A formula, with an optional ``given a, b: vehicle; L: lane:`` in front. Raises ``TextError``."""
    if len(text) > LONGEST_CLAIM:
        raise TextError(
            f"the formula is too long: {len(text)} characters, at most {LONGEST_CLAIM} are allowed",
            None,
            "Give its parts names with def.",
        ).locate(source, text)
    claim = cast(syntax.Claim, _parse(text, source, "claim"))
    _check_depth(claim.body, Position(1, 1), source, text)
    return claim


def _definitions(statements: tuple[Statement, ...]) -> list[syntax.Definition]:
    found: list[syntax.Definition] = []
    for statement in statements:
        match statement:
            case syntax.Definition():
                found.append(statement)
            case syntax.SignalDeclaration() if statement.body is not None:
                found.append(syntax.Definition(statement.name, (), "", statement.body, statement.at))
            case syntax.EachBlock() | syntax.SetBlock() | syntax.WhenBlock():
                found += statement.definitions
            case _:
                pass
    return found


def _check_parentheses(text: str) -> None:
    """Refuse text with parentheses deeper than trees may be; those in strings and comments do not count."""
    depth = 0
    for found in _PARENTHESES.finditer(text):
        if found[0] in "([{":
            depth += 1
        elif found[0] in ")]}":
            depth -= 1
        if depth > DEEPEST_NESTING:
            before = text[: found.start()]
            raise TextError(
                f"parentheses are nested too deep: at most {DEEPEST_NESTING} are allowed",
                Position(before.count("\n") + 1, found.start() - before.rfind("\n")),
                "Give the parts of the formula names with def.",
            )


def _check_depth(body: Expression, at: Position, source: str, text: str) -> None:
    deep = syntax.depth(body)
    if deep > DEEPEST_NESTING:
        raise TextError(
            f"the formula is nested too deep: depth={deep}, at most {DEEPEST_NESTING} is allowed",
            at,
            "Give its parts names with def.",
        ).locate(source, text)


@cache
def _grammar() -> str:
    grammar = resources.files("roadproof.logic").joinpath("grammar.lark").read_text("utf-8")
    longest_first = sorted(UNITS, key=len, reverse=True)
    return grammar.replace("%UNITS%", "|".join(re.escape(x).replace("/", r"\/") for x in longest_first))


@cache
def _version() -> str:
    """All that trees depend on besides the text: grammar, the source of what makes them, lark, Python."""
    here = Path(__file__).parent
    others = (here.parent / name for name in ("errors.py", "world/signals.py", "world/units.py"))
    sources = (path.read_text("utf-8") for path in sorted((*here.glob("*.py"), *others)))
    return "\0".join((_grammar(), *sources, lark.__version__, sys.version))


@cache
def _parser() -> Lark:
    def tables() -> bytes:
        made = io.BytesIO()
        Lark(
            _grammar(),
            start=["library", "claim"],
            parser="lalr",
            propagate_positions=True,
            maybe_placeholders=True,
        ).save(made)
        return made.getvalue()

    return Lark.load(io.BytesIO(remembered("grammar", _version().encode(), tables)))


def _parse(text: str, source: str, start: str) -> object:
    try:
        _check_parentheses(text)
        return SyntaxBuilder().transform(_parser().parse(text, start=start))
    except UnexpectedInput as error:
        raise _explain(error, text).locate(source, text) from None
    except VisitError as error:
        if isinstance(error.orig_exc, TextError):
            raise error.orig_exc.locate(source, text) from None
        raise
    except TextError as error:
        raise error.locate(source, text) from None


_READABLE = {
    "NAME": "a name",
    "INDEXED": "a name",
    "QUALIFIED": "a name",
    "NUMBER": "a number",
    "UNIT": f"a unit ({', '.join(UNITS)})",
    "STRING": 'a "text"',
    "LPAR": "(",
    "RPAR": ")",
    "LSQB": "[",
    "RSQB": "]",
    "LBRACE": "{",
    "RBRACE": "}",
    "COMMA": ",",
    "COLON": ":",
    "SEMICOLON": ";",
    "VBAR": "|",
    "EQUAL": "=",
    "CIRCUMFLEX": "^",
    "COMPARISON": "a comparison (<, <=, >, >=, =, !=)",
    "PLUS": "+",
    "MINUS": "-",
    "TIMES": "*",
    "DIVIDE": "/",
    "INFINITY": "inf",
    "$END": "the end",
    "__ANON_0": ":=",
}


def _readable(names: set[str]) -> str:
    shown = sorted({_READABLE.get(n, n.lower() if n.isalpha() and len(n) > 1 else n) for n in names})
    shown = [s for s in shown if not s.startswith("__")]
    many = len(shown) > 8
    return ", ".join(shown[:8]) + (", …" if many else "")


def _explain(error: UnexpectedInput, text: str) -> TextError:
    mistake = error.pos_in_stream
    foreign = None if mistake is None else find_foreign(text, mistake)
    if foreign is not None:
        begin, sign, instead = foreign
        line = text.count("\n", 0, begin) + 1
        position = Position(line, begin - text.rfind("\n", 0, begin))
        return TextError(f"'{sign}' is not of this language", position, instead)
    if isinstance(error, UnexpectedToken) and error.token.type != "$END":
        expected = set(error.accepts or error.expected)
        return TextError(
            f"'{short_token(str(error.token))}' cannot stand here",
            Position(error.line, error.column),
            f"Expected {_readable(expected)}.",
        )
    if isinstance(error, UnexpectedCharacters):
        found = text[error.pos_in_stream] if error.pos_in_stream is not None else ""
        expected = set(error.allowed or ())
        return TextError(
            f"the character {found!r} cannot stand here",
            Position(error.line, error.column),
            f"Expected {_readable(expected)}." if expected else "",
        )
    expected = set(error.expected) if isinstance(error, UnexpectedEOF | UnexpectedToken) else set()
    lines = text.splitlines() or [""]
    return TextError(
        "the text ends too early",
        Position(len(lines), len(lines[-1]) + 1),
        f"Expected {_readable(expected)}." if expected else "",
    )
