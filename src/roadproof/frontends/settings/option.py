"""Settings classes: what each field says of its option, and functions that take them as keywords."""

import argparse
import dataclasses
import inspect
import os
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from difflib import get_close_matches
from functools import partial
from numbers import Integral, Real
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, Self, TypeAlias, TypeVar

from roadproof.errors import UsageError
from roadproof.extension import extension_error, import_entry, named_entries, owner_of
from roadproof.runtime.records import dataclass

if TYPE_CHECKING:
    from roadproof.evidence.answer import ClaimAnswer
    from roadproof.frontends.api.definitions import Among, Definitions, What
    from roadproof.questions.question import Answers, Question

F = TypeVar("F", bound=Callable[..., object])
S = TypeVar("S", bound="Settings")
Group: TypeAlias = Literal["question", "definitions", "search", "effort", "work", "output"]


@dataclass(frozen=True)
class Option:
    """One option. Without ``flag`` it exists in Python only, without ``keyword`` on the command line only."""

    flag: str | None
    metavar: str | None
    help: str = ""
    group: Group = "question"
    read: Callable[[str], object] | None = None
    """Makes the value out of the text behind the flag."""
    gather: Callable[[list[Any]], object] | None = None
    """The flag may be repeated, and this makes the value out of what was read."""
    choices: tuple[str, ...] | None = None
    checked: bool = True
    """Settings compare values with ``choices``; otherwise the question does."""
    least: int | None = None
    keyword: bool = True
    required: bool = False
    rare: bool = False
    """Only ``--help-all`` shows the flag."""
    last: bool = False
    """The flag is the last one of its group."""

    def check(self, name: str, value: object) -> None:
        """Raises ``UsageError`` where a Python caller gives a value that is not allowed."""
        if self.checked and self.choices is not None and value not in self.choices:
            raise UsageError(f"{name}={value!r}: write {' or '.join(map(repr, self.choices))}")
        if self.metavar == "DIR" and isinstance(value, str) and not value:
            raise UsageError(f"{name}='': write the path of a folder, such as . for the current one")
        if self.least is not None and not (isinstance(value, Integral) and int(value) >= self.least):
            raise UsageError(f"{name}={value!r}: write a whole number greater than {self.least - 1}")


def option(default: object, flag: str = "", help: str = "", **rules: Any) -> Any:
    """A field of settings. ``flag`` has its metavar: "--out DIR"; ``rules``: the rest of ``Option``."""
    name, _, metavar = flag.partition(" ")
    made = Option(name or None, metavar or None, help, **rules)
    return dataclasses.field(default=default, metadata={"option": made})


search = partial(option, group="search")
"""An option of where and how drives are looked for."""
output = partial(option, group="output")
"""An option of what is written."""
definition = partial(option, group="definitions", keyword=False)
"""An option of the definitions; from Python they are given by ``using``."""
work = partial(option, group="work", keyword=False, rare=True)
"""An option of parallel work; from Python ``jobs`` says this."""


@dataclass(frozen=True, kw_only=True)
class Settings:
    """The options of a question. Each subclass is frozen, and each of its fields is made by ``option``."""

    @classmethod
    def options(cls) -> dict[str, Option]:
        """The options by the names of the fields."""
        return {x.name: x.metadata["option"] for x in dataclasses.fields(cls)}

    def modified(
        self, home: "Definitions", among: "Among" = None, what: "Sequence[What] | None" = None
    ) -> "Definitions":
        """Return the definitions that the question is asked in; options of extensions may change them.

        ``among`` or ``what``: the scenarios, or scenarios and formulas, that are asked for.
        """
        return home

    def given_answers(self, question: "Question[Any]") -> "Mapping[str, ClaimAnswer]":
        """Return answers by the name of their claim that are given, so that nothing is computed.

        Options of extensions may read them; there are none without.
        """
        return {}

    def remarks(self, question: "Question[Any]", answers: "Answers") -> tuple[str, ...]:
        """Return lines about answers that options of extensions ask for."""
        return ()

    @classmethod
    def with_files(cls, args: argparse.Namespace, files: list[Path]) -> list[Path]:
        """Return specification files with those that flags of extensions need."""
        return files

    @classmethod
    def of(cls, given: Mapping[str, object]) -> Self:
        """The settings that keyword arguments give. Raises ``TypeError``, ``UsageError``."""
        known, kinds = cls.options(), _kinds_of(cls)
        for name, value in given.items():
            if name not in known or not known[name].keyword:
                near = get_close_matches(name, [x for x in known if known[x].keyword], n=1)
                hint = f"; did you mean {near[0]!r}?" if near else ""
                function = function_of(cls)
                raise TypeError(f"{function}() got an unexpected keyword argument {name!r}{hint}")
            if value is not getattr(cls, name):
                known[name].check(name, value)
                if kinds[name] and not any(kind.fits(value) for kind in kinds[name]):
                    shown = repr(value)[:60]
                    advice = " or ".join(kind.told.format(name=name, value=shown) for kind in kinds[name])
                    raise UsageError(f"{name}={shown}: write {advice}")
        return cls(**given)


def stem_of(settings: type[Settings]) -> str:
    """Return the name of a class without the ending ``Settings``: its function or group of options."""
    return settings.__name__.removesuffix("Settings")


def function_of(settings: type[Settings]) -> str:
    """Return the name of the function whose options a class has: ``online_monitor`` of OnlineMonitor."""
    return re.sub("(?<=[a-z])(?=[A-Z])", "_", stem_of(settings)).lower()


def extensible(command: str) -> Callable[[type[S]], type[S]]:
    """Adds the options to the settings of a command that extensions have for it."""

    def extended(settings: type[S]) -> type[S]:
        """Return the class with the options of extensions."""
        more: list[type[Settings]] = []
        for entry in named_entries("options", command):
            added: type[Settings] = import_entry(entry)
            bases: tuple[type[Settings], ...] = (settings, *more)
            for former in bases:
                _check_new(added, former, entry, command)
            more.append(added)
        if not more:
            return settings
        about: dict[str, Any] = {
            "__doc__": settings.__doc__,
            "__module__": settings.__module__,
            "__annotations__": {},
        }
        made: type[S] = dataclass(frozen=True, kw_only=True)(
            type(settings.__name__, (settings, *more), about)
        )
        return made

    return extended


def _check_new(added: type[Settings], former: type[Settings], entry: str, command: str) -> None:
    """Raise ``InputError`` where options that an extension adds to a command have a name that it has."""
    known = former.options()
    flags = {x.flag for x in known.values()} - {None}
    for name, option in added.options().items():
        if known.get(name) is not option and (name in known or option.flag in flags):
            raise extension_error(
                owner_of(entry), f"options={command!r}: {option.flag or name} of {entry} is there already"
            )


class _Kind(NamedTuple):
    """A kind of values: a test of a value, and how to write one."""

    fits: Callable[[object], bool]
    told: str


_LIST = _Kind(
    lambda x: isinstance(x, Iterable) and not isinstance(x, str | bytes | Mapping),
    "a list, such as {name}=[{value}]",
)
_KINDS: Mapping[str, _Kind] = {
    "Mapping": _Kind(lambda x: isinstance(x, Mapping), "a mapping of names to values"),
    "Iterable": _LIST,
    "Sequence": _LIST,
    "tuple": _LIST,
    "bool": _Kind(lambda x: isinstance(x, bool), "True or False"),
    "int": _Kind(lambda x: isinstance(x, Integral) and not isinstance(x, bool), "a whole number"),
    "float": _Kind(lambda x: isinstance(x, Real) and not isinstance(x, bool), "a number"),
    "str": _Kind(lambda x: isinstance(x, str), "a text"),
    "Path": _Kind(lambda x: isinstance(x, os.PathLike), "a path"),
}
"""The kinds of values by the name of their type; values of other types are checked where they are read."""


def _kinds_of(settings: type[Settings]) -> dict[str, tuple[_Kind, ...]]:
    """The kinds of values that each option takes; none where some of its types are checked elsewhere."""
    made: dict[str, tuple[_Kind, ...]] = {}
    for x in dataclasses.fields(settings):
        written = x.type.__name__ if isinstance(x.type, type) else str(x.type)
        names = [y.strip().rpartition(".")[2] for y in re.sub(r"\[.*\]", "", written).split("|")]
        kinds = tuple(_KINDS[name] for name in names if name in _KINDS)
        made[x.name] = kinds if len(kinds) == len([y for y in names if y != "None"]) else ()
    return made


def takes(settings: type[Settings]) -> Callable[[F], F]:
    """Marks a function whose ``**options`` are those of ``settings``."""

    def show(function: F) -> F:
        """Set the signature of the function to all its options."""
        kinds, options = inspect.Parameter, settings.options()
        signature = inspect.signature(function)
        own = [x for x in signature.parameters.values() if x.kind is not kinds.VAR_KEYWORD]
        more = [
            kinds(x.name, kinds.KEYWORD_ONLY, default=x.default, annotation=x.type)
            for x in dataclasses.fields(settings)
            if options[x.name].keyword
        ]
        vars(function).update(__signature__=signature.replace(parameters=[*own, *more]))
        return function

    return show
