"""HTML made of parts. A text is escaped wherever it is put in; only what ``tag`` made is not."""

from collections.abc import Iterable, Sequence
from html import escape
from typing import TypeAlias


class Markup(str):
    """HTML that is finished."""

    __slots__ = ()


Content: TypeAlias = str | int | float | None

_ALONE = {"br", "col", "input", "meta", "rect", "line"}


def tag(name: str, /, *content: Content, **attributes: Content | bool) -> Markup:
    """An element. ``class_`` is class, ``data_x`` data-x; None and False leave an attribute out.

    >>> tag("b", "a < b", tag("i", 3), class_="x")
    '<b class="x">a &lt; b<i>3</i></b>'
    """
    told = "".join(
        f" {key.rstrip('_').replace('_', '-')}" + ("" if value is True else f'="{escape(str(value))}"')
        for key, value in attributes.items()
        if value is not None and value is not False
    )
    if name in _ALONE:
        return Markup(f"<{name}{told}/>")
    return Markup(f"<{name}{told}>{joined(content)}</{name}>")


def joined(content: Iterable[Content], between: str = "") -> Markup:
    """Parts side by side; a text between them is escaped too."""
    return Markup(escape(between).join(_safe(x) for x in content))


def _safe(part: Content) -> str:
    return part if isinstance(part, Markup) else "" if part is None else escape(str(part))


def table(head: Sequence[Content], rows: Iterable[Sequence[Content]], **attributes: Content | bool) -> Markup:
    """A table with a row of headings; numbers are on the right."""
    top = tag("thead", tag("tr", *(tag("th", x, scope="col") for x in head)))
    body = tag("tbody", *(tag("tr", *map(_cell, row)) for row in rows))
    return tag("div", tag("table", top, body, **attributes), class_="wide")


def _cell(content: Content) -> Markup:
    number = isinstance(content, int | float) and not isinstance(content, bool)
    return tag("td", content, class_="number" if number else None)
