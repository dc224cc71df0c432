"""Claims: proved or refuted."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import field, replace
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar, Self, Unpack

from roadproof.engines.prove.properties import OWN, Task, choose, template_properties
from roadproof.errors import UsageError
from roadproof.evidence.codec import write
from roadproof.frontends.api.build_result import BuildResult
from roadproof.frontends.api.definitions import Definitions, What, definitions_of
from roadproof.frontends.api.question_answers import QuestionAnswers, evidence_of
from roadproof.frontends.api.settings import models_of, setting, work_of
from roadproof.frontends.report import claims as claims_text
from roadproof.frontends.report.numbers import count, took
from roadproof.frontends.settings.groups import Run, SearchPlace
from roadproof.frontends.settings.option import takes
from roadproof.frontends.settings.questions import Prove
from roadproof.library.assumption import MOTION, assumes_motion, claim_statement
from roadproof.library.elaborate import read_claim
from roadproof.library.motion import AssumedClaim, at_values, limits_of, split_claim
from roadproof.library.scenario_references import names_scenarios, read_numbers
from roadproof.questions.basis import Basis
from roadproof.questions.prove import ClaimResult, ClaimsView, ClaimTask, ProveQuestion
from roadproof.runtime.budget import NO_COST, Cost
from roadproof.runtime.executors import Jobs, executor_for
from roadproof.runtime.files import lock_folder
from roadproof.runtime.progress import Listener, listening
from roadproof.runtime.records import dataclass
from roadproof.verdict import ClaimVerdict, ExitCode, Verdict, claim_verdict, exit_code

if TYPE_CHECKING:
    from roadproof.evidence import answer as answers
    from roadproof.evidence.claim import Engine
    from roadproof.evidence.kernels import KernelAnswer, KernelName, KernelRuling
    from roadproof.evidence.kinds import Evidence
    from roadproof.evidence.strict import JsonObject
    from roadproof.frontends.report.cases import Case, Location
    from roadproof.frontends.report.picture import Picture
    from roadproof.frontends.report.sheet import Sheet
    from roadproof.frontends.settings.keywords import ProveKeywords
    from roadproof.library.specification import Specification
    from roadproof.questions.prove_data import KernelSays
    from roadproof.runtime.pool import Progress
    from roadproof.world.road import Road
    from roadproof.world.vehicle import Vehicle

REQUIRES_MOTION = "limits of vehicles require assume=motion, or 'assuming motion:' before the claim"
_PROPERTY = re.compile(r"[A-Z]\d+")


@dataclass(frozen=True, repr=False)
class Proofs(QuestionAnswers[ClaimsView], BuildResult):
    """Claims, settled. ``kernel``: what Coq says of those that are proved, by claim, where it was asked.

    ``places``: where claims are written, by ``task.name``, if in a file.
    """

    question: ProveQuestion
    kernel: KernelAnswer | None = None
    places: Mapping[str, Location] = field(default_factory=dict)
    pieces: ClassVar[str] = "claims"
    command: ClassVar[str] = "prove"

    @classmethod
    def of(
        cls, question: ProveQuestion, given: Run, each: Callable[[str, ClaimResult], None] | None = None
    ) -> Self:
        """Decide claims, calling ``each`` with every result. One run at a time writes a folder."""

        def tell(name: str, answer: answers.ClaimAnswer, cost: Cost) -> None:
            if each is not None:
                each(name, replace(question.result(name, answer), cost=cost))

        with lock_folder(None if given.out is None else Path(given.out)):
            return cls.decide(question, given, tell)

    @property
    def answers(self) -> tuple[ClaimResult, ...]:
        """The results in the order of the claims."""
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
        code = exit_code((x.verdict, x.expected) for x in self.answers)
        return code if self.kernel is None else max(code, self.kernel.exit_code)

    def cases(self) -> Iterator[Case]:
        """Yield a case for each claim."""
        shown = (x for x in self.answers if x.answer is not None and x.answer.is_final)
        files = {} if self.folder is None else {x.name: self.folder / f"{x.name}.json" for x in shown}
        from roadproof.frontends.report.question_cases import claim_cases  # here: for build servers alone

        return claim_cases(self.question, self.answers, files, self.places)

    def put_to_kernel(self, kernel: KernelName, jobs: Jobs = None, progress: Progress | None = None) -> Self:
        """Return the proofs with the rulings of a kernel. Raises ``MissingSolverError``."""
        from roadproof.evidence.kernels import KernelQuestion, kernels

        certificates = {x.name: x.certificate for x in self.answers if x.certificate is not None}
        names = {f"claim_{number}": name for number, name in enumerate(certificates, 1)}
        answered = kernels().check(
            [KernelQuestion(x, certificates[y], self.library) for x, y in names.items()],
            executor_for(jobs).processes,
            progress,
            kernel,
        )
        rulings = {names[x]: ruling for x, ruling in answered.rulings.items()}
        return replace(self, kernel=replace(answered, rulings=rulings))

    def kernel_text(self) -> str:
        """The ruling of Coq on each proof in a line, with its axioms."""
        if self.kernel is None:
            return ""
        lines: list[str] = []
        for x in self.answers:
            ruling = self.kernel.rulings.get(x.name)
            if ruling is not None:
                claim = claim_statement(x.task.assuming, " ".join(x.task.claim.split()))
                lines.append(
                    f"kernel: {ruling.text_with_premises}  {claim}"
                    + f": {ruling.reason}" * bool(ruling.reason)
                )
        return "\n".join([*lines, str(self.kernel)])

    @property
    def _sheet(self) -> Sheet[ClaimResult]:
        return claims_text.sheet_of(self.answers)

    def as_data(self) -> JsonObject:
        """Return the plain data of ``--json``."""
        from roadproof.evidence.heading import heading
        from roadproof.questions.prove_data import SCHEMA, ClaimsData, claim_data

        says = {} if self.kernel is None else self.kernel.rulings
        folder = self.folder

        def place(name: str, answer: answers.ClaimAnswer) -> object:
            return None if folder is None else f"{name}.json"

        claims = (
            claim_data(x, place, _kernel_data(says[x.name]) if x.name in says else None) for x in self.answers
        )

        data = ClaimsData(
            **heading(SCHEMA, self.library),
            **ClaimsData.of_road(self.road),
            verdicts=tuple(claims),
            kernel=None if self.kernel is None else self.kernel.data,
        )
        return write(data)

    def _write(self, folder: Path, pictures: bool) -> None:
        with lock_folder(folder):
            super()._write(folder, pictures)

    def each_picture(self) -> Iterator[tuple[str, Picture]]:
        """The drives that refute a claim."""
        from roadproof.frontends.report.picture import drive_pictures  # here: few answers are drawn

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
    question = prove_question(definitions_of(using), what, using.alone.set_name if using else None, given)
    with listening(stage):
        proofs = Proofs.of(question, given)
    return proofs if given.kernel is None else proofs.put_to_kernel(given.kernel, given.jobs, given.progress)


def prove_question(
    home: Definitions, what: Sequence[What | AssumedClaim], set_name: str | None, given: Prove
) -> ProveQuestion:
    """Return the question of ``prove``: claims in dense time, or within limits; ``set_name`` as below.

    Raises as ``prove``.
    """
    dense = given.engine == "dense"
    values = home.all_values() if given.declared else dict(home.values)
    limits = (models_of(given.vehicles), values) if dense else ()
    assumptions = ClaimAssumptions(given.assume is not None, *limits)
    question = claims_question(home, what, set_name, claim_verdict(given.expect), assumptions)
    basis = replace(question.basis, effort=work_of(given))
    question = replace(question, basis=basis, seek_drive=given.drive)
    if given.engine != "dense":
        if given.kernel is not None:
            raise UsageError(f"engine={given.engine!r} makes no certificates for Coq: omit kernel")
        return _within_limits(question, home, given.engine, given)
    if given.kernel is not None:
        from roadproof.evidence.kernels import kernels

        kernels().require_installed(given.kernel)
    return question


def _kernel_data(ruling: KernelRuling) -> KernelSays:
    from roadproof.questions.prove_data import KernelSays

    return KernelSays(says=str(ruling), reason=ruling.reason, premises=ruling.limits)


@dataclass(frozen=True)
class ClaimAssumptions:
    """The assumptions of claims: whether vehicles move, within the limits of models by name, and values of
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
        texts = claim.texts if assumes_motion(claim.texts) else ((MOTION,) * self.motion + claim.texts)
        if self.vehicles and not assumes_motion(texts):
            raise UsageError(REQUIRES_MOTION)
        return at_values(home.specification, AssumedClaim(query, (*texts, *limits)), self.values)

    def of_list(self, specification: Specification, task: Task) -> Task:
        """A claim of the list at these values, too."""
        if not self.values:
            return task
        claim = AssumedClaim(read_claim(specification, task.claim))
        return replace(task, assuming=at_values(specification, claim, self.values).texts)


def claims_question(
    home: Definitions,
    what: Sequence[What | AssumedClaim],
    set_name: str | None,
    expected: ClaimVerdict = Verdict.PROVED,
    assumptions: ClaimAssumptions | None = None,
) -> ProveQuestion:
    """Return the question about the list's claims in a set (all sets if None), or about given formulas.

    Raises ``TextError``, ``InputError``, ``UsageError``.
    """
    named: list[str] = []
    numbers: set[int] = set()
    own: list[AssumedClaim] = []
    assumed = assumptions or ClaimAssumptions()
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
    assumed, claim = split_claim(what)
    return AssumedClaim(home.read(claim), assumed)


def _own(home: Definitions, claims: list[AssumedClaim], expected: ClaimVerdict) -> list[Task]:
    parts = [str(k) if len(claims) > 1 else "" for k in range(1, len(claims) + 1)]
    name = home.specification.set_name
    return [
        Task(OWN, k, "", None, name, x.query.text, expected, x.texts)
        for k, x in zip(parts, claims, strict=True)
    ]


def _within_limits(question: ProveQuestion, home: Definitions, engine: Engine, given: Prove) -> ProveQuestion:
    """Return the claims about drives on one road up to a horizon, within models of vehicles.

    Raises ``InputError``, ``UsageError``.
    """
    from roadproof.engines.setting import SearchOptions, exists_mode

    if not question.are_own:
        raise UsageError(
            f"engine={engine!r} requires claims of your own: template properties are about all time"
        )
    if any(x.task.assuming for x in question.tasks):
        raise UsageError(
            f"engine={engine!r} is about drives anyway, at the values of params: assume nothing, or ask "
            "engine='dense'"
        )
    where = SearchPlace(road=given.road, vehicles=given.vehicles, horizon=given.horizon, dt=given.dt)
    where = replace(where, strict=given.strict)
    place = replace(setting(home, where), values=dict(home.values))
    within = exists_mode(place, SearchOptions("any", engine))
    basis = replace(question.basis, values=dict(home.values))
    return replace(question, basis=basis, tasks=tuple(replace(x, within=within) for x in question.tasks))
