"""The quantifiers and lemmas of a proof, in the form in which certificates name them."""

from dataclasses import dataclass
from typing import assert_never

from roadproof.evidence.times import moment_of
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.logic.node import memoised
from roadproof.logic.restore import as_syntax
from roadproof.logic.show import text


@dataclass(frozen=True)
class Site:
    """A quantifier at a moment: ``formula`` in prefix form, its polarity, and the moment of evaluation.

    ``instance`` is set if the quantifier is inside an instance of a negated until.
    """

    formula: str
    positive: bool
    moment: str
    instance: str = ""


@dataclass(frozen=True)
class StateLemma:
    """A clause over atoms that holds at every instant; ``moments``: where the proof uses it."""

    literals: tuple[tuple[str, bool], ...]
    moments: tuple[str, ...]


@memoised
def prefix_form(formula: Formula) -> str:
    """Return an abstracted formula as unambiguous text in prefix form."""
    match formula:
        case f.Truth(value):
            return str(value).lower()
        case f.Application(name, _, _):
            return f"|{name}|"
        case f.Not(body):
            return f"(not {prefix_form(body)})"
        case f.And(parts):
            return f"(and {' '.join(map(prefix_form, parts))})"
        case f.Or(parts):
            return f"(or {' '.join(map(prefix_form, parts))})"
        case f.Until(left, interval, right):
            return f"(U {_window(interval)} {prefix_form(left)} {prefix_form(right)})"
        case f.Since(left, interval, right):
            return f"(S {_window(interval)} {prefix_form(left)} {prefix_form(right)})"
        case f.Eventually(interval, body):
            return f"(F {_window(interval)} {prefix_form(body)})"
        case f.Always(interval, body):
            return f"(G {_window(interval)} {prefix_form(body)})"
        case f.Some() | f.Every():
            return f"({text(as_syntax(formula, expand=False))})"
        case f.Compare() | f.Occupies():
            raise ValueError("abstract the formula first")
        case _:
            assert_never(formula)


def _window(interval: f.Interval) -> str:
    high = "inf" if interval.high is None else str(moment_of(interval.high))
    return f"[{moment_of(interval.low)}, {high}]"
