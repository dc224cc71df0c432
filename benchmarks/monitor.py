"""How fast the monitor is: 7 scenarios over 32,398 traces of 375 samples, and ratios in one run.

    python benchmarks/monitor.py [--traces N] [--samples N] [--threads N] [--json FILE] [--peers PYTHON]

The traces are random pairs of cars that follow, approach and pass each other, lengths all equal (the
worst case). Every sampled verdict and margin is compared with the plain recursive evaluator.
``--peers`` names the Python of an environment with rtamt and sentil; they get the truth of the state
atoms ready-made, one trace after another, and are timed on fewer traces, whose verdicts are compared with
the clip convention. Both sides have one thread there, and the best of ``--runs`` counts. The ratios are
for the whole batch, and for traces that come alone (a batch of one).
"""

import argparse
import json
import subprocess
import sys
import tempfile
from collections.abc import Callable, Mapping
from fractions import Fraction
from pathlib import Path
from time import perf_counter

import numpy as np

from roadproof.extensions.traffic.evaluate.recursive import SampledTrace, TraceReader, answer
from roadproof.library.bind import default_values
from roadproof.library.elaborate import apply_definition
from roadproof.library.loading import bundled_library
from roadproof.logic import formula as f
from roadproof.logic.formula import Application, Formula, subformulas
from roadproof.logic.rewrite import with_values, without_names
from roadproof.semantics.sampled import Batch, Monitor, compile
from roadproof.semantics.sampled.boolean import unpack
from roadproof.semantics.sampled.lattice import interval_steps

SCENARIOS = (1, 3, 4, 5, 6, 7, 8)
LANE_WIDTH = 3.5


def scenarios() -> dict[str, Formula]:
    """Scenarios 1, 3 … 8 of the base set with the default parameters, lanes open."""
    library = bundled_library()
    specification = library.select("base")
    values = default_values(library)
    return {
        f"scenario_{i}": with_values(apply_definition(specification, f"scenario_{i}").formula, values)
        for i in SCENARIOS
    }


def random_batch(formulas: dict[str, Formula], traces: int, samples: int, seed: int) -> Batch:
    """Pairs of cars on two lanes at 25 Hz with random accelerations and lane changes."""
    rng = np.random.default_rng(seed)
    time = np.arange(samples)[:, None] / 25
    signals = {}
    for vehicle, ahead in (("SV", 0.0), ("POV", 1.0)):
        v = rng.uniform(20, 35, traces)
        a = rng.normal(0, 0.5, traces)
        start = ahead * rng.uniform(-80, 80, traces)
        lane, target = rng.integers(0, 2, (2, traces))
        when = rng.uniform(0, samples / 25, traces)
        progress = np.clip((time - when) / 4, 0, 1)
        d = LANE_WIDTH * (lane + (target - lane) * progress) + rng.uniform(2.0, 3.3, traces)
        signals["s", vehicle] = start + v * time + a * time**2 / 2
        signals["v_lon", vehicle] = v + a * time
        signals["d", vehicle] = d
        signals["v_lat", vehicle] = np.gradient(d, 0.04, axis=0)
        signals["a_lon", vehicle] = np.broadcast_to(a, time.shape[:1] + a.shape).copy()
    sizes = {}
    for vehicle in ("SV", "POV"):
        sizes["length", vehicle] = rng.uniform(3.5, 6.0, traces)
        sizes["width", vehicle] = rng.uniform(1.7, 2.1, traces)
    in_lane = {
        (vehicle, lane): (signals["d", vehicle] > lane * LANE_WIDTH)
        & (signals["d", vehicle] - sizes["width", vehicle] < (lane + 1) * LANE_WIDTH)
        for vehicle in ("SV", "POV")
        for lane in (0, 1)
    }
    start_lane = in_lane["SV", 1][0]
    given = {}
    for formula in {x for root in formulas.values() for x in subformulas(root) if isinstance(x, Application)}:
        vehicle = formula.arguments[0] if formula.arguments else ""
        if formula.name == "onMainRoad":
            given[formula] = np.ones((samples, traces), dtype=bool)
        elif formula.name == "atLane":
            here, beside = in_lane[vehicle, 1], in_lane[vehicle, 0]
            own = np.where(start_lane, here, beside)
            given[formula] = own if formula.arguments[1] == "L" else np.where(start_lane, beside, here)
    # "some M in adjacentLanes(L)" has one member on two lanes
    for formula in {x for root in formulas.values() for x in subformulas(root)}:
        if isinstance(formula, f.Some) and formula.domain.kind == "adjacent":
            inner = formula.body
            assert isinstance(inner, Application)
            given[formula] = given[inner]
    lengths = np.full(traces, samples)
    return Batch(Fraction(1, 25), lengths, signals, sizes, given)


def trace_of(batch: Batch, index: int) -> SampledTrace:
    length = int(batch.lengths[index])
    return SampledTrace(
        batch.dt,
        length,
        {key: values[:length, index].tolist() for key, values in batch.signals.items()},
        {key: float(values[index]) for key, values in batch.sizes.items()},
        {formula: values[:length, index].tolist() for formula, values in batch.given.items()},
    )


def peer_text(formula: Formula, atoms: Mapping[Formula, int], dt: Fraction) -> str:
    """A formula without names as rtamt and sentil write it, over variables of 1 and -1."""

    def show(x: Formula) -> str:
        if x in atoms:
            return f"(a{atoms[x]} > 0)"
        match x:
            case f.Truth(value):
                return "(a0 > -2)" if value else "(a0 > 2)"
            case f.Not(body):
                return f"(not {show(body)})"
            case f.And(parts):
                return "(" + " and ".join(map(show, parts)) + ")"
            case f.Or(parts):
                return "(" + " or ".join(map(show, parts)) + ")"
            case f.Eventually(interval, body):
                return f"(eventually{bounds(interval)} {show(body)})"
            case f.Always(interval, body):
                return f"(always{bounds(interval)} {show(body)})"
            case f.Until(left, interval, right):
                return f"({show(left)} until{bounds(interval)} {show(right)})"
            case _:
                raise AssertionError(f"{x} has no text for peers")

    def bounds(interval: f.Interval) -> str:
        low, high = interval_steps(interval, dt)
        return "" if high is None else f"[{low},{high}]"

    return show(formula)


def alone(batch: Batch, index: int) -> Batch:
    """One trace of a batch as a batch of its own."""
    one = slice(index, index + 1)
    parts = (batch.signals, batch.sizes, batch.given)
    signals, sizes, given = ({key: values[..., one].copy() for key, values in x.items()} for x in parts)
    return Batch(batch.dt, batch.lengths[one], signals, sizes, given)


def compare_with_peers(
    monitor: Monitor, batch: Batch, python: str, traces: int, slow: int, runs: int
) -> dict[str, float]:
    """Seconds that each side takes for a trace with one thread, and how many verdicts differ from clip."""
    observation = monitor.observe(batch)
    leaves = {x: k for k, x in enumerate(observation.leaves)}
    truth = np.stack([unpack(words, batch.traces)[:, :traces] for words in observation.leaves.values()])
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "atoms.npz"
        np.savez(path, truth=truth, texts=[peer_text(x, leaves, batch.dt) for x in monitor.plain.values()])
        script = Path(__file__).with_name("monitor_peers.py")
        command = [python, script, path, str(slow), str(runs)]
        run = subprocess.run(command, check=True, capture_output=True, text=True)
    print(run.stderr, file=sys.stderr, end="")
    clipped = monitor.evaluate(observation, "clip").answers
    singles = [alone(batch, k) for k in range(slow)]
    in_batch = timed(lambda: monitor.evaluate(batch, "clip", threads=1), runs) / batch.traces
    by_itself = timed(lambda: [monitor.evaluate(x, "clip", threads=1) for x in singles], runs) / slow
    figures = {"trace_in_batch": in_batch, "trace_alone": by_itself}
    for name, answers in json.loads(run.stdout).items():
        ours = np.array([clipped[x].true[: len(answers["verdicts"])] for x in monitor.plain]).T
        figures[f"trace_{name}"] = answers["seconds"]
        figures[f"ratio_{name}_to_batch"] = answers["seconds"] / in_batch
        figures[f"ratio_{name}_to_alone"] = answers["seconds"] / by_itself
        figures[f"count_{name}_verdicts"] = ours.size
        figures[f"count_{name}_differing"] = int((ours != np.array(answers["verdicts"])).sum())
    return figures


def timed(what: Callable[[], object], repeat: int = 3) -> float:
    best = float("inf")
    for _ in range(repeat):
        start = perf_counter()
        what()
        best = min(best, perf_counter() - start)
    return best


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--traces", type=int, default=32_398)
    parser.add_argument("--samples", type=int, default=375)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--recursive", type=int, default=6, help="traces for the recursive evaluator")
    parser.add_argument("--json", type=Path)
    parser.add_argument("--peers", metavar="PYTHON", help="a Python that has rtamt and sentil")
    parser.add_argument("--rtamt", type=int, default=20, help="traces for rtamt")
    parser.add_argument("--runs", type=int, default=3, help="runs of each side with --peers")
    parser.add_argument("--sentil", type=int, default=1000, help="traces for sentil")
    options = parser.parse_args()

    formulas = scenarios()
    batch = random_batch(formulas, options.traces, options.samples, options.seed)
    start = perf_counter()
    monitor = compile(formulas)
    figures = {"compile": perf_counter() - start}
    figures["batch_checks"] = timed(
        lambda: Batch(batch.dt, batch.lengths, batch.signals, batch.sizes, batch.given)
    )
    figures["observe"] = timed(lambda: monitor.observe(batch, threads=options.threads))
    observation = monitor.observe(batch, threads=options.threads)
    figures["boolean_after_packing"] = timed(lambda: monitor.evaluate(observation))
    figures["boolean"] = timed(lambda: monitor.evaluate(batch, threads=options.threads))
    figures["boolean_clip"] = timed(lambda: monitor.evaluate(batch, "clip", threads=options.threads))
    figures["robustness_clip"] = timed(lambda: monitor.measure(batch, "clip", threads=options.threads), 2)
    figures["robustness"] = timed(lambda: monitor.measure(batch, threads=options.threads), 2)

    verdicts = monitor.evaluate(batch, threads=options.threads)
    margins = monitor.measure(batch, threads=options.threads)
    chosen = np.random.default_rng(options.seed).choice(options.traces, options.recursive, replace=False)
    start = perf_counter()
    expected = [[answer(x, trace_of(batch, i)) for x in formulas.values()] for i in chosen]
    per_trace = (perf_counter() - start) / options.recursive
    figures["recursive_scaled"] = per_trace * options.traces
    for i, answers in zip(chosen, expected, strict=True):
        reading = TraceReader(trace_of(batch, i))
        for (name, formula), wanted in zip(formulas.items(), answers, strict=True):
            found = verdicts.answers[name]
            got = "true" if found.true[i] else "false" if found.false[i] else "undecided"
            low = reading.margin(without_names(formula), 0, "strong")
            if got != wanted or low != margins.margins[name].low[i]:
                print(f"trace {i}, {name}: {got} where {wanted} was expected", file=sys.stderr)
                return 30
    figures["ratio_recursive_to_boolean"] = figures["recursive_scaled"] / figures["boolean"]
    if options.peers:
        figures |= compare_with_peers(
            monitor, batch, options.peers, options.sentil, options.rtamt, options.runs
        )
    for name, value in figures.items():
        print(f"{name:28s} {value:12.6f}{'' if name.startswith(('ratio', 'count')) else ' s'}")
    for name, found in verdicts.answers.items():
        print(
            f"{name}: {found.true.sum()} true, {found.false.sum()} false, {found.undecided.sum()} undecided"
        )
    if options.json:
        options.json.write_text(json.dumps(figures, indent=2) + "\n")
    slow = figures["boolean"] > 0.6 or figures["robustness_clip"] > 3
    print("targets: Boolean 0.6 s, robustness 3 s:", "missed" if slow else "met")
    return 10 if slow else 0


if __name__ == "__main__":
    sys.exit(main())
