"""``roadproof.resimulate``: a controller in place of recorded vehicles."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar, Unpack

from roadproof.errors import InputError, UsageError
from roadproof.extensions.catalogue.target_formulas import TargetFormulas
from roadproof.extensions.closed_loop import settings
from roadproof.extensions.closed_loop.controllers.opening import source_of
from roadproof.extensions.closed_loop.drive_tests import drive_files
from roadproof.extensions.closed_loop.requirement_words import with_words
from roadproof.extensions.closed_loop.resimulation import report
from roadproof.extensions.closed_loop.resimulation.data import ResimulationRequest
from roadproof.extensions.closed_loop.resimulation.occurrence import (
    OccurrenceLimits,
    RecordedSituation,
    with_own_ids,
)
from roadproof.extensions.closed_loop.resimulation.question import ResimulationQuestion
from roadproof.extensions.closed_loop.resimulation.recorded import situations_in
from roadproof.extensions.closed_loop.resimulation.tested import situations_of
from roadproof.extensions.closed_loop.resimulation.view import OccurrenceView, ResimulationView
from roadproof.extensions.closed_loop.search.shape import limits_of
from roadproof.extensions.drivers.models import MODELS
from roadproof.extensions.traffic.evaluating import Evaluation, evaluate
from roadproof.frontends.api.build_result import BuildResult
from roadproof.frontends.api.definitions import Definitions, definitions_of
from roadproof.frontends.api.question_answers import QuestionAnswers
from roadproof.frontends.api.settings import basis_of
from roadproof.frontends.report.picture import Picture, draw_drive, drawn, draws_drives
from roadproof.frontends.report.sheet import Sheet
from roadproof.frontends.settings.option import takes
from roadproof.library.bind import exact
from roadproof.library.scenarios import MIN_DANGER, SUBJECT, numbers_of
from roadproof.questions.basis import Basis
from roadproof.runtime.executors import executor_for
from roadproof.runtime.records import dataclass
from roadproof.verdict import ExitCode, Verdict
from roadproof.world.models import load_vehicle

if TYPE_CHECKING:
    from roadproof.extensions.closed_loop.keywords import ResimulateKeywords
    from roadproof.frontends.report.cases import Case


@dataclass(frozen=True, repr=False)
class Resimulated(QuestionAnswers[ResimulationView], BuildResult):
    """The findings about a controller in place of the SV of each occurrence.

    ``notes``: recordings that were left out, and why.
    """

    question: ResimulationQuestion
    notes: tuple[str, ...] = ()
    pieces: ClassVar[str] = "occurrences"
    command: ClassVar[str] = "resimulate"

    @property
    def occurrences(self) -> tuple[OccurrenceView, ...]:
        """The occurrences, each with its finding and drives."""
        return self.view.occurrences

    @property
    def findings(self) -> dict[str, str]:
        """FAILS, KEPT or ERROR for each occurrence."""
        return {x.id: x.finding for x in self.occurrences}

    @property
    def verdicts(self) -> dict[str, Verdict]:
        """REFUTED where the controller fails, WITNESSED where it keeps the requirements, else UNKNOWN."""
        known = {"FAILS": Verdict.REFUTED, "KEPT": Verdict.WITNESSED, "ERROR": Verdict.UNKNOWN}
        return {x.id: known[x.finding] for x in self.occurrences}

    @property
    def exit_code(self) -> ExitCode:
        """The exit code: of a failure, else of an error, else 0."""
        if self.view.failures:
            return ExitCode.UNEXPECTED
        is_open = any(x.finding == "ERROR" for x in self.occurrences)
        return ExitCode.UNKNOWN if is_open else ExitCode.AS_EXPECTED

    def cases(self) -> Iterator[Case]:
        """Yield a case for each occurrence; a failure fails."""
        return report.occurrence_cases(self.view, self.folder)

    def each_picture(self) -> Iterator[tuple[str, Picture]]:
        """Yield the failing drives, and those of driver models."""
        for x in self.view.failures if draws_drives() else ():
            if x.drive is not None:
                yield x.claim_name, draw_drive(x.drive.file, self.library)
            for name, answer in x.driven.items():
                if answer.drive is not None:
                    yield f"{x.claim_name}-{name}", draw_drive(answer.drive.file, self.library)

    def files(self, pictures: bool) -> dict[str, bytes]:
        """Return pictures by file name."""
        return drawn(self.pictures() if pictures else {})

    @property
    def _sheet(self) -> Sheet[OccurrenceView]:
        return report.sheet_of(self.view)

    def __str__(self) -> str:
        return report.as_text(self.view, self.notes)


@takes(settings.Resimulate)
def resimulate(
    controller: str,
    path: str | Path,
    using: Definitions | None = None,
    **options: Unpack[ResimulateKeywords],
) -> Resimulated:
    """Put a controller in the place of SV wherever a scenario occurs in recordings, or in drive files.

    ``controller``: FILE.py:NAME, FILE.fmu, or a command that speaks JSON lines. ``path``: a folder of
    recordings in one format, or the file of one; or a drive file, or a folder of such files. ``require``:
    requirements ``G φ`` on SV and POV. All other vehicles move as they did. ``out``: a folder for evidence.
    Raises ``InputError``, ``UsageError``.
    """
    given = settings.Resimulate.of(options)
    home = with_words(definitions_of(using))
    _ = home.alone
    source = source_of(controller)
    models = tuple(MODELS if given.drivers is None else given.drivers)
    unknown = [x for x in models if x not in MODELS]
    if unknown:
        raise UsageError(f"drivers={unknown[0]}: there are {', '.join(MODELS)}")
    dt, seconds = exact("step", given.step, "s"), exact("seconds", given.seconds, "s")
    if dt <= 0 or seconds < dt:
        raise UsageError(f"step={dt}, seconds={seconds}: a simulation takes at least one step")
    basis = basis_of(home, given, given.vehicles)
    car = basis.vehicles.get("", None) or load_vehicle("car")
    limits = OccurrenceLimits(dt, seconds, limits_of(basis.vehicles.get(SUBJECT, car), True))
    every, scenarios, notes = _occurrences(Path(path), home, given, basis, limits)
    request = ResimulationRequest(
        controller=controller,
        kind=source.kind,
        sha256=source.sha256,
        recordings=str(path),
        scenarios=scenarios,
        require=tuple(given.require),
        drivers=models,
        dt=dt,
        patience=float(given.patience),
        occurrences=tuple(x.occurrence for x in every),
    )
    question = ResimulationQuestion(basis, request, {x.occurrence.id: x.situation for x in every})
    question.require_sense()
    return replace(Resimulated.decide(question, given), notes=notes)


def _occurrences(
    path: Path, home: Definitions, given: settings.Resimulate, basis: Basis, limits: OccurrenceLimits
) -> tuple[list[RecordedSituation], tuple[int, ...], tuple[str, ...]]:
    """Return the occurrences in drives or recordings, the scenarios that were looked for, and notes."""
    files, numbers = drive_files(path), home.among(given.among)
    notes = tuple[str, ...]()
    if files:
        every = [*with_own_ids(situations_of(files, _formulas(basis), limits, numbers or ()))]
        scenarios = tuple(numbers or numbers_of(home.alone))
    else:
        evaluation = _evaluation(path, home, given)
        every = [*with_own_ids(_situations(evaluation, limits))]
        scenarios = evaluation.settings.scenarios
        notes = tuple(f"note: {name} is left out: {why}" for name, why in evaluation.failed.items())
    if not every:
        raise InputError(
            f"{path}: none of the scenarios {', '.join(map(str, scenarios))} occurs in it; see roadproof "
            f"{'catalogue' if files else 'evaluate'}, or name others with --among"
        )
    return every, scenarios, notes


def _formulas(basis: Basis) -> TargetFormulas:
    numbers = numbers_of(basis.specification)
    return TargetFormulas(basis.specification, numbers, None, basis.all_values())


def _evaluation(path: str | Path, home: Definitions, given: settings.Resimulate) -> Evaluation:
    """Return where the scenarios of one spec set occur, at one value of minDanger."""
    others = {name: value for name, value in home.values.items() if name != MIN_DANGER}
    return evaluate(
        path,
        using=replace(home, values=others),
        among=given.among,
        min_danger=(home.all_values()[MIN_DANGER],),
        classes=given.kinds,
        detectors=False,
        road=given.road,
        pictures=False,
        jobs=executor_for(given.jobs).processes,
    )


def _situations(evaluation: Evaluation, limits: OccurrenceLimits) -> Iterator[RecordedSituation]:
    """Yield the occurrences in all recordings, one recording in memory at a time."""
    findings = {x.recording: x for x in evaluation.findings}
    for source in evaluation.experiment.sources():
        if source.name in findings and findings[source.name].matches:
            yield from situations_in(source.read(), findings[source.name], limits)
