"""The same formulas on the same traces in rtamt and sentil; run by ``monitor.py --peers PYTHON``.

Needs neither roadproof nor anything but numpy and the peers, so that they may live in a virtual
environment of their own. Reads an .npz with the truth of the state atoms (atom, time, trace) and the
formulas as text over variables a0, a1, … that are 1 for true and -1 for false; one time unit is one
step. Prints JSON: for each peer seconds a trace, the best of some runs, and one verdict for each trace and
formula.
"""

import json
import sys
from collections.abc import Callable
from importlib import import_module
from time import perf_counter
from typing import Any

import numpy as np

Evaluate = Callable[[dict[str, list[float]]], list[float]]


def rtamt_evaluator(texts: list[str], atoms: int) -> Evaluate:
    rtamt = import_module("rtamt")
    specifications = []
    for text in texts:
        specification = rtamt.StlDiscreteTimeOfflineSpecification()
        for k in range(atoms):
            specification.declare_var(f"a{k}", "float")
        specification.spec = text
        specification.parse()
        specifications.append(specification)

    def evaluate(signals: dict[str, list[float]]) -> list[float]:
        time = list(range(len(signals["a0"])))
        return [s.evaluate({"time": time, **signals})[0][1] for s in specifications]

    return evaluate


def sentil_evaluator(texts: list[str], atoms: int) -> Evaluate:
    sentil = import_module("sentil")
    bank = sentil.FormulaBank()
    for number, text in enumerate(texts):
        bank.add(str(number), text)

    def evaluate(signals: dict[str, list[float]]) -> list[float]:
        found = bank.robustness(sentil.Trace(list(range(len(signals["a0"]))), signals))
        return [found[str(number)] for number in range(len(texts))]

    return evaluate


def main() -> None:
    with np.load(sys.argv[1]) as data:
        texts, truth = [str(x) for x in data["texts"]], data["truth"]
    counts = {"rtamt": int(sys.argv[2]), "sentil": truth.shape[2]}
    answers: dict[str, Any] = {}
    for name, make in (("rtamt", rtamt_evaluator), ("sentil", sentil_evaluator)):
        try:
            evaluate = make(texts, len(truth))
        except ImportError as error:
            print(f"{name} is left out: {error}", file=sys.stderr)
            continue
        signals = [
            {f"a{k}": np.where(atom[:, i], 1.0, -1.0).tolist() for k, atom in enumerate(truth)}
            for i in range(min(counts[name], truth.shape[2]))
        ]
        seconds = []
        for _ in range(int(sys.argv[3])):
            start = perf_counter()
            verdicts = [[value > 0 for value in evaluate(one)] for one in signals]
            seconds.append((perf_counter() - start) / len(signals))
        answers[name] = {"seconds": min(seconds), "verdicts": verdicts}
    print(json.dumps(answers))


if __name__ == "__main__":
    main()
