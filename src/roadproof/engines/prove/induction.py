"""Proofs by induction, and proofs of claims whose scenarios a driver model restricts."""

from collections.abc import Iterator, Sequence

from roadproof.engines.modifier import with_opaque_driver
from roadproof.engines.prove.prover import ProverResult, prove
from roadproof.errors import InputError
from roadproof.library.assumption import Assumption, Axiom
from roadproof.library.elaborate import read_claim
from roadproof.library.motion import axiom_formula
from roadproof.library.specification import Query, Specification
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.logic.restore import as_syntax, term_as_syntax
from roadproof.logic.show import text
from roadproof.logic.terms import Term
from roadproof.reasons import ReasonKind
from roadproof.runtime.budget import Effort
from roadproof.verdict import Verdict

MOST = 8
UNITS = 4.0


def prove_by_induction(
    specification: Specification, query: Query, assumed: Sequence[str], effort: Effort
) -> ProverResult | None:
    """Return a proof of ``query`` that may use inductions; None without a step or a proof.

    Raises ``BudgetExceeded``, ``InputError``.
    """
    axioms = tuple(dict.fromkeys(inductions(specification, query)))[:MOST]
    if not axioms:
        return None
    units = effort.with_units(min(UNITS, effort.units))
    result = prove(specification, query, units, Assumption(tuple(assumed), axioms))
    return result if result.holds else None


def inductions(specification: Specification, query: Query) -> Iterator[Axiom]:
    """Yield an induction axiom for each step ``p -> F[a, b] p`` and ``p -> G[0, d] p`` of the claim."""
    for part in f.subformulas(query.formula):
        if isinstance(part, f.Or):
            for axiom in _axioms_of_step(part.parts):
                try:
                    axiom_formula(specification, query, axiom)
                except InputError:
                    continue
                yield axiom


def _axioms_of_step(parts: Sequence[Formula]) -> Iterator[Axiom]:
    others = {f.negation(x) for x in parts}
    for part in parts:
        match part:
            case f.Eventually(f.Interval(low, high), inside) if high is not None and inside in others:
                yield Axiom("steps", (_text(inside), _number(low), _number(high)))
            case f.Always(f.Interval(_, high), inside) if high is not None and inside in others:
                yield Axiom("lasts", (_text(inside), _number(high)))
            case _:  # open: formulas of another shape have no step
                pass


def _text(formula: Formula) -> str:
    return text(as_syntax(formula))


def _number(term: Term) -> str:
    return text(term_as_syntax(term))


def prove_via_opaque_driver(specification: Specification, query: Query, effort: Effort) -> ProverResult:
    """Prove ``query``; UNKNOWN at once where a proof would need the formulas of the driver model.

    With an opaque driver a false claim is quickly refuted, while a search in the formulas of a driver, which
    are cubic in the state, is slow. The result is a proof of the claim itself. Raises ``BudgetExceeded``.
    """
    outline = with_opaque_driver(specification)
    if outline is not None:
        first = prove(outline, read_claim(outline, query.text), effort)
        if not first.holds:
            return ProverResult(
                first.work, verdict=Verdict.UNKNOWN, reason=ReasonKind.LEFT_OPEN(), seconds=first.seconds
            )
    return prove(specification, query, effort)
