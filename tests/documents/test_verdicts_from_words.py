"""No code decides by the words of a claim, a label, a message or a reason."""

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

SOURCE = Path(__file__).parents[2] / "src/roadproof"
WORDS = {
    "label",
    "reason",
    "claim",
    "remark",
    "told",
    "message",
    "messages",
    "problem",
    "problems",
    "reason_text",
}
EXCHANGE = SOURCE / "extensions/exchange"
READERS = {
    SOURCE / "extensions/traffic/formats",
    EXCHANGE / "storyboard",
    *(
        EXCHANGE / f"{x}.py"
        for x in ("commonroad", "commonroad_obstacles", "openscenario", "osi", "protobuf")
    ),
}
"""Readers of foreign files, whose words are data."""
MATCHES = {"rpartition", "startswith", "endswith", "find", "index", "match", "search", "fullmatch"}


def words_in(node: ast.expr) -> bool:
    match node:
        case ast.Attribute(attr=name) | ast.Name(id=name):
            return name in WORDS
    return False


def is_words(node: ast.expr) -> bool:
    return isinstance(node, ast.Constant) and isinstance(node.value, str) and bool(node.value)


def verdicts_from_words(source: str) -> Iterator[int]:
    """Lines that compare the words of a field with a literal, or match or look up these words."""
    for node in ast.walk(ast.parse(source)):
        match node:
            case ast.Compare(left=left, comparators=[right, *_]):
                literal = is_words(left) or is_words(right)
                listed = isinstance(right, ast.Tuple | ast.List | ast.Set) and any(map(is_words, right.elts))
                formatted = isinstance(right, ast.JoinedStr)
                if (words_in(left) or words_in(right)) and (literal or listed or formatted):
                    yield node.lineno
            case ast.Call(func=ast.Attribute(value=value, attr=name), args=args) if name in MATCHES:
                if words_in(value) or any(map(words_in, args)):
                    yield node.lineno
            case ast.Subscript(slice=key, ctx=ast.Load()) if words_in(key):
                yield node.lineno


def test_no_source_decides_by_words() -> None:
    found = [
        f"{path.relative_to(SOURCE)}:{line}"
        for path in sorted(SOURCE.rglob("*.py"))
        if not READERS & {*path.parents, path}
        for line in verdicts_from_words(path.read_text("utf-8"))
    ]
    assert found == []


@pytest.mark.parametrize(
    "source",
    [
        'x.claim == "shows no scenario"',
        '"no scenario" in x.reason',
        'x.label in ("a", "b")',
        'x.label == f"test {name}"',
        'x.label.startswith("test ")',
        "re.match(pattern, x.told)",
        "TABLE[x.label]",
    ],
)
def test_a_verdict_from_words_is_found(source: str) -> None:
    assert [*verdicts_from_words(source)] == [1]


@pytest.mark.parametrize(
    "source", ["x.kind is Kind.TEST and x.reason.kind in STALE", 'x.label == ""', "TABLE[x.identifier]"]
)
def test_kinds_emptiness_and_identifiers_of_code_are_no_words(source: str) -> None:
    assert [*verdicts_from_words(source)] == []
