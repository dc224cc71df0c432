"""The picture of all simulations of a search on the plane of gap and speed difference."""

from typing import Any, Final

from roadproof.extensions.closed_loop.simulations_file import PointKind
from roadproof.extensions.closed_loop.view import TargetView
from roadproof.frontends.report.figures import hide_frame, legend_beside, make_figure

_STYLES: Final[dict[PointKind, tuple[str, str, str]]] = {
    "other": ("#c9ced6", ".", "other drives"),
    "shown": ("#1f5fbf", ".", "the scenario, no failure"),
    "fails": ("#b5473c", "x", "failure, the driver model collides too"),
    "preventable": ("#e8871e", "D", "failure that the driver model prevents on samples"),
}
_HEIGHT, _SIZE = 4.2, 14


def draw_plane(target: TargetView) -> Any:
    """Return a figure with a point for each simulation, and the boundary of a driver model.

    The boundary is drawn for the other knobs of the failing drive; points have others.
    """
    assert target.simulations is not None
    figure, [axes] = make_figure([_HEIGHT])
    points = target.simulations.points
    for kind, (colour, marker, label) in _STYLES.items():
        some = [x for x in points if x.kind == kind]
        if some:
            x, y = [p.gap for p in some], [p.faster for p in some]
            axes.scatter(
                x, y, s=_SIZE, c=colour, marker=marker, linewidths=0.8, label=f"{label} ({len(some)})"
            )
    boundary, guide = target.simulations.boundary, target.simulations.guide
    if boundary:
        x, y = [p.gap for p in boundary], [p.faster for p in boundary]
        axes.plot(x, y, color="#222222", linewidth=1.2, label=f"{guide} prevents a collision from here on")
    axes.set_xlabel("gap to the last POV at the start (m)")
    axes.set_ylabel("SV is faster at the start (m/s)")
    axes.set_title(f"{target.name}: {target.title}, {len(points)} simulations", loc="left", fontsize=10)
    hide_frame(axes, ("top", "right"))
    legend_beside(axes)
    return figure
