"""The theorem of a certificate, as Coq must prove it, and the goal for the search of its tableau.

The claim is read again with the library at hand. Assumed limits become premises. The tableau also uses facts
about motion and inductions, each rebuilt here; proofs/kernel/Schemas.v proves them.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from fractions import Fraction

from roadproof.evidence.atoms import Atoms
from roadproof.evidence.certificate import Certificate
from roadproof.evidence.derivation import met_sites
from roadproof.evidence.times import bound_parameters
from roadproof.extensions.kernel.branch import Goal
from roadproof.extensions.kernel.printer import Formals
from roadproof.library.assumption import Axiom
from roadproof.library.elaborate import read_claim
from roadproof.library.motion import (
    assumption,
    axiom_arguments,
    axiom_formula,
    limit_formulas,
    value_texts,
    values_in,
)
from roadproof.library.specification import Library, Query, Specification
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import parameters_of, term_with_values, with_values
from roadproof.logic.terms import Term

SCHEMAS: Mapping[str, str] = {
    "at-most": "At_most",
    "below": "Below",
    "meets": "Meets",
    "leaves": "Leaves",
    "within": "Within",
    "after": "After",
    "within-twice": "Within_twice",
    "after-twice": "After_twice",
    "steps": "Repeats",
    "lasts": "Lasts",
}
"""What proofs/kernel/Schemas.v calls the schemas of ``library.motion``."""


@dataclass(frozen=True)
class Instance:
    """An instance of a schema: its name in Coq, and its ``arguments`` with parameter values substituted."""

    schema: str
    arguments: tuple[Formula | Term, ...]
    is_induction: bool


@dataclass(frozen=True)
class Statement:
    """The theorem that ``formula`` holds for all parameters within ``bounds`` (name: strictly above 0).

    ``supposed``: the formula that the tableau proves, with ``instances`` of schemas as further premises.
    ``lemmas``: facts about one instant, with the moments of their use. ``limits``: the number of limits of
    vehicles among the premises. ``values``: assumed parameter values, as text. ``demanded``: values that the
    formula itself demands; Coq substitutes them before it reads the tableau.
    """

    label: str
    claim: str
    set_name: str
    options: Mapping[str, str]
    formula: Formula
    supposed: Formula
    instances: tuple[Instance, ...]
    bounds: Mapping[str, bool]
    lemmas: tuple[tuple[Formula, tuple[str, ...]], ...]
    parameters: tuple[str, ...]
    formals: Formals
    limits: int
    values: tuple[str, ...]
    demanded: Mapping[str, Fraction]
    goal: Goal


def state(certificate: Certificate, library: Library, query: Query | None = None) -> Statement:
    """Return the theorem of a certificate, with assumed parameter values substituted.

    ``query``: the parsed claim, for callers that do not rely on the statement. Raises ``InputError`` if the
    certificate does not fit the library.
    """
    specification = library.select(certificate.set_name, certificate.options)
    query = query or read_claim(specification, certificate.claim)
    assumed = certificate.assumed
    assumed_values = values_in(specification, assumed.texts)
    limits, axioms = _premises(certificate, specification, query)
    formula, supposed = (
        with_values(f.implication(f.conjunction(*premises), query.formula), assumed_values)
        for premises in (limits, [*limits, *axioms])
    )
    pinned_values = values_in(specification, certificate.pinned)
    atoms, goal_formula = Atoms(reading=certificate.reading), with_values(supposed, pinned_values)
    atoms.abstract(
        with_values(query.formula, {**assumed_values, **pinned_values})
    )  # named first, as in the certificate
    abstracted = atoms.abstract(goal_formula)
    if any(name not in atoms.named for lemma in certificate.lemmas for name, _ in lemma.literals):
        # an atom inside a quantifier has its name once there is an instance
        sites = certificate.instances, certificate.names
        met_sites(abstracted, atoms, *sites, library.bounds, query.lanes)
    bounds = bounds_of(specification, parameters_of(supposed))
    parameters = tuple(sorted(bound_parameters(goal_formula)))
    lemmas = tuple(
        (f.disjunction(*(_literal(atoms, *x) for x in lemma.literals)), lemma.moments)
        for lemma in certificate.lemmas
    )
    goal = Goal(
        abstracted,
        atoms,
        bounds,
        parameters,
        query.lanes,
        certificate.instances,
        certificate.names,
        lemmas,
    )
    return Statement(
        certificate.property,
        certificate.claim,
        certificate.set_name,
        dict(certificate.options),
        formula,
        supposed,
        tuple(_instance(specification, query, x, assumed_values) for x in assumed.axioms),
        bounds,
        lemmas,
        parameters,
        formals_of(specification),
        len(limits),
        value_texts(specification, assumed_values),
        pinned_values,
        goal,
    )


def bounds_of(specification: Specification, names: Iterable[str]) -> dict[str, bool]:
    """Return for each bounded parameter whether it is strictly above 0."""
    declared = specification.library.bounds
    return {name: declared[name] == ">" for name in names if declared.get(name)}


def formals_of(specification: Specification) -> Formals:
    """Return the names and sorts of each definition's arguments."""
    return {
        name: tuple((x.name, str(x.sort)) for x in definition.parameters)
        for name, definition in specification.definitions.items()
    }


def _premises(
    certificate: Certificate, specification: Specification, query: Query
) -> tuple[list[Formula], list[Formula]]:
    """Return the limits that are premises, and the instances of schemas, each under a name of its own."""
    assumed = certificate.assumed
    assumption(specification, query, assumed)  # nothing else may be assumed
    limits = limit_formulas(specification, query, assumed).values()
    kinds = ["induction" if x.is_induction else "motion" for x in assumed.axioms]
    axioms = (axiom_formula(specification, query, x) for x in assumed.axioms)
    named = [*(("limit", x) for x in limits), *zip(kinds, axioms, strict=True)]
    premises: list[Formula] = [
        f.Application(f"{word}_{number}", (), x) for number, (word, x) in enumerate(named, 1)
    ]
    return premises[: len(limits)], premises[len(limits) :]


def _instance(
    specification: Specification, query: Query, axiom: Axiom, values: Mapping[str, Fraction]
) -> Instance:
    arguments = tuple(
        x if not values else term_with_values(x, values) if isinstance(x, Term) else with_values(x, values)
        for x in axiom_arguments(specification, query, axiom)
    )
    return Instance(SCHEMAS[axiom.schema], arguments, axiom.is_induction)


def _literal(atoms: Atoms, name: str, positive: bool) -> Formula:
    atom = f.Application(name, (), atoms.meaning(name))
    return atom if positive else f.Not(atom)
