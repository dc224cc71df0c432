"""What becomes of tests under driver models, as lines and as a table for a spreadsheet."""

from collections.abc import Iterator, Sequence
from functools import partial
from itertools import groupby

from roadproof.analysis.catalogue.decisions import Decision
from roadproof.drivers.models import MODELS
from roadproof.frontends.report.sheet import Column, Sheet
from roadproof.frontends.report.sheet import as_csv as csv_of

MOST_TOLD, MOST_ALIKE = 40, 8
_STARTS = ("Ve0", "dV0", "Vf0", "Vy", "Gx", "headway", "dx0", "dx0_f", "dy0")


def as_lines(decisions: Sequence[tuple[str, Decision]]) -> Iterator[str]:
    """How often each model comes to which side, and a line for each test and scenario.

    Of many tests only those are told that some model does not prevent.
    """
    if not decisions:
        return
    yield "driver models, asked when the manoeuvre begins (margins: gap in m, response time in s):"
    for model in MODELS:
        sides = [x.side for _, x in decisions if x.driver == model]
        if sides:
            told = ", ".join(f"{sides.count(side)} {side}" for side in dict.fromkeys(sides))
            yield f"  {model} ({MODELS[model].title}): {told}"
    groups = groupby(decisions, lambda x: (x[0], x[1].scenario))
    every = [(test, scenario, [x for _, x in those]) for (test, scenario), those in groups]
    hit = [x for x in every if any(y.side in ("unpreventable", "partly") for y in x[2])]
    told_of = (every if len(every) <= MOST_ALIKE else hit)[:MOST_TOLD]
    yield from (line for x in told_of for line in _lines(*x))
    if len(told_of) < len(every):
        yield f"  … {len(every) - len(told_of)} more in drivers.csv (--out)"


def _lines(test: str, scenario: str, those: Sequence[Decision]) -> Iterator[str]:
    """The sides of all models in one line, and below it each reason with its models."""
    yield f"  {test} {scenario}: " + ", ".join(f"{x.driver} {said(x)}" for x in those)
    for reason in dict.fromkeys(x.reason for x in those if x.reason):
        models = [x.driver for x in those if x.reason == reason]
        whose = "" if len(models) == len(those) else f"{', '.join(models)}: "
        yield f"    {whose}{reason}"


def said(decision: Decision) -> str:
    """The side, and the margin where there is one: ``preventable (3.2 m, 0.41 s)``."""
    margins = [f"{decision.metres:g} m"] if decision.metres is not None else []
    margins += [f"{decision.seconds:g} s"] if decision.seconds is not None else []
    return decision.side + (f" ({', '.join(margins)})" if margins else "")


def as_csv(decisions: Sequence[tuple[str, Decision]]) -> str:
    """A row for each test, scenario and model; of the state when the manoeuvre begins in SI units."""
    columns: tuple[Column[tuple[str, Decision]], ...] = (
        Column("test", lambda x: x[0]),
        Column("scenario", lambda x: x[1].scenario),
        Column("vehicles", lambda x: " ".join(x[1].vehicles)),
        Column("driver", lambda x: x[1].driver),
        Column("side", lambda x: x[1].side),
        Column("at", lambda x: x[1].at),
        Column("margin_m", lambda x: x[1].metres),
        Column("margin_s", lambda x: x[1].seconds),
        *(Column[tuple[str, Decision]](name, partial(_start, name)) for name in _STARTS),
        Column("reason", lambda x: x[1].reason),
    )
    return csv_of(Sheet(columns, decisions))


def _start(name: str, entry: tuple[str, Decision]) -> float | None:
    return entry[1].start.get(name)
