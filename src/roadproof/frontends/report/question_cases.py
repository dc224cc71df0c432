"""The cases of claims, of searches, and of what is found where evidence is checked."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from roadproof.evidence.finding import NO_EVIDENCE, Acceptance, Finding
from roadproof.frontends.report.cases import Case, CaseRule, Location, State, named_definitions, state_of
from roadproof.library.elaborate import read_claim
from roadproof.library.specification import Specification
from roadproof.logic.syntax import Claim
from roadproof.verdict import Verdict

if TYPE_CHECKING:
    from roadproof.questions.prove import ClaimResult, ProveQuestion
    from roadproof.questions.witness import SearchResult


def written(case: Case, specification: Specification, claim: Claim) -> Case:
    """Return the case with the definitions that it names, at the first of them where it has no place."""
    named = named_definitions(specification, claim)
    first = named[0][1] if named else None
    return replace(case, place=case.place or first, related=named)


def claim_cases(
    question: ProveQuestion,
    answers: Sequence[ClaimResult],
    files: Mapping[str, Path],
    places: Mapping[str, Location],
) -> Iterator[Case]:
    """A case for each claim. ``files``: evidence, ``places``: where it is written, both by ``name``."""
    for x in answers:
        task, specification = x.task, question.specification_of(x.task)
        text = " ".join(task.claim.split())
        expected = "" if x.verdict is x.expected else f", expected {x.expected}"
        reason = x.reason
        by = x.refuted_by
        message = f"{x.verdict}{f' by a {by}' if by else ''}{expected}: {text}{reason and f' ({reason})'}"
        case = Case(
            suite=f"claims in {task.set_name}",
            name=text if task.title == "" else f"{task.name}: {text}",
            state=state_of(x.verdict, (x.expected,)),
            rule=x.verdict,
            message=message,
            place=places.get(x.name),
            evidence=files.get(x.name),
            seconds=x.seconds,
        )
        yield written(case, specification, read_claim(specification, task.claim).claim)


def search_cases(searches: Iterable[tuple[SearchResult, Path | None]]) -> Iterator[Case]:
    """A case for each search for a drive, with its evidence where there is a file."""
    for x, file in searches:
        name = x.query.text if x.scenario is None else f"scenario {x.scenario}"
        case = Case(
            suite=f"drives in {x.set_name}",
            name=name,
            state=state_of(x.verdict, (Verdict.WITNESSED,)),
            rule=x.verdict,
            message=f"{x.verdict}: {name}{x.reason and f' ({x.reason})'}",
            evidence=file,
            seconds=x.cost.seconds or None,
        )
        yield written(case, x.task.specification, x.query.claim)


def finding_cases(findings: Sequence[Finding], strict: bool) -> Iterator[Case]:
    """A case for each claim of a file or of an index that was checked.

    Answers without evidence are undecided if ``strict``, and where nothing else was checked.
    """
    rules: Mapping[Acceptance, CaseRule] = {  # partial: the other outcomes break no rule
        Acceptance.REJECTED: CaseRule.REJECTED,
        Acceptance.UNREADABLE: CaseRule.UNREADABLE,
    }
    nothing = all(x.kind == NO_EVIDENCE for x in findings)
    for x in findings:
        state: State = "passed" if x.outcome is Acceptance.ACCEPTED else "failed"
        without = (strict or nothing) and x.kind == NO_EVIDENCE
        if x.outcome is Acceptance.UNDECIDED or without:
            state = "undecided"
        file = x.where.partition(", ")[0]
        reason = x.reason or ("there is no evidence" if without else "")
        yield Case(
            suite="evidence",
            name=f"{x.where}: {x.label or ' '.join(x.claim.split())}".removesuffix(": "),
            state=state,
            rule=rules.get(x.outcome, Verdict.UNKNOWN),
            message=f"{x.outcome}: {reason}",
            place=Location(file) if Path(file).exists() else None,
        )
