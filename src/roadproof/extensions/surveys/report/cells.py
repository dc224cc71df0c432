"""Cells of heat maps, with names below and beside them."""

from collections.abc import Sequence
from typing import Any


def draw_cell(axes: Any, x: int, y: int, colour: str, text: object = None, ink: str = "black") -> None:
    """A cell of a heat map, one unit wide and high, with a text in it."""
    axes.fill((x, x + 1, x + 1, x), (y, y, y + 1, y + 1), color=colour, ec="white", lw=0.8)
    if text is not None:
        axes.text(x + 0.5, y + 0.5, str(text), fontsize=8, color=ink, ha="center", va="center")


def name_cells(axes: Any, columns: Sequence[str], rows: Sequence[str], size: int) -> None:
    """Names below and beside the middles of cells."""
    axes.set_xticks([k + 0.5 for k in range(len(columns))], columns, fontsize=size)
    axes.set_yticks([k + 0.5 for k in range(len(rows))], rows, fontsize=size)
