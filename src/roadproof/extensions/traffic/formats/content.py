"""The content of text files, looked at piece by piece; quotes are left out, and lines end with line feeds."""

import codecs
import csv
import io
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import BinaryIO

import numpy as np
import numpy.typing as npt

from roadproof.errors import InputError
from roadproof.runtime.files import refuse_name

_THOUSANDS = re.compile(r"-?\d{1,3}(,\d{3})+(\.\d+)?")


def plain_text(path: Path, content: bytes, thousands: bool = False) -> bytes:
    """Return the rows without quotes and spaces beside commas, ended by line feeds. Raises ``InputError``.

    A quoted cell with a comma or a line break in it is refused: no column of a format has such cells, but for
    numbers such as "1,118,846,979" where commas part ``thousands``.
    """
    if b"\n" not in content:
        content = content.replace(b"\r", b"\n")
    if (b'"' not in content and b", " not in content and b" ," not in content) or content.lstrip()[:1] in (
        b"<",
        b"{",
        b"[",
    ):
        return content  # no table: who reads it says what it is
    lines = []
    for number, line in enumerate(content.decode("latin-1").split("\n")[:-1], start=1):
        try:
            (cells,) = csv.reader([line.removesuffix("\r")], strict=True, skipinitialspace=True)
        except (csv.Error, ValueError):
            raise InputError(f"{path}, row {number}: a quote does not end in its cell; remove it") from None
        if thousands:
            cells = [x.replace(",", "") if _THOUSANDS.fullmatch(x) else x for x in cells]
        if any("," in cell or '"' in cell for cell in cells):
            raise InputError(f"{path}, row {number}: a comma or a quote within a quoted cell; remove it")
        lines.append(",".join(x.strip() for x in cells))
    end = "" if content.endswith(b"\n") else content.decode("latin-1").rpartition("\n")[2]
    return "".join(f"{line}\n" for line in lines).encode("latin-1") + end.encode("latin-1")


_MARK = b"\xef\xbb\xbf"
"""What some programs begin text in UTF-8 with."""


@dataclass(frozen=True)
class ByteCounts:
    """The numbers of lines and commas in bytes, and whether they have a quote or a byte outside ASCII text.

    ``spaced``: whether a comma has a space beside it.
    """

    lines: int
    commas: int
    quoted: bool
    strange: bool
    spaced: bool


@dataclass(frozen=True)
class Content:
    """The content of a file without a byte order mark, read in pieces and not held in memory.

    ``kept``: of what is no file on a disk, which can be read once, and of files with quoted cells or other
    line ends, as they are without. ``stamp`` changes when the file does.
    """

    path: Path
    stamp: tuple[int, ...]
    kept: bytes | None

    @classmethod
    def of(cls, path: Path, thousands: bool = False) -> "Content":
        """Raises ``InputError`` for a file that cannot be read or is empty. ``thousands``: see plain_text."""
        refuse_name(path)
        try:
            in_memory = None if path.is_file() else path.read_bytes().removeprefix(_MARK)
            content = cls(path, stamp_of(path), in_memory)
            empty = not content.beginning() or (content.beginning().isspace() and content.all().isspace())
            if not empty and content.needs_change():
                content = cls(path, content.stamp, plain_text(path, content.all(), thousands))
        except OSError as error:
            raise InputError(f"{path}: the file cannot be read ({error.strerror}); check the path") from None
        if empty:
            raise InputError(f"{path}: the file is empty; get it again from its source")
        return content

    def open(self) -> BinaryIO:
        """The content, to be read."""
        return self.path.open("rb") if self.kept is None else io.BytesIO(self.kept)

    def needs_change(self) -> bool:
        """Return whether cells are quoted, or lines end with a carriage return alone; False of what is no
        text.
        """
        from roadproof.runtime.file_kind import other_format  # here: writers load this module, too

        first = self.beginning()
        if b"\0" in first or other_format(first) is not None:
            return False
        return (b"\r" in first and b"\n" not in first) or self.counts.quoted or self.counts.spaced

    @cached_property
    def counts(self) -> ByteCounts:
        """The counts over the whole content, from one pass."""
        lines, commas, quoted, strange, spaced = 0, 0, False, False, False
        for piece in self.pieces():
            codes = np.frombuffer(piece, np.uint8)
            lines += int(np.count_nonzero(codes == ord("\n")))
            commas += int(np.count_nonzero(codes == ord(",")))
            quoted = quoted or b'"' in piece
            strange = strange or is_strange(codes)
            spaced = spaced or b", " in piece or b" ," in piece
        return ByteCounts(lines, commas, quoted, strange, spaced)

    def pieces(self, size: int = 1 << 18) -> Iterator[bytes]:
        """Yield the content in pieces that by default fit the cache."""
        with self.open() as file:
            if file.read(len(_MARK)) != _MARK or self.kept is not None:
                file.seek(0)
            while piece := file.read(size):
                yield piece

    def beginning(self) -> bytes:
        """The first of the pieces, in which the header is."""
        return next(self.pieces(), b"")

    def ends_line(self) -> bool:
        """Return whether it ends with a line break."""
        if self.kept is not None:
            return self.kept.endswith(b"\n")
        with self.path.open("rb") as file:
            file.seek(-1, io.SEEK_END)
            return file.read() == b"\n"

    def all(self) -> bytes:
        return b"".join(self.pieces())

    def source(self) -> Path | bytes:
        """Return the source for polars: the file itself, unless it has a byte order mark."""
        if self.kept is not None:
            return self.kept
        with self.path.open("rb") as file:
            marked = file.read(len(_MARK)) == _MARK
        return self.all() if marked else self.path

    def require_unchanged(self) -> None:
        """Raise ``InputError`` where the file was written to since it was first looked at."""
        require_unchanged(self.path, self.stamp)


def is_strange(piece: npt.NDArray[np.uint8]) -> bool:
    """Return whether a byte of a piece is part of no table of numbers."""
    return bool(piece.max() > 127 or not piece.min())


def require_unchanged(path: Path, stamp: tuple[int, ...]) -> None:
    """Raise ``InputError`` where a file is not what it was when ``stamp_of`` it was asked for."""
    if stamp_of(path) != stamp:
        raise InputError(f"{path}: the file changed while it was read; ask again when it is whole")


def stamp_of(path: Path) -> tuple[int, ...]:
    """Return device, inode, size and time of a file, to notice changes; nothing for a missing file."""
    try:
        status = path.stat()
    except OSError:
        return ()
    return status.st_dev, status.st_ino, status.st_size, status.st_mtime_ns


def is_utf_8(content: Content) -> bool:
    """Return whether the content is text in UTF-8, in which names may have letters of any script."""
    decoder = codecs.getincrementaldecoder("utf-8")()
    try:
        return all("\0" not in decoder.decode(piece) for piece in content.pieces()) and not decoder.decode(
            b"", True
        )
    except UnicodeDecodeError:
        return False


def strange_byte(content: Content) -> InputError:
    """The error for the first byte that is part of no table of numbers."""
    text = content.all()
    piece = np.frombuffer(text, np.uint8)
    strange = next((x for x in (_first_undecodable(text), text.find(b"\0")) if x >= 0), 0)
    row = text.count(b"\n", 0, strange) + 1
    return InputError(
        f"{content.path}, row {row}: byte {piece[strange]:#04x} is no text in UTF-8; save the file as UTF-8"
    )


def _first_undecodable(text: bytes) -> int:
    """The place of the first byte that is no UTF-8, -1 for none."""
    try:
        text.decode("utf-8")
    except UnicodeDecodeError as error:
        return error.start
    return -1


def columns_not_read_note(
    path: Path, names: Iterable[str], read: Iterable[str], harmless: Mapping[str, str], strict: bool
) -> tuple[str, ...]:
    """Return a note on columns: ``names`` in a file that are neither ``read`` nor ``harmless``.

    Raises ``InputError`` instead if ``strict``.
    """
    from roadproof.world.not_read import not_read_note  # here: writers load this module, too

    known = {*read, *harmless}
    return not_read_note(path, [f"column {x}" for x in names if x not in known], strict)
