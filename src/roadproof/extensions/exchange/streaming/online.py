"""A monitor in Python that takes one sample after the other, with the plan and the verdicts of that in C.

Comparisons are those of the monitor of recordings, on a trace of one sample.
"""

from collections.abc import Mapping
from fractions import Fraction
from math import isfinite, nan
from typing import Literal, TypeAlias

import numpy as np

from roadproof.errors import InputError
from roadproof.extensions.exchange.streaming.interpreter import PlanState
from roadproof.extensions.exchange.streaming.plan import Plan
from roadproof.extensions.exchange.streaming.sample import Lane, SampleField, Source
from roadproof.logic import terms as t
from roadproof.logic.formula import Compare
from roadproof.semantics.sampled.arithmetic import run, truth_program
from roadproof.semantics.sampled.batch import Batch

Verdict: TypeAlias = Literal["true", "false", "undecided"]
Sample: TypeAlias = Mapping[str, float]
"""Values by the name of their field: SI units, and truth (or 0 and 1) where a field is a flag."""
_ONE = slice(0, 1)


class OnlineMonitor:
    """A monitor of one formula that is fed one sample after the other, every ``dt`` s.

    ``step`` takes a sample and returns a verdict: about the sample ``delay`` samples before it, or about the
    first one (``about``), as soon as the samples decide it. ``fields``: what a sample must have.
    """

    def __init__(self, text: str, plan: Plan, dt: Fraction, fields: Mapping[Source, SampleField]) -> None:
        self.formula = text
        self.dt = dt
        self._plan = plan
        self._fields = fields
        places = [(k, leaf) for k, leaf in enumerate(plan.leaves) if isinstance(leaf, Compare)]
        self._places = [k for k, _ in places]
        self._program = truth_program([leaf for _, leaf in places])
        self._compared = {x for _, leaf in places for side in (leaf.left, leaf.right) for x in t.leaves(side)}
        self.reset()

    @property
    def fields(self) -> dict[str, str]:
        """The unit and the meaning of each field of a sample."""
        return {x.name: x.about for x in self._fields.values()}

    @property
    def about(self) -> Literal["each sample", "the first sample"]:
        """The subject of verdicts: the first sample where an operator of the formula has no upper bound."""
        return "the first sample" if self._plan.at_start else "each sample"

    @property
    def delay(self) -> int:
        """The delay of verdicts, in samples."""
        return self._plan.delay

    @property
    def samples(self) -> int:
        """The number of samples so far."""
        return self._state.count

    def __repr__(self) -> str:
        return f"<Online monitor of {self.formula}: about {self.about}, {self.samples} samples>"

    def reset(self) -> None:
        """Forget all samples."""
        self._state = PlanState(self._plan)
        self._rejected = False

    def step(self, sample: Sample) -> Verdict:
        """Take a sample and return the verdict, "undecided" while there is none.

        Other entries than ``fields`` are ignored. Raises ``InputError`` for a missing field, a value that is
        no finite number, a size of 0 or less, and a custom signal outside its range. Such a sample is
        rejected: from then on each verdict is "undecided", until ``reset``.
        """
        if self._rejected:
            return "undecided"
        try:
            seen = self._observe(sample)
        except InputError:
            self._rejected = True
            raise
        holds = self._state.advance(seen)
        is_open = self._plan.at_start and not holds and self._state.at_first(weak=True)
        if self._state.count <= self.delay or is_open:
            return "undecided"
        return "true" if holds else "false"

    def finish(self) -> tuple[Verdict, ...]:
        """Return the verdicts if the trace ends here; call it at any time, it changes nothing.

        The verdict about the first sample alone, or those about the last ``delay`` samples, for which later
        ones are missing: "undecided" where these decide.
        """
        count = 1 if self._plan.at_start else min(self._state.count, self.delay)
        rest: list[Verdict] = ["undecided"] * count
        if self._rejected or not self._state.count:
            return tuple(rest)
        nothing = (False,) * len(self._plan.leaves)
        for weak in (False, True):
            state = self._state.copy()
            values = [state.at_first(weak)] if self._plan.at_start else []
            values += [state.advance(nothing, k, weak) for k in range(1, self.delay + 1)]
            for place, value in enumerate(values[-count:] if count else ()):
                if value != weak:
                    rest[place] = "true" if value else "false"
        return tuple(rest)

    def _observe(self, sample: Sample) -> list[bool]:
        """Return the truth of the leaves of the plan in a sample. Raises ``InputError``."""
        values = {source: _value(sample, x) for source, x in self._fields.items()}
        signals: dict[tuple[str, str], np.ndarray[tuple[int, int], np.dtype[np.float64]]] = {}
        sizes = {}
        for source in self._compared:
            match source:
                case t.Size(name, vehicle):
                    sizes[name, vehicle] = np.array([values[source]])
                case t.Signal(name, vehicle) | t.CustomSignal(name, vehicle):
                    signals[name, vehicle] = np.array([[values[source]]])
        number = f"sample {self.samples}"
        batch = Batch(self.dt, np.array([1]), signals, sizes, source=number)
        try:
            truths = run(self._program, batch, _ONE, _ONE)
        except InputError as error:
            raise InputError(f"{number} is rejected: {error}") from None
        seen = [isinstance(leaf, Lane) and bool(values[leaf]) for leaf in self._plan.leaves]
        for place, truth in zip(self._places, truths, strict=True):
            seen[place] = bool(truth[0, 0])
        return seen


def _value(sample: Sample, field: SampleField) -> float:
    """Return the value of a field; a flag is 0 or 1. Raises ``InputError``."""
    if field.name not in sample:
        raise InputError(f"the sample has no {field.name} ({field.about}); add it")
    value = sample[field.name]
    try:
        number = float(value)
    except (TypeError, ValueError, OverflowError):
        number = nan
    if field.flag and not isfinite(number):
        raise InputError(f"{field.name}={value!r}: True or False is needed ({field.about})")
    return float(number != 0) if field.flag else number
