"""How long proofs take, beside z3's and cvc5's own way with quantifiers on the same sentences.

    .venv/bin/python benchmarks/prove.py [--limit SECONDS]

Each claim is proved by roadproof (search, certificate, its query confirmed) and then given to the solvers
as it stands: the negated claim as a first-order sentence with quantifiers over real time. All in one run.
"""

import argparse
import multiprocessing
import subprocess
import sys
import time
from collections.abc import Callable
from functools import partial
from multiprocessing.connection import Connection

from roadproof.engines.prove.prover import prove
from roadproof.engines.solve.smt import check_sat
from roadproof.evidence.atoms import Atoms
from roadproof.evidence.times import moment_of
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.library.specification import Specification
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula

CLAIMS = [
    *(f"scenario_{i}(SV,POV,L) -> dangerArises(SV,POV)" for i in (1, 3, 4, 5, 6, 7, 8)),
    "scenario_2(SV,POV1,POV2,L) -> dangerArises(SV,POV2)",
    "scenario_3(SV,POV,L) -> scenario_3@extA(SV,POV,L)",
    "scenario_3(SV,POV,L) <-> scenario_4(POV,SV,L)",
    "not (scenario_1(SV,POV,L) and scenario_4(SV,POV,L))",
]
COMMANDS = [
    ["--help"],
    ["list"],
    ["prove", CLAIMS[0]],
    ["prove", "P9"],
    ["prove"],
    ["check", "proofs"],
]


def quantified(claim: Formula) -> str:
    """The negation of an abstracted claim at time 0 as SMT-LIB with quantifiers over Real."""
    atoms: set[str] = set()
    count = 0

    def truth(formula: Formula, now: str) -> str:
        nonlocal count
        match formula:
            case f.Application(name, _, _):
                atoms.add(name)
                return f"(|{name}| {now})"
            case f.Truth(value):
                return str(value).lower()
            case f.Not(body):
                return f"(not {truth(body, now)})"
            case f.And(parts) | f.Or(parts):
                word = "and" if isinstance(formula, f.And) else "or"
                return f"({word} {' '.join(truth(part, now) for part in parts)})"
            case f.Eventually(interval, body):
                count += 1
                t = f"t{count}"
                return f"(exists (({t} Real)) (and {window(interval, now, t)} {truth(body, t)}))"
            case f.Always(interval, body):
                count += 1
                t = f"t{count}"
                return f"(forall (({t} Real)) (=> {window(interval, now, t)} {truth(body, t)}))"
            case f.Until(left, interval, right):
                count += 2
                t, u = f"t{count - 1}", f"t{count}"
                before = f"(and (<= (+ {now} {moment_of(interval.low).smt()}) {u}) (< {u} {t}))"
                held = f"(forall (({u} Real)) (=> {before} {truth(left, u)}))"
                return f"(exists (({t} Real)) (and {window(interval, now, t)} {truth(right, t)} {held}))"
            case _:
                raise ValueError("claims with quantifiers over lanes are not in this benchmark")

    def window(interval: f.Interval, now: str, t: str) -> str:
        low = f"(<= (+ {now} {moment_of(interval.low).smt()}) {t})"
        if interval.high is None:
            return low
        return f"(and {low} (<= {t} (+ {now} {moment_of(interval.high).smt()})))"

    negated = truth(claim, "0.0")
    functions = [f"(declare-fun |{name}| (Real) Bool)" for name in sorted(atoms)]
    constants = [f"(declare-const {p} Real)(assert (>= {p} 0.0))" for p in ("minSafe", "minDanger")]
    return "\n".join(
        ["(set-logic UFLRA)", *constants, *functions, f"(assert (not {negated}))", "(check-sat)"]
    )


def without_adjacent_lanes(formula: Formula) -> Formula:
    """Quantifiers over adjacent lanes as atoms, which is how the sentence was asked before roadproof."""
    return f.transform(
        formula, lambda x: f.Application("someLane", (), f.TRUE) if isinstance(x, f.Some) else x
    )


def timed(work: Callable[[], str]) -> tuple[str, float]:
    begun = time.perf_counter()
    return work(), time.perf_counter() - begun


def verdict_of(specification: Specification, claim: str) -> str:
    return str(prove(specification, read_claim(specification, claim)).verdict)


def exit_code_of(words: list[str]) -> str:
    command = [sys.executable, "-m", "roadproof.frontends.cli.main", *words]
    return str(subprocess.run(command, capture_output=True, check=True).returncode)


def limited(script: str, solver: str, limit: float) -> str:
    """The solver's answer within ``limit`` seconds, in a process that can be stopped."""

    def work(pipe: Connection) -> None:
        pipe.send(check_sat(script, solver))

    here, there = multiprocessing.Pipe()
    process = multiprocessing.get_context("fork").Process(target=work, args=(there,))
    process.start()
    answer = str(here.recv()) if here.poll(limit) else "no answer"
    process.kill()
    return answer


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--limit", type=float, default=20.0, help="seconds for a solver's own attempt")
    limit = parser.parse_args().limit
    specification = bundled_library().select("base")
    prove(specification, read_claim(specification, "true"))
    print(f"{'roadproof':>18} {'z3 alone':>18} {'cvc5 alone':>18}  claim")
    for claim in CLAIMS:
        abstracted = Atoms().abstract(read_claim(specification, claim).formula)
        script = quantified(without_adjacent_lanes(abstracted))
        ours = timed(partial(verdict_of, specification, claim))
        scripts = {"z3": script, "cvc5": f"(set-option :enum-inst true)\n{script}"}
        theirs = [timed(partial(limited, text, solver, limit)) for solver, text in scripts.items()]
        shown = "".join(f" {answer:>9} {seconds:6.2f} s" for answer, seconds in (ours, *theirs))
        print(f"{shown}  {claim}", flush=True)
    for words in COMMANDS:
        _, seconds = timed(partial(exit_code_of, words))
        print(f"{seconds:6.2f} s  roadproof {' '.join(words)}", flush=True)


if __name__ == "__main__":
    main()
