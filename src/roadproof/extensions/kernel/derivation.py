"""Derivations: trees of rules that proofs/kernel/Shown.v checks, as text for Coq. Not trusted."""

from collections.abc import Iterator
from fractions import Fraction
from typing import TypeAlias

from roadproof.extensions.kernel.tableau import WIDTH
from roadproof.runtime.records import dataclass


@dataclass(frozen=True)
class Fixed:
    """One instant, in s."""

    time: Fraction


@dataclass(frozen=True)
class Later:
    """So many seconds after each instant."""

    time: Fraction


Moment: TypeAlias = Fixed | Later


@dataclass(frozen=True)
class Soon:
    """Each instant between two, which are as near to the first as one likes."""

    begin: Fraction
    end: Fraction


@dataclass(frozen=True)
class Crossing:
    """The irrational instant between two at which a polynomial, lowest power first, is 0."""

    begin: Fraction
    end: Fraction
    polynomial: tuple[int, ...]


@dataclass(frozen=True)
class Step:
    """A rule of Shown.v, what it is told, and what it rests on.

    ``cuts``: the instants of Sign. ``many``: the children are a list, as Each has them.
    """

    rule: str
    told: tuple[str, ...] = ()
    children: tuple["Step", ...] = ()
    cuts: tuple[Fraction, ...] | None = None
    many: bool = False


def sign(cuts: tuple[Fraction, ...]) -> Step:
    return Step("Sign", cuts=cuts)


def split(time: Fraction, after: bool, before: Step, since: Step) -> Step:
    return Step("Split", (rational(time), str(after).lower()), (before, since))


def case(polynomial: tuple[Fraction, ...], above: Step, not_above: Step) -> Step:
    return Step("Case", (f"[{'; '.join(map(rational, polynomial))}]",), (above, not_above))


def element(number: int, step: Step) -> Step:
    return Step("Element", (str(number),), (step,))


def soon(moment: Soon, before: Step, after: Step) -> Step:
    return Step("Soon", (rational(moment.begin), rational(moment.end)), (before, after))


def crossed(moment: Crossing, sign: int, steps: tuple[Step, Step, Step]) -> Step:
    """``sign``: by which the polynomial is multiplied."""
    coefficients = "; ".join(rational(Fraction(sign * x)) for x in moment.polynomial)
    return Step("Crossing", (rational(moment.begin), rational(moment.end), f"[{coefficients}]"), steps)


def timed(rule: str, moment: Moment, *steps: Step) -> Step:
    """Moment, Reach or Break."""
    return Step(rule, (f"({type(moment).__name__} {rational(moment.time)})",), steps)


def rational(value: Fraction) -> str:
    """A number of Q, where the notations of its scope are open."""
    if value.denominator == 1:
        return str(value) if value >= 0 else f"({value})"
    return f"({value.numerator} # {value.denominator})"


def coq_derivation(step: Step) -> Iterator[str]:
    """A derivation as a term of Shown.v, in lines."""
    line = ""
    for word in _words(step):
        if line and len(line) + len(word) > WIDTH:
            yield line
            line = ""
        line += word if not line or word in (")", "]", ";") or line[-1] in "([" else f" {word}"
    yield line


def _words(step: Step) -> Iterator[str]:
    waiting: list[Step | str] = [step]
    while waiting:
        current = waiting.pop()
        if isinstance(current, str):
            yield current
            continue
        if current.cuts is not None:
            yield f"({current.rule} [{'; '.join(map(rational, current.cuts))}])"
            continue
        if not current.told and not current.children and not current.many:
            yield current.rule
            continue
        yield f"({' '.join([current.rule, *current.told])}"
        after: list[Step | str] = []
        if current.many:
            after.append("[")
            for place, child in enumerate(current.children):
                after += [";"] * bool(place) + [child]
            after.append("]")
        else:
            after += current.children
        waiting += [")", *reversed(after)]
