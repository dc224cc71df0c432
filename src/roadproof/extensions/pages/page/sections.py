"""Renders the section of a result; kinds without a section of their own are shown as tables."""

from collections.abc import Sequence
from typing import NamedTuple

from roadproof.errors import InputError
from roadproof.evidence.finding import Finding, checkers
from roadproof.extension import entries, imported
from roadproof.extensions.pages.page import values
from roadproof.extensions.pages.page.page_context import PageContext
from roadproof.extensions.pages.page.results import PageResult, Words
from roadproof.extensions.pages.page.section_kind import SectionKind
from roadproof.extensions.pages.page.standard_sections import plain
from roadproof.extensions.pages.page.summary import Overview, SummaryStatement, overview
from roadproof.extensions.pages.page.templates import render
from roadproof.library.words import spans
from roadproof.questions.question import QUESTION


class PageSection(NamedTuple):
    """A section as HTML, with its entry in the summary."""

    overview: Overview
    html: str


def section(result: PageResult, context: PageContext, words: Words) -> PageSection:
    """Return the section of a result of any kind; ``words``: names of scenarios. Raises ``InputError``."""
    kind = _kind_of(result)
    rejected = () if result.folder is None else context.rejected.get(str(result.folder / QUESTION), ())
    frame = {"title": kind.title, "question": kind.question, "set": result.data.get("set")}
    known = {number: x for number, x in words.items() if x}
    try:
        shown_values = kind.values(result, context, known)
        html = render(
            f"{kind.template}.html",
            page=context,
            result=result,
            words=known,
            rejections=rejected,
            **frame,
            **shown_values,
        )
    except (AttributeError, IndexError, KeyError, TypeError, ValueError) as error:
        reason = f"{type(error).__name__}: {error}"[:200]
        raise InputError(
            f"{result.name}: it is no result that can be shown: what it says is not of the form of "
            f"{result.schema} ({reason}); make it again"
        ) from None
    wrong = len(rejected) + context.rejected_in(result.folder)
    head = overview(result, kind.title, kind.question, wrong, kind.points(result), kind.counts(result))
    return PageSection(head, html)


def _kind_of(result: PageResult) -> SectionKind:
    if result.kind in entries("sections"):
        kind: SectionKind = imported("sections", result.kind)
        return kind
    return SectionKind(result.kind, "", "plain", plain)


def drive_section(findings: Sequence[Finding], context: PageContext) -> PageSection:
    """Return the gallery of accepted drives that no result names."""
    cards = values.drives_alone(findings, context)
    statements = [SummaryStatement(x.verdict, x.drive.title or x.claim, x.place) for x in cards]
    scenarios = {x.drive.scenario for x in cards if x.drive.scenario is not None}
    subject = f"scenarios {spans(scenarios)}" if scenarios else ""
    head = Overview(
        "Drives", "Which drives show the scenarios?", "drives", "", subject, statements=statements
    )
    return PageSection(head, render("drives.html", page=context, cards=cards, head=head))


def evidence_section(findings: Sequence[Finding], context: PageContext, solver: str) -> PageSection:
    """Return the section about evidence that no result names, with a row for each file."""
    accepted_and_wrong = values.evidence(findings)
    proofs = [SummaryStatement(x.verdict, x.label, "evidence") for x in findings if x.kind == "certificate"]
    counts = "" if proofs else f"{len(findings)} files"
    head = Overview(
        "Evidence", "Does independent code accept it?", "evidence", counts=counts, statements=proofs
    )
    by = checkers(findings, solver)
    html = render(
        "evidence.html", page=context, checkers=by, count=len(findings), head=head, **accepted_and_wrong
    )
    return PageSection(head, html)
