"""Readers of the texts behind flags; ``flags.py`` puts the flag before the ``UsageError`` that they raise."""

import re
from argparse import ArgumentTypeError
from collections.abc import Callable, Collection, Iterable, Sequence
from fractions import Fraction
from pathlib import Path
from typing import Any

from roadproof.errors import UsageError

_DECIMAL = re.compile(r"[0-9]{1,12}(\.[0-9]{1,12})?")
_WHOLE = re.compile(r"[0-9]{1,20}")
MOST = 1_000_000


def decimal(text: str) -> float:
    """A number greater than 0."""
    value = float(text) if _DECIMAL.fullmatch(text) else 0.0
    if not 0 < value <= MOST:
        rule = f"write a decimal number greater than 0 and at most {MOST}, such as 20"
        raise UsageError(f"{text[:40]}: {rule}")
    return value


def whole(least: int, most: int = MOST) -> Callable[[str], int]:
    """A reader of whole numbers from ``least`` to ``most``."""

    def read(text: str) -> int:
        """Return the whole number of a text. Raises ``UsageError``."""
        value = int(text) if _WHOLE.fullmatch(text) else least - 1
        if not least <= value <= most:
            rule = "greater than 0" if least == 1 else f"not below {least}"
            raise UsageError(f"{text[:40]}: write a whole number {rule} and at most {most}")
        return value

    return read


def seconds(text: str) -> Fraction:
    """A number greater than 0, such as 6, 0.6 or 3/5."""
    value = fraction(text)
    if value is None or value <= 0:
        raise UsageError(f"{text[:40]}: write a number greater than 0, such as 6, 0.6 or 3/5")
    return value


def fraction(text: str) -> Fraction | None:
    """Return the number that a short text is, also a ratio; None where it is none."""
    try:
        return Fraction(text) if len(text) <= 40 and "e" not in text.lower() else None
    except (ValueError, ZeroDivisionError):
        return None


def named(usual: str) -> Callable[[str], tuple[str, str]]:
    """A reader of ``NAME=VALUE`` as a pair; the name is ``usual`` where none is given."""

    def read(text: str) -> tuple[str, str]:
        name, equals, value = text.rpartition("=")
        return (name if equals else usual), value

    return read


def folder(text: str) -> Path:
    """The path of a folder; an empty one, as of a variable that is not set, would be the current folder."""
    if not text:
        raise UsageError("'': write the path of a folder, such as . for the current one")
    return Path(text)


def file_name(text: str) -> str:
    """The name of a file, or - for stdout."""
    if not Path(text).name:
        raise ArgumentTypeError(f"'{text}' is not a file name")
    return text


def assignment(flag: str) -> Callable[[str], tuple[str, str]]:
    """A reader of ``NAME=VALUE`` as a pair, of which neither side is empty."""

    def read(text: str) -> tuple[str, str]:
        """Return the name and value of a text. Raises ``UsageError``."""
        name, equals, value = (part.strip() for part in text.partition("="))
        if not (name and equals and value):
            raise UsageError(f"{text}: write {flag} NAME=VALUE")
        return name, value

    return read


def set_names(texts: Sequence[str]) -> tuple[str, ...]:
    """The spec sets of ``--set``, which may be repeated and have commas."""
    names = tuple(name.strip() for text in texts for name in text.split(","))
    if not all(names):
        raise UsageError(f"{' '.join(texts)}: write names separated by commas, such as base,ext")
    return names


def items_of(
    what: str, example: str = "", read: Callable[[str], Any] = str
) -> Callable[[str], tuple[Any, ...]]:
    """A reader of items with commas between them; ``what`` are they?"""

    def read_items(text: str) -> tuple[Any, ...]:
        """Return the items of a text. Raises ``UsageError``."""
        items = [item.strip() for item in text.split(",")]
        if not all(items):
            raise UsageError(f"{text}: write {what} separated by commas{example}")
        return tuple(map(read, items))

    return read_items


def formats_in(to: str | Iterable[str], known: Collection[str]) -> list[str]:
    """Formats by name, each once, from names with commas. Raises ``UsageError``."""
    texts = to.split(",") if isinstance(to, str) else [x for text in to for x in text.split(",")]
    names = list(dict.fromkeys(text.strip() for text in texts))
    from roadproof.library.specification import unknown_name  # most commands name no format

    for name in names:
        if name not in known:
            raise UsageError(unknown_name("format", name, known))
    if not names:
        raise UsageError(f"to: name a format: {', '.join(known)}")
    return names
