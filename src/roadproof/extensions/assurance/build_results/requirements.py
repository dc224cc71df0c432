"""The cases of requirements: one for each link, at the line of its requirement."""

from collections.abc import Iterator, Mapping
from pathlib import Path

from roadproof.evidence.finding import Acceptance
from roadproof.extensions.assurance.answers.trace import (
    Answer,
    LinkedEvidence,
    LinkState,
    TracedLink,
    TracedRequirement,
)
from roadproof.extensions.assurance.requirements.report import reason_of
from roadproof.frontends.report.cases import Case, Location, Rule, State
from roadproof.verdict import Verdict

_RULES: Mapping[LinkState, Verdict | Rule] = {
    LinkState.UNKNOWN: Verdict.UNKNOWN,
    LinkState.STALE: Rule.STALE,
    LinkState.MISSING: Rule.MISSING,
    LinkState.REJECTED: Rule.REJECTED,
    LinkState.REFUTED: Verdict.REFUTED,
}


def requirement_cases(answer: Answer) -> Iterator[Case]:
    """A case for each link, for each requirement without links and parts, and for evidence that is rejected
    and that no requirement names."""
    with_parts = {parent for x in answer.requirements for parent in x.parents}
    for x in answer.requirements:
        for link in x.links:
            yield _of_link(x, link)
        if not x.links and x.id not in with_parts:
            yield _case(x, x.id, LinkState.MISSING, "the requirement has no link", ())
    for y in answer.unlinked:
        if y.outcome is not Acceptance.ACCEPTED:
            rule = Rule.UNREADABLE if y.outcome is Acceptance.UNREADABLE else Rule.REJECTED
            name = f"{y.where}: {y.label}".removesuffix(": ")
            yield Case(
                suite="evidence without a requirement",
                name=name,
                state="undecided" if y.outcome is Acceptance.UNDECIDED else "failed",
                rule=Verdict.UNKNOWN if y.outcome is Acceptance.UNDECIDED else rule,
                message=f"{y.outcome}: {y.reason}",
                place=Location(y.where) if Path(y.where).is_file() else None,
            )


def _of_link(x: TracedRequirement, link: TracedLink) -> Case:
    name = f"{x.id}: {link.kind} {' '.join(link.target.split())}"
    return _case(x, name, link.state, reason_of(link), link.evidence)


def _case(
    x: TracedRequirement, name: str, state: LinkState, reason: str, evidence: tuple[LinkedEvidence, ...]
) -> Case:
    result: State = "passed" if state.is_shown else "undecided" if state is LinkState.UNKNOWN else "failed"
    files = [Path(y.where) for y in evidence if Path(y.where).is_file()]
    return Case(
        suite=x.id,
        name=name,
        state=result,
        rule=_RULES.get(state),
        message=f"{state}: {reason}".removesuffix(": "),
        place=Location(x.place.file, x.place.line, x.place.column),
        evidence=files[0] if files else None,
    )
