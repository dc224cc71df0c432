"""What all trees of this package are made of: frozen dataclasses that remember their hash.

Identity is structure: two nodes are equal when they are built alike, whatever they are called.
Formulas share sub-trees, so without the remembered hash every look-up would walk the whole tree.
"""

from collections.abc import Callable
from functools import wraps
from operator import attrgetter
from typing import Any, TypeVar, dataclass_transform

from roadproof.runtime.records import dataclass

T = TypeVar("T")
N = TypeVar("N")

# In place of a fact of a node: it was not asked for yet; it is the node itself, which would be a cycle.
_UNKNOWN, _ITSELF = object(), object()


@dataclass_transform(frozen_default=True)
def node(cls: type[T]) -> type[T]:
    """Make ``cls`` a frozen dataclass whose hash is computed once per object."""
    made = dataclass(frozen=True, eq=False)(cls)
    fields = _fields(cls)

    def remembered(self: Any) -> int:
        try:
            known: int = self._hash
        except AttributeError:
            known = hash(fields(self))
            object.__setattr__(self, "_hash", known)
        return known

    def state(self: Any) -> dict[str, object]:
        """What is pickled: all but what is remembered; another process would compute another hash."""
        return {name: value for name, value in self.__dict__.items() if name[0] != "_"}

    def equals(self: Any, other: object) -> bool:
        """Structural, but settled at once for the same object and for different hashes."""
        if self is other:
            return True
        if type(self) is not type(other) or hash(self) != hash(other):
            return False
        return bool(fields(self) == fields(other))

    made.__eq__ = equals  # type: ignore[method-assign]
    made.REMEMBERS = True  # type: ignore[attr-defined]  # its digest, too (runtime.canonical)
    made.__getstate__ = state  # type: ignore[method-assign]
    made.__hash__ = remembered  # type: ignore[method-assign]
    return made


def _fields(cls: type) -> Callable[[Any], object]:
    """A function that gives the values of all fields of an instance, as a tuple."""
    names = tuple(cls.__annotations__)
    if len(names) < 2:  # attrgetter gives one value as it is, and does not take none
        return lambda of: tuple([getattr(of, name) for name in names])
    return attrgetter(*names)


def once(fact: Callable[[N], T]) -> Callable[[N], T]:
    """``fact`` of a node, worked out once per object. It must depend on nothing but the node."""
    key = f"_{fact.__module__}.{fact.__name__}"

    @wraps(fact)
    def known(of: N) -> T:
        kept = getattr(of, key, _UNKNOWN)
        if kept is _UNKNOWN:
            kept = fact(of)
            object.__setattr__(of, key, _ITSELF if kept is of else kept)
        found: T = of if kept is _ITSELF else kept  # type: ignore[assignment]
        return found

    return known
