"""A claim's ground query with every quantifier instantiated, again and again, at all moments met.

Where a claim is false, no choice of instances may make its query unsatisfiable; this tries a large
one, without a finder.
"""

import re

from roadproof.engines.solve.smt import Satisfiability, check_sat
from roadproof.evidence import derivation
from roadproof.evidence.atoms import Atoms
from roadproof.evidence.times import ZERO, moment_of, named_moment
from roadproof.library.elaborate import read_claim
from roadproof.library.specification import Specification
from roadproof.logic import formula as f
from roadproof.logic.rewrite import road_names
from roadproof.runtime.budget import Effort


def saturated(specification: Specification, claim: str, rounds: int = 4, most: int = 60) -> str:
    """The ground query of ``claim`` after ``rounds`` of naming what was met and instantiating there."""
    query = read_claim(specification, claim)
    atoms = Atoms()
    goal = atoms.abstract(query.formula)
    bounds = {name: p.bound for name, p in specification.library.parameters.items()}
    shifts = [
        moment_of(bound)
        for part in f.subformulas(goal)
        if isinstance(part, f.Until | f.Eventually | f.Always)
        for bound in (part.interval.low, part.interval.high)
        if bound is not None
    ]
    lane_prefix = derivation.free_prefix("M", {*query.lanes, *road_names(goal)})
    names: dict[derivation.Site, str] = {}
    instances: dict[derivation.Site, tuple[str, ...]] = {}
    for _ in range(rounds):
        walk = derivation._new_derivation(goal, atoms, instances, names, bounds, query.lanes)
        walk.truth(goal, False, ZERO)
        for site in sorted(filter(_is_settled, walk.met_existentials - set(names)), key=str):
            names[site] = f"{lane_prefix if _on_road(site) else 't'}{len(names) + 1}"
        times = [ZERO, *(named_moment(name) for site, name in names.items() if not _on_road(site))]
        pool = [*times, *(time + shift for time in times for shift in shifts)]
        lanes = [*query.lanes, *(name for site, name in names.items() if _on_road(site))]
        for site in filter(_is_settled, walk.met_universals):
            new = lanes if _on_road(site) else map(str, pool)
            instances[site] = tuple(dict.fromkeys([*instances.get(site, ()), *new]))[:most]
    lemmas: tuple[derivation.StateLemma, ...] = ()
    walk = derivation._new_derivation(goal, atoms, instances, names, bounds, query.lanes)
    walk.truth(goal, False, ZERO)
    named = {site: name for site, name in names.items() if site in walk.met_existentials}
    made = {site: texts for site, texts in instances.items() if site in walk.met_universals}
    return derivation.derive_query(goal, atoms, made, named, lemmas, bounds, query.lanes)


def _is_settled(site: derivation.Site) -> bool:
    """Whether the moment of ``site`` has its final name, and not that of an unnamed existential."""
    return re.search(r"\bu_*\d+_", f"{site.moment} {site.instance} {site.formula}") is None


def _on_road(site: derivation.Site) -> bool:
    return site.formula.startswith(("(some", "(every"))


def probe(specification: Specification, claim: str, units: float = 2.0) -> Satisfiability:
    """z3's answer to the saturated query: ``unsat`` would prove ``claim``."""
    return check_sat(saturated(specification, claim), meter=Effort(units).meter())
