"""The one home of matplotlib: a figure with rows of axes, and its bytes."""

import io
from collections.abc import Sequence
from typing import Any

from roadproof.errors import MissingSolverError


def make_figure(heights: Sequence[float], width: float = 9.0) -> tuple[Any, list[Any]]:
    """A figure of ``width`` inches with one axes a row of the given heights (inches).

    Raises ``MissingSolverError`` where matplotlib is not installed.
    """
    try:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    except ImportError:
        raise MissingSolverError(
            "pictures need matplotlib: install matplotlib, or go without pictures"
        ) from None
    figure = Figure(figsize=(width, sum(heights) + 0.4), layout="constrained")
    FigureCanvasAgg(figure)
    rows = figure.subplots(len(heights), 1, height_ratios=list(heights), squeeze=False)
    return figure, [axes for (axes,) in rows]


def draw_box(axes: Any, s: tuple[float, float], d: tuple[float, float], colour: str, label: str) -> None:
    """A vehicle's box [s] × [d], its name inside."""
    from matplotlib.patches import Rectangle

    axes.add_patch(Rectangle((s[0], d[0]), s[1] - s[0], d[1] - d[0], color=colour, zorder=3))
    axes.text(s[1] + 0.8, (d[0] + d[1]) / 2, label, fontsize=7, va="center", color=colour, zorder=4)


def as_bytes(figure: Any) -> dict[str, bytes]:
    """The figure as PNG and SVG; the same figure gives the same SVG."""
    import matplotlib

    made: dict[str, bytes] = {}
    with matplotlib.rc_context({"svg.hashsalt": "roadproof"}):
        for kind, metadata in (("png", {}), ("svg", {"Date": None})):
            out = io.BytesIO()
            figure.savefig(out, format=kind, dpi=110, metadata=metadata)
            made[kind] = out.getvalue()
    return made
