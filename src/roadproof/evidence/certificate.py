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
from typing import Any

from roadproof.errors import InputError, RoadproofError
from roadproof.evidence.atoms import Atoms
from roadproof.evidence.derivation import Lemma, Site, derive_lemma_queries, derive_query
from roadproof.evidence.finding import Acceptance
from roadproof.evidence.strict import Fields, read_assuming, read_json, text
from roadproof.library.elaborate import read_claim
from roadproof.library.motion import (
    ALL_SCHEMAS,
    NOTHING,
    Assumption,
    Axiom,
    assumption,
    value_texts,
    values_said,
)
from roadproof.library.query import Query
from roadproof.library.specification import Library, Specification, unknown
from roadproof.logic import formula as f
from roadproof.logic.fixed_parameters import pins
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import parameters_of, with_values

SCHEMA = "roadproof/certificate/2"
WITHOUT_TABLEAU = "roadproof/certificate/1"  # as files were written before, which are read too
SCHEMAS_READ = (SCHEMA, WITHOUT_TABLEAU)
VIEW = "dense"


@dataclass(frozen=True)
class Certificate:
    """A proof as data; ``queries`` are (title, SMT-LIB script), each to be answered unsat.

    ``pinned``: values of parameters that the claim's own premise demands, as words (``minDanger = 0.6 s``);
    they are put in before anything is asked (``logic.pins``).
    ``tableau``: the same proof for Coq (``kernel.tableau``), as lines; None where there is none. Certificates
    that differ in it alone are equal: it can be found again.
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
    assumed: Assumption = NOTHING
    pinned: tuple[str, ...] = ()
    tableau: tuple[str, ...] | None = field(default=None, compare=False)


def certify(
    specification: Specification,
    query: Query,
    instances: Mapping[Site, tuple[str, ...]],
    names: Mapping[Site, str],
    lemmas: tuple[Lemma, ...],
    label: str = "",
    scenario: int | None = None,
    assumed: Assumption = NOTHING,
    pinned: tuple[str, ...] = (),
) -> Certificate:
    """The certificate for a claim, its queries derived here and not by the finder of the proof.

    Raises ``InputError`` where the text of a query that was put together reads as another formula, and where
    the claim does not pin what is ``pinned``.
    """
    if not query.written and read_claim(specification, query.text).formula != query.formula:
        raise InputError(f"the claim's text does not mean what was proved: {query.text}")
    atoms = Atoms()
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
    )


def goal_of(
    specification: Specification,
    query: Query,
    assumed: Assumption,
    atoms: Atoms,
    pinned: Sequence[str],
) -> tuple[Formula, Formula]:
    """What is proved, abstracted: what is assumed, made anew from words, and the claim that it implies.

    Values of parameters that are assumed, and those that are ``pinned``, are put in. Raises ``InputError``
    for what nobody may assume, and for values that the claim does not pin.
    """
    here = values_said(specification, assumed.said)
    premised = pins(with_values(query.formula, here))
    demanded = values_said(specification, pinned)
    for name, value in demanded.items():
        if premised.get(name) != value:
            raise InputError(f"{name}={value}: no premise of the claim demands that value")
    if tuple(pinned) != value_texts(specification, demanded):
        raise InputError(f"what is pinned is written otherwise than it is read: {', '.join(pinned)[:200]}")
    values = {**here, **demanded}
    claim = atoms.abstract(with_values(query.formula, values))
    premise = with_values(assumption(specification, query, assumed), values)
    return atoms.abstract(premise), claim


def refusal(certificate: Certificate, library: Library, ask: Callable[[str], str]) -> str | None:
    """Why the certificate is not accepted, or None where it is.

    ``ask`` answers sat, unsat or unknown to an SMT-LIB script.
    """
    outcome, reason = rule(certificate, library, ask)
    return None if outcome is Acceptance.ACCEPTED else reason


def rule(certificate: Certificate, library: Library, ask: Callable[[str], str]) -> tuple[Acceptance, str]:
    """Whether the certificate proves its claim, and why where it does not.

    Unreadable where the library does not have what the claim speaks of; undecided where ``ask`` answers
    unknown.
    """
    try:
        specification = library.select(certificate.set_name, certificate.options)
        query = read_claim(specification, certificate.claim)
    except RoadproofError as error:
        return Acceptance.UNREADABLE, str(error)
    try:
        derived = certify(
            specification,
            query,
            certificate.instances,
            certificate.names,
            certificate.lemmas,
            certificate.property,
            certificate.scenario,
            certificate.assumed,
            certificate.pinned,
        )
    except RoadproofError as error:
        return Acceptance.REJECTED, f"the query cannot be derived: {error}"
    difference = _difference(derived, certificate)
    if difference:
        return Acceptance.REJECTED, difference
    for title, script in derived.queries:
        answer = ask(script)
        if answer == "unknown":
            return Acceptance.UNDECIDED, f"the query '{title}' was answered unknown, not unsat"
        if answer != "unsat":
            return Acceptance.REJECTED, f"the query '{title}' was answered {answer}, not unsat"
    return Acceptance.ACCEPTED, ""


def unreadable(certificate: Certificate, library: Library) -> str:
    """Why the claim cannot be read with this library, or nothing where it can."""
    try:
        read_claim(library.select(certificate.set_name, certificate.options), certificate.claim)
    except RoadproofError as error:
        return str(error)
    return ""


def _difference(derived: Certificate, stored: Certificate) -> str:
    """What the file says otherwise than claim and instances give, or nothing."""
    if derived.assumptions != stored.assumptions:
        return f"the assumptions are {', '.join(derived.assumptions)}, not {', '.join(stored.assumptions)}"
    if derived.options != stored.options:
        return f"it does not name the options {_listed(derived.options)}, but {_listed(stored.options)}"
    if derived.queries != stored.queries:
        return "the stored query is not the one that claim and instances give"
    return ""


def _listed(options: Mapping[str, str]) -> str:
    return ", ".join(f"{name}={value}" for name, value in sorted(options.items())) or "none"


# --- files --------------------------------------------------------------------------------------


def to_json(certificate: Certificate) -> str:
    """The certificate as a file's text."""
    return json.dumps(certificate_data(certificate), indent=1) + "\n"


def certificate_data(certificate: Certificate) -> dict[str, Any]:
    """The certificate as plain data; sites share a table of formulas."""
    sites = [*certificate.names, *certificate.instances]
    table = list(dict.fromkeys(site.formula for site in sites))
    place = {text: number for number, text in enumerate(table)}

    def write(site: Site) -> list[Any]:
        sign = "+" if site.positive else "-"
        return [place[site.formula], sign, site.moment] + ([site.instance] if site.instance else [])

    return {
        "schema": SCHEMA,
        "property": certificate.property,
        "scenario": certificate.scenario,
        "claim": certificate.claim,
        **_assumed_data(certificate.assumed),
        **({"pinned": list(certificate.pinned)} if certificate.pinned else {}),
        "set": certificate.set_name,
        "options": dict(certificate.options),
        "view": VIEW,
        "assumptions": list(certificate.assumptions),
        "formulas": table,
        "times": [[name, *write(site)] for site, name in certificate.names.items()],
        "instances": [[*write(site), list(terms)] for site, terms in certificate.instances.items()],
        "lemmas": [
            {"clause": [[n, p] for n, p in lemma.literals], "at": list(lemma.moments)}
            for lemma in certificate.lemmas
        ],
        "queries": [{"title": title, "smtlib": query.splitlines()} for title, query in certificate.queries],
        "tableau": None if certificate.tableau is None else list(certificate.tableau),
    }


def _assumed_data(assumed: Assumption) -> dict[str, Any]:
    """What is assumed, the facts about motion that are premises, and the limits that are none.

    Nothing where nothing is assumed.
    """
    if not assumed.said and not assumed.axioms:
        return {}
    axioms = [{"schema": x.schema, "arguments": x.named()} for x in assumed.axioms]
    unused = {"unused": list(assumed.unused)} if assumed.unused else {}
    said = {"assuming": list(assumed.said)} if assumed.said else {}
    return {**said, "axioms": axioms, **unused}


def read_certificate(path: Path) -> Certificate:
    """A certificate from a file. Raises ``InputError`` where it is none."""
    return read_certificate_data(read_json(path), str(path))


_FIELDS = (
    *("schema", "property", "scenario", "claim", "set", "options", "view", "assumptions"),
    *("formulas", "times", "instances", "lemmas", "queries", "assuming", "axioms", "pinned"),
    *("unused", "tableau"),
)


def read_certificate_data(content: object, where: str) -> Certificate:
    """The inverse of ``certificate_data``. Raises ``InputError``."""
    data = Fields(content, where, _FIELDS)
    if data.text("schema") not in SCHEMAS_READ:
        raise InputError(f"{where} is no certificate: its schema must be {SCHEMA} or {WITHOUT_TABLEAU}")
    if ("tableau" in data.content) != (data.text("schema") == SCHEMA):
        raise InputError(f"{where}: tableau is a field of {SCHEMA}, and of no other")
    if data.text("view") != VIEW:
        raise InputError(f"{where}: view={data.text('view')!r}: a certificate is about {VIEW} time")
    table = data.texts("formulas")
    names = [(_site(entry[1:], table, where), text(entry[0], where)) for entry in _rows(data, "times")]
    instances = [
        (_site(entry[:-1], table, where), _texts(entry[-1], where)) for entry in _rows(data, "instances")
    ]
    for what, sites in (("times", names), ("instances", instances)):
        if len({site for site, _ in sites}) < len(sites):
            raise InputError(f"{where}, {what}: one quantifier is listed twice")
    return Certificate(
        data.text("property"),
        data.whole("scenario") if data.get("scenario") is not None else None,
        data.text("claim"),
        data.text("set"),
        data.named_texts("options"),
        data.texts("assumptions"),
        dict(instances),
        dict(names),
        tuple(_lemma(entry, f"{where}, lemmas") for entry in data.items("lemmas")),
        tuple(_query(entry, f"{where}, queries") for entry in data.items("queries")),
        _assumed(data),
        data.texts("pinned") if "pinned" in data.content else (),
        data.texts("tableau") if data.has("tableau") else None,
    )


def _assumed(data: Fields) -> Assumption:
    """The inverse of ``_assumed_data``."""
    if not {"assuming", "axioms", "unused"} & {*data.content}:
        return NOTHING
    said = read_assuming(data) if "assuming" in data.content else ()
    entries = data.items("axioms")
    if not said and not entries:
        raise InputError(f"{data.where}: 'axioms' is empty, and nothing is assumed: leave it out")
    unused = data.texts("unused") if "unused" in data.content else ()
    return Assumption(said, tuple(_axiom(entry, f"{data.where}, axioms") for entry in entries), unused)


def _axiom(content: object, where: str) -> Axiom:
    data = Fields(content, where, ("schema", "arguments"))
    schema, arguments = data.text("schema"), data.named_texts("arguments")
    if schema not in ALL_SCHEMAS:
        raise InputError(f"{where}: {unknown('schema of motion', schema[:40], ALL_SCHEMAS)}")
    if tuple(arguments) != ALL_SCHEMAS[schema]:
        raise InputError(f"{where}: schema {schema} takes {', '.join(ALL_SCHEMAS[schema])}, in this order")
    return Axiom(schema, tuple(arguments.values()))


def _rows(data: Fields, what: str) -> list[list[Any]]:
    rows = data.items(what)
    for row in rows:
        if not isinstance(row, list) or len(row) not in (4, 5):
            raise InputError(f"{data.where}, {what}: {str(row)[:60]!r} is no entry of 4 or 5 parts")
    return rows


def _site(entry: list[Any], table: Sequence[str], where: str) -> Site:
    number, sign, *moments = entry
    if type(number) is not int or not 0 <= number < len(table):
        raise InputError(f"{where}: there is no formula number {str(number)[:20]}")
    if sign not in ("+", "-"):
        raise InputError(f"{where}: sign={str(sign)[:20]!r} must be + or -")
    return Site(table[number], sign == "+", *_texts(moments, where))


def _lemma(content: object, where: str) -> Lemma:
    data = Fields(content, where, ("clause", "at"))
    literals: list[tuple[str, bool]] = []
    for literal in data.items("clause"):
        if not isinstance(literal, list) or len(literal) != 2 or type(literal[1]) is not bool:
            raise InputError(f"{where}: {str(literal)[:60]!r} is no pair of an atom and a truth value")
        literals.append((text(literal[0], where), literal[1]))
    return Lemma(tuple(literals), data.texts("at"))


def _query(content: object, where: str) -> tuple[str, str]:
    data = Fields(content, where, ("title", "smtlib"))
    return data.text("title"), "\n".join(data.texts("smtlib")) + "\n"


def _texts(items: object, where: str) -> tuple[str, ...]:
    if not isinstance(items, list):
        raise InputError(f"{where}: {str(items)[:60]!r} is no list")
    return tuple(text(item, where) for item in items)
