"""Writes ``keywords.py``, the keyword arguments of each question as mypy and editors read them.

``python -m roadproof.frontends.settings.keywords_file`` makes the file again after a change.
"""

import ast
import dataclasses
import inspect
import re
from pathlib import Path
from typing import TypeGuard

from roadproof.frontends.settings import evidence, groups, questions, recordings, studies
from roadproof.frontends.settings.option import Settings

MODULES = (questions, studies, recordings, evidence)
FILE = Path(__file__).with_name("keywords.py")
_WIDEST = 111  # characters of a line with its end
_HEAD = '''"""Keyword arguments of each question; made by ``roadproof.frontends.settings.keywords_file``."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypedDict

if TYPE_CHECKING:
'''


def all_questions() -> list[type[Settings]]:
    """The settings classes of questions, in the order of their definition."""
    found = ((home, x) for home in MODULES for x in vars(home).values())
    return [x for home, x in found if _is_settings(x) and x.__module__ == home.__name__]


def _is_settings(value: object) -> TypeGuard[type[Settings]]:
    return isinstance(value, type) and issubclass(value, Settings)


def text() -> str:
    """The text of ``keywords.py``."""
    parts, used = [], set[str]()
    for question in all_questions():
        options = question.options()
        fields = [x for x in dataclasses.fields(question) if options[x.name].keyword]
        lines = [f"    {x.name}: {x.type}\n" for x in fields]
        used.update(*(re.findall(r"[A-Za-z_]\w*", str(x.type)) for x in fields))
        parts.append(f"\n\nclass {question.__name__}Keywords(TypedDict, total=False):\n{''.join(lines)}")
    imports = dict[str, set[str]]()
    for module in (groups, *MODULES):
        for node in ast.walk(ast.parse(inspect.getsource(module))):
            if isinstance(node, ast.ImportFrom) and node.module not in (None, groups.__name__):
                imports.setdefault(node.module, set()).update({x.name for x in node.names} & used)
    ordered = sorted((x for x in imports if imports[x]), key=lambda x: (x.startswith("roadproof"), x))
    lines = [_import_line(home, sorted(imports[home])) for home in ordered]
    inner = [x for x in lines if " roadproof" in x]
    outer = [x for x in lines if " roadproof" not in x]
    return _HEAD + "".join([*outer, *(["\n"] if outer and inner else []), *inner]) + "".join(parts)


def _import_line(home: str, names: list[str]) -> str:
    line = f"    from {home} import {', '.join(names)}\n"
    if len(line) <= _WIDEST:
        return line
    return f"    from {home} import (\n" + "".join(f"        {name},\n" for name in names) + "    )\n"


if __name__ == "__main__":
    FILE.write_text(text(), "utf-8")
