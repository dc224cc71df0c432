"""Frozen dataclasses that are made when they are used are those of the standard library."""

import copy
import dataclasses
import inspect
import pickle
import pkgutil
import threading
from collections.abc import Callable
from dataclasses import FrozenInstanceError, field, fields, replace
from importlib import import_module
from typing import Any, ClassVar, Generic, TypeVar

import pytest

import roadproof
from roadproof.runtime import records
from roadproof.runtime.records import dataclass

T = TypeVar("T")
Decorator = Callable[..., Callable[[type], type]]


def family(dataclass: Decorator) -> dict[str, type]:
    """Classes that inherit fields, in every way that roadproof has them."""

    @dataclass(frozen=True)
    class Base:
        """Has a text of its own."""

        first: int
        kind: ClassVar[str] = "base"
        second: "str" = field(default="two", compare=False, repr=False, metadata={"note": 2})

    @dataclass(frozen=True)
    class Child(Base):
        second: str = "other"
        third: tuple[int, ...] = field(default_factory=tuple)
        kind: ClassVar[str] = "child"

        def __post_init__(self) -> None:
            if self.first < 0:
                raise ValueError("negative")

    @dataclass(frozen=True, kw_only=True)
    class Named(Base):
        fourth: float = 4.0

        @property
        def doubled(self) -> float:
            return 2 * self.fourth

    @dataclass(frozen=True, repr=False)
    class Silent(Generic[T]):
        of: T

        def __hash__(self) -> int:
            return 5

    @dataclass(frozen=True, eq=False)
    class Alone:
        first: int = 1

        def __repr__(self) -> str:
            return "alone"

    class Plain(Child):
        def __init__(self, first: int) -> None:
            super().__init__(first, "plain")

    return {x.__name__: x for x in (Base, Child, Named, Silent, Alone, Plain)}


OURS, THEIRS = family(dataclass), family(dataclasses.dataclass)
MADE: dict[str, list[Callable[[type], object]]] = {
    "Base": [lambda x: x(1), lambda x: x(1, "2"), lambda x: x(first=2)],
    "Child": [lambda x: x(1), lambda x: x(1, "a", (3,)), lambda x: x(third=(), first=1)],
    "Named": [lambda x: x(1), lambda x: x(1, fourth=2.5), lambda x: x(1, "b")],
    "Silent": [lambda x: x(1), lambda x: x("a")],
    "Alone": [lambda x: x(), lambda x: x(3)],
    "Plain": [lambda x: x(1), lambda x: x(2)],
}


@pytest.mark.parametrize("name", MADE)
def test_classes_are_those_of_the_standard_library(name: str) -> None:
    ours, theirs = OURS[name], THEIRS[name]
    assert inspect.signature(ours) == inspect.signature(theirs)
    assert ours.__match_args__ == theirs.__match_args__
    told = [[(x.name, x.type, x.default, x.kw_only, x.metadata) for x in fields(y)] for y in (ours, theirs)]
    assert told[0] == told[1]
    assert ours.__init__.__qualname__ == theirs.__init__.__qualname__
    assert getattr(ours, "kind", "") == getattr(theirs, "kind", "")
    assert getattr(ours, "second", "") == getattr(theirs, "second", "")


@pytest.mark.parametrize("name", MADE)
def test_instances_are_those_of_the_standard_library(name: str) -> None:
    mine, others = ([make(x[name]) for make in MADE[name]] for x in (OURS, THEIRS))
    if name != "Silent":
        assert [repr(x) for x in mine] == [repr(x).replace("THEIRS", "OURS") for x in others]
    assert [x == y for x in mine for y in mine] == [x == y for x in others for y in others]
    if name != "Alone":
        assert [hash(x) for x in mine] == [hash(x) for x in others]
    assert mine[0] != others[0]
    assert [vars(x) for x in mine] == [vars(x) for x in others]
    assert vars(copy.copy(mine[0])) == vars(copy.deepcopy(mine[0])) == vars(mine[0])


def test_instances_do_not_change() -> None:
    for made in (OURS["Child"](1), OURS["Plain"](1)):
        with pytest.raises(FrozenInstanceError, match="cannot assign to field 'first'"):
            made.first = 2
        with pytest.raises(FrozenInstanceError, match="cannot delete field 'third'"):
            del made.third
    with pytest.raises(FrozenInstanceError):
        OURS["Child"](1).another = 2
    plain = OURS["Plain"](1)
    plain.another = 2  # as with the standard library: the class has no decorator
    assert plain.another == 2
    del plain.another


def test_mistakes_are_those_of_the_standard_library() -> None:
    for family_of in (OURS, THEIRS):
        with pytest.raises(TypeError, match="missing 1 required positional argument: 'first'"):
            family_of["Base"]()
        with pytest.raises(ValueError, match="negative"):
            family_of["Child"](-1)
        with pytest.raises(ValueError, match="negative"):
            replace(family_of["Child"](1), first=-1)
    with pytest.raises(ValueError, match="mutable default"):
        fields(dataclass(frozen=True)(type("Wrong", (), {"__annotations__": {"x": list}, "x": []})))


@dataclass(frozen=True)
class Kept:
    """Of this class no instance is made before one comes out of a pickle."""

    first: int
    second: int = 2


def test_instances_out_of_a_pickle_are_whole() -> None:
    found = object.__new__(Kept)
    vars(found).update(first=1, second=3)
    match pickle.loads(pickle.dumps(found)):
        case Kept(first, second):
            assert (first, second) == (1, 3)
        case _:
            pytest.fail("it has places")
    with pytest.raises(FrozenInstanceError):
        found.first = 2  # type: ignore[misc]
    assert found == pickle.loads(pickle.dumps(Kept(1, 3)))


def test_nothing_is_made_before_it_is_used() -> None:
    late = family(dataclass)
    pending = {name for name, x in vars(late["Child"]).items() if isinstance(x, records._Pending)}
    assert pending >= {"__init__", "__repr__", "__eq__", "__hash__", "__dataclass_fields__"}
    assert late["Child"](1).first == 1
    left = {name for name, x in vars(late["Child"]).items() if isinstance(x, records._Pending)}
    assert {"__repr__", "__eq__"} <= left
    assert "__init__" not in left
    assert inspect.isfunction(vars(late["Child"])["__init__"])


def test_a_class_of_the_standard_library_may_inherit() -> None:
    @dataclasses.dataclass(frozen=True)
    class Grandchild(family(dataclass)["Child"]):  # type: ignore[misc]
        fifth: int = 5

    assert repr(Grandchild(1)).endswith("Grandchild(first=1, second='other', third=(), fifth=5)")


def test_threads_may_use_a_class_at_once() -> None:
    for _ in range(30):
        late, met, found = family(dataclass)["Child"], threading.Barrier(8), list[Any]()

        def use(late: type = late, met: threading.Barrier = met, found: list[Any] = found) -> None:
            met.wait()
            found.append((hash(late(1)), repr(late(1)), late(1) == late(1)))

        threads = [threading.Thread(target=use) for _ in range(8)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        assert len(found) == 8
        assert len({*found}) == 1


def test_every_class_can_be_made() -> None:
    """What ``dataclasses.dataclass`` refuses is refused at the first use, which is here."""
    count = 0
    for module in pkgutil.walk_packages(roadproof.__path__, "roadproof."):
        if not module.name.endswith("__main__"):
            for value in [*vars(import_module(module.name)).values()]:
                if isinstance(value, type) and value.__module__ == module.name:
                    names = [x for x, y in vars(value).items() if isinstance(y, records._Pending)]
                    assert all(getattr(value, name) is not None for name in names)
                    count += bool(names)
    assert count > 100
