"""The pairs of vehicles that violate the RSS distance, counted over recordings whose windows overlap.

The unit is a pair of vehicles on the road, not a pair of a file: rows of two windows are one pair where they
share a moment (``repeats``), directly or through further windows. A pair matches where one of its traces
does, in whichever window. So neither figure depends on the order of the windows.
"""

from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Literal, TypeAlias

from roadproof.extensions.traffic.evaluate.evaluate import Findings

VehiclePair = tuple[int, int]
Degree: TypeAlias = Literal["match", "surely", "perhaps"]
"""How pairs match: as places are, however they are off, or as they may be off."""
Label = tuple[int, str, str, Degree]
"""An index of minDanger, a set, and a road sector; "" for all sectors together."""


@dataclass
class ViolatingPairs:
    """Disjoint sets of rows: each set is one pair of vehicles, however many windows show it."""

    count: int = 0
    parent: list[int] = field(default_factory=list)
    row_of_moment: dict[int, int] = field(default_factory=dict)
    matched: defaultdict[Label, set[int]] = field(default_factory=lambda: defaultdict(set))

    def add(self, findings: Findings) -> dict[VehiclePair, int]:
        """Add the violating pairs of one recording, repeats included; return the row of each."""
        moments = {(x.first, x.second): x.keys for x in findings.seen if x.violating}
        pairs = {**dict.fromkeys(findings.violating, ()), **moments}
        return {pair: self._add(keys) for pair, keys in pairs.items()}

    def _add(self, moments: Iterable[int]) -> int:
        row = len(self.parent)
        self.parent.append(row)
        self.count += 1
        for moment in filter(None, moments):
            self._join(row, self.row_of_moment.setdefault(moment, row))
        return row

    def _root(self, row: int) -> int:
        while self.parent[row] != row:
            self.parent[row] = self.parent[self.parent[row]]
            row = self.parent[row]
        return row

    def _join(self, one: int, other: int) -> None:
        into, gone = sorted((self._root(one), self._root(other)))
        if into == gone:
            return
        self.parent[gone] = into
        self.count -= 1
        for rows in self.matched.values():
            if gone in rows:
                rows.remove(gone)
                rows.add(into)

    def match(self, column: Label, rows: Iterable[int]) -> int:
        """Note that these rows match in a column; return how many pairs do so far."""
        self.matched[column].update(map(self._root, rows))
        return len(self.matched[column])
