"""Proofs by induction, and of scenarios that begin with what a driver prevents, or cannot prevent."""

from collections.abc import Iterator, Sequence

from roadproof.engines.modifier import left_open
from roadproof.engines.prove.prover import Result, prove
from roadproof.errors import InputError
from roadproof.library.elaborate import read_claim
from roadproof.library.motion import Assumption, Axiom, axiom_formula
from roadproof.library.specification import Query, Specification
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.logic.restore import as_syntax, term_as_syntax
from roadproof.logic.show import text
from roadproof.logic.terms import Term
from roadproof.reasons import Why
from roadproof.runtime.budget import Effort
from roadproof.verdict import Verdict

MOST = 8
UNITS = 4.0


def prove_by_induction(
    specification: Specification, query: Query, said: Sequence[str], effort: Effort
) -> Result | None:
    """A proof of ``query`` that may use inductions; None where the claim has no step or no proof is found.

    Raises ``BudgetExceeded``, ``InputError``.
    """
    axioms = tuple(dict.fromkeys(inductions(specification, query)))[:MOST]
    if not axioms:
        return None
    units = effort.of(min(UNITS, effort.units))
    result = prove(specification, query, units, Assumption(tuple(said), axioms))
    return result if result.holds else None


def inductions(specification: Specification, query: Query) -> Iterator[Axiom]:
    """An induction for each step ``p -> F[a, b] p`` and ``p -> G[0, d] p`` of the claim."""
    for part in f.subformulas(query.formula):
        if isinstance(part, f.Or):
            for axiom in _of_step(part.parts):
                try:
                    axiom_formula(specification, query, axiom)
                except InputError:
                    continue
                yield axiom


def _of_step(parts: Sequence[Formula]) -> Iterator[Axiom]:
    others = {f.negation(x) for x in parts}
    for part in parts:
        match part:
            case f.Eventually(f.Interval(low, high), inside) if high is not None and inside in others:
                yield Axiom("steps", (_text(inside), _number(low), _number(high)))
            case f.Always(f.Interval(_, high), inside) if high is not None and inside in others:
                yield Axiom("lasts", (_text(inside), _number(high)))
            case _:
                pass


def _text(formula: Formula) -> str:
    return text(as_syntax(formula))


def _number(term: Term) -> str:
    return text(term_as_syntax(term))


def prove_of_scenarios(specification: Specification, query: Query, effort: Effort) -> Result:
    """As ``prove``; but where a driver model says what begins, UNKNOWN for what needs its numbers.

    A proof is one of the claim itself, with its certificate. That there may be one is asked first where what
    the driver prevents is left open, which is quickly refuted: a search in the formulas of a driver, cubic in
    the state, is not. Raises ``BudgetExceeded``.
    """
    outline = left_open(specification)
    if outline is not None:
        first = prove(outline, read_claim(outline, query.text), effort)
        if not first.holds:
            return Result(first.work, verdict=Verdict.UNKNOWN, reason=Why.LEFT_OPEN(), seconds=first.seconds)
    return prove(specification, query, effort)
