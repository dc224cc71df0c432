"""The page: one file with styles, scripts, viewers and all texts, which asks nobody for anything."""

import base64
import gzip
import json
from collections.abc import Mapping, Sequence
from functools import cache
from importlib import resources
from typing import Any

from roadproof.frontends.report.page.templates import render
from roadproof.frontends.report.viewer_files import viewer_modules, viewer_style
from roadproof.frontends.report.viewer_page import as_url, hash_of


def page(title: str, sections: Sequence[str], documents: Sequence[Mapping[str, Any]], made: str) -> str:
    """The page as a text; ``documents`` are those of the viewers, read by the browser one by one."""
    modules = {name: as_url(text) for name, text in viewer_modules().items()}
    imports = json.dumps({"imports": modules})
    theme, script = _resource("theme.js"), _resource("page.js")
    return render(
        "page.html",
        title=title,
        made=made,
        sections=sections,
        documents=[_packed(x) for x in documents],
        style=f"{viewer_style()}\n{_resource('page.css')}",
        theme=theme,
        imports=imports,
        script=script,
        hashes=" ".join(map(hash_of, (theme, imports, script))),
    )


def _packed(document: Mapping[str, Any]) -> str:
    """A document as gzipped JSON in base64, which the browser unpacks when it is asked for."""
    text = json.dumps(document, ensure_ascii=False, separators=(",", ":"))
    return base64.b64encode(gzip.compress(text.encode(), mtime=0)).decode()


@cache
def _resource(name: str) -> str:
    return resources.files("roadproof.frontends.report.page").joinpath(name).read_text("utf-8")
