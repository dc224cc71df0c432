"""Gaps in recordings: what overlapping windows show counts once, and what is proved empty must not occur."""

from pathlib import Path

import pytest

from roadproof.analysis.basis import Basis, ProofResult
from roadproof.analysis.coverage.answers import ClassAnswer
from roadproof.analysis.coverage.claims import claims_of
from roadproof.analysis.coverage.classes import GapClasses
from roadproof.analysis.coverage.occurring import GapTrace, GapTraffic, verdict_on, with_counts
from roadproof.errors import InputError
from roadproof.library.loading import bundled_library
from roadproof.verdict import Verdict

BASIS = Basis(bundled_library().select())
FIRST, SECOND, *_ = GapClasses(BASIS).parts
GAP = GapTrace("01", 3, 5, (10, 40), True, (FIRST.key,), False)
ALONE = GapTrace("02", 1, 2, (0, 9), True, (), True)
TRAFFIC = GapTraffic(Path("recordings"), 7, (GAP, GAP, ALONE), 0)


def test_how_often_a_class_occurs_and_where() -> None:
    answer = ClassAnswer(FIRST, Verdict.UNKNOWN, reason="none on main-2")
    seen = with_counts(answer, TRAFFIC)
    where = "recording 01, vehicles 3 and 5, frames 10 to 40"
    assert (seen.verdict, seen.in_traffic, seen.trace) == (Verdict.UNKNOWN, 2, where)
    assert seen.reason == f"occurs in {where}"
    assert with_counts(ClassAnswer(None, Verdict.WITNESSED), TRAFFIC).in_traffic == 1
    never = with_counts(ClassAnswer(SECOND, Verdict.IMPOSSIBLE), TRAFFIC)
    assert (never.verdict, never.in_traffic, never.trace) == (Verdict.IMPOSSIBLE, 0, "")


def test_what_is_proved_not_to_be_and_occurs_is_our_fault() -> None:
    broken = with_counts(ClassAnswer(FIRST, Verdict.IMPOSSIBLE), TRAFFIC)
    assert broken.verdict is Verdict.CROSSCHECK_FAILED
    assert verdict_on([], [broken], TRAFFIC) is Verdict.CROSSCHECK_FAILED
    proved = [ProofResult(claim, Verdict.PROVED) for claim in claims_of(BASIS.specification)]
    assert verdict_on(proved, [], None) is Verdict.COVERED
    assert verdict_on(proved, [], TRAFFIC) is Verdict.CROSSCHECK_FAILED


def test_a_trace_is_told_under_all_its_classes() -> None:
    missed = TRAFFIC.told.missed
    assert [x.classes for x in missed] == [(FIRST.key,), (FIRST.key,), ("",)]
    assert missed[0].pair == "3 and 5, frames 10 to 40"


def test_windows_that_overlap_count_once(tmp_path: Path) -> None:
    pytest.importorskip("polars")
    from roadproof.analysis.coverage.traffic import count_in_traffic, recordings_in
    from traffic.test_repeats import STEPS_SEEN, window

    window(tmp_path / "a.xml", 0, STEPS_SEEN)
    alone = count_in_traffic(BASIS, recordings_in(tmp_path), print)
    assert (alone.disturbances, alone.repeats) == (1, 0)
    window(tmp_path / "b.xml", 3, STEPS_SEEN, (9, 4))
    both = count_in_traffic(BASIS, recordings_in(tmp_path), print)
    assert (both.disturbances, both.missed, both.repeats) == (1, alone.missed, 1)


def test_a_recording_under_two_names_is_refused(tmp_path: Path) -> None:
    pytest.importorskip("polars")
    from roadproof.analysis.coverage.traffic import recordings_in
    from traffic.test_repeats import STEPS_SEEN, window

    for name in ("a.xml", "b.xml"):
        window(tmp_path / name, 0, STEPS_SEEN)
    with pytest.raises(InputError, match="the same content as"):
        recordings_in(tmp_path)
