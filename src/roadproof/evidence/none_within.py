"""The files that show a NONE-WITHIN: a question with its limits, and a tree for each lane assignment.

Reading checks the fields only. To check a tree, the encoder derives the program of its lane assignment.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import TYPE_CHECKING

from roadproof.runtime.records import dataclass

if TYPE_CHECKING:
    from roadproof.evidence.program import Tree
    from roadproof.world.road import Road
    from roadproof.world.vehicle import Vehicle


@dataclass(frozen=True)
class NoneWithinFile:
    """A question with its limits; ``refutations``: pairs of an assignment of free lanes and its tree."""

    scenario: int | None
    set_name: str
    formula: str
    horizon: Fraction
    dt: Fraction
    reach: Fraction
    overlaps_allowed: bool
    values: Mapping[str, Fraction]
    options: Mapping[str, str]
    road: Road
    vehicles: Mapping[str, Vehicle]
    refutations: tuple[tuple[Mapping[str, str], Tree], ...]


# --- trees as lines: each node before its branches -----------------------------------------------------
