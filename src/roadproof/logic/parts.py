"""The parts of a conjunction; definitions are looked through, and shown by name."""

from collections.abc import Iterable, Iterator
from typing import assert_never

from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.logic.restore import as_syntax
from roadproof.logic.show import text


def parts_of(formula: Formula) -> Iterator[Formula]:
    """Yield the parts of a conjunction, also those inside definitions, down to temporal operators."""
    match formula:
        case f.And(every):
            for part in every:
                yield from parts_of(part)
        case f.Application(_, _, body) if isinstance(body, f.And | f.Application) and not f.is_state(body):
            yield from parts_of(body)
        case f.Truth() | f.Compare() | f.Occupies() | f.Some() | f.Every() | f.Not() | f.Or():
            yield formula
        case f.Until() | f.Since() | f.Eventually() | f.Always() | f.Application():
            yield formula
        case _:
            assert_never(formula)


def texts_of(parts: Iterable[Formula]) -> tuple[str, ...]:
    """Return each part of a formula as text, with definitions called by name."""
    return tuple(text(as_syntax(part)) for part in parts)
