"""The road, vehicles and limits of a search for drives, as plain data in ``question.json``."""

from collections.abc import Mapping
from fractions import Fraction
from typing import Annotated

from roadproof.evidence.answers.drive import RoadField
from roadproof.evidence.answers.none_within import VehicleModelData
from roadproof.evidence.claim import Engine, Exists, Objective
from roadproof.evidence.codec import Doc, Rule
from roadproof.evidence.drive_file import road_data, road_of
from roadproof.runtime.records import dataclass
from roadproof.world.vehicle import Vehicle

Positive = Annotated[Fraction, Rule(pattern="^[1-9][0-9]{0,39}(/[0-9]{1,40})?$")]


_OF_ONE_CLAIM = ("unlike", "trees", "apart", "by", "like")


@dataclass(frozen=True, kw_only=True)
class VehicleModel(VehicleModelData):
    """The limits of a vehicle and of its natural drives, in SI units."""

    cruise: Annotated[tuple[Fraction, Fraction], Doc("Speeds with which a natural drive starts.")]
    jump_lon: Annotated[Fraction, Doc("By how much a_lon changes at most in a natural drive.")]
    jump_lat: Annotated[Fraction, Doc("By how much a_lat changes at most in a natural drive.")]
    a_bend: Annotated[Fraction, Doc("The greatest acceleration across on a bend.")]


@dataclass(frozen=True, kw_only=True)
class DriveSearchData:
    """The fields of ``evidence.claim.Exists`` as data."""

    road: Annotated[RoadField | None, Doc("Null: the usual road of the formula.")]
    lanes: Annotated[Mapping[str, str], Doc("Lanes of the road that lanes of the formula stand for.")]
    vehicles: Annotated[Mapping[str, VehicleModel], Doc("Models by name; an empty name: all others.")]
    limits: Annotated[Mapping[str, Mapping[str, Fraction]], Doc("Other limits than theirs, SI units.")]
    horizon: Annotated[Positive, Doc("Seconds that are searched.")]
    dt: Annotated[Positive | None, Doc("Seconds from one sample to the next; null: the coarsest that fits.")]
    reach: Annotated[Positive, Doc("How far apart two vehicles may start, in m.")]
    collisions: Annotated[bool, Doc("Whether boxes may overlap.")]
    natural: Annotated[bool, Doc("Whether natural drives are tried first.")]
    objective: Annotated[Objective, Doc("What a drive should be like.")]
    engine: Annotated[Engine, Doc("What looks for it.")]
    solver: Annotated[str, Doc("What the engine asks.")]
    refinements: Annotated[int, Rule(minimum=0), Doc("How many finer grids are tried.")]
    explain: Annotated[bool, Doc("Whether a proof is looked for that there is none.")]


def search_data(mode: Exists) -> DriveSearchData:
    """Return how drives are looked for as data."""
    fields = {name: value for name, value in vars(mode).items() if name not in _OF_ONE_CLAIM}
    return DriveSearchData(
        **{
            **fields,
            "road": None if mode.road is None else road_data(mode.road),
            "vehicles": {name: vehicle_data(x) for name, x in mode.vehicles.items()},
        }
    )


def search_mode(place: DriveSearchData, where: str) -> Exists:
    """Return how drives are looked for. Raises ``InputError`` for a road that is none."""
    return Exists(
        **{
            **vars(place),
            "road": None if place.road is None else road_of(place.road, where),
            "vehicles": vehicles_of(place.vehicles),
        }
    )


def vehicle_data(vehicle: Vehicle) -> VehicleModel:
    """Return a model of a vehicle as data."""
    return VehicleModel(**vars(vehicle))


def vehicles_of(models: Mapping[str, VehicleModel]) -> dict[str, Vehicle]:
    """Return models of vehicles by name."""
    return {name: Vehicle(**vars(x)) for name, x in models.items()}
