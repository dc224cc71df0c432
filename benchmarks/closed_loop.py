"""Failures of controllers: simulations a second, and simulations to the first one that a driver prevents.

Run: ``PYTHONPATH=tests:examples/closed-loop .venv/bin/python benchmarks/closed_loop.py [--seeds 20]
[--budget 600]``. Ten problems, each searched by CMA-ES as in ``falsify``, by uniform sampling, and by the
dual annealing of PSY-TaLiRo where psy-taliro is installed. All have the same knobs, the same cost and the
same exact judgement of each failure.
"""

import argparse
import statistics
import time
from collections.abc import Callable
from contextlib import suppress
from typing import Any

import aeb
import careful
import follow
import numpy as np

from extensions.closed_loop.loops import problem
from roadproof.extensions.closed_loop.search.problem import TargetProblem
from roadproof.extensions.closed_loop.search.searching import FailureSearchOutcome, Searching, _SearchState
from roadproof.extensions.closed_loop.simulation import ControlLoop

PATIENCE = 60.0
NEVER = 10**6


class TunedAeb(aeb.Aeb):
    """An AEB that brakes ``late`` s after a braking of ``threshold`` m/s^2 is needed."""

    def __init__(self, late: float, threshold: float) -> None:
        self.late, self.threshold = late, threshold

    def step(self, observation: Any, dt: float) -> float:
        me = observation.me
        needs = (aeb.needed(me, x) for x in observation.others if aeb.comes(me, x))
        if self.since is None and any(x > self.threshold for x in needs):
            self.since = observation.time
        brakes = self.since is not None and observation.time >= self.since + self.late - 1e-9
        return -9.0 if brakes else 0.0


PROBLEMS: tuple[tuple[str, int, Callable[[], Any]], ...] = (
    ("AEB, 0.2 s late, 6.5 m/s^2", 1, lambda: TunedAeb(0.2, 6.5)),
    ("AEB, 0.4 s late, 5 m/s^2", 1, lambda: TunedAeb(0.4, 5)),
    ("AEB, 0.3 s late, 5.5 m/s^2", 4, lambda: TunedAeb(0.3, 5.5)),
    ("AEB, 0.4 s late, 5 m/s^2", 4, lambda: TunedAeb(0.4, 5)),
    ("AEB, 0.4 s late, 5 m/s^2", 2, lambda: TunedAeb(0.4, 5)),
    ("IDM", 1, follow.Idm),
    ("IDM", 4, follow.Idm),
    ("ACC, 0.5 s late", 1, follow.DelayedAcc),
    ("ACC, 0.5 s late", 4, follow.DelayedAcc),
    ("careful driver at 10 Hz", 1, careful.Careful),
)
"""Name, scenario and controller of each problem."""


def cma(state: _SearchState, budget: int, seed: int) -> None:
    """Search as ``falsify`` does."""
    state.search()


def uniform(state: _SearchState, budget: int, seed: int) -> None:
    """Sample the knobs uniformly."""
    random = np.random.default_rng(seed)
    while not state._is_over:
        state._evaluate(random.random((32, len(state.low))))


def annealing(state: _SearchState, budget: int, seed: int) -> None:
    """Search by PSY-TaLiRo's dual annealing, with its defaults."""
    from staliro.optimizers import DualAnnealing, Optimizer
    from staliro.signals import Interval

    class Over(Exception):
        pass

    class Cost:
        def eval_sample(self, sample: Any) -> float:
            costs = state._evaluate(np.array([np.clip(sample.values, 0, 1)]))
            if state._is_over or not costs:
                raise Over
            return costs[0]

    bounds = [Interval(0.0, 1.0)] * len(state.low)
    with suppress(Over):
        DualAnnealing().optimize(Cost(), Optimizer.Params(seed=seed, budget=budget, input_bounds=bounds))


METHODS: dict[str, Callable[[_SearchState, int, int], None]] = {
    "CMA-ES": cma,
    "uniform": uniform,
    "PSY-TaLiRo": annealing,
}


def simulations_to_failure(method: str, one: TargetProblem, controller: Any, budget: int, seed: int) -> int:
    """Return the simulations up to the first failure that a driver prevents; ``NEVER`` beyond the budget."""
    outcome = FailureSearchOutcome()
    kind = "cma" if method == "CMA-ES" else "random"
    searching = Searching(one, budget, seed, kind, "preventable")
    METHODS[method](_SearchState(searching, ControlLoop(controller, PATIENCE), outcome), budget, seed)
    return outcome.first_preventable or NEVER


def simulations_a_second(one: TargetProblem, controller: Any, count: int = 2000) -> float:
    """Return the simulations of 100 steps a second of the processor, without judgements and costs."""
    random, knobs = np.random.default_rng(0), one.shape.knobs
    low, wide = np.array([x.low for x in knobs]), np.array([x.high - x.low for x in knobs])
    values = [tuple(low + wide * random.random(len(knobs))) for _ in range(count)]
    loop, begin = ControlLoop(controller, PATIENCE), time.process_time()
    for k in range(0, count, 32):
        one.run(loop, values[k : k + 32])
    return count / (time.process_time() - begin)


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--budget", type=int, default=600)
    args = parser.parse_args()
    try:
        import staliro  # noqa: F401
    except ImportError:
        del METHODS["PSY-TaLiRo"]
        print("psy-taliro is not installed: its dual annealing is left out")
    print(
        f"median of {args.seeds} seeds, in brackets how many of them found one in {args.budget} simulations"
    )
    print(f"{'controller':<28}scenario  simulations/s  {'  '.join(f'{x:>14}' for x in METHODS)}")
    best = dict.fromkeys(METHODS, 0)
    for name, number, make in PROBLEMS:
        one = problem(number, wanted="preventable")
        speed = simulations_a_second(one, make())
        medians: dict[str, float] = {}
        cells: list[str] = []
        for method in METHODS:
            counts = [
                simulations_to_failure(method, one, make(), args.budget, seed) for seed in range(args.seeds)
            ]
            medians[method] = statistics.median(counts)
            text = "none" if medians[method] >= NEVER else f"{medians[method]:g}"
            cells.append(f"{text + f' ({sum(x < NEVER for x in counts)})':>14}")
        least = min(medians.values())
        if least < NEVER:
            for method, median in medians.items():
                best[method] += median == least
        print(f"{name:<28}{number:>8}  {speed:>13.0f}  {'  '.join(cells)}", flush=True)
    print("fewest simulations:", ", ".join(f"{method} {count}" for method, count in best.items()))


if __name__ == "__main__":
    main()
