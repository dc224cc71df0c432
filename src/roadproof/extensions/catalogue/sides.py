"""Claims about drives of a test with a formula on both sides of a driver model: preventable ones, and others.

A search among the drives of a restricted scenario (``drivers.restriction``) only proposes a drive. It counts
where the judge accepts it for the test and the scenario, and where the model, put into it, ends so.
"""

from collections.abc import Iterator
from dataclasses import replace
from functools import cache, cached_property
from typing import get_args

from roadproof.engines.search.placing import judged_as
from roadproof.errors import InputError
from roadproof.evidence.answer import Answer
from roadproof.evidence.claim import Claim, Exists, claim_of
from roadproof.evidence.judged import JudgedDrive
from roadproof.extensions.catalogue.abstract import stem_of
from roadproof.extensions.catalogue.asked import Questions
from roadproof.extensions.catalogue.driver_sides import decisions_of, models_of, side_name
from roadproof.extensions.catalogue.entries import Abstract
from roadproof.extensions.catalogue.fact import Fact
from roadproof.extensions.catalogue.showing import names_shown
from roadproof.extensions.drivers.restriction import Restriction, Side, check_library, files_for, said_in
from roadproof.extensions.surveys.extremes.points import Asking
from roadproof.extensions.traffic.evaluate.decisions import Decision, Drivers
from roadproof.library.compose import both
from roadproof.library.loading import load_library
from roadproof.library.scenarios import Scenario, applied, number_in
from roadproof.library.specification import Library, Query, Source
from roadproof.questions.basis import Basis
from roadproof.questions.question import Steps
from roadproof.reasons import Reason, Why
from roadproof.runtime.budget import Work
from roadproof.runtime.records import dataclass


@dataclass(frozen=True)
class SidesBatch:
    """The claims that a test, which implies a scenario or shows it, has a drive on each side of each model.

    ``drives`` are those of the test that are known.
    """

    basis: Basis
    asked: Questions
    drivers: Drivers
    entry: Abstract
    scenario: str
    drives: tuple[JudgedDrive, ...]

    @property
    def name(self) -> str:
        """How the names of its claims begin."""
        return f"{stem_of(self.entry.id)}-{self.scenario}"

    @property
    def work(self) -> Work:
        """The work that is allowed for a claim."""
        return Work(self.basis.effort, self.basis.proof)

    def steps(self) -> Steps:
        """Yield a claim for each side that no known drive is on."""
        yield from self.facts()

    def facts(self) -> Asking[tuple[Fact, ...]]:
        """Ask, and return a drive for each side that no known drive is on, or that none was found."""
        found, facts = self._decisions(self.drives), list[Fact]()
        for wanted in self._wanted():
            if not _is_on(found, wanted):
                fact = yield from self._side(wanted)
                found += [] if fact.drive is None else self._decisions((fact.drive,))
                facts.append(fact)
        return tuple(facts)

    def _wanted(self) -> Iterator[Restriction]:
        for model in models_of(self.drivers, self.scenario):
            yield from (Restriction(side, model) for side in get_args(Side))

    def _decisions(self, drives: tuple[JudgedDrive, ...]) -> list[Decision]:
        return decisions_of(drives, [self.scenario], self.asked, self.drivers)

    @cached_property
    def _plain(self) -> Query:
        """The scenario, however it begins."""
        number, home = number_in(self.scenario), self.basis.specification
        assert number is not None
        return applied(home, Scenario(number, home.set_name))

    def _claim(self, wanted: Restriction) -> Claim | Reason:
        """Return the claim that there is a drive that begins so, or why the test cannot be asked for it."""
        home, known, number = self.basis.specification, self.drivers.specification, number_in(self.scenario)
        assert number is not None
        try:
            options = {**known.options, **wanted.options}
            there = _library(tuple(known.library.files)).select(known.set_name, options)
            test = said_in(both(self.entry.query, self._plain), home, there)
        except InputError as error:
            return Why.TOLD(error)
        query = both(test, applied(there, Scenario(number, home.set_name)))
        vehicles = {x: y for x, y in self.entry.vehicles.items() if not x or x in query.vehicles}
        mode = Exists(road=self.entry.road, vehicles=vehicles, horizon=self.basis.horizon, explain=False)
        return claim_of(there, query, mode, self.drivers.values)

    def _drive(self, answer: Answer, wanted: Restriction) -> JudgedDrive | None:
        """Return the drive of an answer as one of the test, where the model ends so in it."""
        if answer.drive is None:
            return None
        home = self.basis.specification
        file = replace(answer.drive.file, options=dict(home.options), values=self.basis.all_values())
        query = both(self.entry.query, self._plain)
        judged = self.asked.remembered.of(
            ("side", id(answer.drive), self.name),
            answer.drive,
            lambda: judged_as(file, query, self.basis.library),
        )
        if judged is None or not _is_on(self._decisions((judged,)), wanted):
            return None
        return judged

    def _side(self, wanted: Restriction) -> Asking[Fact]:
        """Ask for a drive on one side."""
        other = side_name(self.scenario, wanted.side, wanted.model)
        fact = Fact(self.entry.id, other, "open", self.entry.query, self._plain)
        claim = self._claim(wanted)
        if not isinstance(claim, Claim):
            return replace(fact, reason=claim)
        name = f"{self.name}-{wanted.side}-{wanted.model}"
        answer = yield name, claim
        drive, fact = self._drive(answer, wanted), replace(fact, name=name, answer=answer)
        if drive is None:
            return replace(fact, reason=answer.reason or Why.SEARCH_FOUND_NONE())
        return replace(fact, relation="shows", drive=drive, also=names_shown(drive, self.asked))


def _is_on(decisions: list[Decision], wanted: Restriction) -> bool:
    return any((x.driver, x.side) == (wanted.model, wanted.side) for x in decisions)


@cache
def _library(files: tuple[Source, ...]) -> Library:
    """The definitions with ``prevention.spec``. Raises ``InputError``."""
    library = load_library(files_for(files))
    check_library(library)
    return library
