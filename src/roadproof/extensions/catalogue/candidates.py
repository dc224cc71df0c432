"""Shipped drives of classes as candidates for drives of a test that show a scenario, before any search.

Each is tried unchanged, then moved towards a drive of the test; then that drive is tried on other roads. A
candidate counts once it is judged exactly for test and scenario, with the definitions of the question.
"""

import json
import re
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cache, cached_property
from typing import Any, Final

from roadproof.core_record import DRIVES
from roadproof.engines.search.impossible import at_start
from roadproof.engines.search.placing import judge_as, place_on_known_roads
from roadproof.errors import RoadproofError
from roadproof.evidence.drive_file import DriveFile, read_drive
from roadproof.evidence.judged import JudgedDrive
from roadproof.extensions.catalogue.entries import AbstractTest
from roadproof.extensions.exchange.export.subject import monotone_starts
from roadproof.extensions.surveys.classify.classes import plan_of, scenarios_in
from roadproof.library.bind import bind, used_values
from roadproof.library.compose import both
from roadproof.library.loading import bundled_library
from roadproof.library.scenarios import PAIR, SUBJECT, name_of, numbers_of
from roadproof.library.specification import Query
from roadproof.questions.basis import Basis
from roadproof.runtime.archives import shipped_answers
from roadproof.semantics.exact.judging import LazyJudge
from roadproof.world.drive import Drive
from roadproof.world.models import load_vehicle
from roadproof.world.signals import KINDS

_CLASS: Final = re.compile(r"(class_\w+)\((.*), L\)")
_LARGEST_DENOMINATOR = 10  # of the distances (m) and speeds (m/s) by which drives are moved


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
    """Return all shipped drives of classes, those of classes with few scenarios first."""
    home, drives = bundled_library().select(), dict[str, Candidate]()
    plan = plan_of(home, numbers_of(home))
    for text in shipped_answers("classify").values():
        content: Any = json.loads(text)
        shown = _CLASS.fullmatch(content.get("formula", "")) if content["schema"] in DRIVES else None
        if shown is not None:
            names = frozenset(map(name_of, scenarios_in(plan, shown[1])))
            drives[shown[1]] = Candidate(text, tuple(shown[2].split(", ")), names)
    return tuple(sorted(drives.values(), key=lambda x: (len(x.scenarios), x.text)))


@dataclass(frozen=True)
class CandidateDrives:
    """The candidates for further drives of a test; ``drive``: a known drive of it, which shows ``names``.

    ``moved``: each candidate moved towards that drive; ``judges``: the judges of these by their places.
    """

    basis: Basis
    entry: AbstractTest
    drive: JudgedDrive
    names: tuple[str, ...]
    moved: dict[int, tuple[Drive, ...]] = field(default_factory=dict, repr=False)
    judges: dict[tuple[int, int], LazyJudge] = field(default_factory=dict, repr=False)

    def find(self, name: str, query: Query) -> JudgedDrive | None:
        """Return a judged drive of the test on which ``query`` holds, the formula of a scenario ``name``."""
        if self.entry.vehicles:
            return None  # shipped drives are those of cars
        combined = both(self.entry.query, query)
        places = [k for k, x in enumerate(candidates()) if self._may_show(x, name, combined)]
        try:
            drives = (judged for k in places if (judged := self._judged(k, combined)) is not None)
            return next(drives, None) or (self._on_another_road(combined) if places else None)
        except RoadproofError:  # the test speaks of signals that these drives do not have
            return None

    def _may_show(self, candidate: Candidate, name: str, combined: Query) -> bool:
        return (
            name in candidate.scenarios
            and not candidate.scenarios.isdisjoint(self.names)
            and {*candidate.vehicles} == {*combined.vehicles}
        )

    def _judged(self, place: int, combined: Query) -> JudgedDrive | None:
        file, library, home = candidates()[place].file, self.basis.library, self.basis.specification
        if self.entry.road not in (None, file.road) or not {*combined.lanes} <= {*file.lanes}:
            return None
        if place not in self.moved:
            self.moved[place] = tuple(_moved_towards(file.drive, self.drive.file.drive))
        values = self.basis.all_values()
        formula = bind(combined.formula, file.road, file.lanes, values)
        first = at_start(formula)
        for k, drive in enumerate(self.moved[place]):
            judge = self.judges.setdefault((place, k), LazyJudge.on(drive))
            if judge.holds(first) and judge.holds(formula):
                used = used_values(library, combined.formula, values)
                here = replace(file, set_name=home.set_name, options=dict(home.options), values=used)
                judged = judge_as(replace(here, drive=drive), combined, library)
                if judged is not None:
                    return judged
        return None

    def _on_another_road(self, combined: Query) -> JudgedDrive | None:
        """Return the known drive of the test, placed on another road on which it shows the scenario too."""
        file = replace(self.drive.file, values=self.basis.all_values())
        return None if self.entry.road else place_on_known_roads(file, combined, self.basis.library)


def _moved_towards(drive: Drive, other: Drive) -> Iterator[Drive]:
    """Yield the drive, then the drive at the speed of SV in the other one, with several gaps.

    The gaps are its own, that of the other, and larger or smaller ones, since RSS distances grow with speed
    and with its square.
    """
    yield drive
    if not {*PAIR} == {*drive.vehicles} == {*other.vehicles}:
        return
    here, there = drive.vehicles[SUBJECT], other.vehicles[SUBJECT]
    faster = (there.v_lon - here.v_lon).limit_denominator(_LARGEST_DENOMINATOR)
    ratio = (here.v_lon + faster) / here.v_lon if here.v_lon else Fraction(1)
    gap = _gap(drive)
    for new_gap in dict.fromkeys((gap, gap * ratio, gap * ratio**2, _gap(other))):
        moved = _moved(drive, faster, (new_gap - gap).limit_denominator(_LARGEST_DENOMINATOR))
        if moved != drive and _is_drivable(moved):
            yield moved


def _gap(drive: Drive) -> Fraction:
    """Return how far the front of POV is ahead of that of SV at the start (m)."""
    first, other = (drive.vehicles[name] for name in PAIR)
    return other.s - first.s


def _moved(drive: Drive, faster: Fraction, ahead: Fraction) -> Drive:
    """Return the drive with all vehicles ``faster`` by so much (m/s), and POV so far ``ahead`` (m)."""
    vehicles = {
        name: replace(x, v_lon=x.v_lon + faster, s=x.s if name == SUBJECT else x.s + ahead)
        for name, x in drive.vehicles.items()
    }
    return replace(drive, vehicles=vehicles)


def _is_drivable(drive: Drive) -> bool:
    """Return whether all speeds are those of a car."""
    low, high = load_vehicle(KINDS[0]).v_lon
    return all(low <= x.v_lon <= high for m in drive.vehicles.values() for x in monotone_starts(m))
