"""CSV files in other customs: quoted cells, and lines that end with a carriage return alone."""

import csv
from pathlib import Path

from roadproof.errors import InputError


def plain_text(path: Path, content: bytes) -> bytes:
    """The same rows with no quotes, and with line feeds. Raises ``InputError``.

    A quoted cell with a comma or a line break in it is refused: no column of a format has such cells.
    """
    if b"\n" not in content:
        content = content.replace(b"\r", b"\n")
    if b'"' not in content or content.lstrip()[:1] in (b"<", b"{", b"["):
        return content  # no table: who reads it says what it is
    lines = []
    for number, line in enumerate(content.decode("latin-1").split("\n")[:-1], start=1):
        try:
            (cells,) = csv.reader([line.removesuffix("\r")], strict=True)
        except (csv.Error, ValueError):
            raise InputError(f"{path}, row {number}: a quote does not end in its cell; remove it") from None
        if any("," in cell or '"' in cell for cell in cells):
            raise InputError(f"{path}, row {number}: a comma or a quote within a quoted cell; remove it")
        lines.append(",".join(cells))
    end = "" if content.endswith(b"\n") else content.decode("latin-1").rpartition("\n")[2]
    return "".join(f"{line}\n" for line in lines).encode("latin-1") + end.encode("latin-1")
