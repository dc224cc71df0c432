"""What is claimed of the gaps of a spec set: that there are none, or that there are some of a class."""

from collections.abc import Callable, Collection, Sequence
from dataclasses import field, replace
from fractions import Fraction
from functools import partial
from typing import Any, TypeVar

from roadproof.evidence.claim import Claim, Exists, Judge, On, claim_of, valid_under
from roadproof.evidence.drive_file import DriveFile
from roadproof.extensions.surveys.coverage.classes import (
    GapClasses,
    GapGroup,
    Part,
    caught,
    claims_of,
    exchanged,
    in_either_role,
    missed,
    near_miss,
    starts_in,
    two_vehicle_numbers,
    with_only,
)
from roadproof.extensions.surveys.coverage.found import Trials, mixed_definitions, parent_of, trial_without
from roadproof.library.compose import both, conjuncts, either, eventually, implication, negation
from roadproof.library.elaborate import read_claim
from roadproof.library.scenarios import LANE, PAIR, Scenario, applied, danger
from roadproof.library.specification import Query, Specification
from roadproof.logic.restore import as_syntax
from roadproof.logic.show import text
from roadproof.questions.basis import Basis
from roadproof.runtime.canonical import digest
from roadproof.runtime.records import dataclass
from roadproof.world.drive import Drive
from roadproof.world.road import Road

T = TypeVar("T")


class Made(dict[object, Any]):
    """What was put together once; other processes put it together again."""

    def __reduce__(self) -> "tuple[type[Made], tuple[()]]":
        return Made, ()

    def once(self, key: object, make: Callable[[], T]) -> T:
        """Return what is made for a key, once."""
        if key not in self:
            self[key] = make()
        made: T = self[key]
        return made


@dataclass(frozen=True)
class GapClaims:
    """Claims about the gaps of a set; ``wider``: extensions of it, each of the one before.

    ``numbers``: the scenarios that count, all of the set where None.
    """

    basis: Basis
    wider: tuple[str, ...] = ()
    numbers: tuple[int, ...] | None = None
    made: Made = field(default_factory=Made, compare=False, repr=False)

    @property
    def home(self) -> Specification:
        """The definitions that all is read with."""
        return self.basis.specification

    @property
    def counted(self) -> Basis:
        """The basis with the scenarios that count."""
        if self.numbers is None:
            return self.basis
        only = self.made.once("counted", partial(with_only, self.home, self.numbers))
        return replace(self.basis, specification=only, sets=())

    @property
    def classes(self) -> GapClasses:
        """Which classes a drive belongs to."""
        return self.made.once("classes", lambda: GapClasses(self.counted))

    @property
    def trials(self) -> Trials:
        """The judge of drives under wider sets."""
        return self.made.once("trials", lambda: Trials(self.counted, self.wider))

    @property
    def groups(self) -> dict[str, GapGroup]:
        """The classes in groups, by the names under which their claims are asked."""
        return self.made.once("groups", lambda: {group_name(x): x for x in self.classes.groups()})

    @property
    def covered(self) -> dict[str, Claim]:
        """Claims that together say that there is no gap, by name."""
        queries = self.made.once("queries", lambda: claims_of(self.counted.specification))
        made = self.made.once("covered", lambda: [valid_under(self.home, x) for x in queries])
        return {f"covered-{k}": x for k, x in enumerate(made, 1)}

    # --- definitions that a set needs -------------------------------------------------------------

    def without(self, definition: str) -> list[Query]:
        """What a drive satisfies that is missed without a definition; then that there is no such drive.

        Definitions are written out, since no shipped set is the one without it.
        """

        def make() -> list[Query]:
            trial = trial_without(self.basis, definition)
            said = [missed(trial, two_vehicle_numbers(trial)), *claims_of(trial)]
            return [read_claim(self.home, text(as_syntax(x.formula, expand=True))) for x in said]

        return self.made.once(("without", definition), make)

    # --- what is judged of drives -----------------------------------------------------------------

    def judged(self, judge: Judge, of: object) -> Claim:
        """Return the claim what a judge shows, where ``of`` says which drives it looks at."""
        claim = self.made.once("true", lambda: read_claim(self.home, "true"))
        files = (digest(of),)
        return claim_of(self.home, claim, On(files, self._rests, judge), {})

    @property
    def _rests(self) -> str:
        """A digest of all on which it depends what a drive is: gaps, near misses, other sets, and values.

        A set put together takes some definitions of another one, so every definition that it may be made of
        counts.
        """

        def make() -> str:
            home, classes = self.home, self.classes
            sets = [home.in_set(x) for x in (home.set_name, *self.wider)]
            if parent_of(home):
                sets.append(home.in_set(parent_of(home)))
            bodies = [sorted(mixed_definitions(home, x).items()) for x in sets]
            near = [(x.key, x.scenario, x.without.formula) for x in classes.every]
            freedom = home.library.freedom, bool(home.library.files)
            asked = classes.missed(classes.numbers).formula, near, bodies, self.wider, freedom
            return digest(asked, home.options, self.basis.all_values())

        return self.made.once("rests", make)

    # --- drives -----------------------------------------------------------------------------------

    def sought(self, part: Part | None, road: Road, first: str = "") -> Claim:
        """The claim that there is a gap of a class on a road; with ``first`` one that it catches first."""

        def make() -> Claim:
            query = self.query(part, self.classes.numbers_on(road), first)
            vehicles = {n: x for n, x in self.basis.vehicles.items() if not n or n in query.vehicles}
            mode = Exists(
                road=road,
                vehicles=vehicles,
                horizon=self.basis.horizon,
                objective=self.basis.objective,
                explain=False,
            )
            return claim_of(self.home, query, mode, self.basis.values)

        return self.made.once(("sought", part and part.key, part and part.scenario, road, first), make)

    def shown(self, part: Part | None, file: DriveFile) -> Claim:
        """The claim that a drive is a gap of a class, where it is."""
        query = self.query(part, self.classes.numbers)
        return self.given(query, file.road, file.drive, file.lanes.get(LANE), file.horizon)

    def given(self, query: Query, road: Road, drive: Drive, lane: str | None, horizon: Fraction) -> Claim:
        """The claim that a formula holds on a drive."""
        lanes = {} if lane is None else {LANE: lane}
        mode = Exists(road=road, lanes=lanes, horizon=horizon, explain=False, like=drive)
        return claim_of(self.home, query, mode, self.basis.values)

    def query(self, part: Part | None, numbers: tuple[int, ...], first: str = "") -> Query:
        """What a gap of the class satisfies; with ``first`` one that this set is the first to catch."""

        def make() -> Query:
            asked = [*conjuncts(self.classes.missed(numbers))]
            if part is None:
                asked += [negation(near_miss(p)) for p in self._finest(numbers)]
            else:
                asked += conjuncts(part.without)
            if first:
                before = self.wider[: self.wider.index(first)]
                catches = {name: caught(self.home, numbers, name) for name in (*before, first)}
                asked += [catches[first], *(negation(catches[name]) for name in before)]
            return both(*asked)

        return self.made.once(("query", part and (part.key, part.scenario), numbers, first), make)

    def on(self, part: Part | None, numbers: Collection[int]) -> list[Part | None]:
        """The counterparts of a part among these scenarios."""
        if part is None:
            return [None]
        return [p for p, _ in self.classes.counterparts(part) if p.scenario in numbers]

    # --- proofs -----------------------------------------------------------------------------------

    def empty(self, part: Part | None) -> list[tuple[Claim, Callable[[], Claim]]]:
        """Each way to say that a class is empty: in the first road sector, and in every one."""

        def make() -> list[tuple[Claim, Callable[[], Claim]]]:
            ways = [self._all_are_near()] if part is None else [self._is_redundant(part), self._no_gaps(part)]
            return [(valid_under(self.home, x[0]), partial(self._every, tuple(x))) for x in ways]

        return self.made.once(("empty", part and part.key), make)

    def _every(self, claims: tuple[Query, ...]) -> Claim:
        return valid_under(self.home, both(*claims))

    def _is_redundant(self, part: Part) -> list[Query]:
        """That the scenario holds without the part only where it holds, a claim for each road sector."""
        return [
            implication(x.without, applied(self.home, Scenario(x.scenario, self.home.set_name)))
            for x, _ in self.classes.counterparts(part)
        ]

    def _no_gaps(self, part: Part) -> list[Query]:
        """That near misses of ``part`` are no gaps, in either role: claims for each road sector.

        Danger is the same in either order, but that is not taken for granted.
        """
        claims = []
        for counterpart, sector in self.classes.counterparts(part):
            some = either(*in_either_role(self.home, sector))
            for pair in (PAIR, PAIR[::-1]):
                later = eventually(danger(self.home, *pair))
                claims.append(implication(both(*conjuncts(counterpart.without), later), some))
        return claims

    def _all_are_near(self) -> list[Query]:
        """That a gap is a near miss but for a single condition, a claim for each road sector."""
        claims = []
        for sector in self.classes.sectors:
            near = [x for p in self._finest(sector) for x in (p.without, exchanged(p.without))]
            some = either(*in_either_role(self.home, sector), *near)
            claims.append(implication(starts_in(self.home, sector), some))
        return claims

    def _finest(self, numbers: Sequence[int]) -> list[Part]:
        """The parts of these scenarios that have no parts themselves."""
        return [part for number in numbers for part in self.classes.by_number[number] if part.finest]


def group_name(group: GapGroup) -> str:
    """Return the word for a group in names of claims."""
    return group.title.replace(" ", "-")
