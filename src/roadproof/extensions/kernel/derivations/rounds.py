"""Parts of a repeating trace, each with the equal part of an earlier round."""

from collections.abc import Iterator
from typing import TypeAlias

from roadproof.evidence.countermodel import Loop
from roadproof.extensions.kernel.derivation import DerivationStep
from roadproof.extensions.kernel.derivations.parts import moved
from roadproof.extensions.kernel.derivations.signs import TimePart
from roadproof.semantics.exact.truth import Cut

# The rule that says so, without what it rests on; None where a part stays as it is.
Rule: TypeAlias = tuple[str, tuple[str, ...]] | None


def is_first(part: TimePart, loop: Loop) -> bool:
    """Return whether a part lies before the end of the first round."""
    return part.end is not None and part.end <= Cut(loop.end, False)


def in_rounds(part: TimePart, loop: Loop) -> Iterator[tuple[TimePart, TimePart, Rule]]:
    """Yield consecutive parts of ``part``, each with an equal earlier part and the rule of Shown.v for it."""
    again = Cut(loop.start, False)
    if part.begin < again:
        first = TimePart(part.begin, again)
        yield first, first, None
        part = TimePart(again, part.end)
    whole = TimePart(Cut(part.start, False), Cut(part.start + loop.period, False))
    if part.end is None or whole.end is None or whole.end < part.end:
        yield part, whole, ("Round", ())
        return
    number = (part.start - loop.start) // loop.period
    limit = Cut(loop.start + (number + 1) * loop.period, False)
    if limit < part.end:
        yield _earlier(TimePart(part.begin, limit), number, loop)
        yield _earlier(TimePart(limit, part.end), number + 1, loop)
    else:
        yield _earlier(part, number, loop)


def _earlier(part: TimePart, rounds: int, loop: Loop) -> tuple[TimePart, TimePart, Rule]:
    shift = rounds * loop.period
    rule = ("Earlier", (str(rounds),)) if rounds else None
    return (
        part,
        TimePart(moved(part.begin, -shift), None if part.end is None else moved(part.end, -shift)),
        rule,
    )


def by_rule(rule: Rule, step: DerivationStep) -> DerivationStep:
    """Return a step for a part, given the step for the equal part of an earlier round."""
    return step if rule is None else DerivationStep(*rule, (step,))
