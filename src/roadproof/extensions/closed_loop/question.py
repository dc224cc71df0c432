"""The question in which scenarios a vehicle under test fails."""

from collections.abc import Iterator, Sequence
from dataclasses import field
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar

from roadproof.errors import InputError, UsageError
from roadproof.evidence.claim import Claim, Exists, Mode, claim_of
from roadproof.evidence.codec import read
from roadproof.evidence.judged import JudgedDrive
from roadproof.evidence.subject import OTHER, Subject
from roadproof.extensions.catalogue.drive_targets import names_shown
from roadproof.extensions.catalogue.target_formulas import TargetFormulas
from roadproof.extensions.closed_loop.claim_names import FAILS, POSSIBLE, SHOWN, SIMULATED, claim_name
from roadproof.extensions.closed_loop.controllers.opening import ControllerSource
from roadproof.extensions.closed_loop.data import FalsifyRequest
from roadproof.extensions.closed_loop.driver_drives import driven_claims
from roadproof.extensions.closed_loop.mode import ClosedLoop, ControllerSearch, Part
from roadproof.extensions.closed_loop.requirement import VehicleRequirement, read_requirement
from roadproof.extensions.closed_loop.search.problem import TargetProblem
from roadproof.extensions.closed_loop.search.searching import Searching
from roadproof.extensions.closed_loop.search.shape import SituationShape, limits_of
from roadproof.extensions.closed_loop.simulation import LOOP
from roadproof.extensions.closed_loop.situation import StepClock
from roadproof.extensions.surveys.classify.division import divide_surely
from roadproof.extensions.traffic.evaluate.decisions import (
    Decision,
    Drivers,
    content_of,
    driver_models,
)
from roadproof.library.elaborate import read_claim
from roadproof.library.scenarios import SUBJECT, name_of, number_in
from roadproof.library.specification import Query
from roadproof.library.words import words_by_number
from roadproof.questions.basis import Basis
from roadproof.questions.question import Answers, QuestionBatch, Steps, walk_batch
from roadproof.runtime.budget import Work
from roadproof.runtime.canonical import digest
from roadproof.runtime.records import dataclass
from roadproof.world.drive import Drive
from roadproof.world.models import load_vehicle

if TYPE_CHECKING:
    from roadproof.extensions.closed_loop.data import FalsifyData
    from roadproof.extensions.closed_loop.view import FalsifyView
    from roadproof.questions.question import EvidencePlace


@dataclass(frozen=True)
class FalsifyQuestion:
    """The question what a controller does in each scenario, and in each class that no drive shows.

    ``seeds``: drives from which searches also start; none in a question about stored answers.
    """

    kind: ClassVar[str] = "falsify"
    basis: Basis
    settings: FalsifyRequest
    seeds: Sequence[Drive] = field(default=(), compare=False, repr=False)

    @property
    def work(self) -> Work:
        """The work that is allowed for a claim of the core."""
        return Work(self.basis.effort, self.basis.proof)

    @classmethod
    def of(cls, basis: Basis, settings: object, where: str) -> "FalsifyQuestion":
        """Return the question that plain data ask. Raises ``InputError``."""
        made = cls(basis, read(FalsifyRequest, settings, where))
        try:
            made.require_sense()
        except UsageError as error:
            raise InputError(f"{where}: {error}") from None
        return made

    def require_sense(self) -> None:
        """Check the requirements, the clock and the drivers. Raises ``UsageError``, ``TextError``."""
        request = self.settings
        if request.dt <= 0 or request.seconds < request.dt or (request.seconds / request.dt).denominator != 1:
            raise UsageError(
                f"step={request.dt}, seconds={request.seconds}: a simulation takes whole steps, at least one"
            )
        _ = self.requirements, self.drivers, self.formulas

    # --- what is asked -------------------------------------------------------------------------------

    @cached_property
    def clock(self) -> StepClock:
        """The clock of all simulations."""
        return StepClock(self.settings.dt, int(self.settings.seconds / self.settings.dt))

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
        """The formulas of all targets. Raises ``UsageError`` where classes are in doubt."""
        numbers = self.settings.scenarios
        classes = divide_surely(self.basis, numbers) if self.settings.classes else None
        return TargetFormulas(self.basis.specification, numbers, classes, self.basis.all_values())

    @property
    def classes(self) -> tuple[str, ...]:
        """The names of all classes that are not proved impossible."""
        known = self.formulas.classes
        return () if known is None else tuple(x.name for x in known.all())

    def title(self, target: str) -> str:
        """Return a scenario in words, or the scenarios of a class."""
        words, number = words_by_number(self.basis.specification), number_in(target)
        if number is not None:
            return words[number].title
        classes = self.formulas.classes
        assert classes is not None
        one = next(x for x in classes.all() if x.name == target)
        numbers = ", ".join(map(str, one.scenarios))
        return f"scenario{'s' * (len(one.scenarios) > 1)} {numbers} and no other"

    # --- claims --------------------------------------------------------------------------------------

    def batches(self, known: Answers) -> Sequence[QuestionBatch]:
        """Return a batch for each scenario; then one for each class that no drive shows so far."""
        first = self._scenario_batches
        if [x for x in first if [*walk_batch(x, lambda name, _: known.get(name))]]:
            return first
        before = {claim_name(part, name_of(n)) for part in (FAILS, SHOWN) for n in self.settings.scenarios}
        shown = self.names_shown({name: x for name, x in known.items() if name in before})
        return [*first, *(TargetBatch(self, x) for x in self.classes if x not in shown)]

    @cached_property
    def _scenario_batches(self) -> "list[TargetBatch]":
        return [TargetBatch(self, name_of(n)) for n in self.settings.scenarios]

    def names_shown(self, known: Answers) -> dict[str, list[str]]:
        """Return the targets that drives of the controller show, each with the names of the claims."""
        shown: dict[str, list[str]] = {}
        for name, answer in known.items():
            part, _, rest = name.partition("-")
            if part in (FAILS, SHOWN) and "-" not in rest and answer.drive is not None:
                for target in names_shown(answer.drive, self.formulas):
                    shown.setdefault(target, []).append(name)
        return shown

    def possible(self, target: str) -> Claim:
        """Return the claim that some drive, with or without the controller, shows a target."""
        return self.basis.claim(self.formulas.query_of(target))

    def problem(self, target: str, pattern: JudgedDrive) -> TargetProblem:
        """Return the problem of a search for a target from a drive on."""
        file, home = pattern.file, self.basis.specification
        models = self.basis.vehicles
        car = models.get("", None) or load_vehicle("car")
        limits = {name: limits_of(models.get(name, car), name == SUBJECT) for name in file.drive.vehicles}
        shape = SituationShape(file, self.clock, limits)
        query = self.formulas.query_of(target)
        parts = [x.broken(shape.vehicles, self.clock.horizon) for x in self.requirements]
        broken = f"({' or '.join(parts)})"
        is_scenario = number_in(target) is not None
        exists = Exists()
        return TargetProblem(
            target,
            shape,
            self._claim(query, exists),
            self._claim(read_claim(home, f"{query.text} and {broken}"), exists) if is_scenario else None,
            self._claim(read_claim(home, broken), exists) if is_scenario else None,
            self.drivers if is_scenario else None,
            self.basis.all_values(),
        )

    def _claim(self, query: Query, mode: Mode) -> Claim:
        return claim_of(self.basis.specification, query, mode, self.basis.values)

    def search(self, target: str, pattern: JudgedDrive, part: Part) -> Claim:
        """Return the claim about a search for a target from a drive on."""
        problem, request = self.problem(target, pattern), self.settings
        source = ControllerSource(request.controller, request.kind, request.sha256)
        starts = tuple(problem.shape.fitted(x) for x in self.seeds if problem.shape.fits(x))
        limit, seed, method, kind = request.simulations, request.seed, request.method, request.wanted
        searching = Searching(problem, limit, seed, method, kind, starts)
        drivers = "" if self.drivers is None else content_of(self.drivers)
        limits = (
            request.simulations,
            request.seed,
            request.dt,
            request.seconds,
            request.method,
            request.wanted,
            request.seeds,
        )
        shape = problem.shape.pattern.drive, problem.shape.pattern.road, problem.shape.limits
        about = target, problem.shown.formula, request.require, drivers, dict(problem.values)
        key = digest(LOOP, request.sha256, request.kind, *limits, *shape, *about)
        mode = ClosedLoop(part, key, ControllerSearch(source, searching, request.patience))
        claim = problem.fails if part == "fails" and problem.fails is not None else problem.shown
        return self._claim(claim.query, mode)

    def decisions(self, target: str, failing: JudgedDrive) -> tuple[Decision, ...]:
        """Return the decisions of the driver models on a failing drive, worked out once."""
        key = ("driven", target, id(failing))
        return self.formulas.cache.of(key, failing, lambda: self.problem(target, failing).decisions(failing))

    def driven(self, target: str, failing: JudgedDrive) -> Iterator[tuple[str, Decision, Claim]]:
        """Yield for each driver model the claim about its drive in the place of the controller."""
        home = self.basis.specification
        yield from driven_claims(home, failing, self.decisions(target, failing), FAILS, target)

    def label(self, name: str) -> str:
        """Return what the claim of a name is about, in words."""
        part, _, rest = name.partition("-")
        target, _, driver = rest.partition("-")
        words = {
            POSSIBLE: f"{target}, with or without the controller",
            SIMULATED: f"{target}, all simulations",
            FAILS: f"{target}, failure",
            SHOWN: f"{target}, shown",
        }
        return f"{target}, {driver} in the place of the controller" if driver else words.get(part, name)

    def subject(self, name: str) -> Subject:
        """Return no subject: requirements do not link to drives of a controller yet."""
        return OTHER

    # --- view and data: see view.py -----------------------------------------------------------------

    def view(self, known: Answers) -> "FalsifyView":
        """Return what became of each target."""
        from roadproof.extensions.closed_loop.view import view_of

        return view_of(self, known)

    def data(self, view: "FalsifyView", place: "EvidencePlace", seconds: float) -> "FalsifyData":
        """Return the view as ``--json`` prints it."""
        from roadproof.extensions.closed_loop.view import data_of

        return data_of(self, view, place, seconds)


@dataclass(frozen=True)
class TargetBatch:
    """The claims about one scenario or class, which one process settles."""

    question: FalsifyQuestion
    target: str

    @property
    def name(self) -> str:
        """The target."""
        return self.target

    def steps(self) -> Steps:
        """Yield whether the target is possible; then the search, its drives, and those of driver models."""
        question, target = self.question, self.target
        possible = yield claim_name(POSSIBLE, target), question.possible(target)
        pattern = possible.drive
        if pattern is None:
            return
        yield claim_name(SIMULATED, target), question.search(target, pattern, "simulations")
        if number_in(target) is not None:
            failing = yield claim_name(FAILS, target), question.search(target, pattern, "fails")
            if failing.drive is not None:
                for name, _, claim in question.driven(target, failing.drive):
                    yield name, claim
        yield claim_name(SHOWN, target), question.search(target, pattern, "shown")
