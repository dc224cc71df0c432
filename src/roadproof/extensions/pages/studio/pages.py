"""The files for the browser, from a fixed list: no name that the browser sends is looked up on a disk."""

import json
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any

from roadproof.core_record import DRIVES
from roadproof.errors import InputError, RoadproofError
from roadproof.evidence.strict import read_json
from roadproof.extensions.pages.studio.examples import EXAMPLES
from roadproof.extensions.pages.studio.gallery import shipped_cards
from roadproof.extensions.pages.studio.requests import form
from roadproof.extensions.pages.viewer_page import viewer_modules, viewer_style
from roadproof.library.specification import read_specification
from roadproof.runtime.files import read_text

_SCRIPT, _STYLE = "text/javascript; charset=utf-8", "text/css; charset=utf-8"
_OWN = (
    *("store", "server", "address", "state", "answers", "history", "recent", "editor", "actions", "live"),
    *("picture", "gallery", "tour", "bar", "side", "app"),
)
MOST_FILES, LARGEST_FILE = 200, 1_000_000  # of a folder that is looked through; bytes
LARGEST_TOGETHER = 60_000_000  # bytes of named recordings, as of dropped ones
OPENED = (".json", ".csv", ".xosc", ".xodr", ".xml", ".toml")


@dataclass(frozen=True)
class StaticFile:
    """A file: its text and media type."""

    text: str
    kind: str


@cache
def static_files() -> dict[str, StaticFile]:
    """Return every file by its name below /page/."""
    modules = {f"{name}.js": StaticFile(text, _SCRIPT) for name, text in _modules().items()}
    return {
        **modules,
        "viewer.css": StaticFile(viewer_style(), _STYLE),
        "studio.css": StaticFile(_read("studio.css"), _STYLE),
    }


def page_of(nonce: str) -> str:
    """Return the page, whose scripts carry ``nonce``; it preloads all scripts at once."""
    addresses = {name: f"/page/{name}.js" for name in _modules()}
    early = "\n".join(f'<link rel="modulepreload" href="{x}" nonce="{nonce}">' for x in addresses.values())
    page = _read("index.html").replace("{{early}}", early).replace("{{nonce}}", nonce)
    return page.replace("{{imports}}", json.dumps({"imports": addresses}))


@cache
def _modules() -> dict[str, str]:
    editor = (
        resources.files("roadproof.extensions.pages")
        .joinpath("viewer", "vendor", "edit.js")
        .read_text("utf-8")
    )
    own = {f"studio/{name}": _read(f"{name}.js") for name in _OWN}
    return {**viewer_modules(), "vendor/edit": editor, **own}


@cache
def _read(name: str) -> str:
    return resources.files("roadproof.extensions.pages.studio").joinpath("page", name).read_text("utf-8")


# --- what the page begins with ---------------------------------------------------------------------


@dataclass(frozen=True)
class StartContent:
    """The content that the page starts with.

    ``text``: the definitions in the editor; ``drives``, ``specs``: contents of drive files and texts of
    specification files that the page lists, by name; ``files``: texts of other named files, which the page
    opens as if they were dropped on it; ``shows``: whether the page starts with the first drive.
    """

    text: str = ""
    drives: tuple[tuple[str, Any], ...] = ()
    specs: tuple[tuple[str, str], ...] = ()
    files: tuple[tuple[str, str], ...] = ()
    shows: bool = True

    def as_data(self) -> dict[str, object]:
        """Return plain data, with the options that the page offers."""
        return {
            "text": self.text,
            "drives": [{"name": name, "drive": x} for name, x in self.drives],
            "specs": [{"name": name, "text": x} for name, x in self.specs],
            "files": [{"name": name, "content": x} for name, x in self.files],
            "shows": self.shows and bool(self.drives),
            "form": form(),
            "examples": [asdict(x) for x in EXAMPLES],
            "cards": shipped_cards(),
        }


def read_start_files(paths: Sequence[Path]) -> StartContent:
    """Return the files that the studio starts with, and the drives and definitions of folders.

    The editor starts with the definitions of the named files, not with those of folders. Raises
    ``InputError`` for other kinds of file, and for more than ``LARGEST_TOGETHER`` bytes of recordings.
    """
    texts: list[str] = []
    drives: list[tuple[str, Any]] = []
    specs: list[tuple[str, str]] = []
    files: list[tuple[str, str]] = []
    for path in paths:
        if path.is_dir():
            inside = read_folder(path)
            drives += inside.drives
            specs += inside.specs
        elif path.suffix == ".spec":
            texts.append(read_specification(path).text)
            specs.append((path.name, texts[-1]))
        elif path.suffix == ".json" and is_drive(content := read_json(path)):
            drives.append((path.name, content))
        elif path.suffix in OPENED:
            files.append((path.name, _text_of(path)))
        else:
            raise InputError(
                f"{path}: the studio opens specification files (.spec), drives and certificates (.json), "
                "samples (.csv, .xosc), the files of a recording, and folders"
            )
    if sum(len(text) for _, text in files) > LARGEST_TOGETHER:
        raise InputError(
            f"the named recordings have more than {LARGEST_TOGETHER // 1_000_000} MB together: "
            "use roadproof evaluate"
        )
    return StartContent("\n".join(texts), tuple(drives), tuple(specs), tuple(files))


def is_drive(content: object) -> bool:
    """Return whether plain data claim to be a drive file."""
    return isinstance(content, dict) and content.get("schema") in DRIVES


def _text_of(path: Path) -> str:
    return read_text(path, LARGEST_TOGETHER, "use roadproof evaluate")


def read_folder(folder: Path) -> StartContent:
    """Return the specification and drive files of a folder, for the user to choose from.

    Other files, large ones, unreadable ones, and all beyond ``MOST_FILES`` are left out.
    """
    drives: list[tuple[str, Any]] = []
    specs: list[tuple[str, str]] = []
    for path in sorted(folder.glob("*.spec"))[:MOST_FILES]:
        with suppress(RoadproofError, OSError, UnicodeDecodeError):
            if path.stat().st_size <= LARGEST_FILE:
                specs.append((path.name, read_specification(path).text))
    for path in sorted(folder.glob("*.json"))[:MOST_FILES]:
        with suppress(RoadproofError, OSError):
            content = read_json(path, LARGEST_FILE)
            if is_drive(content):
                drives.append((path.name, content))
    return StartContent("", tuple(drives), tuple(specs), shows=False)
