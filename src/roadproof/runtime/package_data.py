"""Where the files lie that come with roadproof beside its code: models and proofs."""

import hashlib
import os
from functools import cache
from pathlib import Path


def shipped(folder: str) -> Path:
    """The folder ``models`` or ``proofs``, in a checkout as in an installed wheel.

    The wheel carries them inside the package (pyproject.toml, force-include); a checkout has them at
    its root. Raises ``FileNotFoundError`` where neither is there: the installation is broken.
    """
    package = Path(__file__).parents[1]
    for place in (package / folder, package.parents[1] / folder):
        if place.is_dir():
            return place
    raise FileNotFoundError(f"roadproof was installed without its folder '{folder}'")


@cache
def program() -> str:
    """A digest of the bytes of the whole program and of the shipped models, so that no state of it answers
    for another. Compiled files do not count.
    """
    content = hashlib.sha256()
    for place in (Path(__file__).parents[1], shipped("models")):
        for folder, folders, names in os.walk(place):
            folders[:] = sorted(x for x in folders if x not in ("__pycache__", "models", "proofs"))
            for name in sorted(x for x in names if not x.endswith((".pyc", ".pyo"))):
                path = Path(folder, name)
                content.update(f"{path.relative_to(place).as_posix()}\0{path.stat().st_size}\0".encode())
                content.update(path.read_bytes())
    return content.hexdigest()
