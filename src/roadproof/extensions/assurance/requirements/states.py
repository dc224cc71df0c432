"""The state of every requirement, from the evidence that its links and its parts have."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from roadproof.evidence.finding import NO_EVIDENCE, Acceptance
from roadproof.extensions.assurance.answers.trace import LinkState, TracedLink, TracedRequirement
from roadproof.extensions.assurance.requirements.checked_evidence import CheckedEvidence
from roadproof.extensions.assurance.requirements.fingerprints import (
    Key,
    Parts,
    Surroundings,
    differences,
    key_of,
    parts_of,
)
from roadproof.extensions.assurance.requirements.matching import (
    Shown,
    Target,
    combined,
    is_beside,
    read_target,
    shown_by,
)
from roadproof.extensions.assurance.requirements.requirement import Requirement, Requirements, above, told
from roadproof.reasons import NO_REASON


@dataclass(frozen=True)
class States:
    """Requirements with their states, what each link rests on, and the evidence that none names."""

    requirements: tuple[TracedRequirement, ...]
    rests_on: Mapping[Key, Parts]
    unlinked: tuple[CheckedEvidence, ...]


@dataclass(frozen=True)
class _Matched:
    """A link with what shows it."""

    target: Target
    shown: Sequence[Shown]

    @property
    def evidence(self) -> list[CheckedEvidence]:
        return [x.evidence for x in self.shown]


Targets = Mapping[str, Sequence[Target]]
"""The links of each requirement, by its id."""


def read_targets(given: Requirements, around: Surroundings) -> Targets:
    """All links, read with the definitions of the trace. Raises ``InputError`` for one that is no link."""
    return {
        x.id: [
            read_target(link, around.home, f"{told(x.place)}, requirement {x.id}, {link.kind}")
            for link in x.links
        ]
        for x in given.requirements
    }


def states_of(
    given: Requirements,
    targets: Targets,
    evidence: Sequence[CheckedEvidence],
    around: Surroundings,
    locked: Mapping[Key, Parts] | None,
) -> States:
    """What the evidence says of each requirement. ``locked``: what links rested on when accepted."""
    rests_on: dict[Key, Parts] = {}
    links: dict[str, list[TracedLink]] = {}
    used: set[int] = set()
    for x in given.requirements:
        links[x.id] = []
        for target in targets[x.id]:
            found = _Matched(target, shown_by(target, evidence, around.values, around.folder))
            used |= {id(y) for y in (*found.evidence, *(z for z in evidence if is_beside(target.link, z)))}
            key = key_of(x, target.link)
            rests_on[key] = parts_of(x, target, found.evidence, around)
            before = None if locked is None else locked.get(key)
            links[x.id].append(_link(found, () if before is None else differences(before, rests_on[key])))
    states = _whole_states(given, links)
    traced = tuple(_traced(x, links[x.id], states[x.id]) for x in given.requirements)
    beside = tuple(x for x in evidence if id(x) not in used and _is_evidence(x))
    return States(traced, rests_on, beside)


def _is_evidence(x: CheckedEvidence) -> bool:
    """Whether a finding is listed where no requirement names it: not one that sums up others."""
    finding = x.finding
    return finding.outcome is not Acceptance.ACCEPTED or (
        finding.kind != NO_EVIDENCE and finding.verdict not in ("READ", "DERIVED")
    )


def _link(found: _Matched, changes: tuple[str, ...]) -> TracedLink:
    state, reason = combined(found.target.link.kind, found.shown)
    if changes and (state.is_shown or state is LinkState.STALE):
        state, reason = LinkState.STALE, NO_REASON
    return TracedLink(
        kind=found.target.link.kind,
        target=found.target.link.target,
        state=state,
        reason=reason,
        changes=changes,
        evidence=tuple(x.kept for x in found.evidence),
    )


def _traced(x: Requirement, links: Sequence[TracedLink], state: LinkState) -> TracedRequirement:
    return TracedRequirement(
        id=x.id, title=x.title, text=x.text, parents=x.parents, place=x.place, state=state, links=tuple(links)
    )


def _whole_states(given: Requirements, links: Mapping[str, Sequence[TracedLink]]) -> dict[str, LinkState]:
    """The worst state of the links of each requirement and of all its parts.

    A requirement without links and without parts is missing.
    """
    parents = {x.id: x.parents for x in given.requirements}
    has_parts = {name for x in given.requirements for name in x.parents}
    inside: dict[str, list[LinkState]] = {x: [] for x in parents}
    for name in parents:
        own = [x.state for x in links[name]]
        if not own and name not in has_parts:
            own = [LinkState.MISSING]
        for upper in (name, *above(name, parents)):
            inside[upper] += own
    return {name: worst(found) for name, found in inside.items()}


def worst(states: Iterable[LinkState]) -> LinkState:
    """The worst of several states; missing where there is none."""
    return max(states, key=lambda x: x.rank, default=LinkState.MISSING)
