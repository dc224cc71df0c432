"""Figures that are read from several lines of an output."""

from pathlib import Path

import pytest

from findings import readings as r
from findings.figures import Outcome


def printed(text: str) -> Outcome:
    return Outcome(text, 0, Path())


MATRIX = """\
      1  3  9 11
   1     .  #  .
   3  .     .  #
   9  #  .     ?
  11  .  #  ?
  # WITNESSED: compatible: both hold on a judged drive
"""

CLASSES = """\
class        drives  situations     what happens
class_1      1 of 1     45  60.0 %  SV keeps its lane, POV cuts in
class_4_6_8  1 of 1     20  26.7 %  4, 6 and 8 together
class_1_5    1 of 1     10  13.3 %  1 and 5 together
class_5      1 of 1      0   0.0 %  SV changes lanes, POV cuts in
class_2      1 of 1      1 100.0 %  SV keeps its lane

5 classes: 5 WITNESSED
"""

EXPLORED = """\
scenario 1: cut-in, lane keep, main road, set base
  # WITNESSED: a drive, judged at this value, at 11 of 11 values
  greatest minSafe with a drive: 5.3 s; at 5.4 s UNKNOWN [2]
  11 values, 2 searches, 1 drive in 2.3 s
scenario 4: deceleration ahead, lane keep, main road, set base
  # WITNESSED: a drive, judged at this value, at 11 of 11 values
  greatest minSafe with a drive: 4.6 s; at 5.4 s UNKNOWN [2]
  11 values, 12 searches, 2 drives in 2.3 s
"""

MEASURED = """\
scenario 1: cut-in, lane keep, main road, set base
  least v_lon(SV) - v_lon(POV) at the start: -25 m/s on a judged drive; at -25.1 m/s NONE-WITHIN [1]
  greatest v_lon(SV) - v_lon(POV) at the start: 25 m/s on a judged drive; at 25.1 m/s NONE-WITHIN [1]
"""

ORDER = """\
1@base -> 1@ext
3@base -> 3@extA
9@base -> 9@ext
11@base -> 11@extA
one formula: 1@base, 1@extA
one formula: 6@base, 6@extA, 6@ext
one formula: 9@base, 9@extA
"""


def test_pairs_are_read_from_the_matrix() -> None:
    assert r.pairs_with(printed(MATRIX), "WITNESSED") == {(1, 9), (3, 11)}
    assert r.pairs_with(printed(MATRIX), "IMPOSSIBLE") == {(1, 3), (1, 11), (3, 9)}
    assert r.pairs_drives_proofs(printed(MATRIX)) == (5, 2, 3)


def test_classes_are_read_from_the_table() -> None:
    outcome = printed(CLASSES)
    assert r.happenings(outcome) == (4, "1, 5", "1 with 5, 4 with 6, 8")
    assert r.shares(outcome) == {"1": 60.0, "4_6_8": 26.7, "1_5": 13.3, "5": 0.0, "2": 100.0}
    assert r.all_witnessed(outcome) == "5"
    doubtful = CLASSES.replace("5 WITNESSED", "4 WITNESSED, 1 UNKNOWN")
    assert r.all_witnessed(printed(doubtful)) == "5 classes: 4 WITNESSED, 1 UNKNOWN"


def test_a_set_is_read_from_its_answer() -> None:
    text = f"{CLASSES}10 situations with a scenario, each in exactly one\nOf 12 traces, 2 (17 %) in none\n"
    assert r.classes_of_set(printed(text)) == ("5", "10", "2")
    gaps = "of 52 classes 43 have a judged drive, 9 are proved empty, {} are undecided\n"
    gaps += "of 34 disturbances in traffic 20 are missed\n"
    assert r.gaps_of_set(printed(gaps.format(0))) == ("52", "43", "9", "20")
    with pytest.raises(AssertionError):
        r.gaps_of_set(printed(gaps.format(1)))


def test_boundaries_and_drives_are_those_of_each_scenario() -> None:
    assert r.boundaries(printed(EXPLORED)) == {1: "5.3", 4: "4.6"}
    assert r.drives_that_serve(printed(EXPLORED)) == (2, 11, "one or two")
    assert r.drives_that_serve(printed(EXPLORED.replace("at 11 of", "at 10 of", 1)))[1] == 0


def test_measures_are_those_of_each_scenario() -> None:
    assert r.measures(printed(MEASURED)) == {(1, "least"): "-25", (1, "greatest"): "25"}
    assert r.range_of_both(printed(MEASURED)) == ("25", "25")


def test_the_order_is_read_by_scenario() -> None:
    assert r.one_formula(printed(ORDER)) == ("1", "6")
    assert r.edges_of_a_sector(printed(ORDER)) == "2"


def test_evidence_is_accepted_where_all_of_it_is() -> None:
    assert r.accepted(printed("PROVED P1\n7 of 7 accepted by z3\n")) == "7"
    assert r.accepted(printed("6 of 7 accepted by z3\n")) == "6 of 7 accepted"
