"""``true`` means true whatever comes after the trace, ``false`` means false: on traces that never end.

The continuations here become constant and stay so, which makes unbounded operators decidable: from
the last change on, every formula keeps its value. The exact judge is asked the same on drives.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from monitoring.cases import DT, IN_LANE, ON_MAIN, formulas, intervals, random_batch, trace_of
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula, subformulas
from roadproof.logic.rewrite import bounds_of
from roadproof.semantics.sampled import Batch, compile
from roadproof.semantics.sampled.recursive import Trace, TraceReader
from roadproof.world.drive import Drive, Motion, Piece


@dataclass(frozen=True)
class Endless:
    """A trace whose last sample lasts for ever."""

    trace: Trace

    def holds(self, formula: Formula, k: int) -> bool:
        last = self.trace.length - 1
        k = min(k, last)
        match formula:
            case f.Not(body):
                return not self.holds(body, k)
            case f.And(parts):
                return all(self.holds(p, k) for p in parts)
            case f.Or(parts):
                return any(self.holds(p, k) for p in parts)
            case f.Application(_, _, body) if formula not in self.trace.given:
                return self.holds(body, k)
            case f.Eventually(interval, body):
                return any(self.holds(body, j) for j in self.window(interval, k))
            case f.Always(interval, body):
                return all(self.holds(body, j) for j in self.window(interval, k))
            case f.Until(left, interval, right):
                window = self.window(interval, k)
                return any(
                    self.holds(right, j) and all(self.holds(left, i) for i in window if i < j) for j in window
                )
            case _:
                return TraceReader(self.trace).holds(formula, k, "clip")

    def window(self, interval: f.Interval, k: int) -> range:
        low, high = (None if x is None else x / DT for x in bounds_of(interval))
        assert low is not None
        first = k + int(low)
        return range(first, (max(first, self.trace.length) if high is None else k + int(high)) + 1)


def _continued(batch: Batch, seed: int) -> list[Trace]:
    """Every trace of the batch with some more samples."""
    other = random_batch(seed, batch.traces, 6)
    made = []
    for i in range(batch.traces):
        head, tail = trace_of(batch, i), trace_of(other, i)
        given_truth = {x: [*head.given[x], *tail.given[x]] for x in head.given}
        signals = {x: [*head.signals[x], *tail.signals[x]] for x in head.signals}
        made.append(Trace(DT, head.length + tail.length, signals, head.sizes, given_truth))
    return made


@settings(max_examples=300, deadline=None, derandomize=True)
@given(formulas, st.integers(0, 10**6))
def test_decided_answers_hold_for_every_continuation(formula: Formula, seed: int) -> None:
    batch = random_batch(seed, 4, 6)
    found = compile({"it": formula}).evaluate(batch).answers["it"]
    for other in range(3):
        for i, trace in enumerate(_continued(batch, seed + 1 + other)):
            holds = Endless(trace).holds(formula, 0)
            assert not (found.true[i] and not holds), trace
            assert not (found.false[i] and holds), trace


def test_endless_traces_refute_clipped_answers() -> None:
    """The property above can fail: answers of the other convention do not have it."""
    formula = f.Always(f.FOREVER, IN_LANE)
    batch = random_batch(3, 40, 2)
    found = compile({"it": formula}).evaluate(batch, "clip").answers["it"]
    endless = [Endless(x).holds(formula, 0) for x in _continued(batch, 7)]
    assert any(found.true[i] and not holds for i, holds in enumerate(endless))


def test_every_answer_occurs_and_undecided_is_needed() -> None:
    formula = f.Until(IN_LANE, f.Interval(t.number(0), t.number(4 * DT)), ON_MAIN)
    batch = random_batch(11, 200, 6)
    found = compile({"it": formula}).evaluate(batch).answers["it"]
    assert found.true.any()
    assert found.false.any()
    undecided = np.flatnonzero(found.undecided)
    both = {Endless(_continued(batch, k)[i]).holds(formula, 0) for k in range(20) for i in undecided[:5]}
    assert both == {True, False}


# --- the exact judge ---------------------------------------------------------------------------------

ACCELERATIONS: tuple[tuple[t.SignalName, str], ...] = (
    ("a_lon", "SV"),
    ("a_lat", "SV"),
    ("a_lon", "POV"),
    ("a_lat", "POV"),
)
acceleration_atoms = st.builds(
    f.Compare,
    st.sampled_from([t.Signal(*key) for key in ACCELERATIONS]),
    st.sampled_from(["<", "<=", ">", ">="]),
    st.sampled_from([t.number(0), t.Signal("a_lon", "POV")]),
)
acceleration_formulas = st.recursive(
    acceleration_atoms,
    lambda inner: st.one_of(
        st.builds(f.Not, inner),
        st.builds(lambda x, y: f.And((x, y)), inner, inner),
        st.builds(lambda x, y: f.Or((x, y)), inner, inner),
        st.builds(f.Eventually, intervals, inner),
        st.builds(f.Always, intervals, inner),
        st.builds(f.Until, inner, intervals, inner),
    ),
    max_leaves=6,
)


def _drive(accelerations: Sequence[Sequence[int]]) -> Drive:
    """Accelerations that change at samples only; the last ones stay for ever."""
    vehicles = {}
    for vehicle, columns in (("SV", (0, 1)), ("POV", (2, 3))):
        rows = [tuple(Fraction(row[c]) for c in columns) for row in accelerations]
        pieces = [Piece(DT, *row) for row in rows[:-1]] + [Piece(None, *rows[-1])]
        vehicles[vehicle] = Motion(*(Fraction(x) for x in (4, 2, 0, 0, 20, 0)), tuple(pieces))
    return Drive(vehicles)


def _sampled(accelerations: Sequence[Sequence[int]], samples: int) -> Batch:
    rows = [accelerations[min(k, len(accelerations) - 1)] for k in range(samples)]
    signals = {key: np.array([[float(row[c])] for row in rows]) for c, key in enumerate(ACCELERATIONS)}
    return Batch(DT, np.array([samples]), signals)


@settings(max_examples=200, deadline=None, derandomize=True)
@given(
    acceleration_formulas,
    st.lists(st.tuples(*[st.integers(-1, 1)] * 4), min_size=1, max_size=6),
    st.integers(1, 10),
)
def test_decided_answers_are_those_of_the_judge(
    formula: Formula, accelerations: list[tuple[int, ...]], samples: int
) -> None:
    judge = pytest.importorskip("roadproof.semantics.exact.exact").judge
    holds = judge(formula, _drive(accelerations)).holds
    found = compile({"it": formula}).evaluate(_sampled(accelerations, samples)).answers["it"]
    assert not (found.true[0] and not holds)
    assert not (found.false[0] and holds)


@settings(max_examples=200, deadline=None, derandomize=True)
@given(acceleration_formulas, st.lists(st.tuples(*[st.integers(-1, 1)] * 4), min_size=1, max_size=6))
def test_bounded_formulas_inside_a_trace_are_decided_as_the_judge_does(
    formula: Formula, accelerations: list[tuple[int, ...]]
) -> None:
    judge = pytest.importorskip("roadproof.semantics.exact.exact").judge
    temporal = [x for x in subformulas(formula) if isinstance(x, f.Until | f.Eventually | f.Always)]
    assume(all(x.interval.high is not None for x in temporal))
    longest = 1 + sum(int(bounds_of(x.interval)[1] / DT) for x in temporal)  # type: ignore[operator]
    verdicts = compile({"it": formula}).evaluate(_sampled(accelerations, longest))
    clipped = compile({"it": formula}).evaluate(_sampled(accelerations, longest), "clip")
    holds = judge(formula, _drive(accelerations)).holds
    assert verdicts.answers["it"].true[0] == holds
    assert verdicts.answers["it"].false[0] == (not holds)
    assert clipped.answers["it"].true[0] == holds
