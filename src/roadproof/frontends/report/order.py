"""The order of scenarios under implication: in words, and as DOT text; an extension draws it."""

from collections.abc import Mapping

from roadproof.frontends.report.numbers import took
from roadproof.frontends.report.sheet import Column, Sheet
from roadproof.library.words import ScenarioWords, legend
from roadproof.questions.order.question import OrderView
from roadproof.verdict import Verdict


def as_text(order: OrderView, seconds: float, words: ScenarioWords) -> str:
    """The edges, the scenarios with one formula, the doubts; what they are called; the rest in numbers."""
    lines = [f"{edge.above} -> {edge.below}" for edge in order.edges]
    shared = [kind for kind in order.kinds if len(kind.nodes) > 1]
    lines += [f"one formula: {', '.join(map(str, kind.nodes))}" for kind in shared]
    lines += [f"in doubt: {x.above} -> {x.below}: {x.reason}" for x in order.doubts]
    lines += [f"  {line}" for line in legend(words)] if lines else []
    count = sum(len(kind.nodes) for kind in order.kinds)
    lines.append(
        f"{count} scenarios, {len(order.kinds)} formulas: {len(order.edges)} edges proved, "
        f"{len(order.missing)} implications refuted by {len(order.drives)} drives, "
        f"{len(order.doubts)} in doubt{took(seconds or None, ',')}"
    )
    return "\n".join(lines)


def sheet_of(verdicts: Mapping[str, Verdict]) -> Sheet[tuple[str, Verdict]]:
    """An entry for each implication, ``4@base -> 4@ext``."""
    return Sheet(
        (Column("implication", lambda x: x[0]), Column("verdict", lambda x: x[1], look="verdict")),
        [*verdicts.items()],
    )


def as_dot(order: OrderView, words: ScenarioWords) -> str:
    """A graph in which an arrow leads from what implies to what is implied; one box a formula."""
    number = {kind.node: k for k, kind in enumerate(order.kinds)}
    lines = ["digraph order {", "  rankdir=BT;", "  node [shape=box, fontsize=10];"]
    for k, kind in enumerate(order.kinds):
        names = dict.fromkeys(words[node.number].name.replace('"', "'") for node in kind.nodes)
        label = "\\n".join(filter(None, (*map(str, kind.nodes), *names)))
        lines.append(f'  k{k} [label="{label}"];')
    lines += [f"  k{number[edge.above]} -> k{number[edge.below]};" for edge in order.edges]
    return "\n".join([*lines, "}"]) + "\n"
