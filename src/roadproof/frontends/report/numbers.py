"""Numbers of things and of seconds, as a terminal says them."""


def count(number: int, noun: str) -> str:
    """A number with its noun: ``1 plate``, ``2 plates``."""
    return f"{number} {noun}{'' if number == 1 else 's'}"


def took(seconds: float | None, comma: str = "") -> str:
    """How long an answer took (s), after what was counted; empty for None, as of answers read from a file."""
    return "" if seconds is None else f"{comma} in {seconds:.1f} s"
