"""Printed formulas on traces of steps, as Coq computes them (proofs/kernel/Steps.v), against the judge."""

from hypothesis import strategies as st

from extensions.kernel.reading import answers, judged
from fuzz import held
from fuzz.case import Disagreement
from fuzz.definition import DT, Held
from roadproof.library.bind import bind
from roadproof.logic.formula import Formula
from roadproof.semantics.exact import judge
from roadproof.world.models import load_road

FORMULAS, TRACES = 60, 20  # in a file
CHUNK = 4
SHRINKS = False
NEEDS_COQ = True

_Pair = tuple[Formula, list[tuple[dict, dict]]]
cases = st.lists(
    st.builds(
        lambda formula, seed: (formula, [held.plain(held.random_trace(seed + i)) for i in range(TRACES)]),
        held.formulas,
        st.integers(0, 10**9),
    ),
    min_size=FORMULAS,
    max_size=FORMULAS,
)
"""(formula, traces as plain data)."""


def check(case: list[_Pair]) -> int:
    """Coq has parameters as parameters, with their values beside the trace; the judge has them put in."""
    on_road = [bind(formula, load_road("main-2"), {"L": "main-1"}, {}) for formula, _ in case]
    traces = [[{"signals": x, "sizes": y} for x, y in given] for _, given in case]
    told = answers(judged(list(zip(on_road, traces, strict=True)), DT, held.PARAMETERS))
    pairs = [(formula, given) for formula, some in case for given in some]
    if len(told) != len(pairs):
        raise Disagreement(f"Coq answers to {len(told)} of {len(pairs)} pairs", case)
    counted = 0
    for (formula, given), said in zip(pairs, told, strict=True):
        if said == "None":
            continue  # a division by zero, of which Steps.v says nothing
        ours = judge(held.bound_to_the_road(formula), held.abstract(Held(*given))).holds
        if said != str(ours).lower():
            raise Disagreement(f"Coq says {said}, the judge {ours}", [(formula, [given])])
        counted += 1
    return counted
