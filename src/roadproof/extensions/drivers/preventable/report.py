"""Plates as text and as a table: which initial values a driver prevents a collision from."""

from collections.abc import Sequence
from fractions import Fraction
from functools import partial
from typing import TypeAlias

from roadproof.extensions.drivers.lines import PlateLine, SpanEnd
from roadproof.extensions.drivers.manoeuvres import InitialQuantity
from roadproof.extensions.drivers.models import driver_model, parts_of
from roadproof.extensions.drivers.preventable.question import PreventableQuestion
from roadproof.extensions.drivers.preventable.view import LemmaResult, PlateResult, Shown
from roadproof.extensions.drivers.words import legend
from roadproof.frontends.report.sheet import Column, Sheet
from roadproof.world.units import UNITS

_TESTS = 12  # tests of the reader that the terminal shows
_TOLD = 5  # lines of a plate, and spans of a line, that the terminal shows


def measured(quantity: InitialQuantity, value: Fraction, digits: int = 6) -> str:
    """Return a value in its quantity's unit, with so many digits: ``60 km/h``."""
    return f"{float(value / UNITS[quantity.unit][0]):.{digits}g} {quantity.unit}"


def fixed_text(question: PreventableQuestion, plate: PlateResult) -> str:
    """Return the initial values that are fixed on a plate, as text."""
    known = question.manoeuvre.quantities
    return ", ".join(f"{name} = {measured(known[name], value)}" for name, value in plate.fixed.items())


def shown_symbols(question: PreventableQuestion) -> tuple[InitialQuantity, ...]:
    """The initial values that plates are about, in the order of the manoeuvre."""
    names = {question.manoeuvre.line, question.manoeuvre.across, *question.sheet, *question.fixed}
    return tuple(x for name, x in question.manoeuvre.quantities.items() if name in names)


def share_of(question: PreventableQuestion, plate: PlateResult) -> float:
    """Return which part of the plane is unpreventable: the mean over its lines."""
    low, high = question.along
    total = sum(b.near - a.near for x in plate.lines for a, b in x.spans)
    return total / (float(high - low) * len(plate.lines)) if plate.lines else 0.0


def as_text(
    question: PreventableQuestion, plates: Sequence[PlateResult], lemmas: Sequence[LemmaResult]
) -> str:
    """Return text for the terminal: each plate with some of its lines and its drives, and the lemmas."""
    known = question.manoeuvre.quantities
    along, across = known[question.manoeuvre.line], known[question.manoeuvre.across]
    lines: list[str] = []
    for plate in plates:
        fixed = fixed_text(question, plate)
        title = driver_model(plate.model).title
        lines.append(f"{plate.verdict:<11} {question.manoeuvre.name}, {title}{fixed and f'; {fixed}'}")
        if plate.reason:
            lines.append(f"  {plate.reason}")
        if plate.lines:
            percent = 100 * share_of(question, plate)
            what = f"{percent:.1f} % of the plane"
            if plate.stepped:
                what = "what follows"
                lines.append(f"  {plate.stepped};")
                lines.append("  the drives follow the controller, which their formula does not say")
            if plate.motion:
                lines.append(f"  {plate.motion};")
            lines.append(f"  unpreventable on {what}; {along.doc} [{along.unit}]:")
        for line in _some(plate.lines):
            shown = " and ".join(f"{a.near:.6g} to {b.near:.6g}" for a, b in line.spans[:_TOLD]) or "nowhere"
            if len(line.spans) > _TOLD:
                shown += f" and {len(line.spans) - _TOLD} more"
            lines.append(f"    {across.name} = {measured(across, line.at):<14} {shown}")
        for x in plate.shown:
            result: str = x.reason
            if x.drive is not None:
                values = ", ".join(
                    f"{name} = {measured(known[name], x.values[name])}" for name in (across.name, along.name)
                )
                result = f"a drive at {values}{_scenario_text(question, x)}"
            lines.append(f"  {x.side}: {result}")
    lines += _test_lines(question)
    lines += [legend(shown_symbols(question))] if plates else []
    for proved in lemmas:
        lines.append(f"{proved.verdict:<11} {proved.lemma.name}: {proved.lemma.title}")
        if proved.reason:
            lines.append(f"  {proved.reason}")
    if question.readings:
        lines.append(f"with {', '.join(question.readings)}")
    lines += [f"{idle}: no boundary that is asked for depends on it" for idle in question.idle]
    return "\n".join(lines)


def _test_lines(question: PreventableQuestion) -> list[str]:
    """Return lines on the tests of the reader: how many are drawn, and the values of some."""
    if not question.tests:
        return []
    placed, known = question.placed_tests, question.manoeuvre.quantities
    own = sum(x.has_values for x in placed)
    outside = len(question.tests) - len(placed)
    lines = [
        f"tests: {len(placed)} drawn, {own} with the fixed values of their plate, {len(placed) - own} with "
        f"others, on the nearest plate; {outside} outside the ranges"
    ]
    for x in placed[:_TESTS]:
        values = ", ".join(f"{name} {measured(known[name], v, 4)}" for name, v in x.test.values.items())
        lines.append(f"  {x.test.name}: {values}")
    return lines + ([f"  … {len(placed) - _TESTS} more"] if len(placed) > _TESTS else [])


def _scenario_text(question: PreventableQuestion, shown: Shown) -> str:
    """Return the scenario of the drive, where the question names one."""
    if question.scenario is None:
        return ""
    whole, happening = parts_of(question.scenario, question.manoeuvre.vehicles)
    if shown.scenario == whole:
        return f", of scenario {question.scenario}"
    if shown.scenario == happening:
        return f"; what happens in scenario {question.scenario}, but no start that was tried is safe"
    return f"; no drive that was tried is of scenario {question.scenario}"


def _some(lines: Sequence[PlateLine]) -> Sequence[PlateLine]:
    """A few lines, first and last with them."""
    if len(lines) <= _TOLD:
        return lines
    return [lines[round(k * (len(lines) - 1) / (_TOLD - 1))] for k in range(_TOLD)]


Entry: TypeAlias = tuple[PlateResult, PlateLine, tuple[SpanEnd, SpanEnd]]
"""A span of a line of a plate."""


def sheet_of(question: PreventableQuestion, plates: Sequence[PlateResult]) -> Sheet[Entry]:
    """An entry for each span of each line: SI units, ends as numbers and in CSV also exactly."""
    fixed = dict.fromkeys(name for plate in plates for name in plate.fixed)
    along, across = question.manoeuvre.line, question.manoeuvre.across
    columns: tuple[Column[Entry], ...] = (
        Column("model", lambda x: x[0].model),
        *(Column(name, partial(_fixed, name)) for name in fixed),
        Column(across, lambda x: x[1].at),
        Column(f"{along}_from", lambda x: x[2][0].near),
        Column(f"{along}_to", lambda x: x[2][1].near),
        Column(f"{along}_from_exact", lambda x: "" if x[0].stepped else x[2][0].exact, "csv"),
        Column(f"{along}_to_exact", lambda x: "" if x[0].stepped else x[2][1].exact, "csv"),
        Column("note", lambda x: x[0].stepped or x[0].motion, "csv"),
    )
    every = [(plate, line, span) for plate in plates for line in plate.lines for span in line.spans]
    return Sheet(columns, every)


def _fixed(name: str, entry: Entry) -> Fraction:
    return entry[0].fixed[name]
