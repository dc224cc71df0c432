"""Random claims to the prover: what is proved holds on random traces, what is refuted fails on its own.

Each trace is judged; so is the trace of a refutation, and a certificate is checked again. A claim that
stays UNKNOWN counts for nothing.
"""

from collections import Counter

from hypothesis import strategies as st

from fuzz.case import Disagreement
from proving.claims import PROVED, is_false_on, settle, specification
from proving.test_claims import claims, is_true_on, traces
from rejection import rejection_reason
from roadproof.engines.solve.smt import check_sat
from roadproof.verdict import Verdict

TRACES = 40  # for each claim
CHUNK = 20
UNITS = 1.0

cases = st.tuples(claims(), st.lists(traces, min_size=TRACES, max_size=TRACES))
notes: Counter[str] = Counter()


def check(case: tuple[str, list[dict]]) -> int:
    """How many traces spoke for the verdict."""
    claim, tried = case
    result = settle(claim, units=UNITS)
    notes[str(result.verdict)] += 1
    if result.verdict in PROVED:
        if rejection_reason(result.certificate, specification().library, check_sat) is not None:
            raise Disagreement("PROVED with a certificate that is refused", (claim, []))
        for trace in tried:
            if not is_true_on(claim, trace):
                raise Disagreement("PROVED, and judged false on a trace", (claim, [trace]))
        return len(tried)
    if result.verdict is Verdict.REFUTED:
        if not is_false_on(result.countermodel, claim):
            raise Disagreement("REFUTED with a trace on which it is judged true", (claim, []))
        return 1
    if result.verdict is not Verdict.UNKNOWN:
        raise Disagreement(f"a claim gets the verdict {result.verdict}: {result.reason}", (claim, []))
    return 0
