"""The files of evidence in folders, and the reader of a certificate or drive file."""

from collections.abc import Collection, Iterator, Sequence
from pathlib import Path

from roadproof.core_record import DRIVES
from roadproof.errors import InputError
from roadproof.evidence.certificate import Certificate
from roadproof.evidence.certificate_file import read_certificate_data
from roadproof.evidence.drive_file import DriveFile, read_drive
from roadproof.evidence.finding import Acceptance, Finding
from roadproof.evidence.strict import Fields, read_json
from roadproof.reasons import ReasonKind


def files_of(paths: Sequence[Path], excluded: Collection[Path] = ()) -> tuple[list[Path], list[Finding]]:
    """Return the JSON files among paths and in folders below them, and a finding for each symbolic link.

    ``excluded``: folders to skip. Raises ``InputError`` for a path that does not exist or holds no JSON file.
    """
    files: list[Path] = []
    links: list[Finding] = []
    for path in paths:
        if not path.is_dir():
            if not path.exists():
                raise InputError(f"{path} does not exist")
            files.append(path)
            continue
        inside = [*_walk(path, excluded)]
        evidence = [x for x in inside if x.suffix == ".json" and not x.is_symlink()]
        symlinks = [x for x in inside if x.is_symlink()]
        if not evidence and not symlinks and not any(x.is_relative_to(path) for x in excluded):
            raise InputError(f"{path} holds no .json file: name a folder with certificates or drive files")
        files += evidence
        links += [Finding(str(x), "", Acceptance.REJECTED, ReasonKind.LINK()) for x in symlinks]
    return [*dict.fromkeys(files)], links


def _walk(folder: Path, excluded: Collection[Path]) -> Iterator[Path]:
    """Yield files and links below a folder, in order, without the ``excluded`` folders."""
    waiting = [] if folder in excluded else [folder]
    while waiting:
        for path in sorted(waiting.pop(0).iterdir()):
            if path.is_dir() and not path.is_symlink():
                waiting += [] if path in excluded else [path]
            else:
                yield path


def read_evidence(path: Path) -> Certificate | DriveFile:
    """Return the certificate or drive file at a path. Raises ``InputError``."""
    content = read_json(path)
    if Fields(content, str(path)).text("schema") in DRIVES:
        return read_drive(content, str(path))
    return read_certificate_data(content, str(path))
