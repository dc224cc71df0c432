"""Recorded traces: ``compile(formulas)`` to a ``Monitor``, ``monitor.evaluate(batch)`` to verdicts."""

from roadproof.monitor.batch import Batch
from roadproof.monitor.compiled import Answer, Margin, Margins, Monitor, Observation, Verdicts, compile

__all__ = ["Answer", "Batch", "Margin", "Margins", "Monitor", "Observation", "Verdicts", "compile"]
