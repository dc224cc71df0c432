"""The template values of most sections: matrices, recordings, and single files of evidence."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import replace

from roadproof.evidence.codec import read, write
from roadproof.evidence.finding import Acceptance, Finding
from roadproof.extensions.pages.page.matrix import Heading, Linked, Matrix
from roadproof.extensions.pages.page.page_context import DriveCard, PageContext
from roadproof.extensions.pages.page.results import PageResult, Words
from roadproof.extensions.pages.page.templates import in_unit, notes
from roadproof.extensions.surveys.classify.data import ClassesData
from roadproof.extensions.surveys.coverage import schema as gaps
from roadproof.extensions.surveys.explore.data import ExplorationData, ExploreData
from roadproof.extensions.surveys.redundancy import RedundancyData
from roadproof.extensions.surveys.report.classify import sheet_of
from roadproof.extensions.surveys.report.coverage import sheet_of as sheet_of_classes
from roadproof.extensions.surveys.report.redundancy import sheet_of as sheet_of_changes
from roadproof.extensions.traffic.answers import monitor
from roadproof.extensions.traffic.answers import traffic as evaluations
from roadproof.questions.order.data import OrderData
from roadproof.questions.overlap_data import OverlapData
from roadproof.questions.witness_data import WitnessData


def evidence(findings: Sequence[Finding]) -> dict[str, object]:
    """Return the findings, accepted and others."""
    accepted = [x for x in findings if x.outcome is Acceptance.ACCEPTED]
    return {"accepted": accepted, "wrong": [x for x in findings if x not in accepted]}


def drives_alone(findings: Sequence[Finding], context: PageContext) -> list[DriveCard]:
    """Return a card for each accepted drive."""
    paths = {id(finding): path for path, finding in context.findings.items()}
    drives = [
        x for x in findings if x.kind == "drive" and x.outcome is Acceptance.ACCEPTED and id(x) in paths
    ]
    return [
        DriveCard(context.drive(paths[id(x)]), x.verdict, x.claim, f"drive-{k}", notes(x))
        for k, x in enumerate(drives)
    ]


def witnessed(result: PageResult, context: PageContext, words: Words) -> dict[str, object]:
    """Return the drives of ``witness --json`` as cards; ``without``: the verdicts without a drive."""
    answer = read(WitnessData, result.data, result.name)
    checked = {
        x: map(notes, context.drives_of(result.folder, x)) for x in {y.formula for y in answer.verdicts}
    }
    cards = [
        DriveCard(context.drive(drive), x.verdict, x.formula, place, next(checked[x.formula], ""))
        for k, x in enumerate(answer.verdicts)
        for n, drive in enumerate(x.drives)
        for place in [f"sought-{result.id}-{k}{f'-{n}' * (n > 0)}"]
        if isinstance(drive, Mapping)
    ]
    without = [(f"sought-{result.id}-{k}", x) for k, x in enumerate(answer.verdicts) if not x.drives]
    return {"answer": answer, "cards": cards, "without": without}


def overlap(result: PageResult, context: PageContext, words: Words) -> dict[str, object]:
    """Return pairs of scenarios and a matrix of them."""
    pairs = read(OverlapData, result.data, result.name).verdicts
    several = len({x for pair in pairs for x in (pair.set_a, pair.set_b)}) > 1
    names: dict[tuple[str, int], str] = {}
    cells: dict[tuple[object, object], Linked] = {}
    for k, pair in enumerate(pairs):
        one, other = (
            names.setdefault((of if several else "", n), f"{n} {of if several else ''}".strip())
            for n, of in ((pair.a, pair.set_a), (pair.b, pair.set_b))
        )
        title = f"{pair.a} and {pair.b}: {pair.verdict}"
        cells[one, other] = Linked(pair.verdict, title, f"pair-{result.id}-{k}")
        cells.setdefault((other, one), cells[one, other])
    ends = [(name, number) for (_, number), name in sorted(names.items())]
    heads = [Heading(name, name, words.get(number)) for name, number in ends]
    return {"pairs": pairs, "matrix": Matrix(heads, heads, cells)}


def coverage(result: PageResult, context: PageContext, words: Words) -> dict[str, object]:
    """Return a matrix of classes of gaps, with a column for each scenario and a row for each false part."""
    index = read(gaps.CoverageData, result.data, result.name)
    sheet = sheet_of_classes(index, words)
    cells: dict[tuple[object, object], Linked] = {}
    for k, x in enumerate(index.classes):
        numbers = f", gap {', '.join(map(str, x.gaps))}" if x.gaps else ""
        target = f"gap-{result.id}-{x.gaps[0]}" if x.gaps else f"class-{result.id}-{k}"
        title = f"{x.description}: {x.verdict}{numbers}"
        cells[(x.component, x.condition), x.scenario] = Linked(x.verdict, title, target)
    scenarios = dict.fromkeys(x.scenario for x in index.classes)
    kinds = dict.fromkeys((x.component, x.condition) for x in index.classes)
    return {
        "answer": index,
        "matrix": Matrix(
            [Heading(kind, " ".join(filter(None, kind))) for kind in kinds],
            [Heading(x, x or "other", words.get(x or -1)) for x in scenarios],
            cells,
        ),
        "notes": replace(sheet, entries=[x for x in index.classes if x.reason and x.gaps]),
    }


def order(result: PageResult, context: PageContext, words: Words) -> dict[str, object]:
    """Return implications and a matrix of them."""
    index = read(OrderData, result.data, result.name)
    numbers = {kind[0]: int(kind[0].partition("@")[0]) for kind in index.kinds}
    cells: dict[tuple[object, object], Linked] = {
        (a, b): Linked("UNKNOWN", f"{a} may imply {b}", None) for a in numbers for b in numbers
    }
    cells |= {
        x.pair: Linked("UNKNOWN", f"{x.above} may imply {x.below}: {x.reason}", None) for x in index.doubts
    }
    cells |= {
        x.pair: Linked("PROVED", f"{x.above} implies {x.below}", f"implied-{result.id}-{k}")
        for k, x in enumerate(index.proved)
    }
    for x in index.missing:
        title = f"{x.above} does not always imply {x.below}"
        cells[x.pair] = Linked("REFUTED", title, f"against-{result.id}-{x.drives[0]}")
    cells |= {(name, name): Linked("=", "itself", None) for name in numbers}
    heads = [Heading(name, name, words.get(number)) for name, number in numbers.items()]
    return {
        "answer": index,
        "matrix": Matrix(heads, heads, cells),
        "same": [kind for kind in index.kinds if len(kind) > 1],
        "edges": {x.pair for x in index.edges},
        "doubts": len({x.pair for x in index.doubts}),
    }


def redundancy(result: PageResult, context: PageContext, words: Words) -> dict[str, object]:
    """Return changes of scenarios, with those that are needed last."""
    changes = read(RedundancyData, result.data, result.name).verdicts
    entries = sorted(changes, key=lambda x: x.redundant is False)
    flags = [x.redundant for x in entries]
    sheet = sheet_of_changes(entries, words)
    return {"sheet": sheet, "needed": flags.count(False), "spare": flags.count(True)}


def explored(result: PageResult, context: PageContext, words: Words) -> dict[str, object]:
    """Return explorations, each with a matrix: one row for one parameter, a grid for two."""
    index = read(ExploreData, result.data, result.name)
    return {"explored": [(x, _map(x, f"{result.id}-{k}")) for k, x in enumerate(index.explored)]}


def _map(x: ExplorationData, place: str) -> Matrix:
    cells: dict[tuple[object, object], Linked] = {}
    rows, columns = dict[str, Heading](), dict[str, Heading]()
    for k, one in enumerate(x.values if x.vary else ()):
        shown = [f"{y.name} = {in_unit(at, y.unit)}" for y, at in zip(x.vary, one.at, strict=True)]
        up = shown[1] if len(shown) > 1 else "drive"
        cells[up, one.at[0]] = Linked(one.verdict, f"{', '.join(shown)}: {one.verdict}", f"value-{place}-{k}")
        rows.setdefault(up, Heading(up, up))
        columns.setdefault(one.at[0], Heading(one.at[0], in_unit(one.at[0])))
    return Matrix([*rows.values()], [*columns.values()], cells)


def classes(result: PageResult, context: PageContext, words: Words) -> dict[str, object]:
    """Return classes; ``claims``: counted by kind."""
    index = read(ClassesData, result.data, result.name)
    claims = Counter((x.kind, x.verdict) for x in index.claims)
    return {"answer": index, "sheet": sheet_of(index.classes), "claims": [*claims.items()]}


def traffic(result: PageResult, context: PageContext, words: Words) -> dict[str, object]:
    """Return the results table of recordings; ``numbers``: its scenarios as texts and numbers."""
    answer = read(evaluations.EvaluationData, result.data, result.name)
    numbers = dict.fromkeys(n for x in answer.table for n in x.scenarios)
    return {"answer": answer, "numbers": [(n, int(n)) for n in numbers]}


def monitored(result: PageResult, context: PageContext, words: Words) -> dict[str, object]:
    """Return the answer of ``monitor --json``, which has no trace: its verdict, and when each
    part is true.
    """
    answer = read(monitor.MonitorData, result.data, result.name)
    strips = [(x.formula, x.true) for x in answer.parts]
    return {"answer": answer, "strips": strips, "overruled": [write(x) for x in answer.overruled]}
