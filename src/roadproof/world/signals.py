"""The list of signals, quantities of a vehicle that vary with time; all other lists are made from it.

Code that knows the physics of a signal matches on its name and ends in ``assert_never``, so that mypy names
it when a signal is added here (see CONTRIBUTING.md).
"""

from collections.abc import Mapping
from typing import Literal, TypeAlias, get_args

from roadproof.runtime.records import dataclass
from roadproof.world.units import UNITS, Dimension

SignalName: TypeAlias = Literal["s", "d", "v_lon", "v_lat", "a_lon", "a_lat", "j_lon"]
SizeName: TypeAlias = Literal["length", "width", "kind"]
Kind: TypeAlias = Literal["car", "truck", "bus", "motorcycle", "other"]


class CustomSignalName(str):
    """The name of a custom signal, as a type that differs from the names in ``SIGNALS``."""

    __slots__ = ()


@dataclass(frozen=True)
class SignalInfo:
    """Properties of a signal, in ``unit``.

    ``stored``: what a drive stores. ``start``: its value at time 0, and a grid has an unknown for each
    sample. ``piece``: its value on each piece of the motion. ``nothing``: it follows from the others.
    ``rate_of``: the signal whose rate of change it is at all times; accelerations may jump, so jerk has none.
    ``recorded``: whether recordings and CSV files of samples have it. ``limited``: whether vehicle models
    bound it. ``what``: the quantity; ``where``: its direction, in words.
    """

    unit: str
    stored: Literal["start", "piece", "nothing"]
    rate_of: SignalName | None = None
    recorded: bool = True
    limited: bool = False
    what: str = ""
    where: str = ""


_ALONG, _ACROSS = "along the road", "across the road, to the left"
SIGNALS: Mapping[SignalName, SignalInfo] = {
    "s": SignalInfo("m", "start", what="front end", where=_ALONG),
    "d": SignalInfo("m", "start", what="left side", where="across the road, growing to the left"),
    "v_lon": SignalInfo("m/s", "start", rate_of="s", limited=True, what="velocity", where=_ALONG),
    "v_lat": SignalInfo("m/s", "start", rate_of="d", limited=True, what="velocity", where=_ACROSS),
    "a_lon": SignalInfo("m/s^2", "piece", rate_of="v_lon", limited=True, what="acceleration", where=_ALONG),
    "a_lat": SignalInfo("m/s^2", "piece", rate_of="v_lat", limited=True, what="acceleration", where=_ACROSS),
    "j_lon": SignalInfo("m/s^3", "piece", recorded=False, what="jerk", where=_ALONG),
}
SIZES: Mapping[SizeName, str] = {"length": "m", "width": "m"}
"""The box of a vehicle, which never changes, and the unit of its sizes."""

KINDS: tuple[Kind, ...] = get_args(Kind)
"""The kinds of vehicles; a term represents them as 1, 2, … in this order."""
FIXED: tuple[SizeName, ...] = (*SIZES, "kind")
"""The quantities of a vehicle that never change."""

STARTING = tuple(name for name, info in SIGNALS.items() if info.stored == "start")
RECORDED = tuple(name for name, info in SIGNALS.items() if info.recorded)
LIMITED = tuple(name for name, info in SIGNALS.items() if info.limited)
SIGNAL_DIMENSIONS: Mapping[SignalName, Dimension] = {n: UNITS[x.unit][1] for n, x in SIGNALS.items()}
SIZE_DIMENSIONS: Mapping[SizeName, Dimension] = {name: UNITS[unit][1] for name, unit in SIZES.items()}
