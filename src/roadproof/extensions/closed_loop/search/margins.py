"""The margins by which simulations show a scenario and break a requirement, on samples, many at once.

The margins guide a search. The judge decides.
"""

from collections.abc import Mapping, Sequence
from fractions import Fraction

import numpy as np
import numpy.typing as npt

from roadproof.extensions.closed_loop.protocol import OBSERVED
from roadproof.extensions.closed_loop.simulation import VehicleSamples
from roadproof.extensions.closed_loop.situation import StepClock, VehicleCourse
from roadproof.library.bind import bind
from roadproof.logic.formula import Formula
from roadproof.runtime.records import dataclass
from roadproof.semantics.sampled import Batch, Monitor, compile
from roadproof.world.road import Road

MOST = 1e4
"""The greatest margin; an infinite one is cut to it."""


@dataclass(frozen=True)
class Ruler:
    """A monitor of formulas that are bound to a road, on the samples of simulations."""

    monitor: Monitor[str]
    clock: StepClock

    @classmethod
    def of(
        cls,
        formulas: Mapping[str, Formula],
        road: Road,
        lanes: Mapping[str, str],
        values: Mapping[str, Fraction],
        clock: StepClock,
    ) -> "Ruler":
        """Return the ruler of formulas by name. Raises ``InputError``."""
        bound = {name: bind(x, road, lanes, values) for name, x in formulas.items()}
        return cls(compile(bound), clock)

    def measure(
        self, tracks: Mapping[str, VehicleSamples], courses: Mapping[str, VehicleCourse]
    ) -> dict[str, npt.NDArray[np.float64]]:
        """Return the margin of each formula at the start of each simulation.

        ``tracks``: arrays of shape (steps + 1, simulations). Raises ``InputError`` where an interval of a
        formula is no multiple of the step.
        """
        count = next(iter(tracks.values())).s.shape[1]
        signals = {(x, name): getattr(track, x) for name, track in tracks.items() for x in OBSERVED}
        sizes = {
            (size, name): np.full(count, float(getattr(course, size)))
            for name, course in courses.items()
            for size in ("length", "width")
        }
        lengths = np.full(count, self.clock.steps + 1)
        batch = Batch(self.clock.dt, lengths, signals, sizes)  # type: ignore[arg-type]
        margins = self.monitor.measure(batch, "clip").margins
        return {name: np.clip(x.low, -MOST, MOST) for name, x in margins.items()}


def stacked(runs: Sequence[VehicleSamples]) -> VehicleSamples:
    """Return the samples of one vehicle in several simulations as columns."""
    return VehicleSamples(*(np.stack([getattr(x, name) for x in runs], axis=1) for name in OBSERVED))
