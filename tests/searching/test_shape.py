"""What makes drives alike or different, and inequalities that are kept with a margin."""

from fractions import Fraction

import pytest

from roadproof.engines.encode.circuit import evaluate
from roadproof.engines.encode.motion import Layout
from roadproof.engines.encode.unroll import Grid
from roadproof.engines.search.shape import _with_margin
from roadproof.engines.search.variety import differ
from roadproof.engines.solve.bounds import Affine, Bound
from roadproof.engines.solve.smooth import minimise
from roadproof.world.drive import Drive, Motion, Piece
from roadproof.world.models import load_road, load_vehicle

X, Y = Affine(((0, 1.0),), 0.0), Affine(((1, 1.0),), 0.0)
BOUNDS = [Bound(X, 0.5), Bound(X + Y.scaled(-1.0), 0.25), Bound(Y, 0.0)]


def greatest(x_most):
    """The point where the inequalities with a margin hold by as much as they can; y is fixed at 0."""
    box, bounds, cost = _with_margin([(0.0, x_most), (0.0, 0.0)], BOUNDS)
    found = minimise([], box, bounds, [], cost)
    return None if found is None else found[:2]


def test_facts_with_a_margin_hold_by_as_much_as_they_can():
    assert greatest(8.0) == pytest.approx((8.0, 0.0), abs=1e-3)


def test_no_fact_keeps_less_than_the_least_margin():
    assert greatest(0.1) is None


def test_vehicles_clearly_apart_across_are_in_different_lanes():
    """From one side of a lane to the other is no other drive, from lane to lane is."""
    car, layout = load_vehicle("car"), Layout(("SV",), Grid(Fraction(1), 1))
    right, left = load_road("main-2").lanelets[0].d
    still = (Piece(None, Fraction(0), Fraction(0)),)
    start = right + car.width
    other = Drive({"SV": Motion(car.length, car.width, Fraction(0), start, Fraction(20), Fraction(0), still)})
    for d, clearly in ((left, False), (start + left - right, True)):
        signals = {"s": (0, 20), "d": (d, d), "v_lon": (20, 20), "v_lat": (0, 0)}
        values = {layout.column("SV", x, k): Fraction(pair[k]) for x, pair in signals.items() for k in (0, 1)}
        made = differ(layout, other)
        assert evaluate(made, lambda x, v=values: x.polynomial.value(lambda c: v[c]) >= 0) == clearly
