"""Handles files that are dropped on the page: judges drives, checks certificates, monitors recordings.

The question carries the file contents. They are written into a temporary folder of this process, under names
that it allows; no path that the page names is ever opened.
"""

import re
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

import roadproof as rp
from roadproof.core_record import DRIVES
from roadproof.errors import InputError, RoadproofError, UsageError
from roadproof.evidence.drive_file import read_drive
from roadproof.evidence.strict import parse_json
from roadproof.extensions.pages.studio.requests import MOST_FILES, Answer, StudioQuestion
from roadproof.extensions.pages.studio.showing import view
from roadproof.extensions.pages.viewer_document import FormulaView
from roadproof.extensions.pages.viewer_recorded import recorded_data
from roadproof.extensions.traffic.evaluate.one_trace import OneTrace, read_pair, read_samples
from roadproof.runtime.progress import report_stage

MOST_PAIRS = 2000
_NAME = re.compile(r"\w[\w .()+-]{0,80}\.(json|csv|xosc|xodr|xml|toml)")


def drop(question: StudioQuestion) -> Answer:
    """Return the view of a dropped drive, the check of a certificate, or the pairs and matches of a
    recording.
    """
    names = _names(question)
    if len(names) == 1 and names[0].endswith(".json"):
        return _evidence(question)
    report_stage("reading the recording")
    with _laid_out(question) as folder:
        if len(names) == 1 and names[0].endswith((".csv", ".xosc")) and "_tracks" not in names[0]:
            return {"view": _monitored(question, read_samples(folder / names[0]))}
        report_stage("searching for danger")
        evaluation = rp.evaluate(folder, using=question.home, detectors=False, jobs=1)
        pairs, matches = evaluation.pairs().to_dicts(), evaluation.matches().to_dicts()
        recording = {"pairs": _plain(pairs[:MOST_PAIRS]), "matches": _plain(matches), "files": names}
        return {"recording": recording}


def pair(question: StudioQuestion) -> Answer:
    """Monitor the question and watched formulas on some vehicles of a dropped recording."""
    if question.pair is None:
        raise InputError("question: 'pair' is missing")
    selection, ids = question.pair, ",".join(map(str, question.pair.vehicles))
    report_stage(f"reading vehicles {ids}")
    with _laid_out(question) as folder:
        tracks = f"{selection.recording}_tracks.csv"
        if tracks not in _names(question):
            raise InputError(f"recording={selection.recording[:40]}: it is not among the files")
        return {
            "view": _monitored(
                question, read_pair(f"{folder / tracks}:{ids}", (selection.first, selection.last))
            )
        }


def _evidence(question: StudioQuestion) -> Answer:
    [name], [file] = _names(question), question.files
    data = parse_json(file.content, name)
    if isinstance(data, dict) and data.get("schema") in DRIVES:
        drive = read_drive(data, name)
        return {"drive": data, "view": view(replace(question, formula=drive.formula), drive)}
    report_stage("checking the file")
    with _laid_out(question) as folder:
        specs, draft = [], question.draft
        if draft.text.strip() or draft.before is not None:
            (folder / "edit.spec").write_text(draft.file(), "utf-8")
            specs = [folder / "edit.spec"]
        checked = rp.check(folder / name, specs=specs, jobs=1)
        report = str(checked).replace(f"{folder}/", "")
    [finding] = checked.findings
    word = finding.verdict if checked.accepted else str(finding.outcome).upper()
    return {
        "checked": {"verdict": word, "accepted": checked.accepted, "formula": finding.claim, "told": report}
    }


def _monitored(question: StudioQuestion, trace: OneTrace) -> Answer:
    """Return the viewer document of a trace with the question, where it fits these vehicles, and watched
    formulas.
    """
    home = question.home
    formulas = [("question", question.formula), *(("watch", x) for x in question.watches)]
    observed, errors = [], []
    for role, formula in formulas:
        try:
            observed.append((role, rp.monitor(formula, trace, using=home).observed))
        except RoadproofError as error:
            errors.append(FormulaView(role, formula, home.sets[0], error=str(error)))
    document = recorded_data(trace, observed, home.specification, home.all_values())
    return replace(document, formulas=[*document.formulas, *errors]).as_json()


def _names(question: StudioQuestion) -> list[str]:
    """Return the names of the sent files. Raises ``UsageError`` for too many files or a name that is not
    allowed.
    """
    names = [x.name for x in question.files]
    if not 1 <= len(names) <= MOST_FILES:
        raise UsageError(f"{len(names)} files: drop 1 to {MOST_FILES} at once")
    for name in names:
        if not _NAME.fullmatch(name):
            raise UsageError(
                f"file {name[:60]!r}: drop drives and certificates (.json), samples (.csv, .xosc), or the "
                "files of a recording (01_tracks.csv, 01_tracksMeta.csv, 01_recordingMeta.csv) together"
            )
    return names


@contextmanager
def _laid_out(question: StudioQuestion) -> Iterator[Path]:
    """Yield a temporary folder with the files in it."""
    with tempfile.TemporaryDirectory(prefix="roadproof-studio-") as place:
        for name, file in zip(_names(question), question.files, strict=True):
            (Path(place) / name).write_text(file.content, "utf-8")
        try:
            yield Path(place)
        except RoadproofError as error:
            raise InputError(str(error).replace(f"{place}/", "")) from None


def _plain(rows: Sequence[Mapping[str, object]]) -> list[Answer]:
    return [{name: x if isinstance(x, str | bool) else _number(x) for name, x in row.items()} for row in rows]


def _number(value: Any) -> int | float | None:
    if value is None:
        return None
    return int(value) if float(value) == int(value) else float(value)
