"""What a certificate claims, as Coq is to prove it, and the goal for a search of its tableau.

The claim is read again with the library at hand. What is assumed of motion becomes a premise of what is
proved: each fact by itself, made anew of its schema, so that a reader of the printed claim sees it.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from fractions import Fraction

from roadproof.errors import InputError
from roadproof.evidence.atoms import Atoms
from roadproof.evidence.certificate import Certificate
from roadproof.evidence.kernel.branch import Goal
from roadproof.evidence.kernel.printer import Formals
from roadproof.evidence.times import bound_parameters
from roadproof.library.elaborate import read_claim
from roadproof.library.motion import NOTHING, assumption, axiom_formula, value_texts, values_said
from roadproof.library.specification import Library, Query, Specification
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import parameters_of, with_values


@dataclass(frozen=True)
class Premises:
    """How many ``limits`` of vehicles, ``facts`` about motion and ``inductions`` a claim is proved under.

    >>> str(Premises(1, 2))
    '1 limit and 2 facts about motion'
    """

    limits: int = 0
    facts: int = 0
    inductions: int = 0

    @property
    def count(self) -> int:
        return self.limits + self.facts + self.inductions

    def __str__(self) -> str:
        counted = (
            (self.limits, "limit", ""),
            (self.facts, "fact", " about motion"),
            (self.inductions, "induction", " over time"),
        )
        return " and ".join(f"{n} {word}{'s' * (n != 1)}{of}" for n, word, of in counted if n)


NO_PREMISES = Premises()


@dataclass(frozen=True)
class Statement:
    """``formula`` is what Coq is to prove for all parameters within ``bounds`` (name: strictly above 0).

    ``lemmas``: facts about one instant, with the moments at which the proof uses them. ``premises``: how
    many limits and facts about motion are premises, which are not proved. ``values`` of parameters, as words,
    are put in; those that are ``demanded`` by the formula itself Coq puts in before it reads the tableau.
    """

    label: str
    claim: str
    set_name: str
    options: Mapping[str, str]
    formula: Formula
    bounds: Mapping[str, bool]
    lemmas: tuple[tuple[Formula, tuple[str, ...]], ...]
    parameters: tuple[str, ...]
    formals: Formals
    premises: Premises
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
    premises = _premises(certificate, library, query)
    here = values_said(specification, certificate.assumed.said)
    formula = with_values(f.implication(f.conjunction(*premises), query.formula), here)
    demanded = values_said(specification, certificate.pinned)
    atoms, proved = Atoms(), with_values(formula, demanded)
    abstracted = atoms.abstract(proved)
    bounds = bounds_of(specification, parameters_of(formula))
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
        bounds,
        lemmas,
        parameters,
        formals_of(specification),
        Premises(*map(len, (assumed.limits, assumed.facts, assumed.inductions))),
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


def _premises(certificate: Certificate, library: Library, query: Query) -> list[Formula]:
    """The facts about motion and the limits of vehicles that are assumed, each with a name of its own."""
    if certificate.assumed == NOTHING:
        return []
    specification = library.select(certificate.set_name, certificate.options)
    whole = assumption(specification, query, certificate.assumed)
    axioms = [axiom_formula(specification, query, x) for x in certificate.assumed.axioms]
    parts = list(whole.parts) if isinstance(whole, f.And) else [whole]
    if whole == f.TRUE:
        return []
    limits = parts[: len(parts) - len(axioms)]
    if parts[len(limits) :] != axioms or f.conjunction(*limits, *axioms) != whole:
        raise InputError("what is assumed of motion cannot be told apart into facts")
    words = ["induction" if x.is_induction else "motion" for x in certificate.assumed.axioms]
    named = [("limit", x) for x in limits] + [*zip(words, axioms, strict=True)]
    return [f.Application(f"{word}_{number}", (), x) for number, (word, x) in enumerate(named, 1)]


def _literal(atoms: Atoms, name: str, positive: bool) -> Formula:
    atom = f.Application(name, (), atoms.meaning(name))
    return atom if positive else f.Not(atom)
