"""What a catalogue tests, to look at: lines, a table for a spreadsheet, a report for CI, a matrix."""

import csv
import io
from collections.abc import Iterator, Sequence
from xml.etree import ElementTree as xml

from roadproof.analysis.catalogue.tested import Remark, Target, Tested
from roadproof.report.figures import as_bytes, make_figure
from roadproof.spec.scenarios import number_in

MOST_TOLD = 40
_SURE, _POSSIBLE, _NONE = "#1f5fbf", "#9dbbe3", "#b5473c"


def as_text(tests: int, found: Tested, notes: Sequence[str]) -> str:
    """How much is tested, what is missing, and every remark."""
    lines = [f"{tests} test{'s' * (tests != 1)}"]
    for kind, those in kinds(found).items():
        lines += [_counted(kind, those), *_by_sector(those)] if those else []
    lines += _listed("not tested", [f"{x.name}: {x.words}" for x in found.missing])
    for heading, remarks in headings(found).items():
        lines += _listed(heading, [remark_line(x) for x in remarks])
    return "\n".join([*lines, *(f"note: {x}" for x in notes), _summary(found)])


def kinds(found: Tested) -> dict[str, list[Target]]:
    """The targets by what they are."""
    scenarios = [x for x in found.targets if number_in(x.name) is not None]
    return {"scenarios": scenarios, "classes": [x for x in found.targets if x not in scenarios]}


def _counted(kind: str, targets: Sequence[Target]) -> str:
    done = sum(bool(x.tested) for x in targets)
    return f"{kind}: {done} of {len(targets)} are tested"


def _by_sector(targets: Sequence[Target]) -> list[str]:
    """A line for each road sector, where there are several."""
    sectors = dict.fromkeys(x.sector for x in targets if x.sector)
    return [_counted(f"  {x.replace('_', ' and ')}", [y for y in targets if y.sector == x]) for x in sectors]


def headings(found: Tested) -> dict[str, Sequence[Remark]]:
    """The remarks under what is wrong."""
    return {
        "readers contradict each other": found.contradictions,
        "not what they claim": found.faults,
        "in doubt": found.doubts,
        "say the same": found.alike,
    }


def remark_line(remark: Remark) -> str:
    return f"{' and '.join(remark.tests)}: {remark.told}"


def _listed(heading: str, lines: Sequence[str]) -> Iterator[str]:
    if lines:
        yield f"{heading}:"
        yield from (f"  {line}" for line in lines[:MOST_TOLD])
        if len(lines) > MOST_TOLD:
            yield f"  … {len(lines) - MOST_TOLD} more"


def _summary(found: Tested) -> str:
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


def as_csv(tests: Sequence[str], found: Tested) -> str:
    """A row a test, a column a scenario or class: ``x`` shown or implied, ``o`` by some drives of it."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(["test", *(x.name for x in found.targets)])
    for test in tests:
        writer.writerow([test, *(_mark(test, x) for x in found.targets)])
    return out.getvalue()


def _mark(test: str, target: Target) -> str:
    return "x" if test in target.tested else "o" if test in target.possible else ""


def as_junit(tests: Sequence[str], found: Tested) -> str:
    """A suite of the tests, which fail where they are not what they claim, and one of all targets."""
    suites = xml.Element("testsuites", name="roadproof catalogue")
    wrong = {x.tests[0]: x.told for x in (*found.doubts, *found.faults, *found.contradictions)}
    _suite(suites, "tests", {test: wrong.get(test, "") for test in tests})
    _suite(suites, "tested", {x.name: "" if x.tested else f"no test shows {x.words}" for x in found.targets})
    xml.indent(suites)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + xml.tostring(suites, "unicode") + "\n"


def _suite(suites: xml.Element, name: str, cases: dict[str, str]) -> None:
    failures = sum(bool(told) for told in cases.values())
    suite = xml.SubElement(suites, "testsuite", name=name, tests=str(len(cases)), failures=str(failures))
    for case, told in cases.items():
        element = xml.SubElement(suite, "testcase", classname=name, name=case)
        if told:
            xml.SubElement(element, "failure", message=told)


def draw_matrix(tests: Sequence[str], found: Tested) -> dict[str, bytes]:
    """Tests over scenarios, and how many tests each class has: ``{"png": …, "svg": …}``."""
    scenarios, classes = kinds(found).values()
    heights = [0.16 * len(tests) + 3.4] + ([2.2] if classes else [])
    width = max(7.0, 1.5 + 0.26 * len(scenarios), 1.0 + 0.15 * len(classes))
    figure, axes = make_figure(heights, width=width)
    above = axes[0]
    for x, target in enumerate(scenarios):
        for y, test in enumerate(tests):
            mark = _mark(test, target)
            if mark:
                above.scatter(x, y, s=26, marker="s", color=_SURE if mark == "x" else _POSSIBLE)
    names = [f"{number_in(x.name)} {x.words}" for x in scenarios]
    above.set_xticks(range(len(scenarios)), names, fontsize=7, rotation=90)
    for label, target in zip(above.get_xticklabels(), scenarios, strict=True):
        label.set_color("black" if target.tested else _NONE)
    above.set_yticks(range(len(tests)), tests, fontsize=6)
    wrong = {test for x in (*found.faults, *found.contradictions) for test in x.tests}
    for label, test in zip(above.get_yticklabels(), tests, strict=True):
        label.set_color(_NONE if test in wrong else "black")
    above.grid(color="#eeeeee", lw=0.6)
    above.set_axisbelow(True)
    above.set_ylim(len(tests) - 0.5, -0.5)
    above.set_xlim(-0.6, len(scenarios) - 0.4)
    above.xaxis.tick_top()
    above.set_title(
        "scenarios, and tests; red: not tested, not what it claims; light: by some drives of it only",
        fontsize=8,
    )
    if classes:
        below, counts = axes[1], [len(x.tested) for x in classes]
        below.bar(range(len(classes)), counts, color=_SURE, width=0.8)
        missing = [k for k, count in enumerate(counts) if not count]
        below.scatter(missing, [0] * len(missing), marker="x", s=16, color=_NONE, zorder=3)
        labels = [x.name.removeprefix("class_").replace("_", " ") for x in classes]
        below.set_xticks(range(len(classes)), labels, fontsize=5, rotation=90)
        below.set_xlim(-0.8, len(classes) - 0.2)
        below.yaxis.get_major_locator().set_params(integer=True)
        below.tick_params(axis="y", labelsize=7)
        below.set_title("tests of each class (red: none)", fontsize=8)
    return as_bytes(figure)
