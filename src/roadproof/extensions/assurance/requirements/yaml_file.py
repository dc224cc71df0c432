"""Reads YAML files; the only module that imports PyYAML. All scalars are texts, as written."""

import json
from pathlib import Path
from typing import Any, NamedTuple, TypeAlias

import yaml

from roadproof.errors import InputError
from roadproof.runtime.files import read_text

LARGEST = 1_000_000
"""The largest file size in bytes."""


class Item(NamedTuple):
    """An entry of a list or object: a text, or a key with its value."""

    text: str
    value: str | None = None


Value: TypeAlias = str | tuple[Item, ...]


class _Loader(yaml.BaseLoader):  # type: ignore[misc]
    """Loads scalars as texts; rejects repeated keys, aliases and tags."""

    def construct_mapping(self, node: Any, deep: bool = False) -> dict[Any, Any]:
        keys: set[str] = set()
        for place, _ in node.value:
            name = str(self.construct_object(place, deep=True))
            if name in keys:
                raise yaml.constructor.ConstructorError(
                    None, None, f"the key '{name}' is given twice", place.start_mark
                )
            keys.add(name)
        made: dict[Any, Any] = super().construct_mapping(node, deep)
        return made

    def compose_node(self, parent: Any, index: Any) -> Any:
        event = self.peek_event()
        if isinstance(event, yaml.events.AliasEvent) or getattr(event, "tag", None):
            message = "a repeated part (*name) and a tag (!name) are not read"
            raise yaml.composer.ComposerError(None, None, message, event.start_mark)
        return super().compose_node(parent, index)


def read_yaml(path: Path) -> dict[str, Value]:
    """Return the keys of a file with their values, all as texts. Raises ``InputError`` with the line.

    An object inside is a list of its keys with their values.
    """
    text = read_text(path, LARGEST, "an item of requirements is smaller")
    try:
        content = yaml.load(text, _Loader)
    except RecursionError:
        raise InputError(f"{path}: its parts lie too deep in each other") from None
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        where = "" if mark is None else f", line {mark.line + 1}"
        problem = " ".join(str(getattr(error, "problem", error)).split())
        raise InputError(f"{path}{where}: it is no YAML: {problem}") from None
    if content in (None, ""):
        return {}
    if not isinstance(content, dict):
        raise InputError(f"{path}, line 1: write keys with texts, blocks of lines or lists")
    return {name: _value(value) for name, value in content.items()}


def _value(value: object) -> Value:
    if isinstance(value, list):
        return tuple(item for x in value for item in _items(x))
    return _items(value) if isinstance(value, dict) else _text(value)


def _items(value: object) -> tuple[Item, ...]:
    if isinstance(value, dict):
        return tuple(Item(str(name), _text(item)) for name, item in value.items())
    return (Item(_text(value)),)


def _text(value: object) -> str:
    """Return a text; deeper structures, which no known field has, as JSON."""
    return value.strip("\n") if isinstance(value, str) else json.dumps(value, ensure_ascii=False)
