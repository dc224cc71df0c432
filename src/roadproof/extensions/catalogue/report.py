"""What a catalogue tests, to look at: lines, a table for a spreadsheet, a report for CI, a matrix."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from functools import partial
from itertools import groupby
from textwrap import indent
from typing import Any

from roadproof.extensions.catalogue.cases import catalogue_cases
from roadproof.extensions.catalogue.gaps import PREFIX
from roadproof.extensions.catalogue.kept import Figure, Remark, Target
from roadproof.extensions.catalogue.ranges import Span
from roadproof.extensions.catalogue.tested import CLASSES, SCENARIOS, Targets, kind_of
from roadproof.extensions.catalogue.view import CatalogueView
from roadproof.extensions.drivers.models import MODELS
from roadproof.extensions.traffic.evaluate.decisions import Decision, said
from roadproof.frontends.api.build_result import formats, written
from roadproof.frontends.report.figures import count_axis, make_figure
from roadproof.frontends.report.sheet import Column, Mark, Sheet, csv_text
from roadproof.frontends.report.sheet import as_csv as csv_of
from roadproof.library.scenarios import number_in
from roadproof.runtime.files import utf8
from roadproof.verdict import ExitCode, Verdict

MOST_TOLD, MOST_ALIKE = 40, 8
_STARTS = ("Ve0", "dV0", "Vf0", "Vy", "Gx", "headway", "dx0", "dx0_f", "dy0")


def driver_lines(decisions: Sequence[tuple[str, Decision]]) -> Iterator[str]:
    """How often each model comes to which side, and a line for each test and scenario.

    Of many tests only those are told that some model does not prevent.
    """
    if not decisions:
        return
    yield "driver models in place of SV, in the test's own motion:"
    for model in MODELS:
        sides = [x.side for _, x in decisions if x.driver == model]
        if sides:
            told = ", ".join(f"{sides.count(side)} {side}" for side in dict.fromkeys(sides))
            yield f"  {model} ({MODELS[model].title}): {told}"
    groups = groupby(decisions, lambda x: (x[0], x[1].scenario))
    every = [(test, scenario, [x for _, x in those]) for (test, scenario), those in groups]
    hit = [x for x in every if any(y.side in ("unpreventable", "partly") for y in x[2])]
    told_of = (every if len(every) <= MOST_ALIKE else hit)[:MOST_TOLD]
    yield from (line for x in told_of for line in _lines_of_test(*x))
    if len(told_of) < len(every):
        yield f"  … {len(every) - len(told_of)} more in drivers.csv (--out)"


def _lines_of_test(test: str, scenario: str, those: Sequence[Decision]) -> Iterator[str]:
    """The sides of all models in one line, and below it each reason with its models."""
    yield f"  {test} {scenario}: " + ", ".join(f"{x.driver} {said(x)}" for x in those)
    for reason in dict.fromkeys(x.reason for x in those if x.reason):
        models = [x.driver for x in those if x.reason == reason]
        whose = "" if len(models) == len(those) else f"{', '.join(models)}: "
        yield f"    {whose}{reason}"


def drivers_csv(decisions: Sequence[tuple[str, Decision]]) -> str:
    """A row for each test, scenario and model; of the state when the manoeuvre begins in SI units."""
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


_SURE, _POSSIBLE, _NONE = "#1f5fbf", "#9dbbe3", "#b5473c"
_INCH_A_LETTER = 0.06  # of labels at 7 points


def as_text(
    tests: int, found: Targets, notes: Sequence[str], counted: Sequence[Figure], drivers: Iterable[str] = ()
) -> str:
    """How much is tested, in ``counted`` figures, what is missing, and every remark.

    ``drivers``: lines on what becomes of tests under driver models.
    """
    lines = [f"{tests} test{'s' * (tests != 1)}", *_figures(counted), *_gaps(found), *drivers]
    lines += _listed("not tested", [f"{x.name}: {x.words}" for x in found.missing])
    for heading, remarks in headings(found).items():
        lines += _listed(heading, [f"{' and '.join(x.tests)}: {x.told}" for x in remarks])
    return "\n".join([*lines, *(f"note: {x}" for x in notes), _summary(found)])


def kinds(found: Targets) -> dict[str, list[Target]]:
    """The targets by what they are."""
    return {kind: [x for x in found.targets if kind_of(x.name) == kind] for kind in (SCENARIOS, CLASSES)}


def _figures(counted: Sequence[Figure]) -> Iterator[str]:
    """A line a figure, those of road sectors below; which spec set, where there are several."""
    sets = dict.fromkeys(x.set_name for x in counted)
    for x in counted:
        where = f"set {x.set_name}, " if len(sets) > 1 and not x.sector else ""
        what = f"  {x.sector.replace('_', ' and ')}" if x.sector else f"{where}{x.kind}"
        yield f"{what}: {x.tested} of {x.total} are tested"


def _gaps(found: Targets) -> Iterator[str]:
    """What is known of gaps beyond figures."""
    gaps = found.gaps
    if gaps.empty:
        yield f"classes of gaps that are proved empty: {len(gaps.empty)}"
    if not gaps.asked and any(x.tested or x.possible for x in gaps.targets):
        shown = sum(bool(x.tested) for x in gaps.targets)
        yield f"classes of gaps: {shown} of {gaps.total} are shown (--gaps: which others there are)"


def range_lines(spans: Sequence[Span], horizon: Fraction) -> Iterator[str]:
    """What part of the ranges nobody tests, a line a number, and within which limits that is."""
    if spans:
        yield (
            f"how tests begin, of how drives can that were found ({horizon} s of driving, cars, at most 80 m "
            "apart at the start):"
        )
    for name in dict.fromkeys(x.target for x in spans):
        yield f"  {name}"
        for x in (y for y in spans if y.target == name):
            tested, can = (f"{low:.4g} to {high:.4g}" for low, high in (x.tested, x.reached))
            yield f"    {x.term}: {tested} of {can} {x.unit}; {x.share:.0%} is not tested"


def tables(result: CatalogueView) -> dict[str, bytes]:
    """The tables beside an index, by file name."""
    tests = tuple(x.id for x in result.catalogue.entries)
    found, in_force = result.tested, result.in_force
    made = {
        "matrix.csv": as_csv(tests, found, in_force),
        "figures.csv": figures_csv(result.figures),
        "drivers.csv": drivers_csv(result.decisions),
        **dict(build_results(tests, found, in_force)),
    }
    return {name: utf8(text) for name, text in made.items()}


def figures_csv(counted: Sequence[Figure]) -> str:
    """The figures as a table."""
    columns: tuple[Column[Figure], ...] = (
        Column("set", lambda x: x.set_name),
        Column("kind", lambda x: x.kind),
        Column("sector", lambda x: x.sector),
        Column("tested", lambda x: x.tested),
        Column("total", lambda x: x.total),
    )
    return csv_of(Sheet(columns, counted))


def sheet_of(
    targets: Sequence[Target], verdicts: Mapping[str, Verdict], possible: bool = True
) -> Sheet[Target]:
    """An entry for each scenario, class and class of gaps; those without a verdict are covered.

    ``possible``: whether pages show which tests show it on some drives only.
    """

    def verdict(x: Target) -> Verdict:
        return verdicts.get(x.name, Verdict.COVERED)

    def mark(x: Target) -> Mark:
        if verdict(x) is not Verdict.COVERED:
            return Mark("✗ not tested", "against")
        count = len(x.tested)
        return Mark(f"✓ {count} test{'s' * (count != 1)}", "proof") if count else Mark("– none", "none")

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
                "some of whose drives do",
            ),
        ),
        targets,
    )


def headings(found: Targets) -> dict[str, Sequence[Remark]]:
    """The remarks under what is wrong."""
    return {
        "readers contradict each other": found.contradictions,
        "not what they claim": found.faults,
        "in doubt": found.doubts,
        "say the same": found.alike,
    }


def _listed(heading: str, lines: Sequence[str]) -> Iterator[str]:
    if lines:
        yield f"{heading}:"
        yield from (indent(line, "  ") for line in lines[:MOST_TOLD])
        if len(lines) > MOST_TOLD:
            yield f"  … {len(lines) - MOST_TOLD} more"


def _summary(found: Targets) -> str:
    wrong = [
        f"{len(those)} {word}"
        for those, word in (
            (found.missing, "not tested"),
            (found.faults, "not what they claim"),
            (found.doubts, "in doubt"),
            (found.contradictions, "contradicting"),
        )
        if those
    ]
    return ", ".join(wrong) or "complete"


def as_csv(tests: Sequence[str], found: Targets, in_force: Sequence[str] = ()) -> str:
    """A row a test, a column a scenario, class or gap: ``x`` shown or implied, ``o`` by some drives of it.

    ``in_force``: what was asked otherwise than by default, which the first cell says.
    """
    header = ["; ".join(["test", *in_force]), *(x.name for x in found.all_targets)]
    return csv_text(header, ([test, *(_mark(test, x) for x in found.all_targets)] for test in tests))


def _mark(test: str, target: Target) -> str:
    return "x" if test in target.tested else "o" if test in target.possible else ""


def build_results(
    tests: Sequence[str], found: Targets, in_force: Sequence[str] = ()
) -> Iterator[tuple[str, str]]:
    """Yield ``junit.xml`` where JUnit XML is installed: a suite of the tests, and one of all targets.

    ``in_force``: what was asked otherwise than by default, a property of each suite.
    """
    if "junit" in formats():
        cases = tuple(catalogue_cases(tests, found))
        yield "junit.xml", written("junit", "catalogue", cases, ExitCode.AS_EXPECTED, in_force)


def draw_matrix(tests: Sequence[str], found: Targets, in_force: Sequence[str] = ()) -> Any:
    """Tests over scenarios and gaps; how many tests each class has, and each class of gaps, if asked."""
    scenarios, classes = kinds(found).values()
    gaps = [x for x in found.gaps.targets if x.tested or x.possible]
    bars = {"tests of each class (red: none)": classes}
    bars |= {"tests of each class of gaps (red: none)": [*found.gaps.targets] if found.gaps.asked else []}
    bars = {title: those for title, those in bars.items() if those}
    columns = [*scenarios, *gaps]
    names = [f"{number_in(x.name)} {x.words}" for x in scenarios]
    names += [x.name.removeprefix(PREFIX).replace("_", " ") + " (gap)" for x in gaps]
    labels = _INCH_A_LETTER * max(map(len, names), default=0)
    heights = [0.16 * len(tests) + labels + 1.2, *(2.2 + 0.6 * ("gaps" in title) for title in bars)]
    longest = max(map(len, bars.values()), default=0)
    width = max(7.0, 1.5 + 0.26 * len(columns), 1.0 + 0.15 * longest)
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
    wrong = {test for x in (*found.faults, *found.contradictions) for test in x.tests}
    for label, test in zip(above.get_yticklabels(), tests, strict=True):
        label.set_color(_NONE if test in wrong else "black")
    above.grid(color="#eeeeee", lw=0.6)
    above.set_axisbelow(True)
    above.set_ylim(len(tests) - 0.5, -0.5)
    above.set_xlim(-0.6, len(columns) - 0.4)
    title = "scenarios, gaps and tests; red: not tested, not what it claims; light: by some drives of it only"
    above.set_title("\n".join([title, *in_force]), fontsize=8)
    for below, (title, those) in zip(axes[1:], bars.items(), strict=True):
        _draw_bars(below, title, those)
    return figure


def _draw_bars(axes: Any, title: str, targets: Sequence[Target]) -> None:
    """How many tests each target has."""
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
