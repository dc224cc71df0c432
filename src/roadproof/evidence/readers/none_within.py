"""Reads the trees that show a NONE-WITHIN."""

from roadproof.evidence.answers.none_within import VehicleModelData
from roadproof.evidence.claim import Claim, Exists
from roadproof.evidence.none_within import NoneWithinFile
from roadproof.evidence.none_within_file import read_none_within
from roadproof.evidence.readers.about_claim import require, require_options, require_values, shortened
from roadproof.world.vehicle import Vehicle


def none_within_for(claim: Claim, content: object, where: str) -> NoneWithinFile:
    """Return the trees of a file, unchecked. Raises ``InputError`` if they are about another claim."""
    file = read_none_within(content, where)
    require_options(claim, file.set_name, file.options, where)
    require(
        claim.read(file.formula) == claim.formula,
        where,
        f"it is about {shortened(file.formula)}",
    )
    require_values(claim, file.values, where)
    require(_is_within(claim, file), where, "it is about drives within other limits")
    return file


def _is_within(claim: Claim, file: NoneWithinFile) -> bool:
    """Return whether trees cover all drives that a claim asks for; they choose what the claim leaves open."""
    mode = claim.mode
    if not isinstance(mode, Exists):
        return False
    models = {name: mode.vehicles.get(name, mode.vehicles.get("")) for name in claim.vehicles}
    return (
        mode.road in (None, file.road)
        and mode.dt in (None, file.dt)
        and mode.horizon <= file.horizon
        and mode.reach <= file.reach
        and mode.collisions <= file.overlaps_allowed
        and (
            bool(mode.limits)
            or file.road.line is not None
            or all(x is None or _moves_as(x, file.vehicles[name]) for name, x in models.items())
        )
    )


def _moves_as(one: Vehicle, other: Vehicle) -> bool:
    """Return whether two vehicle models allow the same motions; limits of natural drives are ignored."""
    return all(getattr(one, x) == getattr(other, x) for x in VehicleModelData.__annotations__)
