"""Answers that are shipped with roadproof: an archive for each kind of question, by key."""

import json
import lzma
from collections.abc import Mapping
from functools import cache
from pathlib import Path

from roadproof.runtime.canonical import digest
from roadproof.runtime.files import write_whole
from roadproof.runtime.package_data import shipped


@cache
def archived(kind: str) -> Mapping[str, object]:
    """Return the answers to questions of a kind that are shipped, by key; none where they were changed."""
    path = archive(shipped("proofs") / "known", kind)
    if not path.is_file():
        return {}
    content = json.loads(lzma.decompress(path.read_bytes()))
    answers: Mapping[str, object] = content["answers"]
    return answers if content["seal"] == digest(answers) else {}


def archive(folder: Path, kind: str) -> Path:
    """Return the path of the answers that are shipped."""
    return folder / f"{kind}.json.xz"


def ship(folder: Path, kind: str, answers: Mapping[str, object]) -> Path:
    """Write answers by key as those that are shipped."""
    content = {"seal": digest(answers), "answers": dict(sorted(answers.items()))}
    path = archive(folder, kind)
    write_whole(path, lzma.compress(json.dumps(content).encode(), preset=9 | lzma.PRESET_EXTREME))
    archived.cache_clear()
    return path
