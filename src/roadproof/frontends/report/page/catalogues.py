"""A catalogue of tests on the page: what is tested, a matrix, and behind each cell what a test shows."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

from roadproof.evidence.answers.catalogue_index import (
    AbstractTest,
    ConcreteTest,
    Index,
    KeptFact,
    Range,
    Remark,
    Target,
)
from roadproof.evidence.answers.coverage import KeptClass
from roadproof.evidence.codec import read
from roadproof.evidence.drive_file import DriveFile
from roadproof.frontends.report.page.catalogue_facts import decisions, provenance
from roadproof.frontends.report.page.markup import Content, Markup, joined, table, tag
from roadproof.frontends.report.page.page_context import PageContext
from roadproof.frontends.report.page.pieces import cell, evidence_of, folded, matrix, short, verdict
from roadproof.frontends.report.page.results import Result
from roadproof.frontends.report.viewer_data import ShownFormula
from roadproof.library.scenarios import danger_comes, number_in, roles

MOST_FORMULAS = 6


def catalogue(result: Result, context: PageContext, words: Mapping[int, str]) -> Markup:
    """What tests show: a row for each situation, a matrix of tests, and what is odd about them."""
    data = read(Index, result.data, result.name)
    gaps, wanted, tests, facts = data.gaps, data.targets, data.tests, data.facts
    targets = (*wanted, *gaps.targets)
    missing = {*data.not_tested}
    rows = [_situation(x, x.name in missing) for x in targets]
    asked = targets if gaps.asked else wanted
    lacking = sum(x.name in missing for x in asked)
    told = f"{_counted(len(tests), 'test')}; {lacking} of {len(asked)} situations are tested by none."
    some = any(x.possible for x in targets)
    head = ("", "what", "in words", "tests that show it", *("some of whose drives do",) * some)
    driver = data.prevention
    if driver is not None:
        begun = ", ".join(map(str, driver.scenarios)) or "no scenario"
        told += (
            f" Asked of what begins {driver.side} for the driver model {driver.driver}: scenarios {begun}."
        )
        told += " Formulas of tests mean what the library says."
    parts: list[Content] = [tag("p", told), table(head, [row[: len(head)] for row in rows])]
    columns = [tag("th", tag("span", x.name), scope="col", class_="turned") for x in targets]
    cells = [_row(result, k, x, targets, facts) for k, x in enumerate(tests)]
    said = (
        "■ it shows the situation, ✓ all of its drives do, by proof, ○ some of them do, ✗ it claims it and "
    )
    said += "does not show it. Each cell leads to the drive or the proof, and so does the name of the test."
    parts += [tag("h3", "Each test and what it shows"), tag("p", said), matrix(columns, cells)]
    for heading, remarks in _remarks(data).items():
        listed = tag("ul", *(tag("li", short(x, 2000)) for x in remarks))
        parts += [tag("h3", heading), listed] if remarks else []
    parts += decisions(data.decisions)
    parts += _ranges(data.ranges)
    parts += [tag("h3", "The tests")] if tests else []
    for k, x in enumerate(tests):
        parts.append(_test(result, data, k, [y for y in facts if y.test == x.id], context))
    known = {x.id for x in tests}
    parts += [_fact(x, result, context) for x in facts if x.test not in known]
    parts += [_gap(x, result, context) for x in gaps.classes]
    return joined([*parts, *provenance(data, context)])


def _remarks(data: Index) -> dict[str, list[str]]:
    """What is to be said of tests, by heading."""
    return {
        "Not what they claim": [*map(_remark, data.faults)],
        "In doubt": [*map(_remark, data.doubts)],
        "Say the same": [*map(_remark, data.alike)],
        "Seen although it is proved never to be": [*map(_remark, data.contradictions)],
        "Notes": [*data.notes],
    }


def _remark(x: Remark) -> str:
    return f"{' and '.join(x.tests)}: {short(x.told, 2000)}"


def _counted(count: int, word: str) -> str:
    return f"{count} {word}{'s' if count != 1 else ''}"


def _situation(x: Target, lacks: bool) -> list[Content]:
    needless = not x.tested and not lacks
    said = "✗ not tested" if lacks else "– none" if needless else f"✓ {_counted(len(x.tested), 'test')}"
    kind = "against" if lacks else "none" if needless else "proof"
    word = tag("span", said, class_=f"verdict-word {kind}")
    return [word, x.name, x.words, short(x.tested, 2000), short(x.possible, 2000)]


def _id(result: Result, place: int) -> str:
    return f"test-{result.id}-{place}"


def _row(
    result: Result,
    place: int,
    test: ConcreteTest | AbstractTest,
    targets: Sequence[Target],
    facts: Sequence[KeptFact],
) -> list[Content]:
    """The cells of a test, which lead to what is behind it."""
    name, link, is_file = test.id, _id(result, place), isinstance(test, ConcreteTest)
    excluded = {x.other for x in facts if x.test == name and x.relation == "excludes"}
    empty = any(x.test == name and x.relation == "empty" for x in facts)
    shown = {x.what for x in test.shown} if isinstance(test, ConcreteTest) else set()
    head = tag("th", tag("a", name, href=f"#{link}"), scope="row", title=test.title)
    cells: list[Content] = [head]
    for x in targets:
        what = x.name
        if what in shown:
            cells.append(cell("WITNESSED", f"{name} shows {what}", link))
        elif name in x.tested:
            cells.append(cell("PROVED", f"all drives of {name} show {what}: that is proved", link))
        elif name in x.possible:
            cells.append(cell("NONE-WITHIN", f"some drives of {name} show {what}", link))
        elif what in test.claims and (is_file or what in excluded or empty):
            cells.append(cell("REFUTED", f"{name} says that it is {what}, and does not show it", link))
        elif what in test.claims:
            cells.append(
                cell("UNKNOWN", f"{name} says that it is {what}, and nobody knows whether it can", link)
            )
        else:
            cells.append(tag("td"))
    return cells


def _test(result: Result, data: Index, place: int, facts: Sequence[KeptFact], context: PageContext) -> Markup:
    """One test: what it is and claims; its drive with what it shows, or what is proved of its formula."""
    x = data.tests[place]
    summary = (tag("b", x.id), f" {x.title}" if x.title else "")
    inside: list[Content] = []
    inside += [tag("p", "claims ", short(x.claims))] if x.claims else []
    if isinstance(x, AbstractTest):
        inside += [tag("p", tag("code", x.formula))]
    else:
        inside += [tag("pre", x.fault, class_="wrong")] if x.fault else []
        shown = [(y.what, ", ".join(y.vehicles), y.lane, y.at) for y in x.shown]
        inside += [table(("shows", "vehicles", "L", "from (s)"), shown)] if shown else []
        inside += [] if x.fault else [_drive(data, x, context)]
    return folded(summary, *inside, *(_fact(y, result, context) for y in facts), id=_id(result, place))


def _drive(data: Index, x: ConcreteTest, context: PageContext) -> Markup:
    """The drive of a test with the scenarios that it is said to show, judged for the page."""
    path = Path(x.file)
    if not x.dense:
        return tag("p", f"Monitored on the samples of {path}; there is no drive.", class_="faint")
    if not path.is_file():
        told = f"Its drive is {path}, which is not there: make the page where the catalogue was asked for."
        return tag("p", told, class_="faint")
    scenarios = [y for y in x.shown if number_in(y.what) is not None][:MOST_FORMULAS]
    lanes = {y.lane: f"L{k}" for k, y in enumerate(scenarios)}
    set_name = data.set.partition(",")[0]
    values = {name: Fraction(v) for name, v in data.parameters.items()}

    def put(file: DriveFile) -> DriveFile:
        """The drive in the definitions and at the values of the catalogue."""
        named = {**file.lanes, **{v: k for k, v in lanes.items()}}
        return replace(file, set_name=set_name, options=data.options, values=values, lanes=named)

    since = [float(y.at) for y in scenarios]
    asked = []
    for k, y in enumerate(scenarios):
        first, *others = y.vehicles
        group = others[0] if len(others) == 1 else f"{{{', '.join(others)}}}"
        text = f"{y.what}({first}, {group}, {lanes[y.lane]})"
        asked.append(ShownFormula("watch" if k else "question", text))
    if not asked:
        home = context.library.select(set_name)
        asked, since = [ShownFormula("question", danger_comes(home, *roles(2)).text)], []
    return context.drive(path, put=put, asked=asked, since=since)


def _fact(x: KeptFact, result: Result, context: PageContext) -> Markup:
    told = f" {x.test} {_RELATIONS.get(x.relation, x.relation)} {x.other} ".replace("  ", " ")
    inside: list[Content] = [tag("p", x.reason)] if x.reason else []
    return folded(
        (verdict(x.verdict), told, tag("code", short(x.formula))),
        *inside,
        *evidence_of(result, context, x.drive, x.certificate),
    )


_RELATIONS = {"runs": "can be run", "empty": "can never be run", "reaches": "reaches", "open": "is open:"}


def _gap(x: KeptClass, result: Result, context: PageContext) -> Markup:
    """A class of gaps that no test shows: a drive of it, or a proof that there is none."""
    inside: list[Content] = [tag("p", tag("code", x.claim))] if x.claim else []
    inside += [tag("p", x.reason)] if x.reason else []
    inside += [part for y in x.gaps for part in evidence_of(result, context, y.drive)]
    summary = (verdict(x.verdict), f" gap, scenario {x.scenario}: {x.description}")
    return folded(summary, *inside, *evidence_of(result, context, None, x.certificate))


def _ranges(found: Sequence[Range]) -> list[Content]:
    if not found:
        return []
    rows = [
        [*map(short, (x.target, x.term, x.tested, x.reached, x.untested)), f"{100 * x.share:.0f} %"]
        for x in found
    ]
    head = ("what", "at the start", "tested", "reached", "untested", "of the range")
    return [tag("h3", "What of the range of each is tested"), table(head, rows)]
