"""Values of sections with a matrix: where in a result the answer about a row and a column is."""

from dataclasses import replace

from roadproof.evidence.answers import coverage as gaps
from roadproof.evidence.answers import explore as explorations
from roadproof.evidence.answers import order as implications
from roadproof.evidence.answers import overlap as pairs
from roadproof.evidence.answers import redundancy as changes
from roadproof.evidence.codec import read
from roadproof.frontends.report.coverage import sheet_of as sheet_of_classes
from roadproof.frontends.report.page.page_context import PageContext
from roadproof.frontends.report.page.results import Result, Words
from roadproof.frontends.report.redundancy import sheet_of as sheet_of_changes


def overlap(result: Result, context: PageContext, words: Words) -> dict[str, object]:
    """Pairs of scenarios; ``ends``: each scenario by name, with its number."""
    found = read(pairs.Index, result.data, result.name).verdicts
    several = len({x for pair in found for x in (pair.set_a, pair.set_b)}) > 1
    names: dict[tuple[str, int], str] = {}
    places: dict[tuple[str, str], int] = {}
    for k, pair in enumerate(found):
        one, other = (
            names.setdefault((of if several else "", n), f"{n} {of if several else ''}".strip())
            for n, of in ((pair.a, pair.set_a), (pair.b, pair.set_b))
        )
        places[one, other] = k
        places.setdefault((other, one), k)
    ends = [(name, number) for (_, number), name in sorted(names.items())]
    return {"pairs": found, "ends": ends, "places": places}


def coverage(result: Result, context: PageContext, words: Words) -> dict[str, object]:
    """Classes of gaps: a column for each scenario, a row for each part that is false."""
    index = read(gaps.Index, result.data, result.name)
    sheet = sheet_of_classes(index, words)
    places = {(x.scenario, (x.component, x.condition)): k for k, x in enumerate(index.classes)}
    return {
        "answer": index,
        "places": places,
        "scenarios": list(dict.fromkeys(scenario for scenario, _ in places)),
        "kinds": list(dict.fromkeys(kind for _, kind in places)),
        "notes": replace(sheet, entries=[x for x in index.classes if x.reason and x.gaps]),
    }


def order(result: Result, context: PageContext, words: Words) -> dict[str, object]:
    """Implications: the place of each proof, the number of each drive; ``numbers`` of scenarios by name."""
    index = read(implications.Index, result.data, result.name)
    return {
        "answer": index,
        "numbers": {kind[0]: int(kind[0].partition("@")[0]) for kind in index.kinds},
        "same": [kind for kind in index.kinds if len(kind) > 1],
        "edges": {x.pair for x in index.edges},
        "proved": {x.pair: k for k, x in enumerate(index.proved)},
        "refuted": {x.pair: x.drives[0] for x in index.missing},
        "doubts": {x.pair: x.reason for x in index.doubts},
    }


def redundancy(result: Result, context: PageContext, words: Words) -> dict[str, object]:
    """Changes of scenarios, those that are needed last."""
    found = read(changes.Index, result.data, result.name).verdicts
    entries = sorted(found, key=lambda x: x.redundant is False)
    said = [x.redundant for x in entries]
    sheet = sheet_of_changes(entries, words)
    return {"sheet": sheet, "needed": said.count(False), "spare": said.count(True)}


def explored(result: Result, context: PageContext, words: Words) -> dict[str, object]:
    """Explorations, each with the values ``across`` and ``up`` of its map and the places of findings."""
    return {"explored": [(x, _grid(x)) for x in read(explorations.Index, result.data, result.name).explored]}


def _grid(x: explorations.Exploration) -> dict[str, object]:
    places = {
        (one.at[0], one.at[1] if len(x.vary) > 1 else ""): k for k, one in enumerate(x.values) if x.vary
    }
    across, up = (list(dict.fromkeys(at[k] for at in places)) for k in (0, 1))
    return {"across": across, "up": up, "places": places}
