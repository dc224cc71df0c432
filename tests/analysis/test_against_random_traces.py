"""What analysis proves is never false on a random trace, as the monitor sees it."""

from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from itertools import combinations, permutations

import pytest

from asking import prove
from monitoring.cases import random_traffic
from roadproof.analysis.overlap import Meeting, conjunctions
from roadproof.analysis.redundancy import changes_of
from roadproof.library.bind import default_values
from roadproof.library.compose import equivalence, implication
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.library.scenarios import Scenario, applied
from roadproof.library.specification import Specification
from roadproof.logic.rewrite import with_values
from roadproof.runtime.budget import Effort
from roadproof.semantics.sampled import compile
from roadproof.verdict import Verdict

LIBRARY = bundled_library()


def exclusions(home: Specification) -> Iterator[tuple[str, bool]]:
    """Claims that two scenarios never hold together, and whether they are provable."""
    for a, b in combinations((1, 3, 4, 5, 6, 7, 8), 2):
        (both,) = conjunctions(home, Scenario(a, home.set_name), Scenario(b, home.set_name), Meeting())
        yield f"not ({both.text})", (a, b) not in {(1, 5), (3, 6), (4, 6), (4, 8), (6, 8)}


def implications(home: Specification) -> Iterator[tuple[str, bool]]:
    """A scenario implies itself in a wider set, and does not in a narrower one."""
    sets = ("base", "extA", "ext")
    for n in (4, 8):
        for one, other in permutations(sets, 2):
            above, below = (applied(home, Scenario(n, x)) for x in (one, other))
            yield implication(above, below).text, sets.index(one) < sets.index(other)


def redundancies(home: Specification) -> Iterator[tuple[str, bool]]:
    """Of the condition on lanes in scenario 4, nothing is needed; of safety and the road, all."""
    whole = applied(home, Scenario(4, home.set_name))
    for change in changes_of(home, whole):
        if (
            change.part.startswith(("sameLane", "inAdjLanes", "initSafe", "roadSector", "laneKeep"))
            and change.value
        ):
            yield equivalence(whole, change.changed).text, change.part.startswith(("sameLane", "inAdjLanes"))


def false_somewhere(home: Specification, claims: Sequence[str]) -> set[str]:
    """The claims that are false, however the trace goes on, on one of 6,000 random traces."""
    values = {**default_values(LIBRARY), "minSafe": Fraction(2, 25), "minDanger": Fraction(2, 25)}
    formulas = {claim: with_values(read_claim(home, claim).formula, values) for claim in claims}
    batch = random_traffic(list(formulas.values()), traces=6000, longest=20, seed=11, noise=4.0)
    answers = compile(formulas).evaluate(batch).answers
    return {claim for claim in claims if answers[claim].false.any()}


@pytest.mark.parametrize("kind", [exclusions, implications, redundancies])
def test_what_is_proved_is_never_false(kind: Callable[[Specification], Iterator[tuple[str, bool]]]) -> None:
    home = LIBRARY.select("base")
    claims = dict(kind(home))
    false = false_somewhere(home, tuple(claims))
    assert false
    for claim, provable in claims.items():
        if provable:
            assert prove(home, claim).verdict is Verdict.PROVED
            assert claim not in false
    assert all(prove(home, claim, Effort(0.2)).verdict is not Verdict.PROVED for claim in false)
