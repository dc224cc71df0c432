"""Where evidence goes: files in a folder that a journal keeps, or inside the answer where there is none."""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from roadproof.cli.options import json_text, write_text
from roadproof.errors import UsageError

if TYPE_CHECKING:
    from roadproof.analysis.journal import Journal
    from roadproof.analysis.requests import Asked


def evidence_folder(out: Path | None, target: str | None) -> Path | None:
    """DIR of --out, or FILE-evidence beside the file of --json, or none."""
    if out is None and target not in (None, "-"):
        path = Path(str(target))
        return path.with_name(f"{path.stem}-evidence")
    return out


def keep_specifications(folder: Path | None, specs: Sequence[Path]) -> list[str]:
    """The names of specification files, with copies in a folder of evidence: ``check`` reads them there."""
    from roadproof.files import write_whole
    from roadproof.spec.library import read_specification

    names = [path.name for path in specs]
    if len(set(names)) < len(names):
        raise UsageError(f"two files of --spec have the same name: {', '.join(map(str, specs))}")
    if folder is not None:
        for path in specs:
            write_whole(folder / path.name, read_specification(path).text.encode("utf-8"))
    return names


def said_once(asked: "Asked", folder: Path | None) -> dict[str, Any]:
    """What an index says of all its answers: readings, values of parameters, specification files."""
    _, specification = asked.load()
    values = {name: str(value) for name, value in sorted(asked.values.items())}
    return {
        "options": dict(specification.options),
        "parameters": values,
        "specs": keep_specifications(folder, asked.specs),
    }


def write_index(folder: Path, data: Mapping[str, Any]) -> None:
    """As ``study.shelf.write_index``."""
    from roadproof.study import shelf

    shelf.write_index(folder, data)


class Evidence:
    """The evidence of one answer; ``files`` are the names of those that were written."""

    def __init__(self, journal: "Journal | None") -> None:
        self.journal = journal
        self.files: list[str] = []

    def certificate(self, name: str, text: str) -> str:
        """The path of a file with a certificate's text, or the text."""
        return text if self.journal is None else self._written(self.journal.folder, name, text)

    def drive(self, name: str, data: Mapping[str, Any]) -> str | dict[str, Any]:
        """The path of a drive file, or its data."""
        return (
            dict(data) if self.journal is None else self._written(self.journal.folder, name, json_text(data))
        )

    def _written(self, folder: Path, name: str, text: str) -> str:
        write_text(folder / name, text)
        self.files.append(name)
        return str(folder / name)


def read_drive(kept: str | Mapping[str, Any]) -> Mapping[str, Any]:
    """A drive file's data, wherever ``Evidence.drive`` has put it."""
    return json.loads(Path(kept).read_text("utf-8")) if isinstance(kept, str) else kept
