"""Writes ``keywords.py``, the keyword arguments of each question as mypy and editors read them.

``python -m roadproof.frontends.settings.keywords_file`` makes the file again after a change.
"""

import ast
import inspect
import re
from pathlib import Path
from types import ModuleType
from typing import TypeGuard

from roadproof.extensions.traffic import settings as recordings
from roadproof.frontends.settings import groups, questions, studies
from roadproof.frontends.settings.option import Settings

MODULES = (questions, studies, recordings)
FILE = Path(__file__).with_name("keywords.py")
_WIDEST = 111  # characters of a line with its end
_HEAD = '''"""Keyword arguments of each question; made by ``roadproof.frontends.settings.keywords_file``."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypedDict

if TYPE_CHECKING:
'''


def all_questions() -> list[type[Settings]]:
    """The settings classes of questions, in the order of their definition."""
    return [x for home in MODULES for x in _settings_in(home)]


def _settings_in(home: ModuleType) -> list[type[Settings]]:
    return [x for x in vars(home).values() if _is_settings(x) and x.__module__ == home.__name__]


def _is_settings(value: object) -> TypeGuard[type[Settings]]:
    return isinstance(value, type) and issubclass(value, Settings)


def _keywords(settings: type[Settings]) -> set[str]:
    return {name for name, option in settings.options().items() if option.keyword}


def _class_text(settings: type[Settings]) -> str:
    """The class of a question or group, which inherits as that does and has the keywords of no base."""
    bases = [x for x in settings.__bases__ if _is_settings(x) and _keywords(x)]
    known = {name for x in bases for name in _keywords(x)}
    if not known <= _keywords(settings):
        raise TypeError(f"{settings.__name__} takes keywords away that its groups have: {known}")
    own = {k: x for k, x in inspect.get_annotations(settings).items() if k in _keywords(settings) - known}
    inherits = [*([f"{x.__name__}Keywords" for x in bases] or ["TypedDict"]), "total=False"]
    fields = "".join(f"    {name}: {kind}\n" for name, kind in own.items()) or "    pass\n"
    return "\n\n" + _listed(f"class {settings.__name__}Keywords", inherits, ":") + fields


def text() -> str:
    """The text of ``keywords.py``."""
    parts = [_class_text(x) for x in (*_settings_in(groups), *all_questions()) if _keywords(x)]
    types = re.findall(r"^    \w+: (.+)$", "".join(parts), re.MULTILINE)
    used = {*re.findall(r"[A-Za-z_]\w*", " ".join(types))}
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


def _listed(begin: str, items: list[str], end: str = "", indent: str = "") -> str:
    """A list in parentheses, in one line or, where that is too long, a line for each item."""
    line = f"{indent}{begin}({', '.join(items)}){end}\n"
    if len(line) <= _WIDEST:
        return line
    return f"{indent}{begin}(\n" + "".join(f"{indent}    {x},\n" for x in items) + f"{indent}){end}\n"


def _import_line(home: str, names: list[str]) -> str:
    line = f"    from {home} import {', '.join(names)}\n"
    return line if len(line) <= _WIDEST else _listed(f"from {home} import ", names, indent="    ")


if __name__ == "__main__":
    FILE.write_text(text(), "utf-8")
