"""No error message names an option which the command that raises it does not have."""

import argparse
import ast
import re
from collections.abc import Iterator
from functools import cache
from importlib import import_module
from pathlib import Path

import pytest

import roadproof
from roadproof.frontends.cli.main import COMMANDS

SOURCE = Path(roadproof.__file__).parent
# What is raised for an option is raised only by commands that have it: these read it, or what it made.
READERS = {
    "roadproof.frontends.cli.numbers": {"--cluster", "--jobs", "--json", "--shard"},
    "roadproof.runtime.executors": {"--jobs"},
    "roadproof.analysis.study.frame": {"--out", "--shard"},
    "roadproof.frontends.cli.options": {"--option", "--param", "--set"},
    "roadproof.analysis.study.pool": {"--jobs"},
    "roadproof.runtime.process_pool": {"--jobs"},
    "roadproof.analysis.explore.asking": {"--vary", "--steps", "--precision"},
    # Raised for a catalogue that is asked for, and never for one that is judged again.
    "roadproof.analysis.catalogue.examination": {"--no-classes"},
    "roadproof.analysis.classify.classes": {"--among"},
}
OPTION = re.compile(r"(?<![\w-])--[a-z][a-z-]*")


def file_of(module: str) -> Path | None:
    path = SOURCE.joinpath(*module.split(".")[1:])
    return next((p for p in (path.with_suffix(".py"), path / "__init__.py") if p.is_file()), None)


@cache
def tree_of(module: str) -> ast.Module:
    path = file_of(module)
    assert path is not None
    return ast.parse(path.read_text("utf-8"))


def statements(node: ast.AST) -> Iterator[ast.AST]:
    """All below a node, but for what is imported for types only."""
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.If) and "TYPE_CHECKING" in ast.unparse(child.test):
            continue
        yield child
        yield from statements(child)


@cache
def imported_by(module: str) -> frozenset[str]:
    found: set[str] = set()
    for node in statements(tree_of(module)):
        if isinstance(node, ast.ImportFrom) and node.module and node.module.startswith("roadproof."):
            found.add(node.module)
            found |= {f"{node.module}.{alias.name}" for alias in node.names}
    return frozenset(name for name in found if file_of(name) is not None)


def reached_from(module: str) -> set[str]:
    reached, waiting = {module}, [module]
    while waiting:
        new = imported_by(waiting.pop()) - reached
        reached |= new
        waiting += new
    return reached


@cache
def hints_in(module: str) -> frozenset[str]:
    """The options that the error messages of a module name."""
    found: set[str] = set()
    for node in statements(tree_of(module)):
        if isinstance(node, ast.Call) and ast.unparse(node.func).endswith("Error"):
            texts = [x.value for x in ast.walk(node) if isinstance(x, ast.Constant)]
            found |= {option for text in texts for option in OPTION.findall(str(text))}
    return frozenset(found)


def options_of(command: str) -> set[str]:
    parser = argparse.ArgumentParser()
    import_module(f"roadproof.frontends.cli.{command}").add_arguments(parser)
    return {text for option in parser._actions for text in option.option_strings}


@pytest.mark.parametrize("command", COMMANDS)
def test_errors_name_options_that_the_command_has(command: str) -> None:
    known = options_of(command)
    wrong = {
        (module, option)
        for module in reached_from(f"roadproof.frontends.cli.{command}")
        for option in hints_in(module) - READERS.get(module, set())
        if option not in known
    }
    assert not wrong


def test_messages_are_found() -> None:
    assert "--jobs" in hints_in("roadproof.runtime.process_pool")
    assert "roadproof.engines.encode.unroll" in reached_from("roadproof.frontends.cli.witness")
    assert len({option for command in COMMANDS for option in options_of(command)}) > 40
