"""Where a line of a Python file is: its function and its text, so that the name survives other changes."""

import ast
from collections.abc import Iterator


def functions_of(tree: ast.AST, above: str = "") -> Iterator[tuple[str, ast.FunctionDef]]:
    """(qualified name, function), outer ones first."""
    for node in ast.iter_child_nodes(tree):
        match node:
            case ast.FunctionDef(name=name):
                yield f"{above}{name}", node
                yield from functions_of(node, f"{above}{name}.")
            case ast.ClassDef(name=name):
                yield from functions_of(node, f"{above}{name}.")
            case _:
                yield from functions_of(node, above)


def places_of(tree: ast.Module, text: str) -> dict[int, str]:
    """Line number to ``function|text of the line``; the function is empty outside of any."""
    owner: dict[int, str] = {}
    for name, function in functions_of(tree):
        for line in range(function.lineno, (function.end_lineno or 0) + 1):
            owner[line] = name
    return {n: f"{owner.get(n, '')}|{line.strip()}" for n, line in enumerate(text.split("\n"), start=1)}
