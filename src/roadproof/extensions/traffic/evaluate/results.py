"""The files of an evaluation: one for each recording, so a killed run resumes, then the totals.

Every file appears whole or not at all, and the whole is made from the files of the recordings alone:
a run that was killed and started again ends with the same bytes as one that was not.
"""

import csv
import hashlib
import json
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence, Set
from contextlib import contextmanager
from dataclasses import fields
from fractions import Fraction
from io import TextIOWrapper
from itertools import product
from pathlib import Path
from typing import Any, TextIO

from roadproof.evidence.codec import write
from roadproof.evidence.heading import heading
from roadproof.evidence.strict import JsonObject
from roadproof.extensions.drivers.models import MODELS, course_in
from roadproof.extensions.traffic.answers import traffic as traffic_data
from roadproof.extensions.traffic.evaluate import totals as sums
from roadproof.extensions.traffic.evaluate.detectors import Detection
from roadproof.extensions.traffic.evaluate.evaluate import DisturbanceTrace, Findings
from roadproof.extensions.traffic.evaluate.foretelling import LABELS
from roadproof.extensions.traffic.evaluate.matching import Match, PossibleMatch
from roadproof.extensions.traffic.evaluate.questions import EvaluationSettings
from roadproof.extensions.traffic.formats.repeats import FramePair
from roadproof.library.scenarios import MIN_DANGER
from roadproof.library.words import ScenarioWords, words_in_sets
from roadproof.questions.foreign_code import all_foreign_code
from roadproof.runtime.canonical import digest
from roadproof.runtime.files import atomic_file, make_folder
from roadproof.runtime.package_data import program_digest
from roadproof.world.not_read import left_out_in

RECORDING_SCHEMA = "roadproof/recording-findings/5"
MATCH_COLUMNS = tuple(
    "recording sv pov pov2 lane start_frame end_frame min_danger set scenario title uncertain".split()  # noqa: SIM905
)
PAIR_COLUMNS = tuple(
    "recording first second min_danger start_frame end_frame first_lane second_lane sectors violating".split()  # noqa: SIM905
)


def question_digest(settings: EvaluationSettings) -> str:
    """Return the digest of settings, declarations of the library, this program and packages of others."""
    contents = {x.name: getattr(settings, x.name) for x in fields(settings) if x.name != "library"}
    read_with = settings.library.fingerprint, *all_foreign_code()
    return digest(RECORDING_SCHEMA, program_digest(), contents, *read_with)


def fingerprint(question: str, digests: Sequence[str]) -> str:
    """Return the digest of the question digest and the content of the files of a recording."""
    return digest(question, digests)


def _digest(data: object) -> str:
    return hashlib.sha256(json.dumps(data, sort_keys=True).encode()).hexdigest()


def _settings_data(settings: EvaluationSettings) -> traffic_data.EvaluationSettingsData:
    return traffic_data.EvaluationSettingsData(
        sets=settings.sets,
        min_danger=tuple(map(str, settings.min_danger)),
        scenarios=settings.scenarios,
        classes=settings.classes,
        convention=settings.convention,
        detectors=settings.detectors,
        options=dict(sorted(settings.options.items())),
        parameters={k: str(v) for k, v in sorted(settings.values.items()) if k != MIN_DANGER},
        drivers=settings.drivers,
    )


def save_findings(path: Path, findings: Findings, mark: str) -> None:
    """Write the findings of one recording; ``mark`` is their fingerprint."""
    rows = {name: [_row_values(row) for row in getattr(findings, name)] for name in _ROWS}
    texts = {name: json.dumps(value) for name, value in {**vars(findings), **rows}.items()}
    head = {"schema": RECORDING_SCHEMA, "fingerprint": mark, "seal": _seal_of(mark, texts)}
    with write_text_whole(path) as file:
        file.write(f'{json.dumps(head)[:-1]}, "findings": {_object_of(texts)}}}\n')


def _object_of(texts: Mapping[str, str]) -> str:
    """The JSON object with these texts as its values."""
    return "{" + ", ".join(f"{json.dumps(name)}: {text}" for name, text in texts.items()) + "}"


def _seal_of(mark: str, texts: Mapping[str, str]) -> str:
    """``seal`` of findings whose fields have these texts, as no field has objects to be sorted."""
    content = f"[{json.dumps(mark)}, {_object_of(dict(sorted(texts.items())))}]"
    return hashlib.sha256(content.encode()).hexdigest()


def _row_values(row: Match | DisturbanceTrace | Detection | FramePair | PossibleMatch) -> list[object]:
    """The fields of a row; those about driver models, its last two, where there are any."""
    values = [*vars(row).values()]
    return values[:-2] if isinstance(row, Match) and not row.labels else values


def seal(mark: str, findings: Mapping[str, object]) -> str:
    """Return the digest of findings and their fingerprint, which protects saved findings from changes."""
    return _digest([mark, findings])


def is_saved(path: Path, mark: str) -> bool:
    """Return whether findings were saved under the same fingerprint and not changed since."""
    return _read_saved(path, mark) is not None


def load_findings(path: Path, mark: str) -> Findings | None:
    """Findings that were saved under the same fingerprint and not changed since, else None."""
    stored = _read_saved(path, mark)
    try:
        return None if stored is None else Findings(**{name: _value(name, x) for name, x in stored.items()})
    except (KeyError, TypeError):
        return None


def _read_saved(path: Path, mark: str) -> dict[str, object] | None:
    try:
        match json.loads(path.read_text()):
            case {"schema": schema, "fingerprint": of, "seal": sealed, "findings": dict() as findings}:
                whole = findings.keys() == {x.name for x in fields(Findings)}
                same = (schema, of, sealed) == (RECORDING_SCHEMA, mark, seal(mark, findings))
                return findings if whole and same else None
    except (OSError, ValueError, TypeError, RecursionError):
        pass
    return None


def _value(name: str, value: Any) -> Any:
    """A field of findings from JSON."""
    kind = _ROWS.get(name)
    return _with_tuples(value) if kind is None else tuple(kind(*map(_with_tuples, x)) for x in value)


def _with_tuples(value: object) -> Any:
    """A value of JSON with tuples as its lists."""
    return tuple(map(_with_tuples, value)) if isinstance(value, list) else value


_ROWS: Mapping[str, Callable[..., object]] = {
    "traces": DisturbanceTrace,
    "matches": Match,
    "detections": Detection,
    "seen": FramePair,
    "possible": PossibleMatch,
}


@contextmanager
def write_text_whole(path: Path) -> Iterator[TextIO]:
    """A text file that appears whole or not at all; its folder is made. Raises ``InputError``."""
    make_folder(path.parent)
    with atomic_file(path) as file:
        text = TextIOWrapper(file, "utf-8", newline="")
        try:
            yield text
        finally:
            text.detach()


def write_results(
    folder: Path, settings: EvaluationSettings, findings: Iterable[Findings], failed: Mapping[str, str]
) -> sums.Totals:
    """Write matches.csv, pairs.csv and results.json; ``findings`` gives the recordings in order.

    Recordings are taken one at a time, and what an earlier one shows too is left out. ``failed`` says which
    recordings are left out and why.
    """
    totals = sums.begin_totals(settings)
    shown = sums.ShownMoments(repeats=totals.repeats)
    words = scenario_words(settings)
    with write_text_whole(folder / "matches.csv") as matches, write_text_whole(folder / "pairs.csv") as pairs:
        match_rows, pair_rows = (csv.writer(file, lineterminator="\n") for file in (matches, pairs))
        match_rows.writerow((*MATCH_COLUMNS, *driver_columns(settings)))
        within = [f"{name}_uncertain" for name in settings.sets]
        pair_rows.writerow((*PAIR_COLUMNS, *settings.detectors, *settings.sets, *within))
        for recorded in findings:
            new = sums.without_repeats(recorded, shown)
            sums.add_findings(totals, new)
            match_rows.writerows(_match_rows(settings, words, new))
            pair_rows.writerows(_pair_rows(settings, new, {*recorded.violating}))
            if new.notes:
                totals.notes[new.recording] = new.notes
    with write_text_whole(folder / "results.json") as file:
        file.write(json.dumps(as_json(totals, failed), indent=1) + "\n")
    return totals


def as_json(totals: sums.Totals, failed: Mapping[str, str]) -> JsonObject:
    """The totals as plain data; ``failed``: which recordings are left out, and why."""
    answer = traffic_data.EvaluationData(
        **heading(traffic_data.SCHEMA, totals.settings.library),
        settings=_settings_data(totals.settings),
        recordings=totals.recordings,
        vehicles=totals.vehicles,
        samples=totals.samples,
        violating=totals.violating,
        asked=totals.asked,
        undecided=totals.undecided,
        differing=totals.differing,
        table=tuple(_row_data(row, totals) for rows in totals.shown.values() for row in rows),
        words=tuple(scenario_words(totals.settings).values()),
        detectors={name: totals.detected[name] for name in totals.settings.detectors},
        checks=traffic_data.ChecksData(broken=tuple(totals.broken), unequal_3_4=tuple(totals.unequal_3_4)),
        repeats=tuple(_repeat_data(x, totals) for x in totals.repeats),
        notes=totals.notes,
        left_out={name: x for name, notes in totals.notes.items() if (x := left_out_in(notes))},
        failed=failed,
        drivers=tuple(driver_label_rows(totals)) if totals.settings.drivers else None,
    )
    return write(answer)


def _row_data(row: sums.ResultsRow, totals: sums.Totals) -> traffic_data.ResultsRowData:
    return traffic_data.ResultsRowData(
        sector=row.sector.name,
        min_danger=str(row.min_danger),
        set=row.set_name,
        traces=row.traces,
        matching=row.matching,
        matching_with_three_cars=row.matching_with_three,
        matching_uncertain=row.uncertain,
        matching_possible=row.possible,
        recall=row.recall,
        recall_interval=_shares(row.bounds, row.traces),
        recall_without_init_safe=row.matching_violating / totals.violating if totals.violating else None,
        recall_without_init_safe_interval=_shares(row.violating_bounds, totals.violating),
        scenarios={str(i): row.scenarios[i] for i in row.sector.scenarios},
        matching_several=row.several,
        together={f"{i}-{j}": n for (i, j), n in sorted(row.together.items())},
    )


def _shares(bounds: tuple[int, int], whole: int) -> tuple[float, float] | None:
    low, high = bounds
    return (low / whole, high / whole) if whole else None


def _repeat_data(repeat: sums.Repeat, totals: sums.Totals) -> traffic_data.RepeatData:
    return traffic_data.RepeatData(
        recording=repeat.recording,
        pair=(repeat.first, repeat.second),
        what=repeat.what,
        min_danger=None if repeat.min_danger is None else str(totals.settings.min_danger[repeat.min_danger]),
        shown_in=repeat.shown_in,
    )


def driver_label_rows(totals: sums.Totals) -> Iterator[traffic_data.DriverLabelsData]:
    """Yield for each minDanger, set, scenario and driver model how many matches have each of LABELS.

    Scenarios of road sectors that no road has are left out.
    """
    settings = totals.settings
    numbers = [i for rows in totals.shown.values() for i in rows[0].sector.scenarios]
    for (k, danger), set_name in product(enumerate(settings.min_danger), settings.sets):
        for number, driver in product(numbers, settings.drivers):
            if course_in(number) in MODELS[driver].manoeuvres:
                of = (k, set_name, number, driver)
                counts = {x.replace(" ", "_"): totals.foretold[sums.DriverLabelKey(*of, x)] for x in LABELS}
                yield traffic_data.DriverLabelsData(
                    min_danger=str(danger), set=set_name, scenario=number, driver=driver, **counts
                )


def driver_columns(settings: EvaluationSettings) -> list[str]:
    """Return the names of the driver columns of matches.csv: a label and a frame for each model."""
    return [column for name in settings.drivers for column in (name, f"{name}_frame")]


def driver_cells(settings: EvaluationSettings, match: Match) -> list[str | int | None]:
    """Return the driver columns of a match; None where a model does not cover the scenario."""
    labels = match.labels or ("",) * len(settings.drivers)
    return [cell for label in labels for cell in ((label, match.begun) if label else (None, None))]


def scenario_words(settings: EvaluationSettings) -> ScenarioWords:
    """Return the titles of the scenarios of an evaluation."""
    specification = settings.library.select(settings.sets[0], settings.options)
    return words_in_sets(specification, settings.sets, settings.scenarios)


def _match_rows(
    settings: EvaluationSettings, words: ScenarioWords, findings: Findings
) -> Iterator[list[object]]:
    dangers = [decimal(x) for x in settings.min_danger]
    for m in findings.matches:
        pov2 = "" if m.pov2 is None else m.pov2
        frames = (m.start_frame, m.end_frame, dangers[m.min_danger])
        happens = (m.set_name, m.scenario, words[m.scenario].title)
        models = driver_cells(settings, m)
        yield [findings.recording, m.sv, m.pov, pov2, m.lane, *frames, *happens, int(m.uncertain), *models]


def uncertain_pairs(findings: Findings) -> Set[tuple[tuple[int, int], int, str]]:
    """The traces, by pair, minDanger and set, for which errors of places decide whether they match."""
    sure = {(m.pair, m.min_danger, m.set_name) for m in findings.matches if not m.uncertain}
    perhaps = {(x.pair, x.min_danger, x.set_name) for x in findings.possible}
    return (perhaps | {(m.pair, m.min_danger, m.set_name) for m in findings.matches}) - sure


def _pair_rows(
    settings: EvaluationSettings, findings: Findings, violating: Set[tuple[int, int]]
) -> Iterator[list[object]]:
    """A row for each trace, and one without a trace for each other pair that violates or is detected.

    ``violating``: all pairs that violate in this recording, whether or not an earlier one shows them too.
    """
    dangers = [decimal(x) for x in settings.min_danger]
    matched = {(m.pair, m.min_danger, m.set_name) for m in findings.matches}
    uncertain = uncertain_pairs(findings)
    detected = {(x.detector, x.pair) for x in findings.detections}

    def of_pair(pair: tuple[int, int]) -> list[int]:
        return [int(pair in violating), *(int((name, pair) in detected) for name in settings.detectors)]

    rows: dict[tuple[int, int], list[list[object]]] = {}
    for t in findings.traces:
        pair = t.first, t.second
        hits = [int((pair, t.min_danger, s) in x) for x in (matched, uncertain) for s in settings.sets]
        frames = (dangers[t.min_danger], t.start_frame, t.end_frame, t.first_lane, t.second_lane)
        row = [findings.recording, *pair, *frames, "; ".join(t.sectors), *of_pair(pair), *hits]
        rows.setdefault((min(pair), max(pair)), []).append(row)
    for pair in sorted({*findings.violating} | {pair for _, pair in detected}):
        if pair not in rows:
            none = [""] * 2 * len(settings.sets)
            rows[pair] = [[findings.recording, *pair, "", "", "", "", "", "", *of_pair(pair), *none]]
    for _, each in sorted(rows.items()):
        yield from each


def decimal(value: Fraction) -> str:
    """0.6 for 3/5; a fraction that is no short decimal stays one."""
    text = f"{float(value):g}"
    return text if Fraction(text) == value else str(value)
