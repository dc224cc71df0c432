"""The files that the browser is given, from a fixed list: no name that it sends is looked up on a disk."""

import json
from dataclasses import dataclass
from functools import cache
from importlib import resources

from roadproof.frontends.report.viewer_page import viewer_modules, viewer_style

_SCRIPT, _STYLE = "text/javascript; charset=utf-8", "text/css; charset=utf-8"
_OWN = ("server", "address", "state", "editor", "actions", "live", "bar", "side", "app")


@dataclass(frozen=True)
class StaticFile:
    """A file: its text and media type."""

    text: str
    kind: str


@cache
def served() -> dict[str, StaticFile]:
    """Every file by its name below /page/."""
    modules = {f"{name}.js": StaticFile(text, _SCRIPT) for name, text in _modules().items()}
    return {
        **modules,
        "viewer.css": StaticFile(viewer_style(), _STYLE),
        "studio.css": StaticFile(_read("studio.css"), _STYLE),
    }


def page_of(nonce: str) -> str:
    """The page, whose scripts carry ``nonce``; all are asked for at once, not when they are met."""
    addresses = {name: f"/page/{name}.js" for name in _modules()}
    early = "\n".join(f'<link rel="modulepreload" href="{x}" nonce="{nonce}">' for x in addresses.values())
    page = _read("index.html").replace("{{early}}", early).replace("{{nonce}}", nonce)
    return page.replace("{{imports}}", json.dumps({"imports": addresses}))


@cache
def _modules() -> dict[str, str]:
    editor = (
        resources.files("roadproof.frontends.report")
        .joinpath("viewer", "vendor", "edit.js")
        .read_text("utf-8")
    )
    own = {f"studio/{name}": _read(f"{name}.js") for name in _OWN}
    return {**viewer_modules(), "vendor/edit": editor, **own}


@cache
def _read(name: str) -> str:
    return resources.files("roadproof.frontends.studio").joinpath("page", name).read_text("utf-8")
