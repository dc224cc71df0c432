"""Where the evidence of a study is: files in a folder, with one file an answer, or inside the answers.

An answer is kept in ``answers/NAME.json``, written whole, so that several runs can share a folder. It counts
again only where its seal holds and it says what its evidence says (``evidence.journal``).
"""

import hashlib
import json
import os
from collections.abc import Callable, Container, Iterator, Mapping
from dataclasses import field, replace
from functools import partial
from pathlib import Path
from typing import Any

from roadproof.errors import InputError, UsageError
from roadproof.evidence.answers.reader import FindLabel, without_labels
from roadproof.evidence.certificate import (
    SCHEMA,
    Certificate,
    certificate_data,
    read_certificate_data,
    to_json,
)
from roadproof.evidence.drive_file import natural_of, read_drive
from roadproof.evidence.heading import heading
from roadproof.evidence.journal import ANSWERS, HEAD, answers_of, head_of, read_kept, seal_of
from roadproof.evidence.judged import JudgedDrive, KnownDrive
from roadproof.evidence.strict import LARGEST_EVIDENCE, Json, JsonObject, read_json
from roadproof.library.specification import Library, Specification
from roadproof.runtime.files import json_bytes, make_folder, write_json, write_whole
from roadproof.runtime.records import dataclass

INDEX = "index.json"


@dataclass(frozen=True)
class Question:
    """What is asked: ``schema`` is that of the index, ``said`` what the index says once for all answers.

    ``more`` is what else an answer depends on. ``find_label`` knows the names of claims, where they have any.
    ``of_some``: what only some answers depend on, whose keys say it (``Study.key``).
    """

    schema: str
    said: JsonObject
    more: Mapping[str, str]
    library: Library
    find_label: FindLabel = without_labels
    of_some: Mapping[str, str] = field(default_factory=dict)

    @property
    def options(self) -> dict[str, str]:
        """The readings that were chosen."""
        said = self.said.get("options")
        return {name: str(x) for name, x in said.items()} if isinstance(said, dict) else {}

    @property
    def beginning(self) -> dict[str, Any]:
        """How every answer begins: its kind, the version, the library, what begins so that is asked about."""
        from roadproof.drivers.restriction import told

        return {**heading(self.schema, self.library), **told(self.options, self.schema)}

    @property
    def heading(self) -> dict[str, Any]:
        """How the index begins: as ``beginning``, and with what is said once."""
        return {**self.beginning, **self.said}

    @property
    def fingerprint(self) -> str:
        """A short text that changes with the question, with all that the library says, with the version."""
        asked = json.dumps([{**self.more, **self.of_some}, self.heading], sort_keys=True)
        return hashlib.sha256(asked.encode()).hexdigest()[:16]


class EvidenceStore:
    """The evidence of one question in a folder, or in memory where there is none.

    Raises ``UsageError`` where the folder holds another's.
    """

    def __init__(self, folder: Path | None, question: Question) -> None:
        self.folder = folder
        self.library = question.library
        self.find_label = question.find_label
        self.question = "" if folder is None else question.fingerprint
        self.head = head_of(question.schema, self.question, question.said)
        self.written: list[str] = []
        self.names: set[str] = set()
        if folder is not None:
            for place in (folder, folder / ANSWERS):
                make_folder(place)
            if not (folder / HEAD).exists():
                write_json(folder / HEAD, self.head)
            keep_specifications(folder, question.library)

    # --- evidence ------------------------------------------------------------------------------

    def certificate(self, name: str, certificate: Certificate | None) -> str | JsonObject | None:
        """The name of a file with a certificate, or its data; a file has its tableau too, if one is found."""
        if certificate is None:
            return None
        if self.folder is None:
            return certificate_data(certificate)
        if certificate.tableau is None:
            certificate = self._with_tableau(certificate)
        return self._put(self.folder, name, to_json(certificate).encode())

    def _with_tableau(self, certificate: Certificate) -> Certificate:
        from roadproof.evidence.kernel.accept import find_tableau  # here: most answers write no file

        return replace(certificate, tableau=find_tableau(certificate, self.library))

    def drive(self, name: str, drive: JudgedDrive | None) -> str | JsonObject | None:
        """The name of a drive file, or its data."""
        if drive is None or self.folder is None:
            return None if drive is None else drive.as_data()
        return self._put(self.folder, name, json_bytes(drive.as_data()))

    def read_certificate(self, kept: object) -> Certificate | None:
        """The inverse of ``certificate``. Raises ``InputError``."""
        return None if kept is None else read_certificate_data(self._get(kept), str(kept)[:60])

    def read_drive(self, kept: object) -> JudgedDrive | None:
        """The inverse of ``drive``: judged again. Raises ``InputError``."""
        if kept is None:
            return None
        content, where = self._get(kept), str(kept)[:60]
        return JudgedDrive(read_drive(content, where), self.library, natural_of(content, where))

    def adopt(self, files: Mapping[str, str], whole: bool) -> None:
        """Take over the texts of evidence files by name, which were checked when they were made.

        Unless they are ``whole``, a tableau is searched for each certificate.
        """
        if self.folder is None:
            return
        for name, text in files.items():
            content = None if whole else json.loads(text)
            if content is not None and content.get("schema") == SCHEMA:
                self.certificate(name, read_certificate_data(content, name))
            else:
                self._put(self.folder, name, text.encode())

    def _put(self, folder: Path, name: str, content: bytes) -> str:
        refuse_vanished(folder)
        write_whole(folder / name, content)
        self.written.append(name)
        return name

    def _get(self, kept: object) -> object:
        if isinstance(kept, str) and self.folder is not None:
            return read_json(self.folder / kept, LARGEST_EVIDENCE)
        return kept

    # --- answers -------------------------------------------------------------------------------

    def answers(
        self, say: Callable[[str], None] | None = None, known: Container[str] = ()
    ) -> Iterator[tuple[str, JsonObject]]:
        """The answers that count, by name, but for those that are ``known``.

        Of answers that do not count ``say`` is told, and they are asked again.
        """
        if self.folder is None:
            return
        try:
            kept = read_kept(self.folder, known)
        except InputError as error:
            raise UsageError(self._foreign(f"they are not of this version ({error})")) from None
        if kept is None or kept.head.content != self.head:
            raise UsageError(self._foreign("to this one under another library"))
        for line in answers_of(kept, self.library, self.find_label):
            if line.fault and say is not None:
                say(f"a stored answer is invalid and is computed again: {line.fault}")
            elif not line.fault and line.record is not None:
                self.names |= set(line.record.texts("evidence"))
                bare = {k: v for k, v in line.record.content.items() if k not in ("evidence", "seal")}
                yield line.name, bare

    def _foreign(self, otherwise: str) -> str:
        return (
            f"{self.folder} holds the answers to another question, or {otherwise}: name another folder with "
            "--out, or remove it"
        )

    def keep(self, name: str, record: JsonObject, sure: bool) -> None:
        """Keep an answer under its seal, whose evidence has been written before, if it is ``sure``."""
        names, self.written = self.written, []
        self.names |= set(names)
        if self.folder is not None and sure:
            refuse_vanished(self.folder)
            sealed: JsonObject = {"evidence": [*names], **record}
            seal = seal_of(sealed, self.question, self.folder)
            write_json(self.folder / ANSWERS / f"{name}.json", {**sealed, "seal": seal})

    def with_paths(self, data: Any) -> Any:
        """``data`` with the names of evidence files as paths from here."""
        folder = self.folder
        return data if folder is None else _mapped(data, lambda x: str(folder / x) if x in self.names else x)


class EvidenceTexts(EvidenceStore):
    """Evidence held as the texts of its files; drives that are read are judged by ``judge``, or when they are
    looked at.

    Unless it is ``whole``, certificates have no tableau, whose search can take longer than the proof.
    """

    def __init__(
        self, question: Question, files: Mapping[str, str] | None = None, whole: bool = True
    ) -> None:
        super().__init__(None, question)
        self.files, self.whole = dict(files or {}), whole
        self.drives: list[JudgedDrive] = []

    def certificate(self, name: str, certificate: Certificate | None) -> str | None:
        if certificate is None:
            return None
        if not self.whole:
            certificate = replace(certificate, tableau=None)
        elif certificate.tableau is None:
            certificate = self._with_tableau(certificate)
        return self._hold(name, to_json(certificate))

    def drive(self, name: str, drive: JudgedDrive | None) -> str | None:
        return None if drive is None else self._hold(name, json_bytes(drive.as_data()).decode())

    def read_drive(self, kept: object) -> JudgedDrive | None:
        if kept is None:
            return None
        self.drives.append(KnownDrive(partial(self._get, kept), str(kept)[:60], self.library))
        return self.drives[-1]

    def judge(self) -> None:
        """Judge every drive that was read. Raises ``InputError`` where the judge rejects one."""
        for drive in self.drives:
            _ = drive.judgement

    def inside(self, data: Any) -> Any:
        """``data`` with evidence in place of the names of its files, as without a folder."""
        return _mapped(data, lambda x: _without_tableau(self._get(x)) if x in self.files else x)

    def _hold(self, name: str, text: str) -> str:
        self.files[name] = text
        return name

    def _get(self, kept: object) -> object:
        return json.loads(self.files[kept]) if isinstance(kept, str) and kept in self.files else kept


def _without_tableau(evidence: Any) -> Any:
    """As evidence is inside an answer: a tableau is only in files."""
    return {**evidence, "tableau": None} if "tableau" in evidence else evidence


def write_index(folder: Path, data: JsonObject) -> None:
    """The index of a folder; files in it are named as they are from there. Raises ``InputError``."""
    refuse_vanished(folder)
    write_json(folder / INDEX, inside(dict(data), folder))


def refuse_vanished(folder: Path) -> None:
    """Raises ``InputError`` where a folder of answers has gone since they were begun, and their evidence."""
    if not (folder / HEAD).is_file():
        raise InputError(
            f"{folder} or its {HEAD} was removed during the run, and with it evidence "
            "of answers; run the command again to compute the lost answers"
        )


def inside(data: Any, folder: Path) -> Any:
    """``data`` with paths into ``folder`` as they are from there, so that the folder may be moved."""
    begins = f"{folder}{os.sep}"
    return _mapped(data, lambda x: Path(x).relative_to(folder).as_posix() if x.startswith(begins) else x)


def _mapped(data: Any, change: Callable[[str], object]) -> Any:
    """Plain data with every text in it changed."""
    match data:
        case dict():
            return {key: _mapped(value, change) for key, value in data.items()}
        case list():
            return [_mapped(item, change) for item in data]
        case _:
            return change(data) if isinstance(data, str) else data


def specification_names(library: Library) -> list[str]:
    """The names of the users' specification files, as ``check`` looks for them beside the evidence."""
    names = [Path(source.name).name for source in library.files]
    if len(set(names)) < len(names):
        told = ", ".join(source.name for source in library.files)
        raise UsageError(f"two files of --spec have the same name: {told}")
    return names


def readings(specification: Specification, **more: Json) -> JsonObject:
    """What an index says once for all answers: options, ``more``, and the users' specification files."""
    files = specification_names(specification.library)
    return {"options": dict(specification.options), **more, "specs": [*files]}


def keep_specifications(folder: Path, library: Library) -> None:
    """Copies of the users' specification files in a folder of evidence: ``check`` reads them there."""
    for name, source in zip(specification_names(library), library.files, strict=True):
        write_whole(folder / name, source.text.encode("utf-8"))
