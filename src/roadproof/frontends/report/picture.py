"""Pictures of answers, as files. A drive is drawn by an extension, without matplotlib; plots are figures."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from roadproof.errors import UsageError
from roadproof.extension import entries, import_entry
from roadproof.frontends.report.figures import as_bytes
from roadproof.runtime.files import write_atomic

if TYPE_CHECKING:
    from roadproof.evidence.drive_file import DriveFile
    from roadproof.evidence.judged import JudgedDrive
    from roadproof.library.specification import Library

DRIVE = "drive"
"""The entry of the slot ``pictures`` that draws a drive."""
NO_DRIVE_PICTURES = "no pictures of drives: no installed extension draws them (roadproof extensions)"
BOTH = ("png", "svg")


class Picture:
    """A picture as SVG and PNG; a notebook shows it, ``save`` writes it.

    ``formats``: those in which it is written beside an answer. The PNG of a drive is made when it is asked
    for, and needs matplotlib.
    """

    def __init__(
        self, svg: bytes, draw_png: Callable[[], bytes], formats: tuple[str, ...] = ("svg",)
    ) -> None:
        self.svg, self.formats, self._draw_png = svg, formats, draw_png

    @cached_property
    def png(self) -> bytes:
        """The picture as PNG. Raises ``MissingSolverError`` without matplotlib."""
        return self._draw_png()

    def save(self, path: str | Path) -> Path:
        """Write it as .png or .svg, by the name's ending. Raises ``UsageError``, ``InputError``."""
        target = Path(path)
        if target.suffix not in (".png", ".svg"):
            raise UsageError(f"save({str(path)!r}): name a file that ends in .png or .svg")
        write_atomic(target, self.png if target.suffix == ".png" else self.svg)
        return target

    def __repr__(self) -> str:
        return "Picture()"

    def _repr_png_(self) -> bytes | None:
        return self.png if "png" in self.formats else None

    def _repr_svg_(self) -> str | None:
        return None if "png" in self.formats else self.svg.decode()


def picture(figure: object) -> Picture:
    """Return a figure of matplotlib in both formats."""
    made = as_bytes(figure)
    return Picture(made["svg"], lambda: made["png"], BOTH)


def draws_drives() -> bool:
    """Return whether an extension draws drives."""
    return DRIVE in entries("pictures")


def draw_drive(file: DriveFile, library: Library, title: str = "") -> Picture:
    """Return the picture of a drive; ``title`` replaces its scenario or formula.

    Raises ``UsageError`` where no extension draws drives (``draws_drives``).
    """
    if not draws_drives():
        raise UsageError(NO_DRIVE_PICTURES)
    drawn: Picture = import_entry(entries("pictures")[DRIVE])(file, library, title)
    return drawn


def drive_pictures(
    drives: Iterable[tuple[str, JudgedDrive | None]], library: Library
) -> Iterator[tuple[str, Picture]]:
    """Yield the name and the picture of each drive, where an extension draws drives."""
    if draws_drives():
        yield from ((name, draw_drive(x.file, library)) for name, x in drives if x is not None)


def picture_by(kind: str, answer: object) -> Iterator[tuple[str, Picture]]:
    """Yield the picture that an extension draws of the answer to a kind of question; none without it."""
    if (entry := entries("pictures").get(kind)) is not None:
        yield kind, import_entry(entry)(answer)


def drawn(pictures: Mapping[str, Picture]) -> dict[str, bytes]:
    """Return pictures as files by name, each in its formats."""
    return {f"{name}.{kind}": getattr(x, kind) for name, x in pictures.items() for kind in x.formats}
