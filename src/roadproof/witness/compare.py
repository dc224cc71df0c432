"""Two formulas side by side: which implies which, by a proof or a drive in each direction."""

from dataclasses import dataclass, replace
from typing import Literal, TypeAlias

from roadproof.effort import Late
from roadproof.evidence.certificate import Certificate
from roadproof.evidence.judged import Judged
from roadproof.prove.prover import prove
from roadproof.spec.compose import both, implication, negation
from roadproof.spec.query import Query
from roadproof.verdict import Verdict
from roadproof.witness.ask import Search, ask

Relation: TypeAlias = Literal["equivalent", "stronger", "weaker", "incomparable", "unknown"]

PROOF = 5.0  # units of work for a proof before a drive is looked for


@dataclass(frozen=True)
class Direction:
    """``claim`` is ``F1 -> F2``: PROVED with a certificate, REFUTED with a drive, or neither."""

    claim: Query
    verdict: Verdict
    reason: str = ""
    certificate: Certificate | None = None
    drive: Judged | None = None


@dataclass(frozen=True)
class Comparison:
    """How the first formula relates to the second: stronger is to imply it and not the reverse."""

    first: Query
    second: Query
    relation: Relation
    forward: Direction
    backward: Direction


def compare(search: Search, other: Query) -> Comparison:
    """Compare the formula of a search with another, both read with the search's specification.

    Drives that tell them apart are looked for in the search's setting. Raises as ``ask`` does.
    """
    forward = _imply(search, search.query, other)
    backward = _imply(search, other, search.query)
    return Comparison(search.query, other, _relation(forward, backward), forward, backward)


def _relation(forward: Direction, backward: Direction) -> Relation:
    match forward.verdict, backward.verdict:
        case Verdict.PROVED, Verdict.PROVED:
            return "equivalent"
        case Verdict.PROVED, Verdict.REFUTED:
            return "stronger"
        case Verdict.REFUTED, Verdict.PROVED:
            return "weaker"
        case Verdict.REFUTED, Verdict.REFUTED:
            return "incomparable"
        case _:
            return "unknown"


def _imply(search: Search, one: Query, other: Query) -> Direction:
    """Which of the two is so; UNKNOWN where the clock cuts the search off."""
    claim = implication(one, other)
    try:
        return _decide(replace(search, query=both(one, negation(other)), count=1), claim)
    except Late as late:
        return Direction(claim, Verdict.UNKNOWN, str(late))


def _decide(against: Search, claim: Query) -> Direction:
    """Ask for a proof first, which takes a moment where there is one, then for a drive against the claim."""
    effort = against.means.effort
    proof = prove(against.specification, claim, effort.of(min(PROOF, effort.units)))
    if proof.holds and proof.certificate is not None:
        return Direction(claim, Verdict.PROVED, proof.reason, certificate=proof.certificate)
    found = ask(against)
    if found.drives:
        return Direction(claim, Verdict.REFUTED, drive=found.drives[0])
    if found.impossibility is not None:
        return Direction(claim, Verdict.PROVED, certificate=found.impossibility.certificate)
    verdict = Verdict.PROVED_BOUNDED if found.verdict is Verdict.NONE_WITHIN else Verdict.UNKNOWN
    return Direction(claim, verdict, found.reason)
