"""The order of scenarios by implication."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from typing import TYPE_CHECKING, Unpack

from roadproof.frontends.api.definitions import Among, Definitions, load
from roadproof.frontends.api.question_answers import QuestionAnswers, evidence_of
from roadproof.frontends.api.settings import basis_of
from roadproof.frontends.report import order as order_report
from roadproof.frontends.report.picture import Picture, drawn, picture_by
from roadproof.frontends.settings import relations as settings
from roadproof.frontends.settings.option import takes
from roadproof.library.words import ScenarioWords, words_in_sets
from roadproof.questions.order.question import Compared, OrderQuestion, OrderView
from roadproof.verdict import Verdict

if TYPE_CHECKING:
    from roadproof.evidence.kinds import Evidence
    from roadproof.frontends.report.sheet import Sheet
    from roadproof.frontends.settings.keywords import OrderKeywords


class Orders(QuestionAnswers[OrderView]):
    """The implications between scenarios: each one proved, or refuted by a drive."""

    pieces = "families of scenarios"

    @property
    def verdicts(self) -> dict[str, Verdict]:
        """The verdict of every implication between two formulas that was decided by itself."""
        order = self.view
        verdicts = {f"{x.above} -> {x.below}": Verdict.PROVED for x in order.proved}
        verdicts |= {f"{above} -> {below}": Verdict.REFUTED for above, below, _ in order.missing}
        return verdicts | {f"{x.above} -> {x.below}": Verdict.UNKNOWN for x in order.doubts}

    @property
    def evidence(self) -> tuple[Evidence, ...]:
        answers = [x.answer for x in self.view.proved] + [x.answer for x in self.view.drives]
        return tuple(map(evidence_of, answers))

    @property
    def _sheet(self) -> Sheet[tuple[str, Verdict]]:
        return order_report.sheet_of(self.verdicts)

    @cached_property
    def words(self) -> ScenarioWords:
        """The titles of the scenarios."""
        numbers = {node.number for kind in self.view.kinds for node in kind.nodes}
        return words_in_sets(self.question.basis.specification, self.question.basis.set_names, numbers)

    def each_picture(self) -> Iterator[tuple[str, Picture]]:
        """The Hasse diagram, which an extension draws."""
        return picture_by("order", self)

    def files(self, pictures: bool) -> dict[str, bytes]:
        graph = {"order.dot": order_report.as_dot(self.view, self.words).encode()}
        return graph | drawn(self.pictures() if pictures else {})

    def __str__(self) -> str:
        return order_report.as_text(self.view, self.seconds, self.words)


@takes(settings.Order)
def order(among: Among = None, using: Definitions | None = None, **options: Unpack[OrderKeywords]) -> Orders:
    """Return which scenarios imply which, in the sets of ``using`` (all three). Raises as ``overlap``."""
    given = settings.Order.of(options)
    home = using or load("base", "extA", "ext")
    basis = basis_of(home, given, given.vehicles)
    return Orders.decide(OrderQuestion(basis, Compared(among=home.among(among))), given)
