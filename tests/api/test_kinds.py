"""A keyword argument of another kind than its option takes is refused by its name, before any work."""

import dataclasses
import re
from fractions import Fraction
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path

import pytest

import roadproof as rp
from roadproof.errors import UsageError
from roadproof.extension import installed_extensions
from roadproof.frontends.settings.option import Settings

VALUES = (None, True, 3, 0.5, Fraction(1, 3), "text", Path("p"), ("a",), ["a"], {"a": "b"}, object())
ALLOWED = {
    "Mapping": (dict,),
    "Iterable": (tuple, list),
    "Sequence": (tuple, list),
    "tuple": (tuple, list),
    "bool": (bool,),
    "int": (int,),
    "float": (int, float, Fraction),
    "str": (str,),
    "Path": (Path,),
    "None": (type(None),),
}


def settings() -> list[type[Settings]]:
    """The classes of options of the core and of all extensions."""
    import_module("roadproof.frontends.settings.questions")
    for x in installed_extensions().values():
        if find_spec(f"{x.package}.settings") is not None:
            import_module(f"{x.package}.settings")
    found, waiting = [], [Settings]
    while waiting:
        waiting += (cls := waiting.pop()).__subclasses__()
        found.append(cls)
    return found


def kinds_of(field: dataclasses.Field) -> tuple[str, ...]:
    """The names of the types in the annotation of a field, without what is in brackets."""
    text = field.type.__name__ if isinstance(field.type, type) else str(field.type)
    while "[" in text:
        text = re.sub(r"\[[^\[\]]*\]", "", text)
    return tuple(x.strip().rpartition(".")[2] for x in text.split("|"))


CASES = [
    (cls, x.name, kinds)
    for cls in settings()
    for x in dataclasses.fields(cls)
    if cls.options()[x.name].keyword and {*(kinds := kinds_of(x))} <= {*ALLOWED}
]


@pytest.mark.parametrize("cls", {x: None for x, _, _ in CASES}, ids=lambda x: x.__name__)
def test_a_value_of_another_kind_is_refused(cls: type[Settings]) -> None:
    for name, kinds in ((x, y) for z, x, y in CASES if z is cls):
        allowed = tuple(y for kind in kinds for y in ALLOWED[kind])
        for value in VALUES:
            fits = isinstance(value, allowed) and not (isinstance(value, bool) and bool not in allowed)
            if not fits and value is not getattr(cls, name):
                with pytest.raises(UsageError, match=f"{name}="):
                    cls.of({name: value})


def test_what_is_refused_says_what_to_write() -> None:
    assert len(CASES) > 60
    with pytest.raises(UsageError, match="lanes='main-2': write a mapping of names to values"):
        rp.witness(4, lanes="main-2")
    with pytest.raises(UsageError, match="effort='x': write a number"):
        rp.prove("P2", effort="x")
