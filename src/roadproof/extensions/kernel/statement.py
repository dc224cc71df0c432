"""What a certificate claims, as Coq is to prove it, and the goal for a search of its tableau.

The claim is read again with the library at hand. Limits that it is proved under become its premises. The
tableau also supposes facts about motion and inductions, each made anew; proofs/kernel/Schemas.v proves them.
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
from roadproof.library.elaborate import read_claim
from roadproof.library.motion import (
    Axiom,
    assumption,
    axiom_arguments,
    axiom_formula,
    limit_formulas,
    value_texts,
    values_said,
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
    """An instance of a schema: its name in Coq, and its ``arguments``, values of parameters put in."""

    schema: str
    arguments: tuple[Formula | Term, ...]
    is_induction: bool


@dataclass(frozen=True)
class Statement:
    """``formula`` is what Coq is to prove for all parameters within ``bounds`` (name: strictly above 0).

    ``supposed``: what the tableau proves, with ``instances`` of schemas as further premises. ``lemmas``:
    facts about one instant, with the moments at which the proof uses them. ``limits``: how many limits of
    vehicles are premises. ``values`` of parameters, as words, are put in; those that are ``demanded`` by the
    formula itself Coq puts in before it reads the tableau.
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
    """What is to be proved, values of parameters that are assumed put in.

    ``query``: the claim, where it need not be read again, since nobody rests on the statement.
    Raises ``InputError`` where the certificate does not fit the library.
    """
    specification = library.select(certificate.set_name, certificate.options)
    query = query or read_claim(specification, certificate.claim)
    assumed = certificate.assumed
    here = values_said(specification, assumed.said)
    limits, axioms = _premises(certificate, specification, query)
    formula, supposed = (
        with_values(f.implication(f.conjunction(*premises), query.formula), here)
        for premises in (limits, [*limits, *axioms])
    )
    demanded = values_said(specification, certificate.pinned)
    atoms, proved = Atoms(reading=certificate.reading), with_values(supposed, demanded)
    atoms.abstract(with_values(query.formula, {**here, **demanded}))  # named first, as in the certificate
    abstracted = atoms.abstract(proved)
    if any(name not in atoms.named for lemma in certificate.lemmas for name, _ in lemma.literals):
        # an atom inside a quantifier has its name once there is an instance
        sites = certificate.instances, certificate.names
        met_sites(abstracted, atoms, *sites, library.bounds, query.lanes)
    bounds = bounds_of(specification, parameters_of(supposed))
    parameters = tuple(sorted(bound_parameters(proved)))
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
        tuple(_instance(specification, query, x, here) for x in assumed.axioms),
        bounds,
        lemmas,
        parameters,
        formals_of(specification),
        len(limits),
        value_texts(specification, here),
        demanded,
        goal,
    )


def bounds_of(specification: Specification, names: Iterable[str]) -> dict[str, bool]:
    """Of the parameters that are bounded, whether they are strictly above 0."""
    declared = specification.library.bounds
    return {name: declared[name] == ">" for name in names if declared.get(name)}


def formals_of(specification: Specification) -> Formals:
    """What each definition calls its arguments."""
    return {
        name: tuple((x.name, str(x.sort)) for x in definition.parameters)
        for name, definition in specification.definitions.items()
    }


def _premises(
    certificate: Certificate, specification: Specification, query: Query
) -> tuple[list[Formula], list[Formula]]:
    """The limits that are premises, and the instances of schemas, each with a name of its own."""
    assumed = certificate.assumed
    assumption(specification, query, assumed)  # nothing else may be assumed
    limits = limit_formulas(specification, query, assumed).values()
    words = ["induction" if x.is_induction else "motion" for x in assumed.axioms]
    axioms = (axiom_formula(specification, query, x) for x in assumed.axioms)
    named = [*(("limit", x) for x in limits), *zip(words, axioms, strict=True)]
    made: list[Formula] = [
        f.Application(f"{word}_{number}", (), x) for number, (word, x) in enumerate(named, 1)
    ]
    return made[: len(limits)], made[len(limits) :]


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
