"""Files that are dropped on the page: drives are judged, certificates checked, recordings monitored.

Their contents come with the question. They are put into a folder that this process makes and removes, under
names that it allows; no path that the page names is ever opened.
"""

import re
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import roadproof as rp
from roadproof.errors import InputError, RoadproofError, UsageError
from roadproof.evidence.drive_file import SCHEMAS_READ as DRIVES
from roadproof.evidence.drive_file import read_drive
from roadproof.evidence.strict import Fields, parse_json
from roadproof.frontends.report.viewer_recorded import recorded_data
from roadproof.frontends.studio.requests import draft_of, set_of, text_of
from roadproof.frontends.studio.showing import view
from roadproof.recordings.evaluate.one_trace import OneTrace, read_pair, read_samples

MOST_FILES = 12
MOST_PAIRS = 2000
_NAME = re.compile(r"\w[\w .()+-]{0,80}\.(json|csv|xosc|xodr|xml|toml)")


def drop(ask: Mapping[str, Any], say: Any) -> dict[str, Any]:
    """What was dropped: a drive, a certificate, or a recording with a list of its pairs and matches."""
    names = [name for name, _ in _files(ask)]
    if len(names) == 1 and names[0].endswith(".json"):
        return _evidence(ask, say)
    say("reading the recording")
    with _laid_out(ask) as folder:
        if len(names) == 1 and names[0].endswith((".csv", ".xosc")) and "_tracks" not in names[0]:
            return {"view": _monitored(ask, read_samples(folder / names[0]))}
        say("searching for danger")
        draft = draft_of(ask)
        found = rp.evaluate(folder, using=draft.definitions(set_of(ask)), detectors=False, jobs=1)
        pairs, matches = found.pairs().to_dicts(), found.matches().to_dicts()
        return {
            "recording": {"pairs": _plain(pairs[:MOST_PAIRS]), "matches": _plain(matches), "files": names}
        }


def pair(ask: Mapping[str, Any], say: Any) -> dict[str, Any]:
    """Vehicles of a recording that was dropped, with the question and what is watched monitored on them."""
    data = Fields(ask.get("pair"), "pair", ("recording", "vehicles", "first", "last"))
    ids = ",".join(str(_whole(x)) for x in data.items("vehicles"))
    say(f"reading vehicles {ids}")
    with _laid_out(ask) as folder:
        tracks = f"{data.text('recording')}_tracks.csv"
        if tracks not in [name for name, _ in _files(ask)]:
            raise InputError(f"recording={data.text('recording')[:40]}: it is not among the files")
        frames = (data.whole("first"), data.whole("last"))
        return {"view": _monitored(ask, read_pair(f"{folder / tracks}:{ids}", frames))}


def _evidence(ask: Mapping[str, Any], say: Any) -> dict[str, Any]:
    [(name, content)] = _files(ask)
    data = parse_json(content, name)
    if isinstance(data, dict) and data.get("schema") in DRIVES:
        file = read_drive(data, name)
        return {"drive": data, "view": view(draft_of(ask), file, {**ask, "formula": file.formula})}
    say("checking the file")
    draft = draft_of(ask)
    with _laid_out(ask) as folder:
        specs = []
        if draft.text.strip() or draft.before is not None:
            (folder / "edit.spec").write_text(draft.file(), "utf-8")
            specs = [folder / "edit.spec"]
        checked = rp.check(folder / name, specs=specs, jobs=1)
        told = str(checked).replace(f"{folder}/", "")
    [found] = checked.findings
    word = found.verdict if checked.accepted else str(found.outcome).upper()
    return {"checked": {"verdict": word, "accepted": checked.accepted, "formula": found.claim, "told": told}}


def _monitored(ask: Mapping[str, Any], trace: OneTrace) -> dict[str, Any]:
    """The document of a trace: the question, where it can be asked of these vehicles, and what is watched."""
    draft = draft_of(ask)
    home = draft.definitions(set_of(ask))
    asked = [("question", text_of(ask, "formula"))]
    asked += [("watch", x) for x in Fields(ask, "question").texts("watches")] if "watches" in ask else []
    observed, refused = [], []
    for role, formula in asked:
        try:
            observed.append((role, rp.monitor(formula, trace, using=home).observed))
        except RoadproofError as error:
            refused.append({"role": role, "formula": formula, "set": home.sets[0], "error": str(error)})
    document = recorded_data(trace, observed, home.specification, home.all_values())
    document["formulas"] += refused
    return document


def _files(ask: Mapping[str, Any]) -> list[tuple[str, str]]:
    """The names and contents that were sent. Raises ``UsageError``, ``InputError``."""
    every = Fields(ask, "question").items("files")
    if not 1 <= len(every) <= MOST_FILES:
        raise UsageError(f"{len(every)} files: drop 1 to {MOST_FILES} at once")
    found = []
    for one in every:
        data = Fields(one, "file", ("name", "content"))
        name = data.text("name")
        if not _NAME.fullmatch(name):
            raise UsageError(
                f"file {name[:60]!r}: drop drives and certificates (.json), samples (.csv, .xosc), or the "
                "files of a recording (01_tracks.csv, 01_tracksMeta.csv, 01_recordingMeta.csv) together"
            )
        found.append((name, data.text("content")))
    return found


@contextmanager
def _laid_out(ask: Mapping[str, Any]) -> Iterator[Path]:
    """A folder of our own with the files in it, for as long as it is needed."""
    with tempfile.TemporaryDirectory(prefix="roadproof-studio-") as place:
        for name, content in _files(ask):
            (Path(place) / name).write_text(content, "utf-8")
        try:
            yield Path(place)
        except RoadproofError as error:
            raise InputError(str(error).replace(f"{place}/", "")) from None


def _whole(value: object) -> int:
    if not isinstance(value, int) or isinstance(value, bool):
        raise UsageError(f"vehicle {str(value)[:40]}: name it by its number")
    return value


def _plain(rows: list[dict[str, Any]]) -> list[dict[str, Any]]:
    return [{name: x if isinstance(x, str | bool) else _number(x) for name, x in row.items()} for row in rows]


def _number(value: Any) -> int | float | None:
    if value is None:
        return None
    return int(value) if float(value) == int(value) else float(value)
