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
from roadproof.extensions.traffic.evaluate.questions import Questions, Settings, ask
from roadproof.extensions.traffic.evaluate.totals import Totals
from roadproof.extensions.traffic.formats.clock import Rate
from roadproof.extensions.traffic.formats.recording import Recording
from roadproof.extensions.traffic.formats.source import RecordingSource
from roadproof.extensions.traffic.formats.sources import copies_among, find_sources
from roadproof.extensions.traffic.formats.windows import WindowedRecording
from roadproof.runtime.dispatch import answers_of
from roadproof.runtime.executors import Executor, LostJob, is_fork_unsafe
from roadproof.runtime.memory import keep_freed_memory
from roadproof.runtime.worker import is_worker


@dataclass(frozen=True)
class Experiment:
    """Where the recordings are, where results go, and what is asked.

    ``strict``: no vehicle is left out of a recording. ``road``: of a map, for recordings without their own.
    """

    recordings: Path
    out: Path
    settings: Settings
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
    question = results.question_mark(experiment.settings)
    digests = _digests(sources, experiment.hands)
    more = ["strict"] * experiment.strict
    marks = {name: results.fingerprint(question, [*each, *more]) for name, each in digests.items()}
    failed = copies_among(sources, digests)
    waiting = [
        x
        for x in sources
        if x.name not in failed and not results.is_saved(_path(experiment.out, x), marks[x.name])
    ]
    kept = len(sources) - len(failed) - len(waiting)
    if kept:
        tell(f"{kept} of {len(sources)} recordings are already evaluated")
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
            found = _known(experiment, source, marks[source.name])
            if found is None:
                raise InputError(f"recording {source.name}: its results changed while they were used")
            yield found

    in_order = {source.name: failed[source.name] for source in sources if source.name in failed}
    totals = results.write_results(experiment.out, experiment.settings, findings(), in_order)
    return ExperimentOutcome(totals, in_order, marks, tuple(lost))


def saved_findings(
    experiment: Experiment, outcome: ExperimentOutcome
) -> Iterator[tuple[RecordingSource, Findings]]:
    """What an experiment that is done has saved of each recording, in order."""
    for source in experiment.sources():
        if source.name in outcome.marks and source.name not in outcome.failed:
            found = _known(experiment, source, outcome.marks[source.name])
            if found is not None:
                yield source, found


def _path(out: Path, source: RecordingSource) -> Path:
    return out / "recordings" / f"{source.name}.json"


def _known(experiment: Experiment, source: RecordingSource, mark: str) -> Findings | None:
    return results.load_findings(_path(experiment.out, source), mark)


def _digests(sources: Sequence[RecordingSource], hands: Executor) -> dict[str, list[str]]:
    """The digests of the files of each recording by its name: the workers of a cluster read them, or we."""
    if hands.cluster is None:
        with ThreadPoolExecutor(hands.processes or os.cpu_count() or 1) as threads:
            found = list(threads.map(RecordingSource.digests, sources))
    else:
        told = dict(answers_of(RecordingSource.digests, sources, hands))
        answers = (told[place] for place in range(len(sources)))
        found = [s.digests() if isinstance(x, LostJob) else x for s, x in zip(sources, answers, strict=True)]
    return {source.name: each for source, each in zip(sources, found, strict=True)}


def _evaluate_all(
    experiment: Experiment, question: str, marks: Mapping[str, str], sources: list[RecordingSource]
) -> Iterator[tuple[RecordingSource, str | LostJob | None]]:
    """Evaluate and save each; the second part is why a recording could not be used."""
    jobs = [_Job(experiment.settings, question, experiment.out, s, marks[s.name]) for s in sources]
    hands = experiment.hands
    if (hands.cluster is None and hands.processes == 1) or len(sources) < 2:
        for job in jobs:
            yield job.source, _evaluate(job)
        return
    with closing(answers_of(_evaluate, jobs, hands, fresh=is_fork_unsafe())) as answers:
        for place, error in answers:
            yield sources[place], error


@dataclass(frozen=True)
class _Job:
    """One recording to evaluate: ``question`` marks the settings, ``mark`` the results."""

    settings: Settings
    question: str
    out: Path
    source: RecordingSource
    mark: str


def _evaluate(job: _Job) -> str | None:
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
        findings = evaluate_windows(divided.windows(), questions)
    except InputError as error:
        told, file = str(error), str(job.source.files[-1])
        return told if told.startswith(file) else f"{file}: {told}"
    except Exception as error:
        raise RuntimeError(f"recording {job.source.name}: {type(error).__name__}: {error}") from error
    results.save_findings(_path(job.out, job.source), findings, job.mark)
    return None


_MOST_ASKED = 4
_asked: dict[tuple[str, Rate, tuple[str, ...]], Questions] = {}


def questions_for(settings: Settings, question: str, recording: Recording | WindowedRecording) -> Questions:
    """Compiled once a process for recordings of one rate and the same zones.

    ``question`` is the settings' mark, which tells settings apart, as they come as copies.
    """
    key = question, recording.rate, recording.zone_names
    if key not in _asked:
        if len(_asked) >= _MOST_ASKED:
            _asked.clear()
        _asked[key] = ask(settings, recording.rate, recording.zone_names)
    return _asked[key]
