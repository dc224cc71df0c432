"""Drives that may show a scenario in a test before any search: shipped drives of the classes of scenarios.

They are proposals, whatever they were found for. Each is tried as it is, and moved towards a drive of the
test, then that drive on other roads. One counts once it is judged exactly for the test and the scenario, in
the definitions at hand.
"""

import json
import re
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cache, cached_property
from typing import Any, Final

from roadproof.engines.search.impossible import at_start
from roadproof.engines.search.placing import judged_as, placed
from roadproof.errors import RoadproofError
from roadproof.evidence.drive_file import SCHEMAS_READ, DriveFile, read_drive
from roadproof.evidence.judged import JudgedDrive
from roadproof.extensions.catalogue.entries import Abstract
from roadproof.extensions.surveys.classify.classes import plan_of, scenarios_in
from roadproof.library.bind import bind, telling_values
from roadproof.library.compose import both
from roadproof.library.loading import bundled_library
from roadproof.library.scenarios import PAIR, SUBJECT, name_of, numbers_of
from roadproof.library.specification import Query
from roadproof.questions.basis import Basis
from roadproof.runtime.archives import archived
from roadproof.semantics.exact.exact import LazyJudge
from roadproof.world.drive import Drive
from roadproof.world.models import load_vehicle
from roadproof.world.motion import monotone_starts
from roadproof.world.signals import KINDS

_CLASS: Final = re.compile(r"(class_\w+)\((.*), L\)")
_DIGITS = 10  # least parts of m and m/s by which drives are moved


@dataclass(frozen=True)
class Candidate:
    """A shipped drive of a class: the ``text`` of its file, and the ``scenarios`` of the class by name."""

    text: str
    vehicles: tuple[str, ...]
    scenarios: frozenset[str]

    @cached_property
    def file(self) -> DriveFile:
        """The drive file, read once."""
        return read_drive(json.loads(self.text), "a shipped drive")


@cache
def candidates() -> tuple[Candidate, ...]:
    """All shipped drives of classes, those of classes with few scenarios first."""
    home, found = bundled_library().select(), dict[str, Candidate]()
    plan = plan_of(home, numbers_of(home))
    for text in archived("classify").values():
        content: Any = json.loads(text)
        shown = _CLASS.fullmatch(content.get("formula", "")) if content["schema"] in SCHEMAS_READ else None
        if shown is not None:
            names = frozenset(map(name_of, scenarios_in(plan, shown[1])))
            found[shown[1]] = Candidate(text, tuple(shown[2].split(", ")), names)
    return tuple(sorted(found.values(), key=lambda x: (len(x.scenarios), x.text)))


@dataclass(frozen=True)
class CandidateDrives:
    """Candidates for drives of a test of which one ``drive`` is known, which shows ``names``.

    ``moved``: each candidate towards that drive; ``judges``: what is known of these, by their places.
    """

    basis: Basis
    entry: Abstract
    drive: JudgedDrive
    names: tuple[str, ...]
    moved: dict[int, tuple[Drive, ...]] = field(default_factory=dict, repr=False)
    judges: dict[tuple[int, int], LazyJudge] = field(default_factory=dict, repr=False)

    def find(self, name: str, query: Query) -> JudgedDrive | None:
        """A drive of the test on which the scenario ``name`` holds, as ``query`` says it, judged."""
        if self.entry.vehicles:
            return None  # shipped drives are those of cars
        wanted = both(self.entry.query, query)
        places = [k for k, x in enumerate(candidates()) if self._may_show(x, name, wanted)]
        try:
            found = (judged for k in places if (judged := self._judged(k, wanted)) is not None)
            return next(found, None) or (self._on_another_road(wanted) if places else None)
        except RoadproofError:  # the test speaks of signals that these drives do not have
            return None

    def _may_show(self, candidate: Candidate, name: str, wanted: Query) -> bool:
        return (
            name in candidate.scenarios
            and not candidate.scenarios.isdisjoint(self.names)
            and {*candidate.vehicles} == {*wanted.vehicles}
        )

    def _judged(self, place: int, wanted: Query) -> JudgedDrive | None:
        file, library, home = candidates()[place].file, self.basis.library, self.basis.specification
        if self.entry.road not in (None, file.road) or not {*wanted.lanes} <= {*file.lanes}:
            return None
        if place not in self.moved:
            self.moved[place] = tuple(_moved_towards(file.drive, self.drive.file.drive))
        values = self.basis.all_values()
        formula = bind(wanted.formula, file.road, file.lanes, values)
        first = at_start(formula)
        for k, drive in enumerate(self.moved[place]):
            judge = self.judges.setdefault((place, k), LazyJudge.on(drive))
            if judge.holds(first) and judge.holds(formula):
                told = telling_values(library, wanted.formula, values)
                here = replace(file, set_name=home.set_name, options=dict(home.options), values=told)
                judged = judged_as(replace(here, drive=drive), wanted, library)
                if judged is not None:
                    return judged
        return None

    def _on_another_road(self, wanted: Query) -> JudgedDrive | None:
        """The drive of the test itself where it shows the scenario, too."""
        file = replace(self.drive.file, values=self.basis.all_values())
        return None if self.entry.road else placed(file, wanted, self.basis.library)


def _moved_towards(drive: Drive, other: Drive) -> Iterator[Drive]:
    """The drive, then at the speed of SV in the other one: with its own gap, that of the other, and smaller
    or larger ones, since RSS distances grow with speed and with its square.
    """
    yield drive
    if not {*PAIR} == {*drive.vehicles} == {*other.vehicles}:
        return
    here, there = drive.vehicles[SUBJECT], other.vehicles[SUBJECT]
    faster = (there.v_lon - here.v_lon).limit_denominator(_DIGITS)
    ratio = (here.v_lon + faster) / here.v_lon if here.v_lon else Fraction(1)
    gap = _gap(drive)
    for wanted in dict.fromkeys((gap, gap * ratio, gap * ratio**2, _gap(other))):
        moved = _moved(drive, faster, (wanted - gap).limit_denominator(_DIGITS))
        if moved != drive and _is_drivable(moved):
            yield moved


def _gap(drive: Drive) -> Fraction:
    first, other = (drive.vehicles[name] for name in PAIR)
    return other.s - first.s


def _moved(drive: Drive, faster: Fraction, ahead: Fraction) -> Drive:
    """All vehicles that much faster (m/s), POV that far ahead (m)."""
    vehicles = {
        name: replace(x, v_lon=x.v_lon + faster, s=x.s if name == SUBJECT else x.s + ahead)
        for name, x in drive.vehicles.items()
    }
    return replace(drive, vehicles=vehicles)


def _is_drivable(drive: Drive) -> bool:
    """Whether all speeds are those of a car."""
    low, high = load_vehicle(KINDS[0]).v_lon
    return all(low <= x.v_lon <= high for m in drive.vehicles.values() for x in monotone_starts(m))
