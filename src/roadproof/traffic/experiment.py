"""The highD experiment over many recordings: resumable, and in memory one recording a process."""

from collections.abc import Callable, Iterator
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

from roadproof.errors import InputError
from roadproof.traffic.evaluate import Findings, evaluate_recording
from roadproof.traffic.questions import Questions, Settings, ask
from roadproof.traffic.results import Totals, fingerprint, load_findings, save_findings, write_results
from roadproof.traffic.sources import RecordingSource, find_sources
from roadproof.workers import Lost, answers_of


@dataclass(frozen=True)
class Experiment:
    """Where the recordings are, where results go, and what is asked."""

    recordings: Path
    out: Path
    settings: Settings
    jobs: int = 1
    keep_going: bool = False


@dataclass(frozen=True)
class Outcome:
    """The totals, and the recordings that could not be used, with the reason.

    ``lost`` are those among them whose process ended twice, which may be the machine's fault.
    """

    totals: Totals
    failed: dict[str, str]
    lost: tuple[str, ...] = ()


def run_experiment(experiment: Experiment, tell: Callable[[str], None] = lambda line: None) -> Outcome:
    """Evaluate every recording that has no valid result yet, then write the results of all.

    ``tell`` gets a line for each recording that is done. Raises ``InputError`` for the first
    recording that cannot be read, unless ``keep_going``: then it is left out, and said so.
    """
    sources = find_sources(experiment.recordings)
    waiting = [s for s in sources if _known(experiment, s) is None]
    if len(waiting) < len(sources):
        tell(f"{len(sources) - len(waiting)} of {len(sources)} recordings are already evaluated")
    failed: dict[str, str] = {}
    lost: list[str] = []
    for done, (source, error) in enumerate(_evaluate_all(experiment, waiting), start=1):
        if isinstance(error, Lost):
            lost.append(source.name)
            error = error.reason
        elif error is not None and not experiment.keep_going:
            raise InputError(error)
        if error is not None:
            failed[source.name] = error
        tell(f"[{done}/{len(waiting)}] {source.name}" + (f": left out: {error}" if error else ""))
    if len(failed) == len(sources):
        raise InputError(
            f"recordings={experiment.recordings}: none could be used; " + "; ".join(failed.values())
        )

    def findings() -> Iterator[Findings]:
        for source in sources:
            found = None if source.name in failed else _known(experiment, source)
            if found is None and source.name not in failed:
                raise InputError(
                    f"recording {source.name}: its files or results changed while they were used"
                )
            if found is not None:
                yield found

    in_order = {source.name: failed[source.name] for source in sources if source.name in failed}
    totals = write_results(experiment.out, experiment.settings, findings(), in_order)
    return Outcome(totals, in_order, tuple(lost))


def saved_findings(experiment: Experiment, outcome: Outcome) -> Iterator[tuple[RecordingSource, Findings]]:
    """What an experiment that is done has saved of each recording, in order."""
    for source in find_sources(experiment.recordings):
        found = None if source.name in outcome.failed else _known(experiment, source)
        if found is not None:
            yield source, found


def _path(out: Path, source: RecordingSource) -> Path:
    return out / "recordings" / f"{source.name}.json"


def _known(experiment: Experiment, source: RecordingSource) -> Findings | None:
    mark = fingerprint(experiment.settings, source.stamp())
    return load_findings(_path(experiment.out, source), mark)


def _evaluate_all(
    experiment: Experiment, sources: list[RecordingSource]
) -> Iterator[tuple[RecordingSource, str | Lost | None]]:
    """Evaluate and save each; the second part is why a recording could not be used."""
    if experiment.jobs == 1 or len(sources) < 2:
        for source in sources:
            yield source, _evaluate((experiment.settings, experiment.out, source))
        return
    tasks = [(experiment.settings, experiment.out, source) for source in sources]
    # Threads of a library may hold locks while a process forks, so workers start afresh.
    with closing(answers_of(_evaluate, tasks, min(experiment.jobs, len(sources)), fresh=True)) as answers:
        for place, error in answers:
            yield sources[place], error


def _evaluate(task: tuple[Settings, Path, RecordingSource]) -> str | None:
    settings, out, source = task
    mark = fingerprint(settings, source.stamp())
    try:
        recording = source.read()
    except InputError as error:
        return str(error)
    save_findings(
        _path(out, source), evaluate_recording(recording, _questions(settings, recording.rate)), mark
    )
    return None


_asked: dict[int, tuple[Settings, Questions]] = {}


def _questions(settings: Settings, rate: int) -> Questions:
    """Compiled once a process and rate."""
    known = _asked.get(rate)
    if known is None or known[0] is not settings:
        _asked[rate] = (settings, ask(settings, rate))
    return _asked[rate][1]
