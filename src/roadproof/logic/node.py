"""The base of all syntax trees, terms and formulas: frozen dataclasses that cache their hash.

Two nodes are equal if they have the same structure, whatever definitions they come from. Formulas share
sub-trees; without the cached hash every look-up in a dictionary would walk the whole tree.
"""

from collections.abc import Callable
from functools import wraps
from operator import attrgetter
from typing import Any, TypeVar, dataclass_transform

from roadproof.runtime.records import dataclass

T = TypeVar("T")
N = TypeVar("N")

# Placeholders for a cached value: not computed yet; the node itself, which would make a cycle.
_UNKNOWN, _ITSELF = object(), object()


@dataclass_transform(frozen_default=True)
def node(cls: type[T]) -> type[T]:
    """Make ``cls`` a frozen dataclass whose hash is computed once per object."""
    node_class = dataclass(frozen=True, eq=False)(cls)
    fields = _fields(cls)

    def remembered(self: Any) -> int:
        """Return the hash, computed at the first call."""
        try:
            stored_hash: int = self._hash
        except AttributeError:
            stored_hash = hash(fields(self))
            object.__setattr__(self, "_hash", stored_hash)
        return stored_hash

    def state(self: Any) -> dict[str, object]:
        """Return the fields without cached values, for pickle: another process would compute another hash."""
        return {name: value for name, value in self.__dict__.items() if name[0] != "_"}

    def equals(self: Any, other: object) -> bool:
        """Compare structure; the same object and different hashes are decided at once."""
        if self is other:
            return True
        if type(self) is not type(other) or hash(self) != hash(other):
            return False
        return bool(fields(self) == fields(other))

    node_class.__eq__ = equals  # type: ignore[method-assign]
    node_class.REMEMBERS = True  # type: ignore[attr-defined]  # its digest, too (runtime.canonical)
    node_class.__getstate__ = state  # type: ignore[method-assign]
    node_class.__hash__ = remembered  # type: ignore[method-assign]
    return node_class


def _fields(cls: type) -> Callable[[Any], object]:
    """Return a function that gives the values of all fields of an instance, as a tuple."""
    names = tuple(cls.__annotations__)
    if len(names) < 2:  # attrgetter returns a tuple only for two or more names
        return lambda of: tuple([getattr(of, name) for name in names])
    return attrgetter(*names)


def memoised(fact: Callable[[N], T]) -> Callable[[N], T]:
    """Cache ``fact(node)`` on the node itself, so that it is computed once per object.

    ``fact`` must depend on the node alone.
    """
    key = f"_{fact.__module__}.{fact.__name__}"

    @wraps(fact)
    def cached(node: N) -> T:
        """Return the stored value, or compute and store it."""
        value = getattr(node, key, _UNKNOWN)
        if value is _UNKNOWN:
            value = fact(node)
            object.__setattr__(node, key, _ITSELF if value is node else value)
        result: T = node if value is _ITSELF else value  # type: ignore[assignment]
        return result

    return cached
