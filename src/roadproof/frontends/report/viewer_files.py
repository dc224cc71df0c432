"""The files of the viewer in a browser: modules, styles, and what they stand on, by the names they import."""

from functools import cache
from importlib import resources
from importlib.resources.abc import Traversable

_OWN = ("palette", "drive", "scene", "strips", "curves", "verdict", "viewer")
_MODULES = ("vendor/view", *(f"viewer/{name}" for name in _OWN))
_STYLES = ("vendor/uPlot.css", "viewer/viewer.css")


def folder() -> Traversable:
    """Where they lie."""
    return resources.files("roadproof.frontends.report").joinpath("viewer")


@cache
def viewer_modules() -> dict[str, str]:
    """The text of each ES module, by the name under which the others import it."""
    return {name: _text(f"{name.removeprefix('viewer/')}.js") for name in _MODULES}


@cache
def viewer_style() -> str:
    """All styles of the viewer."""
    return "\n".join(_text(name.removeprefix("viewer/")) for name in _STYLES)


def _text(path: str) -> str:
    return folder().joinpath(path).read_text("utf-8")
