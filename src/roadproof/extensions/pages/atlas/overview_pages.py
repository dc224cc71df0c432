"""The values of the front page and of the overview pages: pairs, implications, classes and gaps."""

from collections.abc import Mapping, Sequence

from roadproof.extensions.pages.atlas.answers import Answers, Source, name_in
from roadproof.extensions.pages.atlas.notation import shown
from roadproof.extensions.pages.atlas.pictures import DrivePicture
from roadproof.extensions.pages.atlas.scenario_page import Gap, Statement, all_gaps, claims
from roadproof.extensions.pages.page.templates import counted
from roadproof.library.words import Words


def page_of(number: int) -> str:
    """The file of a scenario's page."""
    return f"scenario-{number:02d}.html"


def front_values(answers: Answers, drawn: Mapping[str, DrivePicture]) -> dict[str, object]:
    """The grid of scenarios, and how often each verdict occurs on each overview."""
    every = [answers.home.words(n) for n in answers.numbers]
    sectors = [*dict.fromkeys(x.sector for x in every)]
    rows: dict[str, dict[str, tuple[Words, DrivePicture | None]]] = {}
    smooth = answers.drives.get("smooth", {})
    for x in every:
        found = smooth.get(x.number)
        rows.setdefault(x.title, {})[x.sector] = x, None if found is None else drawn[found.source.file]
    return {"sectors": sectors, "rows": rows, "general": claims(answers, None), "counts": _counts(answers)}


def _counts(answers: Answers) -> dict[str, list[tuple[str, int]]]:
    """How often each verdict occurs, by topic."""
    found: dict[str, list[tuple[str, int]]] = {}
    if answers.proofs is not None:
        found["proofs"] = counted(x.verdict for x in answers.proofs.verdicts)
    if answers.overlap is not None:
        found["overlaps"] = counted(x.verdict for x in answers.overlap.verdicts)
    if answers.order is not None:
        index = answers.order
        every = {"PROVED": index.proved, "REFUTED": index.missing, "UNKNOWN": index.doubts}
        found["implications"] = [(word, len(x)) for word, x in every.items() if x]
    if answers.classes is not None:
        found["classes"] = counted(x.verdict for x in answers.classes.classes)
    if answers.coverage is not None:
        found["gaps"] = counted(x.verdict for x in answers.coverage.classes)
    return found


def overlap_values(answers: Answers) -> dict[str, object]:
    """The matrix of pairs: cells by both numbers."""
    cells: dict[tuple[int, int], tuple[str, Source]] = {}
    for x in () if answers.overlap is None else answers.overlap.verdicts:
        source = answers.source("overlap", f"--among {x.a},{x.b}", "overlap", name_in(x.evidence))
        cells[x.a, x.b] = cells[x.b, x.a] = x.verdict, source
    return {"names": [answers.home.words(n) for n in answers.numbers], "cells": cells}


def implication_values(answers: Answers) -> dict[str, object]:
    """The implications that follow from no others, and the pairs that are refuted."""
    index = answers.order
    assert index is not None, "it is asked only where there are implications"
    proved = [
        Statement(
            "PROVED",
            shown(x.claim),
            answers.source("order", "", "order", name_in([x.certificate])),
            f"{x.above} implies {x.below}",
        )
        for x in sorted(index.edges, key=lambda x: (int(x.above.partition("@")[0]), x.pair))
    ]
    refuted = [
        Statement(
            "REFUTED",
            f"{x.holds} holds; {', '.join(x.fails)} fail",
            answers.source("order", "", "order", name_in([x.drive])),
        )
        for x in index.drives
    ]
    same = [kind for kind in index.kinds if len(kind) > 1]
    return {"proved": proved, "refuted": refuted, "same": same}


def class_values(answers: Answers, drawn: Mapping[str, DrivePicture]) -> dict[str, object]:
    """The classes, and the claims that they exclude each other and make up the scenarios."""
    index = answers.classes
    assert index is not None, "it is asked only where there are classes"
    sources = [answers.source("classify", "--no-shares", "classes", _name(x.drive)) for x in index.classes]
    cards = [(x, source, drawn.get(source.file)) for x, source in zip(index.classes, sources, strict=True)]
    proofs = [
        Statement(
            x.verdict,
            shown(x.claim),
            answers.source("classify", "--no-shares", "classes", _name(x.certificate)),
            x.name,
            x.kind,
        )
        for x in index.claims
    ]
    return {"cards": cards, "proofs": proofs, "kinds": counted(x.kind for x in index.claims)}


def gap_values(answers: Answers, drawn: Mapping[str, DrivePicture]) -> dict[str, object]:
    """The classes of gaps by scenario; None stands for those of no single scenario."""
    groups: dict[Words | None, list[Gap]] = {}
    for x in all_gaps(answers, drawn):
        words = None if x.found.scenario is None else answers.home.words(x.found.scenario)
        groups.setdefault(words, []).append(x)
    index = answers.coverage
    assert index is not None, "it is asked only where there are gaps"
    general: Sequence[Statement] = [
        Statement(
            x.verdict,
            shown(x.claim),
            answers.source("coverage", "", "coverage", _name(x.certificate)),
            x.reason,
        )
        for x in index.claims
    ]
    return {"groups": groups, "verdict": index.verdict, "general": general}


def _name(evidence: object) -> str | None:
    """Return the name of a file of evidence; None where there is none."""
    return None if evidence is None else name_in([evidence])
