"""The JSON file of a certificate."""

import json
from collections.abc import Sequence
from pathlib import Path

from roadproof.core_record import CERTIFICATE
from roadproof.errors import InputError
from roadproof.evidence.answers import certificate as json_types
from roadproof.evidence.certificate import Certificate
from roadproof.evidence.codec import read, write
from roadproof.evidence.sites import Site, StateLemma
from roadproof.evidence.strict import Fields, JsonObject, read_json
from roadproof.library.assumption import ALL_SCHEMAS, NOTHING, Assumption, Axiom
from roadproof.library.specification import unknown_name


def to_json(certificate: Certificate) -> str:
    """Return the certificate as the text of its file."""
    return json.dumps(certificate_data(certificate), indent=1) + "\n"


def certificate_data(certificate: Certificate) -> JsonObject:
    """Return the certificate as JSON; sites refer to one table of formulas."""
    sites = [*certificate.names, *certificate.instances]
    table = list(dict.fromkeys(site.formula for site in sites))
    place = {text: number for number, text in enumerate(table)}

    def site_row(site: Site) -> tuple[int, json_types.Sign, str] | tuple[int, json_types.Sign, str, str]:
        sign: json_types.Sign = "+" if site.positive else "-"
        where = place[site.formula], sign, site.moment
        return (*where, site.instance) if site.instance else where

    tableau, assumed = certificate.tableau, certificate.assumed
    is_assumed = assumed.texts or assumed.axioms
    return write(
        json_types.CertificateData(
            property=certificate.property,
            scenario=certificate.scenario,
            claim=certificate.claim,
            assuming=assumed.texts,
            axioms=tuple(json_types.AxiomData(schema=x.schema, arguments=x.named()) for x in assumed.axioms)
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
            times=tuple((name, *site_row(site)) for site, name in certificate.names.items()),
            instances=tuple((*site_row(site), moments) for site, moments in certificate.instances.items()),
            lemmas=tuple(
                json_types.StateLemmaData(clause=x.literals, at=x.moments) for x in certificate.lemmas
            ),
            queries=tuple(
                json_types.QueryData(title=title, smtlib=tuple(query.splitlines()))
                for title, query in certificate.queries
            ),
            tableau=tableau,
        )
    )


def read_certificate(path: Path) -> Certificate:
    """Return the certificate in a file. Raises ``InputError`` if it is none."""
    return read_certificate_data(read_json(path), str(path))


def read_certificate_data(content: object, where: str) -> Certificate:
    """Return the certificate in parsed JSON, the inverse of ``certificate_data``. Raises ``InputError``."""
    if Fields(content, where).text("schema") != CERTIFICATE:
        raise InputError(f"{where} is no certificate: its schema must be {CERTIFICATE}")
    stored = read(json_types.CertificateData, content, where)
    names = [(_site(row[1:], stored.formulas, where), row[0]) for row in stored.times]
    instances = [(_site(row[:-1], stored.formulas, where), row[-1]) for row in stored.instances]
    for kind, sites in (("times", names), ("instances", instances)):
        if len({site for site, _ in sites}) < len(sites):
            raise InputError(f"{where}, {kind}: one quantifier is listed twice")
    return Certificate(
        stored.property,
        stored.scenario,
        stored.claim,
        stored.set,
        stored.options,
        stored.assumptions,
        dict(instances),
        dict(names),
        tuple(StateLemma(x.clause, x.at) for x in stored.lemmas),
        tuple((x.title, "\n".join(x.smtlib) + "\n") for x in stored.queries),
        _assumed(stored, where),
        stored.pinned,
        stored.reading or "states",
        stored.tableau,
    )


def _assumed(stored: json_types.CertificateData, where: str) -> Assumption:
    """Return the assumptions, the motion facts that are premises, and the limits that are not."""
    if stored.axioms is None:
        if stored.assuming or stored.unused:
            raise InputError(f"{where}: 'axioms' is missing")
        return NOTHING
    if not stored.assuming and not stored.axioms:
        raise InputError(f"{where}: 'axioms' is empty, and nothing is assumed: leave it out")
    return Assumption(
        stored.assuming, tuple(_axiom(x, f"{where}, axioms") for x in stored.axioms), stored.unused
    )


def _axiom(stored: json_types.AxiomData, where: str) -> Axiom:
    schema = stored.schema
    if schema not in ALL_SCHEMAS:
        raise InputError(f"{where}: {unknown_name('schema of motion', schema[:40], ALL_SCHEMAS)}")
    if tuple(stored.arguments) != ALL_SCHEMAS[schema]:
        raise InputError(f"{where}: schema {schema} takes {', '.join(ALL_SCHEMAS[schema])}, in this order")
    return Axiom(schema, tuple(stored.arguments.values()))


def _site(row: tuple[int, str, str] | tuple[int, str, str, str], table: Sequence[str], where: str) -> Site:
    """Return the quantifier of a ``row``: place in the table, sign, moment, and instance if inside one."""
    number, sign, *moments = row
    if number >= len(table):
        raise InputError(f"{where}: there is no formula number {number}")
    return Site(table[number], sign == "+", *moments)
