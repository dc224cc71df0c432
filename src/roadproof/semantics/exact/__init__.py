"""The exact judge of formulas on drives, in dense and unbounded time."""

from roadproof.semantics.exact.judging import Judgement, judge
from roadproof.semantics.exact.truth import TruthSet

__all__ = ["Judgement", "TruthSet", "judge"]
