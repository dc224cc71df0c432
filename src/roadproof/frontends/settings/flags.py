"""Flags of the command line, made from settings classes."""

import argparse
import functools
from collections.abc import Callable
from typing import Any

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


def add_flags(parser: argparse.ArgumentParser, settings: type[Settings]) -> None:
    """The flags of a question, in groups."""
    for name, option in settings.options().items():
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
        "type": _reader(option),
        "choices": option.choices,
        "default": default,
    }
    rules |= {"required": option.required or None}
    if option.gather is not None:
        rules |= {"action": "append", "default": None}
    return {key: value for key, value in rules.items() if value is not None}


def _reader(option: Option) -> Callable[[str], object] | None:
    """The reader of an option; its ``UsageError`` begins with the flag."""
    if option.read is None:
        return None
    made = option.read

    @functools.wraps(made)
    def read(text: str) -> object:
        try:
            return made(text)
        except UsageError as error:
            raise UsageError(f"{option.flag} {error}") from None

    return read


def read_keywords(args: argparse.Namespace, settings: type[Settings]) -> Any:
    """The keyword arguments that the flags of a question give."""
    found = {}
    for name, option in settings.options().items():
        if option.flag and option.keyword:
            value = getattr(args, name)
            if option.gather is not None:
                value = getattr(settings, name) if value is None else option.gather(value)
            found[name] = value
    return found
