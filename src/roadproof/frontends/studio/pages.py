"""The files that the browser is given, from a fixed list: no name that it sends is looked up on a disk."""

import json
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any

from roadproof.errors import InputError
from roadproof.evidence.strict import read_json
from roadproof.frontends.report.viewer_page import viewer_modules, viewer_style
from roadproof.frontends.studio.requests import form
from roadproof.library.specification import read_specification

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


# --- what the page begins with ---------------------------------------------------------------------


@dataclass(frozen=True)
class Begun:
    """``text``: the definitions that the editor begins with; ``drives``: drive files by name."""

    text: str = ""
    drives: tuple[tuple[str, Any], ...] = ()

    def as_data(self) -> dict[str, object]:
        """As plain data, with the options that the page offers."""
        drives = [{"name": name, "drive": x} for name, x in self.drives]
        return {"text": self.text, "drives": drives, "form": form()}


def begin_with(paths: Sequence[Path]) -> Begun:
    """Read specification files (.spec) and drive files (.json). Raises ``InputError``."""
    texts: list[str] = []
    drives: list[tuple[str, Any]] = []
    for path in paths:
        if path.suffix == ".json":
            drives.append((path.name, read_json(path)))
        elif path.suffix == ".spec":
            texts.append(read_specification(path).text)
        else:
            raise InputError(f"{path}: the studio opens specification files (.spec) and drive files (.json)")
    return Begun("\n".join(texts), tuple(drives))
