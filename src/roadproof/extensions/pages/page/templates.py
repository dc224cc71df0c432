"""Renders pages from templates; the only module that imports jinja2, and only when a page is written.

A page is one file with styles, scripts, viewers and all texts; it loads nothing from a network.
"""

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from functools import cache
from typing import TYPE_CHECKING, NamedTuple

from roadproof.evidence.finding import NO_EVIDENCE, Finding
from roadproof.extensions.surveys.report.explore import show
from roadproof.runtime.files import utf8

if TYPE_CHECKING:
    from jinja2 import Environment
import base64
import gzip
import json
from importlib import resources

from roadproof.extensions.pages.viewer_document import ViewerDocument
from roadproof.extensions.pages.viewer_page import as_url, design, hash_of, viewer_modules, viewer_style
from roadproof.frontends.report.sheet import excerpt


class Sign(NamedTuple):
    """The sign of a verdict, which is readable without colour, and its colour class."""

    text: str
    colour: str


_UNKNOWN = Sign("?", "doubt")
SIGNS: Mapping[str, Sign] = {
    "WITNESSED": Sign("■", "drive"),
    "IMPOSSIBLE": Sign("·", "none"),
    "PROVED": Sign("✓", "proof"),
    "VACUOUS": Sign("∅", "doubt"),
    "REFUTED": Sign("✗", "against"),
    "PROVED-BOUNDED": Sign("✓", "doubt"),
    "NONE-WITHIN": Sign("○", "doubt"),
    "COVERED": Sign("✓", "proof"),
    "GAPS": Sign("■", "drive"),
    "UNKNOWN": _UNKNOWN,
    "FAILS": Sign("✗", "against"),
    "true": Sign("✓", "proof"),
    "false": Sign("✗", "against"),
    "proved": Sign("✓", "proof"),
    "witnessed": Sign("■", "drive"),
    "stale": Sign("↻", "doubt"),
    "missing": Sign("–", "against"),
    "rejected": Sign("✗", "against"),
    "refuted": Sign("✗", "against"),
}


def sign(verdict: object) -> Sign:
    """Return the sign of a verdict."""
    return SIGNS.get(str(verdict), _UNKNOWN)


def counted(verdicts: Iterable[object]) -> list[tuple[str, int]]:
    """Return how often each verdict occurs."""
    return [*Counter(map(str, verdicts)).items()]


def in_unit(value: str, unit: str = "") -> str:
    """Return a rational as a decimal with its unit."""
    return f"{show(Fraction(value))} {unit if unit != 'unitless' else ''}".rstrip()


def notes(finding: Finding) -> str:
    """Return what was checked of evidence, and what was not."""
    if finding.kind == NO_EVIDENCE:
        return "there is no evidence for it"
    unchecked = f"not checked: {', '.join(finding.unchecked)}" if finding.unchecked else ""
    return "; ".join([*finding.checked, *([unchecked] if unchecked else [])])


def short(value: object, most: int = 400) -> str:
    """Return a value in one line of at most ``most`` characters."""
    if isinstance(value, Mapping):
        text = ", ".join(f"{k}={short(x, 80)}" for k, x in value.items())
    elif isinstance(value, Sequence) and not isinstance(value, str):
        text = ", ".join(short(x, 80) for x in value)
    else:
        text = "" if value is None else str(value)
    return excerpt(text, most)


@cache
def _environment() -> "Environment":
    from jinja2 import ChoiceLoader, Environment, PackageLoader, PrefixLoader, StrictUndefined

    atlas = PrefixLoader({"atlas": PackageLoader("roadproof.extensions.pages.atlas")})
    made = Environment(
        loader=ChoiceLoader([PackageLoader("roadproof.extensions.pages.page"), atlas]),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    made.filters |= {"counted": counted, "in_unit": in_unit, "notes": notes, "short": short, "sign": sign}
    return made


def style_without_scripts() -> str:
    """Return colours, fonts and verdict styles for pages without scripts."""
    return design() + _resource("pieces.css")


def page_style() -> str:
    """Return the styles of a page without viewers."""
    return "\n".join((design(), _resource("page.css"), _resource("pieces.css")))


def render(template: str, **values: object) -> str:
    """Return a template of the folder ``templates``, or of the atlas, as HTML with escaped ``values``."""
    return _environment().get_template(template).render(values)


def page(title: str, summary: str, sections: Sequence[str], documents: Sequence[ViewerDocument]) -> str:
    """Return the page as text; ``documents``: those of the viewers, which the browser unpacks one by one."""
    texts = {**viewer_modules(), "page/tables": _resource("tables.js")}
    modules = {name: as_url(text) for name, text in texts.items()}
    imports = json.dumps({"imports": modules})
    script = _resource("page.js")
    return render(
        "page.html",
        title=title,
        summary=summary,
        sections=sections,
        documents=[_compressed(x) for x in documents],
        style="\n".join((viewer_style(), _resource("page.css"), _resource("pieces.css"))),
        imports=imports,
        script=script,
        hashes=" ".join(map(hash_of, (imports, script))),
    )


def _compressed(document: ViewerDocument) -> str:
    """Return a document as gzipped JSON in base64, which the browser unpacks on demand."""
    text = json.dumps(document.as_json(), ensure_ascii=False, separators=(",", ":"))
    return base64.b64encode(gzip.compress(utf8(text), mtime=0)).decode()


@cache
def _resource(name: str) -> str:
    return resources.files("roadproof.extensions.pages.page").joinpath(name).read_text("utf-8")
