"""Text of what a claim assumes: read, with mistakes at their place in it."""

from collections.abc import Iterator
from contextlib import contextmanager

from roadproof.errors import InputError, TextError
from roadproof.logic import syntax
from roadproof.logic.parse import parse_claim

SOURCE = "what is assumed"


@contextmanager
def located(written: str) -> Iterator[None]:
    """Mistakes inside are those of ``written``."""
    try:
        yield
    except TextError as error:
        raise error.locate(SOURCE, written) from None


def parsed(written: str) -> syntax.Expression:
    """What is assumed, which uses the names of the claim. Raises ``TextError``, ``InputError``."""
    claim = parse_claim(written, SOURCE)
    if claim.given:
        raise InputError(f"'{written[:80]}' may declare nothing: it is read with the names of the claim")
    return claim.body
