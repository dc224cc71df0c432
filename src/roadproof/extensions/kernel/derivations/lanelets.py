"""The numbers of the lanelets that names and domains of a formula denote on a road."""

from collections.abc import Mapping
from typing import TypeAlias

from roadproof.extensions.kernel.derivations.parts import NoDerivationError
from roadproof.logic import formula as f
from roadproof.reasons import ReasonKind
from roadproof.runtime.records import dataclass
from roadproof.world.road import Lanelet, Road

Scope: TypeAlias = Mapping[str, int]
"""The number of the lanelet that each bound variable denotes; it stands for its lane, too."""


@dataclass(frozen=True)
class LaneletNumbers:
    """A road, and the lane for each free name of a lane."""

    road: Road
    lanes: Mapping[str, str]

    def number(self, name: str, scope: Scope) -> int:
        """Return the number of the lanelet that a name denotes; of a lane, its first one."""
        if name in scope:
            return scope[name]
        lane = self.lanes.get(name, name)
        for number, lanelet in enumerate(self.road.lanelets):
            if lanelet.lane == lane:
                return number
        raise NoDerivationError(ReasonKind.NO_LANE(name))

    def members(self, domain: f.Domain, scope: Scope) -> list[int]:
        """Return the numbers of the lanelets in a domain."""
        lanelets = list(enumerate(self.road.lanelets))
        if domain.kind == "lanes":
            return [k for k, _ in lanelets]
        if domain.kind == "zone":
            return [k for k, x in lanelets if x.zone == domain.of]
        lane = self.road.lanelets[self.number(domain.of, scope)].lane
        if domain.kind == "lanelets":
            return [k for k, x in lanelets if x.lane == lane]
        return [k for k, x in lanelets if x.lane in self.road.adjacent_lanes(lane)]

    def lanelet(self, name: str, scope: Scope) -> Lanelet:
        """Return the lanelet that a name denotes. Raises ``NoDerivationError``."""
        return self.road.lanelets[self.number(name, scope)]
