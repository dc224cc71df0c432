"""Restricted questions: a drive or a test counts where the driver model, put into it, ends as is asked."""

from fractions import Fraction
from pathlib import Path

import pytest

import roadproof as rp
from roadproof.engines.search import drive_search
from roadproof.extensions.drivers.driver_settings import DriverSettings
from roadproof.extensions.drivers.models import MODELS
from roadproof.extensions.drivers.objection import Driven
from roadproof.extensions.drivers.outcome import Result
from roadproof.extensions.drivers.replay import replay
from roadproof.extensions.traffic.evaluate import decisions
from roadproof.library.bind import values_with
from roadproof.reasons import ReasonKind
from roadproof.verdict import Verdict

EXAMPLE = Path(__file__).parents[3] / "examples" / "catalogue" / "tests"


@pytest.mark.parametrize("model", ["careful", "rss"])
def test_a_drive_counts_where_the_model_in_it_ends_so(model: str) -> None:
    """The formula of the first state holds of drives that a driver prevents by what POV does later."""
    found = rp.witness(1, unpreventable=model, jobs=1)
    assert found.verdict is Verdict.WITNESSED
    [drive] = found.drives
    file = drive.file
    settings = DriverSettings(values_with(found.library, file.values), file.options)
    home = found.library.select(file.set_name, file.options)
    ended = replay(
        file.drive, file.road, ("SV", "POV"), "cut-in", MODELS[model].name, Fraction(0), home, settings
    ).outcome
    assert ended.result is Result.COLLIDES


def test_drives_to_which_a_model_objects_are_no_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Driven, "objection", lambda *_: "no collision, 3 m left")
    monkeypatch.setattr(drive_search, "TRIES", 1)
    found = rp.witness(1, unpreventable="careful", jobs=1)
    assert found.verdict is Verdict.UNKNOWN
    [outcome] = found.outcomes
    assert outcome.reason.kind is ReasonKind.NOT_DRIVEN
    assert "no collision, 3 m left" in outcome.reason


def test_a_test_counts_where_the_model_in_it_ends_so(monkeypatch: pytest.MonkeyPatch) -> None:
    """Its start is such a state under ``start="any"``, and the driver in the test decides."""
    drive = EXAMPLE / "drives" / "cut-in.json"
    found = rp.catalogue(drive, among="1", classes=False, start="any", preventable="careful", jobs=1)
    [test] = found.concrete
    assert "scenario_1" in test.names
    monkeypatch.setattr(decisions, "RESULTS", dict.fromkeys(Result, "undecided"))
    found = rp.catalogue(
        drive, among="1", classes=False, start="any", preventable="careful", jobs=1, fresh=True
    )
    [test] = found.concrete
    assert "scenario_1" not in test.names
    assert "scenario_1 begins as preventable, but is undecided with careful in place of SV" in test.notes
