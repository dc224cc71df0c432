"""A picture of a drive: the road from above, speeds, gaps against RSS distances, and what is true when."""

from collections.abc import Iterator, Mapping
from fractions import Fraction
from math import nan
from typing import Any

from roadproof.errors import RoadproofError
from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.judged import judge_file
from roadproof.judge.algebraic import approximate
from roadproof.judge.robust import robustness
from roadproof.judge.truth import TruthSet
from roadproof.logic.formula import Compare, Formula, subformulas
from roadproof.report.figures import as_bytes, draw_box, make_figure
from roadproof.spec.bind import bind, default_values
from roadproof.spec.library import Library
from roadproof.spec.scenarios import SUBJECT, too_near_ahead
from roadproof.world.motion import State, state_at

COLOURS = ("#1f5fbf", "#c8641e", "#4b8b3b", "#8a4fa3")
SNAPSHOTS = 5
MOST_STRIPS = 24
GRAIN = Fraction(1, 10)


def draw_drive(file: DriveFile, library: Library, title: str = "") -> dict[str, bytes]:
    """The picture of a drive file as ``{"png": …, "svg": …}``; the title is its formula where none is given.

    Raises ``InputError`` without matplotlib.
    """
    strips = list(_strips(file, library))[:MOST_STRIPS]
    heights = [0.75] * SNAPSHOTS + [1.5, 1.7, 0.2 + 0.16 * len(strips)]
    figure, axes = make_figure(heights)
    order = sorted(file.drive.vehicles, key=lambda name: (name != SUBJECT, name))
    colours = dict(zip(order, COLOURS * len(order), strict=False))
    for k in range(SNAPSHOTS):
        _snapshot(axes[k], file, colours, file.horizon * k / (SNAPSHOTS - 1))
    axes[SNAPSHOTS - 1].set_xlabel("m along the road, from the first vehicle shown", fontsize=7)
    _speeds(axes[SNAPSHOTS], file, colours)
    _gaps(axes[SNAPSHOTS + 1], file, colours, library)
    _draw_strips(axes[SNAPSHOTS + 2], strips, float(file.horizon))
    for one in axes:
        one.tick_params(labelsize=7)
    title = title or f"{file.formula}, set {file.set_name}"
    figure.suptitle(f"{title}, road {file.road.name}", fontsize=9)
    return as_bytes(figure)


def _times(file: DriveFile) -> list[Fraction]:
    return [k * GRAIN for k in range(int(file.horizon / GRAIN) + 1)]


def _snapshot(axes: Any, file: DriveFile, colours: Mapping[str, str], time: Fraction) -> None:
    """The road around the vehicles at one instant, driving direction to the right."""
    states = {name: state_at(file.drive.vehicles[name], time) for name in colours}
    origin = states[next(iter(colours))].s
    shown = [float(x.s - origin) for x in states.values()]
    low, high = min(-30.0, min(shown) - 15.0), max(30.0, max(shown) + 15.0)
    for lanelet in file.road.lanelets:
        ends = (
            low if lanelet.s[0] is None else max(low, float(lanelet.s[0] - origin)),
            high if lanelet.s[1] is None else min(high, float(lanelet.s[1] - origin)),
        )
        if ends[0] < ends[1]:
            right, left = (float(x) for x in lanelet.d)
            shade = {"main": "#ececec", "merge": "#e4ecf4", "depart": "#f4ece0"}[lanelet.zone]
            axes.fill_between(ends, right, left, color=shade, zorder=1, linewidth=0)
            axes.plot(ends, (right, right), color="#888888", lw=0.6, zorder=2)
            axes.plot(ends, (left, left), color="#888888", lw=0.6, zorder=2)
    for name, colour in colours.items():
        motion, state = file.drive.vehicles[name], states[name]
        s = (float(state.s - motion.length - origin), float(state.s - origin))
        draw_box(axes, s, (float(state.d - motion.width), float(state.d)), colour, name)
    axes.set_xlim(low, high)
    axes.set_yticks([])
    axes.set_ylabel(f"{float(time):.1f} s", rotation=0, fontsize=7, ha="right", va="center")
    for side in ("top", "right", "left"):
        axes.spines[side].set_visible(False)


def _speeds(axes: Any, file: DriveFile, colours: Mapping[str, str]) -> None:
    times = _times(file)
    for name, colour in colours.items():
        states: list[State] = [state_at(file.drive.vehicles[name], time) for time in times]
        seconds = [float(time) for time in times]
        axes.plot(seconds, [float(x.v_lon) for x in states], color=colour, label=f"{name} along")
        lateral = [float(x.v_lat) for x in states]
        if any(lateral):
            label = f"{name} across, times 10"
            axes.plot(seconds, [10 * v for v in lateral], color=colour, ls=":", lw=1, label=label)
    axes.set_ylabel("speed, m/s", fontsize=7)
    axes.legend(fontsize=6, loc="upper right", ncols=2, framealpha=0.6)
    axes.set_xlim(0, float(file.horizon))


def _gaps(axes: Any, file: DriveFile, colours: Mapping[str, str], library: Library) -> None:
    """Distance from front to rear where one vehicle is ahead, and the RSS distance that it needs."""
    seconds = [float(time) for time in _times(file)]
    names = list(colours)
    for behind in names:
        for ahead in names:
            margins = _rss_margin(file, library, behind, ahead) if behind != ahead else None
            if margins is None:
                continue
            length = file.drive.vehicles[ahead].length
            gaps = [
                float(
                    state_at(file.drive.vehicles[ahead], t).s
                    - length
                    - state_at(file.drive.vehicles[behind], t).s
                )
                for t in _times(file)
            ]
            if max(gaps) < 0:
                continue
            shown = [gap if gap >= 0 else nan for gap in gaps]  # nan leaves the line open
            needed = [gap + margin for gap, margin in zip(shown, margins, strict=True)]
            colour = colours[ahead]
            axes.plot(seconds, shown, color=colour, label=f"{behind} to {ahead}")
            label = f"RSS distance {behind} to {ahead}"
            axes.plot(seconds, needed, color=colour, ls="--", lw=1, label=label)
    axes.set_ylabel("gap along, m", fontsize=7)
    axes.set_xlim(0, float(file.horizon))
    if axes.get_lines():
        axes.legend(fontsize=6, loc="upper right", framealpha=0.6)


def _rss_margin(file: DriveFile, library: Library, behind: str, ahead: str) -> list[float] | None:
    """RSS distance less gap at each time, from the library's own definition; None where it has none."""
    try:
        query = too_near_ahead(library.select(file.set_name, file.options), behind, ahead)
        formula = bind(query.formula, file.road, {}, {**default_values(library), **file.values})
    except RoadproofError:
        return None
    comparisons = [x for x in subformulas(formula) if isinstance(x, Compare)]
    if len(comparisons) != 2:
        return None
    nearer: Formula = comparisons[1]
    return list(robustness(nearer, file.drive, GRAIN, _times(file)[-1]).margins[nearer])


def _strips(file: DriveFile, library: Library) -> Iterator[tuple[str, TruthSet]]:
    """When each named part of the formula is true, in the order of the template."""
    judgement = judge_file(file, library).judgement
    if judgement is not None:
        for part, truth in judgement.named():
            yield f"{part.name}({', '.join(part.arguments)})", truth


def _draw_strips(axes: Any, strips: list[tuple[str, TruthSet]], horizon: float) -> None:
    for row, (_, truth) in enumerate(strips):
        for span in truth.spans():
            begin = approximate(span.begin.point)
            end = horizon if span.end is None else min(horizon, approximate(span.end.point))
            if begin <= horizon:
                width = max(end - begin, horizon / 300)
                axes.barh(row, width, left=begin, height=0.7, color="#4b8b3b")
    axes.set_yticks(range(len(strips)), [name for name, _ in strips], fontsize=6)
    axes.set_ylim(len(strips) - 0.4, -0.6)
    axes.set_xlim(0, horizon)
    axes.set_xlabel("s; green where true", fontsize=7)
