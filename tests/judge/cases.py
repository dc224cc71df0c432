"""Random drives, truth sets and formulas for the judge's tests."""

from fractions import Fraction
from itertools import product

from hypothesis import strategies as st

from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.semantics.exact.truth import from_switches
from roadproof.world.drive import Drive, Motion, Piece
from roadproof.world.signals import SIGNALS

HALF = Fraction(1, 2)
halves = st.integers(0, 6).map(lambda n: n * HALF)


@st.composite
def intervals(draw):
    low = draw(halves)
    high = draw(st.one_of(st.none(), halves.map(lambda more: low + more)))
    return f.Interval(t.number(low), None if high is None else t.number(high))


def _looking_back(inner):
    yield st.builds(f.Since, inner, intervals(), inner)
    yield st.builds(f.once, intervals(), inner)
    yield st.builds(f.historically, intervals(), inner)


def formulas(atoms, leaves=6, past=True):
    """Formulas over ``atoms`` with every operator; without ``past``, with those that look ahead."""
    return st.recursive(
        atoms,
        lambda inner: st.one_of(
            inner.map(f.Not),
            st.tuples(inner, inner).map(f.And),
            st.tuples(inner, inner).map(f.Or),
            st.builds(f.Eventually, intervals(), inner),
            st.builds(f.Always, intervals(), inner),
            st.builds(f.Until, inner, intervals(), inner),
            *(_looking_back(inner) if past else ()),
        ),
        max_leaves=leaves,
    )


@st.composite
def truth_sets(draw):
    """Truth sets whose switches are multiples of 1/2, few, so that they often coincide."""
    points = sorted(draw(st.sets(st.integers(1, 5), max_size=4)))
    pairs = [(draw(st.booleans()), draw(st.booleans())) for _ in range(len(points) + 1)]
    return from_switches((Fraction(p, 2), *pair) for p, pair in zip([0, *points], pairs, strict=True))


OPAQUE = tuple(f.Compare(t.Signal("s", name), ">", t.number(0)) for name in ("P", "Q", "R"))


@st.composite
def opaque_cases(draw):
    """A formula over three opaque atoms, and their truth sets; two of three are until or since."""
    plain = formulas(st.sampled_from(OPAQUE))
    side = formulas(st.sampled_from(OPAQUE), leaves=2)
    both = [st.builds(operator, side, intervals(), side) for operator in (f.Until, f.Since)]
    formula = draw(st.one_of(plain, *both))
    return formula, {atom: draw(truth_sets()) for atom in OPAQUE}


def every_small_case():
    """Every operator on every truth set that switches at 0 and 1 only (for one operand: also at 2)."""
    bounds = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 3), (0, None), (1, None)]
    windows = [f.Interval(t.number(a), None if b is None else t.number(b)) for a, b in bounds]
    left, right, _ = OPAQUE
    for one, other in product(all_sets(2), repeat=2):
        given = {left: one, right: other}
        yield f.And((left, right)), given
        yield f.Or((left, f.Not(right))), given
        for window in windows:
            yield f.Until(left, window, right), given
            yield f.Since(left, window, right), given
    for one in all_sets(3):
        for window in windows:
            yield f.Eventually(window, left), {left: one}
            yield f.Always(window, left), {left: one}
            yield f.once(window, left), {left: one}
            yield f.historically(window, left), {left: one}


def all_sets(points):
    """Every truth set that switches at 0, 1, …, points - 1 only."""
    for bits in product([False, True], repeat=2 * points):
        yield from_switches((Fraction(i), bits[2 * i], bits[2 * i + 1]) for i in range(points))


NO_JERK = st.just(0)


@st.composite
def motions(draw, jerks=NO_JERK):
    numbers = st.integers(-4, 8).map(lambda n: Fraction(n, 2))
    accelerations = st.integers(-3, 3).map(Fraction)
    durations = st.integers(1, 4).map(lambda n: n * HALF)
    pieces = [
        Piece(draw(durations), draw(accelerations), draw(accelerations), Fraction(draw(jerks)))
        for _ in range(draw(st.integers(0, 2)))
    ]
    last = Piece(None, draw(accelerations), draw(accelerations))
    state = [draw(numbers) for _ in range(4)]
    return Motion(Fraction(2), Fraction(1), *state, (*pieces, last))


drives = st.builds(lambda a, b: Drive({"A": a, "B": b}), motions(), motions())
jerks = st.sampled_from([0, 1, -1, 2, -3])
jerk_drives = st.builds(lambda a, b: Drive({"A": a, "B": b}), motions(jerks), motions(jerks))

operators = st.sampled_from(["<", "<=", ">", ">="])
numbers = st.integers(-6, 12).map(lambda n: t.number(Fraction(n, 2)))


def comparisons_of(names):
    """Comparisons of terms of every kind over signals of these names."""
    signals = st.builds(t.Signal, st.sampled_from(names), st.sampled_from("AB"))
    sides = st.one_of(
        signals,
        numbers,
        st.builds(lambda x, y: t.subtract(x, y), signals, signals),
        st.builds(lambda x, y: t.Maximum((x, y)), signals, st.one_of(signals, numbers)),
        st.builds(lambda x, y: t.Minimum((x, y)), signals, st.one_of(signals, numbers)),
        st.builds(
            lambda x, y: t.Sum((x, t.Product((y, y)))),
            numbers,
            st.builds(t.Signal, st.just("v_lon"), st.sampled_from("AB")),
        ),
        st.builds(
            lambda x: t.Quotient(t.Power(x, 2), t.number(3)),
            st.builds(t.Signal, st.just("v_lat"), st.sampled_from("AB")),
        ),
    )
    return st.one_of(
        st.builds(f.Compare, sides, operators, sides),
        st.builds(f.Compare, sides.map(t.Inverse), operators, st.one_of(sides, sides.map(t.Inverse))),
        st.builds(f.Compare, numbers, operators, sides.map(t.Inverse)),
    )


comparisons = comparisons_of(tuple(x for x in SIGNALS if x != "j_lon"))
jerk_comparisons = comparisons_of(tuple(SIGNALS))
