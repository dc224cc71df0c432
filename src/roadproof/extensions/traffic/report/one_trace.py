"""The result of a formula on one trace as text, and as strips that show when each part is true."""

from fractions import Fraction
from math import isfinite, nan
from textwrap import wrap
from typing import Any

from roadproof.extensions.traffic.evaluate.margin_signal import RobustnessSignal, interval_text
from roadproof.extensions.traffic.evaluate.observed import MonitorResult
from roadproof.frontends.report.figures import legend_beside, make_figure, name_rows
from roadproof.frontends.report.sheet import excerpt

_TRUE, _UNDECIDED, _WIDEST = "#4b8b3b", "#bbbbbb", 60
_CURVE = 1.6
"""Height of the curve of the robustness, in inches."""
_POINTS = 600
"""Points at which an exact curve is drawn."""


def as_text(observed: MonitorResult) -> str:
    """Verdict, how it is meant, and a line for each part."""
    lines = [f"{observed.formula}: {observed.verdict}", f"  {_promise(observed)}", f"  {_margin(observed)}"]
    lines.append("when true, in seconds from the start:")
    width = min(48, max(len(strip.name) for strip in observed.strips))
    for strip in observed.strips:
        spans = strip.exact or " ∪ ".join(map(interval_text, strip.true)) or "never"
        if strip.undecided:
            spans += "; undecided " + " ∪ ".join(map(interval_text, strip.undecided))
        lines.append(f"  {strip.name:<{width}}  {spans}")
    if observed.signal is not None:
        lines.append(str(observed.signal))
    return "\n".join(lines)


def _promise(observed: MonitorResult) -> str:
    if observed.view == "dense":
        return "view: dense, every instant of an unbounded drive, judged exactly"
    other = "clip" if observed.convention == "truncated" else "truncated"
    return (
        f"view: recorded, samples every {float(observed.dt):g} s for {observed.seconds:g} s; "
        f"end of the trace: {observed.convention} ({other}: {observed.other})"
    )


def _margin(observed: MonitorResult) -> str:
    low, high = observed.margin
    grid = f", on a grid of {float(observed.dt):g} s" if observed.view == "dense" else ""
    whether = "" if observed.decides else "; it does not decide"
    if low == high:
        return f"robustness {low + 0.0:.6g}{grid}{whether}"
    return f"robustness between {low:.6g} and {high:.6g}, whatever comes after the trace{grid}{whether}"


def draw_strips(observed: MonitorResult) -> Any:
    """A strip a part, each below what it is part of: green where it is true, grey where undecided."""
    strips, signal = observed.strips, observed.signal
    figure, (axes, *below) = make_figure([0.6 + 0.2 * len(strips), *([] if signal is None else [_CURVE])])
    end = max(observed.seconds, float(observed.dt))
    sample = 0.0 if observed.view == "dense" else float(observed.dt)
    for row, strip in enumerate(strips):
        for spans, colour in ((strip.true, _TRUE), (strip.undecided, _UNDECIDED)):
            for begin, last in spans:
                if begin <= end:
                    width = max(min(last, end) - begin + sample, end / 300)
                    axes.barh(row, width, left=begin, height=0.7, color=colour)
    name_rows(axes, ["  " * strip.depth + excerpt(strip.name, _WIDEST) for strip in strips])
    axes.set_xlim(0, end + sample)
    (axes, *below)[-1].set_xlabel("s", fontsize=8)
    if signal is not None:
        _draw_signal(below[0], signal, end)
        below[0].set_xlim(0, end + sample)
    axes.fill([], [], color=_TRUE, label="true")
    if any(strip.undecided for strip in strips):
        axes.fill([], [], color=_UNDECIDED, label="depends on what\ncomes after")
    legend_beside(axes)
    figure.suptitle("\n".join(wrap(f"{observed.formula}: {observed.verdict}", 120)), fontsize=9)
    return figure


def _draw_signal(axes: Any, signal: RobustnessSignal, end: float) -> None:
    """The robustness over time up to ``end`` (s): a curve where it is exact, else bounds at each sample."""
    if signal.pieces:
        times = [Fraction(k) * Fraction(end) / _POINTS for k in range(_POINTS + 1)]
        axes.plot([float(x) for x in times], [signal.at(x)[0] for x in times], color="black", linewidth=0.9)
    else:
        known = [low if low == high else nan for low, high in zip(signal.low, signal.high, strict=True)]
        axes.fill_between(
            signal.times,
            [x if isfinite(x) else nan for x in signal.low],
            [x if isfinite(x) else nan for x in signal.high],
            color=_UNDECIDED,
            linewidth=0,
        )
        axes.plot(signal.times, [x if isfinite(x) else nan for x in known], ".-", color="black", markersize=2)
    axes.axhline(0, color=_UNDECIDED, linewidth=0.6)
    axes.set_ylabel("robustness", fontsize=8)
    axes.tick_params(labelsize=6)
