"""Drives for scenarios and formulas, or proofs that there are none."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import field, replace
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar, Final

from roadproof.errors import InputError
from roadproof.evidence.answer import ClaimAnswer
from roadproof.evidence.answer_files import UndecidedFile
from roadproof.evidence.certificate import Certificate
from roadproof.evidence.claim import Claim, Exists, claim_of
from roadproof.evidence.codec import read
from roadproof.evidence.judged import JudgedDrive
from roadproof.library.elaborate import read_claim
from roadproof.library.scenarios import Scenario, apply_scenario
from roadproof.library.specification import Query, Specification
from roadproof.logic.formula import Formula, Not
from roadproof.questions.basis import Basis
from roadproof.questions.question import Answers, Steps, heading_of
from roadproof.questions.question import EvidencePlace as Placing
from roadproof.reasons import NO_REASON, Reason, ReasonKind
from roadproof.runtime.budget import NO_COST, Cost, Work
from roadproof.runtime.records import dataclass
from roadproof.verdict import DriveVerdict, Verdict

if TYPE_CHECKING:
    from roadproof.questions.witness_data import DriveRequest, DriveRequests, WitnessData
    from roadproof.world.road import Road

NONE_WITHIN: Final = "none-within"


@dataclass(frozen=True)
class SearchTask:
    """A formula in a spec set, for ``count`` drives of which are looked; ``scenario``: whose number it is.

    ``trees``: whether trees are looked for that show a NONE-WITHIN.
    """

    name: str
    specification: Specification
    query: Query
    scenario: int | None = None
    within: Exists = field(default_factory=Exists)
    count: int = 1
    trees: bool = False


@dataclass(frozen=True)
class SearchResult:
    """The result of a search for drives of a formula; ``answers`` in the order of the search.

    ``cost`` in this run.
    """

    task: SearchTask
    answers: tuple[ClaimAnswer, ...]
    cost: Cost = NO_COST

    @property
    def scenario(self) -> int | None:
        """The number of the scenario that was asked for."""
        return self.task.scenario

    @property
    def set_name(self) -> str:
        """The spec set in which the formula is read."""
        return self.task.specification.set_name

    @property
    def query(self) -> Query:
        """The formula."""
        return self.task.query

    @property
    def verdict(self) -> DriveVerdict:
        """WITNESSED where there is a drive, else what the first search came to."""
        match self.answers[0].verdict if self.answers else Verdict.UNKNOWN:
            case Verdict.WITNESSED | Verdict.IMPOSSIBLE | Verdict.NONE_WITHIN as drive_verdict:
                return drive_verdict
            case Verdict.PROVED | Verdict.PROVED_BOUNDED | Verdict.REFUTED | Verdict.VACUOUS:
                return Verdict.UNKNOWN
            case Verdict.DERIVED | Verdict.COVERED | Verdict.GAPS | Verdict.CROSSCHECK_FAILED:
                return Verdict.UNKNOWN
            case Verdict.UNKNOWN:
                return Verdict.UNKNOWN

    @property
    def drives(self) -> tuple[JudgedDrive, ...]:
        """The drives that were found."""
        return tuple(x.drive for x in self.answers if x.drive is not None)

    @property
    def reason(self) -> Reason:
        """Return why there are no drives, or fewer than were asked for."""
        if not self.answers:
            return NO_REASON
        count, last = len(self.drives), self.answers[-1].reason
        if 0 < count < self.task.count:
            return ReasonKind.FEWER_DRIVES(count, self.task.count, last)
        return self.answers[0].reason

    @property
    def road(self) -> str:
        """The name of the road on which was searched."""
        if self.drives:
            return self.drives[0].file.road.name
        if self.task.within.road is not None:
            return self.task.within.road.name
        from roadproof.engines.search.usual_road import usual_road  # here: it reads road files

        return usual_road(self.query.formula).name

    @property
    def natural(self) -> bool:
        """Return whether the first drive was found among natural ones."""
        return bool(self.drives) and bool(self.drives[0].natural)

    @cached_property
    def wishes(self) -> Mapping[str, tuple[bool, ...]]:
        """The wishes of the objective ``typical`` by name, and for each drive whether it fulfils them."""
        if self.task.within.objective != "typical" or not self.drives:
            return {}
        from roadproof.engines.search.wishes import fulfilled_wishes  # here: other objectives have none

        library = self.task.specification.library
        judged = [fulfilled_wishes(self.query, drive.file, library) for drive in self.drives]
        return {name: tuple(x[name] for x in judged) for name in judged[0]}

    @property
    def certificate(self) -> Certificate | None:
        """The proof that there is no drive, if there is one."""
        return self.answers[0].certificate if self.answers else None

    @cached_property
    def core(self) -> tuple[Formula, ...]:
        """The parts that the proof shows to clash."""
        if self.certificate is None:
            return ()
        from roadproof.logic.parts import parts_of  # here: few have a proof

        denied = read_claim(self.answers[0].claim.home, self.certificate.claim).formula
        return tuple(dict.fromkeys(parts_of(denied.body))) if isinstance(denied, Not) else ()

    @property
    def core_texts(self) -> tuple[str, ...]:
        """The parts that clash as texts."""
        from roadproof.logic.parts import texts_of  # here: few have a proof

        return texts_of(self.core)

    @property
    def reason_without_options(self) -> str:
        """The reason, without the options of the command line that widen limits."""
        if self.limits is None:
            return self.reason
        from roadproof.engines.search.claim_search import limits_for_claim  # here: it encodes the motion

        return limits_for_claim(self.answers[0].claim).text(())

    @property
    def limits(self) -> object:
        """The limits within which NONE-WITHIN excludes drives."""
        evidence = self.answers[0].evidence if self.answers else None
        return evidence.limits if isinstance(evidence, UndecidedFile) else None


@dataclass(frozen=True)
class WitnessView:
    """The results in the order in which they were asked."""

    results: tuple[SearchResult, ...]


@dataclass(frozen=True)
class WitnessQuestion:
    """The question for drives of some formulas."""

    kind: ClassVar[str] = "witness"
    basis: Basis
    tasks: tuple[SearchTask, ...]

    @property
    def work(self) -> Work:
        """The work that is allowed for a claim."""
        return Work(self.basis.effort, proof=0.0, alone=True)

    @property
    def settings(self) -> DriveRequests:
        """The question as data."""
        from roadproof.questions.witness_data import DriveRequests, task_data  # here: for folders alone

        return DriveRequests(searches=tuple(map(task_data, self.named.values())))

    @classmethod
    def of(cls, basis: Basis, settings: object, where: str) -> WitnessQuestion:
        """Return the question that plain data ask. Raises ``InputError``."""
        from roadproof.questions.witness_data import DriveRequests  # here: for folders alone

        data = read(DriveRequests, settings, where)
        tasks = tuple(_task(basis.specification.in_set(x.set), x, where) for x in data.searches)
        return cls(basis, tasks)

    def beside(self, former: WitnessQuestion) -> WitnessQuestion:
        """Return the question about former formulas, too: a folder of drives grows."""
        return replace(self, tasks=tuple({**former.named, **self.named}.values()))

    def displaced(self, former: WitnessQuestion) -> list[str]:
        """Return the names of answers to former searches in whose place there is another now."""
        others = [x for x in former.named if x in self.named and not self._is_asked_by(former, x)]
        return [y for x in others for y in (*former.claim_names(x), f"{NONE_WITHIN}-{x}")]

    def _is_asked_by(self, other: WitnessQuestion, name: str) -> bool:
        """Return whether another question has this search under this name, too."""
        is_same = self.named[name].count == other.named[name].count
        return is_same and self.claim(name) == other.claim(name)

    @cached_property
    def names(self) -> tuple[str, ...]:
        """The names of the searches, in order; names of files begin so."""
        return tuple(x.name for x in self.tasks)

    @cached_property
    def named(self) -> dict[str, SearchTask]:
        """The searches by name; what is asked twice is there once."""
        return {x.name: x for x in self.tasks}

    def claim_names(self, name: str) -> list[str]:
        """Return the names of the claims of a search, one for each drive."""
        count = self.named[name].count
        return [name] if count == 1 else [f"{name}-{k}" for k in range(1, count + 1)]

    def search_named(self, claim: str) -> str:
        """Return the name of the search to which a claim belongs."""
        plain = claim.removeprefix(f"{NONE_WITHIN}-")
        return plain if plain in self.named else plain.rpartition("-")[0]

    def is_last(self, claim: str, answer: ClaimAnswer) -> bool:
        """Return whether nothing more is asked of a search once a claim of it has this answer."""
        name = self.search_named(claim)
        if claim not in self.claim_names(name):
            return True
        if claim == self.claim_names(name)[0] and self.wants_trees(name, answer):
            return False
        return answer.drive is None or claim == self.claim_names(name)[-1]

    def wants_trees(self, name: str, first: ClaimAnswer) -> bool:
        """Return whether trees are looked for where the first search came to this answer."""
        return self.named[name].trees and first.verdict is Verdict.NONE_WITHIN

    def claim(self, name: str, before: Sequence[ClaimAnswer] = ()) -> Claim:
        """Return the claim that there is a drive, which is unlike those ``before``."""
        task = self.named[name]
        unlike = tuple(x.drive.file.drive for x in before if x.drive is not None)
        mode = replace(task.within, unlike=unlike)
        return claim_of(task.specification, task.query, mode, self.basis.values)

    def batches(self, known: Answers) -> list[SearchBatch]:
        """A batch for scenarios of which one search may answer several."""
        if len(self.named) == 1:
            return [SearchBatch(self, tuple(self.named))]
        from roadproof.library.sector_twins import sector_twin  # here: a single search has no twin

        groups: dict[object, list[str]] = {}
        for name, task in self.named.items():
            number = task.scenario
            group = name if number is None else sector_twin(task.specification, number)
            groups.setdefault(group, []).append(name)
        return [SearchBatch(self, tuple(names)) for names in groups.values()]

    def label(self, name: str) -> str:
        """Return which scenario the claim of a name is about."""
        task = self.named[self.search_named(name)]
        scenario = "" if task.scenario is None else f"scenario {task.scenario} "
        return f"{scenario}{task.specification.set_name}"

    def view(self, known: Answers) -> WitnessView:
        """Return what was found for each formula."""
        return WitnessView(tuple(self.result(name, known) for name in self.names))

    def result(self, name: str, known: Answers) -> SearchResult:
        """Return what is known of drives for a formula."""
        return SearchResult(self.named[name], tuple(known[x] for x in self.claim_names(name) if x in known))

    def data(self, view: WitnessView, place: Placing, seconds: float) -> WitnessData:
        """Return the view as ``--json`` prints it."""
        from roadproof.questions.witness_data import (  # here: for --json alone
            SCHEMA,
            WitnessData,
            result_data,
        )

        return WitnessData(
            **heading_of(SCHEMA, self.basis),
            **WitnessData.of_road(self.road),
            verdicts=tuple(map(result_data, view.results)),
        )

    @property
    def road(self) -> Road | None:
        """The road on which drives are looked for, where one was chosen."""
        return self.tasks[0].within.road


@dataclass(frozen=True)
class SearchBatch:
    """The searches of some formulas."""

    question: WitnessQuestion
    names: tuple[str, ...]

    @property
    def name(self) -> str:
        """The name of the first search."""
        return self.names[0]

    def steps(self) -> Steps:
        """Yield a claim for each drive, until there is none, and for trees of a NONE-WITHIN."""
        for name in self.names:
            answers: list[ClaimAnswer] = []
            for claim_name in self.question.claim_names(name):
                answers.append((yield claim_name, self.question.claim(name, answers)))
                if answers[-1].drive is None:
                    break
            if self.question.wants_trees(name, answers[0]):
                within = self.question.named[name].within
                claim = self.question.claim(name)
                yield f"{NONE_WITHIN}-{name}", replace(claim, mode=replace(within, trees=True))


def _task(home: Specification, search: DriveRequest, where: str) -> SearchTask:
    """Return a search as data say it. Raises ``InputError``."""
    query = read_claim(home, search.formula)
    if search.scenario is not None:
        scenario = apply_scenario(home, Scenario(search.scenario, home.set_name))
        if scenario.formula != query.formula:
            raise InputError(f"{where}: {search.formula[:80]} is not scenario {search.scenario}")
    from roadproof.questions.drive_search_data import search_mode

    within = search_mode(search.within, where)
    return SearchTask(search.name, home, query, search.scenario, within, search.count, search.trees)


def name_of(number: int, scenario: int | None, set_name: str) -> str:
    """Return the name of the ``number``-th search."""
    what = f"formula-{number:02d}" if scenario is None else f"scenario-{scenario:02d}"
    return f"{what}-{set_name}"
