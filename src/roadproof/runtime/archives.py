"""Archives of known answers: those that are shipped with roadproof, and those of this user's earlier runs.

An archive for each kind of question has a line for each key. Answers of earlier runs are used only by the
same program (``program_digest``).
"""

import hashlib
import lzma
import os
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Literal, TypeAlias

from roadproof.runtime.cache import load_bytes, store_bytes
from roadproof.runtime.canonical import digest
from roadproof.runtime.package_data import program_digest, shipped_folder
from roadproof.runtime.records import dataclass
from roadproof.runtime.version import VERSION

SWITCH = "ROADPROOF_KNOWN"
CACHE, JUDGED = "answers", "judged"
Origin: TypeAlias = Literal["shipped", "cache"]


def origins_in_words(origins: Sequence[Origin], total: int) -> str:
    """Return a line that counts the known answers among ``total``; empty if there are none."""
    if not origins:
        return ""
    of_release = origins.count("shipped")
    earlier = len(origins) - of_release
    parts = [f"{of_release} shipped with roadproof {VERSION}"] if of_release else []
    parts += [f"{earlier} of earlier runs"] if earlier else []
    return f"{len(origins)} of {total} answers were known: {', '.join(parts)}; --fresh computes them again"


def is_off() -> bool:
    """Return whether known answers are neither used nor stored."""
    return os.environ.get(SWITCH) == "off"


@dataclass(frozen=True)
class KnownText:
    """A text that is known under a key, and its origin.

    An answer of an earlier run was judged when it was stored. A shipped answer is judged once by each
    program, which ``note_judged`` records.
    """

    key: str
    text: str
    origin: Origin

    @property
    def is_judged(self) -> bool:
        """Return whether this program has judged the text under this key."""
        return self.origin == "cache" or load_bytes(JUDGED, self._record_key) is not None

    def note_judged(self) -> None:
        """Record that this program has judged the text under this key."""
        if not self.is_judged:
            store_bytes(JUDGED, self._record_key, b"")

    @property
    def _record_key(self) -> str:
        return digest(self.key, self.text, program_digest())


def recall(kind: str, key: str) -> KnownText | None:
    """Return the JSON text that is known under a key, else None."""
    if key in shipped_answers(kind):
        return KnownText(key, shipped_answers(kind)[key], "shipped")
    data = load_bytes(CACHE, digest(key, program_digest()))
    return None if data is None else KnownText(key, lzma.decompress(data).decode(), "cache")


def remember(key: str, text: str) -> None:
    """Store a JSON text for later runs of this program."""
    store_bytes(CACHE, digest(key, program_digest()), lzma.compress(text.encode(), preset=0))


@cache
def shipped_answers(kind: str) -> Mapping[str, str]:
    """Return the shipped answers to questions of a kind, as JSON by key; empty if the file is damaged."""
    path = archive_path(shipped_folder("proofs") / "known", kind)
    if not path.is_file():
        return {}
    try:
        seal, _, lines = lzma.decompress(path.read_bytes()).decode().partition("\n")
    except (lzma.LZMAError, EOFError, UnicodeDecodeError):
        return {}
    if seal != hashlib.sha256(lines.encode()).hexdigest():
        return {}
    return {key: text for key, _, text in (line.partition(" ") for line in lines.splitlines())}


def archive_path(folder: Path, kind: str) -> Path:
    """Return the path of the shipped answers to questions of a kind."""
    return folder / f"{kind}.xz"
