"""Files of drives: one by one, or in a folder."""

from pathlib import Path

from roadproof.core_record import DRIVES
from roadproof.evidence.strict import read_json


def drive_files(path: Path) -> tuple[Path, ...]:
    """Return the drive files of a path: itself, or those in the folder; none where it has recordings.

    Raises ``InputError``.
    """
    if path.suffix == ".json" and path.is_file():
        return (path,)
    return tuple(x for x in sorted(path.glob("*.json")) if _is_drive(x)) if path.is_dir() else ()


def _is_drive(path: Path) -> bool:
    content = read_json(path)
    return isinstance(content, dict) and content.get("schema") in DRIVES
