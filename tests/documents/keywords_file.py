"""The text of ``keywords.py``, the keyword arguments of questions as mypy and editors read them.

``make generated`` writes the files after a change: one for the core, and one beside ``settings.py`` of each
extension that has one.
"""

import ast
import inspect
import re
from collections.abc import Iterator
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from types import ModuleType
from typing import TypeGuard

from roadproof.extension import installed_extensions
from roadproof.frontends.settings import groups, questions, relations
from roadproof.frontends.settings.option import Settings, stem_of

CORE = (questions, relations)
_WIDEST = 111  # characters of a line with its end
_KEYWORDS = "roadproof.frontends.settings.keywords"
_HEAD = '''"""Keyword arguments of each question; ``make generated`` writes this file."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypedDict

if TYPE_CHECKING:
'''


def modules() -> dict[Path, tuple[ModuleType, ...]]:
    """The files of keywords, each with the modules of settings that it is made of."""
    files: dict[Path, tuple[ModuleType, ...]] = {Path(str(questions.__file__)).with_name("keywords.py"): CORE}
    for x in installed_extensions().values():
        name = f"{x.package}.settings"
        if find_spec(name) is not None:
            files[Path(x.folder) / "keywords.py"] = (import_module(name),)
    return files


def all_questions() -> list[type[Settings]]:
    """The settings classes of questions, in the order of their definition."""
    return [x for homes in modules().values() for home in homes for x in _settings_in(home)]


def _settings_in(home: ModuleType) -> list[type[Settings]]:
    return [x for x in vars(home).values() if _is_settings(x) and x.__module__ == home.__name__]


def _is_settings(value: object) -> TypeGuard[type[Settings]]:
    return isinstance(value, type) and issubclass(value, Settings)


def _keywords(settings: type[Settings]) -> set[str]:
    return {name for name, option in settings.options().items() if option.keyword}


def _own(settings: type[Settings]) -> type[Settings]:
    """The class as it is written, without options of extensions."""
    first = settings.__bases__[0]
    return first if _is_settings(first) and first.__qualname__ == settings.__qualname__ else settings


def _bases(settings: type[Settings]) -> list[type[Settings]]:
    """The groups with keywords that a class inherits; of an extended one those of extensions, too."""
    own = _own(settings)
    more = settings.__bases__[1:] if own is not settings else ()
    return [x for x in (*own.__bases__, *more) if _is_settings(x) and _keywords(x)]


def _class_text(settings: type[Settings]) -> str:
    """The class of a question or group, which inherits as that does and has the keywords of no base."""
    bases = _bases(settings)
    known = {name for x in bases for name in _keywords(x)}
    if not known <= _keywords(settings):
        raise TypeError(f"{settings.__name__} takes keywords away that its groups have: {known}")
    names = _keywords(settings) - known
    own = {k: x for k, x in inspect.get_annotations(_own(settings)).items() if k in names}
    inherits = [*([f"{stem_of(x)}Keywords" for x in bases] or ["TypedDict"]), "total=False"]
    fields = "".join(f"    {name}: {kind}\n" for name, kind in own.items()) or "    pass\n"
    return "\n\n" + _listed(f"class {stem_of(settings)}Keywords", inherits, ":") + fields


def _with_groups(classes: list[type[Settings]], core: bool) -> list[type[Settings]]:
    """Classes with the groups that they need before them; the core has its own already."""
    ordered: dict[type[Settings], None] = dict.fromkeys(_settings_in(groups)) if core else {}
    for settings in classes:
        for group in _groups_above(settings):
            if core or group.__module__ != groups.__name__:
                ordered.setdefault(group)
        ordered.setdefault(settings)
    return [x for x in ordered if _keywords(x)]


def _groups_above(settings: type[Settings]) -> Iterator[type[Settings]]:
    for base in _bases(settings):
        yield from _groups_above(base)
        yield base


def text(homes: tuple[ModuleType, ...]) -> str:
    """The text of a file of keywords."""
    core = homes == CORE
    classes = _with_groups([x for home in homes for x in _settings_in(home)], core)
    parts = [_class_text(x) for x in classes]
    types = re.findall(r"^    \w+: (.+)$", "".join(parts), re.MULTILINE)
    used = {*re.findall(r"[A-Za-z_]\w*", " ".join(types))}
    imports = dict[str, set[str]]()
    for module in dict.fromkeys((groups, *homes, *(import_module(x.__module__) for x in classes))):
        for node in ast.walk(ast.parse(inspect.getsource(module))):
            if isinstance(node, ast.ImportFrom) and node.module not in (None, groups.__name__):
                imports.setdefault(node.module, set()).update({x.name for x in node.names} & used)
    here = {f"{stem_of(x)}Keywords" for x in classes}
    above = {f"{stem_of(x)}Keywords" for y in classes for x in _bases(y)} - here
    ordered = sorted((x for x in imports if imports[x]), key=lambda x: (x.startswith("roadproof"), x))
    lines = [_import_line(home, sorted(imports[home])) for home in ordered]
    inner = [x for x in lines if " roadproof" in x]
    outer = [x for x in lines if " roadproof" not in x]
    head = _HEAD
    if above:
        head = head.replace(
            "\nif TYPE", f"\n{_listed(f'from {_KEYWORDS} import ', sorted(above))}\nif TYPE", 1
        )
    if not lines:
        head = head.replace("\nif TYPE_CHECKING:\n", "").replace("TYPE_CHECKING, ", "")
    if core is False and not any("(TypedDict" in x for x in parts):
        head = head.replace(", TypedDict\n", "\n").replace("import TypedDict\n", "import TYPE_CHECKING\n")
    return head + "".join([*outer, *(["\n"] if outer and inner else []), *inner]) + "".join(parts)


def _listed(begin: str, items: list[str], end: str = "", indent: str = "") -> str:
    """A list in parentheses, in one line or, where that is too long, a line for each item."""
    plain = begin.endswith(" import ")
    line = f"{indent}{begin}{', '.join(items)}\n" if plain else f"{indent}{begin}({', '.join(items)}){end}\n"
    if len(line) <= _WIDEST:
        return line
    return f"{indent}{begin}(\n" + "".join(f"{indent}    {x},\n" for x in items) + f"{indent}){end}\n"


def _import_line(home: str, names: list[str]) -> str:
    return _listed(f"from {home} import ", names, indent="    ")
