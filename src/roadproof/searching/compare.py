"""Two formulas side by side: which implies which, by a proof or a drive in each direction."""

from dataclasses import dataclass, replace
from typing import Any, Literal, TypeAlias

from roadproof.effort import Late
from roadproof.evidence.certificate import Certificate, certificate_data
from roadproof.evidence.judged import Judged
from roadproof.proving.prover import prove
from roadproof.searching.ask import Search, ask
from roadproof.spec.compose import both, implication, negation
from roadproof.spec.query import Query
from roadproof.verdict import Verdict

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

    def as_data(self) -> dict[str, Any]:
        """As plain data."""
        return {
            "claim": self.claim.text,
            "verdict": str(self.verdict),
            "reason": self.reason,
            "certificate": None if self.certificate is None else certificate_data(self.certificate),
            "drive": None if self.drive is None else self.drive.as_data(),
        }


@dataclass(frozen=True)
class Comparison:
    """How the first formula relates to the second: stronger is to imply it and not the reverse.

    ``sets``: the spec sets that the two are of.
    """

    first: Query
    second: Query
    relation: Relation
    forward: Direction
    backward: Direction
    sets: tuple[str, str]

    @property
    def directions(self) -> dict[str, Direction]:
        """Both directions, each with a name."""
        return {"first implies second": self.forward, "second implies first": self.backward}

    def as_data(self) -> dict[str, Any]:
        """As plain data, without its heading."""
        return {
            "first": {"formula": self.first.text, "set": self.sets[0]},
            "second": {"formula": self.second.text, "set": self.sets[1]},
            "relation": self.relation,
            "forward": self.forward.as_data(),
            "backward": self.backward.as_data(),
        }


def compare(search: Search, other: Query, set_name: str | None = None) -> Comparison:
    """Compare the formula of a search with another, both read with the search's specification.

    ``set_name``: the spec set of the other, where that is another one (``compose.taken_from``). Drives
    that tell them apart are looked for in the search's setting. Raises as ``ask`` does.
    """
    forward = _imply(search, search.query, other)
    backward = _imply(search, other, search.query)
    mine = search.specification.set_name
    relation = _relation(forward, backward)
    return Comparison(search.query, other, relation, forward, backward, (mine, set_name or mine))


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
    effort = against.search_options.effort
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
