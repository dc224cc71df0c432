"""Turns traced requirements into test cases: one for each link, located at the line of its requirement."""

from collections.abc import Iterator, Mapping
from pathlib import Path

from roadproof.evidence.finding import Acceptance
from roadproof.extensions.assurance.answers.trace import (
    LinkedEvidence,
    LinkState,
    TraceData,
    TracedLink,
    TracedRequirement,
)
from roadproof.extensions.assurance.requirements.report import reason_of
from roadproof.frontends.report.cases import Case, CaseRule, Location, State
from roadproof.verdict import Verdict

_RULES: Mapping[LinkState, Verdict | CaseRule] = {  # partial: the other states are no failures
    LinkState.UNKNOWN: Verdict.UNKNOWN,
    LinkState.STALE: CaseRule.STALE,
    LinkState.MISSING: CaseRule.MISSING,
    LinkState.REJECTED: CaseRule.REJECTED,
    LinkState.REFUTED: Verdict.REFUTED,
}


def requirement_cases(answer: TraceData) -> Iterator[Case]:
    """Yield the test cases of a trace.

    There is one for each link, one for each requirement without links and parts, and one for each piece of
    rejected evidence that no requirement names.
    """
    with_parts = {parent for requirement in answer.requirements for parent in requirement.parents}
    for requirement in answer.requirements:
        for link in requirement.links:
            yield _link_case(requirement, link)
        if not requirement.links and requirement.id not in with_parts:
            yield _case(requirement, requirement.id, LinkState.MISSING, "the requirement has no link", ())
    for evidence in answer.unlinked:
        if evidence.outcome is not Acceptance.ACCEPTED:
            rule = CaseRule.UNREADABLE if evidence.outcome is Acceptance.UNREADABLE else CaseRule.REJECTED
            name = f"{evidence.where}: {evidence.label}".removesuffix(": ")
            yield Case(
                suite="evidence without a requirement",
                name=name,
                state="undecided" if evidence.outcome is Acceptance.UNDECIDED else "failed",
                rule=Verdict.UNKNOWN if evidence.outcome is Acceptance.UNDECIDED else rule,
                message=f"{evidence.outcome}: {evidence.reason}",
                place=Location(evidence.where) if Path(evidence.where).is_file() else None,
            )


def _link_case(requirement: TracedRequirement, link: TracedLink) -> Case:
    name = f"{requirement.id}: {link.kind} {' '.join(link.target.split())}"
    return _case(requirement, name, link.state, reason_of(link), link.evidence)


def _case(
    requirement: TracedRequirement,
    name: str,
    state: LinkState,
    reason: str,
    evidence: tuple[LinkedEvidence, ...],
) -> Case:
    result: State = "passed" if state.is_shown else "undecided" if state is LinkState.UNKNOWN else "failed"
    files = [Path(y.where) for y in evidence if Path(y.where).is_file()]
    return Case(
        suite=requirement.id,
        name=name,
        state=result,
        rule=_RULES.get(state),
        message=f"{state}: {reason}".removesuffix(": "),
        place=Location(requirement.place.file, requirement.place.line, requirement.place.column),
        evidence=files[0] if files else None,
    )
