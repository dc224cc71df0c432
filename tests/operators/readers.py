"""What each reader of formulas says of a case: for each trace and sample a truth, or None for no answer."""

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from typing import TypeAlias

from definition import Definition
from operators.cases import ATOMS, DT, NAMES
from roadproof.engines.encode.problem import evaluate
from roadproof.engines.encode.unroll import Grid, unroll_at
from roadproof.extensions.traffic.evaluate.recursive import SampledTrace, TraceReader
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.semantics.exact.judging import judge
from roadproof.semantics.exact.truth import Cut, TruthSet, from_values
from roadproof.semantics.sampled import Batch, compile
from roadproof.semantics.sampled.answers import Convention

Truths: TypeAlias = list[list[bool | None]]
Values: TypeAlias = Mapping[str, Sequence[float]]


def trace(batch: Batch, index: int) -> Values:
    """Return the values of each atom on one trace, 1 or -1 a sample."""
    length = int(batch.lengths[index])
    return {name: batch.signals["s", name][:length, index].tolist() for name in NAMES}


def on_each(batch: Batch, read: Callable[[Values], list[bool | None]]) -> Truths:
    return [read(trace(batch, index)) for index in range(batch.traces)]


def recursive(formula: Formula, batch: Batch, convention: Convention) -> Truths:
    """The definitions of the recorded view, one sample at a time; None is undecided."""

    def read(values: Values) -> list[bool | None]:
        length = len(values["P"])
        reader = TraceReader(SampledTrace(DT, length, {("s", x): y for x, y in values.items()}, {}))
        if convention == "clip":
            return [reader.holds(formula, k, "clip") for k in range(length)]
        strong, weak = ([reader.holds(formula, k, x) for k in range(length)] for x in ("strong", "weak"))
        return [True if x else None if y else False for x, y in zip(strong, weak, strict=True)]

    return on_each(batch, read)


def monitored(formula: Formula, batch: Batch, convention: Convention) -> Truths:
    """The monitor, on all traces at once."""
    answer = compile({"it": formula}).evaluate(batch, convention, at="all").answers["it"]
    return [
        [
            True if answer.true[k, i] else False if answer.false[k, i] else None
            for k in range(int(batch.lengths[i]))
        ]
        for i in range(batch.traces)
    ]


def lasting(formula: Formula, batch: Batch) -> Truths:
    """The definition where the last sample stands for all later time."""

    def read(values: Values) -> list[bool | None]:
        last = len(values["P"]) - 1
        reading = Definition(last, DT, lambda atom, k: values[atom.left.vehicle][k] > 0)  # type: ignore[attr-defined]
        return [reading.holds(formula, k) for k in range(last + 1)]

    return on_each(batch, read)


def encoded(formula: Formula, batch: Batch) -> Truths:
    """The circuit of the encoder, on the same samples."""

    def read(values: Values) -> list[bool | None]:
        last = len(values["P"]) - 1

        def truth(at):  # type: ignore[no-untyped-def]
            holds = values[at.atom.left.vehicle][at.step] > 0
            return holds if at.atom.op == ">" else not holds

        circuits = [unroll_at(formula, Grid(DT, last), k) for k in range(last + 1)]
        return [evaluate(circuit, truth) for circuit in circuits]

    return on_each(batch, read)


def judged(formula: Formula, batch: Batch) -> Truths:
    """The exact judge, where each sample lasts until the next, at the instants of samples."""

    def read(values: Values) -> list[bool | None]:
        given = {
            ATOMS[name]: from_values((Cut(Fraction(k), False), x > 0) for k, x in enumerate(values[name]))
            for name in NAMES
        }
        truth: TruthSet = judge(formula, None, given).truth(formula)
        return [truth.at(Fraction(k)) for k in range(len(values["P"]))]

    return on_each(batch, read)


def for_steps(formula: Formula) -> Formula:
    """Return the formula of which the definition on samples says what the judge says of values that last.

    There a since that begins at an earlier sample begins shortly before the next one, so its left side holds
    for the rest of that sample, too.
    """

    def change(part: Formula) -> Formula:
        if not isinstance(part, f.Since):
            return part
        now = f.once(f.Interval(part.interval.low, part.interval.low), part.right)
        return f.Or((now, f.Since(part.left, part.interval, f.And((part.left, part.right)))))

    return f.transform(formula, change)
