"""Hints for operators and keywords of other languages in a text that does not parse."""

import re

_PREVIOUS = "Time is dense and has no previous instant: write O[a, b] with a time."
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
    "historically": "Write H.",
    "eventually": "Write F.",
    "finally": "Write F.",
    "until": "Write U.",
    "once": "Write O.",
    "previously": "Write O.",
    "since": "Write S.",
    "P": "Write O.",
    "Y": _PREVIOUS,
    "X": "Time is dense and has no next instant: write F[a, b] with a time.",
    "next": "Time is dense and has no next instant: write F[a, b] with a time.",
    "implies": "Write ->.",
    "iff": "Write <->.",
    "xor": "Write not (p <-> q).",
    "True": "Write true.",
    "TRUE": "Write true.",
    "False": "Write false.",
    "FALSE": "Write false.",
    "infinity": "Write inf.",
}
# F[] and != belong to this language, so [] after F and ! before = are no foreign operators.
_SIGN = re.compile(
    "|".join(
        ("(?<![FGUOHSWR])" if sign == "[]" else "") + re.escape(sign) + ("(?!=)" if sign == "!" else "")
        for sign in sorted(_SIGNS, key=len, reverse=True)
    )
)
_WORD = re.compile(rf"(?<![A-Za-z0-9_@])(?:{'|'.join(_WORDS)})(?![A-Za-z0-9_@])")
_NEAR = 200  # characters around a mistake that are searched


def find_foreign(text: str, mistake: int) -> tuple[int, str, str] | None:
    """Find an operator or keyword of another language at, or just before, the place where parsing stopped.

    Returns its position in ``text``, the operator or keyword, and the hint; None if there is none.
    """
    first = max(0, mistake - _NEAR)
    window = text[first : mistake + _NEAR]
    for match in _SIGN.finditer(window):
        if first + match.start() <= mistake < first + match.end():
            return first + match.start(), match[0], _SIGNS[match[0]]
    for match in _WORD.finditer(window):
        start, end = first + match.start(), first + match.end()
        if start <= mistake and not text[end:mistake].strip() and not _is_name(match[0], window):
            return start, match[0], _WORDS[match[0]]
    return None


def _is_name(word: str, text: str) -> bool:
    """Return whether a text uses a word as the name of something."""
    return re.search(rf"\b{word}\s*[:,)]|\b(some|every)\s+{word}\b", text) is not None


def instead_of(word: str) -> str:
    """Return the hint for a keyword of another language, else an empty text."""
    return _WORDS.get(word, "")
