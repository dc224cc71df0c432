"""Random claims about lanes, zones and boxes, against random roads and traces, by definition."""

from collections import Counter
from random import Random

import pytest

from proving.claims import PROVED, settle
from proving.on_roads import claim_text, is_false_there, is_true_here, random_claim, random_road, random_trace
from roadproof.verdict import Verdict

CLAIMS = 48
WORLDS = 30
seen: Counter[str] = Counter()


@pytest.mark.parametrize("seed", range(CLAIMS))
def test_verdicts_on_random_roads(seed):
    rng = Random(seed)
    tree = random_claim(rng)
    claim = claim_text(tree)
    result = settle(claim, units=0.5)
    seen[str(result.verdict)] += 1
    if result.verdict in PROVED:
        for _ in range(WORLDS):
            assert is_true_here(tree, random_road(rng), random_trace(rng)), claim
    elif result.verdict is Verdict.REFUTED:
        assert is_false_there(tree, result.countermodel), claim
    else:
        assert result.verdict is Verdict.UNKNOWN
        assert result.reason


def test_most_were_decided():
    """Run after the tests above; UNKNOWN counts for nothing."""
    if sum(seen.values()) < CLAIMS:
        pytest.skip("not all of the claims were settled in this process")
    assert seen[str(Verdict.PROVED)] + seen[str(Verdict.VACUOUS)] >= CLAIMS / 6
    assert seen[str(Verdict.REFUTED)] >= CLAIMS / 3
    assert seen[str(Verdict.UNKNOWN)] <= CLAIMS / 4
