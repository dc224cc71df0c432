"""Which texts of a picture are cut off at its edges."""

from typing import Any

from matplotlib.text import Text

from roadproof.frontends.report.figures import fix_layout


def cut_off(figure: Any) -> list[str]:
    """The texts of a figure that reach beyond its edges."""
    fix_layout(figure)
    figure.draw_without_rendering()
    renderer = figure.canvas.get_renderer()
    whole = figure.bbox
    texts = [x for x in figure.findobj(Text) if x.get_text().strip() and x.get_visible()]
    boxes = [(x.get_text(), x.get_window_extent(renderer)) for x in texts if not is_off_axis(figure, x)]
    return [text for text, box in boxes if not (whole.x0 <= box.x0 and box.x1 <= whole.x1 + 0.5)] + [
        text for text, box in boxes if not (whole.y0 <= box.y0 and box.y1 <= whole.y1 + 0.5)
    ]


def is_off_axis(figure: Any, text: Text) -> bool:
    """Whether a text is the label of a tick beyond the ends of its axis, which is not drawn."""
    for axis in (axis for axes in figure.axes for axis in (axes.xaxis, axes.yaxis)):
        low, high = sorted(axis.get_view_interval())
        for tick in axis.majorTicks:
            if text in (tick.label1, tick.label2):
                return not low - 1e-9 <= tick.get_loc() <= high + 1e-9
    return False
