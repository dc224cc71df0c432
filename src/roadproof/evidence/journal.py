"""Journals: answers that a run has kept as they came, each under a seal.

In a folder of evidence ``question.json`` says what was asked, and each file ``answers/NAME.json`` is an
answer with the names of its evidence files, and the seal: a digest of the answer and of the bytes of those
files. Before, both were lines of one file, ``answers.jsonl``, which is still read. A seal tells damage and
carelessness, not malice, since anybody can compute it. So an answer also has to say what its evidence says,
and ``roadproof check`` checks that evidence again.
"""

import hashlib
import json
from collections.abc import Callable, Container, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

from roadproof.errors import InputError, RoadproofError
from roadproof.evidence.answers.entry import Entry, evidence_name, mismatch, read_evidence, stray_evidence
from roadproof.evidence.answers.read import faults_of_record, read_record, record_fields
from roadproof.evidence.answers.reader import FindLabel, without_labels
from roadproof.evidence.refutation import judge_trace
from roadproof.evidence.strict import LARGEST_INDEX, Fields, Json, JsonObject, parse_json, read_json
from roadproof.library.specification import Library
from roadproof.runtime.files import read_limited, read_text
from roadproof.runtime.records import dataclass

NAME = "answers.jsonl"
HEAD, ANSWERS = "question.json", "answers"
SCHEMA = "roadproof/journal/1"
_HEAD = ("schema", "of", "question", "said")


@dataclass(frozen=True)
class Line:
    """One answer of a journal, with its number or its name; ``fault`` says why it does not count."""

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
    """The first line of a journal."""
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
        return read_journal(folder / NAME) if (folder / NAME).exists() else None
    head, fields = _head(read_json(folder / HEAD, LARGEST_INDEX), folder / HEAD, str(folder / HEAD))
    found = (folder / ANSWERS).glob("*.json")
    paths = sorted(x for x in found if not x.name.startswith(".") and x.stem not in but)
    read = [
        _line(path.stem, path, partial(read_json, path, LARGEST_INDEX), str(path), fields, head)
        for path in paths
    ]
    return Journal(folder / HEAD, head, tuple(read))


def read_journal(path: Path) -> Journal:
    """A journal, each line with its seal checked. Raises ``InputError`` where it is none."""
    first, *lines = read_text(path, LARGEST_INDEX, "roadproof reads no larger journals").split("\n")
    head, fields = _head(parse_json(first, f"{path}, line 1"), path, str(path))
    read = [
        _line(str(number), path, partial(parse_json, text, where), where, fields, head)
        for number, text in enumerate(lines, 2)
        for where in (f"{path}, line {number}",)
        if text
    ]
    if lines and lines[-1] and read[-1].record is None:  # cut short, as when a run is killed
        read.pop()
    return Journal(path, head, tuple(read))


def _head(content: object, path: Path, where: str) -> tuple[Fields, tuple[str, ...]]:
    """What was asked, and the fields that each answer has."""
    head = Fields(content, where, _HEAD)
    if head.text("schema") != SCHEMA:
        raise InputError(f"{path}: schema={head.text('schema')!r}, but a journal has {SCHEMA!r}")
    return head, ("evidence", "seal", *record_fields(head.text("of"), str(path)))


def _line(
    name: str, path: Path, read: Callable[[], object], where: str, fields: Sequence[str], head: Fields
) -> Line:
    try:
        record = Fields(read(), where, fields)
    except InputError as error:
        return Line(name, path, None, str(error))
    try:
        for k, file in enumerate(record.texts("evidence"), 1):
            evidence_name(f"{where}, evidence {k}", "evidence", file)
        if record.text("seal") != seal_of(record.content, head.text("question"), Path(head.where).parent):
            return Line(
                name, path, record, f"{where}: answer and evidence are not what its seal was made for"
            )
    except InputError as error:
        return Line(name, path, record, str(error))
    return Line(name, path, record)


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
    name = None if line.path == journal.path else line.name
    return faults_of_record(journal.head, record, name, entries, library, in_index)


def _fault_of(entry: Entry, folder: Path) -> str:
    fault = entry.fault or stray_evidence(entry)
    if fault or entry.shows == "nothing":
        return fault
    if entry.file is None:
        claimed = entry.common.specification, entry.claim or "", entry.where, entry.assuming
        return judge_trace(entry.trace, *claimed)[1]
    return mismatch(entry, read_evidence(folder / entry.file))
