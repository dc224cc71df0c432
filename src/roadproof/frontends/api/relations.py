"""Relations between scenarios: which hold together, and which imply which."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Unpack

from roadproof.errors import UsageError
from roadproof.frontends.api.definitions import Among, Definitions, definitions_of
from roadproof.frontends.api.question_answers import QuestionAnswers, evidence_of
from roadproof.frontends.api.settings import basis_of, positive
from roadproof.frontends.report import overlap as overlap_report
from roadproof.frontends.report.numbers import count, took
from roadproof.frontends.settings import relations as settings
from roadproof.frontends.settings.option import takes
from roadproof.library.words import ScenarioWords, words_in_sets
from roadproof.questions.overlap import Meeting, OverlapQuestion, OverlapView, PairVerdict
from roadproof.verdict import ExitCode, Verdict, exit_code

if TYPE_CHECKING:
    from roadproof.evidence.kinds import Evidence
    from roadproof.frontends.report.picture import Picture
    from roadproof.frontends.report.sheet import Sheet
    from roadproof.frontends.settings.keywords import OverlapKeywords


class Overlaps(QuestionAnswers[OverlapView]):
    """The pairs of scenarios that can hold together: for each a drive, or a proof that none exists."""

    pieces = "groups of pairs"

    @property
    def pairs(self) -> tuple[PairVerdict, ...]:
        """The verdicts in the order of the pairs."""
        return self.view.pairs

    @property
    def verdicts(self) -> dict[str, Verdict]:
        return {f"{x.a}, {x.b}": x.verdict for x in self.pairs}

    @property
    def evidence(self) -> tuple[Evidence, ...]:
        return tuple(evidence_of(y) for x in self.pairs for y in x.evidence.values())

    @cached_property
    def words(self) -> ScenarioWords:
        """The titles of the scenarios."""
        basis, numbers = self.question.basis, {y.number for x in self.pairs for y in (x.a, x.b)}
        return words_in_sets(basis.specification, basis.set_names, numbers)

    @property
    def across(self) -> bool:
        """Return whether the pairs are of two spec sets."""
        return len(self.question.basis.set_names) > 1

    @property
    def exit_code(self) -> ExitCode:
        return exit_code((x.verdict, x.verdict) for x in self.pairs)

    @property
    def _sheet(self) -> Sheet[PairVerdict]:
        return overlap_report.sheet_of(self.pairs, self.words)

    def each_picture(self) -> Iterator[tuple[str, Picture]]:
        """The heat map, which an extension draws."""
        from roadproof.frontends.report.picture import picture_by  # here: few answers are drawn

        return picture_by("overlap", self)

    def files(self, pictures: bool) -> dict[str, bytes]:
        """Return the table of the pairs, and the heat map with ``pictures``, by the names of their files."""
        from roadproof.frontends.report.picture import drawn  # here: most answers are written nowhere
        from roadproof.frontends.report.sheet import as_csv

        table = {"overlap.csv": as_csv(self._sheet).encode()}
        return table | drawn(self.pictures() if pictures else {})

    def __str__(self) -> str:
        summary = count(len(self.pairs), "pair") + took(self.seconds or None)
        return f"{overlap_report.as_text(self.pairs, self.across, self.words)}\n{summary}"


@takes(settings.Overlap)
def overlap(
    among: Among = None, using: Definitions | None = None, **options: Unpack[OverlapKeywords]
) -> Overlaps:
    """Return which scenarios of one spec set can hold together, or those of one set with those of another.

    ``among``: scenarios such as "1,3-8" (all where None); ``lanes``, ``roles``, ``start``: the same for
    both, or any; ``horizon``: seconds of driving searched (6; 9 where ``start`` is any). ``preventable``,
    ``unpreventable``: as for ``witness``. ``out``: a folder in
    which answers are kept as they come; ``say`` is told of kept ones that do not count. Raises
    ``InputError``, ``UsageError``.
    """
    given = settings.Overlap.of(options)
    home = given.modified(definitions_of(using), among)
    if len(home.sets) > 2:
        raise UsageError(f"{', '.join(home.sets)}: name one spec set, or two different ones")
    # What happens one after the other takes longer than what happens at once.
    usual = 9 if given.start == "any" else 6
    horizon = positive("horizon", usual if given.horizon is None else given.horizon, "s")
    basis = replace(basis_of(home, given, given.vehicles), horizon=horizon)
    meeting = Meeting(
        among=home.among(among) or None, lanes=given.lanes, roles=given.roles, start=given.start
    )
    question = OverlapQuestion(basis, meeting)
    if not question.pairs:
        raise UsageError(f"--among {among} selects no pair: select at least two scenarios")
    return Overlaps.decide(question, given)
