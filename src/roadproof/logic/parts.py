"""The parts of a conjunction, through the names of definitions."""

from collections.abc import Iterable, Iterator

from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.logic.restore import as_syntax
from roadproof.logic.show import text


def parts_of(formula: Formula) -> Iterator[Formula]:
    """Yield the parts of a conjunction, through the names of definitions, down to temporal operators."""
    match formula:
        case f.And(every):
            for part in every:
                yield from parts_of(part)
        case f.Application(_, _, body) if isinstance(body, f.And | f.Application) and not f.is_state(body):
            yield from parts_of(body)
        case _:
            yield formula


def texts_of(parts: Iterable[Formula]) -> tuple[str, ...]:
    """Return parts of a formula as texts, definitions by name."""
    return tuple(text(as_syntax(part)) for part in parts)
