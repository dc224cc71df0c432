"""Files that appear whole or not at all."""

import os
import tempfile
from pathlib import Path

from roadproof.errors import InputError


def write_whole(path: Path, content: bytes) -> None:
    """Write ``content`` to ``path`` by way of a hidden file beside it. Raises ``InputError``."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, temporary = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
        try:
            with os.fdopen(handle, "wb") as file:
                file.write(content)
            os.chmod(temporary, 0o644)
            os.replace(temporary, path)
        except BaseException:
            os.unlink(temporary)
            raise
    except OSError as error:
        raise InputError(f"{path}: cannot be written ({error.strerror}); choose another folder") from None
