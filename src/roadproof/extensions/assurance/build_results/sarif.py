"""Writes test cases that did not pass as SARIF 2.1.0 (OASIS), which code hosts show beside source lines."""

import hashlib
import json
from collections.abc import Sequence
from pathlib import Path
from urllib.parse import quote

from roadproof.extensions.assurance.build_results.meanings import MEANINGS
from roadproof.frontends.report.cases import Case, Location
from roadproof.runtime.version import VERSION
from roadproof.verdict import ExitCode

SCHEMA = "https://json.schemastore.org/sarif-2.1.0.json"
_ROOT = "SRCROOT"
_LEVELS = {"failed": "error", "undecided": "warning", "skipped": "note"}


def as_sarif(command: str, cases: Sequence[Case], code: ExitCode) -> str:
    """Return SARIF with a result for each case that did not pass.

    Paths of files below the working directory are relative to it.
    """
    reported = [x for x in cases if x.state != "passed"]
    rules = list(dict.fromkeys(x.rule for x in reported if x.rule is not None))
    driver = {
        "name": "roadproof",
        "semanticVersion": VERSION,
        "rules": [{"id": str(x), "shortDescription": {"text": MEANINGS[x]}} for x in rules],
    }
    run = {
        "tool": {"driver": driver},
        "invocations": [
            {
                "executionSuccessful": code not in (ExitCode.OUR_FAULT, ExitCode.CROSSCHECK_FAILED),
                "exitCode": int(code),
                "commandLine": f"roadproof {command}",
            }
        ],
        "originalUriBaseIds": {_ROOT: {"uri": Path.cwd().as_uri() + "/"}},
        "columnKind": "unicodeCodePoints",
        "results": [_result(x) for x in reported],
    }
    content = {"$schema": SCHEMA, "version": "2.1.0", "runs": [run]}
    return json.dumps(content, indent=2, ensure_ascii=False) + "\n"


def sarif(command: str, cases: Sequence[Case], code: ExitCode, in_force: Sequence[str]) -> str:
    """Return the cases of a command as SARIF."""
    return as_sarif(command, cases, code)


def _result(case: Case) -> dict[str, object]:
    related = [_place(place, name) for name, place in case.related]
    message = case.message
    if case.evidence is not None:
        related.insert(0, {"id": 1, **_place(Location(str(case.evidence)), "evidence", whole=True)})
        message = f"{message} [Evidence](1)."
    result: dict[str, object] = {
        "level": _LEVELS[case.state],
        "message": {"text": message},
        "locations": [] if case.place is None else [_place(case.place, case.name, named=True)],
        "partialFingerprints": {"case/v1": _fingerprint(case)},
    }
    rule = {} if case.rule is None else {"ruleId": str(case.rule)}
    return result | rule | ({"relatedLocations": related} if related else {})


def _fingerprint(case: Case) -> str:
    """Return an identifier of a case that is stable across runs and independent of its location."""
    return hashlib.sha256(f"{case.suite}\0{case.name}".encode()).hexdigest()[:16]


def _place(place: Location, name: str, whole: bool = False, named: bool = False) -> dict[str, object]:
    """Return a SARIF location; ``whole``: the file as a whole; ``named``: ``name`` is the logical location,
    not a message.
    """
    region = {} if whole else {"region": {"startLine": place.line, "startColumn": place.column}}
    location: dict[str, object] = {"physicalLocation": {"artifactLocation": _artifact(place.file), **region}}
    return location | ({"logicalLocations": [{"name": name}]} if named else {"message": {"text": name}})


def _artifact(file: str) -> dict[str, str]:
    path = Path(file).absolute()
    if path.is_relative_to(Path.cwd()):
        return {"uri": quote(path.relative_to(Path.cwd()).as_posix()), "uriBaseId": _ROOT}
    return {"uri": path.as_uri()}
