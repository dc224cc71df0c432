"""Written-out cases of the operators on truth sets: ends, windows, until."""

from fractions import Fraction

import pytest

from roadproof.semantics.exact.algebraic import moved, real_roots
from roadproof.semantics.exact.truth import (
    ALWAYS,
    NEVER,
    always,
    complement,
    eventually,
    from_switches,
    intersection,
    interval,
    union,
    until,
)

SQRT2 = real_roots((-2, 0, 1))[1][0]


def q(text):
    return Fraction(text)


def point(time):
    return interval(q(time), q(time))


def span(low, high, closed="[]"):
    return interval(q(low), None if high is None else q(high), closed)


def test_complement_swaps_open_and_closed():
    assert complement(span(1, 2, "[)")) == union([span(0, 1, "[)"), span(2, None)])
    assert complement(span(1, 2, "(]")) == union([span(0, 1), span(2, None, "()")])
    assert complement(point(0)) == span(0, None, "()")
    assert complement(ALWAYS) == NEVER
    assert complement(complement(point(3))) == point(3)


def test_touching_intervals_join_only_where_a_point_is_covered():
    assert union([span(0, 1, "[)"), span(1, 2)]) == span(0, 2)
    assert len(union([span(0, 1, "[)"), span(1, 2, "(]")]).spans()) == 2
    assert intersection([span(0, 1), span(1, 2)]) == point(1)
    assert intersection([span(0, 1, "[)"), span(1, 2)]) == NEVER
    assert intersection([]) == ALWAYS
    assert union([]) == NEVER


def test_switches_say_what_holds_at_and_after_each_point():
    made = from_switches([(q(0), True, False), (q(1), True, True), (q(2), False, True), (q(3), True, False)])
    assert made == union([point(0), span(1, 2, "[)"), span(2, 3, "(]")])
    assert [made.at(q(t)) for t in ("0", "1/2", "1", "2", "3", "4")] == [
        True,
        False,
        True,
        False,
        True,
        False,
    ]


def test_eventually_keeps_ends_as_they_are():
    assert eventually(q("1/2"), q(1), span(2, 3, "(]")) == span(1, "5/2", "(]")
    assert eventually(q("1/2"), q(1), span(2, 3, "[)")) == span(1, "5/2", "[)")
    assert eventually(q(1), None, span(2, 3, "[)")) == span(0, 2, "[)")
    assert eventually(q(1), q(1), span("1/2", 1, "[)")) == NEVER
    assert eventually(q(1), q(1), span("1/2", 1)) == point(0)


def test_a_single_instant_is_seen_by_a_window_that_ends_on_it():
    assert eventually(q(0), q(1), point(2)) == span(1, 2)
    assert always(q(0), q(1), complement(point(2))) == union([span(0, 1, "[)"), span(2, None, "()")])


def test_point_windows():
    for body in (point(2), span(0, 1, "[)"), span(1, None, "()")):
        assert always(q(0), q(0), body) == eventually(q(0), q(0), body) == body
        assert until(NEVER, q(0), q(0), body) == body


def test_unbounded_operators_look_at_what_lasts_for_ever():
    assert always(q(0), None, span(3, None)) == span(3, None)
    assert always(q(2), None, span(3, None, "()")) == span(1, None, "()")
    assert eventually(q(0), None, span(3, None)) == ALWAYS
    assert eventually(q(0), None, span(3, 4, "[)")) == span(0, 4, "[)")
    assert always(q(0), None, complement(point(7))) == span(7, None, "()")


def test_windows_that_end_on_an_irrational_root():
    reached = interval(SQRT2, None)
    passed = interval(SQRT2, None, "()")
    one = q(1)
    assert eventually(q(0), one, reached) == interval(moved(SQRT2, -one), None)
    assert eventually(q(0), one, passed) == interval(moved(SQRT2, -one), None, "()")
    at = moved(SQRT2, -one)
    assert eventually(q(0), one, reached).at(at)
    assert not eventually(q(0), one, passed).at(at)
    assert str(eventually(q(0), one, interval(SQRT2, SQRT2))) == "[0.414214 ± 0.000001, 1.414214 ± 0.000001]"


def test_until_reaches_over_the_open_end_of_left():
    # left on [0, 2), right only at 2: at every T in [0, 2) left holds at all times before 2.
    assert until(span(0, 2, "[)"), q(0), None, point(2)) == span(0, 2)
    # right only after 2: before each witness lie instants after 2, where left fails.
    assert until(span(0, 2, "[)"), q(0), None, span(2, 3, "(]")) == span(2, 3, "(]")
    assert until(span(0, 2), q(0), None, span(2, 3, "(]")) == span(2, 3, "(]")
    assert until(span(0, "5/2"), q(0), None, span(2, 3, "(]")) == span(0, 3)
    # left open at its beginning.
    assert until(span(1, 2, "()"), q(0), None, point(2)) == span(1, 2, "(]")


def test_until_at_simultaneous_switches():
    left, right = span(0, 1, "[)"), span(1, None)
    assert until(left, q(0), None, right) == ALWAYS
    assert until(left, q(0), q("1/2"), right) == span("1/2", None)
    assert until(span(0, 1, "[)"), q(0), None, span(1, None, "()")) == span(1, None, "()")


def test_until_asks_for_left_from_low_on_only():
    # At 0 left fails on [0, 1), outside the window [1, 3]: the classic until would say no.
    left, right = span(1, 2), point(2)
    assert until(left, q(1), q(3), right).at(q(0))
    classic = intersection([always(q(0), q(1), left), until(left, q(1), q(3), right)])
    assert not classic.at(q(0))
    # Left is not asked for when right holds where the window begins.
    assert until(NEVER, q(1), q(3), point(1)) == point(0)


def test_until_over_two_intervals_of_left():
    left = union([span(0, 1, "[)"), span(1, 2, "(]")])
    assert until(left, q(0), None, point(2)) == union([span(1, 2, "(]")])
    assert until(left, q(0), None, union([point(1), point(2)])) == span(0, 2)


@pytest.mark.parametrize(
    ("truth", "shown"),
    [
        (NEVER, "∅"),
        (ALWAYS, "[0, ∞)"),
        (point("3/2"), "{1.5}"),
        (union([span(0, 1, "[)"), span(2, 3, "(]"), span(4, None, "()")]), "[0, 1) ∪ (2, 3] ∪ (4, ∞)"),
    ],
)
def test_shown(truth, shown):
    assert str(truth) == shown
