"""Compares two states of requirements."""

from collections.abc import Iterator, Mapping

from roadproof.extensions.assurance.answers.trace import LinkState, TraceData, TracedLink, TracedRequirement
from roadproof.extensions.assurance.answers.trace_changes import ChangeKind, TraceChange
from roadproof.reasons import NO_REASON, Reason, ReasonKind, joined


def changes_between(before: TraceData, after: TraceData) -> tuple[TraceChange, ...]:
    """Return the requirements and links that were added, removed, or changed in state or text, in order."""
    old = {x.id: x for x in before.requirements}
    new = {x.id: x for x in after.requirements}
    return tuple(
        change
        for name in dict.fromkeys((*old, *new))
        for change in _requirement_changes(old.get(name), new.get(name))
    )


def counts_between(before: TraceData, after: TraceData) -> dict[str, tuple[int, int]]:
    """Return the number of requirements in each state before and after, by state."""
    both = [[x.state for x in side.requirements] for side in (before, after)]
    return {str(x): (both[0].count(x), both[1].count(x)) for x in LinkState if x in both[0] or x in both[1]}


def _requirement_changes(
    old: TracedRequirement | None, new: TracedRequirement | None
) -> Iterator[TraceChange]:
    if old is None or new is None:
        known = new or old
        assert known is not None
        yield _requirement_change(
            known.id, "added" if old is None else "removed", (old, new), ReasonKind.TOLD(known.title)
        )
        return
    if (old.title, old.text) != (new.title, new.text):
        yield _requirement_change(old.id, "text", (old, new), ReasonKind.TEXT_CHANGED())
    if old.state is not new.state:
        yield _requirement_change(old.id, _way(old.state, new.state), (old, new), NO_REASON)
    yield from _link_changes(old.id, _by_name(old), _by_name(new))


def _requirement_change(
    name: str,
    how: ChangeKind,
    sides: tuple[TracedRequirement | None, TracedRequirement | None],
    reason: Reason,
) -> TraceChange:
    before, after = (None if x is None else x.state for x in sides)
    return TraceChange(
        requirement=name, kind=None, target="", how=how, before=before, after=after, reason=reason
    )


def _link_changes(
    name: str, old: Mapping[str, TracedLink], new: Mapping[str, TracedLink]
) -> Iterator[TraceChange]:
    for key in dict.fromkeys((*old, *new)):
        one, other = old.get(key), new.get(key)
        link = other or one
        assert link is not None
        if one is not None and other is not None and one.state is other.state:
            continue
        how: ChangeKind = "added" if one is None else "removed"
        if one is not None and other is not None:
            how = _way(one.state, other.state)
        yield TraceChange(
            requirement=name,
            kind=link.kind,
            target=link.target,
            how=how,
            before=None if one is None else one.state,
            after=None if other is None else other.state,
            reason=joined((*map(ReasonKind.TOLD, link.changes), link.reason)),
        )


def _by_name(x: TracedRequirement) -> dict[str, TracedLink]:
    return {f"{link.kind} {link.target}": link for link in x.links}


def _way(before: LinkState, after: LinkState) -> ChangeKind:
    return "better" if after.rank < before.rank else "worse"
