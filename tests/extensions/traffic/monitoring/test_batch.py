"""What a batch refuses and ignores, steps, packing and blocks."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import partial

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from definition import Definition
from examples import some
from extensions.traffic.monitoring.cases import (
    DT,
    IN_LANE,
    ON_MAIN,
    formulas,
    interval,
    intervals,
    random_batch,
    trace_of,
)
from roadproof.errors import InputError
from roadproof.extensions.traffic.evaluate.recursive import SampledTrace, TraceReader
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula, subformulas
from roadproof.logic.rewrite import bounds_of
from roadproof.semantics.sampled import Batch, boolean, compile
from roadproof.semantics.sampled.answers import Convention
from roadproof.semantics.sampled.arithmetic import Bytecode
from roadproof.semantics.sampled.batch import Array, steps_of
from roadproof.world.drive import Drive, Motion, Piece

S = t.Signal("s", "SV")
FAST = f.Compare(t.Signal("v_lon", "SV"), ">", t.Sum((S, t.Size("length", "SV"))))


def test_a_window_of_six_tenths_at_25_hertz_is_16_samples() -> None:
    assert steps_of(Fraction("0.6"), DT) == 15
    truth = np.ones((17, 2), dtype=bool)
    truth[15, 0] = truth[16, 1] = False
    formula = f.Always(f.Interval(t.number(0), t.number(Fraction("0.6"))), IN_LANE)
    found = compile({"it": formula}).evaluate(Batch(DT, np.array([17, 17]), given={IN_LANE: truth}))
    assert found.answers["it"].true.tolist() == [False, True]


@given(st.integers(0, 10**6), st.fractions(Fraction(1, 1000), 2))
def test_every_multiple_of_the_step_is_its_number_of_steps(count: int, dt: Fraction) -> None:
    assert steps_of(count * dt, dt) == count


def test_a_bound_that_is_no_multiple_names_both() -> None:
    formula = f.Eventually(f.Interval(t.number(0), t.number(Fraction(1, 2))), IN_LANE)
    with pytest.raises(
        InputError, match=r"0\.5 s is no multiple .* dt=0\.04 s .*25/2 steps.*0\.48 s or 0\.52"
    ):
        compile({"it": formula}).evaluate(random_batch(1, 3, 4))
    with pytest.raises(InputError, match="no multiple"):
        compile({"it": formula}).measure(random_batch(1, 3, 4))


@settings(max_examples=some(300), deadline=None)
@given(formulas, st.integers(0, 2**32), st.integers(1, 9), st.integers(1, 130), st.booleans())
def test_what_is_asked_at_the_start_alone_is_the_first_of_all_samples(
    formula: Formula, seed: int, samples: int, traces: int, clip: bool
) -> None:
    monitor, batch = compile({"it": formula}), random_batch(seed, traces, samples)
    convention: Convention = "clip" if clip else "truncated"
    first, everywhere = (monitor.evaluate(batch, convention, at).answers["it"] for at in ("start", "all"))
    assert np.array_equal(first.true, everywhere.true[0])
    assert np.array_equal(first.false, everywhere.false[0])
    low, lows = (monitor.measure(batch, convention, at).margins["it"] for at in ("start", "all"))
    assert np.array_equal(low.low, lows.low[0], equal_nan=True)
    assert np.array_equal(low.high, lows.high[0], equal_nan=True)


@pytest.mark.parametrize("wrong", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("kind", [np.float32, np.float64])
def test_a_sample_that_is_no_number_is_named(wrong: float, kind: type) -> None:
    values = np.zeros((40_000, 3), dtype=kind)
    lengths = np.array([40_000, 30_000, 40_000])
    values[30_000, 1] = wrong  # after the end of trace 1
    Batch(DT, lengths, {("s", "SV"): values})
    values[29_999, 1] = wrong
    with pytest.raises(InputError, match=r"s\(SV\) is .* in trace 1 at sample 29999"):
        Batch(DT, lengths, {("s", "SV"): values})


ONE = np.array([2, 2])


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Batch(Fraction(0), ONE), "dt=0"),
        (lambda: Batch(DT, np.array([], dtype=int)), "one whole number a trace"),
        (lambda: Batch(DT, np.array([1.0])), "one whole number a trace"),
        (lambda: Batch(DT, np.array([2, 0])), "trace 1 has length=0"),
        (lambda: Batch(DT, ONE, {("s", "SV"): np.zeros((2, 3))}), r"s\(SV\) has shape \(2, 3\)"),
        (lambda: Batch(DT, ONE, {("s", "SV"): np.zeros((1, 2))}), r"need \(time, traces\) = \(2, 2\)"),
        (lambda: Batch(DT, ONE, {("s", "SV"): np.zeros((2, 2), dtype=int)}), "float64 or float32"),
        (lambda: Batch(DT, ONE, {}, {("length", "SV"): np.array([1.0, 0.0])}), "trace 1"),
        (lambda: Batch(DT, ONE, {}, {("length", "SV"): np.array([np.nan, 1.0])}), "trace 0"),
        (lambda: Batch(DT, ONE, {}, {("length", "SV"): np.array([1.0])}), "there are 2 traces"),
        (lambda: Batch(DT, ONE, given={IN_LANE: np.zeros((2, 2))}), "array of bool"),
        (lambda: Batch(DT, ONE, given={IN_LANE: np.zeros((1, 2), dtype=bool)}), "has shape"),
        (
            lambda: Batch(DT, ONE, given={f.Eventually(f.FOREVER, IN_LANE): np.ones((2, 2), dtype=bool)}),
            "without temporal",
        ),
    ],
)
def test_a_batch_that_does_not_fit_is_refused(make: Callable[[], Batch], message: str) -> None:
    with pytest.raises(InputError, match=message):
        make()


@pytest.mark.parametrize(
    ("formula", "message"),
    [
        (f.Compare(t.Signal("d", "SV"), ">", t.number(0)), r"no signal d\(SV\)"),
        (f.Compare(t.Size("width", "SV"), ">", t.number(0)), r"no size width\(SV\)"),
        (f.Occupies("SV", "x1"), r"where occ\(SV, x1\) holds"),
        (f.Every("M", f.Domain("adjacent", "L"), ON_MAIN), r"every M in adjacent\(L\)"),
    ],
)
def test_what_the_batch_does_not_have_is_named(formula: Formula, message: str) -> None:
    monitor, batch = compile({"it": f.Or((IN_LANE, formula))}), replace(random_batch(1, 3, 4))
    batch = replace(batch, given={IN_LANE: batch.given[IN_LANE]})
    with pytest.raises(InputError, match=message):
        monitor.evaluate(batch)
    with pytest.raises(InputError, match=message):
        monitor.measure(batch)


@pytest.mark.parametrize(
    ("formula", "message"),
    [
        (f.Compare(S, ">", t.Parameter("rho")), "it: a monitor needs numbers, but rho"),
        (f.Compare(S, ">", t.Variable("v")), "but v has no value"),
        (f.Always(f.Interval(t.number(0), t.Parameter("minSafe")), FAST), "but minSafe has no value"),
        (f.Always(f.Interval(t.number(2), t.number(1)), FAST), "nor be empty"),
        (f.Always(f.Interval(t.number(-1), None), FAST), "start in the past"),
    ],
)
def test_open_formulas_are_refused(formula: Formula, message: str) -> None:
    with pytest.raises(InputError, match=message):
        compile({"it": formula})


def test_starts_and_cuts_must_lie_inside() -> None:
    batch = random_batch(1, 3, 4)
    monitor = compile({"it": FAST})
    with pytest.raises(InputError, match="inside each trace"):
        monitor.evaluate(batch, starts=batch.lengths)
    with pytest.raises(InputError, match="inside each trace"):
        monitor.measure(batch, starts=batch.lengths)
    with pytest.raises(InputError, match="cut to a length"):
        monitor.observe(batch).cut(batch.lengths + 1)
    with pytest.raises(InputError, match="same dt and lengths"):
        monitor.observe(replace(batch, dt=2 * DT), known=monitor.observe(batch))


def test_an_overflow_is_refused_inside_and_ignored_after_the_end() -> None:
    square = f.Compare(t.Power(S, 2), ">", t.number(4))
    values = np.array([[3.0, 1.0], [3.0, 1e200]])
    ended = Batch(DT, np.array([2, 1]), {("s", "SV"): values})
    assert compile({"it": square}).evaluate(ended).answers["it"].true.tolist() == [True, False]
    whole = Batch(DT, np.array([2, 2]), {("s", "SV"): values})
    for ask in (compile({"it": square}).evaluate, compile({"it": square}).measure):
        with pytest.raises(InputError, match=r"overflow .* traces 0 to 1.*magnitude of road traffic"):
            ask(whole)


@settings(max_examples=50, deadline=None, derandomize=True)
@given(st.integers(1, 200), st.integers(1, 9), st.integers(0, 1000))
def test_packing_is_undone_by_unpacking(traces: int, samples: int, seed: int) -> None:
    truth = np.random.default_rng(seed).random((samples, traces)) < 0.5
    words = boolean.pack(truth)
    assert words.shape == (samples, -(-traces // 64))
    assert (boolean.unpack(words, traces) == truth).all()
    trace = seed % traces
    bit = (words[:, trace // 64] >> np.uint64(trace % 64)) & np.uint64(1)
    assert (bit.astype(bool) == truth[:, trace]).all()


@pytest.mark.parametrize("block", [64, 128, 1024])
@pytest.mark.parametrize("threads", [1, 2])
def test_blocks_and_threads_change_nothing(block: int, threads: int, monkeypatch: pytest.MonkeyPatch) -> None:
    batch = random_batch(4, 300, 20)
    monitor = compile({"it": f.Eventually(interval(0, 3), FAST), "now": FAST})
    whole, margins = monitor.evaluate(batch), monitor.measure(batch, samples_in_block=10**6)
    monkeypatch.setattr(boolean, "_blocks", partial(boolean._blocks, samples_in_block=block))
    parts = monitor.evaluate(batch, threads=threads)
    part_margins = monitor.measure(batch, samples_in_block=block, threads=threads)
    for name in ("it", "now"):
        assert (parts.answers[name].true == whole.answers[name].true).all()
        assert (parts.answers[name].false == whole.answers[name].false).all()
        assert (part_margins.margins[name].low == margins.margins[name].low).all()
    assert whole.answers["it"].true.any()
    assert whole.answers["it"].false.any()


def test_every_sample_is_looked_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """In blocks that overlap the answer is the same, and the work grows with the square of the length."""
    batch = random_batch(4, 300, 20)
    looked = np.zeros((int(batch.lengths.max()), batch.traces), dtype=int)
    true_run = boolean.run

    def run(program: Bytecode, batch: Batch, rows: slice, columns: slice) -> list[Array]:
        looked[rows, columns] += 1
        return true_run(program, batch, rows, columns)

    monkeypatch.setattr(boolean, "run", run)
    monkeypatch.setattr(boolean, "_blocks", partial(boolean._blocks, samples_in_block=128))
    compile({"now": FAST}).evaluate(batch)
    assert looked.max() == 1


def test_single_precision_signals_are_widened_before_arithmetic() -> None:
    single = np.array([[16_777_216.0]], dtype=np.float32)
    formula = f.Compare(t.Sum((S, t.number(1))), ">", S)  # false in single precision
    found = compile({"it": formula}).evaluate(Batch(DT, np.array([1]), {("s", "SV"): single}))
    assert found.answers["it"].true.tolist() == [True]


def test_given_truth_is_found_whatever_its_definitions_are_called() -> None:
    named = f.Application("atLane", ("SV", "L"), IN_LANE)
    truth = np.array([[True, False]])
    for asked, known in ((named, IN_LANE), (IN_LANE, named), (f.Application("x", (), named), named)):
        batch = Batch(DT, np.array([1, 1]), given={known: truth})
        assert compile({"it": asked}).evaluate(batch).answers["it"].true.tolist() == [True, False]
        assert compile({"it": asked}).measure(batch).margins["it"].low.tolist() == [np.inf, -np.inf]


# --- ``true`` means true whatever comes after the trace, ``false`` means false: on traces that never end
# The continuations here become constant and stay so, which makes unbounded operators decidable: from the
# last change on, every formula keeps its value. The exact judge is asked the same on drives.


def endless(trace: SampledTrace) -> Definition:
    """The reading of a trace whose last sample lasts for ever."""
    reader = TraceReader(trace)
    return Definition(trace.length - 1, DT, lambda x, k: reader.holds(x, k, "clip"), trace.given)


def _continued(batch: Batch, seed: int) -> list[SampledTrace]:
    """Every trace of the batch with some more samples."""
    other = random_batch(seed, batch.traces, 6)
    made = []
    for i in range(batch.traces):
        head, tail = trace_of(batch, i), trace_of(other, i)
        given_truth = {x: [*head.given[x], *tail.given[x]] for x in head.given}
        signals = {x: [*head.signals[x], *tail.signals[x]] for x in head.signals}
        made.append(SampledTrace(DT, head.length + tail.length, signals, head.sizes, given_truth))
    return made


@settings(max_examples=some(300), deadline=None, derandomize=True)
@given(formulas, st.integers(0, 10**6))
def test_decided_answers_hold_for_every_continuation(formula: Formula, seed: int) -> None:
    batch = random_batch(seed, 4, 6)
    found = compile({"it": formula}).evaluate(batch).answers["it"]
    for other in range(3):
        for i, trace in enumerate(_continued(batch, seed + 1 + other)):
            holds = endless(trace).holds(formula)
            assert not (found.true[i] and not holds), trace
            assert not (found.false[i] and holds), trace


def test_endless_traces_refute_clipped_answers() -> None:
    """The property above can fail: answers of the other convention do not have it."""
    formula = f.Always(f.FOREVER, IN_LANE)
    batch = random_batch(3, 40, 2)
    found = compile({"it": formula}).evaluate(batch, "clip").answers["it"]
    truths = [endless(x).holds(formula) for x in _continued(batch, 7)]
    assert any(found.true[i] and not holds for i, holds in enumerate(truths))


def test_every_answer_occurs_and_undecided_is_needed() -> None:
    formula = f.Until(IN_LANE, f.Interval(t.number(0), t.number(4 * DT)), ON_MAIN)
    batch = random_batch(11, 200, 6)
    found = compile({"it": formula}).evaluate(batch).answers["it"]
    assert found.true.any()
    assert found.false.any()
    undecided = np.flatnonzero(found.undecided)
    both = {endless(_continued(batch, k)[i]).holds(formula) for k in range(20) for i in undecided[:5]}
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


@settings(max_examples=some(200), deadline=None, derandomize=True)
@given(
    acceleration_formulas,
    st.lists(st.tuples(*[st.integers(-1, 1)] * 4), min_size=1, max_size=6),
    st.integers(1, 10),
)
def test_decided_answers_are_those_of_the_judge(
    formula: Formula, accelerations: list[tuple[int, ...]], samples: int
) -> None:
    judge = pytest.importorskip("roadproof.semantics.exact.judging").judge
    holds = judge(formula, _drive(accelerations)).holds
    found = compile({"it": formula}).evaluate(_sampled(accelerations, samples)).answers["it"]
    assert not (found.true[0] and not holds)
    assert not (found.false[0] and holds)


@settings(max_examples=some(200), deadline=None, derandomize=True)
@given(acceleration_formulas, st.lists(st.tuples(*[st.integers(-1, 1)] * 4), min_size=1, max_size=6))
def test_bounded_formulas_inside_a_trace_are_decided_as_the_judge_does(
    formula: Formula, accelerations: list[tuple[int, ...]]
) -> None:
    judge = pytest.importorskip("roadproof.semantics.exact.judging").judge
    temporal = [x for x in subformulas(formula) if isinstance(x, f.Until | f.Eventually | f.Always)]
    assume(all(x.interval.high is not None for x in temporal))
    longest = 1 + sum(int(bounds_of(x.interval)[1] / DT) for x in temporal)  # type: ignore[operator]
    verdicts = compile({"it": formula}).evaluate(_sampled(accelerations, longest))
    clipped = compile({"it": formula}).evaluate(_sampled(accelerations, longest), "clip")
    holds = judge(formula, _drive(accelerations)).holds
    assert verdicts.answers["it"].true[0] == holds
    assert verdicts.answers["it"].false[0] == (not holds)
    assert clipped.answers["it"].true[0] == holds
