"""The page: one file with styles, scripts, viewers and all texts, which asks nobody for anything."""

import base64
import gzip
import json
from collections.abc import Mapping, Sequence
from functools import cache
from importlib import resources
from typing import Any

from roadproof.frontends.report.page.markup import Content, Markup, tag
from roadproof.frontends.report.viewer_files import viewer_modules, viewer_style
from roadproof.frontends.report.viewer_page import as_url, hash_of

# Before anything is drawn: the colours of the system's choice, light or dark.
_THEME = """
const wanted = matchMedia("(prefers-color-scheme: dark)");
const choose = () => { document.documentElement.dataset.theme = wanted.matches ? "dark" : "light"; };
choose();
wanted.addEventListener("change", choose);
"""


def page(title: str, sections: Sequence[Markup], documents: Sequence[Mapping[str, Any]], made: str) -> str:
    """The page as a text; ``documents`` are those of the viewers, read by the browser one by one."""
    modules = {name: as_url(text) for name, text in viewer_modules().items()}
    imports = json.dumps({"imports": modules})
    script = _resource("page.js")
    hashes = " ".join(map(hash_of, (_THEME, imports, script)))
    policy = (
        f"default-src 'none'; script-src data: {hashes}; style-src 'unsafe-inline'; img-src data:; "
        "base-uri 'none'; form-action 'none'"
    )
    data: list[Content] = [
        tag("script", _packed(x), type="application/gzip", id=f"document-{k}")
        for k, x in enumerate(documents)
    ]
    head = tag(
        "head",
        tag("meta", charset="utf-8"),
        tag("meta", name="viewport", content="width=device-width, initial-scale=1"),
        tag("meta", http_equiv="Content-Security-Policy", content=policy),
        tag("title", title),
        tag("style", Markup(f"{viewer_style()}\n{_resource('page.css')}")),
        tag("script", Markup(_THEME)),
        tag("script", Markup(imports), type="importmap"),
    )
    body = tag(
        "body",
        tag("header", tag("h1", title), tag("p", made, class_="faint")),
        tag("main", *sections),
        *data,
        tag("script", Markup(script), type="module"),
    )
    return f"<!doctype html>\n{tag('html', head, body, lang='en')}\n"


def _packed(document: Mapping[str, Any]) -> str:
    """A document as gzipped JSON in base64, which the browser unpacks when it is asked for."""
    text = json.dumps(document, ensure_ascii=False, separators=(",", ":"))
    return base64.b64encode(gzip.compress(text.encode(), mtime=0)).decode()


@cache
def _resource(name: str) -> str:
    return resources.files("roadproof.frontends.report.page").joinpath(name).read_text("utf-8")
