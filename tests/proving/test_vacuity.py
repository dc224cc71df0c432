"""VACUOUS rests on a derived query, as PROVED does."""

import pytest

from asking import prove
from roadproof.engines.prove import prover
from roadproof.engines.search.settle import settle
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.runtime.budget import Effort
from roadproof.verdict import Verdict

SPECIFICATION = bundled_library().select("base")
CLAIM = "scenario_1(SV,POV,L) and scenario_4(SV,POV,L) -> dangerArises(SV,POV)"


def test_a_premise_that_never_holds() -> None:
    assert prove(SPECIFICATION, CLAIM).verdict is Verdict.VACUOUS


def test_the_finder_alone_is_not_believed(monkeypatch: pytest.MonkeyPatch) -> None:
    satisfiable = "(set-logic QF_LRA)(check-sat)"
    monkeypatch.setattr(prover, "derive_query", lambda *_: satisfiable)
    assert prove(SPECIFICATION, CLAIM).verdict is Verdict.PROVED


@pytest.mark.parametrize(
    "claim",
    [
        "minDanger = 0.6 s and minDanger = 1 s -> false",
        "v_lon(SV) > 3 m/s and v_lon(SV) < 2 m/s -> false",
        "not (v_lon(SV) > 3 m/s or v_lon(SV) < 4 m/s) -> false",
    ],
)
def test_nothing_follows_but_false(claim: str) -> None:
    assert prove(SPECIFICATION, claim).verdict is Verdict.VACUOUS


@pytest.mark.parametrize(
    "claim",
    [
        "true -> not (v_lon(SV) > 3 m/s and v_lon(SV) < 2 m/s)",
        "not (v_lon(SV) > 3 m/s and v_lon(SV) < 2 m/s)",
        "minDanger = 0.6 s -> not minDanger = 1 s",
    ],
)
def test_a_conclusion_that_is_a_negation(claim: str) -> None:
    assert prove(SPECIFICATION, claim).verdict is Verdict.PROVED


def vacuous(claim: str, *said: str) -> bool:
    found = settle(SPECIFICATION, read_claim(SPECIFICATION, claim), Effort(3), said=("motion", *said))
    assert found.result.holds
    return found.verdict is Verdict.VACUOUS


def test_limits_that_contradict_each_other() -> None:
    never = "a_lon(SV) <= 1 m/s^2", "a_lon(SV) >= 2 m/s^2"
    assert vacuous("v_lon(SV) > 3 m/s", *never)
    assert vacuous("v_lon(SV) > 3 m/s or v_lon(SV) < 4 m/s", *never)
    assert not vacuous("a_lon(SV) <= 3 m/s^2", never[0])
    assert vacuous("a_lon(SV) > 3 m/s^2 -> v_lon(SV) > 3 m/s", never[0])


def test_a_premise_that_can_hold() -> None:
    assert prove(SPECIFICATION, "scenario_1(SV,POV,L) -> dangerArises(SV,POV)").verdict is Verdict.PROVED
