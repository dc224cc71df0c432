"""Parts of a trace that repeats for ever, each with the part of an earlier round that it is like."""

from collections.abc import Iterator
from typing import TypeAlias

from roadproof.evidence.countermodel import Loop
from roadproof.extensions.kernel.derivation import Step
from roadproof.extensions.kernel.derivations.parts import moved
from roadproof.extensions.kernel.derivations.signs import Part
from roadproof.semantics.exact.truth import Cut

# The rule that says so, without what it rests on; None where a part stays as it is.
Rule: TypeAlias = tuple[str, tuple[str, ...]] | None


def is_first(part: Part, loop: Loop) -> bool:
    """Whether a part lies before the end of the first round."""
    return part.end is not None and part.end <= Cut(loop.end, False)


def in_rounds(part: Part, loop: Loop) -> Iterator[tuple[Part, Part, Rule]]:
    """Parts of ``part`` that follow each other; for each one where to look, and by which rule of Shown.v."""
    again = Cut(loop.start, False)
    if part.begin < again:
        first = Part(part.begin, again)
        yield first, first, None
        part = Part(again, part.end)
    whole = Part(Cut(part.start, False), Cut(part.start + loop.period, False))
    if part.end is None or whole.end is None or whole.end < part.end:
        yield part, whole, ("Round", ())
        return
    number = (part.start - loop.start) // loop.period
    limit = Cut(loop.start + (number + 1) * loop.period, False)
    if limit < part.end:
        yield _earlier(Part(part.begin, limit), number, loop)
        yield _earlier(Part(limit, part.end), number + 1, loop)
    else:
        yield _earlier(part, number, loop)


def _earlier(part: Part, rounds: int, loop: Loop) -> tuple[Part, Part, Rule]:
    by = rounds * loop.period
    rule = ("Earlier", (str(rounds),)) if rounds else None
    return part, Part(moved(part.begin, -by), None if part.end is None else moved(part.end, -by)), rule


def ruled(rule: Rule, step: Step) -> Step:
    """A step for a part of an earlier round as one for the part itself."""
    return step if rule is None else Step(*rule, (step,))
