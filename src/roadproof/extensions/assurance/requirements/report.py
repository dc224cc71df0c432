"""Presents traced requirements as terminal text, tables and Markdown."""

from collections import Counter
from collections.abc import Iterator, Sequence

from roadproof.evidence.finding import Acceptance
from roadproof.extensions.assurance.answers.trace import (
    LinkedEvidence,
    LinkState,
    TraceData,
    TracedLink,
    TracedRequirement,
)
from roadproof.extensions.assurance.answers.trace_changes import TraceChange, TraceChangesData
from roadproof.frontends.report.sheet import Column, Sheet, aligned, excerpt
from roadproof.runtime.records import dataclass

MOST_LINES = 20
"""The number of pieces of evidence without a requirement that a terminal lists."""


@dataclass(frozen=True)
class LinkRow:
    """A link with its requirement; ``link``: None for a requirement without links."""

    requirement: TracedRequirement
    link: TracedLink | None

    @property
    def state(self) -> LinkState:
        """The state of the link, or of a requirement without links."""
        return self.requirement.state if self.link is None else self.link.state


def sheet_of(answer: TraceData) -> Sheet[LinkRow]:
    """Return a table with a row for each link, and for each requirement without links."""
    return Sheet(
        (
            Column("requirement", lambda x: x.requirement.id, look="strong"),
            Column("title", lambda x: _title_of(x.requirement)),
            Column("edition", lambda x: x.requirement.edition),
            Column("clause", lambda x: x.requirement.clause),
            Column("kind", lambda x: "" if x.link is None else x.link.kind),
            Column("target", lambda x: "" if x.link is None else x.link.target, look="code"),
            Column("state", lambda x: x.state, look="verdict"),
            Column("shows", lambda x: "" if x.link is None else "; ".join(x.link.shows)),
            Column("reason", lambda x: reason_of(x.link)),
            Column("evidence", lambda x: "; ".join(_files(x.link)), "csv"),
            Column("line", lambda x: x.requirement.place.line, "csv"),
        ),
        [LinkRow(x, link) for x in answer.requirements for link in (x.links or (None,))],
    )


def _title_of(x: TracedRequirement) -> str:
    return x.title or excerpt(" ".join(x.text.split()), 70)


def reason_of(link: TracedLink | None) -> str:
    """Return the reason why a link is not shown, with the parts that changed."""
    if link is None:
        return ""
    return "; ".join(filter(None, (link.reason, ", ".join(link.changes))))


def _files(link: TracedLink | None) -> list[str]:
    return [] if link is None else [*dict.fromkeys(x.where for x in link.evidence)]


def counted(answer: TraceData) -> str:
    """Return a sentence with the number of requirements in each state."""
    counts = Counter(x.state for x in answer.requirements)
    shown = sum(n for state, n in counts.items() if state.is_shown)
    states = ", ".join(f"{counts[x]} {x}" for x in LinkState if counts[x])
    return f"{shown} of {len(answer.requirements)} requirements shown: {states}"


def as_lines(answer: TraceData) -> list[str]:
    """Return a line for each requirement with its links below, evidence without a requirement, and counts."""
    rows: list[list[str]] = []
    for x in answer.requirements:
        rows.append([str(x.state), x.id, _title_of(x)])
        for link in x.links:
            reason = excerpt("; ".join(filter(None, (*link.shows, reason_of(link)))), 160)
            target = excerpt(f"{link.kind} {' '.join(link.target.split())}", 90)
            rows.append(["", "", f"  {link.state}: {target}" + (f" ({reason})" if reason else "")])
    lines = aligned(rows)
    if answer.unlinked:
        lines.append("evidence without a requirement:")
        worst_first = sorted(answer.unlinked, key=lambda x: x.outcome is Acceptance.ACCEPTED)
        lines += [f"  {unlinked_line(x)}" for x in worst_first[:MOST_LINES]]
        more = len(answer.unlinked) - MOST_LINES
        lines += [f"  and {more} more"] if more > 0 else []
    return [*lines, *answer.notes, counted(answer)]


def unlinked_line(x: LinkedEvidence) -> str:
    """Return a line about evidence without a requirement."""
    if x.outcome is not Acceptance.ACCEPTED:
        label = f"{x.label}  " if x.label else ""
        return f"{x.outcome}  {label}{x.where}: {x.reason}"
    return f"{x.verdict}  {x.label or excerpt(x.claim, 80)}  {x.where}"


def as_markdown(answer: TraceData) -> str:
    """Return a Markdown table of the requirements, and one of evidence without a requirement."""
    lines = ["# Requirements", "", counted(answer) + ".", ""]
    lines += _table(
        ["requirement", "edition", "clause", "state", "links", "place"],
        (
            [
                f"**{_cell(x.id)}** {_cell(_title_of(x))}",
                _cell(x.edition),
                _cell(x.clause),
                str(x.state),
                "<br>".join(map(_link, x.links)),
                f"{_cell(x.place.file)}:{x.place.line}",
            ]
            for x in answer.requirements
        ),
    )
    if answer.unlinked:
        lines += ["", "## Evidence without a requirement", ""]
        lines += _table(
            ["evidence", "verdict", "outcome"],
            ([_cell(x.label or x.where), x.verdict, str(x.outcome)] for x in answer.unlinked),
        )
    return "\n".join(lines) + "\n"


def _link(link: TracedLink) -> str:
    reason = _cell("; ".join(filter(None, (*link.shows, reason_of(link)))))
    return f"{link.state}: {link.kind} `{_code(link.target)}`" + (f" ({reason})" if reason else "")


def _cell(text: str) -> str:
    """Return a text for a cell of a Markdown table."""
    return _code(text).replace("<", "&lt;")


def _code(text: str) -> str:
    """Return a text for a cell of a Markdown table, between backticks."""
    return " ".join(text.split()).replace("|", "\\|").replace("`", "'")


def _table(header: Sequence[str], rows: Iterator[Sequence[str]]) -> Iterator[str]:
    yield f"| {' | '.join(header)} |"
    yield f"|{'---|' * len(header)}"
    for row in rows:
        yield f"| {' | '.join(row)} |"


def changes_sheet(answer: TraceChangesData) -> Sheet[TraceChange]:
    """Return a table with a row for each change."""
    return Sheet(
        (
            Column("requirement", lambda x: x.requirement),
            Column("link", lambda x: "" if x.kind is None else f"{x.kind} {x.target}"),
            Column("change", lambda x: x.how),
            Column("before", lambda x: x.before),
            Column("after", lambda x: x.after),
            Column("reason", lambda x: x.reason),
        ),
        answer.changes,
    )


_HOW = {"worse": "got worse", "removed": "removed", "better": "got better", "added": "added", "text": "text"}


def changes_lines(answer: TraceChangesData) -> list[str]:
    """Return a line for each change, the worst first, then the counts of requirements before and after."""
    lines: list[str] = []
    for how, words in _HOW.items():
        for x in answer.changes:
            if x.how == how:
                link = "" if x.kind is None else f"  {x.kind} {' '.join(x.target.split())}"
                states = " -> ".join(str(y) for y in (x.before, x.after) if y is not None)
                transition = "" if how == "text" else f": {states}"
                lines.append(
                    f"{words}  {x.requirement}{link}{transition}" + (f" ({x.reason})" if x.reason else "")
                )
    counts = ", ".join(f"{state} {old} -> {new}" for state, (old, new) in answer.counts.items())
    return [*(lines or ["nothing changed"]), f"requirements: {counts}"]
