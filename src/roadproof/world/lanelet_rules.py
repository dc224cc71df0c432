"""Rules that the lanelets of a road obey, and adjacency of lanes (semantics §4)."""

from fractions import Fraction
from itertools import combinations, pairwise

from roadproof.errors import InputError
from roadproof.world.road import Lanelet, adjacency


def check_lanelets(lanelets: tuple[Lanelet, ...], where: str) -> None:
    """Raise ``InputError`` unless ids are unique and each lane is one chain with one attribute."""
    seen: set[str] = set()
    for lanelet in lanelets:
        if lanelet.id in seen:
            raise InputError(f"{where}: lanelet id '{lanelet.id}' is given twice")
        seen.add(lanelet.id)
    for lane in dict.fromkeys(x.lane for x in lanelets):
        ours = (x for x in lanelets if x.lane == lane)
        chain = sorted(ours, key=lambda x: (x.s[0] is not None, x.s[0] or Fraction(0)))
        for before, after in pairwise(chain):
            if before.attribute != after.attribute:
                raise InputError(
                    f"{where}: lane '{lane}' has lanelets of attributes {before.attribute} and "
                    f"{after.attribute}; a lane has one attribute"
                )
            if before.s[1] is None or after.s[0] is None or before.s[1] != after.s[0]:
                raise InputError(
                    f"{where}: in lane '{lane}', lanelet '{after.id}' does not begin where '{before.id}' ends"
                )
            if before.d[0] >= after.d[1] or after.d[0] >= before.d[1]:
                raise InputError(
                    f"{where}: in lane '{lane}', '{before.id}' and '{after.id}' do not meet across the road"
                )


def shared_boundaries(lanelets: tuple[Lanelet, ...]) -> frozenset[frozenset[str]]:
    """Return the pairs of lanes that have lanelets with a common boundary line, next to each other in s."""
    return adjacency(
        (a.lane, b.lane)
        for a, b in combinations(lanelets, 2)
        if a.lane != b.lane and (a.d[1] == b.d[0] or b.d[1] == a.d[0]) and _alongside(a, b)
    )


def _alongside(a: Lanelet, b: Lanelet) -> bool:
    starts = [x.s[0] for x in (a, b) if x.s[0] is not None]
    ends = [x.s[1] for x in (a, b) if x.s[1] is not None]
    return not starts or not ends or max(starts) < min(ends)
