"""Derives the state of every requirement from the evidence of its links and parts."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from roadproof.evidence.finding import NO_EVIDENCE, Acceptance
from roadproof.extensions.assurance.answers.trace import LinkState, TracedLink, TracedRequirement
from roadproof.extensions.assurance.requirements.checked_evidence import CheckedEvidence
from roadproof.extensions.assurance.requirements.fingerprints import (
    Key,
    Parts,
    TraceContext,
    differences,
    key_of,
    parts_of,
)
from roadproof.extensions.assurance.requirements.matching import (
    LinkFinding,
    Target,
    combined_state,
    findings_of_link,
    is_related,
    read_target,
)
from roadproof.extensions.assurance.requirements.requirement import (
    Requirement,
    RequirementSet,
    ancestors_of,
    place_text,
)
from roadproof.reasons import NO_REASON


@dataclass(frozen=True)
class States:
    """Requirements with their states, what each link rests on, and the evidence that no requirement names."""

    requirements: tuple[TracedRequirement, ...]
    rests_on: Mapping[Key, Parts]
    unlinked: tuple[CheckedEvidence, ...]


@dataclass(frozen=True)
class _LinkEvidence:
    """A link with the findings about it."""

    target: Target
    shown: Sequence[LinkFinding]

    @property
    def evidence(self) -> list[CheckedEvidence]:
        return [x.evidence for x in self.shown]


Targets = Mapping[str, Sequence[Target]]
"""The parsed links of each requirement, by its id."""


def read_targets(requirement_set: RequirementSet, context: TraceContext) -> Targets:
    """Parse all links under the definitions of the trace. Raises ``InputError`` for an invalid link."""
    return {
        x.id: [
            read_target(link, context.home, f"{place_text(x.place)}, requirement {x.id}, {link.kind}")
            for link in x.links
        ]
        for x in requirement_set.requirements
    }


def states_of(
    requirement_set: RequirementSet,
    targets: Targets,
    evidence: Sequence[CheckedEvidence],
    context: TraceContext,
    locked: Mapping[Key, Parts] | None,
) -> States:
    """Return the state of each requirement and link.

    ``locked``: the parts that links rested on when they were accepted, None without a lock file.
    """
    rests_on: dict[Key, Parts] = {}
    links: dict[str, list[TracedLink]] = {}
    used: set[int] = set()
    for x in requirement_set.requirements:
        links[x.id] = []
        for target in targets[x.id]:
            matched = _LinkEvidence(
                target, findings_of_link(target, evidence, context.values, context.folder)
            )
            used |= {id(y) for y in (*matched.evidence, *(z for z in evidence if is_related(target.link, z)))}
            key = key_of(x, target.link)
            rests_on[key] = parts_of(x, target, matched.evidence, context)
            before = None if locked is None else locked.get(key)
            links[x.id].append(_link(matched, () if before is None else differences(before, rests_on[key])))
    states = _whole_states(requirement_set, links)
    traced = tuple(_traced(x, links[x.id], states[x.id]) for x in requirement_set.requirements)
    beside = tuple(x for x in evidence if id(x) not in used and _is_evidence(x))
    return States(traced, rests_on, beside)


def _is_evidence(x: CheckedEvidence) -> bool:
    """Return whether to list a finding that no requirement names; findings that sum up others are not
    listed.
    """
    finding = x.finding
    return finding.outcome is not Acceptance.ACCEPTED or (
        finding.kind != NO_EVIDENCE and finding.verdict not in ("READ", "DERIVED")
    )


def _link(matched: _LinkEvidence, changes: tuple[str, ...]) -> TracedLink:
    state, reason = combined_state(matched.target.link.kind, matched.shown)
    if changes and (state.is_shown or state is LinkState.STALE):
        state, reason = LinkState.STALE, NO_REASON
    return TracedLink(
        kind=matched.target.link.kind,
        target=matched.target.link.target,
        state=state,
        reason=reason,
        shows=tuple(dict.fromkeys(x.shows for x in matched.shown if x.shows and x.state is state)),
        changes=changes,
        evidence=tuple(x.as_linked for x in matched.evidence),
    )


def _traced(x: Requirement, links: Sequence[TracedLink], state: LinkState) -> TracedRequirement:
    return TracedRequirement(
        id=x.id,
        title=x.title,
        text=x.text,
        edition=x.edition,
        clause=x.clause,
        parents=x.parents,
        place=x.place,
        state=state,
        links=tuple(links),
    )


def _whole_states(
    requirement_set: RequirementSet, links: Mapping[str, Sequence[TracedLink]]
) -> dict[str, LinkState]:
    """Return the worst state of the links of each requirement and of all its parts.

    A requirement without links and without parts is MISSING.
    """
    parents = {x.id: x.parents for x in requirement_set.requirements}
    has_parts = {name for x in requirement_set.requirements for name in x.parents}
    inside: dict[str, list[LinkState]] = {x: [] for x in parents}
    for name in parents:
        own = [x.state for x in links[name]]
        if not own and name not in has_parts:
            own = [LinkState.MISSING]
        for upper in (name, *ancestors_of(name, parents)):
            inside[upper] += own
    return {name: worst(states) for name, states in inside.items()}


def worst(states: Iterable[LinkState]) -> LinkState:
    """Return the worst of several states, MISSING for none."""
    return max(states, key=lambda x: x.rank, default=LinkState.MISSING)
