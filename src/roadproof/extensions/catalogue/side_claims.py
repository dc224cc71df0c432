"""Claims that a test with a formula has preventable and unpreventable drives under a driver model.

A search among the drives of a restricted scenario (``drivers.restriction``) only proposes a drive. It counts
where the judge accepts it for the test and the scenario, and where the model, put into it, ends on that side.
"""

from collections.abc import Iterator
from dataclasses import replace
from functools import cache, cached_property
from typing import get_args

from roadproof.engines.search.placing import judge_as
from roadproof.errors import InputError
from roadproof.evidence.answer import ClaimAnswer
from roadproof.evidence.claim import Claim, Exists, claim_of
from roadproof.evidence.judged import JudgedDrive
from roadproof.extensions.catalogue.abstract_claims import claim_stem
from roadproof.extensions.catalogue.drive_targets import names_shown
from roadproof.extensions.catalogue.driver_sides import decisions_of, models_of, side_name
from roadproof.extensions.catalogue.entries import AbstractTest
from roadproof.extensions.catalogue.fact import CatalogueFact
from roadproof.extensions.catalogue.target_formulas import TargetFormulas
from roadproof.extensions.drivers.restriction import Restriction, Side, check_library, files_for, restated_in
from roadproof.extensions.surveys.extremes.points import ClaimGenerator
from roadproof.extensions.traffic.evaluate.decisions import Decision, Drivers
from roadproof.library.compose import both
from roadproof.library.loading import load_library
from roadproof.library.scenarios import Scenario, apply_scenario, number_in
from roadproof.library.specification import Library, Query, Source
from roadproof.questions.basis import Basis
from roadproof.questions.question import Steps
from roadproof.reasons import Reason, ReasonKind
from roadproof.runtime.budget import Work
from roadproof.runtime.records import dataclass


@dataclass(frozen=True)
class SideBatch:
    """The claims that a test, which implies a scenario or shows it, has a drive on each side of each model.

    ``drives``: the known drives of the test.
    """

    basis: Basis
    formulas: TargetFormulas
    drivers: Drivers
    entry: AbstractTest
    scenario: str
    drives: tuple[JudgedDrive, ...]

    @property
    def name(self) -> str:
        """The stem of the names of its claims."""
        return f"{claim_stem(self.entry.id)}-{self.scenario}"

    @property
    def work(self) -> Work:
        """The work that is allowed for a claim."""
        return Work(self.basis.effort, self.basis.proof)

    def steps(self) -> Steps:
        """Yield a claim for each side that no known drive is on."""
        yield from self.facts()

    def facts(self) -> ClaimGenerator[tuple[CatalogueFact, ...]]:
        """Yield the claims, and return a fact about each side that no known drive is on."""
        decisions, facts = self._decisions(self.drives), list[CatalogueFact]()
        for restriction in self._restrictions():
            if not _is_on(decisions, restriction):
                fact = yield from self._side(restriction)
                decisions += [] if fact.drive is None else self._decisions((fact.drive,))
                facts.append(fact)
        return tuple(facts)

    def _restrictions(self) -> Iterator[Restriction]:
        """Yield the restriction to each side of each model."""
        for model in models_of(self.drivers, self.scenario):
            yield from (Restriction(side, model) for side in get_args(Side))

    def _decisions(self, drives: tuple[JudgedDrive, ...]) -> list[Decision]:
        return decisions_of(drives, [self.scenario], self.formulas, self.drivers)

    @cached_property
    def _plain(self) -> Query:
        """The scenario without a restriction."""
        number, home = number_in(self.scenario), self.basis.specification
        assert number is not None
        return apply_scenario(home, Scenario(number, home.set_name))

    def _claim(self, restriction: Restriction) -> Claim | Reason:
        """Return the claim that a drive of the test begins as restricted, or why there is no such claim."""
        home, known, number = self.basis.specification, self.drivers.specification, number_in(self.scenario)
        assert number is not None
        try:
            options = {**known.options, **restriction.options}
            there = _library(tuple(known.library.files), restriction.model).select(known.set_name, options)
            test = restated_in(both(self.entry.query, self._plain), home, there)
        except InputError as error:
            return ReasonKind.TOLD(error)
        query = both(test, apply_scenario(there, Scenario(number, home.set_name)))
        vehicles = {x: y for x, y in self.entry.vehicles.items() if not x or x in query.vehicles}
        mode = Exists(road=self.entry.road, vehicles=vehicles, horizon=self.basis.horizon, explain=False)
        return claim_of(there, query, mode, self.drivers.values)

    def _drive(self, answer: ClaimAnswer, restriction: Restriction) -> JudgedDrive | None:
        """Return the drive of an answer as one of the test, where the model ends on the side in it."""
        if answer.drive is None:
            return None
        home = self.basis.specification
        file = replace(answer.drive.file, options=dict(home.options), values=self.basis.all_values())
        query = both(self.entry.query, self._plain)
        judged = self.formulas.cache.of(
            ("side", id(answer.drive), self.name),
            answer.drive,
            lambda: judge_as(file, query, self.basis.library),
        )
        if judged is None or not _is_on(self._decisions((judged,)), restriction):
            return None
        return judged

    def _side(self, restriction: Restriction) -> ClaimGenerator[CatalogueFact]:
        """Claim that a drive on one side exists, and return the fact."""
        other = side_name(self.scenario, restriction.side, restriction.model)
        fact = CatalogueFact(self.entry.id, other, "open", self.entry.query, self._plain)
        claim = self._claim(restriction)
        if not isinstance(claim, Claim):
            return replace(fact, reason=claim)
        name = f"{self.name}-{restriction.side}-{restriction.model}"
        answer = yield name, claim
        drive, fact = self._drive(answer, restriction), replace(fact, name=name, answer=answer)
        if drive is None:
            return replace(fact, reason=answer.reason or ReasonKind.SEARCH_FOUND_NONE())
        return replace(fact, relation="shows", drive=drive, also=names_shown(drive, self.formulas))


def _is_on(decisions: list[Decision], restriction: Restriction) -> bool:
    return any((x.driver, x.side) == (restriction.model, restriction.side) for x in decisions)


@cache
def _library(files: tuple[Source, ...], model: str) -> Library:
    """Return the definitions with those of a restriction by a model. Raises ``InputError``."""
    library = load_library(files_for(files, model))
    check_library(library)
    return library
