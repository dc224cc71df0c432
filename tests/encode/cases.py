"""Random formulas and traces on a grid, and a reading of formulas there by definition."""

import operator
from fractions import Fraction

from hypothesis import strategies as st

from definition import Definition
from roadproof.engines.encode.unroll import Grid
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.world.drive import Drive, Motion, Piece

DT = Fraction(1, 2)
STEPS = 5
GRID = Grid(DT, STEPS)
OPERATORS = {"<": operator.lt, "<=": operator.le, ">": operator.gt, ">=": operator.ge}
SIGNALS = (("a_lon", "A"), ("a_lat", "A"), ("a_lon", "B"))


def atom(signal, vehicle, op, threshold):
    return f.Compare(t.Signal(signal, vehicle), op, t.Number(threshold, (1, -2)))


atoms = st.builds(
    lambda which, op, half: atom(*which, op, Fraction(2 * half + 1, 2)),
    st.sampled_from(SIGNALS),
    st.sampled_from(["<", "<=", ">", ">="]),
    st.integers(-2, 1),
)


def interval(low, length):
    seconds = t.Number(low * DT, (0, 1))
    return f.Interval(seconds, None if length is None else t.Number((low + length) * DT, (0, 1)))


bounded = st.builds(interval, st.integers(0, 2), st.integers(0, 3))
intervals = st.one_of(bounded, st.builds(interval, st.integers(0, 2), st.none()))


def _looking_back(inner, windows):
    yield st.builds(f.Since, inner, windows, inner)
    yield st.builds(f.once, windows, inner)
    yield st.builds(f.historically, windows, inner)


def formulas(windows=intervals, leaves=8, past=True):
    """Formulas with every operator; without ``past``, with those that look ahead."""
    return st.recursive(
        atoms | st.builds(f.Truth, st.booleans()),
        lambda inner: st.one_of(
            st.builds(f.Not, inner),
            st.builds(lambda a, b: f.And((a, b)), inner, inner),
            st.builds(lambda a, b: f.Or((a, b)), inner, inner),
            st.builds(f.Eventually, windows, inner),
            st.builds(f.Always, windows, inner),
            st.builds(f.Until, inner, windows, inner),
            *(_looking_back(inner, windows) if past else ()),
            st.builds(lambda a: f.Application("part", (), a), inner),
        ),
        max_leaves=leaves,
    )


# Accelerations from each sample but the last on; after it there are none.
traces = st.fixed_dictionaries(
    {which: st.lists(st.integers(-2, 2), min_size=STEPS, max_size=STEPS) for which in SIGNALS}
)


def value_at(trace, signal, vehicle, sample):
    values = trace.get((signal, vehicle), [0] * STEPS)
    return values[sample] if sample < STEPS else 0


def holds(formula, trace, k=0):
    """Truth at sample k by definition."""

    def atom(comparison, at):
        left = comparison.left
        return OPERATORS[comparison.op](value_at(trace, left.name, left.vehicle, at), comparison.right.value)

    return Definition(STEPS, DT, atom).holds(formula, k)


def as_drive(trace):
    """The drive with the accelerations of ``trace``."""

    def motion(vehicle):
        pieces = [
            Piece(DT, *(Fraction(value_at(trace, s, vehicle, k)) for s in ("a_lon", "a_lat")))
            for k in range(STEPS)
        ]
        start = [Fraction(x) for x in (4, 2, 0, 2, 30, 0)]
        return Motion(*start, (*pieces, Piece(None, Fraction(0), Fraction(0))))

    return Drive({"A": motion("A"), "B": motion("B")})
