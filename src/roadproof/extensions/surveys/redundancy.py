"""The question which parts of a scenario are redundant: each occurrence is replaced by true and by false.

Three claims about each change are asked until one decides. The scenario stays equivalent on all traces; it
stays equivalent under motion; a drive distinguishes the two.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import field
from functools import cached_property
from itertools import chain
from typing import Annotated, ClassVar, Final, Literal

from roadproof.engines.search.usual_road import usual_road
from roadproof.errors import InputError
from roadproof.evidence.answer import ClaimAnswer
from roadproof.evidence.answers import headings, shared
from roadproof.evidence.assuming import valid_under
from roadproof.evidence.claim import Claim, Exists, claim_of
from roadproof.evidence.codec import Doc, Key, Rule, read
from roadproof.extensions.traffic import scenario_parts
from roadproof.library import scenarios
from roadproof.library.compose import both, equivalence, implication, negation
from roadproof.library.elaborate import read_tree
from roadproof.library.sector_twins import sector_twins
from roadproof.library.specification import Query, Specification
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula, is_state, subformulas
from roadproof.logic.restore import as_syntax
from roadproof.logic.show import text
from roadproof.logic.syntax import Claim as Written
from roadproof.questions.basis import Basis
from roadproof.questions.question import Answers, EvidencePlace, Steps, heading_of
from roadproof.reasons import NO_REASON, Reason, ReasonKind, joined
from roadproof.runtime.budget import Work
from roadproof.runtime.records import dataclass
from roadproof.verdict import Verdict

SCHEMA: Final = "roadproof/redundancy/2"
ChangeVerdict = Literal[Verdict.PROVED, Verdict.REFUTED, Verdict.UNKNOWN]


@dataclass(frozen=True)
class Change:
    """One occurrence of a part replaced by a truth value; ``where``: the definitions around it.

    ``weakens``: the changed formula follows from the original one; otherwise it implies it.
    """

    where: tuple[str, ...]
    part: str
    value: bool
    changed: Query
    weakens: bool


def changes_of(specification: Specification, query: Query, whole: bool = False) -> Iterator[Change]:
    """Yield the changes of ``query``: each part of it replaced by true and by false, from the outside in.

    A definition of one instant that compares numbers, or uses no other definition, is one part unless
    ``whole``: ``rssViolation``, ``aheadOf``, ``atLane``.
    """

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
                changed = Written(query.claim.given, as_syntax(rebuild(f.Truth(value))))
                made = read_tree(specification, changed, "")
                yield Change(where, shown, value, made, value == positive)
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
class ChangeClaims:
    """The claims about a change, in order: on all traces, where vehicles move, and of a drive."""

    equal: Claim
    moving: Claim
    apart: Claim
    assuming: Query


@dataclass(frozen=True)
class ChangeFinding:
    """The answers about a change; None where a claim is undecided.

    A trace that distinguishes the two counts if no drive does.
    """

    scenario: int
    change: Change
    claims: ChangeClaims
    equal: ClaimAnswer | None
    moving: ClaimAnswer | None
    apart: ClaimAnswer | None
    names: tuple[str, str, str]

    @property
    def verdict(self) -> ChangeVerdict:
        """PROVED: the part is redundant. REFUTED: it is needed."""
        match self.shown:
            case None:
                return Verdict.UNKNOWN
            case answer if answer.verdict in (Verdict.PROVED, Verdict.VACUOUS):
                return Verdict.PROVED
            case ClaimAnswer():
                return Verdict.REFUTED

    @property
    def shown(self) -> ClaimAnswer | None:
        """The answer that decides; None if none does."""
        answers = (self.equal, self.moving, self.apart)
        decisive = (x for x in answers if x is not None and _decides(x))
        by_trace = (x for x in (self.equal,) if x is not None and x.verdict is Verdict.REFUTED)
        return next(chain(decisive, by_trace), None)

    @property
    def name(self) -> str:
        """The name of the answer that decides; empty if none does."""
        every = zip(self.names, (self.equal, self.moving, self.apart), strict=True)
        return next((name for name, x in every if x is not None and x is self.shown), "")

    @property
    def redundant(self) -> bool | None:
        """Return whether the part could be left out; None if undecided."""
        return None if self.shown is None else self.verdict is Verdict.PROVED

    @property
    def assuming(self) -> Query | None:
        """The condition under which the part is redundant; None if it always is, or is needed."""
        return self.claims.assuming if self.shown is not None and self.shown is self.moving else None

    @property
    def claim(self) -> Query:
        """The formula of the answer that decides, or else the claim of equivalence."""
        return (self.claims.equal if self.shown is None else self.shown.claim).query

    @property
    def reason(self) -> Reason:
        """The reason why a change is undecided, or is distinguished by a trace alone."""
        if self.shown is not None and _decides(self.shown):
            return NO_REASON
        if self.apart is None:
            return NO_REASON if self.equal is None else self.equal.reason
        mode, apart = self.apart.claim.mode, self.apart.reason
        if apart == ReasonKind.NONE_FOUND() and isinstance(mode, Exists):
            apart = ReasonKind.NONE_AHEAD(mode.horizon)
        if self.shown is not None or self.equal is None:
            return apart
        return joined((apart, self.equal.reason))


def _decides(answer: ClaimAnswer) -> bool:
    """Return whether an answer decides a change: a proof or a drive."""
    proved = answer.verdict in (Verdict.PROVED, Verdict.VACUOUS)
    return proved or answer.drive is not None


def _finding(
    number: int, change: Change, claims: ChangeClaims, names: tuple[str, str, str], known: Answers
) -> ChangeFinding:
    equal, moving, apart = (known.get(name) for name in names)
    return ChangeFinding(number, change, claims, equal, moving, apart, names)


@dataclass(frozen=True)
class RedundancyView:
    """The findings on all changes, by scenario, in the order of changes."""

    findings: Mapping[int, tuple[ChangeFinding, ...]]


@dataclass(frozen=True, kw_only=True)
class Changes:
    """The scenarios whose parts are replaced; ``whole``: also the parts of simple predicates."""

    among: Annotated[tuple[shared.Number, ...], Rule(least=1), Doc("The scenarios.")]
    whole: Annotated[bool, Doc("Whether parts of simple predicates are replaced, too.")] = False


@dataclass(frozen=True)
class RedundancyQuestion:
    """The question which parts of scenarios are redundant."""

    kind: ClassVar[str] = "redundancy"
    basis: Basis
    settings: Changes = field(default_factory=lambda: Changes(among=(1,)))

    @property
    def work(self) -> Work:
        """The work that is allowed for a claim."""
        return Work(self.basis.effort, self.basis.proof)

    @classmethod
    def of(cls, basis: Basis, settings: object, where: str) -> "RedundancyQuestion":
        """Return the question that plain data ask. Raises ``InputError``."""
        data = read(Changes, settings, where)
        unknown = [x for x in data.among if x not in scenarios.numbers_of(basis.specification)]
        if unknown:
            raise InputError(f"{where}: set {basis.specification.set_name} has no scenario {unknown[0]}")
        return cls(basis, data)

    def batches(self, known: Answers) -> list["ChangeBatch"]:
        """Return a batch for scenarios that differ only in their road sector: drives and changes."""
        groups: dict[int, list[int]] = {}
        for number in self.settings.among:
            groups.setdefault(self._twins[number], []).append(number)
        return [ChangeBatch(self, tuple(numbers)) for numbers in groups.values()]

    def drive_of(self, number: int) -> Claim:
        """Return the claim that there is a drive of a scenario."""
        return self._existing(number, self._query(number))

    @cached_property
    def _twins(self) -> dict[int, int]:
        return sector_twins(self.basis.specification)

    def _query(self, number: int) -> Query:
        home = self.basis.specification
        return scenarios.apply_scenario(home, scenarios.Scenario(number, home.set_name))

    def _existing(self, number: int, query: Query) -> Claim:
        """Return the claim that there is a drive, on the usual road of a scenario."""
        basis = self.basis
        mode = Exists(
            road=usual_road(self._query(number).formula),
            vehicles={name: x for name, x in basis.vehicles.items() if not name or name in query.vehicles},
            horizon=basis.horizon,
            objective=basis.objective,
        )
        return claim_of(basis.specification, query, mode, basis.values)

    def named(self, number: int) -> list[tuple[tuple[str, str, str], ChangeClaims]]:
        """Return the claims of each change with their names; equal changes share one."""
        if number not in self._worked_out:
            first: dict[Formula, int] = {}
            made = []
            for place, change in enumerate(self.changes(number), 1):
                stem = f"{number:02}-{first.setdefault(change.changed.formula, place):03}"
                names = (f"redundant-{stem}", f"moving-{stem}", f"needed-{stem}")
                made.append((names, self._claims_of(number, change)))
            self._worked_out[number] = made
        return self._worked_out[number]

    @cached_property
    def _worked_out(self) -> dict[int, list[tuple[tuple[str, str, str], ChangeClaims]]]:
        return {}

    def changes(self, number: int) -> list[Change]:
        """Return the changes of a scenario."""
        return [*changes_of(self.basis.specification, self._query(number), self.settings.whole)]

    def _claims_of(self, number: int, change: Change) -> ChangeClaims:
        home, query = self.basis.specification, self._query(number)
        vehicles = scenarios.vehicles_of(home, scenarios.Scenario(number, home.set_name))
        moving = both(*(scenario_parts.leaves_at_once(home, vehicle) for vehicle in vehicles))
        there = implication(both(moving, query), change.changed)
        back = implication(both(moving, change.changed), query)
        true, false = (change.changed, query) if change.weakens else (query, change.changed)
        apart = both(true, negation(false))
        return ChangeClaims(
            valid_under(home, equivalence(query, change.changed)),
            valid_under(home, both(there, back)),
            self._existing(number, apart),
            moving,
        )

    def label(self, name: str) -> str:
        """Return which change of which scenario the claim of a name is about."""
        _, number, *place = name.split("-")
        if not place:
            return f"scenario {int(number)}"
        change = self.changes(int(number))[int(place[0]) - 1]
        where = change.where[-1] if change.where else ""
        return f"scenario {int(number)}: {change.part} in {where} as {str(change.value).lower()}"

    def view(self, known: Answers) -> RedundancyView:
        """Return what is known of each change."""
        findings = {
            number: tuple(
                _finding(number, change, claims, names, known)
                for change, (names, claims) in zip(self.changes(number), self.named(number), strict=True)
            )
            for number in self.settings.among
        }
        return RedundancyView(findings)

    def data(self, view: RedundancyView, place: EvidencePlace, seconds: float) -> "RedundancyData":
        """Return the view as ``--json`` prints it."""
        return RedundancyData(
            **heading_of(SCHEMA, self.basis),
            set=self.basis.specification.set_name,
            **self.basis.common_data(),
            seconds=seconds,
            verdicts=tuple(finding_data(x, place) for each in view.findings.values() for x in each),
        )


@dataclass(frozen=True)
class ChangeBatch:
    """The claims of scenarios that differ in their road sector only; each change is asked until decided."""

    question: RedundancyQuestion
    numbers: tuple[int, ...]

    @property
    def name(self) -> str:
        """The name of the first scenario."""
        return f"scenario-{self.numbers[0]:02}"

    def steps(self) -> Steps:
        """Yield each claim, and be sent its answer."""
        for number in self.numbers:
            yield f"scenario-{number:02}", self.question.drive_of(number)
            for names, claims in dict(self.question.named(number)).items():
                for name, claim in zip(names, (claims.equal, claims.moving, claims.apart), strict=True):
                    answer = yield name, claim
                    if _decides(answer):
                        break


def finding_data(x: ChangeFinding, place: EvidencePlace) -> "ChangeFindingData":
    """Return what ``--json`` prints of a change."""
    return ChangeFindingData(
        scenario=x.scenario,
        part=x.change.part,
        where=x.change.where,
        value=x.change.value,
        changed=x.change.changed.text,
        redundant=x.redundant,
        verdict=x.verdict,
        assuming="" if x.assuming is None else x.assuming.text,
        claim=x.claim.text,
        evidence=None if x.shown is None else place(x.name, x.shown),
        reason=x.reason,
    )


@dataclass(frozen=True, kw_only=True)
class ChangeFindingData:
    """The effect on a scenario of one occurrence of a part replaced by a truth value."""

    scenario: shared.Number
    part: Annotated[str, Doc("The part that is replaced by a truth value.")]
    where: Annotated[tuple[str, ...], Doc("The definitions around it, from the outside in.")]
    value: Annotated[bool, Key("as"), Doc("The truth value.")]
    changed: Annotated[str, Doc("The scenario with that put in place of the part.")]
    redundant: Annotated[bool | None, Doc("Whether the part could be left out; null in doubt.")]
    verdict: ChangeVerdict
    assuming: Annotated[
        str, Doc("Of motion: that a vehicle which leaves L has a first moment outside it; else empty.")
    ]
    claim: Annotated[shared.Formula, Doc("What the evidence is about; that nothing changes in doubt.")]
    evidence: Annotated[shared.EvidenceField, Doc("A certificate, a drive or a trace; null in doubt.")]
    reason: shared.Reason = NO_REASON


@dataclass(frozen=True, kw_only=True)
class RedundancyData(headings.AnswerHeading):
    """The parts of scenarios that could be left out."""

    schema: Literal["roadproof/redundancy/2"] = SCHEMA
    set: shared.SetName
    options: shared.Options
    parameters: shared.Parameters
    specs: shared.Specifications
    view: shared.Dense = "dense"
    seconds: shared.Seconds = 0.0
    verdicts: tuple[ChangeFindingData, ...]
