"""Recorded traces: ``compile(formulas)`` to a ``Monitor``, ``monitor.evaluate(batch)`` to verdicts."""

from roadproof.monitor.answers import Answer, Margin, Margins, Verdicts
from roadproof.monitor.batch import Batch
from roadproof.monitor.compiled import Monitor, Observation, compile

__all__ = ["Answer", "Batch", "Margin", "Margins", "Monitor", "Observation", "Verdicts", "compile"]
