"""The part of YAML that Doorstop writes: one level of keys with texts, blocks of lines and lists.

All else is refused with its line: anchors, tags, flow collections and deeper levels have no meaning here.
"""

import json
import re
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple, TypeAlias

from roadproof.errors import InputError
from roadproof.runtime.files import read_text

LARGEST = 1_000_000
"""Bytes of a file."""
_KEY = re.compile(r"([A-Za-z_][\w .-]*?|'[^']+'|\"[^\"\\]+\"):(?:\s+(.*))?")
_BLOCK = re.compile(r"([|>])([+-]?)")
_REFUSED = ("&", "*", "!", "{", "[", "?", "%", "@", "`")


class Item(NamedTuple):
    """An item of a list: a text, or the first key of an object with its value."""

    text: str
    value: str | None = None


Value: TypeAlias = str | tuple[Item, ...]


def read_yaml(path: Path) -> dict[str, Value]:
    """The keys of a file with their values, all as texts. Raises ``InputError`` with the line."""
    lines = read_text(path, LARGEST, "an item of requirements is smaller").splitlines()
    found: dict[str, Value] = {}
    at = 0
    while at < len(lines):
        line = lines[at]
        at += 1
        if not line.strip() or line.lstrip().startswith("#") or line in ("---", "..."):
            continue
        key = _KEY.fullmatch(line)
        if key is None:
            raise _refused(path, at, line)
        below = at
        while at < len(lines) and _is_below(lines[at]):
            at += 1
        name = _scalar(key[1], path, below)
        if name in found:
            raise InputError(f"{path}, line {below}: the key '{name}' is given twice")
        found[name] = _value((key[2] or "").strip(), lines[below:at], path, below)
    return found


def _is_below(line: str) -> bool:
    return not line.strip() or line.startswith((" ", "\t", "- ")) or line == "-"


def _value(head: str, below: Sequence[str], path: Path, line: int) -> Value:
    """The value of a key, from the rest of its line and the lines below it."""
    block = _BLOCK.fullmatch(head)
    if block is not None:
        return _block(block[1], below)
    content = [x for x in below if x.strip()]
    if not head and content and content[0].lstrip().startswith("-"):
        return tuple(_items(content, path, line))
    if head == "[]" and not content:
        return ()
    if head == "{}" and not content:
        return ""
    if not head and any(_KEY.fullmatch(x.strip()) for x in content):
        return ""  # an object, which no field that is read has
    return _scalar(" ".join((head, *(x.strip() for x in content))).strip(), path, line)


def _block(kind: str, below: Sequence[str]) -> str:
    """The lines of a block, without their indentation; those of a folded block are joined."""
    widths = [len(x) - len(x.lstrip()) for x in below if x.strip()]
    cut = min(widths, default=0)
    lines = [x[cut:].rstrip() for x in below]
    if kind == "|":
        return "\n".join(lines).strip("\n")
    paragraphs = "\n".join(lines).strip("\n").split("\n\n")
    return "\n".join(" ".join(x.split("\n")) for x in paragraphs)


def _items(content: Sequence[str], path: Path, line: int) -> list[Item]:
    found: list[Item] = []
    for text in content:
        stripped = text.strip()
        if not stripped.startswith("- ") and stripped != "-":
            if found and text[:1] in (" ", "\t"):
                continue  # further keys of an object
            raise _refused(path, line, text)
        said = stripped[1:].strip()
        key = None if said[:1] in ("'", '"') else _KEY.fullmatch(said)
        if key is None:
            found.append(Item(_scalar(said, path, line)))
        else:
            found.append(Item(_scalar(key[1], path, line), _scalar((key[2] or "").strip(), path, line)))
    return found


def _scalar(text: str, path: Path, line: int) -> str:
    """A text, quoted or plain."""
    if text.startswith("'"):
        if len(text) < 2 or not text.endswith("'") or text[1:-1].replace("''", "").count("'"):
            raise _refused(path, line, text)
        return text[1:-1].replace("''", "'")
    if text.startswith('"'):
        try:
            found = json.loads(text)
        except json.JSONDecodeError:
            raise _refused(path, line, text) from None
        return str(found)
    if text.startswith(_REFUSED):
        raise _refused(path, line, text)
    return text.partition(" #")[0].rstrip()


def _refused(path: Path, line: int, text: str) -> InputError:
    return InputError(
        f"{path}, line {line}: {text.strip()[:60]!r} is not read; write a key with a text, a block of lines "
        "or a list"
    )
