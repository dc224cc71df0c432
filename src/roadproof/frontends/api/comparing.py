"""Two formulas side by side."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, ClassVar, Unpack

from roadproof.engines.setting import SearchOptions, exists_mode
from roadproof.errors import UsageError
from roadproof.frontends.api.definitions import Definitions, What, definitions_of
from roadproof.frontends.api.question_answers import QuestionAnswers, evidence_of
from roadproof.frontends.api.settings import setting, work_of
from roadproof.frontends.report import compare as compare_report
from roadproof.frontends.settings.option import takes
from roadproof.frontends.settings.questions import CompareSettings
from roadproof.library.compose import in_spec_set
from roadproof.questions.basis import Basis
from roadproof.questions.compare import CompareQuestion, Comparison, Direction, direction_named
from roadproof.runtime.progress import Listener, listening
from roadproof.runtime.records import dataclass
from roadproof.verdict import ExitCode, Verdict

if TYPE_CHECKING:
    from roadproof.evidence import answer as answers
    from roadproof.evidence.kinds import Evidence
    from roadproof.frontends.report.picture import Picture
    from roadproof.frontends.report.sheet import Sheet
    from roadproof.frontends.settings.keywords import CompareKeywords
    from roadproof.runtime.budget import Cost
    from roadproof.world.road import Road


@dataclass(frozen=True, repr=False)
class ComparisonAnswer(QuestionAnswers[Comparison]):
    """Two formulas side by side; ``relation``: equivalent, stronger, weaker, incomparable or unknown."""

    question: CompareQuestion
    pieces: ClassVar[str] = "directions"

    @property
    def comparison(self) -> Comparison:
        """The answers of both directions."""
        return self.view

    @property
    def relation(self) -> str:
        return self.view.relation

    @property
    def verdicts(self) -> dict[str, Verdict]:
        return {name: x.verdict for name, x in self.view.directions.items()}

    @property
    def evidence(self) -> tuple[Evidence, ...]:
        shown = (x.answer for x in self.view.directions.values() if x.answer is not None)
        return tuple(evidence_of(x) for x in shown if x.is_final)

    @property
    def road(self) -> Road | None:
        return self.question.within.road

    @property
    def exit_code(self) -> ExitCode:
        return ExitCode.UNKNOWN if self.relation == "unknown" else ExitCode.AS_EXPECTED

    @property
    def _sheet(self) -> Sheet[tuple[str, Direction]]:
        return compare_report.sheet_of(self.view)

    def each_picture(self) -> Iterator[tuple[str, Picture]]:
        """Yield a picture of each drive that separates the claims."""
        drives = ((name, x.drive) for name, x in self.view.directions.items())
        from roadproof.frontends.report.picture import drive_pictures  # here: few answers are drawn

        return drive_pictures(drives, self.library)

    def __str__(self) -> str:
        return compare_report.as_text(self.view, self.question.basis.specification)


@takes(CompareSettings)
def compare(
    first: What,
    second: What,
    using: Definitions | None = None,
    *,
    each: Callable[[str, Direction], object] | None = None,
    stage: Listener | None = None,
    **options: Unpack[CompareKeywords],
) -> ComparisonAnswer:
    """Return which of two formulas implies the other.

    Both directions are asked at once where there are two cores, or as many ``jobs`` as are said, each with
    this ``effort`` and ``timeout``; ``each`` is told of a direction ("first implies second" or the reverse)
    when its answer is there, and ``stage`` of each stage that begins (``stages.Stage``): what they raise ends
    all. Where ``using`` has two spec sets, the second formula is of the second one. Drives that tell the two
    apart are looked for as by ``witness``. Raises as that does.
    """
    given = CompareSettings.of(options)
    home = definitions_of(using)
    if len(home.sets) > 2:
        raise UsageError(f"{len(home.sets)} spec sets are given: two formulas have at most two")
    other = home.sets[-1]
    query = replace(home, specification=home.specification.in_set(other)).read(second)
    within = exists_mode(setting(home, given), SearchOptions(engine=given.engine, solver=given.solver))
    basis = Basis(home.specification, values=home.all_values(), effort=work_of(given))
    against = in_spec_set(home.specification, query, other)
    question = CompareQuestion(basis, home.read(first), against, other, within)

    def tell(name: str, answer: answers.ClaimAnswer, cost: Cost) -> None:
        if each is not None:
            each(direction_named(name), question.direction(name, answer))

    with listening(stage):
        return ComparisonAnswer.decide(question, given, tell)
