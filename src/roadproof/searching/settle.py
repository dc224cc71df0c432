"""One claim settled: by a proof, a countermodel, a drive that refutes it, or within bounds.

What searches for drives is imported when one is looked for: most claims are proved without.
"""

import time
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from roadproof.effort import Effort, Late
from roadproof.errors import InputError, UsageError
from roadproof.evidence.judged import Judged
from roadproof.proving.prover import Result, prove
from roadproof.searching.limits import Limits
from roadproof.spec.library import Specification
from roadproof.spec.query import Query
from roadproof.verdict import Verdict

if TYPE_CHECKING:
    from roadproof.searching.ask import Search

DRIVE = 5.0  # units of work for a drive that refutes


@dataclass(frozen=True)
class Settled:
    """A result; ``drive`` is a judged drive on which the claim is false.

    ``bounded``: asked of drives on one road, up to a horizon; ``limits``: within what PROVED-BOUNDED holds.
    """

    result: Result
    drive: Judged | None = None
    limits: Limits | None = None
    bounded: bool = False

    @property
    def verdict(self) -> Verdict:
        """A drive refutes also where no countermodel over points in time was found."""
        return Verdict.REFUTED if self.drive is not None else self.result.verdict


def settle(
    specification: Specification,
    query: Query,
    effort: Effort,
    label: str = "",
    scenario: int | None = None,
    seek_drive: bool = True,
) -> Settled:
    """Prove or refute a claim; a refuted or undecided one also by a drive, where there is one.

    UNKNOWN where the clock cuts the search off.
    """
    begun = time.monotonic()
    try:
        result = prove(specification, query, effort, label, scenario)
    except Late as late:
        return in_doubt(str(late), begun)
    if not seek_drive or result.verdict not in (Verdict.REFUTED, Verdict.UNKNOWN):
        return Settled(result)
    from roadproof.searching.refute import refuting_drive

    try:
        return Settled(result, refuting_drive(specification, query, effort.of(min(DRIVE, effort.units))))
    except (InputError, UsageError):  # the claim is not about drives
        return Settled(result)
    except Late as late:
        return Settled(result) if result.verdict is Verdict.REFUTED else in_doubt(str(late), begun)


def settle_bounded(search: "Search") -> Settled:
    """Look for a drive that refutes the claim within bounds; where none is possible at all, prove it."""
    from roadproof.searching.bounded import check_bounded

    begun = time.monotonic()
    try:
        found = check_bounded(search)
    except Late as late:
        return replace(in_doubt(str(late), begun), bounded=True)
    if found.verdict is Verdict.PROVED:
        return settle(search.specification, search.query, search.search_options.effort)
    result = Result(found.verdict, found.reason, time.monotonic() - begun)
    return Settled(result, found.drive, found.limits, bounded=True)


def in_doubt(reason: str, begun: float | None = None) -> Settled:
    """What is said of a claim that nothing is known of; ``begun``: since when it was asked."""
    seconds = 0.0 if begun is None else time.monotonic() - begun
    return Settled(Result(Verdict.UNKNOWN, reason, seconds))
