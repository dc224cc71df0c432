"""Recorded traffic, and the highD experiment on it."""

import re
import tempfile
from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import ClassVar, Unpack

from roadproof.errors import UsageError
from roadproof.evidence.strict import JsonObject
from roadproof.extensions.drivers.models import DRIVERS
from roadproof.extensions.traffic.evaluate.evaluate import Findings
from roadproof.extensions.traffic.evaluate.experiment import (
    Experiment,
    ExperimentOutcome,
    questions_for,
    run_experiment,
    saved_findings,
)
from roadproof.extensions.traffic.evaluate.questions import EvaluationSettings, askable
from roadproof.extensions.traffic.evaluate.recheck import recheck
from roadproof.extensions.traffic.evaluate.results import (
    as_json,
    driver_cells,
    driver_columns,
    question_digest,
    uncertain_pairs,
)
from roadproof.extensions.traffic.evaluate.totals import Totals
from roadproof.extensions.traffic.formats.clock import rate_text
from roadproof.extensions.traffic.formats.recording import Recording
from roadproof.extensions.traffic.formats.sources import find_sources
from roadproof.extensions.traffic.formats.table import Frame, frame_of
from roadproof.extensions.traffic.keywords import EvaluateKeywords
from roadproof.extensions.traffic.report.cases import recording_cases
from roadproof.extensions.traffic.report.figures import draw_figures, remove_report, write_report
from roadproof.extensions.traffic.report.research_questions import facts
from roadproof.extensions.traffic.report.tables import as_text
from roadproof.extensions.traffic.report.traffic import comparison_table, drivers_table, results_tables
from roadproof.extensions.traffic.scenario_parts import COMPARISON
from roadproof.extensions.traffic.settings import Evaluate
from roadproof.frontends.api.build_result import BuildResult
from roadproof.frontends.api.definitions import Definitions, load
from roadproof.frontends.api.table import Row, Table
from roadproof.frontends.report.cases import Case
from roadproof.frontends.report.picture import Picture, picture
from roadproof.frontends.settings.option import takes
from roadproof.library.bind import exact
from roadproof.library.scenarios import MIN_DANGER
from roadproof.runtime.executors import executor_for
from roadproof.runtime.files import lock_folder
from roadproof.runtime.pool import Say
from roadproof.runtime.records import dataclass
from roadproof.verdict import ExitCode, Verdict

MOST_FACTS = 12
_HALF_WRITTEN = re.compile(r"\..+\.(json|csv|txt|md|tex|png|svg)\.[a-z0-9_]{8}")


@dataclass(frozen=True, repr=False)
class Evaluation(Table, BuildResult):
    """The experiment on recordings: what danger arose, and which scenario matches it.

    ``failed``: recordings that were left out, and why; ``denied``: answers that the plain recursive
    evaluator, where it was asked, does not give; ``folder``: where the results were written, or None
    where all that was found is ``kept`` here.
    """

    experiment: Experiment
    outcome: ExperimentOutcome
    denied: tuple[str, ...] = ()
    folder: Path | None = None
    kept: tuple[Findings, ...] | None = None
    command: ClassVar[str] = "evaluate"

    def cases(self) -> Iterator[Case]:
        broken = [*self.totals.broken, *self.denied]
        names = sorted({*self.outcome.marks, *self.failed})
        where = self.experiment.recordings
        return recording_cases(names, self.failed, self.outcome.lost, broken, where)

    @property
    def settings(self) -> EvaluationSettings:
        """The settings of the evaluation."""
        return self.experiment.settings

    @property
    def findings(self) -> tuple[Findings, ...]:
        """The findings in each recording, read from the folder if there is one."""
        if self.kept is not None:
            return self.kept
        return tuple(findings for _, findings in saved_findings(self.experiment, self.outcome))

    @property
    def totals(self) -> Totals:
        """All counts."""
        return self.outcome.totals

    @property
    def failed(self) -> dict[str, str]:
        return self.outcome.failed

    @property
    def exit_code(self) -> ExitCode:
        if self.totals.broken or self.denied:
            return ExitCode.CROSSCHECK_FAILED
        return ExitCode.UNKNOWN if self.outcome.lost else ExitCode.AS_EXPECTED

    def rows(self) -> list[Row]:
        """A row for each road sector, minDanger and set; null for scenarios of other sectors."""
        return [
            {
                "sector": x.sector.name,
                "minDanger": float(x.min_danger),
                "set": x.set_name,
                "traces": x.traces,
                "matching": x.matching,
                "uncertain": x.uncertain,
                "possible": x.possible,
                "recall": x.recall,
                **{
                    f"s{i}": x.scenarios[i] if i in x.sector.scenarios else None
                    for i in self.settings.scenarios
                },
            }
            for rows in self.totals.shown.values()
            for x in rows
        ]

    def matches(self) -> Frame:
        """A row for each match: recording, vehicles, lane, frames, minDanger (s), spec set, scenario."""
        dangers = [float(x) for x in self.settings.min_danger]
        rows: list[Row] = [
            {
                "recording": x.recording,
                "SV": m.sv,
                "POV": m.pov,
                "POV2": m.pov2,
                "lane": m.lane,
                "first_frame": m.start_frame,
                "last_frame": m.end_frame,
                "minDanger": dangers[m.min_danger],
                "set": m.set_name,
                "scenario": m.scenario,
                "uncertain": m.uncertain,
                **dict(zip(driver_columns(self.settings), driver_cells(self.settings, m), strict=True)),
            }
            for x in self.findings
            for m in x.matches
        ]
        return frame_of(rows)

    def pairs(self) -> Frame:
        """A row for each trace on which danger arises, with whether a scenario of each set matches it."""
        dangers = [float(x) for x in self.settings.min_danger]
        rows: list[Row] = []
        for x in self.findings:
            matched = {(m.pair, m.min_danger, m.set_name) for m in x.matches}
            uncertain = uncertain_pairs(x)
            for trace in x.traces:
                pair = (trace.first, trace.second)
                row: Row = {"recording": x.recording, "first": trace.first, "second": trace.second}
                row |= {"minDanger": dangers[trace.min_danger]}
                row |= {"first_frame": trace.start_frame, "last_frame": trace.end_frame}
                row |= {"sectors": "; ".join(trace.sectors)}
                sets = self.settings.sets
                row |= {name: (pair, trace.min_danger, name) in matched for name in sets}
                row |= {f"{name}_uncertain": (pair, trace.min_danger, name) in uncertain for name in sets}
                rows.append(row)
        return frame_of(rows)

    def as_data(self) -> JsonObject:
        """Return the plain data of ``--json``."""
        return as_json(self.totals, self.failed)

    def plot(self) -> Picture:
        """The first of the figures."""
        return next(picture(figure) for _, figure in draw_figures(self.totals))

    def __str__(self) -> str:
        tables = [
            *results_tables(self.totals, self.failed).values(),
            comparison_table(self.totals, self.failed),
            drivers_table(self.totals),
        ]
        lines = [as_text(table) for table in tables if table is not None]
        known = facts(self.totals)
        lines += [f"- {fact}" for fact in known[:MOST_FACTS]]
        if len(known) > MOST_FACTS:
            where = "" if self.folder is None else f" in {self.folder / 'answers.md'}"
            lines.append(f"… {len(known) - MOST_FACTS} more{where}")
        broken = [*self.totals.broken, *self.denied]
        if broken:
            counts = f"{len(self.totals.broken)} facts violated, {len(self.denied)} answers denied"
            lines.append(f"{Verdict.CROSSCHECK_FAILED}: {counts}")
            lines += [f"  {line}" for line in broken[:20]]
        return "\n".join(lines)

    def __repr__(self) -> str:
        rows = sum(map(len, self.totals.shown.values()))
        return f"<Evaluated: {self.totals.recordings} recordings, {rows} rows>"


@takes(Evaluate)
def evaluate(
    path: str | Path,
    out: str | Path | None = None,
    using: Definitions | None = None,
    **options: Unpack[EvaluateKeywords],
) -> Evaluation:
    """Find where danger arises in recordings, and match it with scenarios (paper, RQ1 to RQ5).

    ``path``: a folder of recordings in one format, or the file of one. ``out``: where results go and are
    taken up again; None keeps nothing. ``using``: base, extA and ext where None. ``among``: all scenarios of
    two or three vehicles where None; those of road sectors that a recording does not have are not asked.
    ``min_danger`` in s; ``classes`` of vehicles; ``end``: what the end of a trace means. ``detectors``: also
    those of earlier works; ``check``: ask the plain recursive evaluator again. ``drivers``: models of
    ``driver.spec`` (``load(specs=["driver"])``), such as careful, that matches are put to. Raises
    ``InputError``, ``UsageError``.
    """
    arguments = Evaluate.of(options)
    models = tuple(arguments.drivers)
    definitions = using or load("base", "extA", "ext", specs=[DRIVERS] if models else [])
    settings = replace(_settings_of(definitions, arguments), drivers=models)
    if out is not None:
        return _evaluate(Path(path), Path(out), settings, arguments)
    if executor_for(arguments.jobs).shard is not None:
        raise UsageError("a shard requires out, the folder that the runs share")
    with tempfile.TemporaryDirectory() as folder:
        evaluation = _evaluate(Path(path), Path(folder), settings, replace(arguments, pictures=False))
        return replace(evaluation, folder=None, kept=evaluation.findings)


def _settings_of(definitions: Definitions, arguments: Evaluate) -> EvaluationSettings:
    """Return the settings of an evaluation. Raises ``UsageError``, ``InputError``."""
    if MIN_DANGER in definitions.values:
        raise UsageError(f"params {MIN_DANGER}: evaluate takes several values of it; use min_danger=(0, 0.6)")
    return EvaluationSettings(
        definitions.library,
        definitions.specification.options,
        definitions.all_values(),
        sets=definitions.sets,
        min_danger=tuple(exact(MIN_DANGER, x, "s") for x in arguments.min_danger),
        scenarios=definitions.among(arguments.among) or askable(definitions.specification),
        classes=tuple(arguments.classes),
        convention=arguments.end,
        detectors=COMPARISON if arguments.detectors else (),
    )


def _evaluate(path: Path, out: Path, settings: EvaluationSettings, arguments: Evaluate) -> Evaluation:
    """Evaluate into a folder, which is locked against other runs."""
    executor = executor_for(arguments.jobs)
    experiment = Experiment(
        path, out, settings, executor, arguments.keep_going, arguments.strict, arguments.road
    )
    say = arguments.tell or (lambda line: None)
    experiment.sources()
    with lock_folder(out, shared=executor.shard is not None):
        remove_report(out)
        outcome = run_experiment(experiment, say)
        denied = tuple(_denied(experiment, outcome, say)) if arguments.check else ()
        write_report(out, outcome.totals, outcome.failed, arguments.pictures)
        _sweep(out)
        return Evaluation(experiment, outcome, denied, out)


def _denied(experiment: Experiment, outcome: ExperimentOutcome, say: Say) -> Iterator[str]:
    """Yield the saved answers that the recursive evaluator denies, recording by recording."""
    question = question_digest(experiment.settings)
    for source, findings in saved_findings(experiment, outcome):
        recording = source.read()
        questions = questions_for(experiment.settings, question, recording)
        denied = list(recheck(recording, questions, findings))
        say(f"checked {source.name}: {len(denied)} answers denied")
        yield from denied


def _sweep(out: Path) -> None:
    """Remove what a killed run may have left: hidden files that were never put in their place."""
    for folder in (out, out / "recordings", out / "figures"):
        for path in folder.glob(".*"):
            if _HALF_WRITTEN.fullmatch(path.name):
                path.unlink(missing_ok=True)


# --- roads of recordings ----------------------------------------------------------------------------


@dataclass(frozen=True)
class RecordedRoad:
    """The lanes of a recording; for each its name, direction and lanelets, each with id, attribute and zone.

    ``notes``: what was inferred, and all that is odd in the recording.
    """

    recording: str
    format: str
    rate: int | Fraction
    vehicles: int
    lanes: tuple[tuple[str, int, tuple[tuple[str, str, str], ...]], ...]
    notes: tuple[str, ...]

    def __str__(self) -> str:
        head = f"{self.recording}: {self.format}, {rate_text(self.rate)} Hz, {self.vehicles} vehicles"
        return "\n".join([head, *self._lanes(), *(f"  note: {note}" for note in self.notes)])

    def _lanes(self) -> Iterator[str]:
        for name, direction, lanelets in self.lanes:
            attributes = " and ".join(dict.fromkeys(attribute for _, attribute, _ in lanelets))
            parts = ", ".join(f"{lanelet} in zone {zone}" for lanelet, _, zone in lanelets)
            yield f"  {attributes} lane {name}, direction {direction}: {parts}"


def roads(path: str | Path, road: str | None = None) -> tuple[RecordedRoad, ...]:
    """The roads of the recordings of ``path``, each read and checked as a whole.

    ``road``: of a map, for recordings that name no lanes (such as inD). Raises ``InputError``,
    ``UsageError``.
    """
    return tuple(_road(x.format.name, x.read()) for x in find_sources(Path(path), road=road))


def _road(format_name: str, recording: Recording) -> RecordedRoad:
    lanes = []
    for lane in recording.lanes:
        lanelets = tuple(
            (x.id, str(x.attribute), str(x.zone)) for x in recording.lanelets if x.lane == lane.name
        )
        lanes.append((lane.name, lane.direction, lanelets or ((lane.name, "main", "main"),)))
    return RecordedRoad(
        recording.name, format_name, recording.rate, recording.vehicles, tuple(lanes), recording.notes
    )
