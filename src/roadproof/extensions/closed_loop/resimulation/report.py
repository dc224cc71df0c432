"""The answer of ``resimulate`` as text, as a table, and as cases for build servers."""

from collections.abc import Iterator
from pathlib import Path

from roadproof.extensions.closed_loop.resimulation.data import OccurrenceFinding
from roadproof.extensions.closed_loop.resimulation.view import OccurrenceView, ResimulationView
from roadproof.extensions.traffic.evaluate.decisions import decision_text
from roadproof.frontends.report.cases import Case, State
from roadproof.frontends.report.sheet import ColouredText, Column, Sheet
from roadproof.verdict import Verdict

_COLOURS: dict[OccurrenceFinding, str] = {"FAILS": "against", "KEPT": "proof", "ERROR": "against"}


def sheet_of(view: ResimulationView) -> Sheet[OccurrenceView]:
    """Return a sheet with an entry for each occurrence."""
    return Sheet(
        (
            Column("", lambda x: ColouredText(x.finding, _COLOURS[x.finding]), "page"),
            Column("occurrence", lambda x: x.id),
            Column("finding", lambda x: x.finding, "frame"),
            Column("scenarios", lambda x: ", ".join(map(str, x.occurrence.scenarios))),
            Column("recording", lambda x: x.occurrence.recording),
            Column("first_frame", lambda x: x.occurrence.first_frame, heading="first frame"),
            Column("seconds", lambda x: float(x.occurrence.seconds)),
            Column("vehicles", lambda x: vehicles_text(x)),
            Column("recorded_gap_m", lambda x: x.occurrence.gap, heading="least gap before (m)"),
            Column("gap_m", lambda x: x.gap, heading="with the controller (m)"),
            Column("shows", lambda x: ", ".join(map(str, x.shows)), "frame"),
            Column("preventable_by", lambda x: ", ".join(x.preventable_by), heading="preventable by"),
        ),
        view.occurrences,
    )


def vehicles_text(x: OccurrenceView) -> str:
    """Return the vehicles of the recording by role, such as ``SV 12, POV 15``."""
    return ", ".join(f"{role} {number}" for role, number in x.occurrence.vehicles.items())


def as_text(view: ResimulationView, notes: tuple[str, ...] = ()) -> str:
    """Return the findings, a line or more for each occurrence, and a summary."""
    lines = [line for x in view.occurrences for line in _lines(x)]
    return "\n".join([*lines, *notes, *_summary(view)])


def _lines(x: OccurrenceView) -> Iterator[str]:
    about = x.occurrence
    numbers = ", ".join(map(str, about.scenarios))
    yield f"{x.finding:<6} {x.id:<28} scenario{'s' * (len(about.scenarios) > 1)} {numbers}".rstrip()
    yield f"  {finding_text(x)}"
    for decision in x.decisions:
        reason = f": {decision.reason}" if decision.reason else ""
        yield f"  {decision.driver}: {decision_text(decision)}{reason}"
    if x.finding == "FAILS" and not x.decisions:
        yield "  no driver model speaks of this scenario"


def finding_text(x: OccurrenceView) -> str:
    """Return what a finding rests on, in words."""
    if x.finding == "ERROR":
        return str(x.reason)
    recorded, driven = (_gap(y) for y in (x.occurrence.gap, x.gap))
    return f"{float(x.occurrence.seconds):g} s; least gap {recorded} before, {driven} with the controller"


def _gap(value: float | None) -> str:
    return "none" if value is None else f"{value:g} m"


def _summary(view: ResimulationView) -> Iterator[str]:
    every = view.occurrences
    preventable = sum(bool(x.preventable_by) for x in view.failures)
    without = sum(x.finding == "KEPT" for x in every)
    yield (
        f"{len(view.failures)} of {len(every)} occurrences with a failure, {preventable} of them "
        f"preventable; {without} without"
    )
    apart = max((x.occurrence.deviation for x in every), default=0.0)
    left_out = sum(x.occurrence.left_out for x in every)
    yield f"other vehicles move as before, within {apart:g} m, and do not react to the controller"
    if left_out:
        yield f"{left_out} vehicles nearby come or go meanwhile; they are left out"


def occurrence_cases(view: ResimulationView, folder: Path | None) -> Iterator[Case]:
    """Yield a case for each occurrence: failed where the controller fails."""
    states: dict[OccurrenceFinding, tuple[State, Verdict | None]] = {
        "FAILS": ("failed", Verdict.REFUTED),
        "KEPT": ("passed", None),
        "ERROR": ("undecided", Verdict.UNKNOWN),
    }
    for x in view.occurrences:
        state, rule = states[x.finding]
        yield Case(
            suite=x.occurrence.recording,
            name=x.id,
            state=state,
            rule=rule,
            message="" if state == "passed" else f"{x.finding} {finding_text(x)}",
            place=None,
            evidence=folder / f"{x.claim_name}.json" if folder and x.finding == "FAILS" else None,
        )
