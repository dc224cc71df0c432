"""Deliberate faults in the judge: the pinning checks must notice each of them."""

from dataclasses import replace
from fractions import Fraction
from itertools import pairwise

import pytest
from hypothesis import HealthCheck, Phase, find, settings
from hypothesis import strategies as st

from judge.cases import comparisons, drives, every_small_case, jerk_comparisons, jerk_drives
from judge.pinning import disagreement_on_drive, disagreement_on_sets
from roadproof.semantics.exact import judging, piecewise, signals, truth
from roadproof.semantics.exact.algebraic import moved
from roadproof.semantics.exact.polynomial import polynomial
from roadproof.semantics.exact.truth import Cut, Span, TruthSet, complement, eventually, intersection, union

search = settings(
    max_examples=2000,
    deadline=None,
    derandomize=True,
    database=None,
    phases=[Phase.generate],
    suppress_health_check=list(HealthCheck),
)
real_until, real_reaching = truth.until, truth._shifted_back
real_since, real_ahead = truth.since, truth._shifted_ahead
real_signs, real_course, real_starts = piecewise._signs, signals.signal_polynomial, signals.piece_starts


def classic_until(left, low, high, right):
    """Asks for left from 0 on, not from low on."""
    start = truth.always(Fraction(0), low, left) if low > 0 else truth.ALWAYS
    return intersection([start, real_until(left, low, high, right)])


def greedy_until(left, low, high, right):
    """Asks for left at the end, too."""
    return real_until(left, low, high, intersection([left, right]))


def until_that_needs_no_left(left, low, high, right):
    return eventually(low, high, right)


def until_that_forgets_the_end(left, low, high, right):
    """The witness must lie inside the interval of left, so not at its open end."""
    return union([right_now(low, right), real_until(left, low, high, intersection([left, right]))])


def right_now(low, right):
    return eventually(low, low, right)


def unclipped_until(left, low, high, right):
    """Measures high from the instant low instead of from 0."""
    return real_until(left, low, None if high is None else high + low, right)


def greedy_since(left, low, high, right):
    """Asks for left at the far end, too."""
    return real_since(left, low, high, intersection([left, right]))


def since_that_needs_no_left(left, low, high, right):
    return real_since(truth.ALWAYS, low, high, right)


def classic_since(left, low, high, right):
    """Asks for left from now back, not from low back."""
    lasting = complement(real_since(truth.ALWAYS, Fraction(0), low, complement(left)))
    return intersection([lasting if low > 0 else truth.ALWAYS, real_since(left, low, high, right)])


def since_before_the_start(left, low, high, right):
    """What holds at time 0 is taken to have held before it."""
    early = truth.interval(Fraction(0), low, "[)") if low > 0 and right.at(Fraction(0)) else truth.NEVER
    return union([early, real_since(left, low, high, right)])


def open_reach(low, high, spans):
    """F loses its closed ends."""
    shrunk = [Span(Cut(b.point, True), None if e is None else Cut(e.point, False)) for b, e in spans]
    return real_reaching(low, high, [s for s in shrunk if s.end is None or s.begin < s.end])


def backward_reach(low, high, spans):
    """Shifts by the wrong sign."""
    found = []
    for begin, end in spans:
        first = Cut(moved(begin.point, low), begin.after)
        found.append(
            Span(first, None if end is None or high is None else Cut(moved(end.point, high), end.after))
        )
    return found


def short_reach(low, high, spans):
    """The window cut to its low end."""
    return real_reaching(low, high if high is None else low, spans)


def short_reach_ahead(low, high, spans):
    return real_ahead(low, high if high is None else low, spans)


def weak_always(low, high, body):
    """Looks at the closed window's inside only."""
    opened = TruthSet(tuple(complement(body).cuts))
    spans = [s for s in opened.spans() if s.end is None or s.begin.point != s.end.point]
    return complement(union([eventually(low, high, truth._overlapped([s], 1)) for s in spans]))


@pytest.mark.parametrize(
    ("module", "name", "fault"),
    [
        (judging, "until", classic_until),
        (judging, "until", greedy_until),
        (judging, "until", until_that_needs_no_left),
        (judging, "until", until_that_forgets_the_end),
        (judging, "until", unclipped_until),
        (judging, "since", greedy_since),
        (judging, "since", since_that_needs_no_left),
        (judging, "since", classic_since),
        (judging, "since", since_before_the_start),
        (truth, "_shifted_ahead", short_reach_ahead),
        (truth, "_shifted_back", open_reach),
        (truth, "_shifted_back", backward_reach),
        (truth, "_shifted_back", short_reach),
        (judging, "always", weak_always),
        (judging, "intersection", union),
        (judging, "complement", lambda body: TruthSet(body.cuts[1:] or (truth.START,))),
    ],
    ids=lambda x: getattr(x, "__name__", None) if callable(x) else "",
)
def test_a_faulty_operator_is_noticed(monkeypatch, module, name, fault):
    monkeypatch.setattr(module, name, fault)
    caught = next((case for case in every_small_case() if disagreement_on_sets(*case) is not None), None)
    assert caught is not None
    monkeypatch.undo()
    assert disagreement_on_sets(*caught) is None


def open_roots(p, start, end):
    """A root counts as what comes after it."""
    return [(point, after, after) for point, _, after in real_signs(p, start, end)]


def crossing_tangents(p, start, end):
    """Every root is taken to change the sign."""
    found = real_signs(p, start, end)
    sign, seen = found[0][2], found[:1]
    for point, at, _ in found[1:]:
        sign = -sign
        seen.append((point, at, sign))
    return seen


def roots_at_the_end(p, start, end):
    """The piece is taken to last one root too long: its start counts as strictly inside."""
    found = real_signs(p, start, end)
    return [(found[0][0], found[0][2], found[0][2]), *found[1:]]


def full_square(name, x):
    """a·t² for a/2·t²."""
    doubled = replace(x, a_lon=2 * x.a_lon, a_lat=2 * x.a_lat) if name in ("s", "d") else x
    return real_course(name, doubled)


def half_cube(name, x):
    """j/2·t³ for j/6·t³ in places."""
    return real_course(name, replace(x, j_lon=3 * x.j_lon) if name == "s" else x)


def full_jerk(name, x):
    """j·t² for j/2·t² in speeds."""
    return real_course(name, replace(x, j_lon=2 * x.j_lon) if name == "v_lon" else x)


def no_jerk(name, x):
    """Accelerations stay what they are at the start of a piece."""
    return real_course(name, replace(x, j_lon=Fraction(0)) if name == "a_lon" else x)


def absolute_times(begin, *coefficients):
    """A polynomial in the time since a piece began is taken for one in time since 0."""
    return polynomial(*coefficients)


def loose_jerk(motion):
    """What jerk adds to the speed is forgotten at the next knot."""
    return real_starts(replace(motion, pieces=tuple(replace(p, j_lon=Fraction(0)) for p in motion.pieces)))


def left_continuous(motion):
    """A knot belongs to the piece that ends there, one piece late."""
    states = real_starts(motion)
    return (states[0], *(replace(x, a_lon=before.a_lon) for before, x in pairwise(states)))


@pytest.mark.parametrize(
    ("module", "name", "fault"),
    [
        (piecewise, "_signs", open_roots),
        (piecewise, "_signs", crossing_tangents),
        (piecewise, "_signs", roots_at_the_end),
        (signals, "signal_polynomial", full_square),
        (signals, "piece_starts", left_continuous),
        (piecewise, "greatest", piecewise.least),
        (signals, "TRUE_SIGNS", {**signals.TRUE_SIGNS, ">=": frozenset({1})}),
        (signals, "MIRRORED", {op: op for op in signals.MIRRORED}),
        (signals, "ZERO", frozenset()),
    ],
    ids=lambda x: getattr(x, "__name__", None) if callable(x) else "",
)
def test_a_faulty_comparison_is_noticed(monkeypatch, module, name, fault):
    monkeypatch.setattr(module, name, fault)
    wrong = lambda case: disagreement_on_drive(*case) not in (None, "doubtful")  # noqa: E731
    comparison, drive = find(st.tuples(comparisons, drives), wrong, settings=search)
    monkeypatch.undo()
    assert disagreement_on_drive(comparison, drive) is None


@pytest.mark.parametrize(
    ("name", "fault"),
    [
        ("signal_polynomial", half_cube),
        ("signal_polynomial", full_jerk),
        ("signal_polynomial", no_jerk),
        ("_from", absolute_times),
        ("piece_starts", loose_jerk),
    ],
    ids=lambda x: getattr(x, "__name__", None) if callable(x) else "",
)
def test_a_faulty_jerk_is_noticed(monkeypatch, name, fault):
    monkeypatch.setattr(signals, name, fault)
    wrong = lambda case: disagreement_on_drive(*case) not in (None, "doubtful")  # noqa: E731
    comparison, drive = find(st.tuples(jerk_comparisons, jerk_drives), wrong, settings=search)
    monkeypatch.undo()
    assert disagreement_on_drive(comparison, drive) is None
