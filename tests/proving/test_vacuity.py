"""VACUOUS rests on a derived query, as PROVED does."""

import pytest

from asking import prove
from roadproof.proving import prover
from roadproof.spec.library import bundled_library
from roadproof.verdict import Verdict

SPECIFICATION = bundled_library().select("base")
CLAIM = "scenario_1(SV,POV,L) and scenario_4(SV,POV,L) -> dangerArises(SV,POV)"


def test_a_premise_that_never_holds() -> None:
    assert prove(SPECIFICATION, CLAIM).verdict is Verdict.VACUOUS


def test_the_finder_alone_is_not_believed(monkeypatch: pytest.MonkeyPatch) -> None:
    satisfiable = "(set-logic QF_LRA)(check-sat)"
    monkeypatch.setattr(prover, "derive_query", lambda *_: satisfiable)
    assert prove(SPECIFICATION, CLAIM).verdict is Verdict.PROVED


def test_a_premise_that_can_hold() -> None:
    assert prove(SPECIFICATION, "scenario_1(SV,POV,L) -> dangerArises(SV,POV)").verdict is Verdict.PROVED
