"""The one home of matplotlib: a figure with rows of axes, and its bytes."""

import io
from collections.abc import Sequence
from typing import Any

from roadproof.errors import MissingSolverError

_DPI = 110


def make_figure(heights: Sequence[float], width: float = 9.0) -> tuple[Any, list[Any]]:
    """A figure of ``width`` inches with one axes a row of the given heights (inches).

    Raises ``MissingSolverError`` where matplotlib is not installed.
    """
    figure_class, canvas = _matplotlib()
    figure = figure_class(figsize=(width, sum(heights) + 0.4), layout="constrained")
    canvas(figure)
    rows = figure.subplots(len(heights), 1, height_ratios=list(heights), squeeze=False)
    return figure, [axes for (axes,) in rows]


def make_page(width: float, height: float, dots: float | None = None) -> Any:
    """An empty figure of that size (inches of ``dots`` pixels), on which each axes is put in its place.

    Raises ``MissingSolverError`` where matplotlib is not installed.
    """
    figure_class, canvas = _matplotlib()
    figure = figure_class(figsize=(width, height), dpi=dots)
    canvas(figure)
    return figure


def _matplotlib() -> tuple[Any, Any]:
    try:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    except ImportError:
        raise MissingSolverError("pictures need matplotlib: install it, or omit pictures") from None
    return Figure, FigureCanvasAgg


def legend_beside(axes: Any) -> None:
    """Draw the legend of ``axes`` to their right, off the curves."""
    if axes.get_legend_handles_labels()[1]:
        axes.legend(fontsize=6, loc="upper left", bbox_to_anchor=(1.005, 1), borderaxespad=0, frameon=False)


def name_rows(axes: Any, names: Sequence[str]) -> None:
    """A name beside each of the rows 0, 1, … of ``axes``, the first on top; names begin at one left edge."""
    axes.set_yticks(range(len(names)), names, fontsize=6, family="monospace", ha="left")
    axes.tick_params(axis="y", pad=3.62 * max(map(len, names), default=0) + 3, length=0)
    axes.set_ylim(len(names) - 0.4, -0.6)


def hide_frame(axes: Any, sides: Sequence[str] = ("top", "right", "bottom", "left")) -> None:
    """Draw no line around ``axes``, or none on some of its sides."""
    for side in sides:
        axes.spines[side].set_visible(False)


def count_axis(axis: Any) -> None:
    """Ticks of an axis that counts: whole numbers only."""
    from matplotlib.ticker import MaxNLocator

    axis.set_major_locator(MaxNLocator(integer=True, min_n_ticks=1))


def as_bytes(figure: Any) -> dict[str, bytes]:
    """The figure as PNG and SVG; the same figure gives the same SVG."""
    import matplotlib

    fix_layout(figure)
    made: dict[str, bytes] = {}
    with matplotlib.rc_context({"svg.hashsalt": "roadproof"}):
        for kind, metadata in (("png", {}), ("svg", {"Date": None})):
            out = io.BytesIO()
            figure.savefig(out, format=kind, dpi=_DPI, metadata=metadata)
            made[kind] = out.getvalue()
    return made


def fix_layout(figure: Any) -> None:
    """Lay a figure out once and for all; the solver that does so differs in the last digits."""
    figure.set_dpi(_DPI)
    figure.draw_without_rendering()
    figure.set_layout_engine("none")
    for axes in figure.axes:
        axes.set_position([round(x, 4) for x in axes.get_position(original=True).bounds])
