"""The question for evidence about classes: a drive for each, and a certificate for each claim about them.

The definitions of the classes are a specification file. The proofs that led to the classes need no trust: the
claims say that classes exclude each other and that scenarios are their unions.
"""

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from typing import ClassVar

from roadproof.errors import InputError
from roadproof.evidence.answer import ClaimAnswer
from roadproof.evidence.assuming import valid_under
from roadproof.evidence.claim import Claim, Exists, claim_of
from roadproof.evidence.codec import read
from roadproof.evidence.verdict_with_evidence import ProofResult
from roadproof.extensions.surveys.classify.cells import Cell
from roadproof.extensions.surveys.classify.classes import SET_NAME, Class, Classes, plan_within
from roadproof.extensions.surveys.classify.data import (
    SCHEMA,
    ClassClaimData,
    ClassData,
    ClassesData,
    DivisionData,
    UndecidedPart,
)
from roadproof.extensions.surveys.classify.division import Division
from roadproof.extensions.surveys.classify.drives import MOST_FAILURES, ClassExample, roads_of
from roadproof.extensions.surveys.classify.text import ClassClaim, claims_of, with_classes, write_classes
from roadproof.library.compose import both
from roadproof.library.elaborate import apply_definition, read_claim
from roadproof.library.scenarios import LANE
from roadproof.library.specification import Specification
from roadproof.logic.formula import Application
from roadproof.questions.basis import Basis
from roadproof.questions.question import Answers, EvidencePlace, Steps, heading_of
from roadproof.reasons import NO_REASON, Reason, ReasonKind, joined
from roadproof.runtime.budget import Work
from roadproof.runtime.records import dataclass
from roadproof.verdict import Verdict

CLAIMS_IN_A_BATCH = 8
CLAIM = 4.0  # how much more work a claim is given than a drive


@dataclass(frozen=True)
class ClassesView:
    """All answers together, in the order of the classes and of the claims; ``doubts``: about the division.

    ``shown``: the answer to each class, with its name; ``decided``: that to each claim.
    """

    examples: tuple[ClassExample, ...]
    decisions: tuple[ProofResult[ClassClaim], ...]
    shown: tuple[tuple[str, ClaimAnswer | None], ...] = ()
    decided: tuple[ClaimAnswer | None, ...] = ()
    doubts: tuple[UndecidedPart, ...] = ()


@dataclass(frozen=True)
class ClassifyQuestion:
    """The question for drives of classes and for proofs that they are a division.

    ``basis`` is about the set of the classes; where the division was cut off, about the scenarios.
    """

    kind: ClassVar[str] = "classify"
    replaces: ClassVar[bool] = True
    basis: Basis
    settings: DivisionData

    @property
    def work(self) -> Work:
        """The work that is allowed for a claim."""
        effort = self.basis.effort
        return Work(effort, CLAIM * effort.units, disprove=False, zones=True)

    @classmethod
    def of(cls, basis: Basis, settings: object, where: str) -> "ClassifyQuestion":
        """Return the question that plain data ask. Raises ``InputError``."""
        made = cls(basis, read(DivisionData, settings, where))
        if made.settings.groups:
            made.require_division(where)
        return made

    def require_division(self, where: str) -> None:
        """Raise ``InputError`` unless the settings describe a division of these scenarios that is defined."""
        if self.basis.specification.set_name != SET_NAME:
            raise InputError(f"{where}: classes are defined in the set '{SET_NAME}'")
        plan = plan_within(self.home, self.settings.scenarios)
        rows = [(group.vehicles, group.disturbances) for group in plan.groups]
        groups = [
            (x.vehicles, tuple(sorted({n for cell in x.cells for n in cell}))) for x in self.settings.groups
        ]
        fits = len(rows) == len(groups) and all(
            vehicles == here and {*numbers} <= {*possible}
            for (vehicles, possible), (here, numbers) in zip(rows, groups, strict=True)
        )
        if not fits or not {n for cell in self.settings.places for n in cell} <= {*plan.sectors}:
            raise InputError(f"{where}: its groups are not those of scenarios {plan.numbers}")
        for one in self.classes.all():
            if one.name not in self.basis.specification.definitions:
                raise InputError(f"{where}: there is no definition '{one.name}' in its specification files")
            if not self._is_made_of_cells(one):
                raise InputError(f"{where}: {one.name} is not defined as what happens, and where")

    def _is_made_of_cells(self, one: Class) -> bool:
        """Return whether a class is defined as its cells, of which claims are made."""
        home, plan = self.basis.specification, self.classes.plan
        if one.where is None:
            return True
        what = apply_definition(home, plan.what(one.what.holds), (*one.vehicles, LANE))
        where = apply_definition(home, plan.where(one.where.holds), one.vehicles)
        defined = one.query(home).formula
        return isinstance(defined, Application) and defined.body == both(what, where).formula

    @property
    def undecided_parts(self) -> list[tuple[str, Reason]]:
        """The undecided parts of the division, with reasons."""
        return [(x.about, x.reason) for x in self.settings.doubts]

    @property
    def home(self) -> Specification:
        """The set whose scenarios are divided."""
        home = self.basis.specification
        parent = home.library.sets[SET_NAME].parent if home.set_name == SET_NAME else home.set_name
        return home.in_set(parent)

    @cached_property
    def classes(self) -> Classes:
        """The classes, without the formulas of their definitions."""
        what = tuple(tuple(map(_cell, x.cells)) for x in self.settings.groups)
        plan = plan_within(self.home, self.settings.scenarios)
        if not what:
            return Classes(plan, ((),) * len(plan.groups), ())
        return Classes(plan, what, tuple(map(_cell, self.settings.places)))

    @cached_property
    def text(self) -> str:
        """The definitions of the classes; empty where the division was cut off."""
        return self.basis.library.files[-1].text if self.settings.groups else ""

    @cached_property
    def claims(self) -> dict[str, ClassClaim]:
        """The claims about the classes, by name."""
        if not self.settings.groups:
            return {}
        empty = {x.vehicles: [read_claim(self.home, text) for text in x.empty] for x in self.settings.groups}
        every = claims_of(self.classes, empty, self.basis.specification)
        return {x.name: x for x in every}

    def batches(self, known: Answers) -> list["ClassBatch | ClassClaimBatch"]:
        """Return a batch for classes with the same disturbances, and batches of a few claims."""
        made: list[ClassBatch | ClassClaimBatch] = [
            ClassBatch(self, x) for x in self.classes.alike() if self.settings.groups
        ]
        names = [*self.claims]
        for first in range(0, len(names), CLAIMS_IN_A_BATCH):
            made.append(ClassClaimBatch(self, tuple(names[first : first + CLAIMS_IN_A_BATCH])))
        return made

    def drives_of(self, one: Class) -> dict[str, Claim]:
        """Return the claims that there is a drive of a class, on one road or another, by name."""
        basis, query = self.basis, one.query(self.basis.specification)
        made: dict[str, Claim] = {}
        for k, road in enumerate(roads_of(one, basis.specification), 1):
            mode = Exists(
                road=road,
                vehicles={n: x for n, x in basis.vehicles.items() if not n or n in query.vehicles},
                horizon=basis.horizon,
                objective=basis.objective,
            )
            claim = claim_of(basis.specification, query, mode, basis.values)
            made[one.name if k == 1 else f"{one.name}-{k}"] = claim
        return made

    def claim(self, name: str) -> Claim:
        """Return a claim about the classes."""
        return valid_under(self.basis.specification, self.claims[name].query)

    def label(self, name: str) -> str:
        """Return the class that the claim of a name is about, or its kind."""
        return self.claims[name].kind if name in self.claims else name.partition("-")[0]

    def view(self, known: Answers) -> ClassesView:
        """Return a drive for each class, and what is proved."""
        shown = [self._shown(one, known) for one in self.classes.all()]
        decisions = tuple(_decision(x, known.get(name)) for name, x in self.claims.items())
        return ClassesView(
            tuple(example for _, _, example in shown),
            decisions,
            tuple((name, answer) for name, answer, _ in shown),
            tuple(known.get(name) for name in self.claims),
            self.settings.doubts,
        )

    def _shown(self, one: Class, known: Answers) -> tuple[str, ClaimAnswer | None, ClassExample]:
        claims = self.drives_of(one)
        answers = {name: known.get(name) for name in claims}
        for name, answer in answers.items():
            if answer is not None and answer.drive is not None:
                return name, answer, ClassExample(one, verdict=Verdict.WITNESSED, drive=answer.drive)
        units = self.basis.effort.units
        reasons = [
            x.reason if x.reason.is_late else ReasonKind.ON_ROAD(x.reason, _road(claims[name]), units)
            for name, x in answers.items()
            if x is not None
        ]
        reason = joined(reasons) if reasons else ReasonKind.NO_DRIVE_ELSEWHERE()
        return one.name, answers[one.name], ClassExample(one, verdict=Verdict.UNKNOWN, reason=reason)

    def data(self, view: ClassesView, place: EvidencePlace, seconds: float) -> ClassesData:
        """Return the view as ``--json`` prints it."""
        return ClassesData(
            **heading_of(SCHEMA, self.basis),
            set=self.classes.plan.set_name,
            **self.basis.common_data(),
            scenarios=self.classes.plan.numbers,
            text=self.text,
            classes=tuple(
                _class_data(x, *shown, place) for x, shown in zip(view.examples, view.shown, strict=True)
            ),
            claims=tuple(
                _claim_data(x, answer, place) for x, answer in zip(view.decisions, view.decided, strict=True)
            ),
            doubts=view.doubts,
            seconds=round(seconds, 1),
        )


@dataclass(frozen=True)
class ClassBatch:
    """Classes with the same disturbances: a drive of one may serve for another."""

    question: ClassifyQuestion
    alike: tuple[Class, ...]

    @property
    def name(self) -> str:
        """The first class."""
        return self.alike[0].name

    def steps(self) -> Steps:
        """Yield each claim, and be sent its answer. After some failures without any drive, stop."""
        any_drive, failures = False, 0
        for one in self.alike:
            if failures >= MOST_FAILURES and not any_drive:
                return
            has_drive = False
            for name, claim in self.question.drives_of(one).items():
                answer = yield name, claim
                has_drive = answer.drive is not None
                if has_drive or answer.reason.is_late:
                    break
            any_drive, failures = any_drive or has_drive, failures + (not has_drive)


@dataclass(frozen=True)
class ClassClaimBatch:
    """Claims about the classes."""

    question: ClassifyQuestion
    names: tuple[str, ...]

    @property
    def name(self) -> str:
        """The first claim."""
        return self.names[0]

    def steps(self) -> Steps:
        """Yield each claim."""
        for name in self.names:
            yield name, self.question.claim(name)


def question_of(basis: Basis, division: Division) -> ClassifyQuestion:
    """Return the question that a division of scenarios of ``basis`` leaves. Raises ``InputError``."""
    if division.cut_off:
        return ClassifyQuestion(basis, division.data)
    home = with_classes(write_classes(division.classes, basis.specification), basis.specification)
    return ClassifyQuestion(replace(basis, specification=home, sets=()), division.data)


def _cell(holds: Sequence[int]) -> Cell:
    return Cell(tuple(holds), tuple(holds), ())


def _road(claim: Claim) -> str:
    assert isinstance(claim.mode, Exists)
    return "" if claim.mode.road is None else claim.mode.road.name


def _decision(claim: ClassClaim, answer: ClaimAnswer | None) -> ProofResult[ClassClaim]:
    if answer is None:
        return ProofResult(claim, verdict=Verdict.UNKNOWN, reason=NO_REASON)
    match answer.verdict:
        case Verdict.PROVED | Verdict.VACUOUS | Verdict.REFUTED | Verdict.UNKNOWN as verdict:
            certificate = answer.certificate
            return ProofResult(claim, verdict=verdict, reason=answer.reason, certificate=certificate)
        case Verdict.PROVED_BOUNDED | Verdict.WITNESSED | Verdict.IMPOSSIBLE | Verdict.NONE_WITHIN:
            return ProofResult(claim, verdict=Verdict.CROSSCHECK_FAILED, reason=answer.reason)
        case Verdict.DERIVED | Verdict.COVERED | Verdict.GAPS | Verdict.CROSSCHECK_FAILED:
            return ProofResult(claim, verdict=Verdict.CROSSCHECK_FAILED, reason=answer.reason)


def _claim_data(
    x: ProofResult[ClassClaim], answer: ClaimAnswer | None, place: EvidencePlace
) -> ClassClaimData:
    shown = answer is not None and answer.certificate is not None
    return ClassClaimData(
        name=x.claim.name,
        kind=x.claim.kind,
        claim=x.claim.query.text,
        verdict=x.verdict,
        reason=x.reason,
        certificate=place(x.claim.name, answer) if answer is not None and shown else None,
    )


def _class_data(x: ClassExample, name: str, answer: ClaimAnswer | None, place: EvidencePlace) -> ClassData:
    return ClassData(
        name=x.one.name,
        vehicles=x.one.vehicles,
        scenarios=x.one.scenarios,
        happens=x.one.what.holds,
        where=x.one.place,
        description=x.one.description,
        formula=x.one.formula,
        verdict=x.verdict,
        reason=x.reason,
        drive=None if answer is None or answer.drive is None else place(name, answer),
    )
