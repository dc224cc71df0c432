"""Random formulas printed for Coq, which reads them back: as the tree that is written apart (kernel.raw)."""

from hypothesis import strategies as st

from extensions.kernel.raw import random_formula
from extensions.kernel.reading import answers, compared
from fuzz.case import Disagreement

BATCH = 500  # formulas in a file: Coq loads its library once
CHUNK = 4
SHRINKS = False  # a formula by itself is small enough
NEEDS_COQ = True

cases = st.integers(0, 10**6).map(lambda n: tuple(range(n * BATCH, (n + 1) * BATCH)))
"""Seeds of formulas."""


def check(case: tuple[int, ...]) -> int:
    told = answers(compared([random_formula(seed) for seed in case], {}))
    if len(told) != len(case):
        raise Disagreement(f"Coq answers to {len(told)} of {len(case)}", case)
    for seed, same in zip(case, told, strict=True):
        if same != "true":
            raise Disagreement("Coq reads another formula than was printed", (seed,))
    return len(case)
