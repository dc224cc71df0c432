"""The robustness over time as plain data of ``roadproof monitor --json``."""

from collections.abc import Iterable
from math import inf, isfinite

from roadproof.extensions.traffic.answers.monitor import (
    LeastMarginData,
    MarginPieceData,
    RobustnessSignalData,
    Spans,
)
from roadproof.extensions.traffic.evaluate.margin_signal import RobustnessSignal
from roadproof.semantics.exact.algebraic import as_float, decimal
from roadproof.semantics.exact.truth import TruthSet


def signal_data(signal: RobustnessSignal) -> RobustnessSignalData:
    """Return a signal as an answer has it; infinite bounds are None."""
    least = signal.least()
    above, below = _signed_spans(signal)
    return RobustnessSignalData(
        exact=signal.exact is not None,
        sampled=signal.sampled,
        times=signal.times,
        low=tuple(map(finite, signal.low)),
        high=tuple(map(finite, signal.high)),
        verdicts=signal.truths,
        least=None
        if least is None
        else LeastMarginData(value=least.value + 0.0, time=least.time, attained=least.attained),
        positive=above,
        negative=below,
        pieces=tuple(
            MarginPieceData(
                begin=as_float(start),
                exact=decimal(start),
                coefficients=tuple(map(str, polynomial.coefficients)),
            )
            for start, polynomial in signal.pieces
        ),
    )


def _signed_spans(signal: RobustnessSignal) -> tuple[Spans, Spans]:
    """Return when the robustness is above 0, and when it is below 0."""
    if signal.exact is None:
        return ended(signal.spans(1)), ended(signal.spans(-1))
    above, below, _ = signal.sign_sets()
    return _exact_spans(above), _exact_spans(below)


def finite(value: float) -> float | None:
    """Return a number, or None for an infinite one."""
    return value + 0.0 if isfinite(value) else None


def ended(spans: Iterable[tuple[float, float]]) -> Spans:
    """Return spans, of which one that never ends has None for its end."""
    return tuple((begin, finite(end)) for begin, end in spans)


def _exact_spans(truth: TruthSet) -> Spans:
    return ended(
        (as_float(begin.point), inf if end is None else as_float(end.point)) for begin, end in truth.spans()
    )
