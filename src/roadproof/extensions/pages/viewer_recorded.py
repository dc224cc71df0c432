"""Builds the document of the drive viewer for a recorded trace: samples, and formulas as monitored."""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any

from roadproof.errors import RoadproofError
from roadproof.extensions.pages import viewer_document as document
from roadproof.extensions.pages.drive_data import Direction, nearer_in, too_near
from roadproof.extensions.pages.viewer_data import road_view, short_number
from roadproof.extensions.traffic.evaluate.observed import MonitorResult, TruthStrip, margins_of
from roadproof.extensions.traffic.evaluate.one_trace import OneTrace
from roadproof.library.bind import bind
from roadproof.library.roles import vehicle_order
from roadproof.library.specification import Specification
from roadproof.world.signals import SIGNALS, SizeName

_DIRECTIONS: tuple[Direction, ...] = ("along", "across")


def recorded_data(
    trace: OneTrace,
    observed: Sequence[tuple[str, MonitorResult]],
    home: Specification,
    values: Mapping[str, Fraction],
) -> document.ViewerDocument:
    """Return the document for a trace; ``observed``: pairs of a role and the monitor's answer on a formula.

    Between samples vehicles are drawn as if they kept their speed. The definitions of ``home`` and the
    parameter ``values`` give the RSS distances; danger appears only in the strips.
    """
    batch = trace.batch
    count = int(batch.lengths[0])
    dt = float(batch.dt)
    names = vehicle_order({name for _, name in batch.signals})
    places = [float(x) for name in names for x in batch.signals["s", name][:count, 0]]
    drive = document.DriveView(
        home.set_name,
        (count - 1) * dt,
        dt,
        trace.lanes,
        road_view(trace.road, (min(places), max(places))),
        {name: _vehicle_view(trace, name, count, dt) for name in names},
        [
            shown
            for direction in _DIRECTIONS
            for other in names[1:]
            if (shown := _distance_view(trace, home, values, direction, names[0], other)) is not None
        ],
    )
    return document.ViewerDocument(
        trace.source, drive, None, [_formula_view(role, x, home.set_name) for role, x in observed]
    )


def _vehicle_view(trace: OneTrace, name: str, count: int, dt: float) -> document.VehicleView:
    batch = trace.batch

    def column(signal: Any) -> list[float]:
        return [round(float(x), 4) for x in batch.signals[signal, name][:count, 0]]

    columns = [column(x) for x, about in SIGNALS.items() if about.stored == "start"]
    knots = [[round(k * dt, 6), *row, 0.0, 0.0, 0.0] for k, row in enumerate(zip(*columns, strict=True))]
    length, width = (float(batch.sizes[x, name][0]) for x in ("length", "width"))
    return document.VehicleView(length, width, knots)


def _distance_view(
    trace: OneTrace,
    home: Specification,
    values: Mapping[str, Fraction],
    direction: Direction,
    one: str,
    other: str,
) -> document.DistanceView | None:
    """Return gap and RSS distance at each sample; None where the library defines no distance of this form."""
    batch, count = trace.batch, int(trace.batch.lengths[0])
    signal = "s" if direction == "along" else "d"
    size: SizeName = "length" if direction == "along" else "width"
    at = {name: batch.signals[signal, name][:count, 0].tolist() for name in (one, other)}
    needs = {}
    for low, high in ((one, other), (other, one)):
        try:
            query = too_near(home, direction, low, high)
            nearer = nearer_in(bind(query.formula, trace.road, {}, values))
            needs[low] = None if nearer is None else margins_of(nearer, batch)
        except RoadproofError:
            return None
    behind = [low <= high for low, high in zip(at[one], at[other], strict=True)]
    gaps, needed = [], []
    for k, is_behind in enumerate(behind):
        low, high = (one, other) if is_behind else (other, one)
        margins = needs[low]
        if margins is None:
            return None
        gap = at[high][k] - at[low][k] - float(batch.sizes[size, high][0])
        margin = margins[k]
        gaps.append(short_number(gap))
        needed.append(None if margin is None else short_number(gap + margin))
    return document.DistanceView(direction, one, other, gaps, needed, behind)


def _formula_view(role: str, observed: MonitorResult, set_name: str) -> document.FormulaView:
    return document.FormulaView(
        role,
        observed.formula,
        set_name,
        text=observed.formula,
        sentence="",
        holds=observed.verdict == "true",
        undecided=observed.verdict == "undecided",
        parts=[_part_view(observed.strips, k) for k in range(len(observed.strips))],
        more=0,
        step=float(observed.dt),
    )


def _part_view(strips: Sequence[TruthStrip], place: int) -> document.PartView:
    """Return a strip as a part whose children are the strips one level deeper that follow it."""
    strip = strips[place]
    children = []
    for k in range(place + 1, len(strips)):
        if strips[k].depth <= strip.depth:
            break
        if strips[k].depth == strip.depth + 1:
            children.append(k)
    exact = "; ".join(f"{begin:g} to {end:g} s" for begin, end in strip.true) or "at no sample"
    margins = [None if x is None else short_number(x) for x in strip.margins]
    return document.PartView(
        "part",
        strip.name,
        children,
        [document.TruthSpan(*x) for x in strip.true],
        [document.TruthSpan(*x) for x in strip.undecided],
        exact,
        margins=margins if any(x is not None for x in margins) else None,
    )
