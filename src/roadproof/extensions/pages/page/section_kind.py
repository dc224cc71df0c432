"""The presentation of a kind of result on a page."""

from collections.abc import Callable, Mapping
from typing import NamedTuple, TypeAlias

from roadproof.extensions.pages.page.page_context import PageContext
from roadproof.extensions.pages.page.results import PageResult, Words

Values: TypeAlias = Mapping[str, object]


class SectionKind(NamedTuple):
    """A title, a question, a template of ``page/templates`` (``plain`` fits any answer), and a function for
    its values.
    """

    title: str
    question: str
    template: str
    values: Callable[[PageResult, PageContext, Words], Values]
