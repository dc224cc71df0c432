"""Recorded traces: ``compile(formulas)`` to a ``Monitor``, ``monitor.evaluate(batch)`` to verdicts."""

from roadproof.monitoring.answers import Margin, Margins, TruthArrays, Verdicts
from roadproof.monitoring.batch import Batch
from roadproof.monitoring.compiled import Monitor, Observation, compile

__all__ = ["Batch", "Margin", "Margins", "Monitor", "Observation", "TruthArrays", "Verdicts", "compile"]
