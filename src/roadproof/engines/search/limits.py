"""The limits of a NONE-WITHIN verdict: every restriction of the search, as data and as text.

Choices that lose no generality, because one drive stands for others (``encode.shift_invariance``), are
not listed here.
"""

from collections.abc import Mapping, Sequence
from dataclasses import field
from fractions import Fraction

from roadproof.engines.encode.unroll import Grid
from roadproof.evidence.answers import shared
from roadproof.evidence.codec import write
from roadproof.evidence.strict import JsonObject
from roadproof.runtime.records import dataclass
from roadproof.world.vehicle import Range

# Options of ``roadproof witness`` and others that search, and of ``roadproof prove``, that widen limits.
SEARCH_OPTIONS = ("--horizon", "--dt", "--road", "--vehicle", "--reach")
PROVE_OPTIONS = ("--horizon", "--dt", "--road")


@dataclass(frozen=True)
class SearchLimits:
    """The set of drives that a NONE-WITHIN verdict excludes.

    Their accelerations are constant between the samples of ``grid`` and 0 after the last; the formula
    is read at the samples, of which the last stands for all later time. At the samples boxes are on
    ``road`` and, unless ``collisions``, apart. ``vehicles``: model by vehicle; ``lanes``: free lanes that
    stand for one lane only; ``values``: parameters (SI); ``reach``: largest distance of two starts (m);
    ``starts``: range of the fronts at time 0 (m), None where it makes no difference. ``custom_signals``: the
    ranges of signals that are constant between samples. ``jerk``: whether the formula has jerk.
    """

    road: str
    grid: Grid
    vehicles: Mapping[str, str]
    lanes: Mapping[str, str]
    values: Mapping[str, Fraction]
    reach: Fraction
    starts: Range | None
    collisions: bool
    shown: tuple[str, ...] = ()
    custom_signals: Mapping[str, str] = field(default_factory=dict)
    jerk: bool = False

    def text(self, options: Sequence[str] = SEARCH_OPTIONS) -> str:
        """One sentence that names every limit, and the ``options`` that widen them."""
        dt, horizon = float(self.grid.dt), float(self.grid.horizon)
        parts = [
            f"no drive on road {self.road} with samples every {dt:g} s up to {horizon:g} s",
            "the formula read at them and the last standing for all later time",
            f"accelerations constant between them{', so that jerk is 0' if self.jerk else ''}",
            f"boxes on the road{'' if self.collisions or len(self.vehicles) < 2 else ' and apart'} at them",
            f"vehicles {_listed(self.vehicles)}",
        ]
        if self.lanes:
            parts.append(f"lane {_listed(self.lanes)}")
        if len(self.vehicles) > 1:
            parts.append(f"starts at most {float(self.reach):g} m apart")
        if self.starts is not None:
            low, high = (f"{float(end):g} m" for end in self.starts)
            parts.append(f"starts between s={low} and s={high}")
        if self.values:
            parts.append(f"parameters {_listed({k: f'{float(v):g}' for k, v in self.values.items()})}")
        if self.custom_signals:
            listed = ", ".join(f"{name} in {bounds}" for name, bounds in self.custom_signals.items())
            parts.append(f"custom signals constant between samples, {listed}")
        shown = f" ({', '.join(self.shown)})" if self.shown else ""
        hint = f"; widen with {', '.join(options)}" if options else ""
        return f"{', '.join(parts)}{hint}{shown}"

    def as_json(self) -> JsonObject:
        """The limits as plain data; rationals as text."""
        return write(
            shared.LimitsData(
                road=self.road,
                dt=self.grid.dt,
                horizon=self.grid.horizon,
                read="at samples, the last for all later time",
                accelerations=f"constant between samples, none after the last{', no jerk' * self.jerk}",
                boxes="on the road at samples" + ("" if self.collisions else ", apart at samples"),
                vehicles=self.vehicles,
                lanes=self.lanes,
                parameters=self.values,
                reach=self.reach,
                starts=self.starts,
                shown=self.shown,
                signals=self.custom_signals or None,
            )
        )


def _listed(entries: Mapping[str, str]) -> str:
    return ", ".join(f"{name}={value}" for name, value in entries.items())
