"""Cases: each thing that was asked, whether it came out as expected, and where it is written."""

import re
from collections.abc import Iterable
from enum import StrEnum
from pathlib import Path
from typing import Literal, TypeAlias

from roadproof.library.specification import Specification, source_of
from roadproof.library.uses import used_in
from roadproof.logic.syntax import Claim, Definition
from roadproof.runtime.records import dataclass
from roadproof.verdict import ExitCode, Verdict

_LIBRARY = Path(__file__).parents[2] / "library" / "sets"

State: TypeAlias = Literal["passed", "failed", "undecided", "skipped"]


class Rule(StrEnum):
    """Why a case did not pass, where that is no verdict."""

    WRONG_TEST = "WRONG-TEST"
    NOT_TESTED = "NOT-TESTED"
    CONTRADICTION = "CONTRADICTION"
    REJECTED = "REJECTED"
    UNREADABLE = "UNREADABLE"
    MISSING = "MISSING"
    STALE = "STALE"
    NO_ANSWER = "NO-ANSWER"


MEANINGS = {
    Verdict.PROVED: "A claim that was expected to be false is proved.",
    Verdict.PROVED_BOUNDED: "A claim that was expected to be false holds within limits.",
    Verdict.REFUTED: "A claim has a counterexample.",
    Verdict.VACUOUS: "A claim holds only because its premise never does.",
    Verdict.WITNESSED: "There is a drive where none was expected.",
    Verdict.IMPOSSIBLE: "No drive can show this formula.",
    Verdict.NONE_WITHIN: "No drive within the limits of the search shows this formula.",
    Verdict.UNKNOWN: "The question is not decided.",
    Verdict.GAPS: "There is danger that the spec set does not cover.",
    Verdict.CROSSCHECK_FAILED: "Two evaluations of one formula differ.",
    Rule.WRONG_TEST: "A test does not show what it claims, or cannot be read.",
    Rule.NOT_TESTED: "No test shows this scenario or class.",
    Rule.CONTRADICTION: "Tests or recordings contradict a proof.",
    Rule.REJECTED: "Evidence does not show what it says.",
    Rule.UNREADABLE: "A file cannot be read.",
    Rule.MISSING: "There is no evidence for a requirement.",
    Rule.STALE: "What a requirement rests on changed since it was accepted.",
    Rule.NO_ANSWER: "The command ended without an answer.",
}
"""What each rule means, in a sentence."""


@dataclass(frozen=True)
class Location:
    """A place in a file; line and column count from 1."""

    file: str
    line: int = 1
    column: int = 1

    def __str__(self) -> str:
        return f"{self.file}:{self.line}:{self.column}"


@dataclass(frozen=True, kw_only=True)
class Case:
    """One thing that was asked.

    ``rule``: the verdict, or what is wrong, which has a meaning in ``MEANINGS``. ``message``: why it did not
    pass. ``place``: where it is written; ``related``: the definitions that it names. ``evidence``: the file
    of its drive or certificate.
    """

    suite: str
    name: str
    state: State
    rule: Verdict | Rule | None = None
    message: str = ""
    place: Location | None = None
    related: tuple[tuple[str, Location], ...] = ()
    evidence: Path | None = None
    seconds: float | None = None


def state_of(verdict: Verdict, expected: Iterable[Verdict]) -> State:
    """As the exit code says it: 0 is passed, 20 undecided, and all else failed."""
    if verdict in expected:
        return "passed"
    return "undecided" if verdict is Verdict.UNKNOWN else "failed"


def whole_case(command: str, cases: Iterable[Case], code: ExitCode) -> Case | None:
    """A case for a whole answer, where ``code`` is not 0 and no case of its parts says why; else None."""
    if code is ExitCode.AS_EXPECTED:
        return None
    state: State = "undecided" if code is ExitCode.UNKNOWN else "failed"
    if any(x.state == state for x in cases):
        return None
    rules: dict[ExitCode, Verdict | Rule] = {
        ExitCode.UNKNOWN: Verdict.UNKNOWN,
        ExitCode.CROSSCHECK_FAILED: Verdict.CROSSCHECK_FAILED,
    }
    told = f"the exit code is {int(code)}, which no part of the answer alone has"
    rule = rules.get(code, Rule.REJECTED)
    return Case(suite="the answer", name=f"roadproof {command}", state=state, rule=rule, message=told)


def ended_case(command: str, code: ExitCode, message: str) -> Case:
    """The case of a command that ended without an answer."""
    states: dict[ExitCode, tuple[State, Verdict | Rule]] = {
        ExitCode.AS_EXPECTED: ("skipped", Rule.NO_ANSWER),  # a share of the work is done
        ExitCode.UNKNOWN: ("undecided", Verdict.UNKNOWN),
        ExitCode.BAD_INPUT: ("failed", Rule.UNREADABLE),
    }
    state, rule = states.get(code, ("failed", Rule.NO_ANSWER))
    return Case(suite="the answer", name=f"roadproof {command}", state=state, rule=rule, message=message)


def definition_location(specification: Specification, definition: Definition) -> Location | None:
    """Where a definition is written; None where it was put together."""
    name = source_of(specification.library, definition).name
    if not name:
        return None
    bundled = _LIBRARY / name
    own = any(x.name == name for x in specification.library.files)
    return Location(name if own else str(bundled), definition.at.line, definition.at.column)


def named_definitions(specification: Specification, claim: Claim) -> tuple[tuple[str, Location], ...]:
    """The definitions that a claim is made of with their places, those of the user first."""
    own = {x.name for x in specification.library.files}
    places = (
        (name, definition_location(specification, x))
        for name, x in used_in(specification, claim).named.items()
    )
    found = [(name, place) for name, place in places if place is not None]
    return tuple(sorted(found, key=lambda x: x[1].file not in own))


def test_location(file: str, name: str) -> Location:
    """Where a test is written: its id in a TOML file, else the beginning of its file."""
    path = Path(file)
    if path.suffix == ".toml" and path.is_file():
        pattern = re.compile(rf"\s*id\s*=\s*[\"']{re.escape(name)}[\"']")
        for number, line in enumerate(path.read_text("utf-8", "replace").splitlines(), 1):
            if pattern.match(line):
                return Location(file, number, len(line) - len(line.lstrip()) + 1)
    return Location(file)
