"""Which model drives where nothing is said: a car, or the first kind that a formula leaves open."""

from fractions import Fraction

from roadproof.errors import UsageError
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.custom_names import code_of, vehicles_with_kind
from roadproof.logic.formula import Formula
from roadproof.logic.initial_conditions import conjuncts
from roadproof.logic.rewrite import terms_of
from roadproof.semantics.exact.exact import judge
from roadproof.semantics.exact.signals import AbstractSignals
from roadproof.world.models import load_vehicle, names_of
from roadproof.world.signals import KINDS, Kind
from roadproof.world.vehicle import Vehicle


def usual_model(formula: Formula, vehicle: str) -> Vehicle:
    """The shipped model of the first kind that is not excluded by a part of the conjunction ``formula``."""
    asked = [part for part in conjuncts(formula) if _is_about_kind(part, vehicle)]
    kinds = (kind for kind in KINDS if kind in names_of("vehicles"))
    return load_vehicle(next((k for k in kinds if all(_holds(x, vehicle, k) for x in asked)), KINDS[0]))


def refuse_unknown(formula: Formula, vehicle: str, model: Vehicle) -> None:
    """Raise ``UsageError`` where a formula speaks of a kind that the model does not tell."""
    if model.kind is None and vehicle in vehicles_with_kind(formula):
        raise UsageError(
            f"vehicle {vehicle}={model.name}: the formula mentions its kind, and the model does not say it: "
            f'write kind = "{KINDS[1]}" in its file (or {", ".join(x for x in KINDS if x != KINDS[1])})'
        )


def _is_about_kind(part: Formula, vehicle: str) -> bool:
    """Whether ``part`` says something of the kind of ``vehicle``, and of nothing else."""
    about = (f.Truth, f.Compare, f.Not, f.And, f.Or, f.Application)
    if not all(isinstance(x, about) for x in f.subformulas(part)):
        return False
    leaves = [x for side in terms_of(part) for x in t.leaves(side) if not isinstance(x, t.Number)]
    return bool(leaves) and all(x == t.Size("kind", vehicle) for x in leaves)


def _holds(part: Formula, vehicle: str, kind: Kind) -> bool:
    return judge(part, AbstractSignals({}, {t.Size("kind", vehicle): Fraction(code_of(kind))})).holds
