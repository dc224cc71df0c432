"""Which parts of a scenario could be left out: every occurrence, replaced by true and by false.

A replacement is redundant where the formula stays equivalent on all traces, which is proved, and
needed where a judged drive tells the two apart. Drives found for one question are tried on the next,
and those for one scenario on the scenarios that differ from it in the road sector only.
"""

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import field, replace
from functools import cached_property
from typing import ClassVar

from roadproof.analysis.basis import Basis
from roadproof.analysis.study.evidence_store import EvidenceStore, Question
from roadproof.analysis.study.frame import Unprepared
from roadproof.engines.search.ask import ask
from roadproof.engines.search.outcome import Search
from roadproof.engines.search.placing import judged_as, placed
from roadproof.engines.search.question import usual_road
from roadproof.errors import InputError
from roadproof.evidence.answers.redundancy import SCHEMA, Finding, Index, Record, Word
from roadproof.evidence.countermodel import Countermodel, read_trace, trace_data
from roadproof.evidence.judged import JudgedDrive
from roadproof.evidence.settled import Settled
from roadproof.library import scenarios as s
from roadproof.library.alike import likes_of
from roadproof.library.bind import bind
from roadproof.library.compose import both, equivalence, implication, negation
from roadproof.library.elaborate import StatedQuery, read_tree
from roadproof.library.specification import Query, Specification
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula, is_state, subformulas
from roadproof.logic.restore import as_syntax
from roadproof.logic.show import text
from roadproof.logic.syntax import Claim
from roadproof.reasons import Reason, Why
from roadproof.runtime.budget import BudgetExceeded
from roadproof.runtime.records import dataclass
from roadproof.semantics.exact.exact import judge
from roadproof.verdict import Verdict

# How many drives are tried on other roads for a change inside a road sector.
MOVED = 5


@dataclass(frozen=True)
class Change:
    """One occurrence of a part replaced by a truth value; ``where``: the definitions around it.

    ``weakens``: what is left holds wherever the whole formula does; else it holds only there.
    """

    where: tuple[str, ...]
    part: str
    value: bool
    changed: Query
    weakens: bool


@dataclass(frozen=True)
class ChangeFinding(Settled[Word]):
    """PROVED: the change may be made. REFUTED: it matters, as a drive shows, or else a trace. UNKNOWN.

    ``trace`` is a judged countermodel over points in time, where no drive was found. ``assuming``: a
    condition on the trace under which the change may be made, part of ``claim``; empty where it always may.
    ``late``: cut off by the clock, so that nothing was looked for in vain.
    """

    change: Change
    claim: Query
    trace: Countermodel | None = None
    assuming: Query | None = None
    late: bool = False

    @property
    def redundant(self) -> bool | None:
        """Whether the part could be left out; None where it is in doubt."""
        return None if self.verdict is Verdict.UNKNOWN else self.verdict is Verdict.PROVED


ChangeFindings = tuple[ChangeFinding, ...]


def changes_of(
    specification: Specification, query: Query, whole: bool = False, stated: bool = False
) -> Iterator[Change]:
    """Every occurrence of a part of ``query``, but itself, by true and by false, from the outside in.

    A definition of one instant that compares numbers, or uses no other one, is one part unless
    ``whole``: ``rssViolation``, ``aheadOf``, ``atLane``. ``stated``: whether changed queries are known to be
    right, and are elaborated only where more than their text is asked for.
    """

    def read(claim: Claim) -> Query:
        return StatedQuery(specification, text(claim)) if stated else read_tree(specification, claim, "")

    def walk(
        current: Formula,
        rebuild: Callable[[Formula], Formula],
        where: tuple[str, ...],
        positive: bool,
        root: bool,
    ) -> Iterator[Change]:
        if isinstance(current, f.Application) and (whole or not _is_simple(current)):
            label = f"{current.name}({','.join(current.arguments)})"
            yield from walk(current.body, rebuild, (*where, label), positive, root)
            return
        if isinstance(current, f.Truth) or (isinstance(current, f.Application) and current.body == f.TRUE):
            return
        if not root:
            shown = text(as_syntax(current))
            for value in (True, False):
                changed = Claim(query.claim.given, as_syntax(rebuild(f.Truth(value))))
                yield Change(where, shown, value, read(changed), value == positive)
        parts = () if isinstance(current, f.Application) else f.children(current)
        for place, part in enumerate(parts):
            inside = _inside(current, parts, place, rebuild)
            yield from walk(part, inside, where, positive != isinstance(current, f.Not), False)

    yield from walk(query.formula, lambda x: x, (), True, True)


def _inside(
    around: Formula, parts: tuple[Formula, ...], place: int, rebuild: Callable[[Formula], Formula]
) -> Callable[[Formula], Formula]:
    return lambda new: rebuild(f.with_children(around, (*parts[:place], new, *parts[place + 1 :])))


def _is_simple(formula: f.Application) -> bool:
    below = list(subformulas(formula.body))
    numbers = any(isinstance(x, f.Compare) for x in below)
    roads = any(isinstance(x, f.Occupies) for x in below)
    alone = not any(isinstance(x, f.Application) for x in below)
    return is_state(formula) and (alone or (numbers and not roads))


@dataclass(frozen=True)
class SharedFindings:
    """What one scenario leaves to those that differ from it in the road sector only.

    By the changed formula, without sectors: drives that told it apart; ``vain``: looked for in vain.
    """

    drives: Mapping[Formula, JudgedDrive] = field(default_factory=dict)
    vain: frozenset[Formula] = frozenset()


_NONE = SharedFindings()


def learn(findings: ChangeFindings) -> SharedFindings:
    """What the findings on one scenario teach about its likes."""
    vain = (x for x in findings if x.drive is None and not x.redundant and not x.late)
    return SharedFindings(
        {_key(x.change): x.drive for x in findings if x.drive is not None},
        frozenset(_key(x.change) for x in vain),
    )


def _key(change: Change) -> Formula:
    return s.without_sectors(change.changed.formula)


def _in_sector(change: Change) -> bool:
    return any(s.is_sector(name) for name in (*change.where, change.part))


@dataclass(frozen=True)
class ScenarioTask:
    """A scenario whose changes are to be decided, with what its likes have taught."""

    scenario: s.Scenario
    learned: SharedFindings = _NONE


@dataclass(frozen=True)
class Redundancy(Unprepared):
    """The question which parts of scenarios are redundant, as a ``study.frame.Study``.

    ``whole``: also the parts of simple predicates (``changes_of``).
    """

    record_type: ClassVar[type[Record]] = Record
    basis: Basis
    numbers: tuple[int, ...]
    whole: bool = False

    @property
    def question(self) -> Question:
        said = {"set": self.basis.specification.set_name, **self.basis.said()}
        more = {"whole": str(self.whole), "effort": f"{self.basis.effort.units:g}", **self.basis.limits}
        return Question(SCHEMA, said, more, self.basis.library)

    def pieces(self, known: Mapping[str, ChangeFindings]) -> Sequence[ScenarioTask]:
        """One scenario of each kind comes first; those that differ in their road sector learn from it."""
        first: dict[int, int] = {}
        for number in self.numbers:
            first.setdefault(self._likes[number], number)
        left = [n for n in self.numbers if name_of(n) not in known]
        leaders = [n for n in left if n in first.values()]
        if leaders:
            return [ScenarioTask(self._scenario(n)) for n in leaders]
        taught = {kind: learn(known[name_of(leader)]) for kind, leader in first.items()} if left else {}
        return [ScenarioTask(self._scenario(n), taught[self._likes[n]]) for n in left]

    def _scenario(self, number: int) -> s.Scenario:
        return s.Scenario(number, self.basis.specification.set_name)

    @cached_property
    def _likes(self) -> dict[int, int]:
        return likes_of(self.basis.specification)

    def settle(self, piece: ScenarioTask) -> dict[str, ChangeFindings]:
        examining = _ExaminationJobs(self.basis, piece.scenario, piece.learned)
        return {name_of(piece.scenario.number): tuple(examining.run(self.whole))}

    def doubt(self, piece: ScenarioTask, reason: Reason) -> dict[str, ChangeFindings]:
        examining = _ExaminationJobs(self.basis, piece.scenario)
        changes = changes_of(self.basis.specification, examining.query, self.whole)
        return {name_of(piece.scenario.number): tuple(examining.doubt(x, reason) for x in changes)}

    def is_sure(self, answer: ChangeFindings) -> bool:
        return all(x.verdict is not Verdict.UNKNOWN for x in answer)

    def wanted(self, known: Mapping[str, ChangeFindings]) -> Collection[str]:
        return [name_of(number) for number in self.numbers]

    def key(self, name: str) -> str:
        home, number = self.basis.specification, int(name.rpartition("-")[2])
        teacher = next(n for n in self.numbers if self._likes[n] == self._likes[number])
        asked = (s.applied(home, self._scenario(n)) for n in (number, teacher))
        return self.basis.key(asked, number, teacher, self.whole)

    def record(self, name: str, answer: ChangeFindings, shelf: EvidenceStore) -> Record:
        number = int(name.rpartition("-")[2])
        verdicts = tuple(
            Finding(
                scenario=number,
                part=x.change.part,
                where=x.change.where,
                value=x.change.value,
                changed=x.change.changed.text,
                redundant=x.redundant,
                verdict=x.verdict,
                assuming="" if x.assuming is None else x.assuming.text,
                claim=x.claim.text,
                certificate=shelf.certificate(f"redundant-{number:02}-{place:03}.json", x.certificate),
                drive=shelf.drive(f"needed-{number:02}-{place:03}.json", x.drive),
                trace=None if x.trace is None else trace_data(x.trace),
                reason=x.reason,
                late=x.late,
            )
            for place, x in enumerate(answer, 1)
        )
        return Record(scenario=number, verdicts=verdicts)

    def recall(self, record: Record, shelf: EvidenceStore) -> tuple[str, ChangeFindings]:
        examining = _ExaminationJobs(self.basis, self._scenario(record.scenario))
        changes = list(changes_of(self.basis.specification, examining.query, self.whole, stated=True))
        if len(changes) != len(record.verdicts):
            raise InputError(
                f"{len(record.verdicts)} findings on the {len(changes)} changes of {examining.scenario}"
            )
        findings = (self._recalled(x, y, shelf) for x, y in zip(changes, record.verdicts, strict=True))
        return name_of(record.scenario), tuple(findings)

    def _recalled(self, change: Change, said: Finding, shelf: EvidenceStore) -> ChangeFinding:
        specification = self.basis.specification
        if said.changed != change.changed.text:
            raise InputError(f"a finding on {said.changed}, where one on {change.changed.text} was kept")
        return ChangeFinding(
            change,
            StatedQuery(specification, said.claim),
            verdict=said.verdict,
            certificate=shelf.read_certificate(said.certificate),
            drive=shelf.read_drive(said.drive),
            trace=None if said.trace is None else read_trace(said.trace, change.part),
            reason=said.reason,
            assuming=StatedQuery(specification, said.assuming) if said.assuming else None,
            late=said.late,
        )

    def index(self, records: Mapping[str, Record], seconds: float) -> Index:
        """The index, made of the answers as they are recorded."""
        verdicts = tuple(x for number in self.numbers for x in records[name_of(number)].verdicts)
        return Index(**self.question.heading, seconds=round(seconds, 1), verdicts=verdicts)


def name_of(number: int) -> str:
    """Under which name the findings on a scenario are kept."""
    return f"scenario-{number:02}"


class _ExaminationJobs:
    def __init__(self, basis: Basis, scenario: s.Scenario, learned: SharedFindings = _NONE) -> None:
        self.basis = basis
        self.values = basis.all_values()
        self.scenario = scenario
        self.query = s.applied(basis.specification, scenario)
        self.learned = learned
        self.mine: list[JudgedDrive] = []

    def run(self, whole: bool) -> Iterator[ChangeFinding]:
        """The findings on every change, in the order of ``changes_of``."""
        changes = list(changes_of(self.basis.specification, self.query, whole))
        known: dict[Formula, ChangeFinding] = {}
        try:
            self._collect()
        except BudgetExceeded as late:
            known = {x.changed.formula: self.doubt(x, late.reason) for x in changes}
        for change in changes:
            if change.changed.formula not in known:
                try:
                    known[change.changed.formula] = self._decide(change)
                except BudgetExceeded as late:
                    known[change.changed.formula] = self.doubt(change, late.reason)
            yield replace(known[change.changed.formula], change=change)

    def doubt(self, change: Change, reason: Reason) -> ChangeFinding:
        """What is said of a change that nothing is known of."""
        claim = equivalence(self.query, change.changed)
        return ChangeFinding(change, claim, verdict=Verdict.UNKNOWN, reason=reason, late=True)

    def _collect(self) -> None:
        """Drives of this scenario, and drives for earlier ones put on a road of its sector."""
        distinct = {repr(x.file.drive): x for x in self.learned.drives.values()}
        for judged in distinct.values():
            here = placed(judged.file, self.query, self.basis.library)
            if here is not None:
                self.mine.append(here)
        if not self.mine:
            self.mine += ask(self._search(self.query)).drives

    def _search(self, query: Query) -> Search:
        return self.basis.search(query, usual_road(self.query.formula))

    def _candidates(self, change: Change) -> Iterator[tuple[JudgedDrive, bool]]:
        """Known drives that may tell a change apart, and whether they are to be tried on other roads too."""
        yield from ((judged, False) for judged in self.mine)
        if _in_sector(change):
            yield from ((judged, True) for judged in self.mine[:MOVED])
        else:
            twin = self.learned.drives.get(_key(change))
            yield from [] if twin is None else [(twin, True)]

    def _decide(self, change: Change) -> ChangeFinding:
        apart = both(self.query, negation(change.changed))
        if change.weakens:
            apart = both(change.changed, negation(self.query))
        for judged, elsewhere in self._candidates(change):
            told = self._tells_apart(judged, apart, elsewhere)
            if told is not None:
                return ChangeFinding(change, apart, verdict=Verdict.REFUTED, drive=told)
        claim, label = equivalence(self.query, change.changed), f"redundancy-{self.scenario}"
        result = self.basis.proof_of(claim, label=label)
        if result.holds and result.certificate is not None:
            return ChangeFinding(change, claim, verdict=Verdict.PROVED, certificate=result.certificate)
        moving = self._redundant_in_motion(change)
        if moving is not None:
            return moving
        vain = not _in_sector(change) and _key(change) in self.learned.vain
        drives = () if vain else ask(self._search(apart)).drives
        if drives:
            self.mine.append(drives[0])
            return ChangeFinding(change, apart, verdict=Verdict.REFUTED, drive=drives[0])
        units, horizon = self.basis.effort.units, self.basis.horizon
        within = (Why.NONE_AHEAD_ELSEWHERE if vain else Why.NONE_AHEAD)(units, horizon)
        if result.countermodel is not None:
            return ChangeFinding(
                change, claim, verdict=Verdict.REFUTED, trace=result.countermodel, reason=within
            )
        reason = Why.NO_PROOF_EITHER(within, self.basis.proof, result.reason)
        return ChangeFinding(change, claim, verdict=Verdict.UNKNOWN, reason=reason)

    def _redundant_in_motion(self, change: Change) -> ChangeFinding | None:
        """A proof for traces on which a vehicle that leaves L has a first moment outside it.

        Every drive is one: it does not jump, and a lane is an open set, since touching is not occupying.
        """
        vehicles = s.vehicles_of(self.basis.specification, self.scenario)
        moving = [s.leaves_at_once(self.basis.specification, vehicle) for vehicle in vehicles]
        there = implication(both(*moving, self.query), change.changed)
        back = implication(both(*moving, change.changed), self.query)
        claim, label = both(there, back), f"redundancy-{self.scenario}"
        found = self.basis.proof_of(claim, label=label)
        if found.verdict is not Verdict.PROVED or found.certificate is None:
            return None
        sure, still = found.certificate, both(*moving)
        return ChangeFinding(change, claim, verdict=Verdict.PROVED, certificate=sure, assuming=still)

    def _tells_apart(self, judged: JudgedDrive, query: Query, elsewhere: bool) -> JudgedDrive | None:
        """The drive judged on ``query`` where it is, or also on roads of other zones."""
        file, library = judged.file, self.basis.library
        if not set(query.vehicles) <= set(file.drive.vehicles):
            return None
        if elsewhere:
            return placed(file, query, library)
        bound = bind(query.formula, file.road, file.lanes, {**self.values, **file.values})
        return judged_as(file, query, library) if judge(bound, file.drive).holds else None
