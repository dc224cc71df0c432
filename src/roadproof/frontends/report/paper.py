"""What the paper reports on the real highD: figures to read ours beside, never to compute with.

Reimann et al., SAC 2024: Table *Quantitative results of our experiments* and Table *Absolute number of
the cut-in and deceleration scenarios*, section *Experimental Evaluation*.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction


@dataclass(frozen=True)
class PaperRow:
    """A row of the paper's results table; ``scenarios`` counts traces by scenario, without scenario 2."""

    traces: int
    matching: int
    recall: str
    scenarios: Mapping[int, int]


def _row(traces: int, matching: int, recall: str, *counts: int) -> PaperRow:
    return PaperRow(traces, matching, recall, dict(zip((1, 3, 4, 5, 6, 7, 8), counts, strict=True)))


RESULTS: Mapping[tuple[Fraction, str], PaperRow] = {
    (Fraction(0), "base"): _row(32398, 24038, "74.2%", 4091, 21941, 21941, 291, 218, 3188, 924),
    (Fraction(0), "extA"): _row(32398, 30288, "93.5%", 4091, 27652, 26008, 291, 218, 4362, 969),
    (Fraction(0), "ext"): _row(32398, 31139, "96.1%", 9364, 27652, 26008, 378, 218, 4362, 969),
    (Fraction(3, 5), "base"): _row(28881, 21564, "74.7%", 4076, 19595, 19595, 283, 215, 3171, 801),
    (Fraction(3, 5), "extA"): _row(28881, 27177, "94.1%", 4076, 24843, 23328, 283, 215, 4347, 838),
    (Fraction(3, 5), "ext"): _row(28881, 27963, "96.8%", 9312, 24843, 23328, 361, 215, 4347, 838),
}

VIOLATING_PAIRS = 99656
"""Pairs with danger at some point, before the filter dangerArises."""

RECALL_WITHOUT_FILTER = "around 25%"
"""The paper's words on recall without the filter (RQ3)."""

COMPARISON: Mapping[str, Mapping[str, int]] = {
    "cut-in": {"TTC": 144, "THW": 7219, "none": 1017, "RSS": 9364},
    "deceleration": {"TTC": 22, "THW": 112, "none": 26846, "RSS": 26008},
}
"""Detections by kind and danger metric: TTC and THW of one earlier work, none of another, RSS the paper's."""

MARK = "the paper's, on the real highD"
