"""The monitor in Python says what the one in C and the recursive reading say, at every sample."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

import roadproof as rp
from examples import some
from extensions.exchange.streaming import c_programs
from extensions.exchange.streaming.random_formulas import random_formula
from extensions.traffic.monitoring.cases import DT, interval, random_batch, random_traffic, trace_of
from planting import plant
from roadproof.errors import InputError, UsageError
from roadproof.extensions.exchange.streaming import online
from roadproof.extensions.exchange.streaming.c_files import CSource, compile_c
from roadproof.extensions.exchange.streaming.interpreter import PlanState, _PlanStep
from roadproof.extensions.exchange.streaming.online import OnlineMonitor
from roadproof.extensions.exchange.streaming.plan import plan_of
from roadproof.extensions.traffic.evaluate.recursive import SampledTrace, TraceReader
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula
from roadproof.semantics.sampled import Batch

CODES = {"false": c_programs.FALSE, "undecided": c_programs.UNKNOWN, "true": c_programs.TRUE}


def monitors_of(source: CSource) -> dict[str, OnlineMonitor]:
    """The monitors in Python of the plans of those in C."""
    return {x.identifier: OnlineMonitor(x.told, x.plan, source.dt, source.fields) for x in source.monitors}


def replies(monitor: OnlineMonitor, samples: np.ndarray) -> np.ndarray:
    """What step and finish say at each sample, laid out as ``c_programs.answers`` has it."""
    monitor.reset()
    rows = np.full((len(samples), 2 + max(1, monitor.delay if monitor.about == "each sample" else 1)), 9)
    for row, values in zip(rows, samples, strict=True):
        try:
            step: str = monitor.step(dict(zip(samples.dtype.names or (), values.item(), strict=True)))
        except InputError:
            step = "undecided"
        rest = [CODES[x] for x in monitor.finish()]
        row[: 2 + len(rest)] = [CODES[step], len(rest), *rest]
    return rows


def parted(source: CSource, batch: Batch) -> Iterator[str]:
    """Where Python and the monitor of recordings part."""
    for (name, monitor), compiled in zip(monitors_of(source).items(), source.monitors, strict=True):
        found = np.full((batch.samples, 2 + compiled.rest, batch.traces), 99)
        for k in range(batch.traces):
            said = replies(monitor, c_programs.samples_of(source, batch, k))
            found[: len(said), :, k] = said
        yield from (f"{name}: {x}" for x in c_programs.parted(compiled, batch, found))


def random_source(seed: int, count: int) -> CSource:
    """Monitors of random formulas, without those that are refused."""
    rng, kept = np.random.default_rng(seed), dict[str, tuple[str, Formula]]()
    for k in range(count):
        formula = random_formula(rng, int(rng.integers(2, 6)))
        try:
            compile_c({"it": ("it", formula)}, DT, "monitor", 65_536)
        except InputError:
            continue
        kept[f"formula_{k}"] = (f"formula_{k}", formula)
    assert len(kept) > count / 2
    return compile_c(kept, DT, "monitor", 65_536)


@c_programs.needs_compiler
@pytest.mark.parametrize("seed", range(100, 100 + some(6, least=2)))
def test_c_and_python_say_the_same(seed: int, tmp_path: Path) -> None:
    source = random_source(seed, 20)
    program = c_programs.build(source, tmp_path)
    for longest, traces in ((4, 8), (24, 4)):
        batch = random_batch(seed, traces, longest)
        found = c_programs.said(source, program, batch)
        for name, monitor in monitors_of(source).items():
            for k in range(traces):
                samples = c_programs.samples_of(source, batch, k)
                assert np.array_equal(replies(monitor, samples), found[name][: len(samples), :, k]), name
        assert list(parted(source, batch)) == []


def judged(formula: Formula, trace: SampledTrace, sample: int) -> str:
    """The verdict of the recursive reading."""
    reading = TraceReader(trace)
    if reading.holds(formula, sample, "strong"):
        return "true"
    return "undecided" if reading.holds(formula, sample, "weak") else "false"


@pytest.mark.parametrize("seed", range(200, 200 + some(6, least=2)))
def test_verdicts_are_those_of_the_recursive_reading(seed: int) -> None:
    """On the whole trace each verdict that step gave stands, and finish says what is open."""
    source, batch = random_source(seed, 12), random_batch(seed, 4, 16)
    given = 0
    for monitor, compiled in zip(monitors_of(source).values(), source.monitors, strict=True):
        for k in range(batch.traces):
            monitor.reset()
            samples, trace = c_programs.samples_of(source, batch, k), trace_of(batch, k)
            steps = [monitor.step({x: row[x].item() for x in samples.dtype.names or ()}) for row in samples]
            if monitor.about == "the first sample":
                whole = judged(compiled.plan.formula, trace, 0)
                assert monitor.finish() == (whole,)
                assert {*steps} <= {"undecided", whole}
            else:
                about = [*steps[monitor.delay :], *monitor.finish()]
                assert about == [judged(compiled.plan.formula, trace, n) for n in range(trace.length)]
            given += len({*steps} - {"undecided"})
    assert given > 20


WIDTHS = (1, 3, 30)


def nested(widths: tuple[int, ...] = WIDTHS) -> CSource:
    """Bounded operators above and below operators without a bound, in both signs."""
    leaf = f.Compare(t.Signal("s", "SV"), ">", t.number(-1))
    other = f.Compare(t.Signal("s", "POV"), ">", t.number(0))
    made: dict[str, tuple[str, Formula]] = {}
    for width in widths:
        window, later = interval(0, width), interval(width, 0)
        below = f.Until(leaf, f.FOREVER, f.Not(other))
        formulas: dict[str, Formula] = {
            "until": f.Until(leaf, window, f.Not(leaf)),
            "reach": f.Until(leaf, window, other),
            "forever": below,
            "two": f.And(
                (
                    f.Eventually(window, f.Always(f.FOREVER, leaf)),
                    f.Until(leaf, f.FOREVER, f.Eventually(window, f.Always(f.FOREVER, other))),
                )
            ),
            "table": f.Until(leaf, window, f.And((other, below))),
            "late": f.And((leaf, f.Or((other, f.Eventually(later, f.Not(leaf)))))),
            "always": f.Always(window, f.Or((leaf, f.Always(f.FOREVER, other)))),
            "eventually": f.Eventually(interval(1, width), f.Not(f.Eventually(f.FOREVER, other))),
            "opposite": f.Not(f.Until(leaf, interval(2, width), f.Or((other, f.Always(f.FOREVER, leaf))))),
            "window": f.And((f.Always(window, leaf), f.Not(f.Eventually(window, f.Not(other))))),
        }
        made |= {f"{name}_{width}": (name, x) for name, x in formulas.items()}
    return compile_c(made, DT, "monitor", 1_000_000)


def rare_failures(seed: int, traces: int, longest: int) -> Batch:
    """Traces on which comparisons seldom change, each for itself."""
    batch, rng = random_batch(seed, traces, longest), np.random.default_rng(seed)
    signals = {x: np.where(rng.random((longest, traces)) < 0.9, 1.0, -1.5) for x in batch.signals}
    return Batch(DT, batch.lengths, signals, batch.sizes)


def test_nested_operators_of_many_widths() -> None:
    assert list(parted(nested(), rare_failures(7, 3, 60))) == []


def test_scenarios_on_traffic() -> None:
    home = rp.load("ext", params={"minSafe": "80 ms", "minDanger": "80 ms"})
    numbers = (1, 3, 4, 6)
    source = rp.compile([*numbers, "danger(SV,POV)"], using=home).source
    batch = random_traffic([home.read(n).formula for n in numbers], traces=12, longest=24)
    assert list(parted(source, batch)) == []


@pytest.mark.parametrize(
    ("owner", "name", "right", "wrong"),
    [
        (_PlanStep, "_bounded", "bool(operand) != universal", "bool(operand) == universal"),
        (_PlanStep, "_bounded", "left[k] = width + 1", "left[k] = width"),
        (_PlanStep, "_until", "min(self.state.waiting.get(k, 0), width)", "0"),
        (_PlanStep, "_until", "waiting if left and not met else 0", "0 if met else waiting"),
        (_PlanStep, "_forever", "(self._padded(operation.left, node) & later)", "later"),
        (_PlanStep, "_forever", "self.next[operation.variable], self.rows = value, None", "pass"),
        (_PlanStep, "_read", "if operand.lag and", "if False and"),
        (_PlanStep, "_padded", "self.ended > node.ready", "self.ended > 0"),
        (_PlanStep, "_end", "self.pad != node.opposite", "self.pad"),
        (_PlanStep, "_over", "self.ended - node.ready", "self.ended"),
        (_PlanStep, "_value", "met | (now & until)", "met | now"),
        (_PlanStep, "evaluate", "*map(self.rewrite, earlier[: node.kept])", "*earlier[: node.kept]"),
        (_PlanStep, "_forever", "= value, None", "= value, self.rows"),
        (_PlanStep, "rewrite", "(table >> now & 1) << row", "(table >> row & 1) << now"),
        (PlanState, "advance", "self.first = step.rewrite(self.first)", "pass"),
        (PlanState, "at_first", "self.plan.weak if weak else self.plan.strong", "self.plan.strong"),
        (OnlineMonitor, "step", "self._state.count <= self.delay", "self._state.count < self.delay"),
        (OnlineMonitor, "finish", "if value != weak:", "if value:"),
        (OnlineMonitor, "_observe", "seen[place] = bool(truth[0, 0])", "seen[0] = bool(truth[0, 0])"),
    ],
)  # fmt: skip
def test_planted_faults_are_noticed(
    monkeypatch: pytest.MonkeyPatch, owner: type, name: str, right: str, wrong: str
) -> None:
    plant(monkeypatch, owner, name, right, wrong)
    cases = ((nested((1, 3)), rare_failures(3, 12, 24)), (random_source(5, 12), random_batch(5, 6, 10)))
    assert any(True for source, batch in cases for _ in parted(source, batch))


def test_the_plan_is_that_of_the_monitor_in_c() -> None:
    made = rp.compile("danger(SV,POV)").source.monitors[0]
    monitor = rp.online_monitor("danger(SV,POV)")
    assert monitor._plan == made.plan
    assert (monitor.about, monitor.delay, monitor.samples) == ("each sample", 15, 0)
    assert online.OnlineMonitor is type(monitor)


# --- Samples -----------------------------------------------------------------------------------------


FAST = "v_lon(SV) > 10 m/s"


def test_a_verdict_stays_and_finish_changes_nothing() -> None:
    monitor = rp.online_monitor(f"F {FAST}", dt="100 ms")
    assert monitor.about == "the first sample"
    assert monitor.finish() == ("undecided",)
    assert [monitor.step({"v_lon_SV": v}) for v in (5, 20, 5)] == ["undecided", "true", "true"]
    assert (monitor.finish(), monitor.samples) == (("true",), 3)
    monitor.reset()
    assert (monitor.step({"v_lon_SV": 5}), monitor.samples) == ("undecided", 1)


@pytest.mark.parametrize(
    ("sample", "words"),
    [
        ({}, "the sample has no v_lon_SV"),
        ({"v_lon_SV": float("nan")}, "v_lon.SV. is nan"),
        ({"v_lon_SV": "fast"}, "v_lon.SV. is nan"),
        ({"v_lon_SV": 10**400}, "v_lon.SV. is nan"),
    ],
)
def test_after_a_wrong_sample_nothing_is_decided(sample: dict[str, float], words: str) -> None:
    monitor = rp.online_monitor(FAST)
    assert monitor.step({"v_lon_SV": 20}) == "true"
    with pytest.raises(InputError, match=words):
        monitor.step(sample)
    assert monitor.step({"v_lon_SV": 20}) == "undecided"
    monitor.reset()
    assert monitor.step({"v_lon_SV": 20}) == "true"


def test_flags_and_lanes_of_a_road() -> None:
    monitor = rp.online_monitor("atLane(SV,L)")
    (field,) = monitor.fields
    assert [monitor.step({field: x}) for x in (True, 0, 2)] == ["true", "false", "true"]
    with pytest.raises(InputError, match="True or False is needed"):
        monitor.step({field: float("nan")})
    bound = rp.online_monitor("atLane(SV,L)", road="main-2", lanes={"L": "main-1"})
    assert "d_SV" in bound.fields
    with pytest.raises(UsageError, match="which road"):
        rp.online_monitor("atLane(SV,L)", lanes={"L": "main-1"})


def test_refused_formulas() -> None:
    with pytest.raises(InputError, match="no multiple of the time step"):
        rp.online_monitor(f"G[0, 0.05] {FAST}")
    always = " and ".join(f"G F s(SV) > {k} m" for k in range(4))
    with pytest.raises(InputError, match="a streaming monitor takes at most 6"):
        rp.online_monitor(always)


def test_a_plan_takes_samples_after_the_longest_delay() -> None:
    formula = f.Eventually(interval(2, 3), f.Compare(t.Signal("s", "SV"), ">", t.number(0)))
    state = PlanState(plan_of(formula, DT, {}))
    assert [state.advance([x == 4]) for x in range(12)][5:] == [True, True, True, False, False, False, False]
