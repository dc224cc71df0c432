"""Flags of the command line, made from settings classes."""

import argparse
import functools
import shlex
from collections.abc import Callable, Iterable, Mapping
from typing import Any, TypeVar

from roadproof.errors import UsageError
from roadproof.frontends.settings.option import Group, Option, Settings

TITLES: dict[Group, str] = {
    "question": "question",
    "definitions": "definitions",
    "search": "search",
    "effort": "limits of work",
    "work": "parallel work",
    "output": "output",
}
_RARE = "rare"
A = TypeVar("A")


def add_flags(parser: argparse.ArgumentParser, settings: type[Settings]) -> None:
    """The flags of a question, in groups."""
    for name, option in sorted(settings.options().items(), key=lambda x: x[1].last):
        if option.flag is not None:
            rules = {"dest": name, "help": option.help, **_rules(settings, name, option)}
            flag = section(parser, option.group).add_argument(option.flag, **rules)
            if option.rare:
                mark_rare(flag)


def section(parser: argparse.ArgumentParser, group: Group) -> argparse._ArgumentGroup:
    """The group of flags in the help of a command. Groups come in the order of ``TITLES``."""
    found = {x.title: x for x in parser._action_groups}
    for title in TITLES.values():
        if title not in found:
            found[title] = parser.add_argument_group(title)
    return found[TITLES[group]]


def mark_rare(flag: argparse.Action) -> None:
    """Leave a flag out of ``--help``; ``--help-all`` shows it."""
    vars(flag)[_RARE] = True


def is_rare(flag: argparse.Action) -> bool:
    """Whether only ``--help-all`` shows a flag."""
    return _RARE in vars(flag)


def _rules(settings: type[Settings], name: str, option: Option) -> dict[str, Any]:
    default = getattr(settings, name)
    if isinstance(default, bool):
        return {"action": "store_false" if default else "store_true"}
    rules = {
        "metavar": option.metavar,
        "type": None if option.read is None else _naming(option, option.read),
        "choices": option.choices,
        "default": default,
        "required": option.required or None,
    }
    if option.gather is not None:
        rules |= {"action": "append", "default": None}
    return {key: value for key, value in rules.items() if value is not None}


def _naming(option: Option, made: Callable[[A], object]) -> Callable[[A], object]:
    """As ``made``, whose ``UsageError`` then begins with the flag."""

    @functools.wraps(made)
    def read(given: A) -> object:
        try:
            return made(given)
        except UsageError as error:
            raise UsageError(f"{option.flag} {error}") from None

    return read


def read_keywords(args: argparse.Namespace, settings: type[Settings]) -> Any:
    """The keyword arguments that the flags of a question give."""
    named = (name for name, option in settings.options().items() if option.flag and option.keyword)
    return {name: read_flag(args, settings, name) for name in named}


def read_flag(args: argparse.Namespace, settings: type[Settings], name: str) -> Any:
    """The value that a flag gives to the field ``name``."""
    value, option = getattr(args, name), settings.options()[name]
    if option.gather is None:
        return value
    return getattr(settings, name) if value is None else _naming(option, option.gather)(value)


def flags_of(settings: Settings) -> list[str]:
    """The words of a command line that give the same settings: every flag whose value is no default."""
    words: list[str] = []
    for name, option in settings.options().items():
        value = getattr(settings, name)
        if option.flag is None or value == getattr(type(settings), name):
            continue
        if isinstance(value, bool):
            words.append(option.flag)
        elif option.gather is not None:
            words += [word for text in _items(value) for word in (option.flag, text)]
        else:
            words += [option.flag, ",".join(_items(value)) or "none"]
    return words


def command_line(name: str, arguments: Iterable[str], *asked: Settings) -> str:
    """The command line of a question: its arguments, then the flags of settings, one after the other."""
    return shlex.join(["roadproof", name, *arguments, *(word for x in asked for word in flags_of(x))])


def _items(value: object) -> list[str]:
    """The texts behind a flag: several where it may be repeated, or has commas."""
    match value:
        case float():
            return [f"{value:g}"]
        case Mapping():
            return [f"{name}={x}" if name else str(x) for name, x in value.items()]
        case list() | tuple():
            return [str(x) for x in value]
        case _:
            return [str(value)]
