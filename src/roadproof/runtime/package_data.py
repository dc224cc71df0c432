"""The folders that are shipped beside the code: models and proofs."""

import hashlib
import os
from functools import cache
from pathlib import Path


def shipped_folder(folder: str) -> Path:
    """Return the folder ``models`` or ``proofs``, in a checkout as in an installed wheel.

    The wheel carries them inside the package (pyproject.toml, force-include); a checkout has them at its
    root. Raises ``FileNotFoundError`` if neither exists: the installation is broken.
    """
    package = Path(__file__).parents[1]
    for place in (package / folder, package.parents[1] / folder):
        if place.is_dir():
            return place
    raise FileNotFoundError(f"roadproof was installed without its folder '{folder}'")


@cache
def program_digest() -> str:
    """Return a digest of all files of the program and of the shipped models, without compiled files.

    It is part of the keys of cached answers, so that they are used by the same program only.
    """
    return folder_digest(Path(__file__).parents[1], shipped_folder("models"))


def folder_digest(*places: Path) -> str:
    """Return a digest of all files in folders, without compiled files, shipped models and proofs."""
    content = hashlib.sha256()
    for place in places:
        for folder, folders, names in os.walk(place):
            folders[:] = sorted(x for x in folders if x not in ("__pycache__", "models", "proofs"))
            for name in sorted(x for x in names if not x.endswith((".pyc", ".pyo"))):
                path = Path(folder, name)
                content.update(f"{path.relative_to(place).as_posix()}\0{path.stat().st_size}\0".encode())
                content.update(path.read_bytes())
    return content.hexdigest()
