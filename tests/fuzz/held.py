"""One formula and one trace, all readers: the judge, both monitors, the circuit, and the printed text.

The trace is held between samples, so all must say the same (``definition``); the monitors see only its
samples and may leave open what comes after them.
"""

import random
from fractions import Fraction
from functools import cache

import numpy as np
from hypothesis import strategies as st

from fuzz.case import Disagreement
from fuzz.definition import DT, Held, definition_of
from logic.test_show import canonical
from roadproof.engines.encode.problem import evaluate
from roadproof.engines.encode.unroll import Grid, unroll
from roadproof.extensions.traffic.evaluate.recursive import SampledTrace, TraceReader
from roadproof.library.bind import bind, default_values
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.library.specification import Specification
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula
from roadproof.logic.restore import as_syntax
from roadproof.logic.show import text
from roadproof.semantics.exact import judge
from roadproof.semantics.exact.signals import AbstractSignals
from roadproof.semantics.sampled import Batch, compile
from roadproof.world.models import load_road

METRES, SPEED, ACCELERATION, SECONDS, PLAIN = (1, 0), (1, -1), (1, -2), (0, 1), (0, 0)
TRACES = 40  # for each formula
MARGINS = 8  # of them, compared with the recursive margin, which is slow
PARAMETERS = {
    "rho": Fraction(1, 2),
    "a_max": Fraction(4),
    "b_min": Fraction(2),
    "b_max": Fraction(4),
    "a_max_lat": Fraction(1),
    "b_min_lat": Fraction(2),
    "minSafe": Fraction(1, 2),
    "minDanger": Fraction(1),
}
"""Powers of two, so that the monitors' floating-point numbers are exact."""

CALLS = (
    *("aheadOf(SV,POV)", "fasterThan(POV,SV)", "sameLane(SV,POV,L)", "inAdjLanes(SV,POV,L)"),
    *("rssViolation(SV,POV)", "danger(POV,SV)", "initSafe(SV,POV)", "dangerArises(SV,POV)"),
    *("leavingLane(POV,L)", "cutIn(POV,SV,L)", "cutOut(POV,SV,L)", "decelerates(POV)"),
    *(f"scenario_{i}(SV,POV,L)" for i in (1, 3, 4, 5, 6, 7, 8, 12)),
)


@cache
def specification() -> Specification:
    return bundled_library().select("ext")


@cache
def _called(words: str) -> Formula:
    return read_claim(specification(), words).formula


_vehicles = st.sampled_from(["SV", "POV"])
_halves = st.integers(-6, 14).map(lambda n: Fraction(n, 2))


@cache
def _leaves(dimension: t.Dimension) -> st.SearchStrategy[t.Term]:
    names = [n for n, d in t.SIGNAL_DIMENSIONS.items() if d == dimension]
    found: list[st.SearchStrategy[t.Term]] = [
        st.builds(t.Signal, st.sampled_from(names), _vehicles),
        st.builds(t.Number, _halves, st.just(dimension)),
    ]
    if dimension == METRES:
        found.append(st.builds(t.Size, st.sampled_from(["length", "width"]), _vehicles))
    return st.one_of(found)


@cache
def terms(dimension: t.Dimension, deep: int = 2) -> st.SearchStrategy[t.Term]:
    """Terms without rounding: halves, multiplied by halves and divided by powers of two."""
    if not deep:
        return _leaves(dimension)
    inner = terms(dimension, deep - 1)
    found = [
        _leaves(dimension),
        _leaves(dimension),
        st.builds(lambda x, y: t.Sum((x, y)), inner, inner),
        st.builds(t.subtract, inner, inner),
        st.builds(lambda n, x: t.Product((t.number(n), x)), _halves, inner),
        st.builds(t.Quotient, inner, st.sampled_from([t.number(2), t.number(4)])),
        st.builds(lambda x, y: t.Maximum((x, y)), inner, inner),
        st.builds(lambda x, y: t.Minimum((x, y)), inner, inner),
    ]
    if dimension == METRES:
        square = st.builds(lambda v: t.Power(v, 2), terms(SPEED, 0))
        found.append(st.builds(t.Quotient, square, st.just(t.Number(Fraction(4), ACCELERATION))))
        found.append(st.builds(lambda v: t.Product((v, t.Number(DT, SECONDS))), terms(SPEED, 0)))
    return st.one_of(found)


_operators = st.sampled_from(["<", "<=", ">", ">="])
_comparisons = st.one_of(
    st.builds(f.Compare, sides, _operators, sides)
    for d in (METRES, SPEED, ACCELERATION)
    for sides in (terms(d, 2), _leaves(d), terms(d, 1).map(t.Inverse))
)


@st.composite
def intervals(draw: st.DrawFn) -> f.Interval:
    if draw(st.integers(0, 3)) == 0:
        return f.Interval(f.ZERO, t.Parameter("minDanger", SECONDS))
    low, width = draw(st.integers(0, 3)), draw(st.none() | st.integers(0, 4))
    if width is None and low == 0:
        return f.FOREVER
    high = None if width is None else t.Number((low + width) * DT, SECONDS)
    return f.Interval(t.Number(low * DT, SECONDS), high)


formulas = st.recursive(
    st.one_of(_comparisons, _comparisons, st.sampled_from(CALLS).map(_called)),
    lambda inner: st.one_of(
        inner.map(f.negation),
        st.lists(inner, min_size=2, max_size=3).map(lambda parts: f.And(tuple(parts))),
        st.lists(inner, min_size=2, max_size=3).map(lambda parts: f.Or(tuple(parts))),
        st.builds(f.Eventually, intervals(), inner),
        st.builds(f.Always, intervals(), inner),
        st.builds(f.Until, inner, intervals(), inner),
    ),
    max_leaves=6,
)


def random_trace(seed: int) -> Held:
    """Both vehicles near each other, each signal mostly as it was, lanes and distances often on the edge."""
    rng = random.Random(seed)
    samples = rng.randint(1, 9)
    halves = {n: Fraction(n, 2) for n in range(-8, 21)}

    def course(low: int, high: int) -> tuple[Fraction, ...]:
        values = [halves[rng.randint(low, high)]]
        while len(values) < samples:
            values.append(values[-1] if rng.random() < 0.6 else halves[rng.randint(low, high)])
        return tuple(values)

    ranges = {
        "s": (-8, 20),
        "d": (1, 15),
        "v_lon": (0, 8),
        "v_lat": (-2, 2),
        "a_lon": (-4, 4),
        "a_lat": (-2, 2),
    }
    signals = {f"{name}({x})": course(*ends) for x in ("SV", "POV") for name, ends in ranges.items()}
    sizes = {f"length({x})": Fraction(rng.randint(2, 9), 2) for x in ("SV", "POV")}
    return Held(signals, sizes | {f"width({x})": Fraction(rng.randint(2, 4), 2) for x in ("SV", "POV")})


cases = st.builds(
    lambda formula, seed: (formula, [plain(random_trace(TRACES * seed + i)) for i in range(TRACES)]),
    formulas,
    st.integers(0, 10**9),
)
"""(formula, traces as plain data)."""


def plain(trace: Held) -> tuple[dict[str, tuple[Fraction, ...]], dict[str, Fraction]]:
    return dict(trace.signals), dict(trace.sizes)


def check(case: tuple[Formula, list[tuple[dict[str, tuple[Fraction, ...]], dict[str, Fraction]]]]) -> int:
    """How many traces were judged alike by all. Raises ``Disagreement`` with one of them."""
    formula, given = case
    read = read_back(formula)
    if canonical(read, keep_names=True) != canonical(formula, keep_names=True):
        raise Disagreement(f"read back from its text as {text(as_syntax(read))}", (formula, []))
    bound = bound_to_the_road(read)
    traces = [Held(*data) for data in given]
    answers = [definition_of(trace).holds(bound, 0) for trace in traces]
    for complaints in (judged, unrolled, monitored):
        for i, complaint in complaints(bound, traces, answers):
            raise Disagreement(f"{complaint}; by definition {answers[i]}", (formula, [given[i]]))
    return len(traces)


def read_back(formula: Formula) -> Formula:
    return read_claim(specification(), text(as_syntax(formula))).formula


def bound_to_the_road(formula: Formula) -> Formula:
    values = default_values(specification().library) | PARAMETERS
    return bind(formula, load_road("main-2"), {"L": "main-1"}, values)


def judged(formula: Formula, traces: list[Held], answers: list[bool]):
    for i, trace in enumerate(traces):
        if judge(formula, abstract(trace)).holds != answers[i]:
            yield i, "the judge says otherwise"


def unrolled(formula: Formula, traces: list[Held], answers: list[bool]):
    for i, trace in enumerate(traces):
        definition = definition_of(trace)
        circuit = unroll(formula, Grid(DT, definition.last))
        if (
            evaluate(circuit, lambda at, definition=definition: definition.holds(at.atom, at.step))
            != answers[i]
        ):
            yield i, "the circuit says otherwise"


def monitored(formula: Formula, traces: list[Held], answers: list[bool]):
    monitor = compile({"it": formula})
    batch = _batch(traces)
    truth = monitor.evaluate(batch).answers["it"]
    clipped = monitor.evaluate(batch, "clip").answers["it"]
    margin = monitor.measure(batch).margins["it"]
    for i, trace in enumerate(traces):
        reading = TraceReader(_recorded(trace))
        if truth.true[i] and not answers[i]:
            yield i, "the monitor says true for every continuation"
        if truth.false[i] and answers[i]:
            yield i, "the monitor says false for every continuation"
        if margin.low[i] > 0 and not truth.true[i]:
            yield i, "a margin above zero, and the monitor does not say true"
        if margin.high[i] < 0 and not truth.false[i]:
            yield i, "a margin below zero, and the monitor does not say false"
        slow = (reading.holds(formula, 0, "strong"), not reading.holds(formula, 0, "weak"))
        if (bool(truth.true[i]), bool(truth.false[i])) != slow:
            yield i, f"the recursive reading says {slow}, the monitor not"
        if bool(clipped.true[i]) != reading.holds(formula, 0, "clip"):
            yield i, "the readings differ on the clipped trace"
        if i >= MARGINS:
            continue
        ends = (reading.margin(formula, 0, "strong"), reading.margin(formula, 0, "weak"))
        if (margin.low[i], margin.high[i]) != ends:
            yield i, f"the recursive margin is {ends}, the monitor's {margin.low[i], margin.high[i]}"


def abstract(trace: Held) -> AbstractSignals:
    times = [k * DT for k in range(trace.samples)]
    signals = {
        _signal(name): tuple(zip(times, values, strict=True)) for name, values in trace.signals.items()
    }
    sizes = {t.Size(*_split(name)): value for name, value in trace.sizes.items()}
    return AbstractSignals(signals, sizes)


def _split(name: str) -> tuple:
    head, _, rest = name.partition("(")
    return head, rest.removesuffix(")")


def _signal(name: str) -> t.Signal:
    return t.Signal(*_split(name))


def _recorded(trace: Held) -> SampledTrace:
    signals = {_split(name): [float(v) for v in values] for name, values in trace.signals.items()}
    return SampledTrace(DT, trace.samples, signals, {_split(n): float(v) for n, v in trace.sizes.items()})


def _batch(traces: list[Held]) -> Batch:
    lengths = np.array([trace.samples for trace in traces])
    longest = int(lengths.max())

    def column(values: tuple[Fraction, ...]) -> list[float]:
        return [float(v) for v in values] + [float("nan")] * (longest - len(values))

    signals = {
        _split(name): np.array([column(trace.signals[name]) for trace in traces]).T
        for name in traces[0].signals
    }
    sizes = {_split(name): np.array([float(x.sizes[name]) for x in traces]) for name in traces[0].sizes}
    return Batch(DT, lengths, signals, sizes)
