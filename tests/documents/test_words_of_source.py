"""Names and docstrings of the source are in the field's words (docs/explanation/glossary.md)."""

import ast
import re
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

SOURCE = Path(__file__).parents[2] / "src/roadproof"
OPENING = re.compile(
    r"(What|As|The same|Those|It|There (is|are)|Whatever|Who|All of it|So (many|much)|How|Whether|Where|Which"
    r"|Why|From|That|Of|For|At|By|When|In|On|With|Within|Without|Along|No|Not|Everything|Both|Either|Neither|Only"
    r"|Beside|Before|After|Also|To|So|Another|Several|Some|Beyond|Here|Ways|Let|Say|Settle|Tells)\b"
)
"""How no docstring begins: a summary says what a function returns or does, or what a class is."""
PRIVATE = re.compile(
    r"_*(told|said|asked|found|kept|wanted|sought|settled?|doubts?|begun|unread|untold|likes?|hands|shelf"
    r"|offered|surely|missed|held)(_\w+)?|\w+_(told|said|asked|kept|wanted|sought)"
)
"""Words that are no names of things."""
LONG = 3
"""Lines beyond the first from which on a public function of the core has a docstring."""
REMAINING: dict[str, int] = {}
"""How many private words each room still has as names of functions, arguments and variables; to be fewer."""
SHARED_CLASS_NAMES = {
    "Claim",
    "PreventionKeywords",
    "Survey",
}
"""Class names of several classes, each of another folder; to be fewer."""


def trees() -> Iterator[tuple[str, ast.Module]]:
    """Yield the tree of each file with its path below the package."""
    for path in sorted(SOURCE.rglob("*.py")):
        yield str(path.relative_to(SOURCE)), ast.parse(path.read_text("utf-8"))


def openings(tree: ast.Module) -> Iterator[str]:
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef | ast.ClassDef | ast.Module):
            text = ast.get_docstring(node)
            if text and OPENING.match(text):
                yield text.splitlines()[0]


def without_docstring(tree: ast.Module) -> Iterator[str]:
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef) and not node.name.startswith("_"):
            is_long = (node.end_lineno or 0) - node.lineno > LONG
            if is_long and ast.get_docstring(node) is None:
                yield node.name


def private_names(tree: ast.Module) -> Iterator[str]:
    """Yield names of functions, arguments and variables that are private words; fields are formats."""
    fields = {
        id(x.target)
        for node in ast.walk(tree)
        if isinstance(node, ast.ClassDef)
        for x in node.body
        if isinstance(x, ast.AnnAssign)
    }
    for node in ast.walk(tree):
        match node:
            case ast.FunctionDef(name=name) | ast.arg(arg=name):
                names = [name]
            case ast.Name(id=name, ctx=ast.Store()) if id(node) not in fields:
                names = [name]
            case _:
                names = []
        yield from (x for x in names if PRIVATE.fullmatch(x))


def room_of(file: str) -> str:
    """Return the folder of a file, and for extensions and frontends the folder in it."""
    parts = file.split("/")
    return "/".join(parts[:2] if parts[0] in ("extensions", "frontends") else parts[:1])


def test_docstrings_begin_with_what_is_returned_or_done() -> None:
    found = {file: [*openings(tree)] for file, tree in trees()}
    assert {file: texts for file, texts in found.items() if texts} == {}


def test_public_functions_of_the_core_have_docstrings() -> None:
    core = ((file, tree) for file, tree in trees() if not file.startswith("extensions/"))
    found = {file: [*without_docstring(tree)] for file, tree in core}
    assert {file: names for file, names in found.items() if names} == {}


def test_private_words_do_not_come_back() -> None:
    found = Counter(room_of(file) for file, tree in trees() for _ in private_names(tree))
    assert {room: count for room, count in found.items() if count > REMAINING.get(room, 0)} == {}


def test_a_class_name_occurs_once() -> None:
    names = Counter(x.name for _, tree in trees() for x in ast.walk(tree) if isinstance(x, ast.ClassDef))
    assert {name for name, count in names.items() if count > 1} == SHARED_CLASS_NAMES
