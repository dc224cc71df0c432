"""``roadproof.falsify``: a search for the scenarios in which a vehicle under test fails."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar, Unpack

from roadproof.errors import InputError, RoadproofError, UsageError
from roadproof.evidence.drive_file import load_drive
from roadproof.extensions.closed_loop import report, settings
from roadproof.extensions.closed_loop.cases import falsify_cases
from roadproof.extensions.closed_loop.claim_names import FAILS, claim_name
from roadproof.extensions.closed_loop.controllers.opening import source_of
from roadproof.extensions.closed_loop.data import FalsifyRequest
from roadproof.extensions.closed_loop.drive_tests import drive_files
from roadproof.extensions.closed_loop.plane import draw_plane
from roadproof.extensions.closed_loop.question import FalsifyQuestion
from roadproof.extensions.closed_loop.regression import WrittenTests, write_tests
from roadproof.extensions.closed_loop.requirement_words import with_words
from roadproof.extensions.closed_loop.view import FalsifyView, TargetView
from roadproof.extensions.drivers.models import MODELS
from roadproof.extensions.surveys.classify.classes import plan_of
from roadproof.frontends.api.build_result import BuildResult
from roadproof.frontends.api.definitions import Definitions, definitions_of
from roadproof.frontends.api.question_answers import QuestionAnswers
from roadproof.frontends.api.settings import basis_of
from roadproof.frontends.report.picture import Picture, draw_drive, drawn, draws_drives, picture
from roadproof.frontends.report.sheet import Sheet
from roadproof.frontends.settings.option import takes
from roadproof.library.bind import exact
from roadproof.library.scenarios import numbers_of
from roadproof.runtime.canonical import digest
from roadproof.runtime.files import utf8
from roadproof.runtime.records import dataclass
from roadproof.verdict import ExitCode, Verdict
from roadproof.world.drive import Drive

if TYPE_CHECKING:
    from roadproof.evidence.answer import ClaimAnswer
    from roadproof.extensions.closed_loop.keywords import FalsifyKeywords
    from roadproof.frontends.report.cases import Case


@dataclass(frozen=True, repr=False)
class Falsification(QuestionAnswers[FalsifyView], BuildResult):
    """The findings about a vehicle under test in each scenario and class.

    ``notes``: what was left out, and why.
    """

    question: FalsifyQuestion
    notes: tuple[str, ...] = ()
    pieces: ClassVar[str] = "scenarios and classes"
    command: ClassVar[str] = "falsify"

    @property
    def targets(self) -> tuple[TargetView, ...]:
        """The scenarios and classes, each with its finding and drives."""
        return self.view.targets

    @property
    def findings(self) -> dict[str, str]:
        """FAILS, SHOWN, NOT SHOWN, IMPOSSIBLE or ERROR for each scenario and class."""
        return {x.name: x.finding for x in self.targets}

    @property
    def verdicts(self) -> dict[str, Verdict]:
        """REFUTED where the controller fails, WITNESSED where a drive shows it, else as the core says."""
        known = {
            "FAILS": Verdict.REFUTED,
            "SHOWN": Verdict.WITNESSED,
            "NOT SHOWN": Verdict.UNKNOWN,
            "IMPOSSIBLE": Verdict.IMPOSSIBLE,
            "ERROR": Verdict.UNKNOWN,
        }
        return {x.name: known[x.finding] for x in self.targets}

    @property
    def exit_code(self) -> ExitCode:
        """The exit code: of a failure, else of a scenario that was not shown or an error, else 0."""
        if self.view.failures:
            return ExitCode.UNEXPECTED
        open_ones = [x for x in self.targets if x.finding in ("NOT SHOWN", "ERROR")]
        is_open = any(x.is_scenario or x.finding == "ERROR" for x in open_ones)
        return ExitCode.UNKNOWN if is_open else ExitCode.AS_EXPECTED

    def cases(self) -> Iterator[Case]:
        """Yield a case for each scenario; a failure fails."""
        return falsify_cases(self.view, self.folder, self.question.basis.specification)

    def each_picture(self) -> Iterator[tuple[str, Picture]]:
        """Yield the plane of all simulations of each scenario, and the failing drives beside the drivers'."""
        for x in self.targets:
            if x.simulations is not None and x.simulations.points and x.is_scenario:
                yield f"plane-{x.name}", picture(draw_plane(x))
        for x in self.view.failures if draws_drives() else ():
            drives = {claim_name(FAILS, x.name): x.failing, **self._driven(x)}
            for name, answer in drives.items():
                if answer is not None and answer.drive is not None:
                    yield name, draw_drive(answer.drive.file, self.library)

    def _driven(self, x: TargetView) -> dict[str, ClaimAnswer]:
        return {claim_name(FAILS, x.name, driver): answer for driver, answer in x.driven.items()}

    def files(self, pictures: bool) -> dict[str, bytes]:
        """Return a table of all simulations, and with ``pictures`` those, by file name."""
        table = utf8(report.simulations_csv(self.view))
        return {"simulations.csv": table} | drawn(self.pictures() if pictures else {})

    def write_tests(self, folder: str | Path, formats: str | Iterable[str] = ()) -> WrittenTests:
        """Write the failing drives into a folder as tests with a ``catalogue.toml``.

        ``formats``: other formats of ``export``, each copy with an entry. Raises ``InputError``,
        ``UsageError``.
        """
        return write_tests(Path(folder), self.question, self.view, formats)

    @property
    def _sheet(self) -> Sheet[TargetView]:
        return report.sheet_of(self.view)

    def __str__(self) -> str:
        return report.as_text(self.view, self.notes)


@takes(settings.Falsify)
def falsify(
    controller: str, using: Definitions | None = None, **options: Unpack[FalsifyKeywords]
) -> Falsification:
    """Search for the scenarios in which a controller breaks a requirement.

    ``controller``: FILE.py:NAME, FILE.fmu, or a command that speaks JSON lines. ``require``: requirements
    ``G φ`` on SV and POV. ``drivers``: driver models that are put into failing drives, all where None. The
    same ``seed`` gives the same answer. ``seeds``: drive files from which the search also starts. ``out``: a
    folder for evidence. Raises ``InputError``, ``UsageError``.
    """
    given = settings.Falsify.of(options)
    home = with_words(given.modified(definitions_of(using), given.among))
    source = source_of(controller)
    numbers = home.among(given.among) or numbers_of(home.alone)
    models = tuple(MODELS if given.drivers is None else given.drivers)
    unknown = [x for x in models if x not in MODELS]
    if unknown:
        raise UsageError(f"drivers={unknown[0]}: there are {', '.join(MODELS)}")
    is_divided, notes = given.classes, tuple[str, ...]()
    if is_divided:
        try:
            plan_of(home.alone, numbers)
        except RoadproofError as error:
            is_divided, notes = False, (f"note: classes are left out: {error}",)
    seeds = _drives(given.seeds)
    request = FalsifyRequest(
        controller=controller,
        kind=source.kind,
        sha256=source.sha256,
        scenarios=tuple(numbers),
        require=tuple(given.require),
        drivers=models,
        classes=is_divided,
        simulations=given.simulations,
        seed=given.seed,
        seeds=tuple(digest(x) for x in seeds),
        dt=exact("step", given.step, "s"),
        seconds=exact("seconds", given.seconds, "s"),
        method=given.method,
        wanted=given.failures,
        patience=float(given.patience),
    )
    question = FalsifyQuestion(basis_of(home, given, given.vehicles), request, seeds)
    question.require_sense()
    return replace(Falsification.decide(question, given), notes=notes)


def _drives(path: str | Path | None) -> tuple[Drive, ...]:
    """Return the drives of a file or a folder. Raises ``InputError`` where there is none."""
    if path is None:
        return ()
    files = drive_files(Path(path))
    if not files:
        raise InputError(f"seeds={path}: there is no drive file (*.json) in it")
    return tuple(load_drive(x).drive for x in files)
