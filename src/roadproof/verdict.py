"""Verdicts, and the exit code that belongs to each (docs/explanation/meaning.md)."""

from collections.abc import Iterable
from enum import IntEnum, StrEnum
from typing import Literal, TypeAlias, get_args


class Verdict(StrEnum):
    """Answers to claims and to questions of existence. None of them leaves without evidence."""

    PROVED = "PROVED"  # for all time; certificate
    PROVED_BOUNDED = "PROVED-BOUNDED"  # up to a horizon, on a grid, within limits
    REFUTED = "REFUTED"  # judged counterexample
    VACUOUS = "VACUOUS"  # holds, but only because its premise never does
    WITNESSED = "WITNESSED"  # judged drive
    IMPOSSIBLE = "IMPOSSIBLE"  # a proof for all time that there is none
    NONE_WITHIN = "NONE-WITHIN"  # none within horizon, grid and limits
    DERIVED = "DERIVED"  # worked out exactly from a definition or a model; checked by working it out again
    UNKNOWN = "UNKNOWN"  # says why
    COVERED = "COVERED"  # of a set that misses no disturbance; certificates
    GAPS = "GAPS"  # of a set that misses some; judged drives
    CROSSCHECK_FAILED = "CROSSCHECK-FAILED"  # readers of the same formula disagree


ClaimVerdict: TypeAlias = Literal[
    Verdict.PROVED,
    Verdict.PROVED_BOUNDED,
    Verdict.REFUTED,
    Verdict.VACUOUS,
    Verdict.UNKNOWN,
    Verdict.CROSSCHECK_FAILED,
]
"""Answers to claims."""


ProofVerdict: TypeAlias = Literal[
    Verdict.PROVED, Verdict.REFUTED, Verdict.VACUOUS, Verdict.UNKNOWN, Verdict.CROSSCHECK_FAILED
]
"""Answers to claims over dense, unbounded time."""


DriveVerdict: TypeAlias = Literal[Verdict.WITNESSED, Verdict.IMPOSSIBLE, Verdict.NONE_WITHIN, Verdict.UNKNOWN]
"""Answers to questions for drives."""


def claim_verdict(word: str) -> ClaimVerdict:
    """The answer to a claim that has a name, such as PROVED. Raises ``KeyError``."""
    verdicts: dict[str, ClaimVerdict] = {str(x): x for x in get_args(ClaimVerdict)}
    return verdicts[word]


class ExitCode(IntEnum):
    AS_EXPECTED = 0
    USAGE = 2
    BAD_INPUT = 3
    MISSING_SOLVER = 4
    UNEXPECTED = 10
    UNKNOWN = 20
    CROSSCHECK_FAILED = 30
    OUR_FAULT = 70
    INTERRUPTED = 130
    READER_GONE = 141  # as shells report SIGPIPE; not 0, since the answer was not delivered
    ENDED = 143  # as shells report SIGTERM


def exit_code(outcomes: Iterable[tuple[Verdict, Verdict]]) -> ExitCode:
    """The exit code for (verdict, expected) pairs; the gravest wins, and a doubt is never 0.

    >>> exit_code([(Verdict.PROVED, Verdict.PROVED), (Verdict.UNKNOWN, Verdict.PROVED)])
    <ExitCode.UNKNOWN: 20>
    """
    worst = ExitCode.AS_EXPECTED
    for verdict, expected in outcomes:
        if verdict is Verdict.CROSSCHECK_FAILED:
            code = ExitCode.CROSSCHECK_FAILED
        elif verdict is Verdict.UNKNOWN:
            code = ExitCode.UNKNOWN
        elif verdict is not expected:
            code = ExitCode.UNEXPECTED
        else:
            code = ExitCode.AS_EXPECTED
        worst = max(worst, code)
    return worst
