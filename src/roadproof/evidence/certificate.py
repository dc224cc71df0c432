"""Certificates of claims proved for all time: files that a second program can check.

A certificate names the claim, the set, the options and assumptions, the instances and lemmas, and
holds the ground queries as SMT-LIB. Checking reads the claim again with the library at hand, makes anew
what it assumes of motion, derives every query from the instances, compares it with the file, and asks a
solver that is passed in.
"""

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from roadproof.errors import InputError, RoadproofError
from roadproof.evidence.answers import certificate as kept
from roadproof.evidence.atoms import Atoms, Reading
from roadproof.evidence.codec import read, write
from roadproof.evidence.derivation import derive_lemma_queries, derive_query
from roadproof.evidence.finding import Acceptance
from roadproof.evidence.sites import Lemma, Site
from roadproof.evidence.strict import Fields, JsonObject, read_json
from roadproof.library import motion
from roadproof.library.elaborate import read_claim
from roadproof.library.specification import Library, Query, Specification, unknown
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.logic.initial_conditions import pins
from roadproof.logic.rewrite import parameters_of, with_values
from roadproof.reasons import NO_REASON, Reason, Why

SCHEMA = kept.SCHEMA


@dataclass(frozen=True)
class Certificate:
    """A proof as data; ``queries`` are (title, SMT-LIB script), each to be answered unsat.

    ``pinned``: values of parameters that the claim's own premise demands, as words (``minDanger = 0.6 s``);
    they are put in before anything is asked (``logic.pins``).
    ``reading``: which parts of the claim are predicates (``atoms.Atoms``).
    ``tableau``: the same proof for Coq (``kernel.tableau``), as lines; None where there is none. Certificates
    that differ in it alone are equal: it can be found again. ``query``: the claim as it was proved, for the
    search of a tableau, on which nobody rests; None where a file was read, which has the text alone.
    """

    property: str
    scenario: int | None
    claim: str
    set_name: str
    options: Mapping[str, str]
    assumptions: tuple[str, ...]
    instances: Mapping[Site, tuple[str, ...]]
    names: Mapping[Site, str]
    lemmas: tuple[Lemma, ...]
    queries: tuple[tuple[str, str], ...]
    assumed: motion.Assumption = motion.NOTHING
    pinned: tuple[str, ...] = ()
    reading: Reading = "states"
    tableau: tuple[str, ...] | None = field(default=None, compare=False)
    query: Query | None = field(default=None, compare=False, repr=False)


def certify(
    specification: Specification,
    query: Query,
    sites: tuple[Mapping[Site, tuple[str, ...]], Mapping[Site, str]],
    lemmas: tuple[Lemma, ...],
    label: str = "",
    scenario: int | None = None,
    assumed: motion.Assumption = motion.NOTHING,
    read_with: tuple[tuple[str, ...], Reading] = ((), "states"),
) -> Certificate:
    """The certificate for a claim, its queries derived here and not by the finder of the proof.

    ``sites``: the instances and the names of sites; ``read_with``: what is pinned, and the reading. Raises
    ``InputError`` where the text of a query that was put together reads as another formula, and where the
    claim does not pin what is said to be pinned.
    """
    if not query.written and read_claim(specification, query.text).formula != query.formula:
        raise InputError(f"the claim's text does not mean what was proved: {query.text}")
    pinned, reading = read_with
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
    assumed: motion.Assumption,
    atoms: Atoms,
    pinned: Sequence[str],
) -> tuple[Formula, Formula]:
    """What is proved, abstracted: what is assumed, made anew from words, and the claim that it implies.

    Values of parameters that are assumed, and those that are ``pinned``, are put in. Raises ``InputError``
    for what nobody may assume, and for values that the claim does not pin.
    """
    here = motion.values_said(specification, assumed.said)
    premised = pins(with_values(query.formula, here))
    demanded = motion.values_said(specification, pinned)
    for name, value in demanded.items():
        if premised.get(name) != value:
            raise InputError(f"{name}={value}: no premise of the claim demands that value")
    if tuple(pinned) != motion.value_texts(specification, demanded):
        raise InputError(f"what is pinned is written otherwise than it is read: {', '.join(pinned)[:200]}")
    values = {**here, **demanded}
    claim = atoms.abstract(with_values(query.formula, values))
    premise = with_values(motion.assumption(specification, query, assumed), values)
    return atoms.abstract(premise), claim


def refusal(certificate: Certificate, library: Library, ask: Callable[[str], str]) -> Reason | None:
    """Why the certificate is not accepted, or None where it is.

    ``ask`` answers sat, unsat or unknown to an SMT-LIB script.
    """
    outcome, reason = rule(certificate, library, ask)
    return None if outcome is Acceptance.ACCEPTED else reason


def rule(certificate: Certificate, library: Library, ask: Callable[[str], str]) -> tuple[Acceptance, Reason]:
    """Whether the certificate proves its claim, and why where it does not.

    Unreadable where the library does not have what the claim speaks of; undecided where ``ask`` answers
    unknown.
    """
    fault = fault_of_queries(certificate, library)
    if fault is not None:
        return fault
    for title, script in certificate.queries:
        answer = ask(script)
        if answer == "unknown":
            return Acceptance.UNDECIDED, Why.NOT_UNSAT(title, answer)
        if answer != "unsat":
            return Acceptance.REJECTED, Why.NOT_UNSAT(title, answer)
    return Acceptance.ACCEPTED, NO_REASON


def fault_of_queries(
    certificate: Certificate, library: Library, query: Query | None = None
) -> tuple[Acceptance, Reason] | None:
    """Return why the stored queries do not follow from the claim and the instances; None where they do.

    ``query``: the claim as it was read, where it was.
    """
    try:
        specification = library.select(certificate.set_name, certificate.options)
        query = query or read_claim(specification, certificate.claim)
    except RoadproofError as error:
        return Acceptance.UNREADABLE, Why.TOLD(error)
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
        return Acceptance.REJECTED, Why.NOT_DERIVED(error)
    difference = _difference(derived, certificate)
    return (Acceptance.REJECTED, difference) if difference else None


def unreadable(certificate: Certificate, library: Library) -> Reason:
    """Why the claim cannot be read with this library, or nothing where it can."""
    try:
        read_claim(library.select(certificate.set_name, certificate.options), certificate.claim)
    except RoadproofError as error:
        return Why.TOLD(error)
    return NO_REASON


def _difference(derived: Certificate, stored: Certificate) -> Reason:
    """What the file says otherwise than claim and instances give, or nothing."""
    if derived.assumptions != stored.assumptions:
        return Why.ASSUMPTIONS(", ".join(derived.assumptions), ", ".join(stored.assumptions))
    if derived.options != stored.options:
        return Why.OPTIONS(_listed(derived.options), _listed(stored.options))
    if derived.queries != stored.queries:
        return Why.STORED_QUERY()
    return NO_REASON


def _listed(options: Mapping[str, str]) -> str:
    return ", ".join(f"{name}={value}" for name, value in sorted(options.items())) or "none"


# --- files --------------------------------------------------------------------------------------


def to_json(certificate: Certificate) -> str:
    """The certificate as a file's text."""
    return json.dumps(certificate_data(certificate), indent=1) + "\n"


def certificate_data(certificate: Certificate) -> JsonObject:
    """The certificate as plain data; sites share a table of formulas."""
    sites = [*certificate.names, *certificate.instances]
    table = list(dict.fromkeys(site.formula for site in sites))
    place = {text: number for number, text in enumerate(table)}

    def said(site: Site) -> tuple[int, kept.Sign, str] | tuple[int, kept.Sign, str, str]:
        sign: kept.Sign = "+" if site.positive else "-"
        where = place[site.formula], sign, site.moment
        return (*where, site.instance) if site.instance else where

    tableau, assumed = certificate.tableau, certificate.assumed
    is_assumed = assumed.said or assumed.axioms
    return write(
        kept.Certificate(
            property=certificate.property,
            scenario=certificate.scenario,
            claim=certificate.claim,
            assuming=assumed.said,
            axioms=tuple(kept.Axiom(schema=x.schema, arguments=x.named()) for x in assumed.axioms)
            if is_assumed
            else None,
            unused=assumed.unused if is_assumed else (),
            pinned=certificate.pinned,
            reading=None if certificate.reading == "states" else certificate.reading,
            set=certificate.set_name,
            options=certificate.options,
            view="dense",
            assumptions=certificate.assumptions,
            formulas=tuple(table),
            times=tuple((name, *said(site)) for site, name in certificate.names.items()),
            instances=tuple((*said(site), terms) for site, terms in certificate.instances.items()),
            lemmas=tuple(kept.Lemma(clause=x.literals, at=x.moments) for x in certificate.lemmas),
            queries=tuple(
                kept.Query(title=title, smtlib=tuple(query.splitlines()))
                for title, query in certificate.queries
            ),
            tableau=tableau,
        )
    )


def read_certificate(path: Path) -> Certificate:
    """A certificate from a file. Raises ``InputError`` where it is none."""
    return read_certificate_data(read_json(path), str(path))


def read_certificate_data(content: object, where: str) -> Certificate:
    """The inverse of ``certificate_data``. Raises ``InputError``."""
    if Fields(content, where).text("schema") != SCHEMA:
        raise InputError(f"{where} is no certificate: its schema must be {SCHEMA}")
    said = read(kept.Certificate, content, where)
    names = [(_site(row[1:], said.formulas, where), row[0]) for row in said.times]
    instances = [(_site(row[:-1], said.formulas, where), row[-1]) for row in said.instances]
    for what, sites in (("times", names), ("instances", instances)):
        if len({site for site, _ in sites}) < len(sites):
            raise InputError(f"{where}, {what}: one quantifier is listed twice")
    return Certificate(
        said.property,
        said.scenario,
        said.claim,
        said.set,
        said.options,
        said.assumptions,
        dict(instances),
        dict(names),
        tuple(Lemma(x.clause, x.at) for x in said.lemmas),
        tuple((x.title, "\n".join(x.smtlib) + "\n") for x in said.queries),
        _assumed(said, where),
        said.pinned,
        said.reading or "states",
        said.tableau,
    )


def _assumed(said: kept.Certificate, where: str) -> motion.Assumption:
    """What is assumed, the facts about motion that are premises, and the limits that are none."""
    if said.axioms is None:
        if said.assuming or said.unused:
            raise InputError(f"{where}: 'axioms' is missing")
        return motion.NOTHING
    if not said.assuming and not said.axioms:
        raise InputError(f"{where}: 'axioms' is empty, and nothing is assumed: leave it out")
    return motion.Assumption(
        said.assuming, tuple(_axiom(x, f"{where}, axioms") for x in said.axioms), said.unused
    )


def _axiom(said: kept.Axiom, where: str) -> motion.Axiom:
    schema = said.schema
    if schema not in motion.ALL_SCHEMAS:
        raise InputError(f"{where}: {unknown('schema of motion', schema[:40], motion.ALL_SCHEMAS)}")
    if tuple(said.arguments) != motion.ALL_SCHEMAS[schema]:
        raise InputError(
            f"{where}: schema {schema} takes {', '.join(motion.ALL_SCHEMAS[schema])}, in this order"
        )
    return motion.Axiom(schema, tuple(said.arguments.values()))


def _site(row: tuple[int, str, str] | tuple[int, str, str, str], table: Sequence[str], where: str) -> Site:
    """``row``: place in the table, sign, moment, and instance where it is inside one."""
    number, sign, *moments = row
    if number >= len(table):
        raise InputError(f"{where}: there is no formula number {number}")
    return Site(table[number], sign == "+", *moments)
