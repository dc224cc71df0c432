"""Readers of the texts behind flags about recordings."""

import re
from collections.abc import Callable
from fractions import Fraction

from roadproof.errors import UsageError
from roadproof.frontends.settings.readers import fraction

_FRAMES = re.compile(r"([0-9]{1,9})-([0-9]{1,9})")
LARGEST_SEED = 2**64 - 1


def seconds_or_zero(text: str) -> Fraction:
    """A number of 0 or more."""
    value = fraction(text)
    if value is None or value < 0:
        raise UsageError(f"{text[:40]}: write seconds, 0 or more, such as 6, 0.6 or 3/5")
    return value


def mapping_of(example: str) -> Callable[[str], dict[str, str]]:
    """A reader of ``NAME=VALUE`` pairs with commas between them; each name comes once."""

    def read(text: str) -> dict[str, str]:
        """Return the pairs of a text by name. Raises ``UsageError``."""
        pairs = [[x.strip() for x in item.partition("=")[::2]] for item in text.split(",")]
        mapping = {name: value for name, value in pairs if name and value}
        if len(mapping) < len(pairs):
            raise UsageError(f"{text}: write NAME=VALUE with commas, each name once, such as {example}")
        return mapping

    return read


def frame_range(text: str) -> tuple[int, int]:
    """A first and a last frame, such as 100-400."""
    match = _FRAMES.fullmatch(text)
    if match is None:
        raise UsageError(f"{text[:40]}: write the first and the last frame, such as 100-400")
    return int(match[1]), int(match[2])
