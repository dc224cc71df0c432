"""Reads and judges the trace that refutes a claim."""

from roadproof.evidence.answer import RefutingTrace, assumed_by
from roadproof.evidence.answer_files import RefutationFile
from roadproof.evidence.claim import Claim
from roadproof.evidence.codec import read
from roadproof.evidence.countermodel import read_trace
from roadproof.evidence.readers.about_claim import require, require_about
from roadproof.evidence.refutation import fault_of
from roadproof.library.bind import values_with
from roadproof.library.motion import under_limits


def unjudged_trace_for(claim: Claim, content: object, where: str) -> RefutingTrace:
    """Return the trace of a file without judging it."""
    file = read(RefutationFile, content, where)
    require_about(claim, file, where)
    trace = read_trace(file.trace, where)
    values_with(claim.home.library, trace.parameters)
    return RefutingTrace(trace, file.drive_sought)


def refuting_trace_for(claim: Claim, content: object, where: str) -> RefutingTrace:
    """Return the trace of a file, judged. Raises ``InputError`` if the claim holds on it."""
    shown = unjudged_trace_for(claim, content, where)
    query = under_limits(claim.home, claim.query, assumed_by(claim))
    fault = fault_of(shown.trace, query.formula, claim.home.library.bounds)
    require(fault is None, where, f"its trace does not refute the claim: {fault}")
    return shown
