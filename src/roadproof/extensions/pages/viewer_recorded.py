"""What the viewer shows of a recorded trace: samples as they are, and formulas as the monitor has them."""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any

from roadproof.errors import RoadproofError
from roadproof.extensions.pages import viewer_document as document
from roadproof.extensions.pages.viewer_data import short_number, shown_road
from roadproof.extensions.traffic.evaluate.observed import FirstAnswer, Strip, margins_of
from roadproof.extensions.traffic.evaluate.one_trace import OneTrace
from roadproof.frontends.report.drive_data import Direction, nearer_in, too_near
from roadproof.library.bind import bind
from roadproof.library.roles import vehicle_order
from roadproof.library.specification import Specification
from roadproof.world.signals import SIGNALS, SizeName

_DIRECTIONS: tuple[Direction, ...] = ("along", "across")


def recorded_data(
    trace: OneTrace,
    observed: Sequence[tuple[str, FirstAnswer]],
    home: Specification,
    values: Mapping[str, Fraction],
) -> document.Document:
    """The document for a trace; ``observed`` are roles and what the monitor said of each formula.

    Between samples vehicles are drawn as if they kept their speed. ``values`` of parameters, with the
    definitions of ``home``, say how far the RSS distances are; of danger nothing is told beside the strips.
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
        shown_road(trace.road, (min(places), max(places))),
        {name: _shown_vehicle(trace, name, count, dt) for name in names},
        [
            shown
            for direction in _DIRECTIONS
            for other in names[1:]
            if (shown := _shown_distance(trace, home, values, direction, names[0], other)) is not None
        ],
    )
    return document.Document(
        trace.source, drive, None, [_shown_formula(role, x, home.set_name) for role, x in observed]
    )


def _shown_vehicle(trace: OneTrace, name: str, count: int, dt: float) -> document.VehicleView:
    batch = trace.batch

    def column(signal: Any) -> list[float]:
        return [round(float(x), 4) for x in batch.signals[signal, name][:count, 0]]

    columns = [column(x) for x, about in SIGNALS.items() if about.kept == "start"]
    knots = [[round(k * dt, 6), *row, 0.0, 0.0, 0.0] for k, row in enumerate(zip(*columns, strict=True))]
    length, width = (float(batch.sizes[x, name][0]) for x in ("length", "width"))
    return document.VehicleView(length, width, knots)


def _shown_distance(
    trace: OneTrace,
    home: Specification,
    values: Mapping[str, Fraction],
    direction: Direction,
    one: str,
    other: str,
) -> document.DistanceView | None:
    """Gap and RSS distance at each sample; None where the library has none, or of another form."""
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


def _shown_formula(role: str, observed: FirstAnswer, set_name: str) -> document.FormulaView:
    return document.FormulaView(
        role,
        observed.formula,
        set_name,
        text=observed.formula,
        sentence="",
        holds=observed.verdict == "true",
        undecided=observed.verdict == "undecided",
        parts=[_shown_part(observed.strips, k) for k in range(len(observed.strips))],
        more=0,
        step=float(observed.dt),
    )


def _shown_part(strips: Sequence[Strip], place: int) -> document.PartView:
    """A strip as a part whose children are the strips one deeper that follow it."""
    one = strips[place]
    children = []
    for k in range(place + 1, len(strips)):
        if strips[k].depth <= one.depth:
            break
        if strips[k].depth == one.depth + 1:
            children.append(k)
    told = "; ".join(f"{begin:g} to {end:g} s" for begin, end in one.true) or "at no sample"
    margins = [None if x is None else short_number(x) for x in one.margins]
    return document.PartView(
        "part",
        one.name,
        children,
        [document.Span(*x) for x in one.true],
        [document.Span(*x) for x in one.undecided],
        told,
        margins=margins if any(x is not None for x in margins) else None,
    )
