"""Numbers of things and of seconds, as a terminal says them."""


def count(number: int, noun: str) -> str:
    """A number with its noun: ``1 plate``, ``2 plates``."""
    return f"{number} {noun}{'' if number == 1 else 's'}"


def took(seconds: float, comma: str = "") -> str:
    """How long an answer took (s), after what was counted; empty where nothing was asked, as of a file."""
    return f"{comma} in {seconds:.1f} s" if seconds else ""
