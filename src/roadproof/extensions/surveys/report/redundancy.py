"""A text and a table of redundant parts of scenarios."""

from collections.abc import Mapping, Sequence

from roadproof.extensions.surveys.redundancy import ChangeFinding, ChangeFindingData
from roadproof.frontends.report.numbers import took
from roadproof.frontends.report.sheet import Column, Sheet, Trail
from roadproof.library.words import ScenarioWords, legend
from roadproof.verdict import Verdict


def as_text(findings: Mapping[int, Sequence[ChangeFinding]], seconds: float, words: ScenarioWords) -> str:
    """Return the redundant and undecided parts by scenario, and counts of the others."""
    every = [(number, x) for number, each in findings.items() for x in each]
    lines = []
    for number, x in every:
        if x.redundant:
            where = " for motion" if x.assuming else ""
            lines.append(f"scenario {number}: redundant{where}: {_change(x)}")
    undecided = [(number, x) for number, x in every if x.verdict is Verdict.UNKNOWN]
    lines += [f"scenario {number}: in doubt: {_change(x)}: {x.reason}" for number, x in undecided]
    lines += [f"  {line}" for line in legend(words)] if lines else []
    redundant = sum(x.redundant is True and x.assuming is None for _, x in every)
    moving = sum(x.redundant is True and x.assuming is not None for _, x in every)
    drives = sum(x.shown is not None and x.shown.drive is not None for _, x in every)
    traces = sum(x.verdict is Verdict.REFUTED for _, x in every) - drives
    lines.append(
        f"{len(every)} changes: {redundant} redundant, {moving} more for motion, {drives} told apart by a "
        f"drive, {traces} by a trace, {len(undecided)} in doubt{took(seconds or None, ',')}"
    )
    return "\n".join(lines)


_SIGNS: Mapping[bool | None, str] = {
    True: "✗\u00a0could\u00a0go",
    False: "✓\u00a0needed",
    None: "?\u00a0in\u00a0doubt",
}


def sheet_of(findings: Sequence[ChangeFindingData], names: Mapping[int, str]) -> Sheet[ChangeFindingData]:
    """Return a sheet with an entry for each change; ``names``: those of scenarios."""
    return Sheet(
        (
            Column("", lambda x: _SIGNS[x.redundant], "page", link="change"),
            Column("scenario", lambda x: x.scenario, "frame"),
            Column("name", lambda x: names.get(x.scenario, ""), "frame"),
            Column("scenario", lambda x: f"{x.scenario} {names.get(x.scenario, '')}".rstrip(), "page"),
            Column("where", lambda x: Trail(x.where)),
            Column("part", lambda x: x.part, look="code"),
            Column("as", lambda x: x.value, "frame"),
            Column("put in its place", lambda x: f"as {str(x.value).lower()}", "page"),
            Column("assuming", lambda x: x.assuming, heading="where it is assumed that"),
            Column("redundant", lambda x: x.redundant, "frame"),
            Column("verdict", lambda x: x.verdict, "frame"),
            Column("reason", lambda x: x.reason, "frame"),
        ),
        findings,
    )


def _change(finding: ChangeFinding) -> str:
    change = finding.change
    return f"{change.part} in {change.where[-1]} as {str(change.value).lower()}"
