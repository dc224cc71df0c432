"""What an evaluation writes: one file a recording, so that a killed run resumes, then the whole.

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
from roadproof.extensions.traffic.answers import traffic as kept
from roadproof.extensions.traffic.evaluate import totals as sums
from roadproof.extensions.traffic.evaluate.detectors import Detection
from roadproof.extensions.traffic.evaluate.evaluate import Findings, Trace
from roadproof.extensions.traffic.evaluate.foretelling import LABELS
from roadproof.extensions.traffic.evaluate.matching import Match, PossibleMatch
from roadproof.extensions.traffic.evaluate.questions import Settings
from roadproof.extensions.traffic.formats.repeats import FramePair
from roadproof.library.scenarios import MIN_DANGER
from roadproof.library.words import Called, called_in
from roadproof.runtime.canonical import digest
from roadproof.runtime.files import make_folder, whole_file
from roadproof.runtime.package_data import program
from roadproof.world.unread import left_out_in

RECORDING_SCHEMA = "roadproof/recording-findings/5"
MATCH_COLUMNS = tuple(
    "recording sv pov pov2 lane start_frame end_frame min_danger set scenario title uncertain".split()  # noqa: SIM905
)
PAIR_COLUMNS = tuple(
    "recording first second min_danger start_frame end_frame first_lane second_lane sectors violating".split()  # noqa: SIM905
)


def question_mark(settings: Settings) -> str:
    """Changes whenever the settings, a declaration of the library or a file of this program do."""
    told = {x.name: getattr(settings, x.name) for x in fields(settings) if x.name != "library"}
    return digest(RECORDING_SCHEMA, program(), told, settings.library.fingerprint)


def fingerprint(question: str, digests: Sequence[str]) -> str:
    """Changes whenever the question's mark or the content of a file of the recording does."""
    return digest(question, digests)


def _digest(told: object) -> str:
    return hashlib.sha256(json.dumps(told, sort_keys=True).encode()).hexdigest()


def _kept_settings(settings: Settings) -> kept.Settings:
    return kept.Settings(
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
    rows = {name: [_saved(row) for row in getattr(findings, name)] for name in _ROWS}
    texts = {name: json.dumps(value) for name, value in {**vars(findings), **rows}.items()}
    told = {"schema": RECORDING_SCHEMA, "fingerprint": mark, "seal": _seal_of(mark, texts)}
    with whole_text(path) as file:
        file.write(f'{json.dumps(told)[:-1]}, "findings": {_object_of(texts)}}}\n')


def _object_of(texts: Mapping[str, str]) -> str:
    """The JSON object with these texts as its values."""
    return "{" + ", ".join(f"{json.dumps(name)}: {text}" for name, text in texts.items()) + "}"


def _seal_of(mark: str, texts: Mapping[str, str]) -> str:
    """``seal`` of findings whose fields have these texts, as no field has objects to be sorted."""
    told = f"[{json.dumps(mark)}, {_object_of(dict(sorted(texts.items())))}]"
    return hashlib.sha256(told.encode()).hexdigest()


def _saved(row: Match | Trace | Detection | FramePair | PossibleMatch) -> list[object]:
    """The fields of a row; those about driver models, its last two, where there are any."""
    values = [*vars(row).values()]
    return values[:-2] if isinstance(row, Match) and not row.labels else values


def seal(mark: str, found: Mapping[str, object]) -> str:
    """What findings that were saved must still have: a digest of them and their fingerprint."""
    return _digest([mark, found])


def is_saved(path: Path, mark: str) -> bool:
    """Whether findings were saved under the same fingerprint and not changed since."""
    return _kept(path, mark) is not None


def load_findings(path: Path, mark: str) -> Findings | None:
    """Findings that were saved under the same fingerprint and not changed since, else None."""
    found = _kept(path, mark)
    try:
        return None if found is None else Findings(**{name: _value(name, x) for name, x in found.items()})
    except (KeyError, TypeError):
        return None


def _kept(path: Path, mark: str) -> dict[str, object] | None:
    try:
        match json.loads(path.read_text()):
            case {"schema": schema, "fingerprint": of, "seal": sealed, "findings": dict() as found}:
                whole = found.keys() == {x.name for x in fields(Findings)}
                same = (schema, of, sealed) == (RECORDING_SCHEMA, mark, seal(mark, found))
                return found if whole and same else None
    except (OSError, ValueError, TypeError, RecursionError):
        pass
    return None


def _value(name: str, value: Any) -> Any:
    """A field of findings from JSON."""
    kind = _ROWS.get(name)
    return _frozen(value) if kind is None else tuple(kind(*map(_frozen, x)) for x in value)


def _frozen(value: object) -> Any:
    """A value of JSON with tuples as its lists."""
    return tuple(map(_frozen, value)) if isinstance(value, list) else value


_ROWS: Mapping[str, Callable[..., object]] = {
    "traces": Trace,
    "matches": Match,
    "detections": Detection,
    "seen": FramePair,
    "possible": PossibleMatch,
}


@contextmanager
def whole_text(path: Path) -> Iterator[TextIO]:
    """A text file that appears whole or not at all; its folder is made. Raises ``InputError``."""
    make_folder(path.parent)
    with whole_file(path) as file:
        text = TextIOWrapper(file, "utf-8", newline="")
        try:
            yield text
        finally:
            text.detach()


def write_results(
    folder: Path, settings: Settings, findings: Iterable[Findings], failed: Mapping[str, str]
) -> sums.Totals:
    """Write matches.csv, pairs.csv and results.json; ``findings`` gives the recordings in order.

    Recordings are taken one at a time, and what an earlier one shows too is left out. ``failed`` says which
    recordings are left out and why.
    """
    totals = sums.begin_totals(settings)
    counted = sums.Counts(repeats=totals.repeats)
    words = words_in(settings)
    with whole_text(folder / "matches.csv") as matches, whole_text(folder / "pairs.csv") as pairs:
        match_rows, pair_rows = (csv.writer(file, lineterminator="\n") for file in (matches, pairs))
        match_rows.writerow((*MATCH_COLUMNS, *driver_columns(settings)))
        within = [f"{name}_uncertain" for name in settings.sets]
        pair_rows.writerow((*PAIR_COLUMNS, *settings.detectors, *settings.sets, *within))
        for all_found in findings:
            found = sums.without_repeats(all_found, counted)
            sums.add_findings(totals, found)
            match_rows.writerows(_match_rows(settings, words, found))
            pair_rows.writerows(_pair_rows(settings, found, {*all_found.violating}))
            if found.notes:
                totals.notes[found.recording] = found.notes
    with whole_text(folder / "results.json") as file:
        file.write(json.dumps(as_json(totals, failed), indent=1) + "\n")
    return totals


def as_json(totals: sums.Totals, failed: Mapping[str, str]) -> JsonObject:
    """The totals as plain data; ``failed``: which recordings are left out, and why."""
    answer = kept.Answer(
        **heading(kept.SCHEMA, totals.settings.library),
        settings=_kept_settings(totals.settings),
        recordings=totals.recordings,
        vehicles=totals.vehicles,
        samples=totals.samples,
        violating=totals.violating,
        asked=totals.asked,
        undecided=totals.undecided,
        differing=totals.differing,
        table=tuple(_kept_row(row, totals) for rows in totals.shown.values() for row in rows),
        words=tuple(words_in(totals.settings).values()),
        detectors={name: totals.detected[name] for name in totals.settings.detectors},
        checks=kept.Checks(broken=tuple(totals.broken), unequal_3_4=tuple(totals.unequal_3_4)),
        repeats=tuple(_kept_repeat(x, totals) for x in totals.repeats),
        notes=totals.notes,
        left_out={name: x for name, notes in totals.notes.items() if (x := left_out_in(notes))},
        failed=failed,
        drivers=tuple(foretold_rows(totals)) if totals.settings.drivers else None,
    )
    return write(answer)


def _kept_row(row: sums.Row, totals: sums.Totals) -> kept.Row:
    return kept.Row(
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


def _kept_repeat(repeat: sums.Repeat, totals: sums.Totals) -> kept.Repeat:
    return kept.Repeat(
        recording=repeat.recording,
        pair=(repeat.first, repeat.second),
        what=repeat.what,
        min_danger=None if repeat.min_danger is None else str(totals.settings.min_danger[repeat.min_danger]),
        shown_in=repeat.shown_in,
    )


def foretold_rows(totals: sums.Totals) -> Iterator[kept.Prediction]:
    """For each minDanger, set, scenario and model that speaks of it how many matches have each of LABELS.

    Scenarios of road sectors that no road has are left out.
    """
    settings = totals.settings
    asked = [i for rows in totals.shown.values() for i in rows[0].sector.scenarios]
    for (k, danger), set_name in product(enumerate(settings.min_danger), settings.sets):
        for number, driver in product(asked, settings.drivers):
            if course_in(number) in MODELS[driver].manoeuvres:
                of = (k, set_name, number, driver)
                counts = {x.replace(" ", "_"): totals.foretold[sums.Foretold(*of, x)] for x in LABELS}
                yield kept.Prediction(
                    min_danger=str(danger), set=set_name, scenario=number, driver=driver, **counts
                )


def driver_columns(settings: Settings) -> list[str]:
    """What the columns about driver models are called in matches.csv: a label, and the frame it is about."""
    return [column for name in settings.drivers for column in (name, f"{name}_frame")]


def driver_cells(settings: Settings, match: Match) -> list[str | int | None]:
    """Their values for a match; None where a model says nothing of the scenario."""
    labels = match.labels or ("",) * len(settings.drivers)
    return [cell for label in labels for cell in ((label, match.begun) if label else (None, None))]


def words_in(settings: Settings) -> Called:
    """What the scenarios of an evaluation are called."""
    home = settings.library.select(settings.sets[0], settings.options)
    return called_in(home, settings.sets, settings.scenarios)


def _match_rows(settings: Settings, words: Called, found: Findings) -> Iterator[list[object]]:
    dangers = [decimal(x) for x in settings.min_danger]
    for m in found.matches:
        pov2 = "" if m.pov2 is None else m.pov2
        frames = (m.start_frame, m.end_frame, dangers[m.min_danger])
        happens = (m.set_name, m.scenario, words[m.scenario].title)
        models = driver_cells(settings, m)
        yield [found.recording, m.sv, m.pov, pov2, m.lane, *frames, *happens, int(m.uncertain), *models]


def uncertain_pairs(found: Findings) -> Set[tuple[tuple[int, int], int, str]]:
    """The traces, by pair, minDanger and set, for which errors of places decide whether they match."""
    sure = {(m.pair, m.min_danger, m.set_name) for m in found.matches if not m.uncertain}
    perhaps = {(x.pair, x.min_danger, x.set_name) for x in found.possible}
    return (perhaps | {(m.pair, m.min_danger, m.set_name) for m in found.matches}) - sure


def _pair_rows(
    settings: Settings, found: Findings, violating: Set[tuple[int, int]]
) -> Iterator[list[object]]:
    """A row for each trace, and one without a trace for each other pair that violates or is detected.

    ``violating``: all pairs that violate in this recording, whether or not an earlier one shows them too.
    """
    dangers = [decimal(x) for x in settings.min_danger]
    matched = {(m.pair, m.min_danger, m.set_name) for m in found.matches}
    uncertain = uncertain_pairs(found)
    detected = {(x.detector, x.pair) for x in found.detections}

    def of_pair(pair: tuple[int, int]) -> list[int]:
        return [int(pair in violating), *(int((name, pair) in detected) for name in settings.detectors)]

    rows: dict[tuple[int, int], list[list[object]]] = {}
    for t in found.traces:
        pair = t.first, t.second
        hits = [int((pair, t.min_danger, s) in x) for x in (matched, uncertain) for s in settings.sets]
        frames = (dangers[t.min_danger], t.start_frame, t.end_frame, t.first_lane, t.second_lane)
        row = [found.recording, *pair, *frames, "; ".join(t.sectors), *of_pair(pair), *hits]
        rows.setdefault((min(pair), max(pair)), []).append(row)
    for pair in sorted({*found.violating} | {pair for _, pair in detected}):
        if pair not in rows:
            none = [""] * 2 * len(settings.sets)
            rows[pair] = [[found.recording, *pair, "", "", "", "", "", "", *of_pair(pair), *none]]
    for _, each in sorted(rows.items()):
        yield from each


def decimal(value: Fraction) -> str:
    """0.6 for 3/5; a fraction that is no short decimal stays one."""
    text = f"{float(value):g}"
    return text if Fraction(text) == value else str(value)
