"""Readers of the texts behind flags; each raises ``UsageError`` by the name of its option."""

import re
from collections.abc import Callable, Iterable
from fractions import Fraction
from typing import Any

from roadproof.errors import UsageError

_DECIMAL = re.compile(r"[0-9]{1,12}(\.[0-9]{1,12})?")
_WHOLE = re.compile(r"[0-9]{1,20}")
_FRAMES = re.compile(r"([0-9]{1,9})-([0-9]{1,9})")
MOST = 1_000_000
LARGEST_SEED = 2**64 - 1


def decimal(option: str) -> Callable[[str], float]:
    """A reader of numbers greater than 0."""

    def read(text: str) -> float:
        value = float(text) if _DECIMAL.fullmatch(text) else 0.0
        if not 0 < value <= MOST:
            raise UsageError(
                f"{option} {text[:40]}: write a decimal number greater than 0 and at most {MOST}, such as 20"
            )
        return value

    return read


def whole(option: str, least: int, most: int = MOST) -> Callable[[str], int]:
    """A reader of whole numbers from ``least`` to ``most``."""

    def read(text: str) -> int:
        value = int(text) if _WHOLE.fullmatch(text) else least - 1
        if not least <= value <= most:
            rule = "greater than 0" if least == 1 else f"not below {least}"
            raise UsageError(f"{option} {text[:40]}: write a whole number {rule} and at most {most}")
        return value

    return read


def seconds(option: str, or_zero: bool = False) -> Callable[[str], Fraction]:
    """A reader of numbers greater than 0 (or 0 too), such as 6, 0.6 or 3/5."""
    return lambda text: read_seconds(option, text, or_zero)


def read_seconds(option: str, text: str, or_zero: bool = False) -> Fraction:
    """A time in seconds, greater than 0 (or 0 too). Raises ``UsageError``."""
    try:
        value = Fraction(text) if len(text) <= 40 and "e" not in text.lower() else None
    except (ValueError, ZeroDivisionError):
        value = None
    if value is None or value < 0 or (value == 0 and not or_zero):
        least = "seconds, 0 or more" if or_zero else "a number greater than 0"
        raise UsageError(f"{option} {text[:40]}: write {least}, such as 6, 0.6 or 3/5")
    return value


def named(usual: str) -> Callable[[str], tuple[str, str]]:
    """A reader of ``NAME=VALUE`` as a pair; the name is ``usual`` where none is given."""

    def read(text: str) -> tuple[str, str]:
        name, equals, value = text.rpartition("=")
        return (name if equals else usual), value

    return read


def items_of(
    option: str, what: str, example: str = "", read: Callable[[str], Any] = str
) -> Callable[[str], tuple[Any, ...]]:
    """A reader of items with commas between them; ``what`` are they?"""

    def read_items(text: str) -> tuple[Any, ...]:
        items = [item.strip() for item in text.split(",")]
        if not all(items):
            raise UsageError(f"{option} {text}: write {what} separated by commas{example}")
        return tuple(map(read, items))

    return read_items


def frame_range(option: str) -> Callable[[str], tuple[int, int]]:
    """A reader of a first and a last frame, such as 100-400."""

    def read(text: str) -> tuple[int, int]:
        found = _FRAMES.fullmatch(text)
        if found is None:
            raise UsageError(f"{option} {text[:40]}: write the first and the last frame, such as 100-400")
        return int(found[1]), int(found[2])

    return read


def text_or_none(text: str) -> str | None:
    """The text, or None where it is empty."""
    return text or None


def several(option: str, example: str) -> Callable[[str], tuple[str, list[str]]]:
    """A reader of ``NAME=VALUE`` with one value or several, as a pair."""

    def read(text: str) -> tuple[str, list[str]]:
        name, equals, value = text.partition("=")
        if not equals or not value.strip():
            raise UsageError(f"{option} {text}: write NAME=VALUE, or several with commas, such as {example}")
        return name.strip(), [x.strip() for x in value.split(",")]

    return read


def driver_models_or_none(option: str) -> Callable[[str], tuple[str, ...]]:
    """A reader of names of driver models with commas between them; none stands for no model."""
    read = items_of(option, "names", ", such as careful,r157, or none")
    return lambda text: () if text == "none" else read(text)


def flat(lists: Iterable[Iterable[str]]) -> list[str]:
    """The texts of several lists in one."""
    return [text for texts in lists for text in texts]
