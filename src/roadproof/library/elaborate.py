"""Elaboration of claims to formulas, with checks of names, sorts, arities, units and cycles."""

import re
from collections.abc import Iterable
from dataclasses import replace

from roadproof.errors import TextError, once_each, raise_all
from roadproof.library import mistakes, scopes
from roadproof.library.elaboration import Elaborator
from roadproof.library.notes import UsedDefinitions
from roadproof.library.scopes import Value, Vehicles
from roadproof.library.specification import Query, Specification, unknown_name
from roadproof.logic import syntax
from roadproof.logic import terms as t
from roadproof.logic.parse import parse_claim
from roadproof.logic.rewrite import vehicles_of
from roadproof.logic.terms import Dimension
from roadproof.world.units import UNITS

MOST_REMEMBERED = 500_000
"""The largest number of formula parts that the shared elaborator of a specification caches."""
MOST_CLAIMS = 5_000
"""The largest number of claims that are cached for one specification."""


def read_claim(specification: Specification, text: str, source: str = "claim") -> Query:
    """Parse and elaborate a claim such as ``scenario_8(SV,POV,L) -> F danger(SV,POV)``.

    SV, POV, POV1…POV9 are vehicles and L, L1…L9 lanes without a declaration. Others are declared in front:
    ``given A, B: vehicle; v: m/s: …``. ``scenario_4@ext(…)`` names a definition of another set. Raises
    ``TextError``.
    """
    read: dict[str, Query] = specification.memo.setdefault((read_claim,), {})
    if text in read:
        return read[text]
    claim = parse_claim(text, source)
    try:
        query = read_tree(specification, claim, text.strip())
        if len(read) < MOST_CLAIMS:
            read[text] = query
        return query
    except TextError as error:
        first = error.locate(source, text)
    raise_all(claim_errors_in(specification, claim, source, text) or [first])
    raise AssertionError("one mistake was found, and then none")


def read_tree(specification: Specification, claim: syntax.Claim, written: str) -> Query:
    """Elaborate a parsed claim; ``written`` is its text. Raises ``TextError``."""
    return replace(elaborate(specification, claim, walk_of(specification)), written=written)


def walk_of(specification: Specification) -> Elaborator:
    """Return the shared elaborator of a specification, which caches the definitions that it has read."""
    walk: Elaborator | None = specification.memo.get((walk_of,))
    if walk is None or len(walk.sizes.known) > MOST_REMEMBERED:
        walk = specification.memo[(walk_of,)] = Elaborator(specification)
    return walk


def claim_errors_in(
    specification: Specification,
    claim: syntax.Claim,
    source: str,
    text: str,
    lost: tuple[re.Pattern[str], ...] = (),
) -> list[TextError]:
    """Return all errors in a claim, the first of each place.

    ``lost``: patterns of names whose declarations could not be parsed; their uses are no errors.
    """
    errors: list[TextError] = []
    walk = Elaborator(specification, errors=errors, lost=lost)
    try:
        walk.formula(claim.body, walk.claim_scope(claim))
    except TextError as error:
        errors.append(error)
    return once_each(error.locate(source, text) for error in errors)


def elaborate(specification: Specification, claim: syntax.Claim, walk: Elaborator | None = None) -> Query:
    """Return the query of a parsed claim. Raises ``TextError``, located if the claim has positions.

    ``walk``: an elaborator for the same specification, whose cache is used.
    """
    return _elaborate_claim(claim, Elaborator(specification) if walk is None else walk.for_next_claim())


def _elaborate_claim(claim: syntax.Claim, elaborator: Elaborator) -> Query:
    formula = elaborator.formula(claim.body, elaborator.claim_scope(claim))
    mistakes.refuse_deeper(elaborator.deepest, claim.body.at)  # also if its parts were cached
    declared = [b.name for b in claim.given if b.sort == "vehicle"]
    free, lanes = (tuple(sorted(elaborator.free[sort])) for sort in ("vehicle", "lane"))
    vehicles = tuple(dict.fromkeys((*declared, *free)))
    return Query(claim, formula, vehicles or vehicles_of(formula), lanes)


def elaborate_with_definitions(
    specification: Specification, claim: syntax.Claim
) -> tuple[Query, UsedDefinitions]:
    """Return the query of a claim, and every definition, by set and name, whose body is part of it.

    Raises ``TextError``.
    """
    elaborator = walk_of(specification).for_next_claim()
    query = _elaborate_claim(claim, elaborator)
    return query, elaborator.used_definitions


def read_term(specification: Specification, text: str, source: str = "term") -> tuple[t.Term, Dimension]:
    """Parse and elaborate a term such as ``v_lon(SV) - v_lon(POV)``, and return it with its dimension.

    Names are free as in ``read_claim``. Raises ``TextError``, also for a formula.
    """
    claim = parse_claim(text, source)
    elaborator = Elaborator(specification)
    try:
        quantity = elaborator.term(claim.body, elaborator.claim_scope(claim))
    except TextError as error:
        raise error.locate(source, text) from None
    return quantity.term, quantity.dimension or UNITS["unitless"][1]


def apply_definition(
    specification: Specification, name: str, arguments: tuple[str, ...] = (), walk: Elaborator | None = None
) -> Query:
    """Return a definition applied to names; by default to its own parameters.

    ``walk``: as for ``elaborate``.

    >>> apply_definition(bundled_library().select(), "scenario_2").vehicles
    ('POV1', 'POV2', 'SV')
    """
    roles = arguments or signature(specification, name.partition("@")[0], walk)
    return elaborate(specification, syntax.Claim((), syntax.Call(name, tuple(map(syntax.Name, roles)))), walk)


def signatures(specification: Specification, names: Iterable[str]) -> dict[str, tuple[str, ...]]:
    """Return the ``signature`` of many definitions; they share a cache."""
    walk = Elaborator(specification)
    return {name: signature(specification, name, walk) for name in names}


def signature(specification: Specification, name: str, walk: Elaborator | None = None) -> tuple[str, ...]:
    """Return the names of the arguments of a definition, a group of vehicles as POV or POV1, POV2.

    The size of a group is the smallest that the definitions below accept. ``walk``: as for ``elaborate``.
    """
    return _applied_to_own(specification, name, walk)[0]


def definitions_below(specification: Specification, name: str) -> UsedDefinitions:
    """Return the definition of a name and all that it uses, by set and name. Raises ``TextError``."""
    used_definitions = _applied_to_own(specification, name, walk_of(specification))[1].used_definitions
    return {(specification.set_name, name): specification.definitions[name]} | used_definitions


def _applied_to_own(
    specification: Specification, name: str, walk: Elaborator | None
) -> tuple[tuple[str, ...], Elaborator]:
    """Return the names of a definition's arguments, and the elaborator that has read its body with them."""
    if name not in specification.definitions:
        raise TextError(unknown_name("definition", name, specification.definitions))
    parameters = specification.definitions[name].parameters
    failure: TextError | None = None
    for size in (1, 2, 3):
        roles: list[str] = []
        scope: dict[str, Value] = {}
        for binding in parameters:
            if binding.sort != "vehicles":
                roles.append(binding.name)
                scope[binding.name] = scopes.typical_value(binding)
                continue
            names = (binding.name,) if size == 1 else tuple(f"{binding.name}{k + 1}" for k in range(size))
            roles += names
            scope[binding.name] = Vehicles(names)
        try:
            elaborator = Elaborator(specification) if walk is None else walk.for_next_claim()
            elaborator.body_of(name, scope)
            return tuple(roles), elaborator
        except TextError as error:
            failure = failure or error
    assert failure is not None
    raise failure
