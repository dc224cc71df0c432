"""Flags of the command line, made from settings classes."""

import argparse
import functools
from collections.abc import Callable
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
    groups = {x.title: x for x in parser._action_groups}
    for title in TITLES.values():
        if title not in groups:
            groups[title] = parser.add_argument_group(title)
    return groups[TITLES[group]]


def mark_rare(flag: argparse.Action) -> None:
    """Leave a flag out of ``--help``; ``--help-all`` shows it."""
    vars(flag)[_RARE] = True


def is_rare(flag: argparse.Action) -> bool:
    """Return whether only ``--help-all`` shows a flag."""
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
    """Return ``made`` with a ``UsageError`` that begins with the flag."""

    @functools.wraps(made)
    def read(given: A) -> object:
        """Read a value; errors begin with the flag."""
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
