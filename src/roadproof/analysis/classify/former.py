"""What earlier runs left in a folder of classes: answers to the same question stay, all else goes."""

from pathlib import Path

from roadproof.analysis.study.evidence_store import INDEX, Question
from roadproof.errors import InputError
from roadproof.evidence.answers.classify import SCHEMA
from roadproof.evidence.journal import ANSWERS, HEAD, Journal, head_of, read_kept
from roadproof.evidence.strict import LARGEST_INDEX, read_json

KINDS = ("drives", "proofs")


def make_room(folder: Path, question: Question) -> None:
    """Remove evidence of classes that are no more, which speaks of another classes.spec, and its index.

    Only what an earlier run has written: a folder without its traces is left alone.
    """
    if not (_says(folder / HEAD, "of") or _says(folder / INDEX, "schema")):
        return
    evidence = [path for kind in KINDS for path in (folder / kind).glob("*.json")]
    kept = _kept(folder, question)
    if kept is None:
        for path in (folder / HEAD, *(folder / ANSWERS).glob("*.json")):
            path.unlink(missing_ok=True)
    lines = [] if kept is None else [line.record for line in kept.lines if line.record is not None]
    named = {name for record in lines for name in record.texts("evidence")}
    (folder / INDEX).unlink(missing_ok=True)
    for path in evidence:
        if path.relative_to(folder).as_posix() not in named:
            path.unlink(missing_ok=True)


def _says(path: Path, field: str) -> bool:
    try:
        said = read_json(path, LARGEST_INDEX)
    except InputError:
        return False
    return isinstance(said, dict) and said.get(field) == SCHEMA


def _kept(folder: Path, question: Question) -> Journal | None:
    """The answers of a run that asked the same."""
    try:
        kept = read_kept(folder)
    except InputError:
        return None
    head = head_of(question.schema, question.fingerprint, question.said)
    return kept if kept is not None and kept.head.content == head else None
