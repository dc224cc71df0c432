"""The Hasse diagram of scenarios under implication: DOT text, and a picture."""

from collections.abc import Mapping, Sequence
from typing import Any

from roadproof.report.figures import as_bytes, make_figure


def as_dot(kinds: Sequence[Sequence[str]], edges: Sequence[Mapping[str, Any]]) -> str:
    """A graph in which an arrow leads from what implies to what is implied; one box a formula."""
    number = {kind[0]: k for k, kind in enumerate(kinds)}
    lines = ["digraph order {", "  rankdir=BT;", "  node [shape=box, fontsize=10];"]
    lines += [f'  k{k} [label="{_label(kind)}"];' for k, kind in enumerate(kinds)]
    lines += [f"  k{number[e['from']]} -> k{number[e['to']]};" for e in edges]
    return "\n".join([*lines, "}"]) + "\n"


def draw_order(
    kinds: Sequence[Sequence[str]], edges: Sequence[Mapping[str, Any]], title: str
) -> dict[str, bytes]:
    """The diagram as ``{"png": …, "svg": …}``: a column for each scenario's number, weaker ones higher."""
    height = _heights(kinds, edges)
    columns = sorted({_number(kind[0]) for kind in kinds})
    figure, (axes,) = make_figure([1.2 + 0.7 * (max(height.values()) + 1)], width=0.55 * len(columns) + 1)
    place = _places(kinds, height, columns)
    for edge in edges:
        (x1, y1), (x2, y2) = place[edge["from"]], place[edge["to"]]
        arrow = {"arrowstyle": "->", "lw": 0.8, "shrinkA": 8, "shrinkB": 8, "color": "#444444"}
        axes.annotate("", (x2, y2), (x1, y1), arrowprops=arrow)
    for kind in kinds:
        x, y = place[kind[0]]
        box = {"boxstyle": "round,pad=0.2", "fc": "#eef2f5", "ec": "#667788", "lw": 0.6}
        axes.text(x, y, "\n".join(kind), fontsize=5, ha="center", va="center", bbox=box)
    axes.set_xlim(-0.7, len(columns) - 0.3)
    axes.set_ylim(-0.5, max(y for _, y in place.values()) + 0.5)
    axes.axis("off")
    figure.suptitle(title, fontsize=8)
    return as_bytes(figure)


def _label(kind: Sequence[str]) -> str:
    return "\\n".join(kind)


def _number(name: str) -> int:
    return int(name.partition("@")[0])


def _heights(kinds: Sequence[Sequence[str]], edges: Sequence[Mapping[str, Any]]) -> dict[str, int]:
    """The longest chain of edges below each kind; a circle of equivalent ones is cut at the bound."""
    height = {kind[0]: 0 for kind in kinds}
    for _ in kinds:
        for edge in edges:
            height[edge["to"]] = min(max(height[edge["to"]], height[edge["from"]] + 1), len(kinds))
    return height


def _places(
    kinds: Sequence[Sequence[str]], height: Mapping[str, int], columns: Sequence[int]
) -> dict[str, tuple[float, float]]:
    """A place for each kind; of two that would have the same one, the later is put higher."""
    place: dict[str, tuple[float, float]] = {}
    for kind in kinds:
        spot = (float(columns.index(_number(kind[0]))), float(height[kind[0]]))
        while spot in place.values():
            spot = (spot[0], spot[1] + 0.5)
        place[kind[0]] = spot
    return place
