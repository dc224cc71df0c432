"""Who meets whom: syntax trees to formulas. Names, sorts, arities, units and cycles are checked here."""

import re
from collections.abc import Iterable
from dataclasses import replace

from roadproof.errors import TextError, once_each, raise_all
from roadproof.library import scopes
from roadproof.library.elaboration import Elaborator
from roadproof.library.notes import Entered, Note
from roadproof.library.scopes import Value, Vehicles
from roadproof.library.specification import Query, Specification, unknown
from roadproof.logic import syntax
from roadproof.logic import terms as t
from roadproof.logic.parse import parse_claim
from roadproof.logic.rewrite import vehicles_of
from roadproof.logic.terms import Dimension
from roadproof.world.units import UNITS

MOST_REMEMBERED = 500_000
"""So many parts of formulas are remembered of what was read in one specification."""
MOST_CLAIMS = 5_000
"""So many claims are remembered as they were read in one specification."""


def read_claim(specification: Specification, text: str, source: str = "claim") -> Query:
    """Parse and elaborate a claim such as ``scenario_8(SV,POV,L) -> F danger(SV,POV)``.

    SV, POV, POV1…POV9 are vehicles and L, L1…L9 lanes without being declared; others are declared
    in front: ``given A, B: vehicle; v: m/s: …``. ``scenario_4@ext(…)`` names a definition of another
    set. Raises ``TextError``.
    """
    read: dict[str, Query] = specification.worked_out.setdefault((read_claim,), {})
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
    raise_all(mistakes_in(specification, claim, source, text) or [first])
    raise AssertionError("one mistake was found, and then none")


def read_tree(specification: Specification, claim: syntax.Claim, written: str) -> Query:
    """As ``read_claim``, for a claim whose tree is known; ``written`` is its text. Raises ``TextError``."""
    return replace(elaborate(specification, claim, walk_of(specification)), written=written)


def walk_of(specification: Specification) -> Elaborator:
    """A walk that remembers the definitions it has read, one for each specification."""
    walk: Elaborator | None = specification.worked_out.get((walk_of,))
    if walk is None or len(walk.sizes.known) > MOST_REMEMBERED:
        walk = specification.worked_out[(walk_of,)] = Elaborator(specification)
    return walk


def mistakes_in(
    specification: Specification,
    claim: syntax.Claim,
    source: str,
    text: str,
    lost: tuple[re.Pattern[str], ...] = (),
) -> list[TextError]:
    """All that is wrong with a claim, the first error of each place; of names that are ``lost`` nothing."""
    errors: list[TextError] = []
    walk = Elaborator(specification, errors=errors, lost=lost)
    try:
        walk.formula(claim.body, walk.given(claim))
    except TextError as error:
        errors.append(error)
    return once_each(error.locate(source, text) for error in errors)


def elaborate(specification: Specification, claim: syntax.Claim, walk: Elaborator | None = None) -> Query:
    """What a claim means in a specification. Raises ``TextError``, located where the claim has positions.

    ``walk``, through the same specification, knows what others use.
    """
    return _read(claim, Elaborator(specification) if walk is None else walk.again())


def _read(claim: syntax.Claim, elaborator: Elaborator) -> Query:
    made = elaborator.formula(claim.body, elaborator.given(claim))
    elaborator.refuse_deeper(elaborator.deepest, claim.body.at)  # whatever the walk has read before
    declared = [b.name for b in claim.given if b.sort == "vehicle"]
    free, lanes = (tuple(sorted(elaborator.free[sort])) for sort in ("vehicle", "lane"))
    vehicles = tuple(dict.fromkeys((*declared, *free)))
    return Query(claim, made, vehicles or vehicles_of(made), lanes)


def notes_of(specification: Specification, claim: syntax.Claim) -> list[Note]:
    """What every expression of a claim, and of the definitions that it uses, became. Raises ``TextError``."""
    notes: list[Note] = []
    elaborator = Elaborator(specification, notes=notes)
    elaborator.formula(claim.body, elaborator.given(claim))
    return notes


def entered_in(specification: Specification, claim: syntax.Claim) -> tuple[Query, Entered]:
    """What a claim means, and every definition, by set and name, whose body is part of that.

    Raises ``TextError``.
    """
    elaborator = walk_of(specification).again()
    query = _read(claim, elaborator)
    return query, elaborator.entered


def read_term(specification: Specification, text: str, source: str = "term") -> tuple[t.Term, Dimension]:
    """Parse and elaborate a term such as ``v_lon(SV) - v_lon(POV)``, with its dimension.

    Names are free as in ``read_claim``. Raises ``TextError``, for a formula too.
    """
    claim = parse_claim(text, source)
    elaborator = Elaborator(specification)
    try:
        made = elaborator.term(claim.body, elaborator.given(claim))
    except TextError as error:
        raise error.locate(source, text) from None
    return made.term, made.dimension or UNITS["unitless"][1]


def apply_definition(
    specification: Specification, name: str, arguments: tuple[str, ...] = (), walk: Elaborator | None = None
) -> Query:
    """The formula of a definition applied to names; to its own parameters where none are given.

    ``walk`` as for ``elaborate``.

    >>> apply_definition(bundled_library().select(), "scenario_2").vehicles
    ('POV1', 'POV2', 'SV')
    """
    roles = arguments or signature(specification, name.partition("@")[0], walk)
    return elaborate(specification, syntax.Claim((), syntax.Call(name, tuple(map(syntax.Name, roles)))), walk)


def signatures(specification: Specification, names: Iterable[str]) -> dict[str, tuple[str, ...]]:
    """As ``signature``, of many definitions; what several of them use is read once."""
    walk = Elaborator(specification)
    return {name: signature(specification, name, walk) for name in names}


def signature(specification: Specification, name: str, walk: Elaborator | None = None) -> tuple[str, ...]:
    """Names of the arguments of a definition, a group of vehicles written out as POV or POV1, POV2.

    The size of a group is the smallest that the definitions below accept. ``walk`` knows what others use.
    """
    return _applied_to_own(specification, name, walk)[0]


def entered_below(specification: Specification, name: str) -> Entered:
    """The definition of a name and every one that it is made of, by set and name. Raises ``TextError``."""
    entered = _applied_to_own(specification, name, walk_of(specification))[1].entered
    return {(specification.set_name, name): specification.definitions[name]} | entered


def _applied_to_own(
    specification: Specification, name: str, walk: Elaborator | None
) -> tuple[tuple[str, ...], Elaborator]:
    """The names of the arguments of a definition, and the walk through its body with them."""
    if name not in specification.definitions:
        raise TextError(unknown("definition", name, specification.definitions))
    parameters = specification.definitions[name].parameters
    failure: TextError | None = None
    for size in (1, 2, 3):
        roles: list[str] = []
        scope: dict[str, Value] = {}
        for binding in parameters:
            if binding.sort != "vehicles":
                roles.append(binding.name)
                scope[binding.name] = scopes.value_of(binding)
                continue
            names = (binding.name,) if size == 1 else tuple(f"{binding.name}{k + 1}" for k in range(size))
            roles += names
            scope[binding.name] = Vehicles(names)
        try:
            elaborator = Elaborator(specification) if walk is None else walk.again()
            elaborator.body_of(name, scope)
            return tuple(roles), elaborator
        except TextError as error:
            failure = failure or error
    assert failure is not None
    raise failure
