"""One trace that was monitored: the verdict, and when each part is true."""

from collections.abc import Mapping
from typing import Any

from roadproof.report.page.book import Book, strips
from roadproof.report.page.markup import Content, Markup, joined, table, tag
from roadproof.report.page.pieces import short
from roadproof.report.page.results import Result

_SIGNS = {"true": ("✓", "proof"), "false": ("✗", "against")}


def monitored(result: Result, book: Book, words: Mapping[int, str]) -> Markup:
    """The answer of ``monitor --json``, which holds no trace: what was said of it, and on what."""
    data = result.data
    sign, kind = _SIGNS.get(data["verdict"], ("?", "doubt"))
    said = tag("span", f"{sign} {data['verdict']}", class_=f"verdict-word {kind}")
    end = f", with the end as {data['end']}" if data.get("end") else ""
    parts = data.get("parts", ())
    rows = [(tag("code", x["formula"]), _spans(x["true"]), _spans(x["undecided"])) for x in parts]
    shown: list[Content] = [
        tag("p", said, " at the start: ", tag("code", data["formula"])),
        tag(
            "p",
            f"{data['trace']}, from {data['start']}, {data['seconds']:g} s on {data['road']}, "
            f"{data['view']}{end}.",
        ),
        tag("p", f"Margin, in the units of what is compared: {_margin(data['robustness'])}."),
        _picture(data),
        table(("part", "true, s", "it depends on what comes later, s"), rows),
    ]
    shown += (
        [tag("p", "In place of what the file says: ", short(data["overruled"]))]
        if data.get("overruled")
        else []
    )
    return joined(shown)


def _picture(data: Mapping[str, Any]) -> Markup:
    """The strips of the parts."""
    named = [{"op": "name", "text": x["formula"], "true": x["true"]} for x in data.get("parts", ())]
    return strips(
        {"formulas": [{"text": data["formula"], "parts": named}], "drive": {"horizon": data["seconds"]}}
    )


def _margin(bounds: tuple[float | None, float | None]) -> str:
    low, high = ("without bound" if x is None else f"{x:.4g}" for x in bounds)
    return low if low == high else f"between {low} and {high}"


def _spans(spans: list[tuple[float, float | None]]) -> str:
    return ", ".join(f"{begin:g} to {'the end' if end is None else f'{end:g}'}" for begin, end in spans)
