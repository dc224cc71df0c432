"""Claims with the verdicts they deserve, and an evaluator that shares nothing with the prover."""

import re
from collections.abc import Mapping
from fractions import Fraction
from functools import cache

from definition import of_values
from engine_calls import prove
from roadproof.engines.prove.prover import ProverResult
from roadproof.evidence.atoms import Atoms
from roadproof.evidence.countermodel import Countermodel
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.library.specification import Specification
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import bounds_of, map_terms, without_names
from roadproof.runtime.budget import Effort
from roadproof.semantics.exact import TruthSet, judge
from roadproof.semantics.exact.truth import from_switches
from roadproof.verdict import Verdict
from tables import read_table

P, Q, R = "atLane(SV,L)", "atLane(POV,L)", "fasterThan(SV,POV)"

# Valid in dense time, for all parameters.
VALID = read_table(__file__, "valid")

# Valid because of what every road has: a lanelet has a lane and one zone, a lane has a lanelet.
ALL_ZONES = " {join} ".join(f"({{word}} m in zone({zone}): {{body}})" for zone in ("main", "merge", "depart"))
ALL_OF_THEM = ALL_ZONES.format(word="every", join="and", body="F occ(SV,m)")
SOME_OF_THEM = ALL_ZONES.format(word="some", join="or", body="F occ(SV,m)")
VALID_ON_ROADS = [
    "(some l in zone(main): F occ(SV,l)) -> (some K in lanes: some l in lanelets(K): F occ(SV,l))",
    "(every K in lanes: every l in lanelets(K): G occ(SV,l)) -> (every l in zone(merge): G occ(SV,l))",
    "given l: lanelet: F occ(SV,l) -> (some K in lanes: some m in lanelets(K): F occ(SV,m))",
    "given l: lanelet: (every K in lanes: every m in lanelets(K): F occ(SV,m)) -> F occ(SV,l)",
    f"{ALL_OF_THEM} -> (every K in lanes: every l in lanelets(K): F occ(SV,l))",
    f"{ALL_OF_THEM} -> (some l in lanelets(L): F occ(SV,l))",
    f"given l: lanelet: {ALL_OF_THEM} -> F occ(SV,l)",
    f"(some l in lanelets(L): F occ(SV,l)) -> {SOME_OF_THEM}",
    f"given l: lanelet: F occ(SV,l) -> {SOME_OF_THEM}",
    "some l in lanelets(L): true",
    "some K in lanes: true",
    "not (some K in adjacentLanes(L): every M in adjacentLanes(K): F p) or F p",
    "(every K in adjacentLanes(L): every M in adjacentLanes(K): F atLane(SV,M))"
    " -> (every K in adjacentLanes(L): F atLane(SV,L))",
]

# Valid because of how parameters compare, and proofs that need a name of one instance in another.
VALID_MORE = [
    "minSafe <= minDanger -> F[minSafe,minDanger] true",
    "minSafe <= minDanger -> (G[0,minDanger] p -> G[0,minSafe] p)",
    "minSafe > minDanger -> G[minSafe,minDanger] p",
    "F[1.8 s, inf] (every K1 in lanes: instSafe(POV, SV))"
    " -> F not not (every K1 in lanes: instSafe(POV, SV))",
]

# False on some trace, for some parameters.
INVALID = read_table(__file__, "invalid")

# Not valid, but each trace that shows it switches for ever: nothing is claimed of these.
NEEDS_INFINITELY_MANY_SWITCHES = ["G F p -> F G p", "G F p and G F q -> F (p and q)"]

# True on every road, but for reasons that the prover does not know. It must not call them false.
BEYOND = read_table(__file__, "beyond")


def spelled(claim: str) -> str:
    """``claim`` with p, q, r as atoms of the library."""
    if claim.startswith("given"):
        return claim
    atoms = {"p": P, "q": Q, "r": R}
    return re.sub(r"\b[pqr]\b", lambda found: atoms[found[0]], claim)


def negated(claim: str) -> str:
    given, colon, body = claim.rpartition(": ") if claim.startswith("given") else ("", "", claim)
    return f"{given}{colon}not ({body})"


@cache
def specification(set_name: str = "base") -> Specification:
    return bundled_library().select(set_name)


def settle(claim: str, set_name: str = "base", units: float = 10.0) -> ProverResult:
    return prove(specification(set_name), spelled(claim), Effort(units))


def is_false_on(countermodel: Countermodel, claim: str, set_name: str = "base") -> bool:
    """Whether ``claim`` is false on the trace that a countermodel describes, judged afresh.

    The truth of each atom is taken from the file's values where they decide it, and else as given.
    Only for claims without quantifiers over lanes, whose road a countermodel does not show.
    """
    atoms = Atoms()
    claimed = atoms.abstract(read_claim(specification(set_name), spelled(claim)).formula)
    assert not any(isinstance(x, f.Some | f.Every) for x in _opaquely(claimed))
    rigid = {
        name: value
        for instant in countermodel.instants
        for name, value in instant.values.items()
        if "(" not in name or name.startswith(("length(", "width("))
    }
    given: dict[Formula, TruthSet] = {}
    for part in _opaquely(claimed):
        if isinstance(part, f.Application):
            truths = [_truth(part, instant, countermodel, rigid) for instant in countermodel.instants]
            given[_with_numbers(part, countermodel.parameters)] = _spread(countermodel, truths)
    return not judge(_with_numbers(claimed, countermodel.parameters), None, given).holds


def _opaquely(formula: Formula) -> list[Formula]:
    """The parts of an abstracted claim, not looking into its atoms."""
    inner = [] if isinstance(formula, f.Application) else f.children(formula)
    return [formula, *(part for child in inner for part in _opaquely(child))]


def _truth(atom: f.Application, instant, countermodel: Countermodel, rigid: Mapping[str, Fraction]) -> bool:
    meaning = without_names(atom)
    stated = instant.atoms[atom.name]
    if not any(isinstance(x, f.Occupies | f.Some | f.Every) for x in f.subformulas(meaning)):
        values = {**countermodel.parameters, **rigid, **instant.values}
        assert holds(meaning, values) == stated, (atom.name, instant)
    return stated


def _spread(countermodel: Countermodel, truths: list[bool]) -> TruthSet:
    later = truths if countermodel.interpolation == "before" else [*truths[1:], truths[-1]]
    return from_switches(zip([x.time for x in countermodel.instants], truths, later, strict=True))


def _with_numbers(formula: Formula, parameters: Mapping[str, Fraction]) -> Formula:
    """Parameters as numbers; an operator whose window ends before it begins has no instant to look at."""

    def number(term):
        return t.replace_leaves(
            term, lambda x: t.number(parameters[x.name], x.dimension) if isinstance(x, t.Parameter) else x
        )

    def emptied(part: Formula) -> Formula:
        if isinstance(part, f.Until | f.Eventually | f.Always):
            low, high = bounds_of(part.interval)
            if high is not None and high < low:
                return f.TRUE if isinstance(part, f.Always) else f.FALSE
        return part

    return f.transform(map_terms(formula, number), emptied)


def holds(formula: Formula, values: Mapping[str, Fraction]) -> bool:
    """A formula about one instant and no road; names are as countermodels write them."""
    return of_values([values]).holds(formula)


def speaks_of_all_lanes(claim: str) -> bool:
    abstracted = Atoms().abstract(read_claim(specification(), spelled(claim)).formula)
    return any(isinstance(x, f.Some | f.Every) for x in _opaquely(abstracted))


PROVED = {Verdict.PROVED, Verdict.VACUOUS}
