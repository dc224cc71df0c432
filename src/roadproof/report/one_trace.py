"""What a formula is on one trace: a few lines, and strips that show when each part of it is true."""

from collections.abc import Mapping

from roadproof.evaluation.observed import Observed
from roadproof.report.figures import as_bytes, make_figure


def as_text(observed: Observed) -> str:
    """Verdict, how it is meant, and a line for each part."""
    lines = [f"{observed.formula}: {observed.verdict}", f"  {_promise(observed)}", f"  {_margin(observed)}"]
    lines.append("when true, in seconds from the start:")
    width = min(48, max(len(strip.name) for strip in observed.strips))
    for strip in observed.strips:
        told = strip.exact or " ∪ ".join(map(_interval, strip.true)) or "never"
        if strip.undecided:
            told += "; undecided " + " ∪ ".join(map(_interval, strip.undecided))
        lines.append(f"  {strip.name:<{width}}  {told}")
    return "\n".join(lines)


def _promise(observed: Observed) -> str:
    if observed.view == "dense":
        return "view: dense, every instant of an unbounded drive, judged exactly"
    other = "clip" if observed.convention == "truncated" else "truncated"
    return (
        f"view: recorded, samples every {float(observed.dt):g} s for {observed.seconds:g} s; "
        f"end of the trace: {observed.convention} ({other}: {observed.other})"
    )


def _margin(observed: Observed) -> str:
    low, high = observed.margin
    grid = f", on a grid of {float(observed.dt):g} s" if observed.view == "dense" else ""
    if low == high:
        return f"robustness {low:.6g}{grid}"
    return f"robustness between {low:.6g} and {high:.6g}, whatever comes after the trace{grid}"


def _interval(span: tuple[float, float]) -> str:
    begin, end = span
    return f"{{{begin:g}}}" if begin == end else f"[{begin:g}, {end:g}]"


def draw_strips(observed: Observed, most: int = 40) -> Mapping[str, bytes]:
    """A strip a part: green where it is true, grey where undecided. Raises ``InputError``."""
    strips = observed.strips[:most]
    figure, (axes,) = make_figure([0.6 + 0.2 * len(strips)])
    end = max(observed.seconds, float(observed.dt))
    sample = 0.0 if observed.view == "dense" else float(observed.dt)
    for row, strip in enumerate(strips):
        for spans, colour in ((strip.true, "#4b8b3b"), (strip.undecided, "#bbbbbb")):
            for begin, last in spans:
                if begin <= end:
                    width = max(min(last, end) - begin + sample, end / 300)
                    axes.barh(row, width, left=begin, height=0.7, color=colour)
    axes.set_yticks(range(len(strips)), [strip.name for strip in strips], fontsize=6)
    axes.set_ylim(len(strips) - 0.4, -0.6)
    axes.set_xlim(0, end + sample)
    axes.set_xlabel("s; green where true, grey where it depends on what comes after", fontsize=7)
    axes.set_title(f"{observed.formula}: {observed.verdict}", fontsize=8)
    return as_bytes(figure)
