"""A table of claims, each with the verdict it deserves; refutations are judged again by other means."""

import pytest

from proving.claims import (
    BEYOND,
    INVALID,
    NEEDS_INFINITELY_MANY_SWITCHES,
    PROVED,
    VALID,
    VALID_MORE,
    VALID_ON_ROADS,
    is_false_on,
    negated,
    settle,
    speaks_of_all_lanes,
    specification,
)
from roadproof.engines.solve.smt import ask
from roadproof.evidence.certificate import refusal
from roadproof.runtime.budget import Effort
from roadproof.verdict import Verdict

library = specification().library


@pytest.mark.parametrize("claim", [*VALID, *VALID_ON_ROADS, *VALID_MORE])
def test_proves_what_is_valid(claim):
    result = settle(claim)
    assert result.verdict in PROVED, result.reason
    assert refusal(result.certificate, library, ask) is None
    for title, query in result.certificate.queries:
        assert ask(query, "cvc5", Effort(10).meter()) == "unsat", title


@pytest.mark.parametrize("claim", INVALID)
def test_refutes_what_is_not_valid(claim):
    result = settle(claim)
    assert result.verdict is Verdict.REFUTED, result.reason
    assert result.certificate is None
    if not speaks_of_all_lanes(claim):
        assert is_false_on(result.countermodel, claim)


@pytest.mark.parametrize("claim", VALID)
def test_does_not_prove_the_negation_of_what_is_valid(claim):
    assert settle(negated(claim)).verdict is not Verdict.PROVED


@pytest.mark.parametrize("claim", NEEDS_INFINITELY_MANY_SWITCHES)
def test_refutes_by_a_trace_that_repeats_where_no_finite_one_decides(claim):
    result = settle(claim, units=1)
    assert result.verdict is Verdict.REFUTED
    assert result.countermodel.loop is not None


@pytest.mark.parametrize("claim", BEYOND)
def test_does_not_refute_what_is_true_of_every_road(claim):
    assert settle(claim).verdict is not Verdict.REFUTED
