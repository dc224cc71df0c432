"""The reference road of a formula that names none."""

from functools import cache

from roadproof.logic import formula as f
from roadproof.logic.formula import Formula, subformulas
from roadproof.world.models import load_road
from roadproof.world.road import Road


def usual_road(formula: Formula) -> Road:
    """Return the reference road that has the zones of ``formula``: merge, depart, else main-2."""
    zones = zones_of(formula)
    return _reference("merge" if "merge" in zones else "depart" if "depart" in zones else "main-2")


_reference = cache(load_road)


def zones_of(formula: Formula) -> frozenset[str]:
    """Return the zones that a formula mentions."""
    quantified = (x for x in subformulas(formula) if isinstance(x, f.Some | f.Every))
    return frozenset(x.domain.of for x in quantified if x.domain.kind == "zone")
