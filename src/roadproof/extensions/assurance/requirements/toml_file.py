"""Reads ``requirements.toml``: requirements with their links, or links for requirements of another file.

``[trace]`` has the settings, ``[[requirement]]`` an ``id``, a ``text`` and links. With ``source`` in
``[trace]`` the requirements are those of other files, and a ``[[requirement]]`` of the same id adds links.
"""

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

from roadproof.errors import InputError
from roadproof.extensions.assurance.answers.trace import RequirementPlace
from roadproof.extensions.assurance.requirements.requirement import (
    FIELDS,
    SOURCE_FIELDS,
    Link,
    Requirement,
    RequirementSet,
    TraceSettings,
    place_text,
)
from roadproof.library.specification import on_request, unknown_name
from roadproof.runtime.files import read_text
from roadproof.world.models import LARGEST_MODEL, read_toml

_HEAD = re.compile(r"(\s*)\[\[\s*requirement\s*\]\]")
_TRACE = ("evidence", "specs", "set", "options", "parameters", "vehicles", "source")
_REQUIREMENT = ("id", "text", "title", "parent", "derived_from", *SOURCE_FIELDS, *FIELDS)
Content = Mapping[str, object]


def read_toml_requirements(path: Path, read: Callable[[Path], RequirementSet]) -> RequirementSet:
    """Return the requirements of a TOML file; ``read`` reads those of a ``source``. Raises ``InputError``."""
    content = read_toml(path)
    for name in content:
        if name not in ("trace", "requirement"):
            raise InputError(f"{path}: {unknown_name('table', name, ('trace', 'requirement'))}")
    head = _table(content.get("trace", {}), f"{path}, trace")
    _check_fields(head, _TRACE, f"{path}, trace")
    settings = _settings(head, path)
    own = [*_requirements(content, path)]
    sources = [read(path.parent / x) for x in _texts(head, "source", f"{path}, trace")]
    if not sources:
        for x in own:
            if not x.text:
                raise InputError(f"{place_text(x.place)}: requirement {x.id or '?'} has no text")
        return RequirementSet(path, tuple(own), settings)
    sourced = [x for source in sources for x in source.requirements]
    notes = tuple(note for source in sources for note in source.notes)
    joined = RequirementSet(path, tuple(_joined(sourced, own)), settings, notes)
    return joined.without_strange_parents()


def _joined(sourced: list[Requirement], own: list[Requirement]) -> Iterator[Requirement]:
    """Yield the requirements of sources with the added links, editions and clauses. Raises ``InputError``."""
    joined = {x.id: x for x in sourced}
    for x in own:
        if x.id not in joined:
            raise InputError(f"{place_text(x.place)}: {unknown_name('requirement', x.id, joined)}")
        there = joined[x.id]
        if x.text or x.title or x.parents:
            raise InputError(
                f"{place_text(x.place)}: the text of {x.id} is in its source; only add links here"
            )
        for name in SOURCE_FIELDS:
            former, new = getattr(there, name), getattr(x, name)
            if former and new not in ("", former):
                raise InputError(
                    f"{place_text(x.place)}: {name}={new!r}, but the source of {x.id} says {former!r}"
                )
        links = tuple(dict.fromkeys((*there.links, *x.links)))
        edition, clause = there.edition or x.edition, there.clause or x.clause
        joined[x.id] = replace(there, links=links, edition=edition, clause=clause)
    yield from joined.values()


def _settings(head: Content, path: Path) -> TraceSettings:
    where, folder = f"{path}, trace", path.parent
    shipped = on_request()
    words = _texts(head, "set", where) or ("base",)
    return TraceSettings(
        evidence=tuple(folder / x for x in _texts(head, "evidence", where)),
        specs=tuple(Path(x) if x in shipped else folder / x for x in _texts(head, "specs", where)),
        set_name=words[0],
        options={k: _text(v, f"{where}, options.{k}") for k, v in _inner(head, "options", where).items()},
        parameters={
            k: _value(v, f"{where}, parameters.{k}") for k, v in _inner(head, "parameters", where).items()
        },
        vehicles={
            k: _model(_text(v, f"{where}, vehicles.{k}"), folder)
            for k, v in _inner(head, "vehicles", where).items()
        },
    )


def _model(name: str, folder: Path) -> str:
    """Return the name of a shipped vehicle model, or the path of one of the user's."""
    return str(folder / name) if name.endswith(".toml") else name


def _requirements(content: Content, path: Path) -> Iterator[Requirement]:
    tables = content.get("requirement", [])
    if not isinstance(tables, list):
        raise InputError(f"{path}: write [[requirement]], with two brackets, for each requirement")
    places = _places(path)
    for number, table in enumerate(tables, 1):
        place = places[number - 1] if len(places) == len(tables) else RequirementPlace(file=str(path))
        where = f"{place_text(place)}, requirement {number}"
        fields = _table(table, where)
        _check_fields(fields, _REQUIREMENT, where)
        yield Requirement(
            _text(fields.get("id", ""), f"{where}, id").strip(),
            _text(fields.get("text", ""), f"{where}, text").strip(),
            place,
            _text(fields.get("title", ""), f"{where}, title").strip(),
            tuple(dict.fromkeys((*_texts(fields, "parent", where), *_texts(fields, "derived_from", where)))),
            tuple(
                dict.fromkeys(
                    Link(kind, x.strip())
                    for name, kind in FIELDS.items()
                    for x in _texts(fields, name, where)
                )
            ),
            edition=_text(fields.get("edition", ""), f"{where}, edition").strip(),
            clause=_text(fields.get("clause", ""), f"{where}, clause").strip(),
        )


def _places(path: Path) -> list[RequirementPlace]:
    """Return where each ``[[requirement]]`` begins."""
    lines = read_text(path, LARGEST_MODEL, "").splitlines()
    headers = ((number, _HEAD.match(line)) for number, line in enumerate(lines, 1))
    return [
        RequirementPlace(file=str(path), line=n, column=len(x[1]) + 1) for n, x in headers if x is not None
    ]


def _table(content: object, where: str) -> Content:
    if not isinstance(content, Mapping):
        raise InputError(f"{where}: a table of TOML is expected here")
    return content


def _inner(content: Content, name: str, where: str) -> Content:
    return _table(content.get(name, {}), f"{where}, {name}")


def _check_fields(content: Content, known: tuple[str, ...], where: str) -> None:
    for name in content:
        if name not in known:
            raise InputError(f"{where}: {unknown_name('field', name, known)}")


def _texts(content: Content, name: str, where: str) -> tuple[str, ...]:
    """Return a list of texts or numbers, or a single one, as texts."""
    value = content.get(name, [])
    every = value if isinstance(value, list) else [value]
    return tuple(_text(x, f"{where}, {name}") for x in every)


def _text(value: object, where: str) -> str:
    if isinstance(value, int) and not isinstance(value, bool):
        return str(value)
    if not isinstance(value, str):
        raise InputError(f"{where}: {value!r} is no text; write it in quotes")
    return value


def _value(value: object, where: str) -> Fraction | int | str:
    if isinstance(value, bool) or not isinstance(value, Fraction | int | str):
        raise InputError(f'{where}: {value!r} is no number, and no text such as "600 ms"')
    return value
