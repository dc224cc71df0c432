"""Proofs about scenarios that begin with what a driver prevents, or cannot prevent."""

from roadproof.drivers.restriction import left_open
from roadproof.engines.prove.prover import Result, prove
from roadproof.library.elaborate import read_claim
from roadproof.library.specification import Query, Specification
from roadproof.runtime.budget import Effort
from roadproof.verdict import Verdict

_OPEN = "not proved where it is left open what a driver prevents, and no other proof was looked for"


def prove_of_scenarios(specification: Specification, query: Query, effort: Effort, label: str = "") -> Result:
    """As ``prove``; but where a driver model says what begins, UNKNOWN for what needs its numbers.

    A proof is one of the claim itself, with its certificate. That there may be one is asked first where what
    the driver prevents is left open, which is quickly refuted: a search in the formulas of a driver, cubic in
    the state, is not. Raises ``BudgetExceeded``.
    """
    outline = left_open(specification)
    if outline is not None:
        first = prove(outline, read_claim(outline, query.text), effort, label)
        if not first.holds:
            return Result(Verdict.UNKNOWN, _OPEN, first.seconds, first.work)
    return prove(specification, query, effort, label)
