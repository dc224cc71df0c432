"""A replacement of ``dataclasses.dataclass`` that compiles methods at their first use.

``dataclasses.dataclass`` compiles six functions for each class, in about 0.3 ms. A command imports hundreds
of classes and uses few methods of few of them. This decorator puts a ``_Pending`` where a method will be. At
the first use the standard library makes the method, and the class then has what ``dataclasses.dataclass``
gives it. Only ``__init__`` is compiled here: the standard library compiles two more methods with it, in five
times the time.
"""

import dataclasses
import sys
import threading
from collections.abc import Callable, Mapping
from copy import copy
from typing import TYPE_CHECKING, Any, cast

_RULES = {"frozen", "kw_only", "eq", "repr"}  # classes with other rules are compiled at once
_NOTHING = {"init": False, "repr": False, "eq": False}
_FIELDS = ("__dataclass_fields__", "__match_args__")
_REPLACE = ("__replace__",) if sys.version_info >= (3, 13) else ()
_LOCK = threading.RLock()  # making a class may make its bases

if TYPE_CHECKING:
    from dataclasses import dataclass as dataclass
else:

    def dataclass(cls: type | None = None, /, **rules: bool) -> object:
        """Replace ``dataclasses.dataclass``; subclasses do not inherit an ``InitVar``."""
        if cls is None:
            return lambda decorated: dataclass(decorated, **rules)
        if not rules.get("frozen") or not rules.keys() <= _RULES or "__eq__" in vars(cls):
            return dataclasses.dataclass(**rules)(cls)
        _postpone(cls, rules)
        return cls


class _Part:
    """Attributes that a class will have, and the rules by which the standard library makes them."""

    def __init__(
        self, cls: type, declared: Mapping[str, object], names: tuple[str, ...], **rules: bool
    ) -> None:
        self.cls, self.declared, self.rules = cls, declared, rules
        self.left = [name for name in names if name not in vars(cls)]
        for name in self.left:
            setattr(cls, name, _Pending(self, name))

    def make(self) -> None:
        """Make the attributes, on a class with the same fields and without bases.

        Each replaces its ``_Pending`` at once, so no other thread sees the class without it.
        """
        with _LOCK:
            if self.left:
                made = _initializer(self.cls) if "__init__" in self.left else None
                attributes = self._made_by_twin() if made is None else {"__init__": made}
                for name in self.left:
                    setattr(self.cls, name, attributes[name])
                self.left = []

    def _made_by_twin(self) -> Mapping[str, object]:
        make: Callable[[type], type] = dataclasses.dataclass(**self.rules)
        return vars(make(_without_bases(self.cls, self.declared)))


class _Pending:
    """A descriptor in place of an attribute; a look-up makes the attribute and returns it."""

    def __init__(self, part: _Part, name: str) -> None:
        self.part, self.name = part, name

    def __get__(self, instance: object, owner: type | None = None) -> Any:
        self.part.make()
        attribute = vars(self.part.cls)[self.name]
        bind = getattr(type(attribute), "__get__", None)
        return attribute if bind is None else bind(attribute, instance, owner)


def _postpone(cls: type, rules: Mapping[str, bool]) -> None:
    declared = {name: value for name, value in vars(cls).items() if isinstance(value, dataclasses.Field)}
    for name, value in declared.items():
        if value.default is dataclasses.MISSING:
            delattr(cls, name)
        else:
            setattr(cls, name, value.default)
    only = _NOTHING | {"kw_only": rules.get("kw_only", False)}
    _Part(cls, declared, (*_FIELDS, *_REPLACE), **only)
    _Part(cls, declared, ("__dataclass_params__",), **rules)
    _Part(cls, declared, ("__init__",), **only | {"init": True, "frozen": True})
    if rules.get("repr", True):
        _Part(cls, declared, ("__repr__",), **only | {"repr": True})
    if rules.get("eq", True):
        _Part(cls, declared, ("__eq__", "__hash__"), **only | {"eq": True, "unsafe_hash": True})
    _freeze(cls)


def _without_bases(cls: type, declared: Mapping[str, object]) -> type:
    """Return a class of the same name without bases, with the fields of ``cls`` and its bases in order."""
    types, values = dict[str, object](), dict[str, object]()
    for base in cls.__mro__[-1:0:-1]:
        if dataclasses.is_dataclass(base):
            types |= {field.name: field.type for field in dataclasses.fields(base)}
            values |= {field.name: copy(field) for field in dataclasses.fields(base)}
    for name, kind in cls.__annotations__.items():
        types[name], values[name] = kind, declared.get(name, getattr(cls, name, dataclasses.MISSING))
    namespace = {name: value for name, value in values.items() if value is not dataclasses.MISSING}
    about = {"__module__": cls.__module__, "__qualname__": cls.__qualname__, "__doc__": cls.__doc__ or "-"}
    if hasattr(cls, "__post_init__"):
        namespace["__post_init__"] = cls.__post_init__
    return type(cls.__name__, (), {**about, **namespace, "__annotations__": types})


def _initializer(cls: Any) -> object | None:
    """Return ``__init__`` for a class; None if a field has a factory or is no argument."""
    fields = sorted(dataclasses.fields(cls), key=lambda x: x.kw_only is True)
    if any(x.default_factory is not dataclasses.MISSING or not x.init for x in fields):
        return None
    parameters, body = list[str](), [f"set_(self, {x.name!r}, {x.name})" for x in fields]
    for place, x in enumerate(fields):
        if x.kw_only and not (place and fields[place - 1].kw_only):
            parameters.append("*")
        is_required = x.default is dataclasses.MISSING
        parameters.append(x.name if is_required else f"{x.name}=defaults_[{place}]")
    if hasattr(cls, "__post_init__"):
        body.append("self.__post_init__()")
    lines = "\n  ".join(body) or "pass"
    arguments = ", ".join(("self", *parameters))
    source = f"def make_(set_, defaults_):\n def __init__({arguments}):\n  {lines}\n return __init__"
    namespace: dict[str, Callable[..., Any]] = {}
    exec(source, {"__name__": cls.__module__}, namespace)
    (make,) = namespace.values()
    initializer = make(object.__setattr__, [x.default for x in fields])
    initializer.__qualname__ = f"{cls.__qualname__}.__init__"
    initializer.__annotations__ = {x.name: x.type for x in fields} | {"return": None}
    return cast(object, initializer)


def _freeze(cls: type) -> None:
    """Make instances refuse changes, as those of a frozen dataclass do."""

    def refuse(self: object, name: str, does: str) -> None:
        if type(self) is cls or (dataclasses.is_dataclass(cls) and name in cls.__dataclass_fields__):
            raise dataclasses.FrozenInstanceError(f"cannot {does} field {name!r}")

    def set_attribute(self: object, name: str, value: object) -> None:
        refuse(self, name, "assign to")
        object.__setattr__(self, name, value)

    def delete_attribute(self: object, name: str) -> None:
        refuse(self, name, "delete")
        object.__delattr__(self, name)

    cls.__setattr__ = set_attribute  # type: ignore[assignment]
    cls.__delattr__ = delete_attribute  # type: ignore[assignment]
