"""The claims about the gaps of a spec set: it has none, a class has one, or a class is empty."""

from collections.abc import Callable, Collection, Sequence
from dataclasses import field, replace
from fractions import Fraction
from functools import partial
from typing import Any, TypeVar

from roadproof.evidence.assuming import valid_under
from roadproof.evidence.claim import Claim, Exists, On, TraceJudge, claim_of
from roadproof.evidence.drive_file import DriveFile
from roadproof.extensions.surveys.composition import split_conjunction
from roadproof.extensions.surveys.coverage.classes import (
    GapClasses,
    GapGroup,
    ScenarioPart,
    catch_formula,
    claims_of,
    gap_formula,
    in_either_role,
    near_miss,
    starts_in,
    swap_roles,
    two_vehicle_numbers,
    with_only,
)
from roadproof.extensions.surveys.coverage.gap_drives import (
    Trials,
    mixed_definitions,
    parent_of,
    trial_without,
)
from roadproof.library.compose import both, either, eventually, implication, negation
from roadproof.library.elaborate import read_claim
from roadproof.library.scenarios import LANE, PAIR, Scenario, apply_scenario, danger
from roadproof.library.specification import Query, Specification
from roadproof.logic.restore import as_syntax
from roadproof.logic.show import text
from roadproof.questions.basis import Basis
from roadproof.runtime.canonical import digest
from roadproof.runtime.records import dataclass
from roadproof.world.drive import Drive
from roadproof.world.road import Road

T = TypeVar("T")


class FormulaCache(dict[object, Any]):
    """A cache of formulas that are composed once; other processes compose them again."""

    def __reduce__(self) -> "tuple[type[FormulaCache], tuple[()]]":
        return FormulaCache, ()

    def once(self, key: object, make: Callable[[], T]) -> T:
        """Return the value of a key, which ``make`` computes once."""
        if key not in self:
            self[key] = make()
        cache: T = self[key]
        return cache


@dataclass(frozen=True)
class GapClaims:
    """The claims about the gaps of a set; ``wider``: sets that extend it, each the one before.

    ``numbers``: the scenarios that count; all of the set if None.
    """

    basis: Basis
    wider: tuple[str, ...] = ()
    numbers: tuple[int, ...] | None = None
    cache: FormulaCache = field(default_factory=FormulaCache, compare=False, repr=False)

    @property
    def home(self) -> Specification:
        """The definitions of the set."""
        return self.basis.specification

    @property
    def counted_basis(self) -> Basis:
        """The basis with the scenarios that count."""
        if self.numbers is None:
            return self.basis
        only = self.cache.once("counted", partial(with_only, self.home, self.numbers))
        return replace(self.basis, specification=only, sets=())

    @property
    def classes(self) -> GapClasses:
        """The classes of gaps, which tell the classes of a drive."""
        return self.cache.once("classes", lambda: GapClasses(self.counted_basis))

    @property
    def trials(self) -> Trials:
        """The judge of drives under wider sets."""
        return self.cache.once("trials", lambda: Trials(self.counted_basis, self.wider))

    @property
    def groups(self) -> dict[str, GapGroup]:
        """The classes in groups, by the names under which their claims are asked."""
        return self.cache.once("groups", lambda: {group_name(x): x for x in self.classes.groups()})

    @property
    def coverage_claims(self) -> dict[str, Claim]:
        """Claims that together say that there is no gap, by name."""
        queries = self.cache.once("queries", lambda: claims_of(self.counted_basis.specification))
        cache = self.cache.once("covered", lambda: [valid_under(self.home, x) for x in queries])
        return {f"covered-{k}": x for k, x in enumerate(cache, 1)}

    # --- definitions that a set needs -------------------------------------------------------------

    def need_formulas(self, definition: str) -> list[Query]:
        """Return the formula of a drive that is missed without a definition, and the claims that none exists.

        Definitions are written out, because no shipped set lacks just this one.
        """

        def make() -> list[Query]:
            trial = trial_without(self.basis, definition)
            queries = [gap_formula(trial, two_vehicle_numbers(trial)), *claims_of(trial)]
            return [read_claim(self.home, text(as_syntax(x.formula, expand=True))) for x in queries]

        return self.cache.once(("without", definition), make)

    # --- what is judged of drives -----------------------------------------------------------------

    def judgement_claim(self, judge: TraceJudge, of: object) -> Claim:
        """Return the claim that a judge answers; ``of`` identifies the drives that it judges."""
        claim = self.cache.once("true", lambda: read_claim(self.home, "true"))
        files = (digest(of),)
        return claim_of(self.home, claim, On(files, self._content_digest, judge), {})

    @property
    def _content_digest(self) -> str:
        """A digest of everything that judgements depend on: gaps, near misses, other sets, and values.

        A mixed set takes some definitions from another set, so all definitions of both count.
        """

        def make() -> str:
            home, classes = self.home, self.classes
            sets = [home.in_set(x) for x in (home.set_name, *self.wider)]
            if parent_of(home):
                sets.append(home.in_set(parent_of(home)))
            bodies = [sorted(mixed_definitions(home, x).items()) for x in sets]
            near = [(x.key, x.scenario, x.without.formula) for x in classes.every]
            freedom = home.library.freedom, bool(home.library.files)
            content = classes.gap_formula(classes.numbers).formula, near, bodies, self.wider, freedom
            return digest(content, home.options, self.basis.all_values())

        return self.cache.once("rests", make)

    # --- drives -----------------------------------------------------------------------------------

    def gap_exists(self, part: ScenarioPart | None, road: Road, first: str = "") -> Claim:
        """Return the claim that a class has a gap on a road; ``first``: the set that catches it first."""

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

        return self.cache.once(("sought", part and part.key, part and part.scenario, road, first), make)

    def gap_on(self, part: ScenarioPart | None, file: DriveFile) -> Claim:
        """Return the claim that a drive is a gap of a class, on its own road."""
        query = self.query(part, self.classes.numbers)
        return self.holds_on(query, file.road, file.drive, file.lanes.get(LANE), file.horizon)

    def holds_on(self, query: Query, road: Road, drive: Drive, lane: str | None, horizon: Fraction) -> Claim:
        """Return the claim that a formula holds on a drive."""
        lanes = {} if lane is None else {LANE: lane}
        mode = Exists(road=road, lanes=lanes, horizon=horizon, explain=False, like=drive)
        return claim_of(self.home, query, mode, self.basis.values)

    def query(self, part: ScenarioPart | None, numbers: tuple[int, ...], first: str = "") -> Query:
        """Return the formula of a gap of the class; ``first``: the set that catches it first."""

        def make() -> Query:
            parts = [*split_conjunction(self.classes.gap_formula(numbers))]
            if part is None:
                parts += [negation(near_miss(p)) for p in self._finest(numbers)]
            else:
                parts += split_conjunction(part.without)
            if first:
                before = self.wider[: self.wider.index(first)]
                catches = {name: catch_formula(self.home, numbers, name) for name in (*before, first)}
                parts += [catches[first], *(negation(catches[name]) for name in before)]
            return both(*parts)

        return self.cache.once(("query", part and (part.key, part.scenario), numbers, first), make)

    def on(self, part: ScenarioPart | None, numbers: Collection[int]) -> list[ScenarioPart | None]:
        """Return the counterparts of a part among these scenarios."""
        if part is None:
            return [None]
        return [p for p, _ in self.classes.counterparts(part) if p.scenario in numbers]

    # --- proofs -----------------------------------------------------------------------------------

    def empty(self, part: ScenarioPart | None) -> list[tuple[Claim, Callable[[], Claim]]]:
        """Return claims that imply that a class is empty, each for the first road sector and for all."""

        def make() -> list[tuple[Claim, Callable[[], Claim]]]:
            ways = [self._all_are_near()] if part is None else [self._is_redundant(part), self._no_gaps(part)]
            return [(valid_under(self.home, x[0]), partial(self._every, tuple(x))) for x in ways]

        return self.cache.once(("empty", part and part.key), make)

    def _every(self, claims: tuple[Query, ...]) -> Claim:
        return valid_under(self.home, both(*claims))

    def _is_redundant(self, part: ScenarioPart) -> list[Query]:
        """Return the claims that a scenario without the part implies the scenario, by road sector."""
        return [
            implication(x.without, apply_scenario(self.home, Scenario(x.scenario, self.home.set_name)))
            for x, _ in self.classes.counterparts(part)
        ]

    def _no_gaps(self, part: ScenarioPart) -> list[Query]:
        """Return the claims that near misses of ``part`` are no gaps, in either role, for each road sector.

        Danger is symmetric, but the claims do not assume it.
        """
        claims = []
        for counterpart, sector in self.classes.counterparts(part):
            some = either(*in_either_role(self.home, sector))
            for pair in (PAIR, PAIR[::-1]):
                later = eventually(danger(self.home, *pair))
                claims.append(implication(both(*split_conjunction(counterpart.without), later), some))
        return claims

    def _all_are_near(self) -> list[Query]:
        """Return the claims that each gap is a near miss of a single condition, one for each road sector."""
        claims = []
        for sector in self.classes.sectors:
            near = [x for p in self._finest(sector) for x in (p.without, swap_roles(p.without))]
            some = either(*in_either_role(self.home, sector), *near)
            claims.append(implication(starts_in(self.home, sector), some))
        return claims

    def _finest(self, numbers: Sequence[int]) -> list[ScenarioPart]:
        """Return the parts of these scenarios that have no parts themselves."""
        return [part for number in numbers for part in self.classes.by_number[number] if part.finest]


def group_name(group: GapGroup) -> str:
    """Return the word for a group in names of claims."""
    return group.title.replace(" ", "-")
