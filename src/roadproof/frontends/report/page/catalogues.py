"""A catalogue of tests on the page: what is tested, a matrix, and behind each cell what a test shows."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

from roadproof.evidence.drive_file import DriveFile
from roadproof.frontends.report.page.catalogue_facts import decisions, provenance
from roadproof.frontends.report.page.markup import Content, Markup, joined, table, tag
from roadproof.frontends.report.page.page_context import PageContext
from roadproof.frontends.report.page.pieces import behind, cell, folded, matrix, short, verdict
from roadproof.frontends.report.page.results import Result
from roadproof.frontends.report.viewer_data import ShownFormula
from roadproof.library.scenarios import danger_comes, number_in, roles

MOST_FORMULAS = 6


def catalogue(result: Result, book: PageContext, words: Mapping[int, str]) -> Markup:
    """What tests show: a row for each situation, a matrix of tests, and what is odd about them."""
    data = result.data
    gaps = data.get("gaps") or {}
    wanted, others = [*data.get("targets", ())], [*(gaps.get("targets") or ())]
    targets, tests = [*wanted, *others], data.get("tests", ())
    missing = {*data.get("not_tested", ())}
    rows = [_situation(x, x.get("name") in missing) for x in targets]
    asked = targets if gaps.get("asked") else wanted
    lacking = sum(x.get("name") in missing for x in asked)
    told = f"{_counted(len(tests), 'test')}; {lacking} of {len(asked)} situations are tested by none."
    some = any(x.get("possible") for x in targets)
    head = ("", "what", "in words", "tests that show it", *("some of whose drives do",) * some)
    driver = data.get("prevention")
    if isinstance(driver, Mapping):
        begin = f"{driver.get('side')} for the driver model {driver.get('driver')}"
        begun = ", ".join(map(str, driver.get("scenarios") or ())) or "no scenario"
        told += f" Asked of what begins {begin}: scenarios {begun}."
        told += " Formulas of tests mean what the library says."
    parts: list[Content] = [tag("p", told), table(head, [row[: len(head)] for row in rows])]
    names = [str(x.get("name")) for x in targets]
    columns = [tag("th", tag("span", name), scope="col", class_="turned") for name in names]
    facts = data.get("facts", ())
    cells = [_row(result, k, x, targets, facts) for k, x in enumerate(tests)]
    said = (
        "■ it shows the situation, ✓ all of its drives do, by proof, ○ some of them do, ✗ it claims it and "
    )
    said += "does not show it. Each cell leads to the drive or the proof, and so does the name of the test."
    parts += [tag("h3", "Each test and what it shows"), tag("p", said), matrix(columns, cells)]
    for name, heading in _REMARKS.items():
        listed = tag("ul", *(tag("li", _remark(x)) for x in data.get(name) or ()))
        parts += [tag("h3", heading), listed] if data.get(name) else []
    parts += decisions(data.get("decisions") or ())
    parts += _ranges(data.get("ranges") or ())
    parts += [tag("h3", "The tests")] if tests else []
    for k, x in enumerate(tests):
        parts.append(_test(result, k, x, [y for y in facts if y.get("test") == x.get("id")], book))
    known = {x.get("id") for x in tests}
    parts += [_fact(x, result, book) for x in facts if x.get("test") not in known]
    parts += [_gap(x, result, book) for x in gaps.get("classes") or ()]
    return joined([*parts, *provenance(data, book)])


_REMARKS = {
    "faults": "Not what they claim",
    "doubts": "In doubt",
    "alike": "Say the same",
    "contradictions": "Seen although it is proved never to be",
    "notes": "Notes",
}


def _counted(count: int, word: str) -> str:
    return f"{count} {word}{'s' if count != 1 else ''}"


def _situation(x: Mapping[str, Any], lacks: bool) -> list[Content]:
    tested = x.get("tested", ())
    needless = not tested and not lacks
    said = "✗ not tested" if lacks else "– none" if needless else f"✓ {_counted(len(tested), 'test')}"
    kind = "against" if lacks else "none" if needless else "proof"
    word = tag("span", said, class_=f"verdict-word {kind}")
    return [word, x.get("name"), x.get("words"), short(tested, 2000), short(x.get("possible"), 2000)]


def _remark(x: Any) -> str:
    if not isinstance(x, Mapping):
        return short(x, 2000)
    return f"{' and '.join(map(str, x.get('tests', ())))}: {short(x.get('told'), 2000)}"


def _id(result: Result, place: int) -> str:
    return f"test-{result.id}-{place}"


def _row(
    result: Result,
    place: int,
    test: Mapping[str, Any],
    targets: Sequence[Mapping[str, Any]],
    facts: Sequence[Mapping[str, Any]],
) -> list[Content]:
    """The cells of a test, which lead to what is behind it."""
    name, link = test.get("id"), _id(result, place)
    excluded = {x.get("other") for x in facts if x.get("test") == name and x.get("relation") == "excludes"}
    empty = any(x.get("test") == name and x.get("relation") == "empty" for x in facts)
    shown = {x.get("what") for x in test.get("shown", ())}
    claims = test.get("claims") or ()
    head = tag("th", tag("a", name, href=f"#{link}"), scope="row", title=test.get("title"))
    cells: list[Content] = [head]
    for x in targets:
        what = x.get("name")
        if what in shown:
            cells.append(cell("WITNESSED", f"{name} shows {what}", link))
        elif name in x.get("tested", ()):
            cells.append(cell("PROVED", f"all drives of {name} show {what}: that is proved", link))
        elif name in x.get("possible", ()):
            cells.append(cell("NONE-WITHIN", f"some drives of {name} show {what}", link))
        elif what in claims and ("file" in test or what in excluded or empty):
            cells.append(cell("REFUTED", f"{name} says that it is {what}, and does not show it", link))
        elif what in claims:
            cells.append(
                cell("UNKNOWN", f"{name} says that it is {what}, and nobody knows whether it can", link)
            )
        else:
            cells.append(tag("td"))
    return cells


def _test(
    result: Result, place: int, x: Mapping[str, Any], facts: Sequence[Mapping[str, Any]], book: PageContext
) -> Markup:
    """One test: what it is and claims; its drive with what it shows, or what is proved of its formula."""
    summary = (tag("b", x.get("id")), f" {x['title']}" if x.get("title") else "")
    inside: list[Content] = []
    inside += [tag("p", "claims ", short(x["claims"]))] if x.get("claims") else []
    inside += [tag("pre", x["fault"], class_="wrong")] if x.get("fault") else []
    inside += [tag("p", tag("code", x["formula"]))] if x.get("formula") else []
    shown = [
        (y.get("what"), ", ".join(y.get("vehicles", ())), y.get("lane"), y.get("at"))
        for y in x.get("shown", ())
    ]
    inside += [table(("shows", "vehicles", "L", "from (s)"), shown)] if shown else []
    if "file" in x and not x.get("fault"):
        inside.append(_drive(result, x, book))
    return folded(summary, *inside, *(_fact(y, result, book) for y in facts), id=_id(result, place))


def _drive(result: Result, x: Mapping[str, Any], book: PageContext) -> Markup:
    """The drive of a test with the scenarios that it is said to show, judged for the page."""
    path = Path(str(x["file"]))
    if not x.get("dense"):
        return tag("p", f"Monitored on the samples of {path}; there is no drive.", class_="faint")
    if not path.is_file():
        told = f"Its drive is {path}, which is not there: make the page where the catalogue was asked for."
        return tag("p", told, class_="faint")
    scenarios = [y for y in x.get("shown", ()) if number_in(str(y.get("what"))) is not None][:MOST_FORMULAS]
    lanes = {str(y.get("lane")): f"L{k}" for k, y in enumerate(scenarios)}
    set_name = str(result.data.get("set") or "base").partition(",")[0]

    readings = {str(k): str(v) for k, v in (result.data.get("options") or {}).items()}
    values = {str(k): Fraction(v) for k, v in (result.data.get("parameters") or {}).items()}

    def put(file: DriveFile) -> DriveFile:
        """The drive in the definitions and at the values of the catalogue."""
        named = {**file.lanes, **{v: k for k, v in lanes.items()}}
        return replace(file, set_name=set_name, options=readings, values=values, lanes=named)

    since = [float(y.get("at") or 0) for y in scenarios]
    asked = []
    for k, y in enumerate(scenarios):
        first, *others = map(str, y.get("vehicles", ()))
        group = others[0] if len(others) == 1 else f"{{{', '.join(others)}}}"
        text = f"{y['what']}({first}, {group}, {lanes[str(y.get('lane'))]})"
        asked.append(ShownFormula("watch" if k else "question", text))
    if not asked:
        home = book.library.select(set_name)
        asked, since = [ShownFormula("question", danger_comes(home, *roles(2)).text)], []
    return book.drive(path, put=put, asked=asked, since=since)


def _fact(x: Mapping[str, Any], result: Result, book: PageContext) -> Markup:
    relation = _RELATIONS.get(str(x.get("relation")), str(x.get("relation")))
    told = f" {x.get('test') or ''} {relation} {x.get('other') or ''} ".replace("  ", " ")
    inside: list[Content] = [tag("p", x["reason"])] if x.get("reason") else []
    return folded(
        (verdict(x.get("verdict")), told, tag("code", short(x.get("formula")))),
        *inside,
        *behind(x, result, book),
    )


_RELATIONS = {"runs": "can be run", "empty": "can never be run", "reaches": "reaches", "open": "is open:"}


def _gap(x: Mapping[str, Any], result: Result, book: PageContext) -> Markup:
    """A class of gaps that no test shows: a drive of it, or a proof that there is none."""
    inside: list[Content] = [tag("p", tag("code", x["claim"]))] if x.get("claim") else []
    inside += [tag("p", x["reason"])] if x.get("reason") else []
    inside += [part for y in x.get("gaps") or () for part in behind(y, result, book)]
    summary = (verdict(x.get("verdict")), f" gap, scenario {x.get('scenario')}: {x.get('description')}")
    return folded(summary, *inside, *behind({**x, "drive": None}, result, book))


def _ranges(found: Sequence[Mapping[str, Any]]) -> list[Content]:
    if not found:
        return []
    keys = ("target", "term", "tested", "reached", "untested")
    rows = [[*(short(x.get(key)) for key in keys), f"{100 * x.get('share', 0):.0f} %"] for x in found]
    head = ("what", "at the start", "tested", "reached", "untested", "of the range")
    return [tag("h3", "What of the range of each is tested"), table(head, rows)]
