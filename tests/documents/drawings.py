"""Drawings of docs/explanation/how.md; ``make generated`` writes them into docs/pictures."""

from collections.abc import Mapping
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import Literal

FOLDER = Path(__file__).parents[2] / "docs" / "pictures"
WIDTH, GAP, HEIGHT, STEP, MARGIN, LINE = 232, 44, 54, 88, 16, 17
STYLE = """
.ground { fill: #ffffff } text { fill: #1b2430 } .arrow { stroke: #5a6472 } .head { fill: #5a6472 }
.given { fill: #d9ecf7; stroke: #0072b2 } .right { fill: #fdebcf; stroke: #b36b00 }
.search { fill: #f1f1f1; stroke: #7a7a7a; stroke-dasharray: 5 3 } .answer { fill: #d8efe4; stroke: #00795a }
@media (prefers-color-scheme: dark) {
.ground { fill: #1e2129 } text { fill: #e6e9ef } .arrow { stroke: #a9b2c0 } .head { fill: #a9b2c0 }
.given { fill: #173a52; stroke: #56b4e9 } .right { fill: #4a3413; stroke: #e69f00 }
.search { fill: #2c303a; stroke: #9aa0aa } .answer { fill: #12402f; stroke: #3ecf9c } }
"""
LEGEND = {
    "given": "given",
    "search": "not trusted: results are checked",
    "right": "trusted",
    "answer": "answer",
}


@dataclass(frozen=True)
class Box:
    """A stage of ``lines`` at a place of the grid, ``columns`` wide; ``of`` says how far it is trusted."""

    column: float
    row: float
    of: Literal["given", "search", "right", "answer"]
    lines: str
    columns: float = 1

    @property
    def left(self) -> float:
        return MARGIN + self.column * (WIDTH + GAP)

    @property
    def right(self) -> float:
        return self.left + self.columns * (WIDTH + GAP) - GAP

    @property
    def top(self) -> float:
        return MARGIN + self.row * STEP

    @property
    def middle(self) -> float:
        return self.top + HEIGHT / 2

    def draw(self) -> list[str]:
        lines = self.lines.split("\n")
        at = (self.left + self.right) / 2
        first = self.middle + 5 - LINE * (len(lines) - 1) / 2
        return [
            f'<rect class="{self.of}" x="{self.left:g}" y="{self.top:g}" width="{self.right - self.left:g}" '
            f'height="{HEIGHT}" rx="6" stroke-width="1.5"/>',
            *(_text(at, first + k * LINE, line) for k, line in enumerate(lines)),
        ]


@dataclass(frozen=True)
class Arrow:
    """From a box to another, below it or beside it; ``shift`` moves it off the middle, by pixels."""

    start: str
    end: str
    label: str = ""
    shift: float = 0

    def draw(self, boxes: Mapping[str, Box]) -> list[str]:
        a, b = boxes[self.start], boxes[self.end]
        if a.row == b.row:
            sign = 1 if a.column < b.column else -1
            x0, x1 = (a.right, b.left) if sign > 0 else (a.left, b.right)
            y = a.middle + self.shift
            ends = f"M{x0:g} {y:g} H{x1 - 6 * sign:g}"
            head = f"M{x1 - 7 * sign:g} {y - 5:g} L{x1:g} {y:g} L{x1 - 7 * sign:g} {y + 5:g} Z"
            label = _text((x0 + x1) / 2, y - 6 if self.shift <= 0 else y + 15, self.label, 12)
        else:
            x = (max(a.left, b.left) + min(a.right, b.right)) / 2 + self.shift
            y0, y1 = a.top + HEIGHT, b.top
            ends = f"M{x:g} {y0:g} V{y1 - 6:g}"
            head = f"M{x - 5:g} {y1 - 7:g} L{x:g} {y1:g} L{x + 5:g} {y1 - 7:g} Z"
            label = _text(x + 8, y0 + 21, self.label, 12, "start")
        drawn = [f'<path class="arrow" d="{ends}" stroke-width="1.5"/>', f'<path class="head" d="{head}"/>']
        return [*drawn, label] if self.label else drawn


def _text(x: float, y: float, text: str, size: int = 14, anchor: str = "middle") -> str:
    return f'<text x="{x:g}" y="{y:g}" font-size="{size}" text-anchor="{anchor}">{escape(text)}</text>'


def drawing(title: str, boxes: Mapping[str, Box], arrows: tuple[Arrow, ...]) -> str:
    """A drawing as SVG, in the colours of a light or a dark page, with a legend."""
    width = max(box.right for box in boxes.values()) + MARGIN
    below = max(box.top for box in boxes.values()) + HEIGHT + 20
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:g} {below + 32:g}" '
        'font-family="Helvetica, Arial, DejaVu Sans, sans-serif">',
        f"<title>{escape(title)}</title>",
        f"<style>{STYLE}</style>",
        f'<rect class="ground" width="{width:g}" height="{below + 32:g}"/>',
    ]
    for box in boxes.values():
        lines += box.draw()
    for arrow in arrows:
        lines += arrow.draw(boxes)
    x: float = MARGIN
    for kind in [kind for kind in LEGEND if any(box.of == kind for box in boxes.values())]:
        lines.append(f'<rect class="{kind}" x="{x:g}" y="{below:g}" width="18" height="14" rx="3"/>')
        lines.append(_text(x + 25, below + 12, LEGEND[kind], 12, "start"))
        x += 55 + 7 * len(LEGEND[kind])
    return "\n".join([*lines, "</svg>", ""])


def proof() -> str:
    """How ``prove`` decides a claim."""
    boxes = {
        "claim": Box(0, 0, "given", "claim and definitions, as text", 3),
        "formula": Box(0, 1, "right", "one formula: names, units and calls resolved", 3),
        "negated": Box(
            0, 2, "search", "negated claim; lanes, vehicles and instants that exist in it get names", 3
        ),
        "z3": Box(0, 3, "search", "z3: a model of the\nclauses without quantifiers?"),
        "instances": Box(1, 3, "search", "instantiate where the model\nviolates a universal"),
        "trace": Box(2, 3, "search", "put the states of the model\non a road: a trace"),
        "certificate": Box(0, 4, "search", "certificate: claim, instances, lemmas about one instant", 2),
        "derived": Box(0, 5, "right", "derive the query again,\nwith separate code"),
        "kernel": Box(1, 5, "right", "Coq: is the tableau a proof\nof the printed claim?"),
        "judge": Box(2, 5, "right", "exact judge: is the claim\nfalse on the trace?"),
        "solver": Box(0, 6, "right", "z3 or cvc5: unsat"),
        "proved": Box(0, 7, "answer", "PROVED"),
        "accepted": Box(1, 7, "answer", "PROVED, accepted\nby the kernel"),
        "refuted": Box(2, 7, "answer", "REFUTED"),
    }
    arrows = (
        Arrow("claim", "formula"),
        Arrow("formula", "negated"),
        Arrow("negated", "z3"),
        Arrow("z3", "instances", "yes", -10),
        Arrow("instances", "z3", "again", 10),
        Arrow("instances", "trace", "none"),
        Arrow("z3", "certificate", "no"),
        Arrow("certificate", "derived"),
        Arrow("certificate", "kernel"),
        Arrow("trace", "judge"),
        Arrow("derived", "solver"),
        Arrow("solver", "proved"),
        Arrow("kernel", "accepted", "yes"),
        Arrow("judge", "refuted", "yes"),
    )
    return drawing("How a proof works", boxes, arrows)


def search() -> str:
    """How ``witness`` looks for a drive."""
    boxes = {
        "formula": Box(0, 0, "given", "formula"),
        "road": Box(1, 0, "given", "road, lanes"),
        "limits": Box(2, 0, "given", "vehicles and their limits,\nparameters"),
        "steps": Box(0, 1, "right", "time becomes steps: columns, linear rows, a circuit of inequalities", 3),
        "choices": Box(0, 2, "search", "HiGHS: choices of a natural\ndrive (mixed-integer)"),
        "widest": Box(1, 2, "right", "all lanes, widest class:\nHiGHS relaxed, z3 exact"),
        "never": Box(2, 2, "search", "prover: can no trace\nsatisfy the formula?"),
        "shape": Box(0, 3, "search", "Clarabel: the smoothest drive\nwith these choices"),
        "rational": Box(0, 4, "search", "round to rational numbers"),
        "judge": Box(0, 5, "right", "replay limits and boxes;\nexact judge, dense time"),
        "witnessed": Box(0, 6, "answer", "WITNESSED"),
        "unknown": Box(1, 5, "answer", "UNKNOWN"),
        "certificate": Box(2, 3, "right", "certificate, derived again"),
        "impossible": Box(2, 4, "answer", "IMPOSSIBLE"),
        "none": Box(1, 3, "answer", "NONE-WITHIN these limits"),
    }
    arrows = (
        Arrow("formula", "steps"),
        Arrow("road", "steps"),
        Arrow("limits", "steps"),
        Arrow("steps", "choices"),
        Arrow("choices", "widest", "none"),
        Arrow("widest", "never", "none"),
        Arrow("widest", "none", "no proof either"),
        Arrow("choices", "shape", "found"),
        Arrow("shape", "rational"),
        Arrow("rational", "judge"),
        Arrow("judge", "witnessed", "true"),
        Arrow("judge", "unknown", "false"),
        Arrow("never", "certificate", "yes"),
        Arrow("certificate", "impossible"),
    )
    return drawing("How a search works", boxes, arrows)


def monitor() -> str:
    """How ``monitor`` and ``evaluate`` read recordings."""
    boxes = {
        "recording": Box(0, 0, "given", "recording: highD, exiD, CSV,\nCommonRoad, OpenSCENARIO"),
        "formulas": Box(1, 0, "given", "formulas: scenarios of the spec sets, or your own", 2),
        "columns": Box(0, 1, "right", "columns in SI units; checks\nfor contradictions"),
        "compiled": Box(1, 1, "right", "compile once; formulas share equal parts", 2),
        "traces": Box(0, 2, "right", "cut traces: a pair, from\nsafety to danger"),
        "atoms": Box(
            0, 3, "right", "compare terms at each sample; one bit for each trace, 64 in a machine word", 3
        ),
        "words": Box(0, 4, "right", "temporal operators on words, for every\ncontinuation and for some", 2),
        "margins": Box(2, 4, "right", "the same walk with\nminimum and maximum"),
        "truth": Box(0, 5, "answer", "true, false or undecided"),
        "tables": Box(1, 5, "answer", "matches, tables, figures"),
        "robustness": Box(2, 5, "answer", "robustness"),
    }
    arrows = (
        Arrow("recording", "columns"),
        Arrow("columns", "traces"),
        Arrow("formulas", "compiled"),
        Arrow("traces", "atoms"),
        Arrow("compiled", "atoms"),
        Arrow("atoms", "words"),
        Arrow("atoms", "margins"),
        Arrow("words", "truth"),
        Arrow("words", "tables"),
        Arrow("margins", "robustness"),
    )
    return drawing("How a monitor works", boxes, arrows)


DRAWINGS = {"how-proof.svg": proof, "how-search.svg": search, "how-monitor.svg": monitor}
