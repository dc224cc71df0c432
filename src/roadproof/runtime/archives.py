"""What is known before it is asked: shipped with roadproof, or kept of this user's earlier runs.

An archive for each kind of question has a line for each key. What is kept stands under its key for this
program alone.
"""

import hashlib
import lzma
import os
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Literal, TypeAlias

from roadproof.runtime.cache import keep_bytes, kept_bytes
from roadproof.runtime.canonical import digest
from roadproof.runtime.files import write_whole
from roadproof.runtime.package_data import program, shipped
from roadproof.runtime.records import dataclass
from roadproof.runtime.version import VERSION

SWITCH = "ROADPROOF_KNOWN"
CACHE, JUDGED = "answers", "judged"
Origin: TypeAlias = Literal["shipped", "cache"]


def origins_in_words(origins: Sequence[Origin], total: int) -> str:
    """Return a line that says how many answers of ``total`` were known; empty where none was."""
    if not origins:
        return ""
    of_release = origins.count("shipped")
    earlier = len(origins) - of_release
    parts = [f"{of_release} shipped with roadproof {VERSION}"] if of_release else []
    parts += [f"{earlier} of earlier runs"] if earlier else []
    return f"{len(origins)} of {total} answers were known: {', '.join(parts)}; --fresh computes them again"


def is_off() -> bool:
    """Return whether nothing is known and nothing is kept."""
    return os.environ.get(SWITCH) == "off"


@dataclass(frozen=True)
class Known:
    """A text that is known under a key, and from where.

    What an earlier run kept was judged by it. What is shipped is judged by each program once, which
    ``note_judged`` remembers.
    """

    key: str
    text: str
    origin: Origin

    @property
    def is_judged(self) -> bool:
        """Whether this program has judged the text under this key."""
        return self.origin == "cache" or kept_bytes(JUDGED, self._noted) is not None

    def note_judged(self) -> None:
        """Remember that this program has judged the text under this key."""
        if not self.is_judged:
            keep_bytes(JUDGED, self._noted, b"")

    @property
    def _noted(self) -> str:
        return digest(self.key, self.text, program())


def recall(kind: str, key: str) -> Known | None:
    """Return the JSON text that is known under a key."""
    if key in archived(kind):
        return Known(key, archived(kind)[key], "shipped")
    data = kept_bytes(CACHE, digest(key, program()))
    return None if data is None else Known(key, lzma.decompress(data).decode(), "cache")


def remember(key: str, text: str) -> None:
    """Keep a JSON text for later runs of this program."""
    keep_bytes(CACHE, digest(key, program()), lzma.compress(text.encode(), preset=0))


@cache
def archived(kind: str) -> Mapping[str, str]:
    """Return the answers to questions of a kind that are shipped, as JSON by key; none where they changed."""
    path = archive(shipped("proofs") / "known", kind)
    if not path.is_file():
        return {}
    try:
        seal, _, lines = lzma.decompress(path.read_bytes()).decode().partition("\n")
    except (lzma.LZMAError, EOFError, UnicodeDecodeError):
        return {}
    if seal != hashlib.sha256(lines.encode()).hexdigest():
        return {}
    return {key: text for key, _, text in (line.partition(" ") for line in lines.splitlines())}


def archive(folder: Path, kind: str) -> Path:
    """Return the path of the answers that are shipped."""
    return folder / f"{kind}.xz"


def ship(folder: Path, kind: str, answers: Mapping[str, str]) -> Path:
    """Write answers, as JSON by key, as those that are shipped."""
    lines = "".join(f"{key} {text}\n" for key, text in sorted(answers.items()))
    content = f"{hashlib.sha256(lines.encode()).hexdigest()}\n{lines}"
    path = archive(folder, kind)
    write_whole(path, lzma.compress(content.encode(), preset=9 | lzma.PRESET_EXTREME))
    archived.cache_clear()
    return path
