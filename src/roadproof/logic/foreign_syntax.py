"""Signs and words of other languages in a text that does not parse, and what to write instead."""

import re

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
