"""Limits of evidence: what verdicts suppose or leave out, read from the evidence of a solution.

They become assumptions of the goals that the solution supports: in GSN a solution itself has no context.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

from roadproof.errors import RoadproofError
from roadproof.evidence import certificate, drive_file
from roadproof.evidence.finding import Finding
from roadproof.evidence.strict import LARGEST_INDEX, Json, read_json

Found: TypeAlias = Iterator[tuple[str, str]]
"""Names of limits, each with one limit in words."""

PREMISES, PARAMETERS, BOUNDS, READINGS = "premises", "parameters", "bounds of parameters", "readings"
WITHIN, COLLISIONS, ROADS, PLATES = "within limits", "collisions", "roads", "plates"
SIGNALS, PREVENTION, TESTS, RECORDINGS = "own signals", "prevention", "tests", "recordings"
UNCHECKED, DIGEST = "not checked", "digest"
BOUNDED = ("NONE-WITHIN", "PROVED-BOUNDED", "UNKNOWN")
"""Verdicts without evidence."""


@dataclass(frozen=True)
class Limit:
    """All limits of one name, each in words."""

    name: str
    told: tuple[str, ...]


def limits_of(
    files: Sequence[Path], findings: Iterable[Finding], views: Sequence[Mapping[str, Json]] = ()
) -> tuple[Limit, ...]:
    """The limits that files of evidence and ``views`` of answers state, and what was not checked."""
    found: dict[str, dict[str, None]] = {}
    for stated in (*map(_of_file, files), *map(_of_answer, views)):
        for name, told in stated:
            found.setdefault(name, {})[told] = None
    for name, told in _of_findings(findings):
        found.setdefault(name, {})[told] = None
    return tuple(Limit(name, tuple(x)) for name, x in found.items())


def _of_file(path: Path) -> Found:
    try:
        content = read_json(path, LARGEST_INDEX)
    except RoadproofError:
        return  # its finding says so
    if not isinstance(content, dict):
        return
    schema = str(content.get("schema", ""))
    if schema == certificate.SCHEMA:
        yield from _of_certificate(content)
    elif schema in drive_file.SCHEMAS_READ:
        yield from _of_drive(content)
    else:
        yield from _of_answer(content)


def _of_certificate(content: Mapping[str, Json]) -> Found:
    for name, key in ((PREMISES, "assuming"), (PARAMETERS, "pinned"), (BOUNDS, "assumptions")):
        for told in _texts(content.get(key)):
            yield name, told
    yield from _readings(content.get("options"))


def _of_drive(content: Mapping[str, Json]) -> Found:
    road = content.get("road")
    if isinstance(road, dict):
        yield ROADS, str(road.get("map") or road.get("name"))


def _of_answer(content: Mapping[str, Json]) -> Found:
    """Limits of an index, of a kept answer or of the results of recordings."""
    yield from _readings(content.get("options"))
    for name, told in _mapping(content.get("signals")).items():
        yield SIGNALS, f"{name}: {told}"
    if said := _mapping(content.get("prevention")):
        yield (
            PREVENTION,
            f"only {said.get('of')} that are {said.get('side')} for driver model {said.get('driver')}",
        )
    if said := _mapping(content.get("length_error")):
        yield ROADS, f"lengths in lanes differ by up to {_told(dict(said))}"
    for recording, why in _mapping(content.get("failed")).items():
        yield RECORDINGS, f"{recording} left out: {why}"
    notes = content.get("notes")
    for recording, lines in _mapping(notes).items():
        for line in _texts(lines):
            yield RECORDINGS, f"{recording}: {line}"
    for line in _texts(notes):
        yield TESTS, line
    for said in _objects(dict(content)):
        yield from _of_entry(said)


def _of_entry(said: Mapping[str, Json]) -> Found:
    """Limits of an object that has a verdict."""
    verdict, limits = said.get("verdict"), _mapping(said.get("limits"))
    if limits:
        told = (f"{k} {_told(v)}" for k, v in limits.items() if v not in (None, [], {}))
        yield WITHIN, f"{verdict}: {'; '.join(told)}"
    elif verdict in BOUNDED:
        why = " ".join(str(said.get("reason") or "this file states no limits, unlike that of --json").split())
        yield WITHIN, f"{verdict}: {why}"
    if "stepped" in said and isinstance(fixed := said.get("fixed"), dict):
        yield PLATES, f"{said.get('model')}: {_told(fixed) or 'nothing'} fixed"
        if stepped := said.get("stepped"):
            yield PLATES, f"{said.get('model')}: nothing is claimed between places: {stepped}"


def _of_findings(findings: Iterable[Finding]) -> Found:
    for finding in findings:
        for told in finding.checked:
            if finding.verdict in BOUNDED:
                yield WITHIN, f"{finding.verdict}: {told}"
            elif told == "declared parameters" or told.startswith("with "):
                yield PARAMETERS, told
            elif told.startswith(("boxes apart up to", "collisions allowed")):
                yield COLLISIONS, told.split(":")[0].removeprefix("collisions ")
        for told in finding.unchecked:
            yield UNCHECKED, told


def _readings(options: Json) -> Found:
    for name, value in _mapping(options).items():
        yield READINGS, f"{name}={value}"


def _objects(content: Json) -> Iterator[Mapping[str, Json]]:
    """All objects inside of a value that have a verdict."""
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


def _told(value: Json) -> str:
    if isinstance(value, dict):
        return ", ".join(f"{k}={v}" for k, v in value.items())
    return ", ".join(map(str, value)) if isinstance(value, list) else str(value)
