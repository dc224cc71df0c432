"""Derives the queries of a certificate from its claim and instances, and compares them with its file."""

from collections.abc import Callable, Mapping, Sequence

from roadproof.errors import InputError, RoadproofError
from roadproof.evidence.atoms import Atoms, Reading
from roadproof.evidence.certificate import Certificate
from roadproof.evidence.derivation import derive_lemma_queries, derive_query
from roadproof.evidence.finding import Acceptance
from roadproof.evidence.sites import Site, StateLemma
from roadproof.library import motion
from roadproof.library.assumption import NOTHING, Assumption
from roadproof.library.elaborate import read_claim
from roadproof.library.specification import Library, Query, Specification
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.logic.initial_conditions import forced_values
from roadproof.logic.rewrite import parameters_of, with_values
from roadproof.reasons import NO_REASON, Reason, ReasonKind


def certify(
    specification: Specification,
    query: Query,
    sites: tuple[Mapping[Site, tuple[str, ...]], Mapping[Site, str]],
    lemmas: tuple[StateLemma, ...],
    label: str = "",
    scenario: int | None = None,
    assumed: Assumption = NOTHING,
    pinned_and_reading: tuple[tuple[str, ...], Reading] = ((), "states"),
) -> Certificate:
    """Return the certificate of a claim; its queries are derived here, independently of the prover.

    Args:
        sites: the instances of each quantifier, and the names of the quantified times and lanes.
        label: the template property of the claim, if any.
        pinned_and_reading: the pinned parameter values, and the reading of predicates.

    Raises:
        InputError: the claim's text reads as another formula, or the claim does not demand a pinned value.
    """
    if not query.written and read_claim(specification, query.text).formula != query.formula:
        raise InputError(f"the claim's text does not mean what was proved: {query.text}")
    pinned, reading = pinned_and_reading
    atoms, (instances, names) = Atoms(reading=reading), sites
    abstracted = f.implication(*goal_of(specification, query, assumed, atoms, pinned))
    bounds = specification.library.bounds
    ground = derive_query(abstracted, atoms, instances, names, lemmas, bounds, query.lanes)
    queries = [("claim", ground)]
    for number, lemma in enumerate(lemmas, 1):
        cases = derive_lemma_queries(atoms, lemma.literals, bounds)
        queries += [(f"lemma {number}, case {k} of {len(cases)}", q) for k, q in enumerate(cases, 1)]
    assumptions = tuple(f"{n} {bounds[n]} 0" for n in parameters_of(abstracted) if bounds.get(n))
    return Certificate(
        label,
        scenario,
        query.text,
        specification.set_name,
        dict(specification.options),
        assumptions,
        dict(instances),
        dict(names),
        lemmas,
        tuple(queries),
        assumed,
        pinned,
        reading,
        query=query,
    )


def goal_of(
    specification: Specification,
    query: Query,
    assumed: Assumption,
    atoms: Atoms,
    pinned: Sequence[str],
) -> tuple[Formula, Formula]:
    """Return the premise, rebuilt from the assumptions, and the claim that it implies, both abstracted.

    Parameter values that are assumed or ``pinned`` are substituted. Raises ``InputError`` for assumptions
    that are not allowed, and for values that the claim does not demand.
    """
    assumed_values = motion.values_in(specification, assumed.texts)
    forced = forced_values(with_values(query.formula, assumed_values))
    pinned_values = motion.values_in(specification, pinned)
    for name, value in pinned_values.items():
        if forced.get(name) != value:
            raise InputError(f"{name}={value}: no premise of the claim demands that value")
    if tuple(pinned) != motion.value_texts(specification, pinned_values):
        raise InputError(f"what is pinned is written otherwise than it is read: {', '.join(pinned)[:200]}")
    values = {**assumed_values, **pinned_values}
    claim = atoms.abstract(with_values(query.formula, values))
    premise = with_values(motion.assumption(specification, query, assumed), values)
    return atoms.abstract(premise), claim


def check_certificate(
    certificate: Certificate, library: Library, ask: Callable[[str], str]
) -> tuple[Acceptance, Reason]:
    """Return whether the certificate proves its claim, and the reason if not.

    UNREADABLE: the library lacks a definition of the claim. UNDECIDED: ``ask`` answered unknown.
    """
    fault = fault_of_queries(certificate, library)
    if fault is not None:
        return fault
    for title, script in certificate.queries:
        answer = ask(script)
        if answer == "unknown":
            return Acceptance.UNDECIDED, ReasonKind.NOT_UNSAT(title, answer)
        if answer != "unsat":
            return Acceptance.REJECTED, ReasonKind.NOT_UNSAT(title, answer)
    return Acceptance.ACCEPTED, NO_REASON


def fault_of_queries(
    certificate: Certificate, library: Library, query: Query | None = None
) -> tuple[Acceptance, Reason] | None:
    """Return why the stored queries do not follow from the claim and the instances; None if they do.

    ``query``: the claim of the certificate, if it is already parsed.
    """
    try:
        specification = library.select(certificate.set_name, certificate.options)
        query = query or read_claim(specification, certificate.claim)
    except RoadproofError as error:
        return Acceptance.UNREADABLE, ReasonKind.TOLD(error)
    try:
        derived = certify(
            specification,
            query,
            (certificate.instances, certificate.names),
            certificate.lemmas,
            certificate.property,
            certificate.scenario,
            certificate.assumed,
            (certificate.pinned, certificate.reading),
        )
    except RoadproofError as error:
        return Acceptance.REJECTED, ReasonKind.NOT_DERIVED(error)
    difference = _difference(derived, certificate)
    return (Acceptance.REJECTED, difference) if difference else None


def unreadable_reason(certificate: Certificate, library: Library) -> Reason:
    """Return why this library cannot read the claim; empty if it can."""
    try:
        read_claim(library.select(certificate.set_name, certificate.options), certificate.claim)
    except RoadproofError as error:
        return ReasonKind.TOLD(error)
    return NO_REASON


def _difference(derived: Certificate, stored: Certificate) -> Reason:
    """Return the first difference between the derived and the stored certificate; empty if they agree."""
    if derived.assumptions != stored.assumptions:
        return ReasonKind.ASSUMPTIONS(", ".join(derived.assumptions), ", ".join(stored.assumptions))
    if derived.options != stored.options:
        return ReasonKind.OPTIONS(_options_text(derived.options), _options_text(stored.options))
    if derived.queries != stored.queries:
        return ReasonKind.STORED_QUERY()
    return NO_REASON


def _options_text(options: Mapping[str, str]) -> str:
    return ", ".join(f"{name}={value}" for name, value in sorted(options.items())) or "none"
