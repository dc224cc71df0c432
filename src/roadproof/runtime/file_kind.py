"""Recognition of files of a wrong format where CSV or XML is expected, for messages with a remedy."""

_BEGINNINGS: tuple[tuple[bytes, str], ...] = (
    (b"\x1f\x8b", "is compressed by gzip; unpack it first (gunzip)"),
    (b"PK\x03\x04", "is a ZIP archive or a spreadsheet; unpack it, or save the sheet as CSV"),
    (b"BZh", "is compressed by bzip2; unpack it first (bunzip2)"),
    (b"\xfd7zXZ\x00", "is compressed by xz; unpack it first (unxz)"),
    (b"\x28\xb5\x2f\xfd", "is compressed by Zstandard; unpack it first (unzstd)"),
    (b"7z\xbc\xaf\x27\x1c", "is a 7z archive; unpack it first"),
    (b"PAR1", "is a Parquet file; let its name end in .parquet, or write it as CSV"),
    (b"\x89HDF", "is an HDF5 file; write its table as CSV"),
    (b"%PDF", "is a PDF file; name the file that it describes"),
    (b"version https://git-lfs", "is a pointer of Git LFS, not the file itself; fetch it with git lfs pull"),
)
_UTF_16 = (b"\xff\xfe", b"\xfe\xff")
_PAGES = (b"<!doctype html", b"<html", b"<head", b"<body")


def other_format(content: bytes, expected: bytes = b"") -> str | None:
    """Return what format ``content`` has and what to do about it; None if it may be CSV or XML.

    ``expected``: how files of the expected format begin.
    """
    for beginning, problem in _BEGINNINGS:
        if content.startswith(beginning) and beginning != expected:
            return problem
    start = content[:200].lstrip(b"\xef\xbb\xbf \t\r\n").lower()
    if start.startswith(_PAGES):
        return "is a page of HTML, such as a login or error page; download the file itself"
    return None


def other_encoding(content: bytes) -> str | None:
    """Return the problem and its remedy if ``content`` is UTF-16 and not UTF-8; else None."""
    if content.startswith(_UTF_16) or any(content[k:200:2].count(0) > 20 for k in (0, 1)):
        return "is text in UTF-16; save it as UTF-8"
    return None


def other_text(content: bytes) -> str | None:
    """Return the problem and its remedy for content that is no UTF-8 text or XML; None if not recognised."""
    return other_format(content) or other_encoding(content)


def other_table(content: bytes, names: int) -> str | None:
    """Return the problem and its remedy for a file that should be CSV with ``names`` columns; else None."""
    problem = other_text(content)
    if problem is not None:
        return problem
    line = content[:10_000].partition(b"\n")[0]
    if line.lstrip().startswith(b"<"):
        return "is XML or HTML, not a table of numbers; name the CSV file"
    if line.lstrip().startswith((b"{", b"[")):
        return "is JSON, not a table of numbers; name the CSV file"
    for separator, called in ((b";", "semicolons"), (b"\t", "tabs"), (b"|", "vertical bars")):
        if names > 1 and line.count(separator) >= max(1, (names - 1) // 2) and b"," not in line:
            return f"has its columns separated by {called}; separate them by commas, decimals with a point"
    return None
