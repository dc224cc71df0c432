"""Reads the results in files and folders: answers of ``--json``, folders of answers, single files of
evidence.
"""

import hashlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

from roadproof.errors import InputError
from roadproof.evidence.checking import SCHEMAS
from roadproof.evidence.strict import LARGEST_INDEX, Fields, Json, read_json
from roadproof.extensions.surveys.classify.question import ClassifyQuestion
from roadproof.extensions.surveys.classify.shares import with_shares
from roadproof.questions.checking import QuestionFolder, is_question, read_folder
from roadproof.questions.question import QUESTION
from roadproof.questions.views import view_data

Words: TypeAlias = Mapping[int, str]
"""The names of scenarios by number."""
TRAFFIC = "results.json"


@dataclass(frozen=True)
class PageResult:
    """An answer as plain data; ``folder``: the folder of its evidence, None without evidence.

    ``id``: its number on the page. ``digest``: the SHA-256 of its file.
    """

    name: str
    schema: str
    data: Mapping[str, Json]
    folder: Path | None = None
    id: int = 0
    digest: str = ""

    @property
    def kind(self) -> str:
        """The kind of answer: ``overlap`` for schema roadproof/overlap/1."""
        return self.schema.split("/")[1] if self.schema.count("/") == 2 else self.schema


@dataclass(frozen=True)
class PageSources:
    """The ``results`` in the order of their paths, and files of ``evidence`` that belong to none of them.

    ``folders``: the folders of answers among the results, as they were read.
    """

    results: tuple[PageResult, ...]
    evidence: tuple[Path, ...]
    folders: tuple[QuestionFolder, ...] = ()

    @property
    def checkable(self) -> tuple[Path, ...]:
        """The folders and files that ``check`` can read."""
        folders = [x.folder for x in self.results if x.folder is not None and x.kind != "traffic-results"]
        return (*dict.fromkeys(folders), *self.evidence)


def read_results(paths: Sequence[Path], specs: Sequence[Path] = ()) -> PageSources:
    """Return the results and the evidence in files and folders.

    ``specs``: the specification files that they were made with. Raises ``InputError`` for a missing file or
    one that is no result.
    """
    results: list[PageResult] = []
    evidence: list[Path] = []
    folders: list[QuestionFolder] = []
    for path in paths:
        if not path.exists():
            raise InputError(f"{path} does not exist: name a file or a folder that a command has written")
        files = [*_result_files(path)] if path.is_dir() else [path]
        if not files:
            raise InputError(
                f"{path} holds no result: name a folder or a JSON answer that a command has written"
            )
        for file in files:
            if file.name == QUESTION:
                folders.append(read_folder(file.parent, specs))
                results.append(_answered_question(folders[-1], len(results)))
                continue
            schema, data, digest = _read_result(file)
            if schema in SCHEMAS:
                evidence.append(file)
            else:
                here = file.parent if file.name == TRAFFIC else _evidence_folder(file)
                name = file.parent.name if file.name == TRAFFIC else file.stem
                results.append(PageResult(name or str(file), schema, data, here, len(results), digest))
    return PageSources(tuple(results), tuple(dict.fromkeys(evidence)), tuple(folders))


def _answered_question(stored: QuestionFolder, number: int) -> PageResult:
    """Return the combined answers of a folder as a result."""
    folder = stored.folder
    data = view_data(stored.question, stored.answers, Path())
    schema = Fields(data, str(folder)).text("schema")
    if stored.question.kind == ClassifyQuestion.kind:
        data = with_shares(data, folder)
    digest = hashlib.sha256((folder / QUESTION).read_bytes()).hexdigest()
    return PageResult(folder.name or str(folder), schema, data, folder, number, digest)


def _evidence_folder(file: Path) -> Path | None:
    """Return the folder with the evidence of an answer of ``--json``, None where there is none."""
    folder = file.with_name(f"{file.stem}-evidence")
    return folder if is_question(folder) else None


def _result_files(folder: Path) -> Iterator[Path]:
    """Yield the question of a folder, or its results; without these, the evidence in it and below."""
    whole = folder / QUESTION if is_question(folder) else folder / TRAFFIC
    if whole.is_file():
        yield whole
        return
    for path in sorted(folder.iterdir()):
        if path.is_symlink():
            continue
        if path.is_dir():
            yield from _result_files(path)
        elif path.suffix == ".json":
            yield path


def _read_result(file: Path) -> tuple[str, Mapping[str, Json], str]:
    """Return the schema, content and SHA-256 of a file."""
    data = Fields(read_json(file, LARGEST_INDEX), str(file))
    schema = data.text("schema") if "schema" in data.content else ""
    if not schema.startswith("roadproof/"):
        raise InputError(f"{file} is not a result of roadproof: its schema does not begin with roadproof/")
    return schema, data.content, hashlib.sha256(file.read_bytes()).hexdigest()
