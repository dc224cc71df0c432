"""Animations of drives by format (SVG, GIF, MP4): how their files end, and how they are drawn."""

from dataclasses import dataclass

from roadproof.evidence.drive_file import DriveFile
from roadproof.extensions.pages.film import as_gif, as_mp4, need
from roadproof.library.specification import Library


@dataclass(frozen=True)
class SvgAnimation:
    """An animated SVG file."""

    ending: str = "-moving.svg"

    def need(self) -> None:
        """Require nothing: a browser plays the file."""

    def draw(self, file: DriveFile, library: Library) -> bytes:
        """Return the SVG file."""
        from roadproof.extensions.pages.moving import draw_moving

        return draw_moving(file, library)


@dataclass(frozen=True)
class FilmAnimation:
    """A film as a GIF or an MP4 file."""

    ending: str

    def need(self) -> None:
        """Raise ``MissingSolverError`` where ffmpeg is needed and missing."""
        need(self.ending)

    def draw(self, file: DriveFile, library: Library) -> bytes:
        """Return the film file. Raises ``MissingSolverError`` without matplotlib, Pillow or ffmpeg."""
        from roadproof.extensions.pages.frames import draw_film

        film = draw_film(file, library)
        return as_gif(film) if self.ending == ".gif" else as_mp4(film)


SVG, GIF, MP4 = SvgAnimation(), FilmAnimation(".gif"), FilmAnimation(".mp4")


def draw_animation(file: DriveFile, library: Library, format: str) -> bytes:
    """Return the animation of a drive as svg, gif or mp4. Raises ``MissingSolverError``."""
    known: dict[str, SvgAnimation | FilmAnimation] = {"svg": SVG, "gif": GIF, "mp4": MP4}
    return known[format].draw(file, library)
