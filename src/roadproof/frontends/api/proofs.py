"""Claims: proved or refuted."""

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import field, replace
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar, Self, Unpack

from roadproof.engines.prove.properties import OWN, Task, choose, template_properties
from roadproof.errors import UsageError
from roadproof.evidence import answer as answers
from roadproof.evidence.claim import Engine
from roadproof.evidence.codec import write
from roadproof.evidence.heading import heading
from roadproof.evidence.kinds import Evidence
from roadproof.evidence.strict import JsonObject
from roadproof.frontends.api.answer import Picture
from roadproof.frontends.api.build_result import BuildResult
from roadproof.frontends.api.definitions import Definitions, What, definitions_of
from roadproof.frontends.api.pictures import drive_pictures
from roadproof.frontends.api.questioned import QuestionAnswers, evidence_of
from roadproof.frontends.api.settings import models_of, setting, work_of
from roadproof.frontends.report import claims as claims_text
from roadproof.frontends.report.cases import Case, Location
from roadproof.frontends.report.numbers import count, took
from roadproof.frontends.report.question_cases import claim_cases
from roadproof.frontends.report.sheet import Sheet
from roadproof.frontends.settings.groups import Run, SearchPlace
from roadproof.frontends.settings.keywords import ProveKeywords
from roadproof.frontends.settings.option import takes
from roadproof.frontends.settings.questions import Prove
from roadproof.library.elaborate import read_claim
from roadproof.library.motion import MOTION, AssumedClaim, at_values, is_moving, limits_of, split, statement
from roadproof.library.scenario_references import names_scenarios, read_numbers
from roadproof.library.specification import Specification
from roadproof.questions.basis import Basis
from roadproof.questions.prove import (
    SCHEMA,
    ClaimResult,
    ClaimsData,
    ClaimsView,
    ClaimTask,
    KernelSays,
    ProveQuestion,
    claim_data,
)
from roadproof.runtime.cost import NO_COST, Cost
from roadproof.runtime.executors import Jobs, hands_of
from roadproof.runtime.files import hold_folder
from roadproof.runtime.pool import Progress
from roadproof.runtime.progress import Listener, listening
from roadproof.runtime.records import dataclass
from roadproof.verdict import ClaimVerdict, ExitCode, Verdict, claim_verdict, exit_code
from roadproof.world.road import Road
from roadproof.world.vehicle import Vehicle

if TYPE_CHECKING:
    from roadproof.evidence.kernels import KernelAnswer, KernelName, Ruling

REQUIRES_MOTION = "limits of vehicles require assume=motion, or 'assuming motion:' before the claim"
_PROPERTY = re.compile(r"[A-Z]\d+")


@dataclass(frozen=True, repr=False)
class Proofs(QuestionAnswers[ClaimsView], BuildResult):
    """Claims, settled. ``kernel``: what Coq says of those that are proved, by claim, where it was asked.

    ``places``: where claims are written, by ``task.name``, if in a file.
    """

    question: ProveQuestion
    kernel: "KernelAnswer | None" = None
    places: Mapping[str, Location] = field(default_factory=dict)
    pieces: ClassVar[str] = "claims"
    command: ClassVar[str] = "prove"

    @classmethod
    def of(
        cls, question: ProveQuestion, given: Run, each: Callable[[str, ClaimResult], None] | None = None
    ) -> Self:
        """Settle claims; ``each`` is told of every result. Of several runs one at a time writes a folder."""

        def tell(name: str, answer: answers.Answer, cost: Cost) -> None:
            if each is not None:
                each(name, replace(question.result(name, answer), cost=cost))

        with hold_folder(None if given.out is None else Path(given.out)):
            return cls.settled(question, given, tell)

    @property
    def answers(self) -> tuple[ClaimResult, ...]:
        """In the order in which they were asked."""
        costs = self.found.costs
        return tuple(replace(x, cost=costs.get(x.name, NO_COST)) for x in self.view.claims)

    @property
    def verdicts(self) -> dict[str, Verdict]:
        return {x.task.name: x.verdict for x in self.answers}

    @property
    def evidence(self) -> tuple[Evidence, ...]:
        shown = (x.answer for x in self.answers if x.answer is not None and x.answer.is_final)
        return tuple(map(evidence_of, shown))

    @property
    def road(self) -> Road | None:
        return self.question.road

    @property
    def exit_code(self) -> ExitCode:
        found = exit_code((x.verdict, x.expected) for x in self.answers)
        return found if self.kernel is None else max(found, self.kernel.exit_code)

    def cases(self) -> Iterator[Case]:
        shown = (x for x in self.answers if x.answer is not None and x.answer.is_final)
        files = {} if self.folder is None else {x.name: self.folder / f"{x.name}.json" for x in shown}
        return claim_cases(self.question, self.answers, files, self.places)

    def put_to_kernel(
        self, kernel: "KernelName", jobs: Jobs = None, progress: Progress | None = None
    ) -> Self:
        """The same, with what a kernel says of each proof. Raises ``MissingSolverError``."""
        from roadproof.evidence.kernels import KernelQuestion, kernels

        asked = {x.name: x.certificate for x in self.answers if x.certificate is not None}
        names = {f"claim_{number}": name for number, name in enumerate(asked, 1)}
        found = kernels().put(
            [KernelQuestion(x, asked[y], self.library) for x, y in names.items()],
            hands_of(jobs).processes,
            progress,
            kernel,
        )
        rulings = {names[x]: ruling for x, ruling in found.rulings.items()}
        return replace(self, kernel=replace(found, rulings=rulings))

    def kernel_text(self) -> str:
        """What Coq says of each proof in a line, and what it stands on."""
        if self.kernel is None:
            return ""
        lines: list[str] = []
        for x in self.answers:
            ruling = self.kernel.rulings.get(x.name)
            if ruling is not None:
                claim = statement(x.task.assuming, " ".join(x.task.claim.split()))
                lines.append(f"kernel: {ruling.told}  {claim}" + f": {ruling.reason}" * bool(ruling.reason))
        return "\n".join([*lines, str(self.kernel)])

    @property
    def _sheet(self) -> Sheet[ClaimResult]:
        return claims_text.sheet_of(self.answers)

    def as_data(self) -> JsonObject:
        says = {} if self.kernel is None else self.kernel.rulings
        folder = self.folder

        def place(name: str, answer: answers.Answer) -> object:
            return None if folder is None else f"{name}.json"

        claims = (claim_data(x, place, _said(says[x.name]) if x.name in says else None) for x in self.answers)
        data = ClaimsData(
            **heading(SCHEMA, self.library),
            **ClaimsData.of_road(self.road),
            verdicts=tuple(claims),
            kernel=None if self.kernel is None else self.kernel.kept,
        )
        return write(data)

    def _write(self, folder: Path, pictures: bool) -> None:
        with hold_folder(folder):
            super()._write(folder, pictures)

    def each_picture(self) -> Iterator[tuple[str, Picture]]:
        """The drives that refute a claim."""
        return drive_pictures(((x.task.name, x.drive) for x in self.answers), self.library)

    def __str__(self) -> str:
        if self.question.are_own:
            return "\n".join(claims_text.details(x, self.question) for x in self.answers)
        table = claims_text.table(self.answers, self.library.select())
        return f"{table}\n{count(len(self.answers), 'claim')}{took(self.seconds or None)}"


@takes(Prove)
def prove(
    *what: What,
    using: Definitions | None = None,
    stage: Listener | None = None,
    **options: Unpack[ProveKeywords],
) -> Proofs:
    """Prove or refute claims for all time, on all roads, for all parameter values within their bounds.

    Values that ``using`` was loaded with are put in, and where ``declared`` the declared ones of all other
    parameters; the answer then holds at these values, and says so.

    A claim is a formula, a property of the list such as "P1", or scenarios such as 4 or "1-8", of which all
    that the list says is settled; without one all of the list is. With ``engine`` "smt" or "milp" a claim is
    about drives on one ``road`` up to a ``horizon`` (s), and PROVED-BOUNDED says within which limits.
    ``assume`` "motion": your own claims are about vehicles that move, with continuous places and speeds,
    ``vehicles`` within the limits of a model for all, or of models by name.
    ``expect``: the verdict that is expected of your own claims; ``drive``: whether one is looked for that
    refutes. ``effort``: units of work for a claim, each about a second of a solver; ``timeout``: seconds
    after which the clock ends it. ``out``: a folder in which answers are kept as they come. ``using``: one
    spec set. ``kernel`` "coq" or "extracted": each proof is put to it, too. ``stage`` is told of each stage
    that begins (``stages.Stage``), and ends all by raising.
    Raises ``TextError``, ``UsageError``, ``InputError``.

    >>> prove("danger(SV,POV) -> danger(SV,POV)", jobs=1).verdict
    <Verdict.PROVED: 'PROVED'>
    """
    given = Prove.of(options)
    asked = claims_asked(definitions_of(using), what, using.alone.set_name if using else None, given)
    with listening(stage):
        found = Proofs.of(asked, given)
    return found if given.kernel is None else found.put_to_kernel(given.kernel, given.jobs, given.progress)


def claims_asked(
    home: Definitions, what: Sequence[What | AssumedClaim], set_name: str | None, given: Prove
) -> ProveQuestion:
    """What ``prove`` settles: claims in dense time, or within limits; ``set_name``: see ``claims_of``.

    Raises as ``prove``.
    """
    dense = given.engine == "dense"
    values = home.all_values() if given.declared else dict(home.values)
    limits = (models_of(given.vehicles), values) if dense else ()
    said = Assumptions(given.assume is not None, *limits)
    asked = claims_of(home, what, set_name, claim_verdict(given.expect), said)
    basis = replace(asked.basis, effort=work_of(given))
    asked = replace(asked, basis=basis, seek_drive=given.drive)
    if given.engine != "dense":
        if given.kernel is not None:
            raise UsageError(f"engine={given.engine!r} makes no certificates for Coq: omit kernel")
        return _within_limits(asked, home, given.engine, given)
    if given.kernel is not None:
        from roadproof.evidence.kernels import kernels

        kernels().find(given.kernel)
    return asked


def _said(ruling: "Ruling") -> KernelSays:
    return KernelSays(says=str(ruling), reason=ruling.reason, premises=ruling.limits)


@dataclass(frozen=True)
class Assumptions:
    """What claims are asked under: whether vehicles move, within the limits of models by name, and values of
    parameters (SI).
    """

    motion: bool = False
    vehicles: Mapping[str, Vehicle] = field(default_factory=dict)
    values: Mapping[str, Fraction] = field(default_factory=dict)

    def of(self, home: Definitions, claim: AssumedClaim) -> AssumedClaim:
        """``claim`` under this as well. Raises ``InputError``, ``UsageError``."""
        query = claim.query
        for name in self.vehicles:
            if name and name not in query.vehicles:
                known = ", ".join(query.vehicles) or "no vehicle"
                raise UsageError(f"vehicle {name}: the claim mentions {known}")
        models = {x: self.vehicles.get(x, self.vehicles.get("")) for x in query.vehicles}
        limits = [x for name, y in models.items() if y is not None for x in limits_of(query, name, y)]
        said = claim.said if is_moving(claim.said) else ((MOTION,) * self.motion + claim.said)
        if self.vehicles and not is_moving(said):
            raise UsageError(REQUIRES_MOTION)
        return at_values(home.specification, AssumedClaim(query, (*said, *limits)), self.values)

    def of_list(self, specification: Specification, task: Task) -> Task:
        """A claim of the list at these values, too."""
        if not self.values:
            return task
        claim = AssumedClaim(read_claim(specification, task.claim))
        return replace(task, assuming=at_values(specification, claim, self.values).said)


def claims_of(
    home: Definitions,
    what: Sequence[What | AssumedClaim],
    set_name: str | None,
    expected: ClaimVerdict = Verdict.PROVED,
    said: Assumptions | None = None,
) -> ProveQuestion:
    """What is claimed: the list's claims in a set, in all where None; or one's own in that of ``home``.

    Raises ``TextError``, ``InputError``, ``UsageError``.
    """
    named: list[str] = []
    numbers: set[int] = set()
    own: list[AssumedClaim] = []
    assumed = said or Assumptions()
    for x in what:
        if isinstance(x, str) and _PROPERTY.fullmatch(x):
            named.append(x)
        elif (
            isinstance(x, int | str)
            and not isinstance(x, bool)
            and names_scenarios(home.specification, str(x))
        ):
            numbers |= {*read_numbers(home.specification, str(x))}
        else:
            own.append(assumed.of(home, _read(home, x)))
    if own and (named or numbers):
        raise UsageError("name template properties or claims of your own, not both")
    if not own and assumed.motion:
        raise UsageError(
            "assume=motion requires claims of your own: template properties are about all traces"
        )
    if not own and assumed.vehicles:
        raise UsageError(REQUIRES_MOTION)
    tasks = _own(home, own, expected)
    if not tasks:
        listed = [x for x in template_properties() if not (assumed.values and x.of_all_values)]
        tasks = choose(listed, named, set_name, sorted(numbers))
    if not tasks:
        words = ", ".join(map(str, what))
        raise UsageError(f"no claim of {words} is stated for set={set_name or 'any'}: ask for others")
    if not own:
        tasks = [assumed.of_list(home.specification.in_set(x.set_name), x) for x in tasks]
    read_with = home.library.select(options=home.specification.options)
    return ProveQuestion(Basis(read_with), tuple(map(ClaimTask, tasks)))


def _read(home: Definitions, what: What | AssumedClaim) -> AssumedClaim:
    if isinstance(what, AssumedClaim):
        return what
    if not isinstance(what, str):
        return AssumedClaim(home.read(what))
    said, claim = split(what)
    return AssumedClaim(home.read(claim), said)


def _own(home: Definitions, claims: list[AssumedClaim], expected: ClaimVerdict) -> list[Task]:
    parts = [str(k) if len(claims) > 1 else "" for k in range(1, len(claims) + 1)]
    name = home.specification.set_name
    return [
        Task(OWN, k, "", None, name, x.query.text, expected, x.said)
        for k, x in zip(parts, claims, strict=True)
    ]


def _within_limits(asked: ProveQuestion, home: Definitions, engine: Engine, given: Prove) -> ProveQuestion:
    """The same claims, about drives on one road up to a horizon, within models of vehicles.

    Raises ``InputError``, ``UsageError``.
    """
    from roadproof.engines.search.question import SearchOptions, exists

    if not asked.are_own:
        raise UsageError(
            f"engine={engine!r} requires claims of your own: template properties are about all time"
        )
    if any(x.task.assuming for x in asked.tasks):
        raise UsageError(
            f"engine={engine!r} is about drives anyway, at the values of params: assume nothing, or ask "
            "engine='dense'"
        )
    where = SearchPlace(road=given.road, vehicles=given.vehicles, horizon=given.horizon, dt=given.dt)
    where = replace(where, strict=given.strict)
    place = replace(setting(home, where), values=dict(home.values))
    within = exists(place, SearchOptions("any", engine))
    basis = replace(asked.basis, values=dict(home.values))
    return replace(asked, basis=basis, tasks=tuple(replace(x, within=within) for x in asked.tasks))
