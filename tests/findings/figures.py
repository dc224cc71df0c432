"""Figures in prose: where a page says them, and where the output of a command says them.

A pattern is text with ``{}`` for each figure; its spaces stand for any white space. One that is meant for
a page must occur there exactly once.
"""

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

WORDS = (
    "none",
    "one",
    "two",
    "three",
    "four",
    "five",
    "six",
    "seven",
    "eight",
    "nine",
    "ten",
    "eleven",
    "twelve",
)


@dataclass(frozen=True)
class Outcome:
    """What a command did: the text on stdout, the exit code, and the folder it ran in."""

    printed: str
    exit: int
    folder: Path


Source = str | Callable[[Outcome], object]


@dataclass(frozen=True)
class Figures:
    """Figures of a page: ``said`` is a pattern of the page; ``source`` a pattern of the output with as many
    ``{}``, or a function that gives the figure, or a tuple of them."""

    said: str
    source: Source


@dataclass(frozen=True)
class Statement:
    """Commands that are run one after the other, and what ``page`` says of what the last one does."""

    page: str
    commands: tuple[str, ...]
    figures: tuple[Figures, ...] = ()
    quick: bool = False  # asked in every run of the tests
    named: str = ""  # how the page names the last command, where it leaves something out
    data: str = ""  # the file with the figures, if the page shows them as a table of data


@dataclass(frozen=True)
class Picture:
    """A picture on a page; ``made`` gives the file that the commands write."""

    file: str
    commands: tuple[str, ...]
    made: Callable[[Outcome], str]


@dataclass(frozen=True)
class Place:
    """Where in a page's text a figure stands."""

    begin: int
    end: int


@dataclass(frozen=True)
class Difference:
    """``said`` at a place of a page, ``found`` in the output: what belongs there if it is ``mendable``."""

    said: str
    found: str
    place: Place = Place(0, 0)
    mendable: bool = False


def compare(figures: Figures, page: str, outcome: Outcome) -> Iterator[Difference]:
    """The differences between a page and what a command did."""
    matches = list(re.finditer(_regex(figures.said), page))
    if len(matches) != 1:
        yield Difference(figures.said, f"the page has this {len(matches)} times, instead of once")
        return
    values = _values(figures, outcome)
    groups = matches[0].groups()
    if values is None or len(values) != len(groups):
        yield Difference(matches[0][0], f"not in the output: {figures.source}", Place(*matches[0].span()))
        return
    for number, (said, value) in enumerate(zip(groups, values, strict=True), start=1):
        if normal(said) != normal(value):
            yield Difference(said, written_like(said, value), Place(*matches[0].span(number)), True)


def covered(figures: Figures, page: str) -> list[Place]:
    """Where the figures of the page stand."""
    matches = list(re.finditer(_regex(figures.said), page))
    return [Place(*m.span(k)) for m in matches for k in range(1, len(m.groups()) + 1)]


def _values(figures: Figures, outcome: Outcome) -> Sequence[str] | None:
    """The figures in the output; None where it does not have them, or has several."""
    if not isinstance(figures.source, str):
        found = figures.source(outcome)
        return [str(x) for x in found] if isinstance(found, tuple) else [str(found)]
    found_all = {m.groups() for m in re.finditer(_regex(figures.source), outcome.printed)}
    return found_all.pop() if len(found_all) == 1 else None


def _regex(pattern: str) -> str:
    """``{}`` is the least text in one line that lets the rest fit; at an end it is one word."""
    parts = [r"\s+".join(map(re.escape, re.split(r" +", part))) for part in pattern.split("{}")]
    result = parts[0]
    for number, part in enumerate(parts[1:], start=1):
        if number == 1 and not parts[0]:
            result += r"(?<!\S)(\S+)"
        elif number == len(parts) - 1 and not part:
            result += r"(\S+?)(?=[.,;:)]*(?:\s|$))"
        else:
            result += "(.+?)"
        result += part
    return result


def normal(figure: str) -> str:
    """The same for figures that say the same: 1,098 and 1098, two and 2, 'a and b' and 'a, b'."""
    plain = re.sub(r"(?<=\d),(?=\d{3}\b)", "", figure.strip()).replace(", and ", ", ").replace(" and ", ", ")
    word = plain.lower()
    return str(WORDS.index(word)) if word in WORDS else plain


def written_like(said: str, value: str) -> str:
    """``value`` in the hand of ``said``: as a word, with commas, with a last "and"."""
    if said.lower() in WORDS and value.isdigit() and int(value) < len(WORDS):
        word = WORDS[int(value)]
        return word.capitalize() if said[:1].isupper() else word
    if value.isdigit():
        return f"{int(value):,}"
    if " and " in said and ", " in value and " and " not in value:
        return " and ".join(value.rsplit(", ", 1))
    return value


def exits_said(page: str, command: str) -> list[tuple[int, Place]]:
    """The exit codes that the page says of a command, behind each place where it names it."""
    found = re.finditer(re.escape(f"`{command}`") + r"(?: \(exit (\d+)\))?", page)
    return [(int(m[1] or 0), Place(m.start() + len(command) + 2, m.end())) for m in found]


def commands_named(page: str) -> list[str]:
    """Every command of roadproof that a page names in its text, sessions left out."""
    prose = re.sub(r"^```.*?^```$", lambda m: " " * len(m[0]), page, flags=re.M | re.S)
    return [m[1] for m in re.finditer(r"`(roadproof [^`]+)`", prose)]
