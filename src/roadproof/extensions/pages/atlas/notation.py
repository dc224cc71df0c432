"""Formulas as HTML in the notation of the paper: its signs, names in italics with indices."""

import re
from collections.abc import Callable, Collection
from html import escape

from roadproof.logic.show import text
from roadproof.logic.syntax import Claim, Definition, Expression

_SIGNS = {
    "and": "∧",
    "or": "∨",
    "not": "¬",
    "->": "⇒",
    "<->": "⇔",
    "<=": "≤",
    ">=": "≥",
    "!=": "≠",
    "*": "·",
    "-": "−",
    ":=": "≔",
    "true": "⊤",
    "false": "⊥",
    "some": "∃",
    "every": "∀",
    "in": "∈",
}
_TEMPORAL = {"G": "𝓖", "F": "𝓕", "U": "𝓤"}
_GREEK = {"rho": "ρ", "alpha": "α", "beta": "β", "gamma": "γ", "delta": "δ", "tau": "τ", "mu": "μ"}
_TOKEN = re.compile(
    r"(?P<bounds>\b[GFU]\[[^\]]*\])|(?P<name>[A-Za-z_]\w*(?:-\d+)?(?:@\w+)?)|(?P<sign><->|->|<=|>=|!=|:=|[*-])"
    r"|(?P<number>\d[\d.]*)|(?P<space>\s+)|(?P<other>.)",
    re.DOTALL,
)


def as_html(tree: Expression | Claim, linked: Collection[str] = (), before: str = "") -> str:
    """A formula as HTML. Names of definitions that are ``linked`` lead to the id ``before`` + name."""
    return shown(text(tree), linked, before)


def head_as_html(definition: Definition) -> str:
    """The name of a definition with its parameters."""
    names = ", ".join(_name(x.name) for x in definition.parameters)
    return f"{_name(definition.name)}({names})"


def shown(written: str, linked: Collection[str] = (), before: str = "") -> str:
    """As ``as_html``, of a formula as text."""

    def name(word: str) -> str:
        made = _name(word)
        return f'<a href="#{before}{escape(word)}">{made}</a>' if word in linked else made

    return "".join(_token(x, name) for x in _TOKEN.finditer(written))


def _token(found: re.Match[str], name: Callable[[str], str]) -> str:
    word = found[0]
    match found.lastgroup:
        case "bounds":
            inner = "".join(_token(x, name) for x in _TOKEN.finditer(word[2:-1]))
            return f"{_TEMPORAL[word[0]]}<sub>[{inner}]</sub>"
        case "name" | "sign":
            return _TEMPORAL.get(word) or _SIGNS.get(word) or name(word)
        case "space":
            return " "
        case _:
            return escape(word)


def _name(word: str) -> str:
    """A name with its indices below, and the spec set above."""
    stem, _, above = word.partition("@")
    stem, *below = [x for x in stem.split("_") if x] or [stem]
    numbered = re.fullmatch(r"([A-Za-z]+)(\d+)", stem)
    if numbered and not below:
        stem, below = numbered[1], [numbered[2]]
    lower = f"<sub>{escape(', '.join(below))}</sub>" if below else ""
    upper = f"<sup>{escape(above)}</sup>" if above else ""
    return f"<i>{escape(_GREEK.get(stem, stem))}</i>{lower}{upper}"
