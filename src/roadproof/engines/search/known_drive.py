"""A known drive, judged for many formulas; shared parts are judged once."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import permutations

from roadproof.engines.search.placing import (
    judge_as,
    place_on_known_roads,
    place_on_roads,
    with_patched_zones,
)
from roadproof.evidence.answer import assumed_by, deciding_formula
from roadproof.evidence.claim import Claim, Exists
from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.judged import JudgedDrive
from roadproof.library.bind import bind, used_values, values_with, without_empty_windows
from roadproof.library.compose import negation
from roadproof.library.motion import under_limits
from roadproof.library.specification import Query
from roadproof.logic.formula import Formula
from roadproof.semantics.exact.judging import LazyJudge
from roadproof.world.drive import Drive


@dataclass(frozen=True)
class KnownDrive:
    """A judged drive and its judge, with a cache."""

    judged: JudgedDrive

    @cached_property
    def _judge(self) -> LazyJudge:
        return LazyJudge.on(self.judged.file.drive)

    @cached_property
    def _others(self) -> dict[tuple[tuple[str, str], ...], tuple[DriveFile, LazyJudge]]:
        """The drive with its vehicles in other roles, each with its judge."""
        return {}

    def has_vehicles_of(self, claim: Claim) -> bool:
        """Return whether the drive has all vehicles that a claim names."""
        return {*claim.vehicles} <= {*self.judged.file.drive.vehicles}

    def moves_as(self, other: JudgedDrive) -> bool:
        """Return whether another drive has these motions on this road, with these lanes and values."""
        return is_same_motion(self.judged.file, other.file) and self.judged.file.values == other.file.values

    def refutes(self, claim: Claim) -> bool:
        """Return whether a claim about all traces is false on the drive where it is."""
        file = self.judged.file
        if not ({*claim.vehicles} <= {*file.drive.vehicles} and {*claim.lanes} <= {*file.lanes}):
            return False
        return self._holds(deciding_formula(claim), claim)

    def _holds(self, formula: Formula, claim: Claim) -> bool:
        file = with_values_of(self.judged.file, claim)
        values = values_with(claim.home.library, file.values)
        return self._judge.holds(bind(formula, file.road, file.lanes, values))

    def refutation(self, claim: Claim) -> JudgedDrive | None:
        """Return the drive as one on which a claim is false; None where the judge rejects that."""
        return judge_as(with_values_of(self.judged.file, claim), negated_claim(claim), claim.home.library)

    def here(self, claim: Claim) -> JudgedDrive | None:
        """Return the drive at its place, with a claim's values, as a drive that answers it, or None."""
        file = file_for_claim(self.judged.file, claim)
        if not ({*claim.vehicles} <= {*file.drive.vehicles} and {*claim.lanes} <= {*file.lanes}):
            return None
        values = values_with(claim.home.library, file.values)
        formula = without_empty_windows(bind(claim.formula, file.road, file.lanes, values))
        if not self._judge.holds(formula):
            return None
        return judge_as(file, claim.query, claim.home.library)

    def elsewhere(self, query: Query, claim: Claim, cut: bool = False) -> JudgedDrive | None:
        """Return the drive on another road on which it satisfies ``query``, or None.

        ``cut``: also on its own road with other zones.
        """
        file, library = with_values_of(self.judged.file, claim), claim.home.library
        shown = place_on_known_roads(file, query, library, judge=self._judge)
        if shown is None and cut:
            return place_on_roads(
                file, query, library, with_patched_zones(file.road, file.drive), self._judge
            )
        return shown

    def recast(self, claim: Claim, moved: bool) -> JudgedDrive | None:
        """Return the drive with its vehicles in other roles, in which it shows a claim; None if in none.

        ``moved``: also on other roads.
        """
        library = claim.home.library
        for cast, judge in self._casts(claim.vehicles):
            file = with_values_of(cast, claim)
            if moved:
                shown = place_on_known_roads(file, claim.query, library, judge=judge)
            else:
                shown = place_on_roads(file, claim.query, library, (file.road,), judge)
            if shown is not None:
                return shown
        return None

    def _casts(self, vehicles: tuple[str, ...]) -> Iterator[tuple[DriveFile, LazyJudge]]:
        """Yield the drive with each choice of its vehicles for others; those that it lacks are far behind."""
        mine, names = tuple(self.judged.file.drive.vehicles), tuple(vehicles)
        if len(mine) < len(names):
            choices = (dict(zip(x, mine, strict=True)) for x in permutations(names, len(mine)))
        else:
            choices = (dict(zip(names, x, strict=True)) for x in permutations(mine, len(names)))
        for roles in choices:
            yield self._cast(roles, names)

    def _cast(self, roles: Mapping[str, str], names: tuple[str, ...]) -> tuple[DriveFile, LazyJudge]:
        key = (*roles.items(), *((x, "") for x in names if x not in roles))
        if key not in self._others:
            file = recast(self.judged.file, roles, names)
            self._others[key] = file, LazyJudge.on(file.drive)
        return self._others[key]


def recast(file: DriveFile, roles: Mapping[str, str], names: Iterable[str]) -> DriveFile:
    """Return a drive in which each of ``roles`` is played by one of its vehicles.

    Those of ``names`` that none plays are far behind all others.
    """
    missing = sorted({*names} - {*roles})
    return replace(file, drive=file.drive.cast(roles).followed_by(missing))


def is_same_motion(one: DriveFile, other: DriveFile) -> bool:
    """Return whether two files have the same motions on the same road, with the same lanes."""
    return (one.drive, one.road, one.lanes) == (other.drive, other.road, other.lanes)


def with_values_of(file: DriveFile, claim: Claim) -> DriveFile:
    """Return a drive file with the values that a claim gives to parameters: its own file may lack them."""
    return replace(file, values={**file.values, **claim.values})


def file_for_claim(file: DriveFile, claim: Claim) -> DriveFile:
    """Return the motions as a file for a claim: with its values and its time without overlap."""
    library = claim.home.library
    values = values_with(library, {x.name: x.value for x in claim.parameters})
    apart = claim.mode.apart if isinstance(claim.mode, Exists) else None
    return replace(
        file,
        scenario=None,
        formula=claim.query.text,
        values=used_values(library, claim.formula, values),
        horizon=file.horizon if apart is None else max(file.horizon, apart),
    )


def drive_of_claim(claim: Claim, mode: Exists, drive: Drive) -> JudgedDrive | None:
    """Return the drive that a claim specifies, on its road; None where the formula is false there."""
    home, lanes = claim.home, dict(mode.lanes)
    assert mode.road is not None
    file = DriveFile(None, home.set_name, "", mode.horizon, lanes, {}, home.options, mode.road, drive)
    return judge_as(
        file_for_claim(replace(file, overlaps_allowed=mode.collisions), claim), claim.query, home.library
    )


def negated_claim(claim: Claim) -> Query:
    """Return the negation of a claim within the limits that it assumes."""
    return negation(under_limits(claim.home, claim.query, assumed_by(claim)))


def first_refuting(claim: Claim, drives: Iterable[KnownDrive]) -> JudgedDrive | None:
    """Return the first drive on which a claim is false, as evidence of that."""
    refuting = (x.refutation(claim) for x in drives if x.refutes(claim))
    return next((x for x in refuting if x is not None), None)
