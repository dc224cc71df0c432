"""Journals: answers that a run has kept as they came, each under a seal.

In a folder of evidence ``question.json`` says what was asked, and each file ``answers/NAME.json`` is an
answer with the names of its evidence files, and the seal: a digest of the answer and of the bytes of those
files. A seal tells damage and carelessness, not malice, since anybody can compute it. So an answer also has
to say what its evidence says, and ``roadproof check`` checks that evidence again.
"""

import hashlib
import json
from collections.abc import Container, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from roadproof.errors import InputError, RoadproofError
from roadproof.evidence.answers.entry import Entry, evidence_name, mismatch, read_evidence, stray_evidence
from roadproof.evidence.answers.read import faults_of_record, read_record, record_fields
from roadproof.evidence.answers.reader import FindLabel, without_labels
from roadproof.evidence.refutation import judge_trace
from roadproof.evidence.strict import LARGEST_INDEX, Fields, Json, JsonObject, read_json
from roadproof.library.specification import Library
from roadproof.runtime.files import read_limited
from roadproof.runtime.records import dataclass

HEAD, ANSWERS = "question.json", "answers"
SCHEMA = "roadproof/journal/1"
_HEAD = ("schema", "of", "question", "said")


@dataclass(frozen=True)
class Line:
    """One answer of a journal with its name; ``fault`` says why it does not count."""

    name: str
    path: Path
    record: Fields | None
    fault: str = ""


@dataclass(frozen=True)
class Journal:
    """The answers of a folder; ``head`` says what was asked."""

    path: Path
    head: Fields
    lines: tuple[Line, ...]


def head_of(schema: str, question: str, said: Mapping[str, Json]) -> JsonObject:
    """The content of ``question.json``."""
    return {"schema": SCHEMA, "of": schema, "question": question, "said": dict(said)}


def seal_of(record: Mapping[str, Json], question: str, folder: Path) -> str:
    """A digest of an answer, of what was asked, and of the bytes of its evidence. Raises ``InputError``."""
    bare = {name: value for name, value in record.items() if name != "seal"}
    digest = hashlib.sha256(json.dumps([question, bare], sort_keys=True).encode())
    for name in Fields(record, "a kept answer").texts("evidence"):
        digest.update(
            hashlib.sha256(read_limited(folder / name, LARGEST_INDEX, "it is no evidence")).digest()
        )
    return digest.hexdigest()


def read_kept(folder: Path, but: Container[str] = ()) -> Journal | None:
    """The answers that are kept in a folder, each with its seal checked; None where there are none.

    ``but``: names of answers that are passed over. Raises ``InputError``.
    """
    if not (folder / HEAD).exists():
        return None
    head, fields = _head(folder / HEAD)
    found = (folder / ANSWERS).glob("*.json")
    paths = sorted(x for x in found if not x.name.startswith(".") and x.stem not in but)
    return Journal(folder / HEAD, head, tuple(_line(path, fields, head) for path in paths))


def _head(path: Path) -> tuple[Fields, tuple[str, ...]]:
    """What was asked, and the fields that each answer has."""
    head = Fields(read_json(path, LARGEST_INDEX), str(path), _HEAD)
    if head.text("schema") != SCHEMA:
        raise InputError(f"{path}: schema={head.text('schema')!r}, but a journal has {SCHEMA!r}")
    return head, ("evidence", "seal", *record_fields(head.text("of"), str(path)))


def _line(path: Path, fields: Sequence[str], head: Fields) -> Line:
    try:
        record = Fields(read_json(path, LARGEST_INDEX), str(path), fields)
    except InputError as error:
        return Line(path.stem, path, None, str(error))
    try:
        for k, file in enumerate(record.texts("evidence"), 1):
            evidence_name(f"{path}, evidence {k}", "evidence", file)
        if record.text("seal") != seal_of(record.content, head.text("question"), Path(head.where).parent):
            fault = f"{path}: answer and evidence are not what its seal was made for"
            return Line(path.stem, path, record, fault)
    except InputError as error:
        return Line(path.stem, path, record, str(error))
    return Line(path.stem, path, record)


def answers_of(journal: Journal, library: Library, find_label: FindLabel = without_labels) -> Iterator[Line]:
    """The lines with all that can be said without a solver: does each answer say what its evidence says?

    Whether a drive holds and a certificate proves is for ``roadproof check``.
    """
    for line in journal.lines:
        if line.record is None or line.fault:
            yield line
            continue
        try:
            entries = read_record(journal.head, line.record, library, find_label)
            fault = next(filter(None, (_fault_of(entry, journal.path.parent) for entry in entries)), "")
            fault = fault or next(faults_of_line(journal, line, line.record, entries, library), "")
        except RoadproofError as error:
            fault = str(error)
        yield replace(line, fault=fault)


def faults_of_line(
    journal: Journal,
    line: Line,
    record: Fields,
    entries: Sequence[Entry],
    library: Library,
    in_index: bool = False,
) -> Iterator[str]:
    """What an answer says otherwise than its name and its entries. Raises ``InputError``.

    ``in_index``: what an index says in the same words is looked at there.
    """
    return faults_of_record(journal.head, record, line.name, entries, library, in_index)


def _fault_of(entry: Entry, folder: Path) -> str:
    fault = entry.fault or stray_evidence(entry)
    if fault or entry.shows == "nothing":
        return fault
    if entry.file is None:
        claimed = entry.common.specification, entry.claim or "", entry.where, entry.assuming
        return judge_trace(entry.trace, *claimed)[1]
    return mismatch(entry, read_evidence(folder / entry.file))
