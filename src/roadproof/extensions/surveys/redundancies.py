"""``roadproof.redundancy``: the parts of scenarios that could be left out."""

from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import Unpack

from roadproof.evidence.kinds import Evidence
from roadproof.extensions.surveys import settings
from roadproof.extensions.surveys.keywords import RedundancyKeywords
from roadproof.extensions.surveys.redundancy import (
    ChangeFinding,
    ChangeFindingData,
    Changes,
    RedundancyQuestion,
    RedundancyView,
    finding_data,
)
from roadproof.extensions.surveys.report import redundancy as redundancy_report
from roadproof.frontends.api.definitions import Among, Definitions, definitions_of
from roadproof.frontends.api.question_answers import QuestionAnswers, evidence_of
from roadproof.frontends.api.settings import basis_of
from roadproof.frontends.report.sheet import Sheet
from roadproof.frontends.settings.option import takes
from roadproof.library.scenarios import numbers_of
from roadproof.library.words import ScenarioWords, words_by_number
from roadproof.verdict import Verdict


class Redundancies(QuestionAnswers[RedundancyView]):
    """The parts of scenarios that could be left out, and evidence that the others are needed."""

    pieces = "scenarios"

    @property
    def findings(self) -> Mapping[int, Sequence[ChangeFinding]]:
        """The findings on every change, by the number of the scenario."""
        return self.view.findings

    @property
    def evidence(self) -> tuple[Evidence, ...]:
        every = (x.shown for each in self.findings.values() for x in each)
        return tuple(evidence_of(x) for x in every if x is not None)

    @cached_property
    def words(self) -> ScenarioWords:
        """The titles of the scenarios."""
        return words_by_number(self.question.basis.specification, tuple(self.findings))

    @property
    def verdicts(self) -> dict[str, Verdict]:
        every = ((number, k, x) for number, each in self.findings.items() for k, x in enumerate(each, 1))
        return {f"scenario {number}, change {k}": x.verdict for number, k, x in every}

    @property
    def _sheet(self) -> Sheet[ChangeFindingData]:
        names = {number: x.name for number, x in self.words.items()}
        every = (x for each in self.findings.values() for x in each)
        return redundancy_report.sheet_of([finding_data(x, lambda *_: None) for x in every], names)

    def __str__(self) -> str:
        return redundancy_report.as_text(self.findings, self.seconds, self.words)


@takes(settings.Redundancy)
def redundancy(
    among: Among = None, using: Definitions | None = None, **options: Unpack[RedundancyKeywords]
) -> Redundancies:
    """Find the parts of scenarios that could be left out; with ``whole`` also parts of simple predicates.

    Raises as ``overlap``.
    """
    given = settings.Redundancy.of(options)
    home = definitions_of(using)
    every = numbers_of(home.alone)
    basis = basis_of(home, given, given.vehicles)
    changes = Changes(among=home.among(among) or every, whole=given.whole)
    return Redundancies.decide(RedundancyQuestion(basis, changes), given)
