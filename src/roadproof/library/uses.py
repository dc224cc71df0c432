"""The definitions and parameters that a claim uses, and the places of its sub-formulas in texts."""

from collections.abc import Mapping
from dataclasses import replace

from roadproof.library.elaborate import elaborate_with_definitions
from roadproof.library.specification import Query, Specification
from roadproof.logic import syntax
from roadproof.logic.rewrite import parameters_of
from roadproof.logic.syntax import Definition, ParameterDeclaration
from roadproof.runtime.records import dataclass


@dataclass(frozen=True)
class PartsOfClaim:
    """A claim with the definitions, in reading order, and the parameters that it uses.

    ``named``: each definition as it is written, by name. A definition of another set that differs from ours
    is named ``name@set``.
    """

    query: Query
    named: Mapping[str, Definition]
    parameters: tuple[ParameterDeclaration, ...]

    @property
    def definitions(self) -> tuple[Definition, ...]:
        """The definitions, renamed to their names in ``named``."""
        return tuple(replace(x, name=name) for name, x in self.named.items())


def parts_of_claim(specification: Specification, claim: syntax.Claim) -> PartsOfClaim:
    """Return a claim with everything that it uses. Raises ``TextError``."""
    query, used_definitions = elaborate_with_definitions(specification, claim)
    named: dict[str, Definition] = {}
    for (set_name, name), definition in used_definitions.items():
        is_ours = definition is specification.definitions.get(name)
        named.setdefault(name if is_ours else f"{name}@{set_name}", definition)
    occurring = {*parameters_of(query.formula)}
    parameters = (x for name, x in specification.library.parameters.items() if name in occurring)
    return PartsOfClaim(query, named, tuple(parameters))
