"""Reports of a catalogue: text, tables for a spreadsheet, a report for CI, a matrix."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from functools import partial
from itertools import groupby
from textwrap import indent
from typing import Any

from roadproof.extensions.catalogue.cases import catalogue_cases
from roadproof.extensions.catalogue.catalogue_data import Figure, Remark, TargetData
from roadproof.extensions.catalogue.figures import CLASSES, SCENARIOS, kind_of
from roadproof.extensions.catalogue.gaps import PREFIX
from roadproof.extensions.catalogue.ranges import InitialValueRange
from roadproof.extensions.catalogue.targets import Targets
from roadproof.extensions.catalogue.view import CatalogueView
from roadproof.extensions.drivers.models import MODELS
from roadproof.extensions.traffic.evaluate.decisions import Decision, decision_text
from roadproof.frontends.api.build_result import formats, written
from roadproof.frontends.report.csv_table import csv_text
from roadproof.frontends.report.figures import count_axis, make_figure
from roadproof.frontends.report.sheet import ColouredText, Column, Sheet, excerpt
from roadproof.frontends.report.sheet import as_csv as csv_of
from roadproof.library.scenarios import number_in
from roadproof.runtime.files import utf8
from roadproof.verdict import ExitCode, Verdict

MOST_LINES, MOST_IN_FULL = 40, 8
_STARTS = ("Ve0", "dV0", "Vf0", "Vy", "Gx", "headway", "dx0", "dx0_f", "dy0")


def driver_lines(decisions: Sequence[tuple[str, Decision]]) -> Iterator[str]:
    """Yield the count of each side by driver model, and a line for each test and scenario.

    Of many tests only those get a line that some model does not prevent.
    """
    if not decisions:
        return
    yield "driver models in place of SV, in the test's own motion:"
    for model in MODELS:
        sides = [x.side for _, x in decisions if x.driver == model]
        if sides:
            counts = ", ".join(f"{sides.count(side)} {side}" for side in dict.fromkeys(sides))
            yield f"  {model} ({MODELS[model].title}): {counts}"
    groups = groupby(decisions, lambda x: (x[0], x[1].scenario))
    every = [(test, scenario, [x for _, x in those]) for (test, scenario), those in groups]
    hit = [x for x in every if any(y.side in ("unpreventable", "partly") for y in x[2])]
    printed = (every if len(every) <= MOST_IN_FULL else hit)[:MOST_LINES]
    yield from (line for x in printed for line in _lines_of_test(*x))
    if len(printed) < len(every):
        yield f"  … {len(every) - len(printed)} more in drivers.csv (--out)"


def _lines_of_test(test: str, scenario: str, those: Sequence[Decision]) -> Iterator[str]:
    """Yield the sides of all models in one line, and below it each reason with its models."""
    yield f"  {test} {scenario}: " + ", ".join(f"{x.driver} {decision_text(x)}" for x in those)
    for reason in dict.fromkeys(x.reason for x in those if x.reason):
        models = [x.driver for x in those if x.reason == reason]
        whose = "" if len(models) == len(those) else f"{', '.join(models)}: "
        yield f"    {whose}{reason}"


def drivers_csv(decisions: Sequence[tuple[str, Decision]]) -> str:
    """Return a row for each test, scenario and model, with the state at the begin of the manoeuvre (SI)."""
    columns: tuple[Column[tuple[str, Decision]], ...] = (
        Column("test", lambda x: x[0]),
        Column("scenario", lambda x: x[1].scenario),
        Column("vehicles", lambda x: " ".join(x[1].vehicles)),
        Column("driver", lambda x: x[1].driver),
        Column("side", lambda x: x[1].side),
        Column("at", lambda x: x[1].at),
        Column("gap_m", lambda x: x[1].gap),
        Column("touches_s", lambda x: x[1].instant),
        Column("faster_m_s", lambda x: x[1].speed),
        *(Column[tuple[str, Decision]](name, partial(_start, name)) for name in _STARTS),
        Column("reason", lambda x: x[1].reason),
    )
    return csv_of(Sheet(columns, decisions))


def _start(name: str, entry: tuple[str, Decision]) -> float | None:
    return entry[1].start.get(name)


MOST_WHY = 90
"""The most letters of the reason beside the name of a test that is not what it claims."""
_SURE, _POSSIBLE, _NONE = "#1f5fbf", "#9dbbe3", "#b5473c"
_INCH_A_LETTER = 0.06  # of labels at 7 points


def as_text(
    tests: int, targets: Targets, notes: Sequence[str], figures: Sequence[Figure], drivers: Iterable[str] = ()
) -> str:
    """Return the text of figures, missing targets and remarks.

    ``tests``: the number of tests; ``drivers``: lines on decisions of driver models.
    """
    lines = [f"{tests} test{'s' * (tests != 1)}", *_figures(figures), *_gaps(targets), *drivers]
    lines += _section("not tested", [f"{x.name}: {x.words}" for x in targets.missing])
    for heading, remarks in headings(targets).items():
        lines += _section(heading, [f"{' and '.join(x.tests)}: {x.told}" for x in remarks])
    return "\n".join([*lines, *(f"note: {x}" for x in notes), _summary(targets)])


def kinds(targets: Targets) -> dict[str, list[TargetData]]:
    """Return the scenarios and the classes among the targets, by kind."""
    return {kind: [x for x in targets.targets if kind_of(x.name) == kind] for kind in (SCENARIOS, CLASSES)}


def _figures(figures: Sequence[Figure]) -> Iterator[str]:
    """Yield a line for each figure, with the spec set where there are several."""
    sets = dict.fromkeys(x.set_name for x in figures)
    for x in figures:
        where = f"set {x.set_name}, " if len(sets) > 1 and not x.sector else ""
        what = f"  {x.sector.replace('_', ' and ')}" if x.sector else f"{where}{x.kind}"
        yield f"{what}: {x.tested} of {x.total} are tested"


def _gaps(targets: Targets) -> Iterator[str]:
    """Yield lines on classes of gaps."""
    gaps = targets.gaps
    if gaps.empty:
        yield f"classes of gaps that are proved empty: {len(gaps.empty)}"
    if not gaps.required and any(x.tested or x.possible for x in gaps.targets):
        shown = sum(bool(x.tested) for x in gaps.targets)
        yield f"classes of gaps: {shown} of {gaps.total} are shown (--gaps: which others there are)"


def range_lines(ranges: Sequence[InitialValueRange], horizon: Fraction) -> Iterator[str]:
    """Yield a line for each initial value with the untested share of its range, after the limits."""
    if ranges:
        yield (
            f"how tests begin, of how drives can that were found ({horizon} s of driving, cars, at most 80 m "
            "apart at the start):"
        )
    for name in dict.fromkeys(x.target for x in ranges):
        yield f"  {name}"
        for x in (y for y in ranges if y.target == name):
            tested, can = (f"{low:.4g} to {high:.4g}" for low, high in (x.tested, x.reached))
            yield f"    {x.term}: {tested} of {can} {x.unit}; {x.share:.0%} is not tested"


def tables(result: CatalogueView) -> dict[str, bytes]:
    """Return the tables of a folder of answers by file name."""
    tests = tuple(x.id for x in result.catalogue.entries)
    targets, in_force = result.tested, result.in_force
    made = {
        "matrix.csv": as_csv(tests, targets, in_force),
        "figures.csv": figures_csv(result.figures),
        "drivers.csv": drivers_csv(result.decisions),
        **dict(build_results(tests, targets, in_force)),
    }
    return {name: utf8(text) for name, text in made.items()}


def figures_csv(figures: Sequence[Figure]) -> str:
    """Return the figures as a table."""
    columns: tuple[Column[Figure], ...] = (
        Column("set", lambda x: x.set_name),
        Column("kind", lambda x: x.kind),
        Column("sector", lambda x: x.sector),
        Column("tested", lambda x: x.tested),
        Column("total", lambda x: x.total),
    )
    return csv_of(Sheet(columns, figures))


def sheet_of(
    targets: Sequence[TargetData], verdicts: Mapping[str, Verdict], possible: bool = True
) -> Sheet[TargetData]:
    """Return a sheet with an entry for each target; those without a verdict are covered.

    ``possible``: whether pages have a column of tests that show a target on some drives only.
    """

    def verdict(x: TargetData) -> Verdict:
        return verdicts.get(x.name, Verdict.COVERED)

    def mark(x: TargetData) -> ColouredText:
        if verdict(x) is not Verdict.COVERED:
            return ColouredText("✗ not tested", "against")
        count = len(x.tested)
        return (
            ColouredText(f"✓ {count} test{'s' * (count != 1)}", "proof")
            if count
            else ColouredText("– none", "none")
        )

    return Sheet(
        (
            Column("", mark, "page"),
            Column("target", lambda x: x.name, heading="what"),
            Column("words", lambda x: x.words, heading="in words"),
            Column("sector", lambda x: x.sector, "frame"),
            Column("verdict", verdict, "frame"),
            Column("tests", lambda x: len(x.tested), "frame"),
            Column("tested_by", lambda x: ", ".join(x.tested), heading="tests that show it"),
            Column(
                "possible_in",
                lambda x: ", ".join(x.possible),
                "" if possible else "frame",
                "tests of which some drives show it",
            ),
        ),
        targets,
    )


def headings(targets: Targets) -> dict[str, Sequence[Remark]]:
    """Return the remarks by heading."""
    return {
        "readers contradict each other": targets.contradictions,
        "not what they claim": targets.faults,
        "in doubt": targets.doubts,
        "duplicate tests": targets.alike,
    }


def _section(heading: str, lines: Sequence[str]) -> Iterator[str]:
    if lines:
        yield f"{heading}:"
        yield from (indent(line, "  ") for line in lines[:MOST_LINES])
        if len(lines) > MOST_LINES:
            yield f"  … {len(lines) - MOST_LINES} more"


def _summary(targets: Targets) -> str:
    wrong = [
        f"{len(those)} {word}"
        for those, word in (
            (targets.missing, "not tested"),
            (targets.faults, "not what they claim"),
            (targets.doubts, "in doubt"),
            (targets.contradictions, "contradicting"),
        )
        if those
    ]
    return ", ".join(wrong) or "complete"


def as_csv(tests: Sequence[str], targets: Targets, in_force: Sequence[str] = ()) -> str:
    """Return a row for each test and a column for each target: ``x`` shown or implied, ``o`` by some drives.

    ``in_force``: the settings that differ from the defaults, for the first cell.
    """
    header = ["; ".join(["test", *in_force]), *(x.name for x in targets.all_targets)]
    return csv_text(header, ([test, *(_mark(test, x) for x in targets.all_targets)] for test in tests))


def _mark(test: str, target: TargetData) -> str:
    return "x" if test in target.tested else "o" if test in target.possible else ""


def build_results(
    tests: Sequence[str], targets: Targets, in_force: Sequence[str] = ()
) -> Iterator[tuple[str, str]]:
    """Yield ``junit.xml`` where JUnit XML is installed: a suite of the tests, and one of all targets.

    ``in_force``: the settings that differ from the defaults, a property of each suite.
    """
    if "junit" in formats():
        cases = tuple(catalogue_cases(tests, targets))
        yield "junit.xml", written("junit", "catalogue", cases, ExitCode.AS_EXPECTED, in_force)


def draw_matrix(tests: Sequence[str], targets: Targets, in_force: Sequence[str] = ()) -> Any:
    """Draw tests over scenarios and gaps, and below it the number of tests of each class."""
    scenarios, classes = kinds(targets).values()
    gaps = [x for x in targets.gaps.targets if x.tested or x.possible]
    bars = {"tests of each class (red: none)": classes}
    bars |= {
        "tests of each class of gaps (red: none)": [*targets.gaps.targets] if targets.gaps.required else []
    }
    bars = {title: those for title, those in bars.items() if those}
    columns = [*scenarios, *gaps]
    names = [f"{number_in(x.name)} {x.words}" for x in scenarios]
    names += [x.name.removeprefix(PREFIX).replace("_", " ") + " (gap)" for x in gaps]
    labels = _INCH_A_LETTER * max(map(len, names), default=0)
    heights = [0.16 * len(tests) + labels + 1.2, *(2.2 + 0.6 * ("gaps" in title) for title in bars)]
    longest = max(map(len, bars.values()), default=0)
    beside = 0.055 * min(MOST_WHY, max(map(len, targets.wrong.values()), default=0))
    width = max(7.0, 1.5 + 0.26 * len(columns) + beside, 1.0 + 0.15 * longest)
    figure, axes = make_figure(heights, width=width)
    above = axes[0]
    for x, target in enumerate(columns):
        for y, test in enumerate(tests):
            mark = _mark(test, target)
            if mark:
                above.scatter(x, y, s=26, marker="s", color=_SURE if mark == "x" else _POSSIBLE)
    if gaps:
        above.axvline(len(scenarios) - 0.5, color="#888888", lw=0.8)
    above.xaxis.tick_top()  # before labels have colours, since it draws others
    above.set_xticks(range(len(columns)), names, fontsize=7, rotation=90)
    for label, target in zip(above.get_xticklabels(), columns, strict=True):
        label.set_color("black" if target.tested else _NONE)
    above.set_yticks(range(len(tests)), tests, fontsize=6)
    wrong = targets.wrong
    for y, (label, test) in enumerate(zip(above.get_yticklabels(), tests, strict=True)):
        if test in wrong:
            label.set_color(_NONE)
            place = (len(columns) - 0.2, y)
            above.text(*place, excerpt(wrong[test], MOST_WHY), fontsize=5.5, color=_NONE, va="center")
    above.grid(color="#eeeeee", lw=0.6)
    above.set_axisbelow(True)
    above.set_ylim(len(tests) - 0.5, -0.5)
    above.set_xlim(-0.6, len(columns) - 0.4)
    title = "scenarios, gaps and tests; red: not tested, not what it claims; light: by some drives of it only"
    above.set_title("\n".join([title, *in_force]), fontsize=8)
    for below, (title, those) in zip(axes[1:], bars.items(), strict=True):
        _draw_bars(below, title, those)
    return figure


def _draw_bars(axes: Any, title: str, targets: Sequence[TargetData]) -> None:
    """Draw the number of tests of each target."""
    counts = [len(x.tested) for x in targets]
    axes.bar(range(len(targets)), counts, color=_SURE, width=0.8)
    missing = [k for k, count in enumerate(counts) if not count]
    axes.scatter(missing, [0] * len(missing), marker="x", s=16, color=_NONE, zorder=3)
    labels = [x.name.removeprefix("class_").removeprefix(PREFIX).replace("_", " ") for x in targets]
    axes.set_xticks(range(len(targets)), labels, fontsize=5, rotation=90)
    axes.set_xlim(-0.8, len(targets) - 0.2)
    count_axis(axes.yaxis)
    axes.tick_params(axis="y", labelsize=7)
    axes.set_title(title, fontsize=8)
