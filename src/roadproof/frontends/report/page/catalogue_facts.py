"""Of a catalogue on the page: what becomes of tests under driver models, and how the answer was made."""

from collections.abc import Sequence
from fractions import Fraction

from roadproof.analysis.catalogue.request import Request, further_options
from roadproof.drivers.manoeuvres import MANOEUVRES
from roadproof.drivers.models import MODELS
from roadproof.evidence.answers.catalogue_index import ConcreteTest, Index, KeptDecision
from roadproof.frontends.report.page.markup import Content, joined, table, tag
from roadproof.frontends.report.page.page_context import PageContext
from roadproof.frontends.report.page.pieces import folded, short

_SIZES = ("length", "width")
_KINDS = {"preventable": "proof", "unpreventable": "against"}


def decisions(found: Sequence[KeptDecision]) -> list[Content]:
    """A table: a row for each test and scenario, a column for each driver model, with margins."""
    if not found:
        return []
    models = [name for name in MODELS if any(x.driver == name for x in found)]
    rows: dict[tuple[str, str], dict[str, KeptDecision]] = {}
    for x in found:
        rows.setdefault((x.test, x.scenario), {})[x.driver] = x
    lines = []
    for (test, scenario), by_model in rows.items():
        first = next(iter(by_model.values()))
        reasons = dict.fromkeys(x.reason for x in by_model.values() if x.reason)
        cells = [_decision(by_model.get(name)) for name in models]
        lines.append([test, scenario, short(first.at), _start(first), *cells, "; ".join(reasons)])
    head = ("test", "scenario", "begins (s)", "state at its beginning", *models, "to be known")
    words = ", ".join(f"{name}: {MODELS[name].title}" for name in models)
    told = (
        "Would a driver have prevented the collision? Each model is asked about the state in which the "
        "manoeuvre begins; POV is supposed to go on as it moves there. In brackets, how far the gap (m) and "
        f"the response time (s) are from the nearest value with the other answer. {words}."
    )
    quantities = {name: x for kind in MANOEUVRES.values() for name, x in kind.quantities.items()}
    said = {name for x in found for name in x.start if name not in _SIZES}
    symbols = [name for name in quantities if name in said]
    legend = "; ".join(f"{name}: {quantities[name].doc}" for name in symbols)
    parts: list[Content] = [tag("h3", "Each test and driver model"), tag("p", told), table(head, lines)]
    return [*parts, tag("p", f"In SI units: {legend}.", class_="faint")] if legend else parts


def _decision(x: KeptDecision | None) -> Content:
    if x is None:
        return ""
    margins = [] if x.metres is None else [f"{x.metres:g} m"]
    margins += [] if x.seconds is None else [f"{x.seconds:g} s"]
    word = tag("span", x.side, class_=f"verdict-word {_KINDS.get(x.side, 'none')}")
    return joined([word, f" ({', '.join(margins)})"]) if margins else word


def _start(x: KeptDecision) -> str:
    return ", ".join(f"{name} {value:.3g}" for name, value in x.start.items() if name not in _SIZES)


def provenance(data: Index, context: PageContext) -> list[Content]:
    """How the answer was made: command, version, definitions, parameters, and digests of tests."""
    if data.request is None:
        return []
    request = Request(**vars(data.request))
    home = context.library.select(request.sets[0], data.options)
    values = {name: Fraction(value) for name, value in data.parameters.items()}
    command = request.command(further_options(home, values, data.scenarios))
    readings = ", ".join(f"{k} = {v}" for k, v in data.options.items())
    parameters = ", ".join(f"{k} = {v}" for k, v in data.parameters.items())
    rows = [
        ("command", tag("code", command)),
        ("version", f"roadproof {data.roadproof}, library {data.library}"),
        ("spec sets", ", ".join(request.sets)),
        ("specification files", short(data.specs or "none but those of roadproof")),
        ("readings", readings or "none"),
        ("parameters (SI)", parameters or "none"),
    ]
    digests = [(x.id, x.file, x.sha256) for x in data.tests if isinstance(x, ConcreteTest) and x.sha256]
    inside: list[Content] = [table(("", ""), rows)]
    inside += [table(("test", "file", "SHA-256"), digests)] if digests else []
    return [folded((tag("b", "How this answer was made"),), *inside)]
