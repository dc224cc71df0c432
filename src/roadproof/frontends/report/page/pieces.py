"""What sections are made of: verdicts with signs, folded parts, matrices, bars, what is behind an answer."""

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from roadproof.frontends.report.page.markup import Content, Markup, joined, tag
from roadproof.frontends.report.page.page_context import PageContext
from roadproof.frontends.report.page.results import Result

# What each verdict is drawn as: a sign that needs no colour, and the class of its colour.
SIGNS = {
    "WITNESSED": ("■", "drive"),
    "IMPOSSIBLE": ("·", "none"),
    "PROVED": ("✓", "proof"),
    "VACUOUS": ("∅", "doubt"),
    "REFUTED": ("✗", "against"),
    "PROVED-BOUNDED": ("✓", "doubt"),
    "NONE-WITHIN": ("○", "doubt"),
    "COVERED": ("✓", "proof"),
    "GAPS": ("■", "drive"),
    "UNKNOWN": ("?", "doubt"),
}


def verdict(word: object) -> Markup:
    """A verdict with its sign."""
    sign, kind = sign_of(word)
    return tag("span", f"{sign} {word}".strip(), class_=f"verdict-word {kind}")


def sign_of(word: object) -> tuple[str, str]:
    """The sign of a verdict, and the class of its colour."""
    return SIGNS.get(str(word), ("?", "doubt"))


def counts(words: Iterable[object]) -> Markup:
    """How often there is which verdict."""
    counted = Counter(map(str, words))
    return joined([joined([n, " ", verdict(word)]) for word, n in counted.items()], ", ")


def words_in(entries: Iterable[Mapping[str, Any]]) -> list[str]:
    """The verdicts of answers as plain data."""
    return [str(x.get("verdict")) for x in entries]


def folded(summary: Sequence[Content], *inside: Content, id: str | None = None) -> Markup:
    """A part that is unfolded where somebody asks for it, or follows a link to ``id``."""
    return tag("details", tag("summary", *summary), *inside, id=id)


def filtered(inside: Markup) -> Markup:
    """A table below a box in which rows are looked for."""
    box = tag("input", type="search", placeholder="Filter", aria_label="Filter the rows", class_="filter")
    return tag("div", box, inside, class_="filtered")


def matrix(columns: Sequence[Markup], rows: Iterable[Sequence[Content]]) -> Markup:
    """A matrix of cells that are finished; the first of each row is its heading."""
    head = tag("thead", tag("tr", tag("td"), *columns))
    body = tag("tbody", *(tag("tr", *row) for row in rows))
    return tag("div", tag("table", head, body, class_="matrix"), class_="wide")


def cell(word: object, told: str, target: str | None) -> Markup:
    """A cell with the sign of a verdict, which leads to what is behind it."""
    sign, kind = sign_of(word)
    if target is None:
        return tag("td", sign, class_=kind, title=told)
    return tag("td", tag("a", sign, href=f"#{target}", title=told, aria_label=told), class_=kind)


def bar(share: float, told: str) -> Markup:
    """A share as a bar, with words."""
    filled = tag("i", style=f"width:{100 * max(0.0, min(1.0, share)):.1f}%")
    return tag("span", tag("span", filled, class_="bar"), " ", told, class_="share")


def core(parts: object) -> Markup:
    """Parts that clash."""
    texts = parts if isinstance(parts, Sequence) and not isinstance(parts, str) else [parts]
    items = (tag("li", tag("code", short(x))) for x in texts)
    return joined([tag("p", "No drive: these parts clash."), tag("ul", *items)])


def behind(entry: Mapping[str, Any], result: Result, context: PageContext) -> list[Content]:
    """As ``evidence_of``, of an answer as plain data."""
    cores = entry.get("cores") or ([{"parts": entry["core"]}] if entry.get("core") else [])
    clashes = [(x.get("formula", ""), x.get("parts", ())) for x in cores]
    return evidence_of(result, context, entry.get("drive"), entry.get("certificate"), clashes)


def evidence_of(
    result: Result,
    context: PageContext,
    drive: object = None,
    certificate: object = None,
    cores: Sequence[tuple[str, Sequence[str]]] = (),
) -> list[Content]:
    """The drive behind an answer, or the parts that clash, with what was found of its evidence."""
    found: list[Content] = []
    for formula, parts in cores:
        found += [tag("p", tag("code", formula))] if formula and len(cores) > 1 else []
        found.append(core(parts))
    for name in (drive, certificate):
        if isinstance(name, str):
            found.append(context.checked(context.finding(result.folder, name)))
    if isinstance(drive, Mapping):
        found.append(context.drive(drive))
    elif isinstance(drive, str) and result.folder is not None:
        found.append(context.drive(result.folder / drive))
    return found


def short(value: object, most: int = 400) -> str:
    """A value in a line."""
    if isinstance(value, Mapping):
        told = ", ".join(f"{k}={short(x, 80)}" for k, x in value.items())
    elif isinstance(value, Sequence) and not isinstance(value, str):
        told = ", ".join(short(x, 80) for x in value)
    else:
        told = "" if value is None else str(value)
    return told if len(told) <= most else told[: most - 1] + "…"
