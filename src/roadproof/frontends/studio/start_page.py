"""What the studio begins with: the files that were named on the command line."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from roadproof.errors import InputError
from roadproof.evidence.strict import read_json
from roadproof.frontends.studio.requests import form
from roadproof.library.specification import read_specification


@dataclass(frozen=True)
class Begun:
    """``text``: the definitions that the editor begins with; ``drives``: drive files by name."""

    text: str = ""
    drives: tuple[tuple[str, Any], ...] = ()

    def as_data(self) -> dict[str, Any]:
        """As plain data, with the options that the page offers."""
        drives = [{"name": name, "drive": x} for name, x in self.drives]
        return {"text": self.text, "drives": drives, "form": form()}


def begin_with(paths: Sequence[Path]) -> Begun:
    """Read specification files (.spec) and drive files (.json). Raises ``InputError``."""
    texts: list[str] = []
    drives: list[tuple[str, Any]] = []
    for path in paths:
        if path.suffix == ".json":
            drives.append((path.name, read_json(path)))
        elif path.suffix == ".spec":
            texts.append(read_specification(path).text)
        else:
            raise InputError(f"{path}: the studio opens specification files (.spec) and drive files (.json)")
    return Begun("\n".join(texts), tuple(drives))
