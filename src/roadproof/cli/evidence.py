"""Where evidence goes: files in a folder that a journal keeps, or inside the answer where there is none."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from roadproof.cli.options import json_text, write_text

if TYPE_CHECKING:
    from roadproof.analysis.journal import Journal


def evidence_folder(out: Path | None, target: str | None) -> Path | None:
    """DIR of --out, or FILE-evidence beside the file of --json, or none."""
    if out is None and target not in (None, "-"):
        path = Path(str(target))
        return path.with_name(f"{path.stem}-evidence")
    return out


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
