"""The table and the picture of classes, on made-up answers."""

from collections import Counter

import pytest

from report.edges import cut_off
from roadproof.analysis.classify.cells import Cell
from roadproof.analysis.classify.classes import Class
from roadproof.analysis.classify.drives import Example
from roadproof.analysis.classify.shares import Shares
from roadproof.analysis.classify.study import ClassificationResult
from roadproof.evidence.answers.classify import Doubt
from roadproof.frontends.report.classify import as_table, compose_classes, summary
from roadproof.library.words import Words
from roadproof.verdict import Verdict

WORDS = {4: Words(4, "slow ahead", "main road"), 8: Words(8, "slow ahead, leaving", "main road")}


def one(happens: tuple[int, ...], place: str | None, verdict: Verdict = Verdict.WITNESSED) -> Example:
    what = "_".join(map(str, happens))
    name = f"class_{what}" if place is None else f"class_{what}_{place}"
    cell = Cell(happens, happens, ())
    reason = "" if verdict is Verdict.WITNESSED else "none was found"
    return Example(Class(name, ("SV", "POV"), happens, cell, None, place, f"what {what} is"), verdict, reason)


def shares_of(**situations: int) -> Shares:
    return Shares(["01"], 20, 8, Counter(situations), classified=Counter({2: 10}), source="roads")


def test_places_are_added_up() -> None:
    examples = [one((4,), "main"), one((4,), "merge", Verdict.UNKNOWN), one((4, 8), "main")]
    shares = shares_of(class_4_main=5, class_4_merge=1, class_4_8_main=4)
    assert as_table(examples, shares, WORDS).splitlines() == [
        "class      drives  situations     what happens",
        "class_4    1 of 2      6  60.0 %  slow ahead: what 4 is",
        "class_4_8  1 of 1      4  40.0 %  4 and 8 together",
        "  8: slow ahead, leaving",
        "",
        "where  drives  situations",
        "main   2 of 2      9  90.0 %",
        "merge  0 of 1      1  10.0 %",
    ]


def test_without_shares_there_are_none() -> None:
    table = as_table([one((4,), None)], None, WORDS)
    assert table.splitlines() == ["class    drives  what happens", "class_4  1 of 1  slow ahead: what 4 is"]


def test_doubts_are_told_and_traces_that_are_shown_twice() -> None:
    shares = shares_of(class_4=10)
    shares.repeated = 5
    found = ClassificationResult(
        (one((4,), None, Verdict.UNKNOWN),), (), (Doubt(about="what there is", reason="lost"),), shares
    )
    assert [*summary(found)] == [
        "1 class: 1 UNKNOWN",
        "  UNKNOWN: what there is: lost",
        "  UNKNOWN: class_4: none was found",
        "on roads: 20 traces, 12 (60.0 %) in none of these scenarios",
        "5 of 25 traces are shown by an earlier recording too, so they are left out",
        "10 situations with a scenario, each in exactly one class, which names its scenarios",
    ]


@pytest.mark.parametrize("doubt", [Verdict.WITNESSED, Verdict.UNKNOWN])
@pytest.mark.parametrize("shares", [shares_of(class_4=1, class_4_8=2), None])
def test_the_picture_names_scenarios_and_colours_and_counts_in_whole_numbers(
    shares: Shares | None, doubt: Verdict
) -> None:
    pytest.importorskip("matplotlib")
    figure = compose_classes([one((4,), None), one((4, 8), None, doubt)], shares, "Classes", WORDS)
    assert cut_off(figure) == []
    *bars, dots = figure.axes
    assert [x.get_text() for x in dots.get_yticklabels()] == ["4 slow ahead", "8 slow ahead, leaving"]
    legend = [x.get_text() for x in dots.get_legend().get_texts()]
    doubtful = ["the same, no drive found"] * (doubt is Verdict.UNKNOWN)
    assert legend == ["holds in the class", *doubtful, "does not hold"]
    assert all(tick == int(tick) for one in bars for tick in one.get_yticks())
    assert len(bars) == (shares is not None)
