"""The result of a formula on one trace: verdict, margin, and when each named part is true."""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import TypeAlias

import numpy as np

from roadproof.extensions.traffic.answers.monitor import Truth, View
from roadproof.extensions.traffic.evaluate.margin_signal import (
    RobustnessSignal,
    drive_signal,
    recorded_signal,
)
from roadproof.extensions.traffic.evaluate.robust import clamped_to_verdict, robustness
from roadproof.extensions.traffic.formats.recording import BACKWARDS, Bools
from roadproof.logic import terms as t
from roadproof.logic.formula import Application, Formula, nesting
from roadproof.logic.rewrite import signal_degree, terms_of
from roadproof.semantics.exact.algebraic import as_float
from roadproof.semantics.exact.judging import judge
from roadproof.semantics.exact.truth import TruthSet
from roadproof.semantics.sampled.answers import Convention, Margin, TruthArrays
from roadproof.semantics.sampled.batch import Batch
from roadproof.semantics.sampled.compiled import compile
from roadproof.world.drive import Drive

_FORMULA = "asked"
Spans: TypeAlias = tuple[tuple[float, float], ...]


@dataclass(frozen=True)
class TruthStrip:
    """The times (s, ends included) at which a part is true, or depends on what comes after the trace.

    ``exact`` tells the same with open and closed ends where the view is dense; ``depth``: in how many others
    the part is. ``margins``: at each sample, None where it depends on what comes later or lanes alone decide.
    """

    name: str
    true: Spans
    undecided: Spans = ()
    exact: str = ""
    depth: int = 0
    margins: tuple[float | None, ...] = field(default=(), compare=False, repr=False)


@dataclass(frozen=True)
class MonitorResult:
    """An answer at the first sample (time 0). ``margin`` bounds the robustness; infinite where only
    lanes decide. ``other`` is the answer under the other convention for the end of a trace. ``signal`` is the
    robustness over time, where it was asked for."""

    formula: str
    view: View
    verdict: Truth
    margin: tuple[float, float]
    seconds: float
    dt: Fraction
    strips: tuple[TruthStrip, ...]
    convention: Convention | None = None
    other: Truth | None = None
    signal: RobustnessSignal | None = None

    @property
    def decides(self) -> bool:
        """Return whether the margin has a sign whatever comes after the trace, which is then that of the
        verdict.
        """
        low, high = self.margin
        return low > 0 or high < 0


def observe_samples(
    text: str, formula: Formula, batch: Batch, convention: Convention, with_signal: bool = False
) -> MonitorResult:
    """The monitor's answer on the one trace of ``batch``. Raises ``InputError``."""
    monitor = compile({_FORMULA: formula})
    other: Convention = "clip" if convention == "truncated" else "truncated"
    seen = monitor.observe(batch)
    verdicts = monitor.evaluate(seen, convention, named=True)
    margins = monitor.measure(batch, convention, at="all", named=True)
    margin = margins.margins[_FORMULA]
    dt = float(batch.dt)
    answer = monitor.evaluate(seen, convention, at="all").answers[_FORMULA]
    spans = _spans(answer, dt)
    depths = _depths(formula)
    strips = (
        TruthStrip(name_of(part), *_spans(truth, dt), "", depths[part], _sampled(margins.named[part]))
        for part, truth in verdicts.named.items()
        if part != formula
    )
    return MonitorResult(
        text,
        "recorded",
        _truth_of(verdicts.answers[_FORMULA]),
        (float(margin.low[0, 0]), float(margin.high[0, 0])),
        float((batch.samples - 1) * batch.dt),
        batch.dt,
        (TruthStrip(text, *spans, margins=_sampled(margin)), *strips),
        convention,
        _truth_of(monitor.evaluate(seen, other).answers[_FORMULA]),
        recorded_signal(margin, answer, batch.dt) if with_signal else None,
    )


def observe_drive(
    text: str, formula: Formula, drive: Drive, horizon: Fraction, dt: Fraction, with_signal: bool = False
) -> MonitorResult:
    """The exact judge's answer on a drive, in dense and unbounded time; the margin is on the grid of dt, and
    0 where its sign there is not that of the verdict.

    Raises ``InputError`` and ``UsageError``.
    """
    judgement = judge(formula, drive)
    sampled = robustness(formula, drive, dt, int(horizon / dt) * dt).value
    margin = clamped_to_verdict(sampled, judgement.holds)
    strips = [_exact_strip(text, judgement.truth(formula))]
    depths = _depths(formula)
    named = [(part, truth) for part, truth in judgement.named() if part != formula]
    strips += [replace(_exact_strip(name_of(part), truth), depth=depths[part]) for part, truth in named]
    verdict: Truth = "true" if judgement.holds else "false"
    signal = drive_signal(judgement, drive, horizon, dt) if with_signal else None
    return MonitorResult(
        text, "dense", verdict, (margin, margin), float(horizon), dt, tuple(strips), signal=signal
    )


def note_on_standing(text: str, formula: Formula, batch: Batch, convention: Convention) -> tuple[str, ...]:
    """A note with the answer where no speed along the road is below 0, if a vehicle drives backwards and that
    answer is another.

    Only for formulas that square these speeds: a square has no sign, so the safe distance of RSS counts a
    vehicle that rolls back as one that drives away. Raises ``InputError``.
    """
    speeds = {key: x for key, x in batch.signals.items() if key[0] == "v_lon"}
    within = int(batch.lengths[0])
    if not any(x[:within, 0].min() < BACKWARDS for x in speeds.values()) or not _squares_speeds(formula):
        return ()
    stopped = {key: np.maximum(x, 0) for key, x in speeds.items()}
    monitor = compile({_FORMULA: formula})
    before, after = (
        _truth_of(monitor.evaluate(one, convention).answers[_FORMULA])
        for one in (batch, replace(batch, signals={**batch.signals, **stopped}))
    )
    return () if before == after else (f"with speeds below 0 taken as 0 m/s, {text}: {after}",)


def _squares_speeds(formula: Formula) -> bool:
    """Return whether it compares a term in which a speed along the road is squared, or multiplied by a
    signal.
    """
    return any(
        isinstance(part, t.Power | t.Product)
        and (signal_degree(part) or 0) > 1
        and any(isinstance(leaf, t.Signal) and leaf.name == "v_lon" for leaf in t.leaves(part))
        for side in terms_of(formula)
        for part in _parts(side)
    )


def _parts(term: t.Term) -> Iterator[t.Term]:
    yield term
    for child in t.children(term):
        yield from _parts(child)


def name_of(part: Application) -> str:
    """An application of a definition as a user writes it."""
    return f"{part.name}({', '.join(part.arguments)})"


def margins_of(formula: Formula, batch: Batch) -> tuple[float | None, ...]:
    """The margin of a formula at each sample of the one trace of ``batch``. Raises ``InputError``."""
    return _sampled(compile({_FORMULA: formula}).measure(batch, "clip", at="all").margins[_FORMULA])


def _sampled(margin: Margin) -> tuple[float | None, ...]:
    pairs = zip(margin.low[:, 0].tolist(), margin.high[:, 0].tolist(), strict=True)
    return tuple(low if low == high and np.isfinite(low) else None for low, high in pairs)


def _depths(formula: Formula) -> dict[Application, int]:
    """Return in how many others each part is, below the formula as a whole."""
    below = 0 if isinstance(formula, Application) else 1
    return {part: depth + below for part, depth in nesting(formula).items()}


def _spans(answer: TruthArrays, dt: float) -> tuple[Spans, Spans]:
    true, false = answer.true[:, 0], answer.false[:, 0]
    return _runs(true, dt), _runs(~true & ~false, dt)


def _runs(truth: Bools, dt: float) -> Spans:
    """First and last time of each run of true samples."""
    edges = np.flatnonzero(np.diff(np.concatenate(([0], truth.astype(np.int8), [0]))))
    return tuple(
        (round(int(begin) * dt, 9), round((int(end) - 1) * dt, 9))
        for begin, end in zip(edges[::2], edges[1::2], strict=True)
    )


def _exact_strip(name: str, truth: TruthSet) -> TruthStrip:
    spans = tuple(
        (as_float(span.begin.point), float("inf") if span.end is None else as_float(span.end.point))
        for span in truth.spans()
    )
    return TruthStrip(name, spans, (), str(truth))


def _truth_of(answer: TruthArrays) -> Truth:
    return "true" if answer.true[0] else "false" if answer.false[0] else "undecided"
