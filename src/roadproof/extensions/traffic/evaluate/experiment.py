"""The highD experiment over many recordings: resumable, and in memory one recording a process."""

import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing
from dataclasses import dataclass, field
from pathlib import Path

from roadproof.errors import InputError, SharedError
from roadproof.extensions.traffic.evaluate import results
from roadproof.extensions.traffic.evaluate.evaluate import Findings, evaluate_windows
from roadproof.extensions.traffic.evaluate.questions import (
    EvaluationQuestions,
    EvaluationSettings,
    compile_questions,
)
from roadproof.extensions.traffic.evaluate.totals import Totals
from roadproof.extensions.traffic.formats.clock import Rate
from roadproof.extensions.traffic.formats.recording import Recording
from roadproof.extensions.traffic.formats.source import RecordingSource
from roadproof.extensions.traffic.formats.sources import copies_among, find_sources
from roadproof.extensions.traffic.formats.windows import TimeWindow, WindowedRecording
from roadproof.runtime.dispatch import run_jobs
from roadproof.runtime.executors import Executor, LostJob, is_fork_unsafe
from roadproof.runtime.memory import keep_freed_memory
from roadproof.runtime.worker import is_worker


@dataclass(frozen=True)
class Experiment:
    """The folders of recordings and of results, and the settings of an evaluation.

    ``strict``: no vehicle is left out of a recording. ``road``: of a map, for recordings without their own.
    """

    recordings: Path
    out: Path
    settings: EvaluationSettings
    hands: Executor = field(default_factory=lambda: Executor(1))
    keep_going: bool = False
    strict: bool = False
    road: str | None = None

    def sources(self) -> tuple[RecordingSource, ...]:
        """The recordings. Raises ``InputError``, ``UsageError``."""
        return find_sources(self.recordings, self.strict, self.road)


@dataclass(frozen=True)
class ExperimentOutcome:
    """The totals, the recordings that could not be used, and why, and what marks the results of each.

    ``lost`` are those among them whose process ended each time, which may be the machine's fault.
    """

    totals: Totals
    failed: dict[str, str]
    marks: Mapping[str, str]
    lost: tuple[str, ...] = ()


def run_experiment(
    experiment: Experiment, tell: Callable[[str], None] = lambda line: None
) -> ExperimentOutcome:
    """Evaluate every recording that has no valid result yet, then write the results of all.

    ``tell`` gets a line for each recording that is done. Raises ``InputError`` for the first
    recording that cannot be evaluated, unless ``keep_going``: then it is left out, and said so. One of
    several runs that divide the recordings raises ``SharedError`` when its share is done.
    """
    sources = experiment.sources()
    shard = experiment.hands.shard
    if shard is not None:
        sources = tuple(shard.among(sources))
    question = results.question_digest(experiment.settings)
    digests = _digests(sources, experiment.hands)
    more = ("strict",) * experiment.strict
    marks = {name: results.fingerprint(question, [*each, *more]) for name, each in digests.items()}
    failed = copies_among(sources, digests)
    waiting = [
        x
        for x in sources
        if x.name not in failed and not results.is_saved(_path(experiment.out, x), marks[x.name])
    ]
    already_done = len(sources) - len(failed) - len(waiting)
    if already_done:
        tell(f"{already_done} of {len(sources)} recordings are already evaluated")
    for copy in failed.values():
        if not experiment.keep_going:
            raise InputError(copy)
        tell(f"left out: {copy}")
    lost: list[str] = []
    for done, (source, error) in enumerate(_evaluate_all(experiment, question, marks, waiting), start=1):
        if isinstance(error, LostJob):
            lost.append(source.name)
            error = error.reason
        elif error is not None and not experiment.keep_going:
            raise InputError(error)
        if error is not None:
            failed[source.name] = error
        tell(f"[{done}/{len(waiting)}] {source.name}" + (f": left out: {error}" if error else ""))
    if shard is not None:
        raise SharedError(
            f"shard {shard} is done: {len(sources) - len(failed)} of {len(sources)} recordings evaluated. "
            "When all runs are done, run once without --shard to merge"
        )
    if len(failed) == len(sources):
        raise InputError(
            f"recordings={experiment.recordings}: none could be used; " + "; ".join(failed.values())
        )

    def findings() -> Iterator[Findings]:
        for source in (x for x in sources if x.name not in failed):
            stored = _known(experiment, source, marks[source.name])
            if stored is None:
                raise InputError(f"recording {source.name}: its results changed while they were used")
            yield stored

    in_order = {source.name: failed[source.name] for source in sources if source.name in failed}
    totals = results.write_results(experiment.out, experiment.settings, findings(), in_order)
    return ExperimentOutcome(totals, in_order, marks, tuple(lost))


def saved_findings(
    experiment: Experiment, outcome: ExperimentOutcome
) -> Iterator[tuple[RecordingSource, Findings]]:
    """Yield the saved findings of each recording of a finished experiment, in order."""
    for source in experiment.sources():
        if source.name in outcome.marks and source.name not in outcome.failed:
            stored = _known(experiment, source, outcome.marks[source.name])
            if stored is not None:
                yield source, stored


def _path(out: Path, source: RecordingSource) -> Path:
    return out / "recordings" / f"{source.name}.json"


def _known(experiment: Experiment, source: RecordingSource, mark: str) -> Findings | None:
    return results.load_findings(_path(experiment.out, source), mark)


def _digests(sources: Sequence[RecordingSource], executor: Executor) -> dict[str, list[str]]:
    """The digests of the files of each recording by its name: the workers of a cluster read them, or we."""
    if executor.cluster is None:
        with ThreadPoolExecutor(executor.processes or os.cpu_count() or 1) as threads:
            digests = list(threads.map(RecordingSource.digests, sources))
    else:
        by_place = dict(run_jobs(RecordingSource.digests, sources, executor))
        answers = (by_place[place] for place in range(len(sources)))
        digests = [
            s.digests() if isinstance(x, LostJob) else x for s, x in zip(sources, answers, strict=True)
        ]
    return {source.name: each for source, each in zip(sources, digests, strict=True)}


def _evaluate_all(
    experiment: Experiment, question: str, marks: Mapping[str, str], sources: list[RecordingSource]
) -> Iterator[tuple[RecordingSource, str | LostJob | None]]:
    """Evaluate and save each; the second part is why a recording could not be used."""
    jobs = [_RecordingJob(experiment.settings, question, experiment.out, s, marks[s.name]) for s in sources]
    executor = experiment.hands
    if (executor.cluster is None and executor.processes == 1) or len(sources) < 2:
        for job in jobs:
            yield job.source, _evaluate(job)
        return
    with closing(run_jobs(_evaluate, jobs, executor, fresh=is_fork_unsafe())) as answers:
        for place, error in answers:
            yield sources[place], error


@dataclass(frozen=True)
class _RecordingJob:
    """One recording to evaluate: ``question`` marks the settings, ``mark`` the results."""

    settings: EvaluationSettings
    question: str
    out: Path
    source: RecordingSource
    mark: str


class _UnreadableWindowError(InputError):
    """A window that cannot be read, with the message of the reader, which begins with the file."""


def _read_windows(recording: WindowedRecording) -> Iterator[TimeWindow]:
    """Yield the windows of a recording. Raises ``_UnreadableWindowError``."""
    try:
        yield from recording.windows()
    except InputError as error:
        raise _UnreadableWindowError(str(error)) from error


def _evaluate(job: _RecordingJob) -> str | None:
    """Read, evaluate and save; why the recording cannot be used, where it is the files' fault."""
    if is_worker():
        keep_freed_memory()
    try:
        divided = job.source.divided()
    except InputError as error:
        return str(error)
    try:
        questions = questions_for(job.settings, job.question, divided)
    except InputError as error:
        return f"{job.source.place_of_rate(divided.rate)}: {error}"
    try:
        findings = evaluate_windows(_read_windows(divided), questions)
    except _UnreadableWindowError as error:
        return str(error)
    except InputError as error:
        return f"{job.source.files[-1]}: {error}"
    except Exception as error:
        raise RuntimeError(f"recording {job.source.name}: {type(error).__name__}: {error}") from error
    results.save_findings(_path(job.out, job.source), findings, job.mark)
    return None


_MOST_COMPILED = 4
_compiled: dict[tuple[str, Rate, tuple[str, ...]], EvaluationQuestions] = {}


def questions_for(
    settings: EvaluationSettings, question: str, recording: Recording | WindowedRecording
) -> EvaluationQuestions:
    """Compiled once a process for recordings of one rate and the same zones.

    ``question`` is the settings' mark, which tells settings apart, as they come as copies.
    """
    key = question, recording.rate, recording.zone_names
    if key not in _compiled:
        if len(_compiled) >= _MOST_COMPILED:
            _compiled.clear()
        _compiled[key] = compile_questions(settings, recording.rate, recording.zone_names)
    return _compiled[key]
