"""The JSON form of the files that show a NONE-WITHIN."""

from collections.abc import Mapping
from fractions import Fraction
from typing import Annotated, Literal

from roadproof.core_record import NONE_WITHIN
from roadproof.evidence.answers.drive import RoadField
from roadproof.evidence.answers.shared import Formula, OneScenario, SetName
from roadproof.evidence.codec import Doc, Rule
from roadproof.runtime.records import dataclass
from roadproof.world.signals import Kind


@dataclass(frozen=True, kw_only=True)
class VehicleModelData:
    """The abilities of a vehicle, in SI units."""

    name: str
    length: Fraction
    width: Fraction
    v_lon: tuple[Fraction, Fraction]
    v_lat: tuple[Fraction, Fraction]
    a_lon: tuple[Fraction, Fraction]
    a_lat: tuple[Fraction, Fraction]
    lateral_share: Annotated[Fraction, Doc("The greatest share of v_lon that |v_lat| has.")]
    kind: Annotated[Kind | None, Doc("What kind of vehicle it is; null where the model does not say it.")]


@dataclass(frozen=True, kw_only=True)
class RefutationTree:
    """A tree for one assignment of lanes."""

    lanes: Annotated[Mapping[str, str], Doc("A lane of the road for each free lane of the formula.")]
    tree: Annotated[
        tuple[Annotated[str, Rule(pattern=r"^(sum|cases|cut) [a-z0-9 *,-]+$")], ...],
        Rule(least=1),
        Doc("The nodes of the tree, each before its branches (docs/explanation/trust.md)."),
    ]


@dataclass(frozen=True, kw_only=True)
class NoneWithinData:
    """The proof that no drive within limits satisfies a formula."""

    schema: Literal["roadproof/none-within/1"] = NONE_WITHIN
    scenario: OneScenario = None
    set: SetName
    formula: Annotated[Formula, Doc("What holds on no drive within the limits.")]
    horizon: Annotated[Fraction, Doc("The last sample, in s.")]
    dt: Annotated[Fraction, Doc("From one sample to the next, in s.")]
    reach: Annotated[Fraction, Doc("How far apart two vehicles may start, in m.")]
    overlaps_allowed: Annotated[bool, Doc("Whether boxes may overlap.")]
    parameters: Annotated[
        Mapping[str, str], Doc("Values of parameters (rationals, SI units) and readings of options, by name.")
    ]
    road: RoadField
    vehicles: Annotated[
        Mapping[str, VehicleModelData], Rule(least=1), Doc("Models by the name in the formula.")
    ]
    refutations: Annotated[
        tuple[RefutationTree, ...], Rule(least=1), Doc("One for each assignment of lanes.")
    ]
