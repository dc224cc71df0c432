"""Animations of drives by format: how their files end, and what is in them."""

from collections.abc import Mapping

from roadproof.evidence.drive_file import DriveFile
from roadproof.library.specification import Library

ENDINGS: Mapping[str, str] = {"svg": "-moving.svg", "gif": ".gif", "mp4": ".mp4"}


def draw_animation(file: DriveFile, library: Library, format: str) -> bytes:
    """The animation of a drive in a format of ``ENDINGS``.

    Raises ``MissingSolverError`` where matplotlib, Pillow or ffmpeg is needed and missing.
    """
    if format == "svg":
        from roadproof.extensions.pages.moving import draw_moving

        return draw_moving(file, library)
    from roadproof.extensions.pages.film import as_gif, as_mp4
    from roadproof.extensions.pages.frames import draw_film

    film = draw_film(file, library)
    return as_gif(film) if format == "gif" else as_mp4(film)
