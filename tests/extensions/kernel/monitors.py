"""Formulas on recorded traces put to Coq, with the words that the Python monitor computes (Monitor.v)."""

import random
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from extensions.kernel.raw import fold_left
from extensions.kernel.reading import monitor_theory
from extensions.traffic.monitoring.cases import IN_LANE, ON_MAIN, interval
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import bounds_of
from roadproof.semantics.sampled import Batch, compile, compiled
from roadproof.semantics.sampled.batch import Array
from roadproof.semantics.sampled.lattice import View

HELPERS = """
From Coq Require Import List NArith.
Import ListNotations.
Open Scope N_scope.
Fixpoint same (l m : list N) : bool :=
  match l, m with [], [] => true | x :: l, y :: m => (x =? y) && same l m | _, _ => false end%bool.
Definition letter (v : verdict) : N := match v with Yes => 1 | No => 0 | Undecided => 2 end.
Definition agrees (bits : N) (rows : nat) (lengths : list nat) (columns : list (list N)) (f : sampled)
    (strong weak clip answers : list N) : bool :=
  let states i := nth i columns [] in
  let words v := value bits rows lengths states v f in
  (same (words Strong) strong && same (words Weak) weak && same (words Clip) clip
   && let first := seq 0 (List.length answers) in
      same (map (fun i => letter (answer bits rows lengths states f 0 i)) first) answers)%bool.
"""
ANSWERED = 8
"""Traces of a batch whose answers at the start are compared, too."""


@dataclass(frozen=True)
class Case:
    """What the Python monitor made of a formula and a batch: a number for each sample, bit b for trace b."""

    formula: str
    bits: int
    lengths: tuple[int, ...]
    columns: tuple[tuple[int, ...], ...]
    words: tuple[tuple[int, ...], ...]
    """In the strong, the weak and the clipped view."""
    answers: tuple[int, ...]
    """At the start of the first traces: 1 for true, 0 for false, 2 for undecided."""


def monitored(formula: Formula, batch: Batch) -> Case:
    """The words and answers of the monitor, as ``Monitor.evaluate`` computes them."""
    monitor = compile({"it": formula})
    seen = monitor.observe(batch)
    shape = (seen.samples, -(-len(seen.lengths) // compiled.BITS))
    end = compiled.packed_inside(seen.lengths, seen.samples)
    evaluation = compiled.LatticeEvaluation(compiled.TRUTH, seen.leaves, end, seen.dt, shape, monitor.states)
    plain = monitor.plain["it"]
    verdicts = monitor.evaluate(seen).answers["it"]
    states = {leaf: number for number, leaf in enumerate(seen.leaves)}
    return Case(
        sampled(plain, batch.dt, states),
        64 * shape[1],
        tuple(map(int, batch.lengths)),
        tuple(numbers(words) for words in seen.leaves.values()),
        tuple(numbers(evaluation.value(plain, view)) for view in (View.STRONG, View.WEAK, View.CLIP)),
        tuple(
            1 if true else 0 if false else 2
            for true, false in zip(verdicts.true[:ANSWERED], verdicts.false[:ANSWERED], strict=True)
        ),
    )


def numbers(words: Array) -> tuple[int, ...]:
    """Each row of machine words as one number."""
    return tuple(int.from_bytes(np.ascontiguousarray(row, dtype="<u8").tobytes(), "little") for row in words)


def sampled(formula: Formula, dt: Fraction, states: Mapping[Formula, int]) -> str:
    """The formula as a tree of Recorded.v."""
    if formula in states:
        return f"(State {states[formula]})"
    match formula:
        case f.Truth(value):
            return f"(Truth_ {str(value).lower()})"
        case f.Not(body):
            return f"(Not_ {sampled(body, dt, states)})"
        case f.And(parts):
            return fold_left("And_", [sampled(x, dt, states) for x in parts])
        case f.Or(parts):
            return fold_left("Or_", [sampled(x, dt, states) for x in parts])
        case f.Until(left, within, right):
            return f"(Until_ {sampled(left, dt, states)} {window(within, dt)} {sampled(right, dt, states)})"
        case f.Eventually(within, body):
            return f"(Eventually_ {window(within, dt)} {sampled(body, dt, states)})"
        case f.Always(within, body):
            return f"(Always_ {window(within, dt)} {sampled(body, dt, states)})"
    raise AssertionError(formula)


def window(within: f.Interval, dt: Fraction) -> str:
    low, high = bounds_of(within)
    return f"{low / dt} {'None' if high is None else f'(Some {high / dt})'}"


def compared(cases: Iterable[Case]) -> str:
    """A file in which Coq says of each case whether its algorithm makes the same of it."""
    return monitor_theory() + HELPERS + "".join(map("".join, map(_lines, cases)))


def _lines(case: Case) -> Iterator[str]:
    yield f"Eval vm_compute in [agrees {case.bits} {len(case.words[0])}%nat {_list(case.lengths)}%nat\n"
    yield f" [{'; '.join(map(_list, case.columns))}]\n {case.formula}%nat\n"
    yield " ".join(map(_list, (*case.words, case.answers))) + "].\n"


def _list(values: Sequence[int]) -> str:
    return f"[{'; '.join(map(hex, values))}]"


# --- random formulas -----------------------------------------------------------------------------

STATES = (
    IN_LANE,
    ON_MAIN,
    f.Compare(t.Signal("s", "SV"), "<", t.Signal("s", "POV")),
    f.Compare(t.Signal("v_lon", "SV"), ">=", t.number(0)),
    f.TRUE,
    f.FALSE,
)


def random_formula(r: random.Random, deep: int, widest: int) -> Formula:
    """A formula of every operator, with windows of up to ``widest`` samples."""
    word = r.choice(["not", "and", "or", "F", "G", "U", "U"]) if deep else "state"
    inside = (
        [random_formula(r, r.randint(0, deep - 1), widest) for _ in range(r.randint(2, 3))] if deep else []
    )
    low, width = r.choice([0, 0, r.randint(1, widest)]), r.choice([None, 0, 1, r.randint(2, widest)])
    match word:
        case "not":
            return f.Not(inside[0])
        case "and":
            return f.And(tuple(inside))
        case "or":
            return f.Or(tuple(inside))
        case "F":
            return f.Eventually(interval(low, width), inside[0])
        case "G":
            return f.Always(interval(low, width), inside[0])
        case "U":
            return f.Until(inside[0], interval(low, width), inside[1])
    return r.choice(STATES)
