"""The paper's figures are consistent in themselves and with the facts that must hold (semantics §6)."""

from fractions import Fraction

from roadproof.frontends.report.paper import COMPARISON, RESULTS, VIOLATING_PAIRS
from roadproof.frontends.report.traffic import percent


def test_recall_is_matching_by_traces() -> None:
    for row in RESULTS.values():
        assert percent(row.matching, row.traces) == row.recall


def test_sets_grow_and_three_equals_four_in_base() -> None:
    for danger in (Fraction(0), Fraction(3, 5)):
        base, middle, ext = (RESULTS[danger, name] for name in ("base", "extA", "ext"))
        assert base.scenarios[3] == base.scenarios[4]
        for i in base.scenarios:
            assert base.scenarios[i] <= middle.scenarios[i] <= ext.scenarios[i]
        assert base.matching < middle.matching < ext.matching


def test_comparison_repeats_the_results() -> None:
    ext = RESULTS[Fraction(0), "ext"]
    assert COMPARISON["cut-in"]["RSS"] == ext.scenarios[1] == 9364
    assert COMPARISON["deceleration"]["RSS"] == ext.scenarios[4] == 26008


def test_recall_without_the_filter_is_a_quarter() -> None:
    assert percent(RESULTS[Fraction(0), "base"].matching, VIOLATING_PAIRS) == "24.1%"
