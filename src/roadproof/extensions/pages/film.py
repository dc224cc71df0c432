"""Encodes frames as a GIF or MP4 file; the only module that uses Pillow and the program ffmpeg."""

import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Callable
from fractions import Fraction
from io import BytesIO
from itertools import pairwise
from math import ceil
from pathlib import Path

from roadproof.errors import MissingSolverError
from roadproof.runtime.records import dataclass

COLOURS = 128  # of a GIF file
_SAMPLES = 8  # frames whose colours are looked at
_MISSING = "mp4 needs the program ffmpeg: install it, such as by apt-get install -y ffmpeg, or write gif"


@dataclass(frozen=True)
class Film:
    """A film; ``draw`` returns the RGBA bytes of a frame by its number.

    ``size``: width and height in px, both even; ``grain``: seconds per frame; ``pause``: seconds of the last
    frame; ``still``: the number of the most telling frame.
    """

    size: tuple[int, int]
    draw: Callable[[int], bytes]
    count: int
    grain: Fraction
    pause: Fraction
    still: int


def need(ending: str) -> None:
    """Raise ``MissingSolverError`` where files with this ending need a program that is missing."""
    if ending == ".mp4" and shutil.which("ffmpeg") is None:
        raise MissingSolverError(_MISSING)


def as_gif(film: Film) -> bytes:
    """Return the film as an endless GIF file. Raises ``MissingSolverError`` without Pillow."""
    try:
        from PIL import Image
    except ImportError:
        raise MissingSolverError("gif needs Pillow: install it, or write svg") from None
    palette = Image.new("P", (1, 1))
    palette.putpalette(b"".join(_colours(film)))

    def frame(k: int) -> Image.Image:
        drawn = Image.frombytes("RGBA", film.size, film.draw(k)).convert("RGB")
        return drawn.quantize(palette=palette, dither=Image.Dither.NONE)

    first, *others = map(frame, range(film.count))
    ends = [round(100 * film.grain * k) for k in range(film.count)]  # GIF files count hundredths
    ends.append(round(100 * (film.grain * (film.count - 1) + film.pause)))
    durations = [10 * (end - begin) for begin, end in pairwise(ends)]
    out = BytesIO()
    first.save(out, "GIF", save_all=True, append_images=others, duration=durations, loop=0)
    return out.getvalue()


def _colours(film: Film) -> list[bytes]:
    """Return the most frequent colours of some frames, as RGB; flat areas keep theirs exactly.

    Pillow cannot distinguish colours that differ in their last bits, so only one of those is listed.
    """
    counted: Counter[int] = Counter()
    for k in {film.still, *range(0, film.count, max(1, film.count // _SAMPLES)), film.count - 1}:
        counted.update(memoryview(film.draw(k)).cast("I"))
    palette: dict[tuple[int, ...], bytes] = {}
    for pixel, _ in counted.most_common():
        rgb = pixel.to_bytes(4, sys.byteorder)[:3]
        palette.setdefault(tuple(x >> 3 for x in rgb), rgb)
    return [*palette.values()][:COLOURS]


def as_mp4(film: Film) -> bytes:
    """Return the film as an MP4 file. Raises ``MissingSolverError`` where ffmpeg is missing or fails."""
    need(".mp4")
    raw = ("-f", "rawvideo", "-pix_fmt", "rgba", "-s", f"{film.size[0]}x{film.size[1]}")
    rate = ("-r", f"{1 / film.grain}", "-i", "-")
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "film.mp4"
        output = ("-pix_fmt", "yuv420p", "-movflags", "+faststart", "-y", str(out))
        command = ["ffmpeg", "-loglevel", "error", *raw, *rate, *output]
        with (
            tempfile.TemporaryFile() as complaints,
            subprocess.Popen(command, stdin=subprocess.PIPE, stdout=complaints, stderr=complaints) as ran,
        ):
            try:
                assert ran.stdin is not None
                for k in range(film.count - 1 + ceil(film.pause / film.grain)):
                    ran.stdin.write(film.draw(min(k, film.count - 1)))
                ran.stdin.close()
            except BrokenPipeError:
                pass  # ffmpeg has ended early; its words say why
            exit_code = ran.wait()
            complaints.seek(0)
            errors = complaints.read().decode(errors="replace").strip().splitlines()
        if exit_code or not out.is_file():
            why = errors[-1] if errors else f"exit code {exit_code}"
            raise MissingSolverError(f"ffmpeg cannot write mp4: {why}; install a full build, or write gif")
        return out.read_bytes()
