"""What docstrings and comments name exists: a module, or something in one."""

import ast
import re
from pathlib import Path

SOURCE = Path(__file__).parents[2] / "src/roadproof"
_NAME = re.compile(r"``([a-z_]+(?:\.[A-Za-z_]+)+)(?:\(\))?``")
_FILE = re.compile(r"\.(toml|json|csv|spec|md|v|txt|py|html|svg|xodr|xml|osm|png|xosc|jsonl|css|js)$")
FOLDERS = {x.name for x in SOURCE.iterdir()} | {"analysis", "recordings", "drivers", "spec", "monitor"}
"""How the name of a module begins, also of one that was."""


def modules() -> set[str]:
    """The modules of the package, by every ending of their names."""
    names = (str(x.relative_to(SOURCE))[:-3].removesuffix("/__init__") for x in SOURCE.rglob("*.py"))
    parts = (name.split("/") for name in names)
    return {".".join(each[k:]) for each in parts for k in range(len(each))}


def defined() -> set[str]:
    """The names of classes, functions, fields and constants."""
    found: set[str] = set()
    for path in SOURCE.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            match node:
                case ast.FunctionDef(name=name) | ast.ClassDef(name=name):
                    found.add(name)
                case ast.AnnAssign(target=ast.Name(id=name)):
                    found.add(name)
                case ast.Assign(targets=[ast.Name(id=name)]):
                    found.add(name)
    return found


def is_there(name: str, known: set[str], names: set[str]) -> bool:
    home, _, leaf = name.rpartition(".")
    return name in known or (home in known and leaf in names)


def test_every_module_that_is_named_exists() -> None:
    known, names = modules(), defined()
    assert is_there("library.elaborate", known, names)
    assert not is_there("spec.elaborate", known, names)
    wrong = [
        f"{path.relative_to(SOURCE)}:{number}: {name}"
        for path in sorted(SOURCE.rglob("*.py"))
        for number, line in enumerate(path.read_text("utf-8").splitlines(), 1)
        for name in _NAME.findall(line)
        if name.split(".")[0] in FOLDERS and not _FILE.search(name) and not is_there(name, known, names)
    ]
    assert not wrong
