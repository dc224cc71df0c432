"""Robustness over time: a value at each sample; on a drive, exact pieces for a formula of one instant.

The value at a sample is the robustness there, under the same convention for the end. For a formula that does
not look back, it is that of the trace that starts there.
"""

from collections.abc import Iterator
from fractions import Fraction
from itertools import groupby
from math import inf, isfinite
from typing import TypeAlias

from roadproof.errors import UsageError
from roadproof.extensions.traffic.answers.monitor import Truth
from roadproof.extensions.traffic.evaluate.robust import clamped_to_verdict, robustness
from roadproof.frontends.api.table import Row, Table
from roadproof.library.bind import Number, exact
from roadproof.logic.formula import Formula
from roadproof.runtime.records import dataclass
from roadproof.semantics.exact.judging import Judgement
from roadproof.semantics.exact.margins import (
    LeastValue,
    NoExactPieces,
    StateMargin,
    least_value,
    state_margin,
    value_at,
)
from roadproof.semantics.exact.piecewise import Pieces, where_sign
from roadproof.semantics.exact.signals import NEGATIVE, POSITIVE, ZERO, DriveSignals, TermPieces
from roadproof.semantics.exact.truth import ALWAYS, NEVER, TruthSet
from roadproof.semantics.sampled.answers import Margin, TruthArrays
from roadproof.world.drive import Drive

Spans: TypeAlias = tuple[tuple[float, float], ...]


@dataclass(frozen=True, repr=False)
class RobustnessSignal(Table):
    """Bounds of the robustness at the samples 0, dt, 2·dt, … (s), with the verdict at each.

    ``low`` and ``high`` are equal where nothing after the trace matters. ``exact``: on a drive, the function
    of time that has these values; ``horizon``: up to where its least value is looked for. ``sampled``: why a
    drive has no such function; "" for recordings.
    """

    dt: Fraction
    low: tuple[float, ...]
    high: tuple[float, ...]
    truths: tuple[Truth, ...]
    horizon: Fraction
    exact: StateMargin | None = None
    sampled: str = ""

    def __len__(self) -> int:
        return len(self.low)

    @property
    def times(self) -> tuple[float, ...]:
        """The times of the samples, in s from the first."""
        return tuple(float(k * self.dt) for k in range(len(self)))

    @property
    def pieces(self) -> Pieces:
        """The pieces of the exact function; none where there is no such function, or it is infinite."""
        return () if self.exact is None or isinstance(self.exact, bool) else self.exact

    def at(self, when: Number) -> tuple[float, float]:
        """Return bounds of the robustness at a time, in s or as text with a unit.

        Raises ``UsageError`` for a time between samples where the function is not known exactly, and for one
        outside the trace; ``InputError`` for what is no time.
        """
        time = exact("time", when, "s")
        if time < 0 or (self.exact is None and time > (len(self) - 1) * self.dt):
            raise UsageError(f"time={float(time):g} s is outside the trace, which begins with 0 s")
        if isinstance(self.exact, bool):
            return (inf, inf) if self.exact else (-inf, -inf)
        if self.exact is not None:
            value = float(value_at(self.exact, time))
            return value, value
        place = time / self.dt
        if place.denominator != 1:
            raise UsageError(
                f"time={float(time):g} s is between two samples, and the robustness there is not known: "
                f"ask at a multiple of dt={float(self.dt):g} s"
            )
        return self.low[int(place)], self.high[int(place)]

    def sign_sets(self) -> tuple[TruthSet, TruthSet, TruthSet]:
        """Return when the exact function is above 0, below 0 and 0."""
        if isinstance(self.exact, bool):
            return (ALWAYS, NEVER, NEVER) if self.exact else (NEVER, ALWAYS, NEVER)
        above, below, zero = (where_sign(self.pieces, x) for x in (POSITIVE, NEGATIVE, ZERO))
        return above, below, zero

    def signs(self) -> tuple[int | None, ...]:
        """Return the sign at each sample: 1, -1, 0 where both bounds are 0, None where it is not known."""
        return tuple(map(_sign, self.low, self.high))

    def spans(self, *signs: int | None) -> Spans:
        """Return first and last time (s) of each run of samples with one of these signs."""
        runs = groupby(zip(self.times, self.signs(), strict=True), key=lambda x: x[1] in signs)
        every = [[time for time, _ in run] for chosen, run in runs if chosen]
        return tuple((round(x[0], 9), round(x[-1], 9)) for x in every)

    def least(self) -> LeastValue | None:
        """Return the least known value, the first one of several; None where no finite value is known."""
        if self.pieces:
            return least_value(self.pieces, self.horizon)
        known = [
            LeastValue(low + 0.0, time)
            for time, low, high in zip(self.times, self.low, self.high, strict=True)
            if low == high and isfinite(low)
        ]
        return min(known, key=lambda x: x.value, default=None)

    def rows(self) -> list[Row]:
        """A row for each sample: time (s), bounds of the robustness, verdict."""
        columns = zip(self.times, self.low, self.high, self.truths, strict=True)
        return [{"time": a, "low": b, "high": c, "verdict": d} for a, b, c, d in columns]

    def __str__(self) -> str:
        return "\n".join(self._lines())

    def __repr__(self) -> str:
        return (
            f"<Robustness at {len(self)} samples{', exact between them' if self.exact is not None else ''}>"
        )

    def _lines(self) -> Iterator[str]:
        yield f"robustness over time, {self._promise()}:"
        least = self.least()
        if least is None:
            yield "  least    no finite value is known"
        else:
            when = "at" if least.attained else "just before"
            until = f", up to {float(self.horizon):g} s" if self.pieces else ""
            yield f"  least    {least.value + 0.0:.6g} {when} {least.time:.6g} s{until}"
        yield from (f"  {name:<8} {when}" for name, when in self._when() if when)

    def _promise(self) -> str:
        if isinstance(self.exact, bool):
            return "exact, the same at every instant"
        if self.exact is not None:
            return f"exact, in {len(self.pieces)} piece{'s' if len(self.pieces) > 1 else ''}"
        grid = f", on a grid of {float(self.dt):g} s, as {self.sampled}" if self.sampled else ""
        return f"a value at each of {len(self)} samples{grid}"

    def _when(self) -> tuple[tuple[str, str], ...]:
        """Return when the robustness has which sign, as text; "" for never."""
        if self.exact is not None:
            above, below, zero = ("" if x == NEVER else str(x) for x in self.sign_sets())
            return ("above 0", above), ("below 0", below), ("0", zero)
        signs = (("above 0", 1), ("below 0", -1), ("0", 0), ("no sign", None))
        return tuple((name, " ∪ ".join(map(interval_text, self.spans(x)))) for name, x in signs)


def interval_text(span: tuple[float, float]) -> str:
    """Return a closed interval of times (s) as text."""
    begin, end = span
    return f"{{{begin:g}}}" if begin == end else f"[{begin:g}, {end:g}]"


def _sign(low: float, high: float) -> int | None:
    if low > 0:
        return 1
    if high < 0:
        return -1
    return 0 if low == high == 0 else None


def recorded_signal(margin: Margin, answer: TruthArrays, dt: Fraction) -> RobustnessSignal:
    """Return the signal of the one trace of a batch, from margins and verdicts at all samples."""
    truths = zip(answer.true[:, 0].tolist(), answer.false[:, 0].tolist(), strict=True)
    low, high = (tuple(x[:, 0].tolist()) for x in (margin.low, margin.high))
    horizon = (len(low) - 1) * dt
    return RobustnessSignal(dt, low, high, tuple(_truth(*x) for x in truths), horizon)


def _truth(true: bool, false: bool) -> Truth:
    return "true" if true else "false" if false else "undecided"


def drive_signal(judgement: Judgement, drive: Drive, horizon: Fraction, dt: Fraction) -> RobustnessSignal:
    """Return the signal of a judged formula on a drive, with samples every ``dt`` s up to ``horizon`` (s).

    For a state formula the function of time is exact. Otherwise values are margins on the grid of samples,
    and 0 where their sign is not the judge's. Raises ``InputError``, ``UsageError``.
    """
    formula, last = judgement.formula, int(horizon / dt)
    truth = judgement.truth(formula)
    holds = [truth.at(k * dt) for k in range(last + 1)]
    truths: tuple[Truth, ...] = tuple("true" if x else "false" for x in holds)
    values = robustness(formula, drive, dt, last * dt).margins[formula].tolist()
    exact, reason = _exact(formula, drive)
    if exact is None:
        values = [clamped_to_verdict(*x) for x in zip(values, holds, strict=True)]
    return RobustnessSignal(dt, tuple(values), tuple(values), truths, horizon, exact, reason)


def _exact(formula: Formula, drive: Drive) -> tuple[StateMargin | None, str]:
    try:
        return state_margin(formula, TermPieces(DriveSignals(drive))), ""
    except NoExactPieces as error:
        return None, str(error)
