"""Is it so: the exact judge of formulas on drives, in dense and unbounded time."""

from roadproof.judge.exact import Judgement, judge
from roadproof.judge.truth import TruthSet

__all__ = ["Judgement", "TruthSet", "judge"]
