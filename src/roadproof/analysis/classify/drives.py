"""A drive for each class: one is looked for, and put on roads where the same happens in other zones."""

import tempfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import combinations, pairwise, product
from pathlib import Path
from typing import Any, get_args

from roadproof.analysis.classify.classes import SET_NAME, Class, Plan, where_axis
from roadproof.analysis.classify.text import FILE_NAME, with_classes
from roadproof.analysis.placing import Shown, as_data, show_elsewhere, zones_of
from roadproof.analysis.requests import Asked, Request, ask
from roadproof.effort import Late
from roadproof.evidence.drive_file import read_drive
from roadproof.evidence.judged import judge_file
from roadproof.judge.exact import judge
from roadproof.logic import formula as f
from roadproof.logic.formula import is_state
from roadproof.spec.bind import bind, default_values
from roadproof.spec.elaborate import read_claim
from roadproof.spec.library import Library
from roadproof.verdict import Verdict
from roadproof.witness.impossible import parts
from roadproof.witness.question import Means, usual_road
from roadproof.world.drive import Drive
from roadproof.world.models import load_road
from roadproof.world.road import Lanelet, Road, Zone

MOST_FAILURES = 2
ROAD_OF_ONE_ZONE = """\
name = "main-2 with zones {zone}"
[[lanelet]]
id = "m1"
lane = "main-1"
zone = "{zone}"
attribute = "main"
s = [-inf, inf]
d = [0, 3.5]
[[lanelet]]
id = "m2"
lane = "main-2"
zone = "{zone}"
attribute = "main"
s = [-inf, inf]
d = [3.5, 7]
"""


@dataclass(frozen=True)
class Example:
    """A judged drive of a class, as plain data, or the reason why there is none to show."""

    name: str
    verdict: Verdict
    reason: str
    drive: Mapping[str, Any] | None


def find_examples(asked: Asked, text: str, plan: Plan, classes: Sequence[Class]) -> list[Example]:
    """Examples of classes in which the same happens in different places; ``text`` defines them."""
    _, specification = asked.load()
    library = with_classes(text, specification).library
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / FILE_NAME
        path.write_text(text, "utf-8")
        searching = _Searching(asked, library, (*asked.specs, path), plan, Path(folder))
        return [searching.example(one) for one in classes]


class _Searching:
    def __init__(
        self, asked: Asked, library: Library, specs: tuple[Path, ...], plan: Plan, folder: Path
    ) -> None:
        self.asked = asked
        self.folder = folder
        self.library = library
        self.specs = specs
        self.plan = plan
        self.found: list[Shown] = []
        self.failures = 0

    def example(self, one: Class) -> Example:
        """A drive of a class; UNKNOWN where none was found, or where the clock cut the search off."""
        try:
            return self._find(one)
        except Late as late:
            return Example(one.name, Verdict.UNKNOWN, str(late), None)

    def _find(self, one: Class) -> Example:
        for shown in self.found:
            placed = show_elsewhere(shown, one.formula, self.library) or self._on_patched_road(shown, one)
            if placed is not None:
                return Example(one.name, Verdict.WITNESSED, "", placed.data)
        if self.failures == MOST_FAILURES:
            return Example(one.name, Verdict.UNKNOWN, "no drive was found for the same in other places", None)
        reasons = []
        for road in self._roads(one):
            outcome = ask(self._request(one, road))
            if outcome.drives:
                self.found.append(Shown(one.formula, outcome.drives[0].as_data()))
                return Example(one.name, Verdict.WITNESSED, "", outcome.drives[0].as_data())
            told = outcome.reason or "a proof that the class is empty was found late, and is not kept"
            reasons.append(f"{told} (road {outcome.road}, {self.asked.effort.units:g} units of work)")
        self.failures += 1
        return Example(one.name, Verdict.UNKNOWN, "; ".join(reasons), None)

    def _request(self, one: Class, road: str) -> Request:
        return Request(
            one.formula,
            SET_NAME,
            self.asked.options,
            self.specs,
            {**default_values(self.library), **self.asked.values},
            road,
            horizon=self.asked.horizon,
            means=Means("smooth", effort=self.asked.effort, explain=False),
        )

    def _roads(self, one: Class) -> Iterator[str]:
        """The usual road for the sectors that hold; those that do not hold would ask for their zones too.

        Then, for sectors of one zone that it has beside others, one that has no other: motions have to
        settle in one lanelet within the horizon, for which zones of the usual roads can be too long.
        """
        sectors = one.formula
        if one.where is not None:
            axis = where_axis(self.plan, one.vehicles)
            sectors = " and ".join(axis.rows[number] for number in one.where.holds)
        formula = read_claim(self.library.select(SET_NAME, self.asked.options), sectors).formula
        usual = usual_road(formula).name
        yield usual
        zones = zones_of(formula)
        if len(zones) == 1 and not zones >= {x.zone for x in load_road(usual).lanelets}:
            (zone,) = zones
            path = self.folder / f"{zone}.toml"
            path.write_text(ROAD_OF_ONE_ZONE.format(zone=zone), "utf-8")
            yield str(path)

    def _on_patched_road(self, shown: Shown, one: Class) -> Shown | None:
        """The motions of ``shown`` on their own road with other zones, judged; None where none does."""
        file = replace(read_drive(shown.data, "drive"), formula=one.formula)
        query = read_claim(self.library.select(file.set_name, file.options), one.formula)
        values = {**default_values(self.library), **file.values}
        now = f.conjunction(*(part for part in parts(query.formula) if is_state(part)))
        for road in patched(file.road, file.drive):
            if judge(bind(now, road, file.lanes, values), file.drive).holds:
                placed = replace(file, road=road)
                ruling = judge_file(placed, self.library)
                if ruling.accepted:
                    return Shown(one.formula, as_data(placed, ruling))
        return None


def patched(road: Road, drive: Drive) -> Iterator[Road]:
    """``road`` with new zones that begin and end across it under the vehicles at time 0; lanes are kept.

    Tried are ends under the same part of every vehicle, then any two ends: vehicles may be side by side.
    """
    shares = (Fraction(1, 2), Fraction(1, 4), Fraction(3, 4))
    choices = [sorted({motion.s - x * motion.length for motion in drive.vehicles.values()}) for x in shares]
    choices.append(sorted({end for ends in choices for end in ends}))
    for ends in choices:
        for count in (0, 1, 2):
            for cuts in combinations(ends, count):
                for zones in product(get_args(Zone), repeat=count + 1):
                    if all(a != b for a, b in pairwise(zones)):
                        yield with_zones(road, cuts, zones)


def with_zones(road: Road, cuts: Sequence[Fraction], zones: Sequence[Zone]) -> Road:
    """``road`` cut across at ``cuts`` (m, rising), with ``zones`` from the first piece to the last."""
    bounds = [None, *cuts, None]

    def pieces(lanelet: Lanelet) -> Iterator[Lanelet]:
        for k, zone in enumerate(zones):
            low = _later(lanelet.s[0], bounds[k])
            high = _sooner(lanelet.s[1], bounds[k + 1])
            if low is None or high is None or low < high:
                yield replace(lanelet, id=f"{lanelet.id}-{k + 1}", zone=zone, s=(low, high))

    told = ", ".join(zones)
    return Road(
        f"{road.name} with zones {told}", tuple(x for y in road.lanelets for x in pieces(y)), road.adjacent
    )


def _later(one: Fraction | None, other: Fraction | None) -> Fraction | None:
    return other if one is None else one if other is None else max(one, other)


def _sooner(one: Fraction | None, other: Fraction | None) -> Fraction | None:
    return other if one is None else one if other is None else min(one, other)
