"""Which kept answers an index says in the same words, beside which they lie and which is made of them."""

import json
from collections.abc import Iterator, Mapping
from typing import Any

from roadproof.evidence.strict import Fields


class IndexLines:
    """The objects of an index, each with its fields."""

    def __init__(self, index: Fields) -> None:
        self._objects = [*_objects(index.content)]
        self._words = frozenset(map(_words, self._objects))
        self._numbered = {x["number"]: x for x in self._objects if type(x.get("number")) is int}

    def has(self, line: object) -> bool:
        """Whether an object of the index has all fields of ``line``, with the same values."""
        if not isinstance(line, dict):
            return False
        return _words(line) in self._words or any(self._is_like(x, line) for x in self._objects)

    def _is_like(self, said: Mapping[str, Any], kept: Mapping[str, Any]) -> bool:
        return all(name in said and self._is_same(said[name], value) for name, value in kept.items())

    def _is_same(self, said: object, kept: object) -> bool:
        """Whether two values are equal, or numbers in the index stand for objects that are kept."""
        if _words(said) == _words(kept):
            return True
        if not isinstance(said, list) or not isinstance(kept, list) or len(said) != len(kept):
            return False
        return all(
            type(number) is int
            and number in self._numbered
            and isinstance(line, dict)
            and self._is_like(self._numbered[number], line)
            for number, line in zip(said, kept, strict=True)
        )


def _objects(content: object) -> Iterator[dict[str, Any]]:
    if isinstance(content, dict):
        yield content
    inside = content.values() if isinstance(content, dict) else content if isinstance(content, list) else ()
    for value in inside:
        yield from _objects(value)


def _words(content: object) -> str:
    return json.dumps(content, sort_keys=True)
