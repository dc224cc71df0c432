"""The presentation of a kind of result on a page."""

from collections.abc import Callable, Iterable, Mapping
from typing import NamedTuple, TypeAlias

from roadproof.extensions.pages.page.page_context import PageContext
from roadproof.extensions.pages.page.results import PageResult, Words

Values: TypeAlias = Mapping[str, object]


class OpenItem(NamedTuple):
    """A point that a result leaves open: a word, a text, and the id of the part of the page about it."""

    word: str
    text: str
    target: str


def no_points(result: PageResult) -> Iterable[OpenItem]:
    """Return no open points, beside those of the verdicts."""
    return ()


def no_counts(result: PageResult) -> str:
    """Return no counts; those of the verdicts are shown."""
    return ""


class SectionKind(NamedTuple):
    """A title, a question, a template of ``page/templates`` (``plain`` fits any answer), and a function for
    its values.

    ``points``, ``counts``: functions for open points and counts in the summary, beside those of verdicts.
    """

    title: str
    question: str
    template: str
    values: Callable[[PageResult, PageContext, Words], Values]
    points: Callable[[PageResult], Iterable[OpenItem]] = no_points
    counts: Callable[[PageResult], str] = no_counts
