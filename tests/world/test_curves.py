"""Curves and reference lines against integrations that share nothing with them."""

import math
from dataclasses import replace
from fractions import Fraction as F
from itertools import pairwise

import numpy as np
import pytest

from roadproof.world.curves import Cubic, Curve, Line, Polyline, Spiral, length_of
from roadproof.world.length_error import length_error
from roadproof.world.reference_line import Part, ReferenceLine
from roadproof.world.road import Lanelet

ONE, ZERO = F(1), F(0)
LENGTH = F(120)
CURVES: dict[str, Curve] = {
    "line": Line(),
    "arc": Spiral(F(1, 400), F(1, 400)),
    "tight arc": Spiral(F(-1, 25), F(-1, 25)),
    "spiral": Spiral(ZERO, F(-1, 100)),
    "spiral that turns back": Spiral(F(1, 80), F(-1, 60)),
    "cubic": Cubic((ZERO, ONE, ZERO, ZERO), (ZERO, ZERO, F(1, 500), F(-1, 90_000)), None),
    "parametric": Cubic((ZERO, F(118), F(2), F(-3)), (ZERO, ZERO, F(25), F(-9)), ONE),
    "parametric by length": Cubic((ZERO, ONE, ZERO, F(-1, 200_000)), (ZERO, ZERO, F(1, 900), ZERO), LENGTH),
}


def dense(curve: Curve) -> tuple[np.ndarray, np.ndarray]:
    """Lengths and places (n, 2) of many points, by trapezia; of cubics from the formula of their points."""
    if isinstance(curve, Cubic):
        last = 1.0 if curve.last is None else float(curve.last)
        t = np.linspace(0, 130.0 if curve.last is None else last, 400_001)
        u, v = (sum(float(c) * t**k for k, c in enumerate(x)) for x in (curve.u, curve.v))
        steps = np.hypot(np.diff(u), np.diff(v))
        s = np.concatenate(([0.0], np.cumsum(steps)))
        if curve.last is not None:
            s *= float(LENGTH) / s[-1]
        return s, np.stack((u, v), axis=1)
    s = np.linspace(0, float(LENGTH), 400_001)
    begin, end = (0.0, 0.0) if isinstance(curve, Line) else (float(curve.begin), float(curve.end))
    curvature = begin + (end - begin) * s / float(LENGTH)
    heading = np.concatenate(([0.0], np.cumsum((curvature[1:] + curvature[:-1]) / 2 * np.diff(s))))
    middle = (heading[1:] + heading[:-1]) / 2
    x, y = (np.concatenate(([0.0], np.cumsum(f(middle) * np.diff(s)))) for f in (np.cos, np.sin))
    return s, np.stack((x, y), axis=1)


@pytest.mark.parametrize("name", CURVES)
def test_places_and_headings_agree_with_an_integration(name: str) -> None:
    curve = CURVES[name]
    s, places = dense(curve)
    for at in (0.0, 7.3, 60.0, 111.1, 120.0):
        pose = curve.pose(at, LENGTH)
        x, y = (np.interp(at, s, places[:, k]) for k in (0, 1))
        assert math.hypot(pose.x - x, pose.y - y) < 1e-5
        k = min(int(np.searchsorted(s, at)), len(s) - 2)
        way = math.atan2(*(places[k + 1] - places[max(k - 1, 0)])[::-1])
        assert abs(math.remainder(pose.heading - way, math.tau)) < 1e-4


@pytest.mark.parametrize("name", CURVES)
def test_the_curvature_is_within_its_bounds(name: str) -> None:
    curve = CURVES[name]
    bends = list(curve.bends(LENGTH))
    assert bends[0].begin == 0
    assert bends[-1].end == LENGTH
    assert all(a.end == pytest.approx(b.begin) for a, b in pairwise(bends))
    step = 1e-3
    for at in np.linspace(0.5, 119.5, 97):
        before, after = curve.pose(at - step, LENGTH), curve.pose(at + step, LENGTH)
        curvature = (after.heading - before.heading) / math.hypot(after.x - before.x, after.y - before.y)
        bend = next(x for x in bends if x.begin <= at <= x.end)
        t = (at - float(bend.begin)) / float(bend.end - bend.begin)
        low, high = (float(x[0]) + t * float(x[1] - x[0]) for x in (bend.low, bend.high))
        assert low - 1e-7 <= curvature <= high + 1e-7
        assert high - low < 0.01  # bounds that say something


def test_a_polyline_is_near_to_the_circle_it_is_sampled_from() -> None:
    radius, count = 400.0, 101
    turns = [k * 120 / radius / (count - 1) for k in range(count)]
    points = tuple((F(radius * math.sin(x)), F(radius * (1 - math.cos(x)))) for x in turns)
    line = Polyline(points)
    length = F(length_of(line))
    assert float(length) == pytest.approx(120, abs=1e-4)
    pose = line.pose(60.0, length)
    assert math.hypot(pose.x - radius * math.sin(0.15), pose.y - radius * (1 - math.cos(0.15))) < 1e-3
    assert pose.heading == pytest.approx(0.15, abs=1e-4)
    assert line.pose(60.9, length).heading == pytest.approx(60.9 / radius, abs=1e-4)
    inner = [x for x in line.bends(length) if 2 < x.begin < 118]
    assert all(float(x.low[0]) == pytest.approx(1 / radius, rel=0.01) for x in inner)


def road_line(**more: object) -> ReferenceLine:
    """Straight on, a spiral, an arc to the left."""
    straight = Part(ZERO, F(100), F(10), F(20), F(1, 2), Line())
    end = straight.pose(100.0)
    spiral = Part(F(100), F(80), F(end.x), F(end.y), F(end.heading), Spiral(ZERO, F(1, 400)))
    end = spiral.pose(180.0)
    arc = Part(F(180), F(300), F(end.x), F(end.y), F(end.heading), Spiral(F(1, 400), F(1, 400)))
    return ReferenceLine((straight, spiral, arc))


def test_a_place_is_found_again() -> None:
    line = road_line()
    for s in (-30.0, 0.0, 99.9, 100.1, 140.0, 180.0, 333.3, 480.0, 520.0):
        for d in (-11.0, 0.0, 3.7):
            found = line.locate(*line.place(s, d))
            assert found == pytest.approx((s, d), abs=1e-6)


def test_what_goes_backward_is_the_same_line_from_the_other_end() -> None:
    line = road_line()
    back = ReferenceLine(
        tuple(
            Part(480 - x.end, x.length, x.x, x.y, x.heading, x.curve, backward=True) for x in line.parts[::-1]
        )
    )
    for s, d in ((0.0, 2.0), (130.0, -3.0), (400.0, 0.5)):
        assert back.place(480 - s, -d) == pytest.approx(line.place(s, d), abs=1e-9)
    there = {(x.begin, x.end): (x.low, x.high) for x in line.bends()}
    for bend in back.bends():
        low, high = there[480 - bend.end, 480 - bend.begin]
        assert (bend.low, bend.high) == ((-high[1], -high[0]), (-low[1], -low[0]))


def test_a_line_beside_a_curve_bends_more_on_the_inside() -> None:
    arc = Part(ZERO, F(100), ZERO, ZERO, ZERO, Spiral(F(1, 100), F(1, 100)), offset=F(20))
    (bend,) = arc.bends()
    assert bend.low[0] == bend.high[1] == F(1, 80)
    pose = arc.pose(0.0)
    assert (pose.x, pose.y) == pytest.approx((0, 20))
    turned = replace(arc, heading=F(1)).pose(0.0)
    assert (turned.x, turned.y) == pytest.approx((-20 * math.sin(1), 20 * math.cos(1)))


def test_the_error_of_lengths_is_that_of_the_outer_edge() -> None:
    lanelets = (
        Lanelet("a", "one", "main", "main", (ZERO, F(480)), (F(-7), F(-7, 2))),
        Lanelet("b", "two", "main", "main", (ZERO, F(480)), (F(-7, 2), ZERO)),
    )
    error = length_error(road_line(), lanelets)
    assert error.share == F(7, 400)
    inner = 80 * math.hypot(0, 1 / 800) + 300 / 400  # of the spiral the mean is half of its end
    assert float(error.metres) >= 7 * inner
    assert str(error).startswith("1.8 %, ")
