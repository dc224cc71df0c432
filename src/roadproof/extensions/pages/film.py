"""Frames as a GIF or MP4 file: the one home of Pillow and of the program ffmpeg."""

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
    """Frames, of which ``draw`` gives the RGBA bytes.

    ``size``: pixels, both even; ``grain``: seconds a frame; ``pause``: those of the last one;
    ``still``: the number of the frame that shows most.
    """

    size: tuple[int, int]
    draw: Callable[[int], bytes]
    count: int
    grain: Fraction
    pause: Fraction
    still: int


def need(ending: str) -> None:
    """Raises ``MissingSolverError`` where files of this ending need a program that is not there."""
    if ending == ".mp4" and shutil.which("ffmpeg") is None:
        raise MissingSolverError(_MISSING)


def as_gif(film: Film) -> bytes:
    """An endless GIF file. Raises ``MissingSolverError`` without Pillow."""
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
    """The colours, as RGB, that most pixels of some frames have; flat areas keep theirs exactly.

    Pillow cannot tell apart colours that differ in their last bits, so that only one of them is left.
    """
    counted: Counter[int] = Counter()
    for k in {film.still, *range(0, film.count, max(1, film.count // _SAMPLES)), film.count - 1}:
        counted.update(memoryview(film.draw(k)).cast("I"))
    found: dict[tuple[int, ...], bytes] = {}
    for pixel, _ in counted.most_common():
        rgb = pixel.to_bytes(4, sys.byteorder)[:3]
        found.setdefault(tuple(x >> 3 for x in rgb), rgb)
    return [*found.values()][:COLOURS]


def as_mp4(film: Film) -> bytes:
    """An MP4 file. Raises ``MissingSolverError`` where ffmpeg is missing or cannot write one."""
    need(".mp4")
    raw = ("-f", "rawvideo", "-pix_fmt", "rgba", "-s", f"{film.size[0]}x{film.size[1]}")
    rate = ("-r", f"{1 / film.grain}", "-i", "-")
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "film.mp4"
        told = ("-pix_fmt", "yuv420p", "-movflags", "+faststart", "-y", str(out))
        command = ["ffmpeg", "-loglevel", "error", *raw, *rate, *told]
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
            complaints_of = ran.wait()
            complaints.seek(0)
            said = complaints.read().decode(errors="replace").strip().splitlines()
        if complaints_of or not out.is_file():
            why = said[-1] if said else f"exit code {complaints_of}"
            raise MissingSolverError(f"ffmpeg cannot write mp4: {why}; install a full build, or write gif")
        return out.read_bytes()
