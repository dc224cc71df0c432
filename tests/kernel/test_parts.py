"""Parts of time with a moment that serves each, against sampling of random truth sets."""

import random
from collections.abc import Iterator
from fractions import Fraction as F
from itertools import pairwise
from math import isqrt

import pytest

from roadproof.evidence.derivations.parts import NoDerivationError, breaks, covered, moments
from roadproof.evidence.derivations.signs import Part
from roadproof.evidence.kernel.derivation import Fixed, Moment
from roadproof.semantics.exact.algebraic import Point, Root
from roadproof.semantics.exact.truth import Cut, TruthSet

END = 12
STEP = F(1, 8)
MOST_LOST = 3
"""Of 400: a side that begins right after the last instant of the first window needs one moment for each."""


def truth(rng: random.Random, roots: float = 0.0, most: int = 6) -> TruthSet:
    """Of up to so many cuts at quarters, open and closed, single instants and gaps of one instant too.

    ``roots``: the share of cuts at square roots of whole numbers, which are irrational.
    """
    cuts = set()
    for _ in range(rng.randrange(most + 1)):
        point: Point = F(rng.randrange(0, 4 * END), 4)
        if rng.random() < roots:
            square = rng.choice([n for n in range(2, END**2) if isqrt(n) ** 2 != n])
            point = Root((-square, 0, 1), F(isqrt(square)), F(isqrt(square) + 1))
        cuts.add(Cut(point, rng.random() < 0.5))
    return TruthSet(tuple(sorted(cuts)))


def instants(begin: Cut, end: Cut | None) -> Iterator[F]:
    """Rational instants of a part: at its ends where they belong to it, and every 1/8 s between."""
    last = F(END) if end is None else end.point
    assert isinstance(begin.point, F)
    assert isinstance(last, F)
    time = begin.point
    while time <= last:
        if (time > begin.point or not begin.after) and (time < last or end is None or end.after):
            yield time
        time += STEP


def follow(parts: list[Part], whole: Part) -> None:
    """They begin and end where the whole does, and each where the one before ends."""
    assert (parts[0].begin, parts[-1].end) == (whole.begin, whole.end)
    for one, other in pairwise(parts):
        assert one.end == other.begin
        assert one.begin < other.begin


def at(moment: Moment, time: F) -> F:
    return moment.time if isinstance(moment, Fixed) else time + moment.time


def sampled(low: F, high: F) -> Iterator[F]:
    """From ``low`` on, before ``high``."""
    time = low
    while time < high:
        yield time
        time += STEP


def windows(rng: random.Random) -> tuple[F, F | None]:
    low = F(rng.randrange(0, 8), 4)
    return low, None if rng.random() < 0.2 else low + F(rng.randrange(0, 12), 4)


def whole(rng: random.Random) -> Part:
    begin = F(rng.randrange(0, 8), 4)
    if rng.random() < 0.2:
        return Part(Cut(begin, rng.random() < 0.5), None)
    after = rng.random() < 0.5
    end = begin + F(rng.randrange(1, 12), 4)
    return Part(Cut(begin, after), Cut(end, rng.random() < 0.5))


@pytest.mark.parametrize("roots", [0.0, 0.5])
@pytest.mark.parametrize("block", range(3))
def test_a_moment_of_a_part_serves_each_of_its_instants(block: int, roots: float) -> None:
    rng, found, refused, lost = random.Random(block), 0, 0, 0
    for _ in range(60 if roots else 400):
        right, left, window, part = truth(rng, roots), truth(rng, roots), windows(rng), whole(rng)
        low, high = window
        try:
            made = [*moments(part, window, right, left)]
        except NoDerivationError:
            refused += 1
            lost += until_everywhere(part, window, right, left)
            continue
        found += 1
        follow([x for x, _ in made], part)
        for piece, moment in made:
            for time in instants(piece.begin, piece.end):
                moved = at(moment, time)
                assert time + low <= moved, (piece, moment)
                assert high is None or moved <= time + high
                assert right.at(moved)
                assert all(left.at(x) for x in sampled(time + low, moved))
    assert found > 5
    assert refused > 5
    assert roots or lost <= MOST_LOST


def until_everywhere(part: Part, window: tuple[F, F | None], right: TruthSet, left: TruthSet) -> bool:
    """Whether an until holds at all instants, by sampling at eighths: with cuts at quarters that is exact."""
    low, high = window
    for time in instants(part.begin, part.end):
        last = F(3 * END) if high is None else time + high
        good = False
        for moved in [*sampled(time + low, last), last]:
            if right.at(moved):
                good = True
                break
            if not left.at(moved):
                break
        if not good:
            return False
    return True


@pytest.mark.parametrize("roots", [0.0, 0.5])
@pytest.mark.parametrize("block", range(3))
def test_a_break_of_a_part_is_one_at_each_of_its_instants(block: int, roots: float) -> None:
    """The left side fails at the moment, and the right side does not come up to then; or it never comes."""
    rng, fixed, later, never_comes, lost = random.Random(100 + block), 0, 0, 0, 0
    for _ in range(60 if roots else 400):
        never, failing, window, part = truth(rng, roots), truth(rng, roots), windows(rng), whole(rng)
        low, high = window
        try:
            made = [*breaks(part, window, never, failing)]
        except NoDerivationError:
            lost += broken_everywhere(part, window, never, failing)
            continue
        follow([x for x, _ in made], part)
        for piece, moment in made:
            fixed += isinstance(moment, Fixed)
            later += moment is not None and not isinstance(moment, Fixed)
            never_comes += moment is None
            for time in instants(piece.begin, piece.end):
                if moment is None:
                    last = F(3 * END) if high is None else time + high
                    assert all(never.at(x) for x in (*sampled(time + low, last), last))
                else:
                    moved = at(moment, time)
                    assert moved >= time + low
                    assert failing.at(moved)
                    assert all(never.at(x) for x in (*sampled(time + low, moved), moved))
    assert roots or min(fixed, later, never_comes) >= 3
    assert roots or lost <= MOST_LOST


def broken_everywhere(part: Part, window: tuple[F, F | None], never: TruthSet, failing: TruthSet) -> bool:
    """Whether at all instants the right side does not come, or the left one fails before."""
    low, high = window
    for time in instants(part.begin, part.end):
        last = F(3 * END) if high is None else time + high
        broken = True
        for moved in [*sampled(time + low, last), last]:
            if not never.at(moved):
                broken = False
                break
            if failing.at(moved):
                break
        if not broken:
            return False
    return True


@pytest.mark.parametrize("roots", [0.0, 0.5])
@pytest.mark.parametrize("block", range(2))
def test_each_covered_part_lies_in_its_set(block: int, roots: float) -> None:
    rng, found = random.Random(200 + block), 0
    for _ in range(60 if roots else 400):
        sets, part = [truth(rng, roots) for _ in range(3)], whole(rng)
        try:
            made = [*covered(part, sets)]
        except NoDerivationError:
            assert roots or not all(any(x.at(t) for x in sets) for t in instants(part.begin, part.end))
            continue
        found += 1
        follow([x for x, _ in made], part)
        for piece, place in made:
            for time in instants(piece.begin, piece.end):
                among = sets if isinstance(place, Root) else [sets[place]]
                assert any(x.at(time) for x in among), (piece, place)
            assert roots or not isinstance(place, Root)
    assert found > 5
