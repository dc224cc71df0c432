"""Comparisons of terms as statements in C: the same operations in the same order as the monitor.

They are made from the monitor's own program (``semantics.sampled.arithmetic``). A value that the monitor
rejects, as it is no finite number, clears ``fine``: infinities and NaN pass through sums and products, so
they are looked for where they may get lost, in comparisons, divisors, maxima, minima and inverses.
"""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from roadproof.extensions.exchange.streaming.sample import SampleField, Source
from roadproof.logic import terms as t
from roadproof.logic.formula import Compare
from roadproof.semantics.sampled.arithmetic import COMPARISONS, Apply, Load, Operation, invert, truth_program

_INFIX: Mapping[Operation, str] = {np.add: "+", np.subtract: "-", np.multiply: "*", np.divide: "/"} | {
    operation: sign for sign, operation in COMPARISONS.items()
}
_CALLS: Mapping[Operation, str] = {np.maximum: "larger", np.minimum: "smaller", invert: "inverse"}
HELPERS = {
    "is_finite": """\
static int is_finite(double x)
{
    return x >= -1.7976931348623157e308 && x <= 1.7976931348623157e308;
}""",
    "larger": """\
static double larger(double x, double y)
{
    return x > y ? x : y;
}""",
    "smaller": """\
static double smaller(double x, double y)
{
    return x < y ? x : y;
}""",
    "inverse": """\
static double inverse(double x)
{
    return x == 0.0 ? (double)INFINITY : 1.0 / x;
}""",
}
"""Functions in C that the statements may call."""


def literal(value: float) -> str:
    """A number in C, to the last bit."""
    return f"({value.hex()})" if value < 0 else value.hex()


def comparisons(leaves: Sequence[tuple[int, Compare]], fields: Mapping[Source, SampleField]) -> Iterator[str]:
    """Statements that write the truth of comparisons into ``seen``, each at its number, and ``fine``."""
    program = truth_program([leaf for _, leaf in leaves])
    inverses = {k for k, x in enumerate(program.steps) if isinstance(x, Apply) and x.operation is invert}
    checked: set[int] = set()
    for k, step in enumerate(program.steps):
        if isinstance(step, Load):
            yield f"const double x{k} = {_load_expression(step.leaf, fields)};"
            continue
        arguments = [f"x{x}" for x in step.operands]
        risky = step.operands[1:] if step.operation is np.divide else step.operands
        if step.operation not in (np.add, np.subtract, np.multiply):
            for x in risky:
                if x not in checked and x not in inverses and not _is_number(program.steps[x]):
                    checked.add(x)
                    yield f"fine &= is_finite(x{x});"
        sign = _INFIX.get(step.operation)
        value = (
            f"{_CALLS[step.operation]}({', '.join(arguments)})"
            if sign is None
            else f" {sign} ".join(arguments)
        )
        yield f"const {'int' if step.operation in COMPARISONS.values() else 'double'} x{k} = {value};"
    places = zip(program.results, leaves, strict=True)
    yield from (f"seen[{place}] = (uint8_t)x{k};" for k, (place, _) in places)


def _is_number(step: Load | Apply) -> bool:
    return isinstance(step, Load) and isinstance(step.leaf, float)


def _load_expression(
    leaf: float | t.Signal | t.Size | t.CustomSignal, fields: Mapping[Source, SampleField]
) -> str:
    if isinstance(leaf, float):
        return literal(leaf)
    field = fields[leaf]
    return f"(sample->{field.name} != 0)" if field.flag else f"sample->{field.name}"


def range_checks(
    leaves: Sequence[tuple[int, Compare]], fields: Mapping[Source, SampleField]
) -> Iterator[str]:
    """Statements that clear ``fine`` for sizes of 0 or less, and custom signals outside of their range."""
    compared = {x for _, leaf in leaves for side in (leaf.left, leaf.right) for x in t.leaves(side)}
    for source, field in fields.items():
        if source not in compared or field.flag:
            continue
        if isinstance(source, t.Size):
            yield f"fine &= sample->{field.name} > 0.0;"
        elif isinstance(source, t.CustomSignal):
            ends = (("<=", source.high), (">=", source.low))
            yield from (
                f"fine &= sample->{field.name} {op} {literal(float(end))};"
                for op, end in ends
                if end is not None
            )
