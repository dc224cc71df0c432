"""Cases: each thing that was asked, whether it came out as expected, and where it is written."""

from collections.abc import Iterable
from enum import StrEnum
from pathlib import Path
from typing import Literal, TypeAlias

from roadproof.library.specification import Specification, source_of
from roadproof.library.uses import parts_of_claim
from roadproof.logic.syntax import Claim, Definition
from roadproof.runtime.records import dataclass
from roadproof.verdict import ExitCode, Verdict

_LIBRARY = Path(__file__).parents[2] / "library" / "sets"

State: TypeAlias = Literal["passed", "failed", "undecided", "skipped"]


class CaseRule(StrEnum):
    """The rule of a case that failed for another reason than its verdict."""

    WRONG_TEST = "WRONG-TEST"
    NOT_TESTED = "NOT-TESTED"
    CONTRADICTION = "CONTRADICTION"
    REJECTED = "REJECTED"
    UNREADABLE = "UNREADABLE"
    MISSING = "MISSING"
    STALE = "STALE"
    NO_ANSWER = "NO-ANSWER"


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
    rule: Verdict | CaseRule | None = None
    message: str = ""
    place: Location | None = None
    related: tuple[tuple[str, Location], ...] = ()
    evidence: Path | None = None
    seconds: float | None = None


def state_of(verdict: Verdict, expected: Iterable[Verdict]) -> State:
    """Return the state of a case from its exit code: 0 is passed, 20 undecided, all else failed."""
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
    rules: dict[ExitCode, Verdict | CaseRule] = {  # partial: others are REJECTED
        ExitCode.UNKNOWN: Verdict.UNKNOWN,
        ExitCode.CROSSCHECK_FAILED: Verdict.CROSSCHECK_FAILED,
    }
    message = f"the exit code is {int(code)}, which no part of the answer alone has"
    rule = rules.get(code, CaseRule.REJECTED)
    return Case(suite="the answer", name=f"roadproof {command}", state=state, rule=rule, message=message)


def ended_case(command: str, code: ExitCode, message: str) -> Case:
    """The case of a command that ended without an answer."""
    states: dict[ExitCode, tuple[State, Verdict | CaseRule]] = {  # partial: others failed
        ExitCode.AS_EXPECTED: ("skipped", CaseRule.NO_ANSWER),  # a share of the work is done
        ExitCode.UNKNOWN: ("undecided", Verdict.UNKNOWN),
        ExitCode.BAD_INPUT: ("failed", CaseRule.UNREADABLE),
    }
    state, rule = states.get(code, ("failed", CaseRule.NO_ANSWER))
    return Case(suite="the answer", name=f"roadproof {command}", state=state, rule=rule, message=message)


def definition_location(specification: Specification, definition: Definition) -> Location | None:
    """Return where a definition is written; None where it was put together."""
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
        for name, x in parts_of_claim(specification, claim).named.items()
    )
    placed = [(name, place) for name, place in places if place is not None]
    return tuple(sorted(placed, key=lambda x: x[1].file not in own))
