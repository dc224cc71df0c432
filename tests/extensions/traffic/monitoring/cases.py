"""Random formulas and ragged batches, and what the recursive reading says of them."""

from collections.abc import Iterator, Sequence
from fractions import Fraction

import numpy as np
from hypothesis import strategies as st

from roadproof.extensions.traffic.evaluate.recursive import SampledTrace, TraceReader
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Application, Formula, subformulas
from roadproof.semantics.sampled import Batch, Monitor, compile
from roadproof.semantics.sampled.answers import Convention

DT = Fraction(1, 25)
IN_LANE = f.Some("l", f.Domain("lanelets", "L"), f.Occupies("SV", "l"))
ON_MAIN = f.Occupies("POV", "main-1a")
SIGNALS: tuple[tuple[t.SignalName, str], ...] = (
    ("s", "SV"),
    ("s", "POV"),
    ("v_lon", "SV"),
    ("v_lon", "POV"),
)


def seconds(steps: int) -> t.Term:
    return t.number(steps * DT, (0, 1))


def interval(low: int, width: int | None) -> f.Interval:
    return f.Interval(seconds(low), None if width is None else seconds(low + width))


intervals = st.builds(
    interval, st.integers(0, 4), st.one_of(st.none(), st.integers(0, 3), st.integers(4, 14))
)
leaves = st.one_of(
    st.sampled_from([t.Signal(name, vehicle) for name, vehicle in SIGNALS]),
    st.sampled_from([t.Size("length", "SV"), t.number(0), t.number(1), t.number(Fraction(1, 3))]),
)


def _larger_terms(inner: st.SearchStrategy[t.Term]) -> st.SearchStrategy[t.Term]:
    some = st.lists(inner, min_size=1, max_size=3).map(tuple)
    return st.one_of(
        st.builds(t.Sum, some),
        st.builds(t.subtract, inner, inner),
        st.builds(t.Product, some),
        st.builds(t.Maximum, some),
        st.builds(t.Minimum, some),
        st.builds(t.Power, inner, st.integers(0, 3)),
        st.builds(t.Quotient, inner, st.sampled_from([t.number(3), t.Size("length", "SV")])),
    )


terms = st.recursive(leaves, _larger_terms, max_leaves=5)
sides = st.one_of(leaves, terms, st.builds(t.Inverse, terms))
comparisons = st.builds(f.Compare, sides, st.sampled_from(["<", "<=", ">", ">="]), sides)
states = st.one_of(st.sampled_from([IN_LANE, ON_MAIN]), comparisons, st.sampled_from([f.TRUE, f.FALSE]))


def _larger_formulas(inner: st.SearchStrategy[Formula]) -> st.SearchStrategy[Formula]:
    some = st.lists(inner, min_size=1, max_size=3).map(tuple)
    return st.one_of(
        st.builds(f.Not, inner),
        st.builds(f.And, some),
        st.builds(f.Or, some),
        st.builds(f.Eventually, intervals, inner),
        st.builds(f.Always, intervals, inner),
        st.builds(f.Until, inner, intervals, inner),
        st.builds(f.Since, inner, intervals, inner),
        st.builds(f.once, intervals, inner),
        st.builds(f.historically, intervals, inner),
        st.builds(f.Application, st.sampled_from("pq"), st.just(("SV", "L")), inner),
    )


formulas = st.recursive(states, _larger_formulas, max_leaves=7)


def random_batch(seed: int, traces: int, longest: int, ties: bool = True) -> Batch:
    """Small numbers, so that comparisons meet their boundaries; rubbish after the end of each trace."""
    rng = np.random.default_rng(seed)
    lengths = rng.integers(1, longest + 1, traces)
    after = np.arange(longest)[:, None] >= lengths[None, :]
    signals = {}
    for key in SIGNALS:
        values = rng.integers(-2, 3, (longest, traces)) / 2 if ties else rng.normal(size=(longest, traces))
        values = np.asarray(values, dtype=np.float64)
        values[after] = rng.choice([np.nan, np.inf, 1e300, 0.5], after.sum())
        signals[key] = values
    sizes: dict[tuple[t.SizeName, str], np.ndarray] = {("length", "SV"): rng.integers(1, 4, traces) / 2}
    given: dict[Formula, np.ndarray] = {
        x: rng.random((longest, traces)) < 0.5
        for x in (IN_LANE, f.Application("onMainRoad", ("POV",), ON_MAIN))
    }
    return Batch(DT, lengths, signals, sizes, given)


def trace_of(batch: Batch, index: int, start: int = 0, end: int | None = None) -> SampledTrace:
    """One trace of a batch from a sample on, without what follows its end."""
    rows = slice(start, int(batch.lengths[index]) if end is None else end)
    return SampledTrace(
        batch.dt,
        rows.stop - start,
        {key: values[rows, index].tolist() for key, values in batch.signals.items()},
        {key: float(values[index]) for key, values in batch.sizes.items()},
        {formula: values[rows, index].tolist() for formula, values in batch.given.items()},
    )


def boolean_differences(formula: Formula, batch: Batch, convention: Convention) -> Iterator[str]:
    """Where the monitor and the recursive reading part, at any sample of any trace."""
    monitor: Monitor = compile({"it": formula})
    found = monitor.evaluate(batch, convention, at="all").answers["it"]
    at_start = monitor.evaluate(batch, convention).answers["it"]
    for i in range(batch.traces):
        reading = TraceReader(trace_of(batch, i))
        for k in range(int(batch.lengths[i])):
            true = reading.holds(formula, k, "clip" if convention == "clip" else "strong")
            false = not reading.holds(formula, k, "clip" if convention == "clip" else "weak")
            if (bool(found.true[k, i]), bool(found.false[k, i])) != (true, false):
                yield f"trace {i}, sample {k}: ({true}, {false}) expected"
            if k == 0 and (bool(at_start.true[i]), bool(at_start.false[i])) != (true, false):
                yield f"trace {i} at its start: ({true}, {false}) expected"


def margin_differences(formula: Formula, batch: Batch, convention: Convention) -> Iterator[str]:
    """The same for margins, to the last bit."""
    monitor = compile({"it": formula})
    found = monitor.measure(batch, convention, at="all", samples_in_block=50).margins["it"]
    at_start = monitor.measure(batch, convention).margins["it"]
    for i in range(batch.traces):
        reading = TraceReader(trace_of(batch, i))
        for k in range(int(batch.lengths[i])):
            low = reading.margin(formula, k, "clip" if convention == "clip" else "strong")
            high = reading.margin(formula, k, "clip" if convention == "clip" else "weak")
            if (found.low[k, i], found.high[k, i]) != (low, high):
                yield f"trace {i}, sample {k}: {(found.low[k, i], found.high[k, i])} for {(low, high)}"
            if k == 0 and (at_start.low[i], at_start.high[i]) != (low, high):
                yield f"trace {i} at its start: {(low, high)} expected"


def random_traffic(
    roots: Sequence[Formula], traces: int, longest: int, seed: int = 6, noise: float = 0.1
) -> Batch:
    """Cars that are safe at first and close in; lane predicates flicker at random; ``noise`` in m/s."""
    rng = np.random.default_rng(seed)
    time = np.arange(longest)[:, None] / 25
    lengths = rng.integers(longest // 2, longest + 1, traces)
    signals = {}
    for vehicle, start, v in (("SV", 0.0, 22.0), ("POV", rng.uniform(59, 67, traces), 14.0)):
        signals["s", vehicle] = start + v * time + np.zeros(traces)
        signals["d", vehicle] = rng.uniform(1, 3, traces) + np.zeros_like(time)
        signals["v_lon", vehicle] = v + rng.normal(0, noise, (longest, traces))
        signals["v_lat", vehicle] = rng.normal(0, 0.1, (longest, traces))
        signals["a_lon", vehicle] = rng.normal(0, 1, (longest, traces))
    sizes = {(name, x): rng.uniform(2, 5, traces) for name in ("length", "width") for x in ("SV", "POV")}
    given = {}
    for node in dict.fromkeys(x for root in roots for x in subformulas(root)):  # the same in every run
        if isinstance(node, Application) and node.name in ("atLane", "onMainRoad"):
            given[node] = rng.random((longest, traces)) < 0.95
        elif isinstance(node, f.Some) and node.domain.kind == "adjacent":
            given[node] = rng.random((longest, traces)) < 0.5
    return Batch(Fraction(1, 25), lengths, signals, sizes, given)
