"""Functions and files of the source are short enough to read at once, and few arguments call a function."""

import ast
from collections.abc import Iterator
from pathlib import Path

SOURCE = Path(__file__).parents[2] / "src/roadproof"
LONGEST_FILE, LONGEST_FUNCTION, MOST_PARAMETERS = 400, 60, 8
LONG_FILES: set[str] = set()
"""Files that are longer; to be none."""


def functions(tree: ast.Module) -> Iterator[ast.FunctionDef | ast.AsyncFunctionDef]:
    """Yield all functions, also those in classes and functions."""
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            yield node


def long_functions(tree: ast.Module) -> Iterator[str]:
    """Yield the functions that are too long."""
    for node in functions(tree):
        if (node.end_lineno or 0) - node.lineno >= LONGEST_FUNCTION:
            yield node.name


def wide_functions(tree: ast.Module) -> Iterator[str]:
    """Yield the functions with too many parameters beside ``self`` and ``cls``."""
    for node in functions(tree):
        names = {x.arg for x in (*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs)}
        if len(names - {"self", "cls"}) > MOST_PARAMETERS:
            yield node.name


def texts() -> dict[str, str]:
    """Return the text of each file by its path below the package."""
    return {str(x.relative_to(SOURCE)): x.read_text("utf-8") for x in SOURCE.rglob("*.py")}


def test_files_are_short() -> None:
    assert {file for file, text in texts().items() if text.count("\n") > LONGEST_FILE} == LONG_FILES


def test_functions_are_short() -> None:
    found = {file: [*long_functions(ast.parse(text))] for file, text in texts().items()}
    assert {file: names for file, names in found.items() if names} == {}


def test_functions_have_few_parameters() -> None:
    found = {file: [*wide_functions(ast.parse(text))] for file, text in texts().items()}
    assert {file: names for file, names in found.items() if names} == {}


def test_a_function_beyond_a_limit_is_named() -> None:
    body = "\n".join(["    pass"] * LONGEST_FUNCTION)
    assert [*long_functions(ast.parse(f"def f():\n{body}"))] == ["f"]
    assert [*long_functions(ast.parse(f"def f(x):\n{body[:-9]}"))] == []
    names = [f"x{k}" for k in range(MOST_PARAMETERS + 1)]
    assert [*wide_functions(ast.parse(f"def f(self, {', '.join(names)}): ..."))] == ["f"]
    assert [*wide_functions(ast.parse(f"def f(self, {', '.join(names[1:])}): ..."))] == []
