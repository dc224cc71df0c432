"""Truth on traces that repeat themselves, against the ordinary judge on the same traces written out."""

from fractions import Fraction
from random import Random

import pytest

from roadproof.errors import InputError
from roadproof.evidence.periodic import Loop, judge_periodic, unrolled
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.semantics.exact import judge
from roadproof.semantics.exact.truth import from_switches, interval

ATOMS = [f.Compare(t.Signal("v_lon", name), "<", t.number(0, (1, -1))) for name in ("A", "B")]


def formula(random, depth):
    if depth == 0 or random.random() < 0.15:
        return random.choice([*ATOMS, f.TRUE, f.FALSE])
    low = Fraction(random.randrange(4), 2)
    high = None if random.random() < 0.4 else low + Fraction(random.randrange(12), 2)
    window = f.Interval(t.number(low, (0, 1)), None if high is None else t.number(high, (0, 1)))
    one, other = (formula(random, depth - 1) for _ in range(2))
    return random.choice(
        [
            f.Not(one),
            f.And((one, other)),
            f.Or((one, other)),
            f.Eventually(window, one),
            f.Always(window, one),
            f.Until(one, window, other),
        ]
    )


def truths(random, times):
    return from_switches((time, random.random() < 0.5, random.random() < 0.5) for time in times)


@pytest.mark.parametrize("seed", range(300))
def test_as_the_ordinary_judge_on_the_trace_written_out(seed):
    """Written out over more rounds than nested operators can tell apart, and compared before they end."""
    random = Random(seed)
    prefix = Fraction(random.randrange(3), 2)
    loop = Loop(prefix, Fraction(random.randrange(1, 5), 2))
    times = [x for x in (Fraction(k, 2) for k in range(8)) if x < loop.end]
    given = {atom: truths(random, times) for atom in ATOMS}
    asked = formula(random, 2)
    written_out = {atom: unrolled(truth, loop, Fraction(60)) for atom, truth in given.items()}
    expected = judge(asked, None, written_out).truth(asked)
    found = judge_periodic(asked, given, loop)
    points = [Fraction(k, 4) for k in range(int(4 * loop.end))]
    if all(x.high is not None for y in f.subformulas(asked) for x in f.intervals(y)):
        assert [found.at(x) for x in points] == [expected.at(x) for x in points]
    else:  # for ever is not 60 s: some suffix is asked for that the written-out trace does not have
        assert [found.at(x) for x in points] == [for_ever(asked, written_out).at(x) for x in points]


def for_ever(asked, written_out):
    """Unbounded operators look 12 s ahead, which is more than prefix and round."""

    def bounded(current):
        match current:
            case f.Eventually(window, body) | f.Always(window, body) if window.high is None:
                return type(current)(cut(window), body)
            case f.Until(left, window, right) if window.high is None:
                return f.Until(left, cut(window), right)
            case _:
                return current

    def cut(window):
        low = t.constant_value(window.low)
        return f.Interval(window.low, t.number(low + 12, (0, 1)))

    made = f.transform(asked, bounded)
    return judge(made, None, written_out).truth(made)


def test_an_alternation_that_never_ends():
    loop = Loop(Fraction(0), Fraction(2))
    given = {ATOMS[0]: interval(Fraction(0), Fraction(1), "[)")}
    again_and_again = f.Always(f.FOREVER, f.Eventually(f.FOREVER, ATOMS[0]))
    in_the_end = f.Eventually(f.FOREVER, f.Always(f.FOREVER, ATOMS[0]))
    assert judge_periodic(again_and_again, given, loop).at(Fraction(0))
    assert not judge_periodic(in_the_end, given, loop).at(Fraction(0))


def test_too_many_rounds_are_refused():
    window = f.Interval(t.number(10_000, (0, 1)), None)
    with pytest.raises(InputError, match="rounds"):
        judge_periodic(
            f.Eventually(window, ATOMS[0]),
            {ATOMS[0]: interval(Fraction(0), None)},
            Loop(*map(Fraction, (0, 1))),
        )
