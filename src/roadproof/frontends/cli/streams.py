"""Stdout and stderr that take every text, whatever the terminal's encoding, and whose failure is told."""

import codecs
import errno
import os
import sys

_PLAIN = {
    "…": "...",
    "∪": "or",
    "×": "x",
    "∞": "inf",
    "⊆": "<=",
    "∅": "{}",
    "⟨": "<",
    "⟩": ">",
    "→": "->",
    "¬": "not ",
    "§": "section ",
    "²": "^2",
    "±": "+-",
    "·": "*",
    "√": "sqrt",
    "–": "-",
}
_HANDLER = "roadproof"
FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO)


def make_streams_lenient() -> None:
    """Signs that an encoding lacks are written with plain letters, or as escapes such as ``\\u03c1``."""
    codecs.register_error(_HANDLER, _in_plain_letters)
    for stream in (sys.stdout, sys.stderr):
        reconfigure = getattr(stream, "reconfigure", None)
        if reconfigure is not None:
            reconfigure(errors=_HANDLER)


def takes_everything(stream: object) -> bool:
    """Return whether a stream is in an encoding of all of Unicode."""
    return (getattr(stream, "encoding", None) or "utf-8").lower().replace("_", "-").startswith("utf")


def forget_output() -> None:
    """Drop what stdout still holds, so that the interpreter does not complain of it when it ends."""
    nothing = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nothing, sys.stdout.fileno())
    os.close(nothing)


def print_at_once(text: str, is_stored: bool) -> None:
    """Print a part of an answer; ``is_stored``: its evidence is, whether or not the reader has gone away.

    Raises ``BrokenPipeError`` where nothing is kept.
    """
    try:
        print(text, flush=True)
    except BrokenPipeError:
        if not is_stored:
            raise
        forget_output()


def _in_plain_letters(error: UnicodeError) -> tuple[str, int]:
    if not isinstance(error, UnicodeEncodeError):
        raise error
    signs = error.object[error.start : error.end]
    plain = (_PLAIN.get(sign) or sign.encode("ascii", "backslashreplace").decode() for sign in signs)
    return "".join(plain), error.end
