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
_FRAMES = re.compile(r"([0-9]{1,9})-([0-9]{1,9})")
MOST = 1_000_000
LARGEST_SEED = 2**64 - 1


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
        value = int(text) if _WHOLE.fullmatch(text) else least - 1
        if not least <= value <= most:
            rule = "greater than 0" if least == 1 else f"not below {least}"
            raise UsageError(f"{text[:40]}: write a whole number {rule} and at most {most}")
        return value

    return read


def seconds(text: str) -> Fraction:
    """A number greater than 0, such as 6, 0.6 or 3/5."""
    value = _fraction(text)
    if value is None or value <= 0:
        raise UsageError(f"{text[:40]}: write a number greater than 0, such as 6, 0.6 or 3/5")
    return value


def seconds_or_zero(text: str) -> Fraction:
    """A number of 0 or more."""
    value = _fraction(text)
    if value is None or value < 0:
        raise UsageError(f"{text[:40]}: write seconds, 0 or more, such as 6, 0.6 or 3/5")
    return value


def _fraction(text: str) -> Fraction | None:
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


def mapping_of(example: str) -> Callable[[str], dict[str, str]]:
    """A reader of ``NAME=VALUE`` pairs with commas between them; each name comes once."""

    def read(text: str) -> dict[str, str]:
        pairs = [[x.strip() for x in item.partition("=")[::2]] for item in text.split(",")]
        found = {name: value for name, value in pairs if name and value}
        if len(found) < len(pairs):
            raise UsageError(f"{text}: write NAME=VALUE with commas, each name once, such as {example}")
        return found

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
        items = [item.strip() for item in text.split(",")]
        if not all(items):
            raise UsageError(f"{text}: write {what} separated by commas{example}")
        return tuple(map(read, items))

    return read_items


def frame_range(text: str) -> tuple[int, int]:
    """A first and a last frame, such as 100-400."""
    found = _FRAMES.fullmatch(text)
    if found is None:
        raise UsageError(f"{text[:40]}: write the first and the last frame, such as 100-400")
    return int(found[1]), int(found[2])


def text_or_none(text: str) -> str | None:
    """The text, or None where it is empty."""
    return text or None


def initial_values(text: str) -> tuple[str, list[str]]:
    """``NAME=VALUE`` with one value or several, as a pair."""
    name, equals, value = text.partition("=")
    if not equals or not value.strip():
        example = "Ve0=60km/h,90km/h"
        raise UsageError(f"{text}: write NAME=VALUE, or several with commas, such as {example}")
    return name.strip(), [x.strip() for x in value.split(",")]


def driver_models_or_none(text: str) -> tuple[str, ...]:
    """Names of driver models with commas between them; none stands for no model."""
    return () if text == "none" else items_of("names", ", such as careful,r157, or none")(text)


def flat(lists: Iterable[Iterable[str]]) -> list[str]:
    """The texts of several lists in one."""
    return [text for texts in lists for text in texts]


def file_names(text: str) -> tuple[str, ...]:
    """Names of files or folders with commas between them."""
    return tuple(x for x in text.split(",") if x)


def formats_in(to: str | Iterable[str], known: Collection[str]) -> list[str]:
    """Formats by name, each once, from names with commas. Raises ``UsageError``."""
    texts = to.split(",") if isinstance(to, str) else [x for text in to for x in text.split(",")]
    names = list(dict.fromkeys(text.strip() for text in texts))
    from roadproof.library.specification import unknown  # most commands name no format

    for name in names:
        if name not in known:
            raise UsageError(unknown("format", name, known))
    if not names:
        raise UsageError(f"to: name a format: {', '.join(known)}")
    return names
