"""Which parts of scenarios are redundant, in words."""

from collections.abc import Mapping

from roadproof.analysis.redundancy import ChangeFinding, ChangeFindings
from roadproof.library.words import Called, legend
from roadproof.verdict import Verdict


def as_text(findings: Mapping[int, ChangeFindings], seconds: float, words: Called) -> str:
    """What is redundant and what is in doubt, by scenario; how the others were told apart, in numbers."""
    every = [(number, x) for number, each in findings.items() for x in each]
    lines = []
    for number, x in every:
        if x.redundant:
            where = " for motion" if x.assuming else ""
            lines.append(f"scenario {number}: redundant{where}: {_change(x)}")
    doubts = [(number, x) for number, x in every if x.verdict is Verdict.UNKNOWN]
    lines += [f"scenario {number}: in doubt: {_change(x)}: {x.reason}" for number, x in doubts]
    lines += [f"  {line}" for line in legend(words)] if lines else []
    redundant = sum(x.redundant is True and x.assuming is None for _, x in every)
    moving = sum(x.redundant is True and x.assuming is not None for _, x in every)
    drives = sum(x.drive is not None for _, x in every)
    traces = sum(x.trace is not None for _, x in every)
    lines.append(
        f"{len(every)} changes: {redundant} redundant, {moving} more for motion, {drives} told apart by a "
        f"drive, {traces} by a trace, {len(doubts)} in doubt, in {seconds:.1f} s"
    )
    return "\n".join(lines)


def _change(finding: ChangeFinding) -> str:
    change = finding.change
    return f"{change.part} in {change.where[-1]} as {str(change.value).lower()}"
