"""Files of evidence in folders, and the folder of a certificate or a drive file alone."""

from collections.abc import Collection, Iterator, Sequence
from pathlib import Path

from roadproof.errors import InputError
from roadproof.evidence import certificate
from roadproof.evidence.certificate import Certificate
from roadproof.evidence.drive_file import SCHEMAS_READ, DriveFile, read_drive
from roadproof.evidence.finding import Acceptance, Finding
from roadproof.evidence.strict import Fields, read_json
from roadproof.reasons import Why


def files_of(paths: Sequence[Path], but: Collection[Path] = ()) -> tuple[list[Path], list[Finding]]:
    """Return the JSON files among paths and in folders below them, and a finding for each link.

    ``but``: folders that are left out. Raises ``InputError`` for a path that is not there or holds nothing.
    """
    files: list[Path] = []
    links: list[Finding] = []
    for path in paths:
        if not path.is_dir():
            if not path.exists():
                raise InputError(f"{path} does not exist")
            files.append(path)
            continue
        inside = [*_walk(path, but)]
        found = [x for x in inside if x.suffix == ".json" and not x.is_symlink()]
        refused = [x for x in inside if x.is_symlink()]
        if not found and not refused and not any(x.is_relative_to(path) for x in but):
            raise InputError(f"{path} holds no .json file: name a folder with certificates or drive files")
        files += found
        links += [Finding(str(x), "", Acceptance.REJECTED, Why.LINK()) for x in refused]
    return [*dict.fromkeys(files)], links


def _walk(folder: Path, but: Collection[Path]) -> Iterator[Path]:
    """Files and links below a folder, in order, but for the folders ``but``."""
    waiting = [] if folder in but else [folder]
    while waiting:
        for path in sorted(waiting.pop(0).iterdir()):
            if path.is_dir() and not path.is_symlink():
                waiting += [] if path in but else [path]
            else:
                yield path


def read_evidence(path: Path) -> Certificate | DriveFile:
    """Return a certificate or a drive file. Raises ``InputError``."""
    content = read_json(path)
    if Fields(content, str(path)).text("schema") in SCHEMAS_READ:
        return read_drive(content, str(path))
    return certificate.read_certificate_data(content, str(path))
