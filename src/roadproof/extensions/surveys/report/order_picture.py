"""The Hasse diagram of the order of scenarios."""

from collections.abc import Mapping, Sequence
from typing import Any

from roadproof.frontends.api.ordering import Orders
from roadproof.frontends.report.figures import make_figure
from roadproof.frontends.report.picture import Picture, picture
from roadproof.library.scenarios import Scenario
from roadproof.library.words import ScenarioWords
from roadproof.questions.order.deciding import Edge
from roadproof.questions.order.kinds import Kind
from roadproof.questions.order.question import OrderView


def draw_answer(answer: Orders) -> Picture:
    """Return the diagram of an answer."""
    sets = ", ".join(answer.question.basis.set_names)
    title = f"implications in {sets}; an arrow leads to what is implied"
    return picture(draw_order(answer.view, title, answer.words))


def draw_order(order: OrderView, title: str, words: ScenarioWords) -> Any:
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
        label = f"{words[number].title}\n{words[number].sector}".strip()
        axes.text(x, -0.45, label, fontsize=6, rotation=90, ha="center", va="top")
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
