"""The one list of signals: what changes with time about a vehicle. All other lists of them are made from it.

Readers that know the physics of a signal match on its name and end in ``assert_never``, so mypy names
each of them when a signal is added here (CONTRIBUTING.md shows how).
"""

from collections.abc import Mapping
from typing import Literal, TypeAlias, get_args

from roadproof.runtime.records import dataclass
from roadproof.world.units import UNITS, Dimension

SignalName: TypeAlias = Literal["s", "d", "v_lon", "v_lat", "a_lon", "a_lat", "j_lon"]
SizeName: TypeAlias = Literal["length", "width", "kind"]
Kind: TypeAlias = Literal["car", "truck", "bus", "motorcycle", "other"]


class OwnName(str):
    """The name of a signal that a specification declares, told apart from those of the list."""

    __slots__ = ()


@dataclass(frozen=True)
class About:
    """What is known of a signal, in ``unit``.

    ``kept``: what a drive keeps of it. Of ``start`` its value at time 0, and a grid has an unknown for
    each sample; of ``piece`` its value on each piece of the motion; ``nothing`` where it follows from
    the others. ``rate_of``: what it is the rate of change of, at all times: accelerations may jump, so that
    jerk is the rate of none. ``recorded``: whether recordings and CSV
    files of samples have it. ``limited``: whether models of vehicles bound it. ``what``: what it is of a
    vehicle, ``where``: in which direction, in words.
    """

    unit: str
    kept: Literal["start", "piece", "nothing"]
    rate_of: SignalName | None = None
    recorded: bool = True
    limited: bool = False
    what: str = ""
    where: str = ""


_ALONG, _ACROSS = "along the road", "across the road, to the left"
SIGNALS: Mapping[SignalName, About] = {
    "s": About("m", "start", what="front end", where=_ALONG),
    "d": About("m", "start", what="left side", where="across the road, growing to the left"),
    "v_lon": About("m/s", "start", rate_of="s", limited=True, what="velocity", where=_ALONG),
    "v_lat": About("m/s", "start", rate_of="d", limited=True, what="velocity", where=_ACROSS),
    "a_lon": About("m/s^2", "piece", rate_of="v_lon", limited=True, what="acceleration", where=_ALONG),
    "a_lat": About("m/s^2", "piece", rate_of="v_lat", limited=True, what="acceleration", where=_ACROSS),
    "j_lon": About("m/s^3", "piece", recorded=False, what="jerk", where=_ALONG),
}
SIZES: Mapping[SizeName, str] = {"length": "m", "width": "m"}
"""The box of a vehicle, which never changes, and its unit."""

KINDS: tuple[Kind, ...] = get_args(Kind)
"""Every vehicle is of one of these kinds at all times; a term holds them as 1, 2, … in this order."""
FIXED: tuple[SizeName, ...] = (*SIZES, "kind")
"""All that never changes about a vehicle."""

STARTING = tuple(name for name, about in SIGNALS.items() if about.kept == "start")
RECORDED = tuple(name for name, about in SIGNALS.items() if about.recorded)
LIMITED = tuple(name for name, about in SIGNALS.items() if about.limited)
SIGNAL_DIMENSIONS: Mapping[SignalName, Dimension] = {n: UNITS[x.unit][1] for n, x in SIGNALS.items()}
SIZE_DIMENSIONS: Mapping[SizeName, Dimension] = {name: UNITS[unit][1] for name, unit in SIZES.items()}
