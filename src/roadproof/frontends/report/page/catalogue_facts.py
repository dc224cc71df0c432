"""Of a catalogue on the page: what becomes of tests under driver models, and how the answer was made."""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any

from roadproof.analysis.catalogue.request import further_options, read_request
from roadproof.drivers.manoeuvres import MANOEUVRES
from roadproof.drivers.models import MODELS
from roadproof.frontends.report.page.markup import Content, joined, table, tag
from roadproof.frontends.report.page.page_context import PageContext
from roadproof.frontends.report.page.pieces import folded, short

_SIZES = ("length", "width")
_KINDS = {"preventable": "proof", "unpreventable": "against"}


def decisions(found: Sequence[Mapping[str, Any]]) -> list[Content]:
    """A table: a row for each test and scenario, a column for each driver model, with margins."""
    if not found:
        return []
    models = [name for name in MODELS if any(x.get("driver") == name for x in found)]
    rows: dict[tuple[str, str], dict[str, Mapping[str, Any]]] = {}
    for x in found:
        rows.setdefault((str(x.get("test")), str(x.get("scenario"))), {})[str(x.get("driver"))] = x
    lines = []
    for (test, scenario), by_model in rows.items():
        first = next(iter(by_model.values()))
        reasons = dict.fromkeys(str(x["reason"]) for x in by_model.values() if x.get("reason"))
        cells = [_decision(by_model.get(name)) for name in models]
        lines.append([test, scenario, short(first.get("at")), _start(first), *cells, "; ".join(reasons)])
    head = ("test", "scenario", "begins (s)", "state at its beginning", *models, "to be known")
    words = ", ".join(f"{name}: {MODELS[name].title}" for name in models)
    told = (
        "Would a driver have prevented the collision? Each model is asked about the state in which the "
        "manoeuvre begins; POV is supposed to go on as it moves there. In brackets, how far the gap (m) and "
        f"the response time (s) are from the nearest value with the other answer. {words}."
    )
    quantities = {name: x for kind in MANOEUVRES.values() for name, x in kind.quantities.items()}
    said = {name for x in found for name in x.get("start") or () if name not in _SIZES}
    symbols = [name for name in quantities if name in said]
    legend = "; ".join(f"{name}: {quantities[name].doc}" for name in symbols)
    parts: list[Content] = [tag("h3", "Each test and driver model"), tag("p", told), table(head, lines)]
    return [*parts, tag("p", f"In SI units: {legend}.", class_="faint")] if legend else parts


def _decision(x: Mapping[str, Any] | None) -> Content:
    if x is None:
        return ""
    margins = [f"{x['metres']:g} m"] if x.get("metres") is not None else []
    margins += [f"{x['seconds']:g} s"] if x.get("seconds") is not None else []
    side = str(x.get("side"))
    word = tag("span", side, class_=f"verdict-word {_KINDS.get(side, 'none')}")
    return joined([word, f" ({', '.join(margins)})"]) if margins else word


def _start(x: Mapping[str, Any]) -> str:
    said = (x.get("start") or {}).items()
    return ", ".join(f"{name} {value:.3g}" for name, value in said if name not in _SIZES)


def provenance(data: Mapping[str, Any], book: PageContext) -> list[Content]:
    """How the answer was made: command, version, definitions, parameters, and digests of tests."""
    if "request" not in data:
        return []
    request = read_request(data["request"], "request")
    home = book.library.select(request.sets[0], data.get("options") or {})
    values = {name: Fraction(value) for name, value in (data.get("parameters") or {}).items()}
    command = request.command(further_options(home, values, data.get("scenarios") or ()))
    readings = ", ".join(f"{k} = {v}" for k, v in (data.get("options") or {}).items())
    parameters = ", ".join(f"{k} = {v}" for k, v in (data.get("parameters") or {}).items())
    rows = [
        ("command", tag("code", command)),
        ("version", f"roadproof {data.get('roadproof')}, library {data.get('library')}"),
        ("spec sets", ", ".join(request.sets)),
        ("specification files", short(data.get("specs") or "none but those of roadproof")),
        ("readings", readings or "none"),
        ("parameters (SI)", parameters or "none"),
    ]
    digests = [(x.get("id"), x.get("file"), x["sha256"]) for x in data.get("tests", ()) if x.get("sha256")]
    inside: list[Content] = [table(("", ""), rows)]
    inside += [table(("test", "file", "SHA-256"), digests)] if digests else []
    return [folded((tag("b", "How this answer was made"),), *inside)]
