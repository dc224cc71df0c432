"""Animations of drives by format: how their files end, and what is in them."""

from dataclasses import dataclass

from roadproof.evidence.drive_file import DriveFile
from roadproof.extensions.pages.film import as_gif, as_mp4, need
from roadproof.library.specification import Library


@dataclass(frozen=True)
class Moving:
    """A moving picture as SVG."""

    ending: str = "-moving.svg"

    def need(self) -> None:
        """A browser plays it."""

    def draw(self, file: DriveFile, library: Library) -> bytes:
        """Return the picture."""
        from roadproof.extensions.pages.moving import draw_moving

        return draw_moving(file, library)


@dataclass(frozen=True)
class Filmed:
    """Frames as a GIF or an MP4 file."""

    ending: str

    def need(self) -> None:
        """Raises ``MissingSolverError`` where ffmpeg is needed and missing."""
        need(self.ending)

    def draw(self, file: DriveFile, library: Library) -> bytes:
        """Return the film. Raises ``MissingSolverError`` without matplotlib, Pillow or ffmpeg."""
        from roadproof.extensions.pages.frames import draw_film

        film = draw_film(file, library)
        return as_gif(film) if self.ending == ".gif" else as_mp4(film)


SVG, GIF, MP4 = Moving(), Filmed(".gif"), Filmed(".mp4")


def draw_animation(file: DriveFile, library: Library, format: str) -> bytes:
    """Return the animation of a drive in a format: svg, gif or mp4. Raises ``MissingSolverError``."""
    known: dict[str, Moving | Filmed] = {"svg": SVG, "gif": GIF, "mp4": MP4}
    return known[format].draw(file, library)
