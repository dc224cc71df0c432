"""Types of values that Python callers may give for an option."""

from collections.abc import Mapping
from pathlib import Path
from typing import Literal, TypeAlias

from roadproof.world.road import Road
from roadproof.world.vehicle import Vehicle

RoadLike: TypeAlias = Road | str | Path
VehicleLike: TypeAlias = Vehicle | str | Path
Vehicles: TypeAlias = VehicleLike | Mapping[str, VehicleLike] | None
"""A model for all vehicles, or models by name."""

Same: TypeAlias = Literal["same", "any"]
"""Whether two scenarios have the same lanes, roles or start, or any."""

ProofEngine: TypeAlias = Literal["dense", "smt", "milp"]
"""In dense time for all time, or on a grid up to a horizon."""

Expected: TypeAlias = Literal["PROVED", "REFUTED"]
"""The verdict that is expected of a claim."""

Assumed: TypeAlias = Literal["motion"]
"""What claims may be asked under."""
