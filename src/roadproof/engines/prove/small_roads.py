"""A road of few lanes and lanelets, all of them known, on which a claim is to be false.

Where quantifiers over lanes stand in each other, naming what they say exists has no end; over a
roster they are finite. What has no model there may have one on a larger road: nothing is proved so.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from roadproof.evidence.atoms import free_lanelets, is_atom
from roadproof.evidence.derivation import free_prefix
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import road_names

FEWEST_LANES = 2
LANELETS_A_LANE = 2


@dataclass(frozen=True)
class Roster:
    """``lanelets`` gives each lanelet its lane."""

    lanes: tuple[str, ...]
    lanelets: Mapping[str, str]

    def members(self, domain: f.Domain) -> list[str]:
        """The elements that are in ``domain``, or may be in it (a zone, lanes beside another)."""
        match domain.kind:
            case "lanes":
                return list(self.lanes)
            case "adjacent":
                return [lane for lane in self.lanes if lane != domain.of]
            case "lanelets":
                return [lanelet for lanelet, lane in self.lanelets.items() if lane == domain.of]
            case "zone":
                return list(self.lanelets)

    def elements(self) -> dict[str, f.Domain]:
        lanes = dict.fromkeys(self.lanes, f.Domain("lanes"))
        return lanes | {lanelet: f.Domain("lanelets", lane) for lanelet, lane in self.lanelets.items()}


def roster_for(claim: Formula, lanes: Sequence[str]) -> Roster | None:
    """A roster for an abstracted claim; None where it has no quantifier over the road that is no atom.

    A free lanelet is in the last lane.
    """
    quantifiers = open_quantifiers(claim)
    if not quantifiers:
        return None
    prefix = free_prefix("M", {*lanes, *road_names(claim)})
    missing = max(0, FEWEST_LANES - len(lanes))
    names = (*lanes, *(f"{prefix}{number}" for number in range(1, missing + 1)))
    lanelets = dict.fromkeys(free_lanelets(claim), names[-1])
    if lanelets or any(x.domain.kind in ("lanelets", "zone") for x in quantifiers):
        places = [lane for lane in names for _ in range(LANELETS_A_LANE)]
        lanelets |= {f"{prefix}{missing + k}": lane for k, lane in enumerate(places, 1)}
    return Roster(names, lanelets)


def open_quantifiers(formula: Formula) -> list[f.Some | f.Every]:
    """The quantifiers over the road that are no part of an atom."""
    return [x for x in f.subformulas(formula) if isinstance(x, f.Some | f.Every) and not is_atom(x)]
