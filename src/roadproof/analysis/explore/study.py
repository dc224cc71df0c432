"""Explorations of several formulas: each is a piece with an answer of its own, kept and taken up again."""

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import ClassVar

from roadproof.analysis.explore.answer import (
    Explorable,
    ExplorationResult,
    Extreme,
    PointFinding,
    say_nothing,
)
from roadproof.analysis.explore.extreme import (
    ExtremeQuestion,
    find_extreme,
    find_extremes,
    soughts_of,
    unsought,
)
from roadproof.analysis.explore.record import as_kept, explored_of
from roadproof.analysis.explore.search import Reply, SearchTask, look, undecided, values_of
from roadproof.analysis.explore.values import explore
from roadproof.analysis.study.evidence_store import EvidenceStore, Question, readings
from roadproof.analysis.study.pool import Say, in_order, work
from roadproof.analysis.witnesses import name_of
from roadproof.engines.solve.milp import prepare
from roadproof.errors import InputError
from roadproof.evidence.answers import explore as kept
from roadproof.evidence.answers.explore import SCHEMA
from roadproof.evidence.claim import parameters_in
from roadproof.reasons import Reason
from roadproof.runtime.canonical import digest
from roadproof.runtime.executors import Jobs
from roadproof.runtime.timing import now, since
from roadproof.verdict import Verdict
from roadproof.world.road import Road


@dataclass(frozen=True)
class Exploration:
    """All that is ``asked``, as a ``study.frame.Study``: the same of one formula or of several.

    ``hands`` share the searches for one formula, where formulas do not already.
    ``say`` is told how far one is.
    """

    record_type: ClassVar[type[kept.Record]] = kept.Record
    asked: tuple[Explorable, ...]
    hands: Jobs = None
    say: Say = say_nothing

    @cached_property
    def named(self) -> dict[str, Explorable]:
        """What is asked by the names under which the answers are kept; what is asked twice is there once."""
        return {name_of(number, asked.search): asked for number, asked in enumerate(self.asked, 1)}

    @property
    def road(self) -> Road | None:
        """The road on which is searched, where one is named."""
        return self.asked[0].search.setting.road

    @property
    def question(self) -> Question:
        """What is varied has its values in the findings, and no other for all of them."""
        first = self.asked[0]
        specification = first.search.specification
        varied = {knob.name for knob in first.knobs}
        values = sorted((n, str(v)) for n, v in values_of(first.search).items() if n not in varied)
        said = readings(specification, parameters=dict(values))
        asked = digest([_content_of(x) for x in self.named.values()])
        return Question(SCHEMA, said, {"asked": asked}, specification.library)

    def pieces(self, known: Mapping[str, ExplorationResult]) -> Sequence[str]:
        return [name for name in self.named if name not in known]

    def settle(self, piece: str) -> dict[str, ExplorationResult]:
        begun, asked = now(), self.named[piece]
        prepare()  # the processes that share the searches are forked from this one
        explored = explore(asked, self._look_all, self.say) if asked.knobs else ExplorationResult()
        extremes: list[Extreme] = []
        for measure in asked.measures:
            extremes += find_extremes(soughts_of(asked, explored, measure), self._find_all)
        explored = replace(
            explored,
            extremes=tuple(extremes),
            searches=explored.searches + sum(x.searches for x in extremes),
            seconds=since(begun),
            late=explored.late or any(x.late for x in extremes),
        )
        return {piece: explored}

    def _look_all(self, tasks: Sequence[SearchTask]) -> Iterable[Reply]:
        return in_order(work(look, tasks, self.hands, undecided))

    def _find_all(self, soughts: Sequence[ExtremeQuestion]) -> Iterable[Extreme]:
        find = partial(find_extreme, say=self.say)
        return in_order(work(find, soughts, self.hands, unsought))

    def doubt(self, piece: str, reason: Reason) -> dict[str, ExplorationResult]:
        asked = self.named[piece]
        findings = (
            PointFinding(x, asked.query(x), verdict=Verdict.UNKNOWN, reason=reason) for x in asked.points
        )
        explored = ExplorationResult(tuple(findings), late=True)
        soughts = (x for measure in asked.measures for x in soughts_of(asked, explored, measure))
        return {piece: replace(explored, extremes=tuple(unsought(x, reason) for x in soughts))}

    def is_sure(self, answer: ExplorationResult) -> bool:
        """A doubt that the count of work makes is the same in the next run, so it stands."""
        return not answer.late

    def wanted(self, known: Mapping[str, ExplorationResult]) -> Collection[str]:
        return self.named

    def key(self, name: str) -> str:
        asked = self.named[name]
        return digest(_content_of(asked), asked.search.search_options.effort)

    def prepare(self) -> None:
        prepare()

    def record(self, name: str, answer: ExplorationResult, shelf: EvidenceStore) -> kept.Record:
        return kept.Record(exploration=as_kept(name, self.named[name], answer, shelf))

    def recall(self, record: kept.Record, shelf: EvidenceStore) -> tuple[str, ExplorationResult]:
        said = record.exploration
        for name, asked in self.named.items():
            if (said.scenario, said.set, said.formula) == _asked_of(asked):
                return name, explored_of(asked, said, shelf)
        raise InputError(f"an exploration of {said.formula}, which is not asked for")

    def index(self, records: Mapping[str, kept.Record], seconds: float) -> kept.Index:
        """The index, made of the answers as they are recorded."""
        explored = tuple(records[name].exploration for name in self.named)
        return kept.Index(
            **self.question.heading,
            **kept.Index.of_road(self.road),
            seconds=round(seconds, 1),
            explored=explored,
        )


def _asked_of(asked: Explorable) -> tuple[int | None, str, str]:
    search = asked.search
    return search.scenario, search.specification.set_name, search.query.text


def _content_of(asked: Explorable) -> str:
    """A digest of a claim with what is varied and measured, the parameters of that, and the work."""
    search, library = asked.search, asked.search.specification.library
    moments = [x.moment.formula for x in asked.measures if x.moment is not None]
    measured = parameters_in(library, moments, search.setting.values, (x.term for x in asked.measures))
    measures = [(x.sense, x.text, x.term, x.dimension, x.when) for x in asked.measures]
    units = search.search_options.effort.units
    looked_for = asked.knobs, asked.steps, asked.precision, measures, moments, measured, units
    return digest(search.claim, _asked_of(asked), search.specification.options, looked_for)
