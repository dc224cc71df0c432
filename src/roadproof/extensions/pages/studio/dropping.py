"""Files that are dropped on the page: drives are judged, certificates checked, recordings monitored.

Their contents come with the question. They are put into a folder that this process makes and removes, under
names that it allows; no path that the page names is ever opened.
"""

import re
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

import roadproof as rp
from roadproof.errors import InputError, RoadproofError, UsageError
from roadproof.evidence.drive_file import SCHEMAS_READ as DRIVES
from roadproof.evidence.drive_file import read_drive
from roadproof.evidence.strict import parse_json
from roadproof.extensions.pages.studio.requests import MOST_FILES, Answer, Ask
from roadproof.extensions.pages.studio.showing import view
from roadproof.extensions.pages.viewer_document import FormulaView
from roadproof.extensions.pages.viewer_recorded import recorded_data
from roadproof.extensions.traffic.evaluate.one_trace import OneTrace, read_pair, read_samples
from roadproof.runtime.progress import begin

MOST_PAIRS = 2000
_NAME = re.compile(r"\w[\w .()+-]{0,80}\.(json|csv|xosc|xodr|xml|toml)")


def drop(ask: Ask) -> Answer:
    """What was dropped: a drive, a certificate, or a recording with a list of its pairs and matches."""
    names = _names(ask)
    if len(names) == 1 and names[0].endswith(".json"):
        return _evidence(ask)
    begin("reading the recording")
    with _laid_out(ask) as folder:
        if len(names) == 1 and names[0].endswith((".csv", ".xosc")) and "_tracks" not in names[0]:
            return {"view": _monitored(ask, read_samples(folder / names[0]))}
        begin("searching for danger")
        found = rp.evaluate(folder, using=ask.home, detectors=False, jobs=1)
        pairs, matches = found.pairs().to_dicts(), found.matches().to_dicts()
        told = {"pairs": _plain(pairs[:MOST_PAIRS]), "matches": _plain(matches), "files": names}
        return {"recording": told}


def pair(ask: Ask) -> Answer:
    """Vehicles of a recording that was dropped, with the question and what is watched monitored on them."""
    if ask.pair is None:
        raise InputError("question: 'pair' is missing")
    wanted, ids = ask.pair, ",".join(map(str, ask.pair.vehicles))
    begin(f"reading vehicles {ids}")
    with _laid_out(ask) as folder:
        tracks = f"{wanted.recording}_tracks.csv"
        if tracks not in _names(ask):
            raise InputError(f"recording={wanted.recording[:40]}: it is not among the files")
        return {"view": _monitored(ask, read_pair(f"{folder / tracks}:{ids}", (wanted.first, wanted.last)))}


def _evidence(ask: Ask) -> Answer:
    [name], [file] = _names(ask), ask.files
    data = parse_json(file.content, name)
    if isinstance(data, dict) and data.get("schema") in DRIVES:
        drive = read_drive(data, name)
        return {"drive": data, "view": view(replace(ask, formula=drive.formula), drive)}
    begin("checking the file")
    with _laid_out(ask) as folder:
        specs, draft = [], ask.draft
        if draft.text.strip() or draft.before is not None:
            (folder / "edit.spec").write_text(draft.file(), "utf-8")
            specs = [folder / "edit.spec"]
        checked = rp.check(folder / name, specs=specs, jobs=1)
        told = str(checked).replace(f"{folder}/", "")
    [found] = checked.findings
    word = found.verdict if checked.accepted else str(found.outcome).upper()
    return {"checked": {"verdict": word, "accepted": checked.accepted, "formula": found.claim, "told": told}}


def _monitored(ask: Ask, trace: OneTrace) -> Answer:
    """The document of a trace: the question, where it can be asked of these vehicles, and what is watched."""
    home = ask.home
    asked = [("question", ask.formula), *(("watch", x) for x in ask.watches)]
    observed, refused = [], []
    for role, formula in asked:
        try:
            observed.append((role, rp.monitor(formula, trace, using=home).observed))
        except RoadproofError as error:
            refused.append(FormulaView(role, formula, home.sets[0], error=str(error)))
    document = recorded_data(trace, observed, home.specification, home.all_values())
    return replace(document, formulas=[*document.formulas, *refused]).as_json()


def _names(ask: Ask) -> list[str]:
    """The names of the files that were sent. Raises ``UsageError``."""
    names = [x.name for x in ask.files]
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
def _laid_out(ask: Ask) -> Iterator[Path]:
    """A folder of our own with the files in it, for as long as it is needed."""
    with tempfile.TemporaryDirectory(prefix="roadproof-studio-") as place:
        for name, file in zip(_names(ask), ask.files, strict=True):
            (Path(place) / name).write_text(file.content, "utf-8")
        try:
            yield Path(place)
        except RoadproofError as error:
            raise InputError(str(error).replace(f"{place}/", "")) from None


def _plain(rows: list[dict[str, Any]]) -> list[Answer]:
    return [{name: x if isinstance(x, str | bool) else _number(x) for name, x in row.items()} for row in rows]


def _number(value: Any) -> int | float | None:
    if value is None:
        return None
    return int(value) if float(value) == int(value) else float(value)
