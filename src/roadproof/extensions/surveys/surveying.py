"""``roadproof.ask``: surveys without a function of their own."""

from collections.abc import Callable, Mapping
from typing import Unpack

from roadproof.errors import UsageError
from roadproof.evidence.answer import ClaimAnswer
from roadproof.extensions.surveys import survey
from roadproof.extensions.surveys.keywords import AskKeywords
from roadproof.extensions.surveys.settings import Ask
from roadproof.extensions.surveys.survey import Survey, verdict_of
from roadproof.frontends.api.definitions import Among, Definitions, definitions_of
from roadproof.frontends.api.question_answers import QuestionAnswers
from roadproof.frontends.api.settings import basis_of
from roadproof.frontends.report.numbers import count, took
from roadproof.frontends.report.sheet import Column, Sheet
from roadproof.frontends.settings.option import takes
from roadproof.library.scenarios import numbers_of
from roadproof.questions.basis import Basis
from roadproof.verdict import Verdict

Row = tuple[str, ClaimAnswer | None]


class SurveyAnswers(QuestionAnswers[Mapping[str, ClaimAnswer | None]]):
    """The answers to a survey, each with a verdict."""

    @property
    def verdicts(self) -> dict[str, Verdict]:
        return {name: verdict_of(x) for name, x in self.view.items()}

    @property
    def _sheet(self) -> Sheet[Row]:
        return Sheet(
            (
                Column("name", lambda x: x[0]),
                Column("verdict", lambda x: verdict_of(x[1])),
                Column("reason", lambda x: "" if x[1] is None else x[1].reason),
            ),
            [*self.view.items()],
        )

    def __str__(self) -> str:
        reasons = {name: "" if x is None else x.reason for name, x in self.view.items()}
        lines = [
            f"{x:<11} {name}{reasons[name] and f': {reasons[name]}'}" for name, x in self.verdicts.items()
        ]
        return "\n".join([*lines, count(len(lines), "answer") + took(self.seconds or None)])


@takes(Ask)
def ask(
    about: Callable[[Basis, survey.Among], Survey],
    among: Among = None,
    using: Definitions | None = None,
    **options: Unpack[AskKeywords],
) -> SurveyAnswers:
    """Return the answers to a survey of scenarios.

    ``among``: scenarios such as "1,3-8" (all if None). ``effort``: units of work for one drive; ``out``: a
    folder for answers, which are written as they come; ``say`` is called for stored answers that are refused.
    Raises ``InputError``, ``UsageError``.
    """
    given = Ask.of(options)
    home = definitions_of(using)
    numbers = home.among(among) or numbers_of(home.specification)
    question = about(basis_of(home, given, given.vehicles), survey.Among(numbers=tuple(numbers)))
    if not question.queries:
        raise UsageError(f"--among {among} selects no scenario: select others")
    return SurveyAnswers.decide(question, given)
