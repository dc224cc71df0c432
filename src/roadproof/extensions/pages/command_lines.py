"""Command lines that ask the questions of pages again."""

import shlex
from collections.abc import Iterable, Mapping

from roadproof.frontends.settings.option import Settings


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


def command_line(name: str, arguments: Iterable[str], *settings: Settings) -> str:
    """The command line of a question: its arguments, then the flags of settings, one after the other."""
    return shlex.join(["roadproof", name, *arguments, *(word for x in settings for word in flags_of(x))])


def _items(value: object) -> list[str]:
    """The texts behind a flag: several where it may be repeated, or has commas."""
    match value:
        case float():
            return [f"{value:g}"]
        case Mapping():
            return [f"{name}={x}" if name else str(x) for name, x in value.items()]
        case list() | tuple():
            return [str(x) for x in value]
        case _:  # open: any value of an option
            return [str(value)]
