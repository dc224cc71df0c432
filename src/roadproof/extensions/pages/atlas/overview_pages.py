"""The template values of the front page and the overview pages: pairs, implications, classes and gaps."""

from collections.abc import Iterator, Mapping, Sequence

from roadproof.extensions.pages.atlas.answers import Answers, EvidenceSource, name_in
from roadproof.extensions.pages.atlas.notation import text_as_html
from roadproof.extensions.pages.atlas.pictures import AtlasPicture
from roadproof.extensions.pages.atlas.scenario_page import GapClass, SourcedStatement, all_gaps, claims
from roadproof.extensions.pages.page.templates import counted
from roadproof.library.words import Words


def page_of(number: int) -> str:
    """Return the file name of a scenario's page."""
    return f"scenario-{number:02d}.html"


def front_values(answers: Answers, pictures: Mapping[str, AtlasPicture]) -> dict[str, object]:
    """Return the values of the front page: the grid of scenarios, and counts of verdicts for each
    overview.
    """
    every = [answers.home.words(n) for n in answers.numbers]
    sectors = [*dict.fromkeys(x.sector for x in every)]
    rows: dict[str, dict[str, tuple[Words, AtlasPicture | None]]] = {}
    typical = answers.drives.get("typical", {})
    for x in every:
        drive = typical.get(x.number)
        rows.setdefault(x.title, {})[x.sector] = x, None if drive is None else pictures[drive.source.file]
    return {
        "sectors": sectors,
        "rows": rows,
        "general": claims(answers, None),
        "counts": dict(_counts(answers)),
    }


def _counts(answers: Answers) -> Iterator[tuple[str, list[tuple[str, int]]]]:
    """Yield each topic, with how often each verdict occurs in it."""
    if answers.proofs is not None:
        yield "proofs", counted(x.verdict for x in answers.proofs.verdicts)
    if answers.overlap is not None:
        yield "overlaps", counted(x.verdict for x in answers.overlap.verdicts)
    if answers.order is not None:
        index = answers.order
        every = {"PROVED": index.proved, "REFUTED": index.missing, "UNKNOWN": index.doubts}
        yield "implications", [(word, len(x)) for word, x in every.items() if x]
    if answers.classes is not None:
        yield "classes", counted(x.verdict for x in answers.classes.classes)
    if answers.coverage is not None:
        yield "gaps", counted(x.verdict for x in answers.coverage.classes)


def overlap_values(answers: Answers) -> dict[str, object]:
    """Return the matrix of pairs, with cells by both scenario numbers."""
    cells: dict[tuple[int, int], tuple[str, EvidenceSource]] = {}
    for x in () if answers.overlap is None else answers.overlap.verdicts:
        source = answers.source("overlap", f"--among {x.a},{x.b}", "overlap", name_in(x.evidence))
        cells[x.a, x.b] = cells[x.b, x.a] = x.verdict, source
    return {"names": [answers.home.words(n) for n in answers.numbers], "cells": cells}


def implication_values(answers: Answers) -> dict[str, object]:
    """Return the implications that follow from no others, and the refuted pairs."""
    index = answers.order
    assert index is not None, "it is asked only where there are implications"
    proved = [
        SourcedStatement(
            "PROVED",
            text_as_html(x.claim),
            answers.source("order", "", "order", name_in([x.certificate])),
            f"{x.above} implies {x.below}",
        )
        for x in sorted(index.edges, key=lambda x: (int(x.above.partition("@")[0]), x.pair))
    ]
    refuted = [
        SourcedStatement(
            "REFUTED",
            f"{x.holds} holds; {', '.join(x.fails)} fail",
            answers.source("order", "", "order", name_in([x.drive])),
        )
        for x in index.drives
    ]
    same = [kind for kind in index.kinds if len(kind) > 1]
    return {"proved": proved, "refuted": refuted, "same": same}


def class_values(answers: Answers, pictures: Mapping[str, AtlasPicture]) -> dict[str, object]:
    """Return the classes, and the claims that they are disjoint and make up the scenarios."""
    index = answers.classes
    assert index is not None, "it is asked only where there are classes"
    sources = [answers.source("classify", "--no-shares", "classes", _name(x.drive)) for x in index.classes]
    cards = [(x, source, pictures.get(source.file)) for x, source in zip(index.classes, sources, strict=True)]
    proofs = [
        SourcedStatement(
            x.verdict,
            text_as_html(x.claim),
            answers.source("classify", "--no-shares", "classes", _name(x.certificate)),
            x.name,
            x.kind,
        )
        for x in index.claims
    ]
    return {"cards": cards, "proofs": proofs, "kinds": counted(x.kind for x in index.claims)}


def gap_values(answers: Answers, pictures: Mapping[str, AtlasPicture]) -> dict[str, object]:
    """Return the classes of gaps by scenario; the key None has those of no single scenario."""
    groups: dict[Words | None, list[GapClass]] = {}
    for x in all_gaps(answers, pictures):
        words = None if x.gap_class.scenario is None else answers.home.words(x.gap_class.scenario)
        groups.setdefault(words, []).append(x)
    index = answers.coverage
    assert index is not None, "it is asked only where there are gaps"
    general: Sequence[SourcedStatement] = [
        SourcedStatement(
            x.verdict,
            text_as_html(x.claim),
            answers.source("coverage", "", "coverage", _name(x.certificate)),
            x.reason,
        )
        for x in index.claims
    ]
    return {"groups": groups, "verdict": index.verdict, "general": general}


def _name(evidence: object) -> str | None:
    """Return the name of a file of evidence; None where there is no file."""
    return None if evidence is None else name_in([evidence])
