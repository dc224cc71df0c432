"""Writes ``keywords.py``, the keyword arguments of each question as mypy and editors read them.

``python -m roadproof.frontends.settings.keywords_file`` makes the file again after a change.
"""

import dataclasses
import inspect
import re
from pathlib import Path
from typing import TypeGuard

from roadproof.frontends.settings import evidence, groups, questions, recordings
from roadproof.frontends.settings.option import Settings

MODULES = (questions, recordings, evidence)
FILE = Path(__file__).with_name("keywords.py")
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
        for line in re.findall(r"^ *(from \S+ import [^\n(]+)$", inspect.getsource(module), re.MULTILINE):
            _, home, _, names = line.split(" ", 3)
            imports.setdefault(home, set()).update({*names.split(", ")} & used)
    ordered = sorted((x for x in imports if imports[x]), key=lambda x: (x.startswith("roadproof"), x))
    lines = [f"    from {home} import {', '.join(sorted(imports[home]))}\n" for home in ordered]
    inner = [x for x in lines if " roadproof" in x]
    outer = [x for x in lines if " roadproof" not in x]
    return _HEAD + "".join([*outer, *(["\n"] if outer and inner else []), *inner]) + "".join(parts)


if __name__ == "__main__":
    FILE.write_text(text(), "utf-8")
