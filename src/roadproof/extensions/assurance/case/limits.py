"""Reads the limits of evidence: what verdicts assume or leave out.

They become assumptions of the goals that a solution supports, because in GSN a solution has no context of its
own.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

from roadproof.core_record import CERTIFICATE, DRIVES
from roadproof.errors import RoadproofError
from roadproof.evidence.finding import Finding, LimitRemark, RemarkKind
from roadproof.evidence.strict import LARGEST_INDEX, Json, read_json

NamedLimits: TypeAlias = Iterator[tuple[str, str]]
"""Pairs of the name of a limit and its text."""

PREMISES, PARAMETERS, BOUNDS, READINGS = "premises", "parameters", "bounds of parameters", "readings"
WITHIN, COLLISIONS, ROADS, PLATES = "within limits", "collisions", "roads", "plates"
SIGNALS, PREVENTION, TESTS, RECORDINGS = "custom signals", "prevention", "tests", "recordings"
UNCHECKED, DIGEST = "not checked", "digest"
_LIMIT_OF_REMARK: Mapping[RemarkKind, str] = {
    RemarkKind.PARAMETERS: PARAMETERS,
    RemarkKind.COLLISIONS: COLLISIONS,
}
BOUNDED = ("NONE-WITHIN", "PROVED-BOUNDED", "UNKNOWN")
"""Verdicts without evidence."""


@dataclass(frozen=True)
class Limit:
    """All limits of one name, each as a text."""

    name: str
    texts: tuple[str, ...]


def limits_of(
    files: Sequence[Path], findings: Iterable[Finding], views: Sequence[Mapping[str, Json]] = ()
) -> tuple[Limit, ...]:
    """Return the limits that evidence states.

    Args:
      files: files of evidence and of answers.
      findings: the results of their check, which say what was not checked.
      views: answers as plain data.
    """
    by_name: dict[str, dict[str, None]] = {}
    for stated in (*map(_limits_of_file, files), *map(_limits_of_answer, views)):
        for name, text in stated:
            by_name.setdefault(name, {})[text] = None
    for name, text in _limits_of_findings(findings):
        by_name.setdefault(name, {})[text] = None
    return tuple(Limit(name, tuple(x)) for name, x in by_name.items())


def _limits_of_file(path: Path) -> NamedLimits:
    try:
        content = read_json(path, LARGEST_INDEX)
    except RoadproofError:
        return  # its finding says so
    if not isinstance(content, dict):
        return
    schema = str(content.get("schema", ""))
    if schema == CERTIFICATE:
        yield from _limits_of_certificate(content)
    elif schema in DRIVES:
        yield from _limits_of_drive(content)
    else:
        yield from _limits_of_answer(content)


def _limits_of_certificate(content: Mapping[str, Json]) -> NamedLimits:
    for name, key in ((PREMISES, "assuming"), (PARAMETERS, "pinned"), (BOUNDS, "assumptions")):
        for text in _texts(content.get(key)):
            yield name, text
    yield from _readings(content.get("options"))


def _limits_of_drive(content: Mapping[str, Json]) -> NamedLimits:
    road = content.get("road")
    if isinstance(road, dict):
        yield ROADS, str(road.get("map") or road.get("name"))


def _limits_of_answer(content: Mapping[str, Json]) -> NamedLimits:
    """Yield the limits of an index, a saved answer, or the results of recordings."""
    yield from _readings(content.get("options"))
    for name, meaning in _mapping(content.get("signals")).items():
        yield SIGNALS, f"{name}: {meaning}"
    if prevention := _mapping(content.get("prevention")):
        of, side, driver = (prevention.get(x) for x in ("of", "side", "driver"))
        yield PREVENTION, f"only {of} that are {side} for driver model {driver}"
    if error := _mapping(content.get("length_error")):
        yield ROADS, f"lengths in lanes differ by up to {_as_text(dict(error))}"
    for recording, why in _mapping(content.get("failed")).items():
        yield RECORDINGS, f"{recording} left out: {why}"
    notes = content.get("notes")
    for recording, lines in _mapping(notes).items():
        for line in _texts(lines):
            yield RECORDINGS, f"{recording}: {line}"
    for line in _texts(notes):
        yield TESTS, line
    for entry in _objects(dict(content)):
        yield from _limits_of_entry(entry)


def _limits_of_entry(entry: Mapping[str, Json]) -> NamedLimits:
    """Yield the limits of an object that has a verdict."""
    verdict, limits = entry.get("verdict"), _mapping(entry.get("limits"))
    if limits:
        texts = (f"{k} {_as_text(v)}" for k, v in limits.items() if v not in (None, [], {}))
        yield WITHIN, f"{verdict}: {'; '.join(texts)}"
    elif verdict in BOUNDED:
        why = " ".join(
            str(entry.get("reason") or "this file states no limits, unlike that of --json").split()
        )
        yield WITHIN, f"{verdict}: {why}"
    if "stepped" in entry and isinstance(fixed := entry.get("fixed"), dict):
        yield PLATES, f"{entry.get('model')}: {_as_text(fixed) or 'nothing'} fixed"
        if stepped := entry.get("stepped"):
            yield PLATES, f"{entry.get('model')}: nothing is claimed between places: {stepped}"


def _limits_of_findings(findings: Iterable[Finding]) -> NamedLimits:
    for finding in findings:
        for remark in finding.checked:
            if finding.verdict in BOUNDED:
                yield WITHIN, f"{finding.verdict}: {remark}"
            elif isinstance(remark, LimitRemark):
                yield _LIMIT_OF_REMARK[remark.kind], remark.limit
        for text in finding.unchecked:
            yield UNCHECKED, text


def _readings(options: Json) -> NamedLimits:
    for name, value in _mapping(options).items():
        yield READINGS, f"{name}={value}"


def _objects(content: Json) -> Iterator[Mapping[str, Json]]:
    """Yield all objects inside a value that have a verdict."""
    if isinstance(content, dict):
        if "verdict" in content:
            yield content
        content = [*content.values()]
    for value in content if isinstance(content, list) else ():
        yield from _objects(value)


def _mapping(value: Json) -> Mapping[str, Json]:
    return value if isinstance(value, dict) else {}


def _texts(value: Json) -> tuple[str, ...]:
    return tuple(x for x in value if isinstance(x, str)) if isinstance(value, list) else ()


def _as_text(value: Json) -> str:
    if isinstance(value, dict):
        return ", ".join(f"{k}={v}" for k, v in value.items())
    return ", ".join(map(str, value)) if isinstance(value, list) else str(value)
