"""Certificates of claims proved for all time: files that a second program can check.

A certificate names the claim, the set, the options and assumptions, the instances and lemmas, and
holds the ground queries as SMT-LIB. Checking reads the claim again with the library at hand, derives
every query from the instances, compares it with the file, and asks a solver that is passed in.
"""

import json
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from roadproof.errors import InputError, RoadproofError
from roadproof.evidence.atoms import Atoms
from roadproof.evidence.derivation import Lemma, Site, derive_lemma_queries, derive_query
from roadproof.logic.rewrite import parameters_of
from roadproof.spec.elaborate import read_claim
from roadproof.spec.library import Library, Specification

SCHEMA = "roadproof/certificate/1"
VIEW = "dense"


@dataclass(frozen=True)
class Certificate:
    """A proof as data; ``queries`` are (title, SMT-LIB script), each to be answered unsat."""

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


def certify(
    specification: Specification,
    claim: str,
    instances: Mapping[Site, tuple[str, ...]],
    names: Mapping[Site, str],
    lemmas: tuple[Lemma, ...],
    label: str = "",
    scenario: int | None = None,
) -> Certificate:
    """The certificate for a claim, its queries derived here and not by the finder of the proof."""
    query = read_claim(specification, claim)
    formula = query.formula
    atoms = Atoms()
    atomised = atoms.atomise(formula)
    bounds = specification.library.bounds
    ground = derive_query(atomised, atoms, instances, names, lemmas, bounds, query.lanes)
    queries = [("claim", ground)]
    for number, lemma in enumerate(lemmas, 1):
        cases = derive_lemma_queries(atoms, lemma.literals, bounds)
        queries += [(f"lemma {number}, case {k} of {len(cases)}", q) for k, q in enumerate(cases, 1)]
    assumptions = tuple(f"{n} {bounds[n]} 0" for n in parameters_of(formula) if bounds.get(n))
    return Certificate(
        label,
        scenario,
        claim.strip(),
        specification.set_name,
        dict(specification.options),
        assumptions,
        dict(instances),
        dict(names),
        lemmas,
        tuple(queries),
    )


def refusal(certificate: Certificate, library: Library, ask: Callable[[str], str]) -> str | None:
    """Why the certificate is not accepted, or None where it is.

    ``ask`` answers sat, unsat or unknown to an SMT-LIB script.
    """
    try:
        specification = library.select(certificate.set_name, certificate.options)
        derived = certify(
            specification,
            certificate.claim,
            certificate.instances,
            certificate.names,
            certificate.lemmas,
            certificate.property,
            certificate.scenario,
        )
    except RoadproofError as error:
        return f"the query cannot be derived: {error}"
    if derived.assumptions != certificate.assumptions:
        return (
            f"the assumptions are {', '.join(derived.assumptions)}, not {', '.join(certificate.assumptions)}"
        )
    if derived.options != certificate.options:
        return f"it does not name the options {_listed(derived.options)}, but {_listed(certificate.options)}"
    if derived.queries != certificate.queries:
        return "the stored query is not the one that claim and instances give"
    for title, query in derived.queries:
        answer = ask(query)
        if answer != "unsat":
            return f"the query '{title}' was answered {answer}, not unsat"
    return None


def _listed(options: Mapping[str, str]) -> str:
    return ", ".join(f"{name}={value}" for name, value in sorted(options.items())) or "none"


# --- files --------------------------------------------------------------------------------------


def to_json(certificate: Certificate) -> str:
    """The certificate as a file's text; sites share a table of formulas."""
    sites = [*certificate.names, *certificate.instances]
    table = list(dict.fromkeys(site.formula for site in sites))
    place = {text: number for number, text in enumerate(table)}

    def write(site: Site) -> list[Any]:
        sign = "+" if site.positive else "-"
        return [place[site.formula], sign, site.moment] + ([site.instance] if site.instance else [])

    data = {
        "schema": SCHEMA,
        "property": certificate.property,
        "scenario": certificate.scenario,
        "claim": certificate.claim,
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
    }
    return json.dumps(data, indent=1) + "\n"


def read_certificate(path: Path) -> Certificate:
    """A certificate from a file. Raises ``InputError`` where it is none."""
    try:
        data = json.loads(path.read_text("utf-8"))
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror or error}") from None
    except (ValueError, RecursionError) as error:
        raise InputError(f"{path} is not JSON text: {error}") from None
    if not isinstance(data, dict) or data.get("schema") != SCHEMA:
        raise InputError(f"{path} is no certificate: its schema must be {SCHEMA}")
    try:
        return _from_data(data)
    except (KeyError, TypeError, ValueError, IndexError, AttributeError, OverflowError) as error:
        raise InputError(f"{path} is a damaged certificate: {type(error).__name__} {error}") from None


def _from_data(data: Mapping[str, Any]) -> Certificate:
    if data["view"] != VIEW:
        raise ValueError(f"view={data['view']!r}: a certificate is about {VIEW} time")
    table = [str(text) for text in data["formulas"]]

    def site(entry: list[Any]) -> Site:
        number, sign, moment, *rest = entry
        if sign not in ("+", "-") or number < 0:
            raise ValueError(f"bad site {entry}")
        return Site(table[number], sign == "+", str(moment), str(rest[0]) if rest else "")

    scenario = data["scenario"]
    return Certificate(
        str(data["property"]),
        None if scenario is None else int(scenario),
        str(data["claim"]),
        str(data["set"]),
        {str(k): str(v) for k, v in data["options"].items()},
        _texts(data["assumptions"]),
        {site(entry[:-1]): _texts(entry[-1]) for entry in data["instances"]},
        {site(entry[1:]): str(entry[0]) for entry in data["times"]},
        tuple(
            Lemma(tuple((str(n), bool(p)) for n, p in lemma["clause"]), _texts(lemma["at"]))
            for lemma in data["lemmas"]
        ),
        tuple((str(q["title"]), "\n".join(q["smtlib"]) + "\n") for q in data["queries"]),
    )


def _texts(items: Iterable[Any]) -> tuple[str, ...]:
    return tuple(str(item) for item in items)
