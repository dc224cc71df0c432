"""Flags of the command line, made from settings classes."""

import argparse
from typing import Any

from roadproof.frontends.settings.option import Group, Option, Settings

TITLES: dict[Group, str] = {
    "question": "question",
    "search": "search",
    "effort": "limits of work",
    "work": "parallel work",
    "output": "output",
}


def add_flags(parser: argparse.ArgumentParser, settings: type[Settings]) -> None:
    """The flags of a question, in groups."""
    options = settings.options()
    for group, title in TITLES.items():
        section = parser.add_argument_group(title)
        for name, option in options.items():
            if option.group == group and option.flag is not None:
                section.add_argument(
                    option.flag, dest=name, help=option.help, **_rules(settings, name, option)
                )


def _rules(settings: type[Settings], name: str, option: Option) -> dict[str, Any]:
    default = getattr(settings, name)
    if isinstance(default, bool):
        return {"action": "store_false" if default else "store_true"}
    rules = {"metavar": option.metavar, "type": option.read, "choices": option.choices, "default": default}
    if option.gather is not None:
        rules["action"] = "append"
    return {key: value for key, value in rules.items() if value is not None}


def read_keywords(args: argparse.Namespace, settings: type[Settings]) -> Any:
    """The keyword arguments that the flags of a question give."""
    given = {name: option for name, option in settings.options().items() if option.flag and option.keyword}
    found = {name: getattr(args, name) for name in given}
    gathered = ((name, given[name].gather) for name, value in found.items() if value is not None)
    return found | {name: gather(found[name]) for name, gather in gathered if gather is not None}
