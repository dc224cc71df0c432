"""Traces whose samples are held, each until the next, the last for ever: STL by its definition.

Signals that are constant between multiples of DT, and windows that are multiples of it, make dense time
and samples the same: a window that begins at a sample sees just the samples in it. So every reader of a
formula can be asked about one trace.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction

from definition import Definition, of_values

DT = Fraction(1, 2)


@dataclass(frozen=True)
class Held:
    """``signals``: values at the samples 0, DT, …; ``sizes``: of the vehicles. Keys such as ``s(SV)``."""

    signals: Mapping[str, tuple[Fraction, ...]]
    sizes: Mapping[str, Fraction]

    @property
    def samples(self) -> int:
        return len(next(iter(self.signals.values())))

    def values(self, sample: int) -> dict[str, Fraction]:
        return {name: values[sample] for name, values in self.signals.items()} | dict(self.sizes)


def definition_of(trace: Held) -> Definition:
    return of_values([trace.values(k) for k in range(trace.samples)], DT)
