"""Questions to begin with, known answers, and what answers cost."""

from typing import Any

import pytest

from roadproof.extensions.pages.studio import jobs
from roadproof.extensions.pages.studio.examples import EXAMPLES, Example


def asked(job: str, formula: str, **other: Any) -> dict[str, Any]:
    told: Any = jobs.answer(job, {"draft": {}, "formula": formula, **other})
    return dict(told)


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda x: x.title)
def test_an_example_has_the_verdict_that_the_page_shows(example: Example) -> None:
    found = asked(example.job, example.formula)
    assert found["verdict"] == example.verdict
    assert found["cost"]["known"] is None
    assert found["cost"]["seconds"] > 0
    if example.job == "prove":
        assert found["cost"]["effort"] is None or found["cost"]["effort"] > 0


def test_examples_differ_and_show_several_verdicts() -> None:
    assert len({x.formula for x in EXAMPLES}) == len(EXAMPLES)
    assert len({x.verdict for x in EXAMPLES}) >= 5


def test_the_drive_of_a_scenario_is_shipped_however_it_is_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("ROADPROOF_KNOWN")
    by_number, by_formula = asked("find", "1"), asked("find", "scenario_1(SV,POV,L)")
    assert by_number["cost"] == by_formula["cost"]
    assert by_number["cost"]["known"] == "shipped"
    assert by_number["command"] == by_formula["command"] == "roadproof witness 1"
    assert by_number["drive"] == by_formula["drive"]
    other = asked("find", "scenario_1(POV,SV,L)", negated=True)
    assert "not scenario_1(POV, SV, L)" in other["command"]


def test_a_known_answer_is_computed_again_where_that_is_asked(monkeypatch: pytest.MonkeyPatch) -> None:
    known = asked("find", "4")
    monkeypatch.delenv("ROADPROOF_KNOWN")
    fresh = asked("find", "4", fresh=True)
    assert known["cost"]["known"] is None
    assert fresh["cost"]["known"] is None
    assert fresh["verdict"] == "WITNESSED"
