"""One trace that was monitored: the verdict, and when each part is true."""

from collections.abc import Mapping

from roadproof.evidence.answers.monitor import Answer, Spans
from roadproof.evidence.codec import read, write
from roadproof.frontends.report.page.markup import Content, Markup, joined, table, tag
from roadproof.frontends.report.page.page_context import PageContext, strips
from roadproof.frontends.report.page.pieces import short
from roadproof.frontends.report.page.results import Result

_SIGNS = {"true": ("✓", "proof"), "false": ("✗", "against")}


def monitored(result: Result, context: PageContext, words: Mapping[int, str]) -> Markup:
    """The answer of ``monitor --json``, which holds no trace: what was said of it, and on what."""
    answer = read(Answer, result.data, result.name)
    sign, kind = _SIGNS.get(answer.verdict, ("?", "doubt"))
    said = tag("span", f"{sign} {answer.verdict}", class_=f"verdict-word {kind}")
    end = f", with the end as {answer.end}" if answer.end else ""
    rows = [(tag("code", x.formula), _spans(x.true), _spans(x.undecided)) for x in answer.parts]
    shown: list[Content] = [
        tag("p", said, " at the start: ", tag("code", answer.formula)),
        tag(
            "p",
            f"{answer.trace}, from {answer.start}, {answer.seconds:g} s on {answer.road}, "
            f"{answer.view}{end}.",
        ),
        tag("p", f"Margin, in the units of what is compared: {_margin(answer.robustness)}."),
        _picture(answer),
        table(("part", "true, s", "it depends on what comes later, s"), rows),
    ]
    if answer.overruled:
        said_there = short([write(x) for x in answer.overruled])
        shown.append(tag("p", "In place of what the file says: ", said_there))
    return joined(shown)


def _picture(answer: Answer) -> Markup:
    """The strips of the parts."""
    named = [{"op": "name", "text": x.formula, "true": x.true} for x in answer.parts]
    return strips(
        {"formulas": [{"text": answer.formula, "parts": named}], "drive": {"horizon": answer.seconds}}
    )


def _margin(bounds: tuple[float | None, float | None]) -> str:
    low, high = ("without bound" if x is None else f"{x:.4g}" for x in bounds)
    return low if low == high else f"between {low} and {high}"


def _spans(spans: Spans) -> str:
    return ", ".join(f"{begin:g} to {'the end' if end is None else f'{end:g}'}" for begin, end in spans)
