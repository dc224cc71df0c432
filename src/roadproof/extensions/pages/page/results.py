"""Which results are in files and folders: answers of ``--json``, folders of answers, evidence alone."""

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
from roadproof.questions.checking import is_question, read_folder
from roadproof.questions.data import QUESTION
from roadproof.questions.views import view_data

Words: TypeAlias = Mapping[int, str]
"""What scenarios are called."""
TRAFFIC = "results.json"


@dataclass(frozen=True)
class Result:
    """An answer as plain data; ``folder``: where the evidence lies that it names, None where it has none.

    ``id``: its place on the page. ``digest``: the SHA-256 of its file.
    """

    name: str
    schema: str
    data: Mapping[str, Json]
    folder: Path | None = None
    id: int = 0
    digest: str = ""

    @property
    def kind(self) -> str:
        """``overlap`` of roadproof/overlap/1."""
        return self.schema.split("/")[1] if self.schema.count("/") == 2 else self.schema


@dataclass(frozen=True)
class Given:
    """``results``, in the order in which they were named, and files of ``evidence`` that are of none."""

    results: tuple[Result, ...]
    evidence: tuple[Path, ...]

    @property
    def checkable(self) -> tuple[Path, ...]:
        """What ``check`` reads: folders of answers, and files alone."""
        folders = [x.folder for x in self.results if x.folder is not None and x.kind != "traffic-results"]
        return (*dict.fromkeys(folders), *self.evidence)


def read_results(paths: Sequence[Path], given: Sequence[Path] = ()) -> Given:
    """What is in files and folders. Raises ``InputError`` for what is not there, or is no result.

    ``given``: the specification files that it was made with.
    """
    results: list[Result] = []
    evidence: list[Path] = []
    for path in paths:
        if not path.exists():
            raise InputError(f"{path} does not exist: name a file or a folder that a command has written")
        found = [*_in_folder(path)] if path.is_dir() else [path]
        if not found:
            raise InputError(
                f"{path} holds no result: name a folder or a JSON answer that a command has written"
            )
        for file in found:
            if file.name == QUESTION:
                results.append(_answered(file.parent, given, len(results)))
                continue
            schema, data, digest = _read(file)
            if schema in SCHEMAS:
                evidence.append(file)
            else:
                here = file.parent if file.name == TRAFFIC else _beside(file)
                name = file.parent.name if file.name == TRAFFIC else file.stem
                results.append(Result(name or str(file), schema, data, here, len(results), digest))
    return Given(tuple(results), tuple(dict.fromkeys(evidence)))


def _answered(folder: Path, given: Sequence[Path], number: int) -> Result:
    """The view of a folder of answers."""
    read = read_folder(folder, given)
    data = view_data(read.question, read.answers, Path())
    if read.question.kind == ClassifyQuestion.kind:
        data = with_shares(data, folder)
    digest = hashlib.sha256((folder / QUESTION).read_bytes()).hexdigest()
    return Result(folder.name or str(folder), str(data["schema"]), data, folder, number, digest)


def _beside(file: Path) -> Path | None:
    """The folder in which the evidence of an answer of ``--json`` lies."""
    folder = file.with_name(f"{file.stem}-evidence")
    return folder if is_question(folder) else None


def _in_folder(folder: Path) -> Iterator[Path]:
    """The question of a folder, or its results; without these the evidence in it and below."""
    whole = folder / QUESTION if is_question(folder) else folder / TRAFFIC
    if whole.is_file():
        yield whole
        return
    for path in sorted(folder.iterdir()):
        if path.is_symlink():
            continue
        if path.is_dir():
            yield from _in_folder(path)
        elif path.suffix == ".json":
            yield path


def _read(file: Path) -> tuple[str, Mapping[str, Json], str]:
    """Schema, content, and SHA-256 of a file."""
    data = Fields(read_json(file, LARGEST_INDEX), str(file))
    schema = data.text("schema") if "schema" in data.content else ""
    if not schema.startswith("roadproof/"):
        raise InputError(f"{file} is not a result of roadproof: its schema does not begin with roadproof/")
    return schema, data.content, hashlib.sha256(file.read_bytes()).hexdigest()
