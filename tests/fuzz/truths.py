"""The judge's operators on sets of instants, open and closed ends, against the definition. Exact."""

from fuzz.case import Disagreement
from judge.cases import opaque_cases
from judge.pinning import disagreement_on_sets
from roadproof.logic.formula import Formula
from roadproof.semantics.exact.truth import TruthSet

cases = opaque_cases()
"""(formula over three opaque atoms, their truth sets)."""


def check(case: tuple[Formula, dict[Formula, TruthSet]]) -> int:
    found = disagreement_on_sets(*case)
    if found is not None:
        raise Disagreement(f"the judge differs from the definition at {found[1]}", case)
    return 1
