"""Renders formulas as HTML in the notation of the paper: its signs, and names in italics with indices."""

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
_TEMPORAL = {"G": "𝓖", "F": "𝓕", "U": "𝓤", "W": "𝓦", "R": "𝓡", "O": "𝓞", "H": "𝓗", "S": "𝓢"}
_GREEK = {"rho": "ρ", "alpha": "α", "beta": "β", "gamma": "γ", "delta": "δ", "tau": "τ", "mu": "μ"}
_TOKEN = re.compile(
    r"(?P<bounds>\b[GFUWROHS]\[[^\]]*\])|(?P<name>[A-Za-z_]\w*(?:-\d+)?(?:@\w+)?)|(?P<sign><->|->|<=|>=|!=|:=|[*-])"
    r"|(?P<number>\d[\d.]*)|(?P<space>\s+)|(?P<other>.)",
    re.DOTALL,
)


def as_html(tree: Expression | Claim, linked: Collection[str] = (), id_prefix: str = "") -> str:
    """Return a formula as HTML; names in ``linked`` link to the id ``id_prefix`` + name."""
    return text_as_html(text(tree), linked, id_prefix)


def head_as_html(definition: Definition) -> str:
    """Return the name of a definition with its parameters as HTML."""
    names = ", ".join(_name_as_html(x.name) for x in definition.parameters)
    return f"{_name_as_html(definition.name)}({names})"


def text_as_html(formula: str, linked: Collection[str] = (), id_prefix: str = "") -> str:
    """Return the text of a formula as HTML; names in ``linked`` link to the id ``id_prefix`` + name."""

    def name(word: str) -> str:
        made = _name_as_html(word)
        return f'<a href="#{id_prefix}{escape(word)}">{made}</a>' if word in linked else made

    return "".join(_token_as_html(x, name) for x in _TOKEN.finditer(formula))


def _token_as_html(token: re.Match[str], name: Callable[[str], str]) -> str:
    word = token[0]
    match token.lastgroup:
        case "bounds":
            inner = "".join(_token_as_html(x, name) for x in _TOKEN.finditer(word[2:-1]))
            return f"{_TEMPORAL[word[0]]}<sub>[{inner}]</sub>"
        case "name" | "sign":
            return _TEMPORAL.get(word) or _SIGNS.get(word) or name(word)
        case "space":
            return " "
        case _:  # open: names of groups of the pattern, here number and other
            return escape(word)


def _name_as_html(word: str) -> str:
    """Return a name with its indices as subscripts and the spec set as superscript."""
    stem, _, above = word.partition("@")
    stem, *below = [x for x in stem.split("_") if x] or [stem]
    numbered = re.fullmatch(r"([A-Za-z]+)(\d+)", stem)
    if numbered and not below:
        stem, below = numbered[1], [numbered[2]]
    lower = f"<sub>{escape(', '.join(below))}</sub>" if below else ""
    upper = f"<sup>{escape(above)}</sup>" if above else ""
    return f"<i>{escape(_GREEK.get(stem, stem))}</i>{lower}{upper}"
