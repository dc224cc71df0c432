"""Small faults in definitions: edits of the text of a ``.spec`` file, doc strings and comments left alone."""

import re
from collections.abc import Iterator

from mutants.edits import Edit

_WORDS = {
    "and": ("or",),
    "or": ("and",),
    "some": ("every",),
    "every": ("some",),
    "true": ("false",),
    "max": ("min",),
    "min": ("max",),
    "front": ("rear",),
    "rear": ("front",),
    "length": ("width",),
    "width": ("length",),
    "v_lon": ("v_lat",),
    "v_lat": ("v_lon",),
    "minSafe": ("minDanger",),
    "minDanger": ("minSafe",),
    "b_min": ("b_max",),
    "b_max": ("b_min",),
    "a_max": ("b_min",),
    "main": ("merge",),
    "merge": ("depart",),
    "depart": ("main",),
    "accel": ("decel",),
    "decel": ("accel",),
    "aheadOf": ("aheadOf_ext",),
    "aheadOf_ext": ("aheadOf",),
    "danger": ("instSafe",),
    "leavingLane": ("enteringLane",),
    "enteringLane": ("leavingLane",),
    "F": ("G",),
    "G": ("F",),
    "not": ("",),
}
_SIGNS = {
    "<": ("<=", ">"),
    "<=": ("<", ">="),
    ">": (">=", "<"),
    ">=": (">", "<="),
    "+": ("-",),
    "-": ("+",),
    "*": ("/",),
    "/": ("*",),
    "..": (),
    ":=": (),
    "->": ("<->",),
}
_TOKEN = re.compile(r'"[^"]*"|#[^\n]*|[A-Za-z_]\w*(?:\{[^}]*\})?|\d+(?:\.\d+)?|:=|->|<=|>=|\.\.|[^\s\w]')
_CALL = re.compile(r"\b([A-Za-z_]\w*(?:\{[^}]*\})?)\(([^()]*)\)")
_WINDOW = re.compile(r"\b([FGU])(\[[^\]]*\])")


def spec_edits_of(file: str, text: str) -> list[Edit]:
    """Every fault that the operators make of a spec file, in the order of its text."""
    made: list[Edit] = []
    seen: dict[tuple[str, ...], int] = {}
    place = 0
    definition = ""
    for number, line in enumerate(text.splitlines(keepends=True), start=1):
        if begun := re.match(r"\s*(?:each .*\{ *)?(def|param|when|set|each) (\S+?)[(\s]", line):
            definition = begun[2]
        for start, end, operator, after in _faults(line):
            shown = " ".join(line.split())
            key = (shown, operator, line[start:end], after)
            nth = seen[key] = seen.get(key, -1) + 1
            where = (place + start, place + end)
            context = f"{definition}|{shown}"
            made.append(Edit(file, operator, *where, line[start:end], after, (number, number), context, nth))
        place += len(line)
    return made


def _faults(line: str) -> Iterator[tuple[int, int, str, str]]:
    """(start, end, operator, new text)."""
    bare = re.sub(r'"[^"]*"|#.*', lambda found: "\0" * len(found[0]), line)
    bare = re.sub(r"\bdef [^(]*\([^)]*\)|(?<=\d )m/s(\^2)?", lambda found: "\0" * len(found[0]), bare)
    if bare.lstrip().startswith("option"):
        return
    for token in _TOKEN.finditer(bare):
        start, end, word = token.start(), token.end(), token[0]
        heading = re.match(r"\s*(each|when)\b", bare) and end <= max(bare.find("{"), 0)
        if heading:
            continue
        for other in (*_WORDS.get(word, ()), *_SIGNS.get(word, ())):
            yield start, end, "word" if word in _WORDS else "sign", other
        if word[0].isdigit():
            yield start, end, "number", str(int(word) + 1) if word.isdecimal() else f"{word}5"
    for call in _CALL.finditer(bare):
        parts = [part.strip() for part in call[2].split(",")]
        for i in range(len(parts) - 1):
            if parts[i] != parts[i + 1] and call[1] not in ("min", "max"):
                swapped = [*parts[:i], parts[i + 1], parts[i], *parts[i + 2 :]]
                yield call.start(), call.end(), "arguments swapped", f"{call[1]}({', '.join(swapped)})"
    for window in _WINDOW.finditer(bare):
        yield window.start(), window.end(), "window left out", window[1]
