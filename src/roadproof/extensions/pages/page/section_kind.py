"""How results of a kind are shown on a page."""

from collections.abc import Callable, Mapping
from typing import NamedTuple, TypeAlias

from roadproof.extensions.pages.page.page_context import PageContext
from roadproof.extensions.pages.page.results import Result, Words

Values: TypeAlias = Mapping[str, object]


class SectionKind(NamedTuple):
    """Title, question, template of ``page/templates`` (``plain`` shows any answer), and its values."""

    title: str
    question: str
    template: str
    values: Callable[[Result, PageContext, Words], Values]
