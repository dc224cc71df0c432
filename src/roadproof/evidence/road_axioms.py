"""The axioms of roads in one table: as text, in Coq, and as SMT-LIB about memberships of lanelets.

docs/explanation/formal.md has the text, proofs/kernel/Meaning.v the Coq form, and the provers use the
SMT-LIB. A test compares these, and the roads of files, countermodels and searches, with this table.
"""

from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass
from itertools import combinations
from typing import TypeAlias

from roadproof.logic import formula as f

ZONES = ("main", "merge", "depart")
Membership: TypeAlias = tuple[f.Domain, str]


def membership(domain: f.Domain, element: str) -> str:
    """Return the name of the fact that ``element`` belongs to ``domain``; time does not change it."""
    return f"{element} in {domain.kind}({domain.of})"


def _fact(domain: f.Domain, element: str) -> str:
    return f"|{membership(domain, element)}|"


def _no_instances(_: Collection[Membership]) -> Iterator[str]:
    """Yield nothing: the axiom is no clause about memberships."""
    yield from ()


def _own_lane(memberships: Collection[Membership]) -> Iterator[str]:
    for domain, element in memberships:
        if domain.kind == "lanelets" and domain.of == element:
            yield _fact(domain, element)


def _not_beside_itself(memberships: Collection[Membership]) -> Iterator[str]:
    for domain, element in memberships:
        if domain.kind == "adjacent" and domain.of == element:
            yield f"(not {_fact(domain, element)})"


def _beside_both_ways(memberships: Collection[Membership]) -> Iterator[str]:
    for domain, element in memberships:
        converse = f.Domain("adjacent", element), domain.of
        if domain.kind == "adjacent" and domain.of < element and converse in memberships:
            yield f"(= {_fact(domain, element)} {_fact(*converse)})"


def _one_zone(memberships: Collection[Membership]) -> Iterator[str]:
    zones: dict[str, list[str]] = {}
    for domain, element in memberships:
        if domain.kind == "zone":
            zones.setdefault(element, []).append(_fact(domain, element))
    for facts in map(sorted, zones.values()):
        yield from (f"(not (and {a} {b}))" for a, b in combinations(facts, 2))
        if len(facts) == len(ZONES):
            yield f"(or {' '.join(facts)})"


@dataclass(frozen=True)
class RoadAxiom:
    """An axiom in ``words``, as fields of ``world`` in ``coq``, and its ``instances`` as SMT-LIB."""

    name: str
    words: str
    coq: tuple[str, ...]
    instances: Callable[[Collection[Membership]], Iterator[str]] = _no_instances


AXIOMS = (
    RoadAxiom("some lanelet", "a road has a lanelet", ("element : Type", "somewhere : element")),
    RoadAxiom(
        "own lane",
        "every lanelet is a lanelet of the lane that it belongs to",
        ("lanelets : element -> element -> Prop", "lanelets_reflexive : forall l, lanelets l l"),
        _own_lane,
    ),
    RoadAxiom(
        "one zone",
        "every lanelet is in one of the zones main, merge and depart, and in no other",
        ("zone_of : element -> zone",),
        _one_zone,
    ),
    RoadAxiom(
        "not beside itself",
        "no lane is adjacent to itself",
        ("adjacent : element -> element -> Prop", "adjacent_irreflexive : forall l, ~ adjacent l l"),
        _not_beside_itself,
    ),
    RoadAxiom(
        "beside both ways",
        "a lane is adjacent to all lanes that are adjacent to it",
        ("adjacent_symmetric : forall l m, adjacent l m -> adjacent m l",),
        _beside_both_ways,
    ),
    RoadAxiom(
        "rectangles",
        "a lanelet is a rectangle along and across the road, which may have no end along it",
        ("shape : element -> extent",),
    ),
)


def road_clauses(memberships: Collection[Membership]) -> list[str]:
    """Return the SMT-LIB clauses about ``memberships`` that hold on every road.

    Their names are ``membership(…)``; a name may denote a lanelet and also the lane that it belongs to.
    """
    known = dict.fromkeys(memberships)
    return [clause for axiom in AXIOMS for clause in axiom.instances(known)]
