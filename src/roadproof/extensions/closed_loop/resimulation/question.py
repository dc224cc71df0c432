"""The question what a controller does in place of recorded vehicles."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import field
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar

from roadproof.errors import InputError, UsageError
from roadproof.evidence.claim import Claim, Exists, claim_of
from roadproof.evidence.codec import read
from roadproof.evidence.judged import JudgedDrive
from roadproof.evidence.subject import OTHER, Subject
from roadproof.extensions.catalogue.target_formulas import TargetFormulas
from roadproof.extensions.closed_loop.claim_names import BREAKS, KEEPS, claim_name
from roadproof.extensions.closed_loop.controllers.opening import ControllerSource
from roadproof.extensions.closed_loop.driver_drives import decisions_on, driven_claims, models_of
from roadproof.extensions.closed_loop.requirement import VehicleRequirement, read_requirement
from roadproof.extensions.closed_loop.resimulation.data import RecordedOccurrence, ResimulationRequest
from roadproof.extensions.closed_loop.resimulation.mode import RecordedRun, RequirementPart, Resimulation
from roadproof.extensions.closed_loop.simulation import LOOP
from roadproof.extensions.closed_loop.situation import TrafficSituation
from roadproof.extensions.traffic.evaluate.decisions import Decision, Drivers, driver_models
from roadproof.library.elaborate import read_claim
from roadproof.library.scenarios import name_of
from roadproof.questions.basis import Basis
from roadproof.questions.question import Answers, QuestionBatch, Steps
from roadproof.runtime.budget import Work
from roadproof.runtime.canonical import digest
from roadproof.runtime.records import dataclass

if TYPE_CHECKING:
    from roadproof.extensions.closed_loop.resimulation.data import ResimulationData
    from roadproof.extensions.closed_loop.resimulation.view import ResimulationView
    from roadproof.questions.question import EvidencePlace


@dataclass(frozen=True)
class ResimulationQuestion:
    """The question whether a controller keeps the requirements in place of the SV of each occurrence.

    ``situations``: by occurrence; empty in a question about stored answers, which drives nothing.
    """

    kind: ClassVar[str] = "resimulate"
    basis: Basis
    settings: ResimulationRequest
    situations: Mapping[str, TrafficSituation] = field(default_factory=dict, compare=False, repr=False)

    @property
    def work(self) -> Work:
        """The work that is allowed for a claim of the core."""
        return Work(self.basis.effort, self.basis.proof)

    @classmethod
    def of(cls, basis: Basis, settings: object, where: str) -> "ResimulationQuestion":
        """Return the question that plain data ask. Raises ``InputError``."""
        made = cls(basis, read(ResimulationRequest, settings, where))
        try:
            made.require_sense()
        except UsageError as error:
            raise InputError(f"{where}: {error}") from None
        return made

    def require_sense(self) -> None:
        """Check the requirements and the drivers. Raises ``UsageError``, ``TextError``."""
        _ = self.requirements, self.drivers

    @cached_property
    def requirements(self) -> tuple[VehicleRequirement, ...]:
        """The requirements. Raises ``UsageError``, ``TextError``."""
        home, values = self.basis.specification, self.basis.all_values()
        return tuple(read_requirement(home, values, x) for x in self.settings.require)

    @cached_property
    def drivers(self) -> Drivers | None:
        """The driver models that are put in the place of SV."""
        return driver_models(self.basis.specification, self.basis.all_values(), self.settings.drivers)

    @cached_property
    def formulas(self) -> TargetFormulas:
        """The formulas of all scenarios."""
        values = self.basis.all_values()
        return TargetFormulas(self.basis.specification, self.settings.scenarios, None, values)

    # --- claims --------------------------------------------------------------------------------------

    def batches(self, known: Answers) -> Sequence[QuestionBatch]:
        """Return a batch for each occurrence."""
        return [OccurrenceBatch(self, x) for x in self.settings.occurrences]

    def broken(self, x: RecordedOccurrence) -> str:
        """Return the formula that a requirement is broken while the controller drives."""
        parts = [y.broken(tuple(x.vehicles), x.seconds) for y in self.requirements]
        return f"({' or '.join(parts)})"

    def driven_by_controller(self, x: RecordedOccurrence, part: RequirementPart) -> Claim:
        """Return the claim that the controller breaks a requirement, or that it keeps all of them."""
        request, home = self.settings, self.basis.specification
        broken = self.broken(x)
        query = read_claim(home, broken if part == "breaks" else f"not {broken}")
        source = ControllerSource(request.controller, request.kind, request.sha256)
        situation = self.situations.get(x.id)
        run = None if situation is None else RecordedRun(source, situation, request.patience)
        key = digest(LOOP, request.sha256, request.kind, request.dt, x.seconds, x.sha256)
        return claim_of(home, query, Resimulation(part, key, run), self.basis.values)

    def scenario(self, x: RecordedOccurrence) -> str:
        """Return the first scenario of an occurrence of which a driver model speaks; else the first one."""
        names = [name_of(n) for n in x.scenarios]
        return next((name for name in names if models_of(self.drivers, name)), names[0])

    def decisions(self, x: RecordedOccurrence, failing: JudgedDrive) -> tuple[Decision, ...]:
        """Return the decisions of the driver models on a failing drive, worked out once."""
        home, scenario = self.basis.specification, self.scenario(x)

        def decide() -> tuple[Decision, ...]:
            breach = claim_of(home, read_claim(home, self.broken(x)), Exists(), self.basis.values)
            vehicles, values = tuple(x.vehicles), self.basis.all_values()
            return decisions_on(failing, self.drivers, scenario, vehicles, breach, values)

        return self.formulas.cache.of(("driven", x.id, id(failing)), failing, decide)

    def driven(self, x: RecordedOccurrence, failing: JudgedDrive) -> Iterator[tuple[str, Decision, Claim]]:
        """Yield for each driver model the claim about its drive in the place of the controller."""
        home = self.basis.specification
        yield from driven_claims(home, failing, self.decisions(x, failing), BREAKS, x.id)

    def label(self, name: str) -> str:
        """Return what the claim of a name is about, in words."""
        part, _, rest = name.partition("-")
        occurrence, _, driver = rest.partition("-")
        words = {BREAKS: f"{occurrence}, failure", KEEPS: f"{occurrence}, no failure"}
        return f"{occurrence}, {driver} in the place of the controller" if driver else words.get(part, name)

    def subject(self, name: str) -> Subject:
        """Return no subject: requirements do not link to drives of a controller yet."""
        return OTHER

    # --- view and data: see view.py -----------------------------------------------------------------

    def view(self, known: Answers) -> "ResimulationView":
        """Return what became of each occurrence."""
        from roadproof.extensions.closed_loop.resimulation.view import view_of

        return view_of(self, known)

    def data(self, view: "ResimulationView", place: "EvidencePlace", seconds: float) -> "ResimulationData":
        """Return the view as ``--json`` prints it."""
        from roadproof.extensions.closed_loop.resimulation.view import data_of

        return data_of(self, view, place, seconds)


@dataclass(frozen=True)
class OccurrenceBatch:
    """The claims about one occurrence, which one process settles."""

    question: ResimulationQuestion
    occurrence: RecordedOccurrence

    @property
    def name(self) -> str:
        """The occurrence."""
        return self.occurrence.id

    def steps(self) -> Steps:
        """Yield whether the controller breaks a requirement; then driver models, or that it keeps them."""
        question, x = self.question, self.occurrence
        breaks = yield claim_name(BREAKS, x.id), question.driven_by_controller(x, "breaks")
        if breaks.drive is None:
            yield claim_name(KEEPS, x.id), question.driven_by_controller(x, "keeps")
            return
        for name, _, claim in question.driven(x, breaks.drive):
            yield name, claim
