"""The answer of ``falsify`` as text and as a table."""

from collections.abc import Iterator

from roadproof.extensions.closed_loop.data import Finding
from roadproof.extensions.closed_loop.simulations_file import SimulationPoint
from roadproof.extensions.closed_loop.view import FalsifyView, TargetView
from roadproof.extensions.traffic.evaluate.decisions import decision_text
from roadproof.frontends.report.sheet import ColouredText, Column, Sheet, as_csv

_COLOURS: dict[Finding, str] = {
    "FAILS": "against",
    "SHOWN": "proof",
    "NOT SHOWN": "none",
    "IMPOSSIBLE": "proof",
    "ERROR": "against",
}


def sheet_of(view: FalsifyView) -> Sheet[TargetView]:
    """Return a sheet with an entry for each target."""
    return Sheet(
        (
            Column("", lambda x: ColouredText(x.finding, _COLOURS[x.finding]), "page"),
            Column("target", lambda x: x.name),
            Column("title", lambda x: x.title, heading="in words"),
            Column("finding", lambda x: x.finding, "frame"),
            Column("preventable_by", lambda x: ", ".join(x.preventable_by), heading="preventable by"),
            Column("simulations", lambda x: _count(x)),
            Column("first_failure", lambda x: _first(x), "frame"),
            Column("shown_by", lambda x: ", ".join(x.shown_by), "frame"),
        ),
        view.targets,
    )


def _count(x: TargetView) -> int:
    return 0 if x.simulations is None else x.simulations.count


def _first(x: TargetView) -> int:
    return 0 if x.simulations is None else x.simulations.first_failure


def simulations_csv(view: FalsifyView) -> str:
    """Return a row for each simulation: its target, gap (m), speed difference (m/s) and outcome."""
    rows = [(x.name, point) for x in view.targets if x.simulations for point in x.simulations.points]
    columns: tuple[Column[tuple[str, SimulationPoint]], ...] = (
        Column("target", lambda x: x[0]),
        Column("gap_m", lambda x: x[1].gap),
        Column("faster_m_s", lambda x: x[1].faster),
        Column("outcome", lambda x: x[1].kind),
    )
    return as_csv(Sheet(columns, rows))


def as_text(view: FalsifyView, notes: tuple[str, ...] = ()) -> str:
    """Return the findings, a line or more for each target, and a summary."""
    lines = [line for x in view.targets for line in _lines(x)]
    return "\n".join([*lines, *notes, *_summary(view)])


def _lines(x: TargetView) -> Iterator[str]:
    yield f"{x.name:<12} {x.finding:<10} {finding_text(x)}".rstrip()
    yield f"  {x.title}"
    if x.finding == "FAILS":
        for decision in x.decisions:
            reason = f": {decision.reason}" if decision.reason else ""
            yield f"  {decision.driver}: {decision_text(decision)}{reason}"
        if not x.decisions:
            yield "  no driver model speaks of this scenario"


def finding_text(x: TargetView) -> str:
    """Return what a finding rests on, in words."""
    file = x.simulations
    match x.finding:
        case "FAILS":
            first = 0 if file is None else file.first_failure
            by = ", ".join(x.preventable_by)
            after = f"after {first} simulation{'s' * (first != 1)}"
            return f"{after}, preventable by {by}" if by else f"{after}, no driver model prevents it"
        case "SHOWN":
            if file is None:
                return f"by {', '.join(x.shown_by)}"
            words = "no failure found" if x.is_scenario else "shown"
            if x.failing is not None and file.first_failure:
                words = "no failure that a driver prevents"
            return f"{words} in {file.count} simulations"
        case "NOT SHOWN":
            if file is None or file.nearest is None:
                return str(x.reason)
            if file.nearest > 0:
                return f"in {file.count} simulations; some show it on samples, but the judge rejects them"
            return f"in {file.count} simulations, the nearest misses it by {-file.nearest:.3g}"
        case "IMPOSSIBLE":
            return "proved: no drive shows it, whoever drives SV"
        case "ERROR":
            return str(x.reason)


def _summary(view: FalsifyView) -> Iterator[str]:
    scenarios = [x for x in view.targets if x.is_scenario]
    preventable = sum(bool(x.preventable_by) for x in view.failures)
    yield (
        f"{len(view.failures)} of {len(scenarios)} scenarios with a failure, {preventable} of them "
        f"preventable; {view.simulations} simulations"
    )
    if view.classes_asked:
        yield f"classes: {view.classes_shown} of {len(view.classes)} possible ones shown"
    yield "simulations show failures; that none was found shows nothing about other drives"
