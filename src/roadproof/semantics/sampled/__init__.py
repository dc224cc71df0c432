"""The monitor for recorded traces: ``compile(formulas).evaluate(batch)`` returns verdicts."""

from roadproof.semantics.sampled.answers import Margin, Margins, TruthArrays, Verdicts
from roadproof.semantics.sampled.batch import Batch
from roadproof.semantics.sampled.compiled import Monitor, Observation, compile

__all__ = ["Batch", "Margin", "Margins", "Monitor", "Observation", "TruthArrays", "Verdicts", "compile"]
