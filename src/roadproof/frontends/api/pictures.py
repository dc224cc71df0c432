"""Pictures of answers, as files."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import field
from pathlib import Path
from typing import TYPE_CHECKING

from roadproof.errors import UsageError
from roadproof.extension import entries, import_entry
from roadproof.frontends.report.figures import as_bytes
from roadproof.runtime.files import write_atomic
from roadproof.runtime.records import dataclass

if TYPE_CHECKING:
    from roadproof.evidence.judged import JudgedDrive
    from roadproof.library.specification import Library


def drive_pictures(
    drives: Iterable[tuple[str, JudgedDrive | None]], library: Library
) -> Iterator[tuple[str, Picture]]:
    """A picture of each drive that there is."""
    from roadproof.frontends.report.drive import draw_drive

    return ((name, picture(draw_drive(x.file, library))) for name, x in drives if x is not None)


def picture_by(kind: str, answer: object) -> Iterator[tuple[str, Picture]]:
    """Yield the picture that an extension draws of the answer to a kind of question; none without it."""
    if (entry := entries("pictures").get(kind)) is not None:
        yield kind, picture(import_entry(entry)(answer))


def drawn(pictures: Mapping[str, Picture]) -> dict[str, bytes]:
    """Pictures as files by name."""
    return {f"{name}.{kind}": getattr(x, kind) for name, x in pictures.items() for kind in ("png", "svg")}


@dataclass(frozen=True)
class Picture:
    """A picture in two formats; a notebook shows it, ``save`` writes it."""

    png: bytes = field(repr=False)
    svg: bytes = field(repr=False)

    def save(self, path: str | Path) -> Path:
        """Write it as .png or .svg, by the name's ending. Raises ``UsageError``, ``InputError``."""
        target = Path(path)
        if target.suffix not in (".png", ".svg"):
            raise UsageError(f"save({str(path)!r}): name a file that ends in .png or .svg")
        write_atomic(target, self.png if target.suffix == ".png" else self.svg)
        return target

    def _repr_png_(self) -> bytes:
        return self.png


def picture(figure: object) -> Picture:
    """A figure that ``report`` has drawn, in both formats."""
    return Picture(**as_bytes(figure))
