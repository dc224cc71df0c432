"""What the viewer shows of a recorded trace: samples as they are, and formulas as the monitor has them."""

from collections.abc import Sequence
from typing import Any

from roadproof.evaluation.observed import Observed, Strip
from roadproof.evaluation.one_trace import OneTrace
from roadproof.report.viewer_data import SCHEMA, shown_road
from roadproof.spec.scenarios import SUBJECT


def recorded_data(trace: OneTrace, observed: Sequence[tuple[str, Observed]], set_name: str) -> dict[str, Any]:
    """The document for a trace; ``observed`` are roles and what the monitor said of each formula.

    Between samples vehicles are drawn as if they kept their speed. RSS distances are not drawn.
    """
    batch = trace.batch
    count = int(batch.lengths[0])
    dt = float(batch.dt)
    names = sorted({name for _, name in batch.signals}, key=lambda name: (name != SUBJECT, name))
    drive = {
        "set": set_name,
        "horizon": (count - 1) * dt,
        "grain": dt,
        "lanes": dict(trace.lanes),
        "road": shown_road(trace.road),
        "vehicles": {name: _shown_vehicle(trace, name, count, dt) for name in names},
        "distances": [],
        "dangers": [],
    }
    return {
        "schema": SCHEMA,
        "title": trace.source,
        "verdict": {},
        "drive": drive,
        "file": None,
        "formulas": [_shown_formula(role, x, set_name) for role, x in observed],
    }


def _shown_vehicle(trace: OneTrace, name: str, count: int, dt: float) -> dict[str, Any]:
    batch = trace.batch

    def column(signal: Any) -> list[float]:
        return [round(float(x), 4) for x in batch.signals[signal, name][:count, 0]]

    columns = [column(x) for x in ("s", "d", "v_lon", "v_lat")]
    knots = [[round(k * dt, 6), *row, 0.0, 0.0] for k, row in enumerate(zip(*columns, strict=True))]
    length, width = (float(batch.sizes[x, name][0]) for x in ("length", "width"))
    return {"length": length, "width": width, "knots": knots}


def _shown_formula(role: str, observed: Observed, set_name: str) -> dict[str, Any]:
    strips = observed.strips
    return {
        "role": role,
        "formula": observed.formula,
        "set": set_name,
        "text": observed.formula,
        "sentence": "",
        "holds": observed.verdict == "true",
        "undecided": observed.verdict == "undecided",
        "parts": [_shown_part(strips, k) for k in range(len(strips))],
        "more": 0,
        "step": 0.0,
    }


def _shown_part(strips: Sequence[Strip], place: int) -> dict[str, Any]:
    """A strip as a part whose children are the strips one deeper that follow it."""
    one = strips[place]
    children = []
    for k in range(place + 1, len(strips)):
        if strips[k].depth <= one.depth:
            break
        if strips[k].depth == one.depth + 1:
            children.append(k)
    true = [[begin, end, True, True] for begin, end in one.true]
    told = "; ".join(f"{begin:g} to {end:g} s" for begin, end in one.true) or "at no sample"
    doubt = [[begin, end, True, True] for begin, end in one.undecided]
    return {"op": "part", "text": one.name, "children": children, "true": true, "open": doubt, "exact": told}
