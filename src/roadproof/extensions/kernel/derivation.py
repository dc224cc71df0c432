"""Derivations: trees of rules that proofs/kernel/Shown.v checks, as text for Coq. Not trusted."""

from collections.abc import Iterator
from fractions import Fraction
from typing import TypeAlias

from roadproof.extensions.kernel.tableau import WIDTH
from roadproof.runtime.records import dataclass


@dataclass(frozen=True)
class Fixed:
    """A moment at one instant (s)."""

    time: Fraction


@dataclass(frozen=True)
class Later:
    """A moment at a delay (s) after each instant."""

    time: Fraction


DerivationMoment: TypeAlias = Fixed | Later


@dataclass(frozen=True)
class Soon:
    """The instants between two that are arbitrarily close to the first."""

    begin: Fraction
    end: Fraction


@dataclass(frozen=True)
class Crossing:
    """The irrational instant between two rational ones at which a polynomial, lowest power first, is 0."""

    begin: Fraction
    end: Fraction
    polynomial: tuple[int, ...]


@dataclass(frozen=True)
class DerivationStep:
    """A rule of Shown.v with its arguments and premises.

    ``cuts``: the instants of Sign. ``many``: the children form a list, as in Each.
    """

    rule: str
    arguments: tuple[str, ...] = ()
    children: tuple["DerivationStep", ...] = ()
    cuts: tuple[Fraction, ...] | None = None
    many: bool = False


def sign(cuts: tuple[Fraction, ...]) -> DerivationStep:
    return DerivationStep("Sign", cuts=cuts)


def split(time: Fraction, after: bool, before: DerivationStep, since: DerivationStep) -> DerivationStep:
    return DerivationStep("Split", (rational(time), str(after).lower()), (before, since))


def case(
    polynomial: tuple[Fraction, ...], above: DerivationStep, not_above: DerivationStep
) -> DerivationStep:
    return DerivationStep("Case", (f"[{'; '.join(map(rational, polynomial))}]",), (above, not_above))


def element(number: int, step: DerivationStep) -> DerivationStep:
    return DerivationStep("Element", (str(number),), (step,))


def soon(moment: Soon, before: DerivationStep, after: DerivationStep) -> DerivationStep:
    return DerivationStep("Soon", (rational(moment.begin), rational(moment.end)), (before, after))


def crossed(
    moment: Crossing, sign: int, steps: tuple[DerivationStep, DerivationStep, DerivationStep]
) -> DerivationStep:
    """Return the step for an irrational instant; ``sign``: a factor of the polynomial."""
    coefficients = "; ".join(rational(Fraction(sign * x)) for x in moment.polynomial)
    return DerivationStep(
        "Crossing", (rational(moment.begin), rational(moment.end), f"[{coefficients}]"), steps
    )


def timed(rule: str, moment: DerivationMoment, *steps: DerivationStep) -> DerivationStep:
    """Return a step of the rule Moment, Reach or Break."""
    return DerivationStep(rule, (f"({type(moment).__name__} {rational(moment.time)})",), steps)


def rational(value: Fraction) -> str:
    """Return a number of Q, for places where the notations of its scope are open."""
    if value.denominator == 1:
        return str(value) if value >= 0 else f"({value})"
    return f"({value.numerator} # {value.denominator})"


def coq_derivation(step: DerivationStep) -> Iterator[str]:
    """Yield the lines of a derivation as a term of Shown.v."""
    line = ""
    for word in _words(step):
        if line and len(line) + len(word) > WIDTH:
            yield line
            line = ""
        line += word if not line or word in (")", "]", ";") or line[-1] in "([" else f" {word}"
    yield line


def _words(step: DerivationStep) -> Iterator[str]:
    waiting: list[DerivationStep | str] = [step]
    while waiting:
        current = waiting.pop()
        if isinstance(current, str):
            yield current
            continue
        if current.cuts is not None:
            yield f"({current.rule} [{'; '.join(map(rational, current.cuts))}])"
            continue
        if not current.arguments and not current.children and not current.many:
            yield current.rule
            continue
        yield f"({' '.join([current.rule, *current.arguments])}"
        after: list[DerivationStep | str] = []
        if current.many:
            after.append("[")
            for place, child in enumerate(current.children):
                after += [";"] * bool(place) + [child]
            after.append("]")
        else:
            after += current.children
        waiting += [")", *reversed(after)]
