"""Answers that are known before a question is asked: shipped with roadproof, or of this user's earlier runs.

An answer is kept with the texts of its evidence files under a key, a digest of all that it depends on: the
version, the question, its limits, and the definitions and parameters that it uses. So a changed definition
makes only those answers unknown that depend on it. ``roadproof check`` reads none of this.
"""

import json
import lzma
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from pathlib import Path

from roadproof.errors import InputError
from roadproof.evidence.strict import Fields, JsonObject
from roadproof.runtime.archives import CACHE, JUDGED, Origin, is_off
from roadproof.runtime.cache import keep_bytes, kept_bytes, make_room
from roadproof.runtime.canonical import digest
from roadproof.runtime.files import write_whole
from roadproof.runtime.package_data import program, shipped
from roadproof.runtime.records import dataclass
from roadproof.runtime.version import ANSWERS, VERSION

SCHEMA = "roadproof/known/1"


@dataclass(frozen=True)
class KnownAnswer:
    """A record as it is kept, and the texts of the evidence files that it names."""

    record: JsonObject
    files: Mapping[str, str]
    origin: Origin = "cache"

    @classmethod
    def of(cls, content: object, origin: Origin) -> "KnownAnswer":
        """The answer that plain data say. Raises ``InputError``."""
        data = Fields(content, "a known answer")
        return cls(data.mapping("record"), data.named_texts("files"), origin)

    @property
    def content(self) -> JsonObject:
        """The answer as plain data."""
        return {"record": self.record, "files": dict(self.files)}


@dataclass(frozen=True)
class KnownAnswers:
    """The known answers to one question. ``kind``: of what question; ``asked``: a digest of it."""

    kind: str
    asked: str

    @classmethod
    def to(cls, schema: str, said: Mapping[str, object], more: Mapping[str, str]) -> "KnownAnswers":
        """Those to a question with answers of ``schema``; parameters and files count where they are used."""
        rest = {name: value for name, value in said.items() if name not in ("parameters", "specs")}
        kind = schema.removeprefix("roadproof/").partition("/")[0]
        return cls(kind, _digest(ANSWERS, schema, rest, dict(more)))

    def find(self, name: str, key: str) -> KnownAnswer | None:
        """The answer of this name, where all that it depends on has the digest ``key``."""
        if is_off():
            return None
        found = self.read(shipped("proofs") / "known").get(self.entry(name, key))
        if found is not None:
            return KnownAnswer.of(found, "shipped")
        data = kept_bytes(CACHE, self._cached(name, key))
        return None if data is None else KnownAnswer.of(json.loads(lzma.decompress(data)), "cache")

    def remember(self, name: str, key: str, answer: KnownAnswer) -> None:
        """Keep an answer in the cache of this user, unless known answers are off."""
        if not is_off():
            data = lzma.compress(json.dumps(answer.content).encode(), preset=0)
            keep_bytes(CACHE, self._cached(name, key), data)

    def is_judged(self, key: str, answer: KnownAnswer) -> bool:
        """Whether this program has judged the drives of this answer for this key before."""
        return kept_bytes(JUDGED, self._judged(key, answer)) is not None

    def note_judged(self, key: str, answer: KnownAnswer) -> None:
        """Remember that this program has judged the drives of this answer for this key."""
        keep_bytes(JUDGED, self._judged(key, answer), b"")

    def _judged(self, key: str, answer: KnownAnswer) -> str:
        return _digest(self.kind, self.asked, key, answer.content, program())

    def make_room(self) -> None:
        """Keep the cache within its bounds."""
        for folder in (CACHE, JUDGED):
            make_room(folder)

    @staticmethod
    def entry(name: str, key: str) -> str:
        """Under which name an archive has an answer."""
        return f"{name} {_digest(key)}"

    def read(self, folder: Path) -> Mapping[str, object]:
        """The answers of an archive, by entry; none where it is not there or was changed."""
        return _read(self._archive(folder))

    def ship(self, folder: Path, answers: Mapping[str, object]) -> Path:
        """Write answers by entry into an archive, beside those that it has."""
        every = dict(sorted({**self.read(folder), **answers}.items()))
        text = json.dumps({"schema": SCHEMA, "seal": _digest(every), "answers": every})
        write_whole(self._archive(folder), lzma.compress(text.encode(), preset=9 | lzma.PRESET_EXTREME))
        _read.cache_clear()
        return self._archive(folder)

    def _archive(self, folder: Path) -> Path:
        return folder / f"{self.kind}-{self.asked}.json.xz"

    def _cached(self, name: str, key: str) -> str:
        return _digest(self.kind, self.asked, self.entry(name, key), program())


def shipped_answers(kind: str) -> Iterator[KnownAnswer]:
    """All shipped answers to questions of a kind, such as ``classify``, whatever they depend on."""
    for archive in sorted((shipped("proofs") / "known").glob(f"{kind}-*.json.xz")):
        for content in _read(archive).values():
            yield KnownAnswer.of(content, "shipped")


def _digest(*parts: object) -> str:
    return digest(parts)[:24]


@cache
def _read(path: Path) -> Mapping[str, object]:
    if not path.is_file():
        return {}
    try:
        content = Fields(json.loads(lzma.decompress(path.read_bytes())), str(path))
        answers = content.mapping("answers")
        sound = content.text("schema") == SCHEMA and content.text("seal") == _digest(answers)
    except (OSError, EOFError, lzma.LZMAError, ValueError, InputError):
        return {}
    return answers if sound else {}


def told(origins: Sequence[Origin], total: int) -> Iterator[str]:
    """In a line, how many answers were known, and how to have them computed again."""
    if origins:
        shipped_here = origins.count("shipped")
        kept = len(origins) - shipped_here
        parts = [f"{shipped_here} shipped with roadproof {VERSION}"] if shipped_here else []
        parts += [f"{kept} of earlier runs"] if kept else []
        yield f"{len(origins)} of {total} answers were known: {', '.join(parts)}; --fresh computes them again"
