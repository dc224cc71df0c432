"""What changed between two states of requirements."""

from collections.abc import Iterator, Mapping

from roadproof.extensions.assurance.answers.trace import Answer, LinkState, TracedLink, TracedRequirement
from roadproof.extensions.assurance.answers.trace_changes import Change, Way
from roadproof.reasons import NO_REASON, Reason, Why, joined


def changes_between(before: Answer, after: Answer) -> tuple[Change, ...]:
    """Requirements and links that were added or removed, or whose state or text is another; in order."""
    old = {x.id: x for x in before.requirements}
    new = {x.id: x for x in after.requirements}
    return tuple(
        change for name in dict.fromkeys((*old, *new)) for change in _of_one(old.get(name), new.get(name))
    )


def counts_between(before: Answer, after: Answer) -> dict[str, tuple[int, int]]:
    """By state, how many requirements have it before and after."""
    both = [[x.state for x in side.requirements] for side in (before, after)]
    return {str(x): (both[0].count(x), both[1].count(x)) for x in LinkState if x in both[0] or x in both[1]}


def _of_one(old: TracedRequirement | None, new: TracedRequirement | None) -> Iterator[Change]:
    if old is None or new is None:
        there = new or old
        assert there is not None
        yield _of_requirement(
            there.id, "added" if old is None else "removed", (old, new), Why.TOLD(there.title)
        )
        return
    if (old.title, old.text) != (new.title, new.text):
        yield _of_requirement(old.id, "text", (old, new), Why.TEXT_CHANGED())
    if old.state is not new.state:
        yield _of_requirement(old.id, _way(old.state, new.state), (old, new), NO_REASON)
    yield from _links(old.id, _by_name(old), _by_name(new))


def _of_requirement(
    name: str, how: Way, sides: tuple[TracedRequirement | None, TracedRequirement | None], reason: Reason
) -> Change:
    before, after = (None if x is None else x.state for x in sides)
    return Change(requirement=name, kind=None, target="", how=how, before=before, after=after, reason=reason)


def _links(name: str, old: Mapping[str, TracedLink], new: Mapping[str, TracedLink]) -> Iterator[Change]:
    for key in dict.fromkeys((*old, *new)):
        one, other = old.get(key), new.get(key)
        link = other or one
        assert link is not None
        if one is not None and other is not None and one.state is other.state:
            continue
        how: Way = "added" if one is None else "removed"
        if one is not None and other is not None:
            how = _way(one.state, other.state)
        yield Change(
            requirement=name,
            kind=link.kind,
            target=link.target,
            how=how,
            before=None if one is None else one.state,
            after=None if other is None else other.state,
            reason=joined((*map(Why.TOLD, link.changes), link.reason)),
        )


def _by_name(x: TracedRequirement) -> dict[str, TracedLink]:
    return {f"{link.kind} {link.target}": link for link in x.links}


def _way(before: LinkState, after: LinkState) -> Way:
    return "better" if after.rank < before.rank else "worse"
