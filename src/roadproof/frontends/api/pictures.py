"""Pictures of answers, as files."""

from collections.abc import Iterable, Iterator, Mapping

from roadproof.evidence.judged import JudgedDrive
from roadproof.frontends.api.answer import Picture, picture
from roadproof.library.specification import Library


def drive_pictures(
    drives: Iterable[tuple[str, JudgedDrive | None]], library: Library
) -> Iterator[tuple[str, Picture]]:
    """A picture of each drive that there is."""
    from roadproof.frontends.report.drive import draw_drive

    return ((name, picture(draw_drive(x.file, library))) for name, x in drives if x is not None)


def drawn(pictures: Mapping[str, Picture]) -> dict[str, bytes]:
    """Pictures as files by name."""
    return {f"{name}.{kind}": getattr(x, kind) for name, x in pictures.items() for kind in ("png", "svg")}
