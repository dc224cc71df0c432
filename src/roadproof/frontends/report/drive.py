"""A picture of a drive: the road from above, speeds, gaps against RSS distances, and what is true when."""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from textwrap import wrap
from typing import Any

from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.judged import judge_file
from roadproof.frontends.report import drive_data as data
from roadproof.frontends.report.figures import draw_box, hide_frame, legend_beside, make_figure, name_rows
from roadproof.frontends.report.plane import RoadView, extent, extent_of, views_along
from roadproof.library.specification import Library
from roadproof.world.length_error import bend_note
from roadproof.world.motion import State, state_at
from roadproof.world.road import Zone

COLOURS = ("#1f5fbf", "#c8641e", "#4b8b3b", "#8a4fa3")
TRUE, DANGER = "#4b8b3b", "#b5202a"
SHADES: Mapping[Zone, str] = {"main": "#ececec", "merge": "#d6e4f2", "depart": "#f4e4cc"}
SNAPSHOTS = 5
WIDTH, STRIP = 10.0, 0.15
ROAD_INCHES = 6.0  # about what is left of WIDTH between names and legends
_PAD = (4.0, 46.0)  # points to the time of an instant; on a bend there are names of lanes between
HIGHEST = 2.5  # inches of a road with bends
LETTER = (0.058, 0.13)  # of a vehicle's name, in inches


def draw_drive(file: DriveFile, library: Library, title: str = "") -> Any:
    """The road at some instants, then speeds, gaps and strips over one axis of time; no gaps of one vehicle.

    The title is the formula where none is given. Raises ``MissingSolverError`` without matplotlib.
    """
    judgement = judge_file(file, library).judgement
    strips = () if judgement is None else data.strips_of(judgement, file.horizon)
    dangers = data.dangers_of(file, library)
    above = [_road_height(file)] * SNAPSHOTS
    gaps: Mapping[data.Direction, float] = (
        {"along": 1.4, "across": 1.2} if len(file.drive.vehicles) > 1 else {}
    )
    heights = [*above, 1.4, *gaps.values(), 0.2 + STRIP * len(strips)]
    longest = max((2 * x.depth + len(x.name) for x in strips), default=0)
    figure, axes = make_figure(heights, WIDTH + 0.05 * max(0, longest - 50))  # room for names of strips
    colours = dict(zip(data.vehicles_of(file), COLOURS * len(file.drive.vehicles), strict=False))
    _draw_roads(axes[:SNAPSHOTS], file, colours, heights[0])
    speeds, *between, below = axes[SNAPSHOTS:]
    _speeds(speeds, file, colours)
    for one, direction in zip(between, gaps, strict=True):
        _gaps(one, file, colours, library, direction)
    _draw_strips(below, strips)
    _share_time((speeds, *between, below), float(file.horizon), dangers)
    for one in axes:
        one.tick_params(axis="x", labelsize=7)
    figure.align_ylabels(axes[SNAPSHOTS:-1])
    figure.suptitle(_title(file, library, title, dangers), fontsize=9)
    return figure


def _title(file: DriveFile, library: Library, title: str, dangers: Sequence[data.Danger]) -> str:
    """Return the title of a drive: formula, road, and when danger begins."""
    lines = title.splitlines() or data.heading_of(file, library)
    lanes = "".join(f", {name} = {lane}" for name, lane in file.lanes.items())
    lines.append(f"set {file.set_name}, road {file.road.name}{lanes}")
    lines[-1] += "".join(f"; {x}" for x in dangers)
    lines.append(bend_note(file.road))
    return "\n".join(piece for line in lines if line for piece in wrap(line, 120))


# --- the road from above ------------------------------------------------------------------------


def _draw_roads(axes: Sequence[Any], file: DriveFile, colours: Mapping[str, str], height: float) -> None:
    """The road around the vehicles at some instants, all to one scale, driving direction to the right."""
    times, window, views = _snapshots(file)
    zones: dict[Zone, None] = {}
    for k, (one, time) in enumerate(zip(axes, times, strict=True)):
        origin = state_at(file.drive.vehicles[next(iter(colours))], time).s
        road = data.road_in(file.road, origin, window)
        zones |= dict.fromkeys(road.zones)
        if views:
            _bent_snapshot(one, road, views[k], extent_of(views, window, road.across))
        else:
            _snapshot(one, road, window)
        one.set_ylabel(
            f"{float(time):.1f} s",
            rotation=0,
            fontsize=8,
            ha="right",
            va="center",
            labelpad=_PAD[bool(views)],
        )
        size = one.get_xlim()[1] - one.get_xlim()[0], height
        _vehicles(one, file, colours, time, size, views[k] if views else None)
    for zone in zones:
        axes[0].fill([], [], color=SHADES[zone], ec="#888888", lw=0.6, label=data.ZONES[zone])
    legend_beside(axes[0])
    arrow = {"arrowstyle": "->", "lw": 0.9, "color": "#444444"}
    axes[1].annotate("", (1.12, 0.5), (1.01, 0.5), "axes fraction", arrowprops=arrow, annotation_clip=False)
    axes[1].text(1.01, 0.56, "driving direction", fontsize=6, va="bottom", transform=axes[1].transAxes)
    for one in axes[:-1]:
        one.tick_params(axis="x", labelbottom=False)
    along = f"m along the road from the front of {next(iter(colours))}"
    axes[-1].set_xlabel("m to scale, as seen from the middle" if views else along, fontsize=7)


def _snapshots(file: DriveFile) -> tuple[list[Fraction], data.Span, list[RoadView]]:
    """Return some instants, the visible span of the road, and the views of the road then, if it has bends."""
    times = [file.horizon * k / (SNAPSHOTS - 1) for k in range(SNAPSHOTS)]
    window = data.window_of(file, times)
    subject = file.drive.vehicles[data.vehicles_of(file)[0]]
    return times, window, views_along(file.road, (state_at(subject, time).s for time in times), window)


def _road_height(file: DriveFile) -> float:
    """Inches for the road at an instant: by its lanes, or to scale where it has bends."""
    _, window, views = _snapshots(file)
    usual = 0.2 + 0.26 * len(file.road.lanes)
    if not views:
        return usual
    across = data.road_in(file.road, Fraction(0), window).across
    left, right, bottom, top = extent_of(views, window, across)
    return min(max(usual, ROAD_INCHES * (top - bottom) / (right - left)), HIGHEST)


def _bent_snapshot(axes: Any, road: data.ShownRoad, view: RoadView, seen: data.Box) -> None:
    for zone, along, (right, left) in road.pieces:
        axes.fill(*zip(*view.outline((*along, right, left)), strict=True), color=SHADES[zone], lw=0, zorder=1)
        for d in (right, left):
            axes.plot(*zip(*view.edge(*along, d), strict=True), color="#888888", lw=0.6, zorder=2)
    begin = min(along[0] for _, along, _ in road.pieces)
    for name, middle in road.lanes:
        x, y = view.at(begin, middle)
        axes.annotate(name, (x, y), (-3, 0), "data", "offset points", fontsize=6, ha="right", va="center")
    axes.set_aspect("equal")
    axes.set_xlim(*seen[:2])
    axes.set_ylim(seen[2] - 0.2, seen[3] + 0.2)
    axes.set_yticks([])
    hide_frame(axes, ("top", "right", "left"))


def _snapshot(axes: Any, road: data.ShownRoad, window: data.Span) -> None:
    for zone, along, (right, left) in road.pieces:
        axes.fill_between(along, right, left, color=SHADES[zone], zorder=1, linewidth=0)
        axes.plot(along, (right, right), color="#888888", lw=0.6, zorder=2)
        axes.plot(along, (left, left), color="#888888", lw=0.6, zorder=2)
    axes.set_xlim(*window)
    axes.set_ylim(road.across[0] - 0.2, road.across[1] + 0.2)
    axes.set_yticks([middle for _, middle in road.lanes], [name for name, _ in road.lanes], fontsize=6)
    axes.tick_params(axis="y", length=0)
    hide_frame(axes, ("top", "right", "left"))


def _vehicles(
    axes: Any,
    file: DriveFile,
    colours: Mapping[str, str],
    time: Fraction,
    size: tuple[float, float],
    view: RoadView | None,
) -> None:
    """The boxes of all vehicles and their names; ``size``: metres shown along, inches across."""
    origin = state_at(file.drive.vehicles[next(iter(colours))], time).s
    boxes: dict[str, data.Box] = {}
    for name in colours:
        motion, state = file.drive.vehicles[name], state_at(file.drive.vehicles[name], time)
        s, d = float(state.s - origin), float(state.d)
        boxes[name] = (s - float(motion.length), s, d - float(motion.width), d)
    shapes = {} if view is None else {name: view.vehicle(box) for name, box in boxes.items()}
    boxes |= {name: extent(corners) for name, corners in shapes.items()}
    low, high = axes.get_ylim()
    letter = (LETTER[0] * size[0] / ROAD_INCHES, LETTER[1] * (high - low) / size[1])
    names = data.place_names(boxes, {name: (len(name) * letter[0], letter[1]) for name in boxes})
    for name, colour in colours.items():
        if name in shapes:
            axes.fill(*zip(*shapes[name], strict=True), color=colour, lw=0, zorder=3)
        else:
            draw_box(axes, boxes[name], colour)
        if boxes[name][2] > high or boxes[name][3] < low:
            continue  # beside the road that is shown; its name would take the room of the road
        left, _, bottom, top = names[name]
        behind = {"fc": "white", "ec": "none", "alpha": 0.7, "pad": 0.4}
        axes.text(
            left, (bottom + top) / 2, name, fontsize=7, va="center", color=colour, zorder=4, bbox=behind
        )


# --- over time ----------------------------------------------------------------------------------


def _share_time(axes: Sequence[Any], horizon: float, dangers: Sequence[data.Danger]) -> None:
    """One axis of time for all, labelled below the last, and a line through all where danger begins."""
    for one in axes:
        one.set_xlim(0, horizon)
        for danger in dangers:
            one.axvline(danger.begins, color=DANGER, lw=1, ls=(0, (4, 2)), zorder=5)
    for one in axes[:-1]:
        one.sharex(axes[-1])
        one.tick_params(axis="x", labelbottom=False)
    for danger in dangers:
        label = f"danger with {danger.other} begins" if len(dangers) > 1 else "danger begins"
        axes[0].text(
            *(danger.begins, 1.02, f" {label} "),
            fontsize=7,
            color=DANGER,
            ha="left" if danger.begins < 0.8 * horizon else "right",
            transform=axes[0].get_xaxis_transform(),
        )
    axes[-1].set_xlabel("s", fontsize=8)


def _speeds(axes: Any, file: DriveFile, colours: Mapping[str, str]) -> None:
    times = data.times_of(file)
    seconds = [float(time) for time in times]
    for name, colour in colours.items():
        states: list[State] = [state_at(file.drive.vehicles[name], time) for time in times]
        axes.plot(seconds, [float(x.v_lon) for x in states], color=colour, label=f"{name} along")
        lateral = [float(x.v_lat) for x in states]
        if any(lateral):
            label = f"{name} across (to the left), × 10"
            axes.plot(seconds, [10 * v for v in lateral], color=colour, ls=":", lw=1, label=label)
    axes.set_ylabel("speed, m/s", fontsize=7)
    axes.tick_params(axis="y", labelsize=7)
    legend_beside(axes)


def _gaps(
    axes: Any, file: DriveFile, colours: Mapping[str, str], library: Library, direction: data.Direction
) -> None:
    """Distances between boxes, and the RSS distances that they need; shaded where they are below."""
    seconds = [float(time) for time in data.times_of(file)]
    for x in data.distances_of(file, library, direction):
        colour = colours[x.other]
        axes.plot(seconds, x.gap, color=colour, label=f"{x.one} to {x.other}")
        for k, run in enumerate(x.runs):
            label = "" if k else "RSS distance"
            axes.plot(seconds[run], x.needed[run], color=colour, ls="--", lw=1, label=label)
        near = [gap <= needed for gap, needed in zip(x.gap, x.needed, strict=True)]
        if any(near):
            axes.fill_between(
                seconds, x.gap, x.needed, near, color=colour, alpha=0.15, lw=0, label="nearer than that"
            )
    axes.axhline(0, color="#999999", lw=0.5, zorder=0)
    axes.set_ylabel(f"gap {direction}, m", fontsize=7)
    axes.tick_params(axis="y", labelsize=7)
    legend_beside(axes)


def _draw_strips(axes: Any, strips: Sequence[data.Strip]) -> None:
    """A row for each part, its name moved in below what it is part of."""
    for row, strip in enumerate(strips):
        for begin, end in strip.spans:
            axes.barh(row, end - begin, left=begin, height=0.7, color=TRUE, ec=TRUE, lw=0.6)
    name_rows(axes, ["  " * x.depth + x.name for x in strips])
    axes.fill([], [], color=TRUE, label="true")
    legend_beside(axes)
