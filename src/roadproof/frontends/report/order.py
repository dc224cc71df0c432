"""The order of scenarios under implication: in words, as DOT text, and as a Hasse diagram."""

from collections.abc import Mapping, Sequence
from typing import Any

from roadproof.frontends.report.figures import make_figure
from roadproof.frontends.report.numbers import took
from roadproof.frontends.report.sheet import Column, Sheet
from roadproof.library.scenarios import Scenario
from roadproof.library.words import Called, legend
from roadproof.questions.order.deciding import Edge
from roadproof.questions.order.kinds import Kind
from roadproof.questions.order.question import OrderView
from roadproof.verdict import Verdict


def as_text(order: OrderView, seconds: float, words: Called) -> str:
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


def as_dot(order: OrderView, words: Called) -> str:
    """A graph in which an arrow leads from what implies to what is implied; one box a formula."""
    number = {kind.node: k for k, kind in enumerate(order.kinds)}
    lines = ["digraph order {", "  rankdir=BT;", "  node [shape=box, fontsize=10];"]
    for k, kind in enumerate(order.kinds):
        names = dict.fromkeys(words[node.number].name.replace('"', "'") for node in kind.nodes)
        label = "\\n".join(filter(None, (*map(str, kind.nodes), *names)))
        lines.append(f'  k{k} [label="{label}"];')
    lines += [f"  k{number[edge.above]} -> k{number[edge.below]};" for edge in order.edges]
    return "\n".join([*lines, "}"]) + "\n"


def draw_order(order: OrderView, title: str, words: Called) -> Any:
    """The diagram: a column for each scenario's number, which is named below, weaker ones higher."""
    kinds, edges = order.kinds, order.edges
    height = _heights(kinds, edges)
    columns = sorted({kind.node.number for kind in kinds})
    width = max(6.0, 0.55 * len(columns) + 1)
    figure, (axes,) = make_figure([2.8 + 0.7 * (max(height.values()) + 1)], width)
    place = _places(kinds, height, columns)
    for edge in edges:
        (x1, y1), (x2, y2) = place[edge.above], place[edge.below]
        arrow = {"arrowstyle": "->", "lw": 0.8, "shrinkA": 8, "shrinkB": 8, "color": "#444444"}
        axes.annotate("", (x2, y2), (x1, y1), arrowprops=arrow)
    for kind in kinds:
        x, y = place[kind.node]
        box = {"boxstyle": "round,pad=0.2", "fc": "#eef2f5", "ec": "#667788", "lw": 0.6}
        names = "\n".join(map(str, kind.nodes))
        axes.text(x, y, names, fontsize=5, ha="center", va="center", bbox=box)
    for x, number in enumerate(columns):
        told = f"{words[number].title}\n{words[number].sector}".strip()
        axes.text(x, -0.45, told, fontsize=6, rotation=90, ha="center", va="top")
    axes.set_xlim(-0.7, len(columns) - 0.3)
    axes.set_ylim(-0.5, max(y for _, y in place.values()) + 0.5)
    axes.axis("off")
    figure.suptitle(title, fontsize=8)
    return figure


def _heights(kinds: Sequence[Kind], edges: Sequence[Edge]) -> dict[Scenario, int]:
    """The longest chain of edges below each kind; a circle of equivalent ones is cut at the bound."""
    height = {kind.node: 0 for kind in kinds}
    for _ in kinds:
        for edge in edges:
            height[edge.below] = min(max(height[edge.below], height[edge.above] + 1), len(kinds))
    return height


def _places(
    kinds: Sequence[Kind], height: Mapping[Scenario, int], columns: Sequence[int]
) -> dict[Scenario, tuple[float, float]]:
    """A place for each kind; of two that would have the same one, the later is put higher."""
    place: dict[Scenario, tuple[float, float]] = {}
    for kind in kinds:
        spot = (float(columns.index(kind.node.number)), float(height[kind.node]))
        while spot in place.values():
            spot = (spot[0], spot[1] + 0.5)
        place[kind.node] = spot
    return place
