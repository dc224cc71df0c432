"""Evaluates comparisons over blocks of samples by straight-line bytecode, each sub-term once.

Arithmetic is IEEE double in a fixed order, the same as in ``extensions.traffic.evaluate.recursive``: a
sub-term without signals is one exact rational rounded once; sums and products run from left to right; a
power is a repeated product. Comparisons are strict or not exactly as written.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias, assert_never

import numpy as np

from roadproof.errors import InputError
from roadproof.logic import terms as t
from roadproof.logic.custom_names import refuse_value
from roadproof.logic.formula import Compare, Comparison
from roadproof.semantics.sampled.batch import Array, Batch

Operation: TypeAlias = Callable[..., Any]

COMPARISONS: dict[Comparison, Operation] = {
    "<": np.less,
    "<=": np.less_equal,
    ">": np.greater,
    ">=": np.greater_equal,
}


def invert(values: Array) -> Array:
    """Return 1/x, and ∞ where x = 0, of either sign (paper, appendix *Robust Semantics*)."""
    with np.errstate(divide="ignore", over="ignore"):
        return np.where(values == 0, np.inf, np.divide(1.0, values))


def difference(left: Array, right: Array) -> Array:
    """Return ``left - right``, and 0 for two equal infinities."""
    with np.errstate(invalid="ignore"):
        return np.where(left == right, 0.0, np.subtract(left, right))


@dataclass(frozen=True)
class Load:
    """A step that loads a constant, a signal or a size."""

    leaf: float | t.Signal | t.Size | t.CustomSignal


@dataclass(frozen=True)
class Apply:
    """A step that applies an operation to the results of earlier steps."""

    operation: Operation
    operands: tuple[int, ...]


Step: TypeAlias = Load | Apply


@dataclass(frozen=True)
class Bytecode:
    """A straight-line program: steps in order, each an input of later ones; ``results`` are its outputs.

    ``dead[k]`` are the steps whose values are no longer needed after step k.
    """

    steps: tuple[Step, ...]
    results: tuple[int, ...]
    dead: tuple[tuple[int, ...], ...]


def truth_program(comparisons: Sequence[Compare]) -> Bytecode:
    """Return the bytecode for the truth (bool) of every comparison."""
    return _compiled(comparisons, lambda c: (COMPARISONS[c.op], False))


def margin_program(comparisons: Sequence[Compare]) -> Bytecode:
    """Return the bytecode for margins: larger minus smaller side, negative where a comparison fails."""

    def operation(compare: Compare) -> tuple[Operation, bool]:
        infinite = any(isinstance(side, t.Inverse) for side in (compare.left, compare.right))
        return (difference if infinite else np.subtract), compare.op in ("<", "<=")

    return _compiled(comparisons, operation)


def run(program: Bytecode, batch: Batch, rows: slice, columns: slice) -> list[Array]:
    """Return the results on a block of samples × traces, each of shape (rows, columns).

    Raises ``InputError`` where a value inside a trace leaves the range of floating-point numbers.
    """
    try:
        return _run(program, batch, rows, columns, clean=False)
    except FloatingPointError:
        pass  # it may come from what the arrays hold after the end of a trace
    try:
        return _run(program, batch, rows, columns, clean=True)
    except FloatingPointError as error:
        raise InputError(
            f"{error} at samples {rows.start} to {rows.stop - 1} of traces {columns.start} to "
            f"{columns.stop - 1}: signals must be in SI units and of the magnitude of road traffic"
        ) from None


def _run(program: Bytecode, batch: Batch, rows: slice, columns: slice, clean: bool) -> list[Array]:
    shape = (rows.stop - rows.start, columns.stop - columns.start)
    inside = np.arange(rows.start, rows.stop)[:, None] < batch.lengths[None, columns] if clean else None
    values: list[Any] = [None] * len(program.steps)
    with np.errstate(over="raise", invalid="raise", divide="raise", under="ignore"):
        for index, step in enumerate(program.steps):
            match step:
                case Apply(operation, operands):
                    values[index] = operation(*(values[k] for k in operands))
                case Load(leaf):
                    values[index] = _load(leaf, batch, rows, columns, inside)
                case _:
                    assert_never(step)
            for unused in program.dead[index]:
                values[unused] = None
    return [np.broadcast_to(values[k], shape) for k in program.results]


def _load(
    leaf: float | t.Signal | t.Size | t.CustomSignal,
    batch: Batch,
    rows: slice,
    columns: slice,
    inside: Array | None,
) -> Any:
    match leaf:
        case float():
            return np.float64(leaf)
        case t.CustomSignal():
            block = _load_custom(leaf, batch, rows, columns)
            return block if inside is None else np.where(inside, block, 1.0)
        case t.Signal(name, vehicle):
            signal = batch.signals.get((name, vehicle))
            if signal is None:
                raise InputError(f"the batch has no signal {name}({vehicle}), which the formula needs")
            block = signal[rows, columns].astype(np.float64, copy=False)
            return block if inside is None else np.where(inside, block, 1.0)
        case t.Size(name, vehicle):
            size = batch.sizes.get((name, vehicle))
            if size is None and name == "kind":
                raise InputError(f"nothing says what kind of vehicle {vehicle} is, which the formula asks")
            if size is None:
                raise InputError(f"the batch has no size {name}({vehicle}), which the formula needs")
            return size[columns].astype(np.float64, copy=False)
        case _:
            assert_never(leaf)


def _load_custom(signal: t.CustomSignal, batch: Batch, rows: slice, columns: slice) -> Array:
    """Return a block of a custom signal, checked against its declaration."""
    values = batch.signals.get((signal.name, signal.vehicle))
    source = f"{batch.source}: " if batch.source else ""
    if values is None:
        raise InputError(f"{source}the batch has no signal {signal.text}, which the formula needs")
    block = values[rows, columns].astype(np.float64, copy=False)
    within = np.isin(block, (0.0, 1.0)) if signal.truth else np.isfinite(block)
    with np.errstate(invalid="ignore"):
        within &= block >= (-np.inf if signal.low is None else float(signal.low))
        within &= block <= (np.inf if signal.high is None else float(signal.high))
    wrong = np.argwhere(~within & (np.arange(rows.start, rows.stop)[:, None] < batch.lengths[None, columns]))
    if len(wrong):
        sample, trace = wrong[0]
        value = float(block[sample, trace])
        where = f"in trace {columns.start + trace} at sample {rows.start + sample}"
        if not np.isfinite(value):
            raise InputError(f"{source}{signal.text} {where} is missing, or no finite number; fill the gap")
        refuse_value(signal, value, where, source)
    return block


def _compiled(
    comparisons: Sequence[Compare], operation: Callable[[Compare], tuple[Operation, bool]]
) -> Bytecode:
    building = _BytecodeBuilder()
    results = []
    for compare in comparisons:
        left, right = building.place(compare.left), building.place(compare.right)
        compute, swapped = operation(compare)
        results.append(building.apply(compute, *((right, left) if swapped else (left, right))))
    return Bytecode(tuple(building.steps), tuple(results), _dead(building.steps, results))


def _dead(steps: Sequence[Step], results: Iterable[int]) -> tuple[tuple[int, ...], ...]:
    last_use = {k: index for index, s in enumerate(steps) if isinstance(s, Apply) for k in s.operands}
    needed = set(results)
    dead: list[list[int]] = [[] for _ in steps]
    for k, index in last_use.items():
        if k not in needed:
            dead[index].append(k)
    return tuple(tuple(d) for d in dead)


class _BytecodeBuilder:
    def __init__(self) -> None:
        self.steps: list[Step] = []
        self.known: dict[Step, int] = {}
        self.placed: dict[t.Term, int] = {}

    def add(self, step: Step) -> int:
        """Return the number of a step, appended if it is new."""
        if step not in self.known:
            self.known[step] = len(self.steps)
            self.steps.append(step)
        return self.known[step]

    def apply(self, operation: Operation, *operands: int) -> int:
        """Append an operation on earlier steps and return its number."""
        return self.add(Apply(operation, operands))

    def fold(self, operation: Operation, operands: Iterable[t.Term]) -> int:
        """Append a chain of a binary operation over terms, from left to right."""
        first, *rest = (self.place(x) for x in operands)
        for operand in rest:
            first = self.apply(operation, first, operand)
        return first

    def place(self, term: t.Term) -> int:
        """Return the step that computes ``term``."""
        if term not in self.placed:
            self.placed[term] = self._place(term)
        return self.placed[term]

    def _place(self, term: t.Term) -> int:
        constant = t.constant_value(term)
        if constant is not None:
            return self.add(Load(float(constant)))
        match term:
            case t.Signal() | t.Size() | t.CustomSignal():
                return self.add(Load(term))
            case t.Sum(terms):
                return self.sum_of(terms)
            case t.Product(factors):
                return self.fold(np.multiply, factors)
            case t.Power(base, exponent):
                return self.power_of(base, exponent)
            case t.Quotient(numerator, denominator):
                return self.apply(np.divide, self.place(numerator), self.place(denominator))
            case t.Maximum(terms):
                return self.fold(np.maximum, terms)
            case t.Minimum(terms):
                return self.fold(np.minimum, terms)
            case t.Inverse(inner):
                return self.apply(invert, self.place(inner))
            case t.Number() | t.Parameter() | t.Variable():
                raise InputError(f"a monitored formula has values for all its names, but {term} is open")
            case _:
                assert_never(term)

    def sum_of(self, terms: tuple[t.Term, ...]) -> int:
        """Append a sum; x + (-1)·y is x - y to the last bit, and one operation cheaper."""
        total = self.place(terms[0])
        for term in terms[1:]:
            match term:
                case t.Product((t.Number(value, _), negated)) if value == -1:
                    total = self.apply(np.subtract, total, self.place(negated))
                case _:  # open: terms of another shape are added
                    total = self.apply(np.add, total, self.place(term))
        return total

    def power_of(self, base: t.Term, exponent: int) -> int:
        """Append a power as a repeated product."""
        if exponent < 0:
            raise InputError(f"exponent={exponent}: a power must not be negative; write inverse(…)")
        if exponent == 0:
            return self.add(Load(1.0))
        factor = power = self.place(base)
        for _ in range(exponent - 1):
            power = self.apply(np.multiply, power, factor)
        return power
